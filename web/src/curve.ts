import { RESOLUTION, rounded } from './rounding'

/** One number per step; NaN where there is none. */
export type Curve = Float32Array

/** The value that is largest in magnitude, 0 for a curve without any value. */
export function extreme(curve: Curve): number {
  let largest = 0
  for (const value of curve) if (Math.abs(value) > Math.abs(largest)) largest = value
  return largest
}

/** Largest magnitude over time, 0 for a curve without any value. */
export function peak(curve: Curve): number {
  return Math.abs(extreme(curve))
}

/** Index of the value that comes first in an order, the first one of equals. */
export function firstIndex(curve: Curve, before: (a: number, b: number) => boolean): number {
  let best = 0
  for (let k = 1; k < curve.length; k++) if (before(curve[k], curve[best])) best = k
  return best
}

/** Values of every `stride`-th step in their places, gaps between; nothing for a curve without values. */
export function spread(curve: Curve, stride: number, steps: number): Curve {
  if (curve.length === 0) return curve
  const whole = new Float32Array(steps).fill(NaN)
  curve.forEach((value, k) => (whole[k * stride] = value))
  return whole
}

/** As uPlot wants it: null is a gap. */
export function withGaps(curve: Curve): (number | null)[] {
  return Array.from(curve, (value) => (Number.isNaN(value) ? null : value))
}

/** For a logarithmic axis: null where there is no positive value. */
export function positive(curve: Curve): (number | null)[] {
  return Array.from(curve, (value) => (value > 0 ? value : null))
}

/** The powers of ten around values from `low` to `high`, at least one decade. */
export function decades(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !(low > 0)) return [0.1, 1]
  const bottom = Math.floor(Math.log10(low) + 1e-9)
  const top = Math.ceil(Math.log10(high) - 1e-9)
  return [10 ** Math.min(bottom, top - 1), 10 ** top]
}

/** Range of the axis around a constant, relative to its size. */
const FLAT = 0.2

/** Range of an axis for values from `low` to `high`: they, and a little on both sides. */
export function padded(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [-1, 1]
  const size = Math.max(Math.abs(low), Math.abs(high))
  const flat = high - low <= RESOLUTION * size
  const minimum = size > 0 ? (flat ? FLAT : RESOLUTION) * size : 2
  const middle = (low + high) / 2
  const half = 0.56 * Math.max(high - low, minimum)
  return [middle - half, middle + half]
}

/** Below this part of its largest, a rate is that of a turning point. */
const TURNS = 1e-4

/** Fraction of its maximum below which a rate belongs to a motion about to reverse. */
const TURNING = 0.25
/**
 * Fraction of its maximum below which a rate counts as zero at the turn of the abscissa; the rest is curvature.
 */
const WITH_IT = 0.1

/**
 * Slope dy/dx along the motion: ratio of the rates, or of the accelerations where `x` reverses and both rates vanish.
 * NaN where neither is defined, and close to a reversal of `x` that `y` does not share: there `y` is not a function of
 * `x`.
 */
export function slope(y: readonly [Curve, Curve, Curve], x: readonly [Curve, Curve, Curve]): Curve {
  const at = slopeAt(y, x)
  return Float32Array.from(x[0], (_, k) => at(k))
}

/** The same at single steps. */
export function slopeAt(
  y: readonly [Curve, Curve, Curve],
  x: readonly [Curve, Curve, Curve],
): (step: number) => number {
  const [fastest, steepest, liveliest] = [peak(x[1]), peak(x[2]), peak(y[1])]
  return (k) => {
    if (Math.abs(x[1][k]) <= fastest * TURNS) {
      return Math.abs(x[2][k]) > steepest * TURNS && Math.abs(y[1][k]) <= liveliest * TURNS ? y[2][k] / x[2][k] : NaN
    }
    // Where x. is nothing, y. will be  y. - y.. x. / x..
    const left = y[1][k] - (y[2][k] * x[1][k]) / x[2][k]
    const goesOn = Math.abs(x[1][k]) < fastest * TURNING && Math.abs(left) > liveliest * WITH_IT
    return goesOn ? NaN : y[1][k] / x[1][k]
  }
}

/**
 * Slope dy/dx while one driver moves alone, from the changes of both per unit of the driver; NaN where the driver
 * hardly moves `x`.
 */
export function slopeAlone(y: Curve, x: Curve): Curve {
  const minimum = peak(x) * TURNS
  return y.map((value, k) => (Math.abs(x[k]) > minimum ? value / x[k] : NaN))
}

/** Part of the larger of two curves in single precision below which their difference is rounding. */
const SINGLE = 1e-6

/** A sensitivity at a fixed abscissa rather than a fixed time: `dy - slope dx`, 0 where that is rounding. */
export function atFixedAbscissa(dy: Curve, dx: Curve, slope: Curve): Curve {
  const least = SINGLE * peak(dy)
  return dy.map((value, k) => {
    const left = value - slope[k] * dx[k]
    return Math.abs(left) <= least ? 0 : left
  })
}

/** A curve with its abscissa; none if that is time, which is the same for all designs. */
type OverAbscissa = readonly [y: Curve, x?: Curve]

/**
 * Change of a curve to another one at the same abscissa: interpolated on the other's nearest stretch around it, NaN
 * beyond its ends.
 */
export function changeFrom([y, x]: OverAbscissa, [before, at]: OverAbscissa): Curve {
  if (!x || !at || x === at) return y.map((value, k) => value - before[k])
  return y.map((value, k) => value - nearStep(before, at, x[k], k))
}

/** The value of a curve where its abscissa is `x`, on the stretch nearest to a step. */
function nearStep(y: Curve, x: Curve, value: number, step: number): number {
  if (x[step] === value) return y[step]
  for (let away = 0; away < x.length; away++) {
    for (const k of [step - away, step + 1 + away]) {
      if (!(k > 0 && k < x.length) || !((x[k - 1] - value) * (x[k] - value) <= 0)) continue
      const part = (value - x[k - 1]) / (x[k] - x[k - 1] || 1)
      return y[k - 1] + part * (y[k] - y[k - 1])
    }
  }
  return NaN
}

/** The step whose value is nearest to `value`; of equals the one nearest to `step`. */
export function nearestStep(curve: Curve, value: number, step: number): number {
  let best = 0
  const range = peak(curve) || 1
  const distance = (k: number) => Math.abs(curve[k] - value) + (1e-3 * range * Math.abs(k - step)) / curve.length
  for (let k = 1; k < curve.length; k++) if (distance(k) < distance(best)) best = k
  return best
}

/** The value at a fractional step. */
export function valueAt(curve: Curve, step: number): number {
  const k = Math.min(Math.floor(step), curve.length - 1)
  const next = Math.min(k + 1, curve.length - 1)
  return step === k ? curve[k] : curve[k] + (curve[next] - curve[k]) * (step - k)
}

/** A quantity over time: its values, then its rates and accelerations as far as they are known. */
export type Course = readonly Curve[]

/**
 * Coefficients, from the constant on, of a course between step `k` and the next one, a time `h` later: the polynomial
 * with the values, rates and accelerations of both steps, as metrics are evaluated between output times. Its variable
 * goes from 0 to 1.
 */
function polynomial([y, v, a]: Course, k: number, h: number): number[] {
  if (!v?.length || Number.isNaN(v[k] + v[k + 1])) return [y[k], y[k + 1] - y[k]]
  const [first, rate] = [y[k], h * v[k]]
  if (!a?.length || Number.isNaN(a[k] + a[k + 1])) {
    const [rise, turn] = [y[k + 1] - first - rate, h * v[k + 1] - rate]
    return [first, rate, 3 * rise - turn, turn - 2 * rise]
  }
  const bend = (h * h * a[k]) / 2
  const rise = y[k + 1] - first - rate - bend
  const turn = h * v[k + 1] - rate - 2 * bend
  const left = (h * h * a[k + 1]) / 2 - bend
  return [first, rate, bend, 10 * rise - 4 * turn + left, 7 * turn - 15 * rise - 2 * left, 6 * rise - 3 * turn + left]
}

function horner(coefficients: readonly number[], s: number): number {
  return coefficients.reduceRight((sum, coefficient) => coefficient + s * sum, 0)
}

/** Value of a course between step `k` and the next one, a time `h` later; `s` goes from 0 to 1. */
export function hermite(course: Course, k: number, h: number, s: number): number {
  return horner(polynomial(course, k, h), s)
}

/** Intervals of a step in which the sign of a rate is looked for. */
const PARTS = 4
/** Difference of a rise from the one by the mean rate, relative to the larger rate, beyond which there is a kink. */
const KINK = 0.4

/** Places between 0 and 1 where a polynomial turns. */
function turns(coefficients: readonly number[]): number[] {
  const rate = coefficients.slice(1).map((coefficient, k) => (k + 1) * coefficient)
  const found: number[] = []
  for (let part = 0; part < PARTS; part++) {
    let [low, high] = [part / PARTS, (part + 1) / PARTS]
    const sign = horner(rate, low)
    if (!(sign * horner(rate, high) < 0)) continue
    for (let n = 0; n < BISECTIONS; n++) {
      const middle = (low + high) / 2
      if (horner(rate, middle) * sign > 0) low = middle
      else high = middle
    }
    found.push(low)
  }
  return found
}

/**
 * Minimum and maximum of a course, also between its steps; undefined without a value. Steps in which the rates do not
 * belong to the values, as beside a kink, have those of their ends.
 */
export function courseRange(course: Course, times: Curve): [number, number] | undefined {
  const [y, v] = course
  let [low, high] = [Infinity, -Infinity]
  const take = (value: number) => {
    if (!Number.isFinite(value)) return
    if (value < low) low = value
    if (value > high) high = value
  }
  for (let k = 0; k < y.length; k++) {
    take(y[k])
    if (!v?.length || k + 1 >= y.length) continue
    const h = times[k + 1] - times[k]
    const [rise, begin, end] = [y[k + 1] - y[k], h * v[k], h * v[k + 1]]
    const largest = Math.max(Math.abs(begin), Math.abs(end))
    // A cubic with these rates goes one way only.
    const isMonotone = begin * rise >= 0 && end * rise >= 0 && largest <= 3 * Math.abs(rise)
    if (isMonotone || !(Math.abs(rise - (begin + end) / 2) <= KINK * largest)) continue
    const coefficients = polynomial(course, k, h)
    for (const turn of turns(coefficients)) take(horner(coefficients, turn))
  }
  return low <= high ? [low, high] : undefined
}

/** Bisections that leave less than single precision of an interval. */
const BISECTIONS = 30

/** Abscissas in single precision count as the same within this part. */
const NEAR = 1e-6

/** Values of a course wherever its abscissa is `x`, from step `first` to step `last`, in the order of the motion. */
export function crossings(
  xs: Course,
  ys: Course,
  times: Curve,
  x: number,
  [first, last]: readonly [number, number],
): number[] {
  const found: number[] = []
  const near = Math.max(1, Math.abs(x)) * NEAR
  const away = (k: number) => (Math.abs(xs[0][k] - x) <= near ? 0 : xs[0][k] - x)
  for (let k = first; k <= last; k++) {
    if (away(k) === 0) found.push(ys[0][k])
    else if (k < last && away(k) * away(k + 1) < 0) {
      const h = times[k + 1] - times[k]
      let [low, high] = [0, 1]
      for (let n = 0; n < BISECTIONS; n++) {
        const middle = (low + high) / 2
        if ((hermite(xs, k, h, middle) - x) * away(k) > 0) low = middle
        else high = middle
      }
      found.push(hermite(ys, k, h, (low + high) / 2))
    }
  }
  return found.filter((value) => !Number.isNaN(value))
}

/** The fractional step at which ascending `times` reach `time`. */
export function stepAt(times: Curve, time: number): number {
  const last = times.length - 1
  if (!(time > times[0])) return 0
  if (time >= times[last]) return last
  let low = 0
  let high = last
  while (high - low > 1) {
    const middle = (low + high) >> 1
    if (times[middle] <= time) low = middle
    else high = middle
  }
  return low + (time - times[low]) / (times[high] - times[low])
}

/** A curve with values that are rounding next to `scale`, the largest of its kind, set to zero. */
export function quiet(curve: Curve, scale: number): Curve {
  const largest = rounded(peak(curve), Math.max(scale, 1)) || Math.max(scale, 1)
  return curve.map((value) => rounded(value, largest))
}
