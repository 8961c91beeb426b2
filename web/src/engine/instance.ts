import type { Request, ProgressReply } from './protocol'

/** Exports of the engine's binary: see `web/engine`. */
interface Exports {
  memory: WebAssembly.Memory
  room(length: number): number
  answer(): number
  answered(): number
}

/** Answers a request with a block of bytes, at once. */
export type Ask = (request: Request) => ArrayBuffer

/** An engine of its own; `onProgress` receives the progress of a study. */
export async function instantiate(
  module: WebAssembly.Module,
  onProgress: (progress: ProgressReply) => void,
): Promise<Ask> {
  const text = (place: number, length: number) =>
    new TextDecoder().decode(new Uint8Array(exports.memory.buffer, place, length))
  const page = {
    tell: (place: number, length: number) => onProgress(JSON.parse(text(place, length))),
  }
  const { exports: found } = await WebAssembly.instantiate(module, { page })
  const exports = found as unknown as Exports
  return (request) => {
    const bytes = new TextEncoder().encode(JSON.stringify(request))
    const place = exports.room(bytes.length)
    new Uint8Array(exports.memory.buffer, place, bytes.length).set(bytes)
    try {
      const length = exports.answer()
      return exports.memory.buffer.slice(exports.answered(), exports.answered() + length) as ArrayBuffer
    } catch (error) {
      throw new Error(String(error))
    }
  }
}
