import type { Curve } from '../curve'
import type * as wire from '../payload'
import { type Decode, inflated } from '../unpack'
import type { Failed, Message, Request, Told } from './protocol'
import type { Order, Report } from './worker'
import EngineWorker from './worker?worker&inline'

/** An answer with its curves. */
export interface Answer<T> {
  json: T
  decode: Decode
}

/** Why there is no answer, in the words of the command line. */
export class Refused extends Error {
  constructor(readonly messages: Message[]) {
    super(messages[0]?.message ?? 'there is no answer')
  }
}

interface Waiting {
  done: (block: ArrayBuffer) => void
  failed: (error: Error) => void
  tell?: (told: Told) => void
}

/** An engine in a worker of its own. What is asked is answered in order. */
export class Solver {
  #worker?: Worker
  #waiting = new Map<number, Waiting>()
  #number = 0

  constructor(private readonly module: WebAssembly.Module) {}

  async ask<T>(request: Request, tell?: (told: Told) => void): Promise<Answer<T>> {
    const worker = (this.#worker ??= this.#start())
    const number = ++this.#number
    const block = await new Promise<ArrayBuffer>((done, failed) => {
      this.#waiting.set(number, { done, failed, tell })
      worker.postMessage({ number, request } satisfies Order)
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
    worker.postMessage({ module: this.module } satisfies Order)
    worker.addEventListener('message', ({ data }: MessageEvent<Report>) => {
      const waiting = this.#waiting.get(data.number)
      if (!waiting) return
      if ('told' in data) return waiting.tell?.(data.told)
      this.#waiting.delete(data.number)
      if ('block' in data) return waiting.done(data.block)
      // After a panic its memory is not to be trusted.
      waiting.failed(new Error(`the engine failed: ${data.broken}`))
      this.stop()
    })
    worker.addEventListener('error', ({ message }) => {
      for (const { failed } of this.#waiting.values()) failed(new Error(`the engine could not start: ${message}`))
      this.#waiting.clear()
    })
    return worker
  }
}

/** Reads a block as `crates/hardpoint-studio` lays it out; a refusal is thrown. */
export function answer<T>(block: ArrayBuffer): Answer<T> {
  const length = new DataView(block).getUint32(0, true)
  const json: T | Failed = JSON.parse(new TextDecoder().decode(new Uint8Array(block, 4, length)))
  if (isFailed(json)) throw new Refused(json.failed)
  const start = Math.ceil((4 + length) / 4) * 4
  const decode = ([first, count]: wire.Curve): Curve => (count ? new Float32Array(block, start + 4 * first, count) : new Float32Array())
  return { json, decode }
}

function isFailed(json: unknown): json is Failed {
  return typeof json === 'object' && json !== null && 'failed' in json
}

/** The engine's binary that a page carries; none where it carries none. */
export async function binary(): Promise<WebAssembly.Module | undefined> {
  const text = document.getElementById('engine')?.textContent?.trim()
  return text ? WebAssembly.compile(await inflated(text)) : undefined
}
