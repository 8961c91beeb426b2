import type { Interval } from './clearance'
import { type Course, type Curve, firstIndex } from './curve'
import { type Part, seenRange } from './zoom'

/** A curve of a plot. */
export interface Line {
  label: string
  color: string
  curve: Curve
  /** Abscissa of this curve, if it is another than that of the content. */
  over?: Curve
  /** Values and abscissa with their rates, if they are known; abscissa only if it is not time. */
  course?: () => { y: Course; x?: Course }
  /** True if its points are not those of the output times, as in a file that was read. */
  free?: boolean
  /** Thinned values drawn as circles instead of a line. */
  marks?: (number | null)[]
  width?: number
  dash?: number[]
  /** Listed in the legend, but not drawn. */
  hidden?: boolean
  pick?: () => void
  /** Heading of its column in a table; by default the label after the title. */
  heading?: string
  /** Explanation of the label. */
  about?: string
}

export interface Content {
  title: string
  /** Unit of the vertical axis, empty for a pure number. */
  unit: string
  lines: Line[]
  /** From a power of ten to another; values that are not positive are left out. */
  logarithmic?: boolean
  /** Abscissa of the curves instead of time. */
  over?: { label: string; unit: string; curve: Curve }
  /** True if lines that the motion goes along again are drawn once: dashes would fill each other's gaps. */
  once?: boolean
  /** True if a length is as long along both axes. */
  equal?: boolean
  /** Visible part of the abscissa, and of the ordinate; all of it if undefined. */
  part?: Part
  upright?: Part
  caption?: string
  /** Targets of the values: at one abscissa, or everywhere. */
  wanted?: { low: number | null; high: number | null; at?: number }[]
  /** Intervals of time in which shapes touch. */
  contacts?: readonly Interval[]
  /** Shown in place of the plot. */
  message?: string
}

/** Lines of a plot that are not hidden. */
export function drawnLines({ lines }: Content): Line[] {
  return lines.filter(({ hidden }) => !hidden)
}

/** Heading of a line's column in a table. */
export function headingOf({ label, heading }: Line, { title }: Content): string {
  return heading ?? (label === title ? title : `${title}: ${label}`)
}

/** The abscissa of a line. */
export function abscissaOf(line: Line, { over }: Content, times: Curve): Curve {
  return line.over ?? over?.curve ?? times
}

/** Values of the way back agree with the way there up to this part of their range, besides the bend between steps. */
const RETRACED = 1e-3

/** True if the steps beyond a stretch with ascending or descending abscissas have the values of the stretch. */
function isRetraced(xs: Curve, ys: ArrayLike<number | null>, first: number, last: number): boolean {
  const y = (k: number) => ys[Math.min(Math.max(k, first), last)] ?? NaN
  const bend = (k: number) => Math.abs(y(k - 1) - 2 * y(k) + y(k + 1))
  let [low, high] = [Infinity, -Infinity]
  for (let k = first; k <= last; k++) [low, high] = [Math.min(low, y(k)), Math.max(high, y(k))]
  const sign = xs[first] < xs[last] ? 1 : -1
  for (let k = 0; k < xs.length; k++) {
    const value = ys[k] ?? NaN
    if ((k >= first && k <= last) || Number.isNaN(value)) continue
    let [a, b] = [first, last]
    while (b - a > 1) {
      const middle = (a + b) >> 1
      if (sign * (xs[middle] - xs[k]) <= 0) a = middle
      else b = middle
    }
    const part = xs[b] === xs[a] ? 0 : (xs[k] - xs[a]) / (xs[b] - xs[a])
    const between = y(a) + part * (y(b) - y(a))
    if (!(Math.abs(value - between) <= RETRACED * (high - low) + bend(a) + bend(b))) return false
  }
  return true
}

/**
 * First and last step of a line that are drawn: from end to end of the abscissa where that is enough, because the other
 * steps go along the same line again.
 */
export function drawnSteps(line: Line, content: Content, times: Curve): [first: number, last: number] {
  const xs = abscissaOf(line, content, times)
  const all: [number, number] = [0, xs.length - 1]
  if (!content.once || line.free) return all
  const [low, high] = [firstIndex(xs, (a, b) => a < b), firstIndex(xs, (a, b) => a > b)]
  const [first, last] = low < high ? [low, high] : [high, low]
  const sign = low < high ? 1 : -1
  for (let k = first; k < last; k++) if (!(sign * (xs[k + 1] - xs[k]) >= 0)) return all
  return isRetraced(xs, line.curve, first, last) ? [first, last] : all
}

/** Least and largest drawn value within the visible part of the abscissa; of all where none is visible. */
export function drawnRange(content: Content, times: Curve): [number, number] | undefined {
  const pairs = drawnLines(content).map((line) => [line.marks ?? line.curve, abscissaOf(line, content, times)] as const)
  return seenRange(pairs, content.part, content.logarithmic)
}
