import { inflatedOf85 } from '../unpack'
import { type Answer, answer } from './answer'
import type { Request, ProgressReply } from './protocol'
import type { WorkerRequest, WorkerReply } from './worker'
import EngineWorker from './worker?worker&inline'

interface PendingRequest {
  done: (block: ArrayBuffer) => void
  failed: (error: Error) => void
  onProgress?: (progress: ProgressReply) => void
}

/** An engine in a worker of its own. What is asked is answered in order. */
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

  /** Ends it, whatever it is at; what is asked later is asked of a new one. */
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

/** The engine's binary that a page carries; none where it carries none, or the browser runs no WebAssembly. */
export async function binary(): Promise<WebAssembly.Module | undefined> {
  const text = document.getElementById('engine')?.textContent?.trim()
  if (!text || typeof WebAssembly === 'undefined') return undefined
  return WebAssembly.compile(await inflatedOf85(text)).catch(() => undefined)
}
