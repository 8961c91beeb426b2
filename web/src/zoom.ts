import type { Curve } from './curve'
import { extent } from './export/axis'

/** Visible part of an abscissa: from a value to a larger one. */
export type Part = readonly [low: number, high: number]

/** Smallest visible part: below it, a curve between output times is only a straight line. */
const LEAST = 1 / 200

/** Visible part of the abscissa of some plots; all of it if undefined. */
export class Zoom {
  #part?: Part
  #listeners: (() => void)[] = []

  get part(): Part | undefined {
    return this.#part
  }

  onChange(listener: () => void): void {
    this.#listeners.push(listener)
  }

  show(part: Part | undefined): void {
    this.#part = part
    for (const listener of this.#listeners) listener()
  }
}

/** From one of two values to the other. */
export function between(a: number, b: number): Part {
  return a < b ? [a, b] : [b, a]
}

/** Number of times as wide, with `at` where it was on the screen. */
export function scaled([low, high]: Part, factor: number, at: number): Part {
  return [at - (at - low) * factor, at + (high - at) * factor]
}

/** Moved by a share of its width. */
export function moved([low, high]: Part, share: number): Part {
  const by = share * (high - low)
  return [low + by, high + by]
}

/** The range, shifted into the whole; undefined if it is the whole. */
export function within([low, high]: Part, whole: Part): Part | undefined {
  const width = high - low
  if (!(width < whole[1] - whole[0])) return undefined
  const from = Math.min(Math.max(low, whole[0]), whole[1] - width)
  return [from, from + width]
}

/** The part itself, or the largest visible range about its middle. */
export function atLeast([low, high]: Part, whole: Part): Part {
  const half = Math.max(high - low, LEAST * (whole[1] - whole[0])) / 2
  const middle = (low + high) / 2
  return [middle - half, middle + half]
}

/**
 * The values of a curve where its abscissa is within a part: those of its steps, and those with which it enters and
 * leaves.
 */
export function inside(values: ArrayLike<number | null>, abscissa: Curve, [low, high]: Part): number[] {
  const found: number[] = []
  for (let k = 0; k < abscissa.length; k++) {
    const [x, y] = [abscissa[k], values[k] ?? NaN]
    if (low <= x && x <= high) found.push(y)
    // Before the first step there is nothing, and NaN is on neither side of an edge.
    const [x0, y0] = [abscissa[k - 1] ?? NaN, values[k - 1] ?? NaN]
    for (const edge of [low, high])
      if ((x0 - edge) * (x - edge) < 0) found.push(y0 + ((y - y0) * (edge - x0)) / (x - x0))
  }
  return found
}

/** The steps of which something is seen within a part: of each stretch from one step to the next, both ends. */
export function stepsWithin(abscissa: Curve, [low, high]: Part): Set<number> {
  const steps = new Set<number>()
  for (let k = 1; k < abscissa.length; k++) {
    const [first, last] = between(abscissa[k - 1], abscissa[k])
    if (first <= high && last >= low) steps.add(k - 1).add(k)
  }
  return steps
}

/**
 * Least and largest of the values that are seen, each list with its abscissas; where there are none, of all.
 */
export function seenRange(
  curves: readonly (readonly [values: ArrayLike<number | null>, abscissa: Curve])[],
  part: Part | undefined,
  positive = false,
): [number, number] | undefined {
  const seen =
    part &&
    extent(
      curves.map(([values, abscissa]) => inside(values, abscissa, part)),
      positive,
    )
  return (
    seen ??
    extent(
      curves.map(([values]) => values),
      positive,
    )
  )
}
