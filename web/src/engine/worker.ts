import { type Ask, instantiate } from './instance'
import type { Request, ProgressReply } from './protocol'

/** To the worker: the binary first, then requests by number. */
export type Order = { module: WebAssembly.Module } | { number: number; request: Request }
/** From the worker: the answer to a request, its progress, or an error. */
export type Report = { number: number } & ({ block: ArrayBuffer } | { progress: ProgressReply } | { broken: string })

let engine: Promise<Ask> | undefined
let number = 0

addEventListener('message', async ({ data }: MessageEvent<Order>) => {
  const send = (report: Report, moved: ArrayBuffer[] = []) => postMessage(report, { transfer: moved })
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
    send({ number: data.number, broken: error instanceof Error ? error.message : String(error) })
  }
})
