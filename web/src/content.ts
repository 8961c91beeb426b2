import type { Interval } from './clearance'
import { type Curve, firstIndex } from './curve'
import { type Part, seenRange } from './zoom'

/** A curve of a plot. */
export interface Line {
  label: string
  color: string
  curve: Curve
  /** Abscissa of this curve, if it is another than that of the content. */
  over?: Curve
  /** True if its points are not those of the output times, as in a file that was read. */
  free?: boolean
  /** Thinned values drawn as circles instead of a line. */
  marks?: (number | null)[]
  width?: number
  dash?: number[]
  /** Listed in the legend, but not drawn. */
  hidden?: boolean
  pick?: () => void
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
  /** True if the motion goes back and forth along one line, drawn once: dashes would fill each other's gaps. */
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

/** The abscissa of a line. */
export function abscissaOf(line: Line, { over }: Content, times: Curve): Curve {
  return line.over ?? over?.curve ?? times
}

/** First and last step of a line that are drawn: from end to end of the abscissa where that is enough. */
export function drawnSteps(line: Line, content: Content, times: Curve): [first: number, last: number] {
  const xs = abscissaOf(line, content, times)
  const all: [number, number] = [0, xs.length - 1]
  if (!content.once || line.free) return all
  const [low, high] = [firstIndex(xs, (a, b) => a < b), firstIndex(xs, (a, b) => a > b)]
  const [first, last] = low < high ? [low, high] : [high, low]
  const sign = low < high ? 1 : -1
  for (let k = first; k < last; k++) if (!(sign * (xs[k + 1] - xs[k]) >= 0)) return all
  return [first, last]
}

/** Least and largest drawn value within the visible part of the abscissa; of all where none is visible. */
export function drawnRange(content: Content, times: Curve): [number, number] | undefined {
  const pairs = drawnLines(content).map((line) => [line.marks ?? line.curve, abscissaOf(line, content, times)] as const)
  return seenRange(pairs, content.part, content.logarithmic)
}
