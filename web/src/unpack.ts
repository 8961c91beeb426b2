import type { Curve } from './curve'
import type * as wire from './payload'

/** From a curve of the payload to its values. */
export type Decode = (curve: wire.Curve) => Curve

/** Contents of the report's file: packed by `encoding.rs` of `hardpoint-report`, tracks by `hardpoint-table`. */
export async function unpack(text: string): Promise<{ payload: wire.Payload; decode: Decode }> {
  const block = await inflatedOf91(text.trim())
  const [json, tracks, gaps, residuals] = new Uint32Array(block.buffer, 0, COUNTS)
  const start = COUNTS * 4 + json
  const payload: wire.Payload = JSON.parse(new TextDecoder().decode(block.subarray(COUNTS * 4, start)))
  const values = new Tracks(block, start, tracks, gaps, residuals)
  return { payload, decode: (curve) => interleaved(curve.map((index) => values.track(index))) }
}

/** The bytes that were deflated and written in base64. */
export const inflated = (base64: string): Promise<Uint8Array<ArrayBuffer>> => inflate(bytesOf(base64))

/** The bytes that were deflated and written in base 91, as `base91.rs` of `hardpoint-report` does. */
export const inflatedOf91 = (text: string): Promise<Uint8Array<ArrayBuffer>> => inflate(bytesOf91(text))

/** A text, deflated and written in base64. */
export async function deflated(text: string): Promise<string> {
  const packed = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'))
  const bytes = new Uint8Array(await new Response(packed).arrayBuffer())
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''))
}

async function inflate(deflated: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  const plain = new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate-raw'))
  return new Uint8Array(await new Response(plain).arrayBuffer())
}

/** Numbers at the head of the block. */
const COUNTS = 4
const SCALED = 8
const BITS = 16

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64.trim())
  // A plain loop: Uint8Array.from is ten times slower.
  const bytes = new Uint8Array(text.length)
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k)
  return bytes
}

const DIGITS = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!#$%&'()*+,-./:;=>?@[]^_`{|}~"

/** 13 bits of each two characters, the lowest first; a last single character has six. */
function bytesOf91(text: string): Uint8Array<ArrayBuffer> {
  const value = new Uint8Array(128)
  for (let k = 0; k < DIGITS.length; k++) value[DIGITS.charCodeAt(k)] = k
  const [pairs, single] = [text.length >> 1, text.length % 2]
  const bytes = new Uint8Array((pairs * 13 + single * 6) >> 3)
  let [number, bits] = [0, 0]
  for (let k = 0, at = 0; k < text.length; k += 2) {
    const pair = k + 1 < text.length
    number |= (value[text.charCodeAt(k)] + (pair ? 91 * value[text.charCodeAt(k + 1)] : 0)) << bits
    for (bits += pair ? 13 : 6; bits >= 8; bits -= 8, number >>>= 8) bytes[at++] = number
  }
  return bytes
}

/** First values of all tracks, then the second ones, and so on. */
function interleaved(tracks: Curve[]): Curve {
  if (tracks.length < 2) return tracks[0] ?? new Float32Array()
  const together = new Float32Array(tracks.length * tracks[0].length)
  tracks.forEach((track, part) => track.forEach((value, k) => (together[k * tracks.length + part] = value)))
  return together
}

/** The tracks of a block, read when they are requested. */
class Tracks {
  readonly #forms: Uint8Array
  readonly #lengths: Uint32Array
  readonly #scales: Float32Array
  readonly #gapCounts: Uint32Array
  readonly #gaps: Uint32Array
  readonly #planes: Uint8Array[]
  /** First residual and first gap of each track. */
  readonly #starts: { residual: number; gap: number }[] = []
  readonly #known = new Map<number, Curve>()

  constructor(block: Uint8Array, start: number, tracks: number, gaps: number, residuals: number) {
    let at = start
    const take = (bytes: number) => block.slice(at, (at += bytes))
    this.#forms = take(tracks)
    this.#lengths = new Uint32Array(take(4 * tracks).buffer)
    this.#scales = new Float32Array(take(4 * tracks).buffer)
    this.#gapCounts = new Uint32Array(take(4 * tracks).buffer)
    this.#gaps = new Uint32Array(take(8 * gaps).buffer)
    this.#planes = [0, 1, 2, 3].map(() => block.subarray(at, (at += residuals)))
    let [residual, gap] = [0, 0]
    for (let index = 0; index < tracks; index++) {
      this.#starts.push({ residual, gap })
      if (this.#forms[index] >= SCALED) residual += this.#lengths[index]
      for (const last = gap + this.#gapCounts[index]; gap < last; gap++) {
        if (this.#forms[index] >= SCALED) residual -= this.#gaps[2 * gap + 1]
      }
    }
  }

  track(index: number): Curve {
    const known = this.#known.get(index)
    if (known) return known
    const read = this.#read(index)
    this.#known.set(index, read)
    return read
  }

  #read(index: number): Curve {
    const values = new Float32Array(this.#lengths[index])
    const { gap: first } = this.#starts[index]
    const numbers = this.#numbers(index)
    const gaps = this.#gaps.subarray(2 * first, 2 * (first + this.#gapCounts[index]))
    const spans = [...gaps, values.length]
    // Between the gaps the values follow each other.
    for (let k = 0, next = 0, span = 0; k < values.length; span += 2) {
      const count = spans[span] - k
      if (numbers) values.set(numbers.subarray(next, next + count), k)
      else values.fill(this.#scales[index], k, k + count)
      next += count
      k += count
      if (span + 1 < spans.length) values.fill(NaN, k, (k += spans[span + 1]))
    }
    return values
  }

  /** The values without the gaps; nothing for a constant. */
  #numbers(index: number): Curve | undefined {
    const form = this.#forms[index]
    if (form < SCALED) return
    const { residual: first } = this.#starts[index]
    const last = this.#starts[index + 1]?.residual ?? this.#planes[0].length
    const [a, b, c, d] = this.#planes
    const whole = new Int32Array(last - first)
    for (let k = first; k < last; k++) {
      const folded = a[k] | (b[k] << 8) | (c[k] << 16) | (d[k] << 24)
      whole[k - first] = (folded >>> 1) ^ -(folded & 1)
    }
    for (let order = form % 8; order > 0; order--) {
      for (let k = 1; k < whole.length; k++) whole[k] += whole[k - 1]
    }
    if (form < BITS) {
      const scale = this.#scales[index]
      return Float32Array.from(whole, (n) => n * scale)
    }
    return new Float32Array(whole.map((n) => (n < 0 ? -n | (1 << 31) : n)).buffer)
  }
}
