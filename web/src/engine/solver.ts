import { inflatedOf91 } from '../unpack'
import { type Answer, answer } from './answer'
import type { Request, ProgressReply } from './protocol'
import type { WorkerRequest, WorkerReply } from './worker'
import EngineWorker from './worker?worker&inline'

interface PendingRequest {
  done: (block: ArrayBuffer) => void
  failed: (error: Error) => void
  onProgress?: (progress: ProgressReply) => void
}

/** An engine in a worker of its own. Requests are answered in order. */
export class Solver {
  #worker?: Worker
  #waiting = new Map<number, PendingRequest>()
  #number = 0

  constructor(private readonly module: WebAssembly.Module) {}

  async ask<T>(request: Request, onProgress?: (progress: ProgressReply) => void): Promise<Answer<T>> {
    const worker = (this.#worker ??= this.#start())
    const number = ++this.#number
    const block = await new Promise<ArrayBuffer>((done, failed) => {
      this.#waiting.set(number, { done, failed, onProgress })
      worker.postMessage({ number, request } satisfies WorkerRequest)
    })
    return answer<T>(block)
  }

  /** Ends the worker at once; later requests start a new one. */
  stop(): void {
    this.#worker?.terminate()
    this.#worker = undefined
    for (const { failed } of this.#waiting.values()) failed(new Error('stopped'))
    this.#waiting.clear()
  }

  #start(): Worker {
    const worker = new EngineWorker()
    worker.postMessage({ module: this.module } satisfies WorkerRequest)
    worker.addEventListener('message', ({ data }: MessageEvent<WorkerReply>) => {
      const waiting = this.#waiting.get(data.number)
      if (!waiting) return
      if ('progress' in data) return waiting.onProgress?.(data.progress)
      this.#waiting.delete(data.number)
      if ('block' in data) return waiting.done(data.block)
      // After a panic its memory is not to be trusted.
      waiting.failed(new Error(`the engine failed: ${data.failure}`))
      this.stop()
    })
    worker.addEventListener('error', ({ message }) => {
      for (const { failed } of this.#waiting.values()) failed(new Error(`the engine could not start: ${message}`))
      this.#waiting.clear()
    })
    return worker
  }
}

/** The engine binary of a page; undefined if it has none, or if the browser does not support WebAssembly. */
export async function binary(): Promise<WebAssembly.Module | undefined> {
  const text = document.getElementById('engine')?.textContent?.trim()
  if (!text || typeof WebAssembly === 'undefined') return undefined
  return WebAssembly.compile(await inflatedOf91(text)).catch(() => undefined)
}
