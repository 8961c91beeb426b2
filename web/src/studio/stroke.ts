/** A point of a curve, or of the screen. */
export type Point = readonly [x: number, y: number]

/** Fraction of the visible range over which a new part blends into the old curve. */
const BLEND = 0.03
/** Tremble of a hand, and tolerance of a thinned curve, px. */
const TREMBLE = 7
const OFF = 2
/** Minimum number of steps of the numbers across the visible range. */
const STEPS = 500

/** Drawn stroke as one value at each abscissa: where it went back, the last one. */
export function upright(drawn: readonly Point[]): Point[] {
  let curve: Point[] = []
  let [before] = drawn
  for (const point of drawn) {
    const [from, to] = before[0] <= point[0] ? [before, point] : [point, before]
    const kept = curve.filter(([x]) => x < from[0] || x > to[0])
    // The last point of a vertical stretch is used.
    const added = from[0] === to[0] ? [point] : [from, to]
    curve = [...kept.filter(([x]) => x < from[0]), ...added, ...kept.filter(([x]) => x > to[0])]
    before = point
  }
  return curve
}

/** The value of a curve at an abscissa, in straight lines between its points; nothing beyond its ends. */
export function at(curve: readonly Point[], x: number): number | undefined {
  const k = curve.findIndex((point) => point[0] >= x)
  if (k < 0) return undefined
  if (curve[k][0] === x) return curve[k][1]
  if (k === 0) return undefined
  const [[x0, y0], [x1, y1]] = [curve[k - 1], curve[k]]
  return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0)
}

/** A curve without the tremble of a hand: every value the mean of those around it, its ends where they are. */
export function smoothed(curve: readonly Point[], reach = TREMBLE): Point[] {
  if (curve.length < 3) return [...curve]
  const [[first], [last]] = [curve[0], curve.at(-1)!]
  const count = Math.max(2, Math.ceil(((last - first) / reach) * 3))
  const xs = Array.from({ length: count + 1 }, (_, k) => (k === count ? last : first + ((last - first) * k) / count))
  const ys = xs.map((x) => at(curve, x)!)
  return xs.map((x, k) => {
    // As far to the one side as to the other, so that a straight line stays one.
    const half = Math.min(k, count - k, 3)
    const weights = Array.from({ length: 2 * half + 1 }, (_, j) => half + 1 - Math.abs(j - half))
    const sum = weights.reduce((sum, weight, j) => sum + weight * ys[k - half + j], 0)
    return [x, sum / weights.reduce((a, b) => a + b)]
  })
}

/** As few of the points as leave none farther off than that: Douglas and Peucker. */
export function thinned(curve: readonly Point[], off = OFF): Point[] {
  if (curve.length < 3) return [...curve]
  const [[x0, y0], [x1, y1]] = [curve[0], curve.at(-1)!]
  const length = Math.hypot(x1 - x0, y1 - y0)
  const away = curve.map(([x, y]) =>
    length === 0 ? Math.hypot(x - x0, y - y0) : Math.abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length,
  )
  const farthest = away.reduce((maximum, distance, k) => (distance > away[maximum] ? k : maximum), 0)
  if (away[farthest] <= off) return [curve[0], curve.at(-1)!]
  return [...thinned(curve.slice(0, farthest + 1), off).slice(0, -1), ...thinned(curve.slice(farthest), off)]
}

/**
 * A curve with a new part in place of what it had there; beside it the curve stays, and comes back to itself within a
 * `seen` part of the abscissa.
 */
export function replaced(curve: readonly Point[], part: readonly Point[], seen: number): Point[] {
  if (part.length === 0) return [...curve]
  const [from, to] = [part[0][0], part.at(-1)![0]]
  const beside = BLEND * seen
  const kept = (x: number): Point[] => {
    const y = at(curve, x)
    return y === undefined ? [] : [[x, y]]
  }
  return [
    ...curve.filter(([x]) => x < from - beside),
    ...kept(from - beside),
    ...part,
    ...kept(to + beside),
    ...curve.filter(([x]) => x > to + beside),
  ]
}

/** A number to about a thousandth of a range: to a power of ten, as a person would. */
export function roundedIn(value: number, range: number): number {
  const step = 10 ** Math.floor(Math.log10(range / STEPS))
  return Number((Math.round(value / step) * step).toPrecision(12))
}

/** The points in numbers that a person would write, with rising abscissas. */
export function written(curve: readonly Point[], [across, up]: readonly [across: number, up: number]): Point[] {
  const rounded = curve.map(([x, y]): Point => [roundedIn(x, across), roundedIn(y, up)])
  return rounded.filter(([x], k) => k === 0 || x > rounded[k - 1][0])
}
