import { expect, test } from 'vitest'
import {
  atFixedAbscissa,
  courseRange,
  decades,
  nearestStep,
  peak,
  positive,
  slope,
  slopeAlone,
  spread,
  stepAt,
  valueAt,
  withGaps,
} from '../src/curve'

const curve = (...values: number[]) => Float32Array.from(values)

test('NaN becomes a gap', () => {
  expect(withGaps(curve(NaN, 1))).toEqual([null, 1])
})

test('peak is the largest magnitude and passes over gaps', () => {
  expect(peak(curve(1, NaN, -3))).toBe(3)
  expect(peak(curve(NaN))).toBe(0)
})

test('values of every few steps are put in their places', () => {
  expect([...spread(curve(7, 8), 3, 5)]).toEqual([7, NaN, NaN, 8, NaN])
  expect(spread(curve(), 3, 5).length).toBe(0)
})

test('values between steps are interpolated', () => {
  expect(valueAt(curve(2, 4), 0.25)).toBe(2.5)
  expect(valueAt(curve(2, 4), 1)).toBe(4)
})

test('a gap does not reach the step before it', () => {
  expect(valueAt(curve(2, NaN), 0)).toBe(2)
  expect(valueAt(curve(2, NaN), 0.5)).toBeNaN()
})

test('time and step are inverse to each other on uneven steps', () => {
  const times = curve(0, 1, 4, 5)
  for (const step of [0, 0.5, 1, 1.75, 3]) expect(stepAt(times, valueAt(times, step))).toBe(step)
  expect(stepAt(times, -1)).toBe(0)
  expect(stepAt(times, 9)).toBe(3)
})

test('a logarithmic axis runs from a power of ten to another', () => {
  expect(decades(0.02, 0.4)).toEqual([0.01, 1])
  expect(decades(1, 1)).toEqual([0.1, 1])
  expect(decades(null, null)).toEqual([0.1, 1])
})

test('what is not positive is left out of a logarithmic curve', () => {
  expect(positive(Float32Array.of(1, 0, NaN, 0.5))).toEqual([1, null, null, 0.5])
})

test('a slope over an abscissa that turns back follows from the accelerations there', () => {
  // x = sin t, y = sin^2 t: the slope is 2 x, also where x turns.
  const times = [0, Math.PI / 6, Math.PI / 2, Math.PI]
  const of = (f: (t: number) => number) => Float32Array.from(times, f)
  const x = [of(Math.sin), of(Math.cos), of((t) => -Math.sin(t))] as const
  const y = [of((t) => Math.sin(t) ** 2), of((t) => Math.sin(2 * t)), of((t) => 2 * Math.cos(2 * t))] as const
  const found = slope(y, x)
  times.forEach((t, k) => expect(found[k]).toBeCloseTo(2 * Math.sin(t), 5))
  // Where x rests and y does not, there is none.
  expect(slope(y, [of(() => 1), of(() => 0), of(() => 0)])[1]).toBeNaN()
})

test('what a driver does alone stays finite where the motion of several turns the abscissa back', () => {
  // x = a + b, y = 2 a + 3 b with a = t, b = 1 - t^2: along the motion dy/dx = (2 - 6 t) / (1 - 2 t), of the first
  // driver alone 2.
  const [y, x] = [Float32Array.of(2, 2, 2), Float32Array.of(1, 1, 1e-6)]
  expect([...slopeAlone(y, x)]).toEqual([2, 2, NaN])
})

test('where the abscissa is about to turn and the other goes on, there is a gap in place of a spike', () => {
  // x = sin t, y = t: the slope 1 / cos t grows beyond all bounds.
  const times = Array.from({ length: 200 }, (_, k) => k * 0.016)
  const of = (f: (t: number) => number) => Float32Array.from(times, f)
  const found = slope([of((t) => t), of(() => 1), of(() => 0)], [of(Math.sin), of(Math.cos), of((t) => -Math.sin(t))])
  times.forEach((t, k) => {
    if (Math.abs(Math.cos(t)) < 0.25) expect(found[k]).toBeNaN()
    else expect(found[k] * Math.cos(t)).toBeCloseTo(1, 5)
  })
})

test('a sensitivity at a fixed abscissa leaves out what the abscissa moves', () => {
  // y = (x - b)^2 and x = t + b: at fixed t nothing depends on b, at fixed x dy/db = -2 (x - b).
  expect([...atFixedAbscissa(curve(0, 0), curve(1, 1), curve(0, 4))]).toEqual([0, -4])
  // Feed and spindle turn further together: what is left is rounding.
  expect([...atFixedAbscissa(curve(0, 2, 2), curve(0, 4, 1), curve(0.5, 0.5 + 1e-8, 0.5))]).toEqual([0, 0, 1.5])
})

test('the nearest step prefers the branch that is shown', () => {
  const there = curve(0, 1, 2, 1, 0)
  expect(nearestStep(there, 1, 0)).toBe(1)
  expect(nearestStep(there, 1, 4)).toBe(3)
})

test('the range of a course has the extrema between its steps', () => {
  const times = curve(...Array.from({ length: 9 }, (_, k) => (k * 6) / 8))
  const [value, rate] = [(t: number) => Math.sin(t + 0.2), (t: number) => Math.cos(t + 0.2)]
  const smooth = [times.map(value), times.map(rate), times.map((t) => -value(t))]
  const near = (range: [number, number] | undefined, digits: number) => {
    expect(range![0]).toBeCloseTo(-1, digits)
    expect(range![1]).toBeCloseTo(1, digits)
  }
  near(courseRange(smooth, times), 4)
  near(courseRange(smooth.slice(0, 2), times), 2)
  expect(courseRange(smooth.slice(0, 1), times)).toEqual([Math.min(...smooth[0]), Math.max(...smooth[0])])
  expect(courseRange([curve()], times)).toBe(undefined)
  expect(courseRange([curve(NaN, 2, 1), curve(NaN, 0, -1)], times)).toEqual([1, 2])
})

test('a kink at a step does not add to the range of a course', () => {
  const times = curve(0, 1, 2, 3)
  for (const rates of [curve(1, 1, 0, 0), curve(1, 0, 0, 0)])
    expect(courseRange([curve(0, 1, 1, 1), rates, curve(0, 0, 0, 0)], times)).toEqual([0, 1])
})
