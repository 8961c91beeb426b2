import { padded } from '../curve'
import { number } from '../format'

/** From values to pixels, with round numbers on the way. */
export interface Axis {
  /** Position of a value; NaN if a logarithmic axis cannot show it. */
  at(value: number): number
  ticks: { value: number; text: string }[]
}

/** Least number of round numbers along an ordinate. */
export const FEWEST_TICKS = 3
/** Number of powers of ten above which only every other one has a label. */
const MOST_POWERS = 6

/** A range of an axis; of one value a little to either side, as an axis without width has no steps. */
export function widened([low, high]: readonly [number, number]): [number, number] {
  return low === high ? padded(low, high) : [low, high]
}

/** An axis from the first value at `from` to the second at `to` with about `count` round numbers. */
export function linearAxis(range: readonly [number, number], from: number, to: number, count: number): Axis {
  const [low, high] = widened(range)
  const at = (value: number) => from + ((value - low) / (high - low)) * (to - from)
  const step = roundStep((high - low) / count)
  const first = Math.ceil(low / step - 1e-9)
  const last = Math.floor(high / step + 1e-9)
  const ticks = Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => {
    const value = (first + k) * step
    return { value, text: number(value, 6) }
  })
  return { at, ticks }
}

/** Round numbers of an ordinate, at least three. */
export function ticks(range: [number, number], count: number): number[] {
  for (let wanted = count; ; wanted++) {
    const found = linearAxis(range, 0, 1, wanted).ticks.map(({ value }) => value)
    if (found.length >= FEWEST_TICKS || wanted > 4 * count) return found
  }
}

/** An axis over whole powers of ten. */
export function logarithmicAxis([low, high]: [number, number], from: number, to: number): Axis {
  const [bottom, top] = [Math.log10(low), Math.log10(high)]
  const at = (value: number) => (value > 0 ? from + ((Math.log10(value) - bottom) / (top - bottom)) * (to - from) : NaN)
  const powers = Array.from({ length: Math.round(top - bottom) + 1 }, (_, k) => Math.round(bottom) + k)
  const few = powers.length <= MOST_POWERS
  return {
    at,
    ticks: powers.map((power) => ({ value: 10 ** power, text: few || power % 2 === 0 ? number(10 ** power) : '' })),
  }
}

/** The nearest of 1, 2 and 5 times a power of ten that is not below. */
export function roundStep(minimum: number): number {
  const power = 10 ** Math.floor(Math.log10(minimum))
  return ([1, 2, 5].find((lead) => lead * power >= minimum * (1 - 1e-9)) ?? 10) * power
}

/** Minimum and maximum of the numbers; undefined if there are none. */
export function extent(lists: ArrayLike<number | null>[], positive = false): [number, number] | undefined {
  let [low, high] = [Infinity, -Infinity]
  for (const list of lists) {
    for (let k = 0; k < list.length; k++) {
      const value = list[k]
      if (value === null || !Number.isFinite(value) || (positive && value <= 0)) continue
      if (value < low) low = value
      if (value > high) high = value
    }
  }
  return low <= high ? [low, high] : undefined
}
