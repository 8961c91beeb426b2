import { type Ask, instantiate } from './instance'
import type { Request, ProgressReply } from './protocol'

/** To the worker: the binary first, then requests by number. */
export type WorkerRequest = { module: WebAssembly.Module } | { number: number; request: Request }
/** From it: what a request came to, or how far it is. */
export type WorkerReply = { number: number } & (
  | { block: ArrayBuffer }
  | { progress: ProgressReply }
  | { failure: string }
)

let engine: Promise<Ask> | undefined
let number = 0

addEventListener('message', async ({ data }: MessageEvent<WorkerRequest>) => {
  const send = (report: WorkerReply, moved: ArrayBuffer[] = []) => postMessage(report, { transfer: moved })
  if ('module' in data) {
    engine = instantiate(data.module, (progress) => send({ number, progress }))
    return
  }
  try {
    const ask = await engine!
    ;({ number } = data)
    const block = ask(data.request)
    send({ number: data.number, block }, [block])
  } catch (error) {
    send({ number: data.number, failure: error instanceof Error ? error.message : String(error) })
  }
})
