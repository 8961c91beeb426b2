import { css } from '../dom'

type Rgb = readonly [number, number, number]

/** Shades to either side of nothing. */
const SHADES = 64
/** Side of the canvas that a colour is read back from, px. */
const PIXEL = 1

/** Colours from the minimum (blue) over zero to the maximum (orange), for canvases. */
export class Scale {
  readonly #shades: string[]

  constructor() {
    const [low, none, high] = ['--heat-low', '--heat-none', '--heat-high'].map(channels)
    const between = (to: Rgb, share: number) =>
      `rgb(${none.map((from, k) => Math.round(from + (to[k] - from) * share)).join(' ')})`
    const shares = Array.from({ length: 2 * SHADES + 1 }, (_, k) => k / SHADES - 1)
    this.#shades = shares.map((share) => between(share < 0 ? low : high, Math.abs(share)))
  }

  /** The colour of a share from -1 to 1. */
  of(share: number): string {
    return this.#shades[Math.round((Math.min(Math.max(share, -1), 1) + 1) * SHADES)]
  }
}

/** True if text on a share's colour is to be light, where colours grow darker away from nothing. */
export function strong(share: number): boolean {
  return Math.abs(share) > 0.6
}

/** A custom property's colour in numbers, however it is written. */
function channels(name: string): Rgb {
  const canvas = document.createElement('canvas')
  canvas.width = canvas.height = PIXEL
  const context = canvas.getContext('2d')!
  context.fillStyle = css(name)
  context.fillRect(0, 0, PIXEL, PIXEL)
  const [r, g, b] = context.getImageData(0, 0, PIXEL, PIXEL).data
  return [r, g, b]
}
