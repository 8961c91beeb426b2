import { type Curve, stepAt, valueAt } from './curve'
import { number, pretty } from './format'
import type { Pair, Report } from './report'
import { rounded } from './rounding'
import type { State } from './state'

/** An interval of time, in the unit of the report. */
export type Interval = readonly [from: number, to: number]

/** Digits of a depth, and of the time at which it is reached. */
const DIGITS = 4
/** Numbers of a point pair per step. */
const STRIDE = 6

/** Intervals in which a distance is below 0, with straight lines between the steps. */
export function below(times: Curve, distance: Curve): Interval[] {
  const found: [number, number][] = []
  for (let k = 0; k < distance.length; k++) {
    if (!(distance[k] < 0)) continue
    const open = found.at(-1)
    const crossing = (other: number) => {
      const [a, b] = [distance[k], distance[other]]
      return Number.isFinite(b) ? times[k] + ((times[other] - times[k]) * a) / (a - b) : times[k]
    }
    const to = k + 1 < distance.length && !(distance[k + 1] < 0) ? crossing(k + 1) : times[k]
    if (k > 0 && distance[k - 1] < 0 && open) open[1] = to
    else found.push([k > 0 ? crossing(k - 1) : times[k], to])
  }
  return found
}

/** Intervals that together are all of these, in order of time. */
export function united(intervals: Interval[]): Interval[] {
  const found: [number, number][] = []
  for (const [from, to] of [...intervals].sort(([a], [b]) => a - b)) {
    const last = found.at(-1)
    if (last && from <= last[1]) last[1] = Math.max(last[1], to)
    else found.push([from, to])
  }
  return found
}

/** Pairs of the present design; undefined where its distances are not known, as those of a prediction. */
function pairsOf({ report, present, changed }: State): Pair[] | undefined {
  if (present) return present.clearance?.pairs
  return changed ? undefined : report.clearance?.pairs
}

/** Intervals of time in which shapes of a clearance touch in the present design; of all clearances by default. */
export function contacts(state: State, clearance?: number): Interval[] {
  const { report } = state
  const pairs = pairsOf(state)
  if (pairs) {
    const own = pairs.filter(({ clearances }) => clearance === undefined || clearances.includes(clearance))
    return united(own.flatMap(({ touching, distance }) => touching ?? below(report.times, distance)))
  }
  // The measure of a clearance is known where its pairs are not.
  const marks = (report.clearance?.clearances ?? []).filter((_, k) => clearance === undefined || clearance === k)
  return united(
    marks.flatMap(({ quantities }) => quantities.slice(0, 1)).flatMap((q) => below(report.times, state.curve(q, 0))),
  )
}

/** The clearance that a quantity measures: its index. */
export function clearanceOf({ clearance }: Report, quantity: number): number | undefined {
  const found = clearance?.clearances.findIndex(({ quantities }) => quantities.includes(quantity)) ?? -1
  return found < 0 ? undefined : found
}

/** The two nearest points of a clearance at a moment. */
export interface NearestPoints {
  pair: Pair
  distance: number
  points: [Place, Place]
}

type Place = [x: number, y: number, z: number]

/** The nearest pair of a clearance at a fractional step, if it is known and not beyond what the clearance lists. */
export function nearest({ clearance }: Report, index: number, step: number): NearestPoints | undefined {
  let found: NearestPoints | undefined
  for (const pair of clearance?.pairs ?? []) {
    if (!pair.clearances.includes(index)) continue
    const distance = valueAt(pair.distance, step)
    if (!Number.isFinite(distance) || (found && found.distance <= distance)) continue
    found = { pair, distance, points: pointsAt(pair.points, step) }
  }
  const beyond = clearance?.clearances[index].beyond ?? Infinity
  return found && found.distance <= beyond ? found : undefined
}

/** Both points of a pair at a fractional step. */
function pointsAt(points: Curve, step: number): [Place, Place] {
  const last = points.length / STRIDE - 1
  const k = Math.min(Math.floor(step), last)
  const next = Math.min(k + 1, last)
  const at = (part: number) => {
    const [a, b] = [points[k * STRIDE + part], points[next * STRIDE + part]]
    return step > k ? a + (b - a) * (step - k) : a
  }
  return [
    [at(0), at(1), at(2)],
    [at(3), at(4), at(5)],
  ]
}

/** Names of both shapes of a pair. */
export function pairName({ clearance }: Report, { shapes: [a, b] }: Pair): string {
  const name = (index: number) => clearance?.shapes[index].name ?? ''
  return `${name(a)} – ${name(b)}`
}

/** Sentences on the shapes that touch in the present design: which ones, how deep, and when. */
export function contactSentences(state: State): string[] {
  const { report } = state
  const { times, units, clearance } = report
  // Until the first change is solved, nothing is known of it.
  if (!clearance || (state.solver && state.isPredicted)) return []
  const depth = (distance: Curve) => {
    let deepest = -1
    distance.forEach((value, k) => value < 0 && (deepest < 0 || value < distance[deepest]) && (deepest = k))
    if (deepest < 0) return undefined
    const by = number(rounded(-distance[deepest]), DIGITS)
    return `${by} ${pretty(units.length)} deep at ${number(times[deepest], DIGITS)} ${pretty(units.time)}`
  }
  const pairs = pairsOf(state)
  if (pairs)
    return pairs.flatMap((pair) => {
      const [a, b] = pair.shapes.map((shape) => clearance.shapes[shape].name)
      const deep = depth(pair.distance)
      return deep ? [`\`${a}\` touches \`${b}\`, ${deep}.`] : []
    })
  return clearance.clearances.flatMap(({ name, quantities: [quantity] }) => {
    const deep = quantity === undefined ? undefined : depth(state.curve(quantity, 0))
    return deep ? [`Shapes of \`${name}\` touch, ${deep}.`] : []
  })
}

/** Fractional steps of an interval. */
export function stepsOf({ times }: Report, [from, to]: Interval): [number, number] {
  return [stepAt(times, from), stepAt(times, to)]
}
