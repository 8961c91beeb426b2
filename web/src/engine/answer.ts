import type { Curve } from '../curve'
import type * as wire from '../payload'
import type { Decode } from '../unpack'
import type { ErrorReply, DiagnosticMessage } from './protocol'

/** An answer with its curves. */
export interface Answer<T> {
  json: T
  decode: Decode
}

/** Reason why there is no answer, in the words of the command line. */
export class RequestError extends Error {
  constructor(readonly messages: DiagnosticMessage[]) {
    super(messages[0]?.message ?? 'there is no answer')
  }
}

/** Reads a block as `crates/hardpoint-studio` lays it out; a refusal is thrown. */
export function answer<T>(block: ArrayBuffer): Answer<T> {
  const length = new DataView(block).getUint32(0, true)
  const json: T | ErrorReply = JSON.parse(new TextDecoder().decode(new Uint8Array(block, 4, length)))
  if (isFailed(json)) throw new RequestError(json.failed)
  const start = Math.ceil((4 + length) / 4) * 4
  const decode = ([first, count]: wire.Curve): Curve =>
    count ? new Float32Array(block, start + 4 * first, count) : new Float32Array()
  return { json, decode }
}

function isFailed(json: unknown): json is ErrorReply {
  return typeof json === 'object' && json !== null && 'failed' in json
}
