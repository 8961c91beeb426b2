import { describe, expect, test } from 'vitest'
import { kindOf } from '../src/glossary'
import type { Report } from '../src/report'
import { abscissaNamed, hasOneFreedom, onSideOf, sheetOf, sideOf } from '../src/sheet'
import { crank } from './mechanisms'

const STEPS = 41
const curve = (at: (t: number) => number) => Float32Array.from({ length: STEPS }, (_, k) => at(k / (STEPS - 1)))
const wave = (turns: number) => curve((t) => Math.sin(2 * Math.PI * turns * t))

type Measure = [name: string, values: Float32Array, unit?: string, group?: string, kind?: string]

/** A report of these measures, its drivers moving as the curves say. */
function reportOf(measures: Measure[], drivers: Float32Array[], changes: Partial<Report> = {}): Report {
  const [driver] = crank().drivers
  const quantities = measures.map(([name, values, unit = 'deg', group = 'measure', kind = 'position'], index) => ({
    ...{ index, name, group, kind, units: [unit, `${unit}/s`, `${unit}/s^2`] as const },
    curves: [values, values, values] as const,
    wanted: new Float32Array(),
  }))
  return crank({
    quantities,
    drivers: drivers.map((travel, k) => ({ ...driver, name: `driver_${k}`, travel, alone: [] })),
    times: curve((t) => t),
    ...changes,
  })
}

const names = (report: Report) =>
  sheetOf(report).plots.map(({ y, over }) => [
    ...y.map((index) => report.quantities[index].name),
    over === undefined ? 'time' : report.quantities[over].name,
  ])

describe('the sheet of a suspension', () => {
  const measures: Measure[] = [
    ['lca_angle', wave(1)],
    ['left.toe', wave(2)],
    ['left.camber', wave(3)],
    ['left.wheel_travel', wave(1), 'mm'],
    ['right.toe', wave(2)],
    ['right.wheel_travel', wave(1), 'mm'],
    ['left.roll_centre_height', wave(2), 'mm'],
  ]

  test('has toe, camber and roll centre of both sides over wheel travel, in that order', () => {
    expect(names(reportOf(measures, [wave(1)]))).toEqual([
      ['left.toe', 'right.toe', 'left.wheel_travel'],
      ['left.camber', 'left.wheel_travel'],
      ['left.roll_centre_height', 'left.wheel_travel'],
    ])
  })

  test('is drawn over time where several drivers move independently: over travel it would be loops', () => {
    const report = reportOf(measures, [wave(1), wave(0.5)])
    expect(hasOneFreedom(report)).toBe(false)
    expect(names(report).map((plot) => plot.at(-1))).toEqual(['time', 'time', 'time'])
    // Both wheels in bump are one motion.
    const bump = reportOf(measures, [wave(1), wave(1).map((z) => -2 * z + 3)])
    expect(hasOneFreedom(bump)).toBe(true)
    expect(names(bump)[0].at(-1)).toBe('left.wheel_travel')
  })

  test('is drawn over the force where forces alone move, in proportion', () => {
    const forces = (right: Float32Array): Measure[] => [
      ...measures.slice(0, 2),
      ['right.toe', wave(2)],
      ['left_side', curve((t) => 1000 * t), 'N', 'force', 'force'],
      ['right_side', right, 'N', 'force', 'force'],
    ]
    const report = reportOf(forces(curve((t) => -1000 * t)), [curve(() => 0)])
    expect(names(report)).toEqual([['left.toe', 'right.toe', 'left_side']])
    expect(onSideOf(report, 3, 2)).toBe(4)
    expect(names(reportOf(forces(wave(1)), [curve(() => 0)]))[0].at(-1)).toBe('time')
    expect(names(reportOf(forces(curve((t) => t)), [wave(1)]))[0].at(-1)).not.toBe('left_side')
  })

  test('keeps an abscissa by its name only where that moves', () => {
    const report = reportOf(measures, [wave(1)])
    expect(abscissaNamed(report, 'right.wheel_travel')).toBe(5)
    expect(abscissaNamed(report, undefined)).toBeUndefined()
    const still: Measure[] = [...measures.slice(0, 5), ['right.wheel_travel', curve(() => 0), 'mm']]
    expect(abscissaNamed(reportOf(still, [wave(1)]), 'right.wheel_travel')).toBe(3)
  })

  test('draws the curves of a side over the travel of that side', () => {
    const report = reportOf(measures, [wave(1)])
    expect(onSideOf(report, 3, 4)).toBe(5)
    expect(onSideOf(report, 3, 1)).toBe(3)
    const named = (name: string, kind = 'angle') => kindOf({ name, kind })
    expect([named('front.left.toe'), named('left_toe'), named('toe_left')]).toEqual(['toe', 'toe', 'toe_left'])
    // A measure of a wheel is what its type says, whatever its name.
    expect([named('vorspur', 'toe'), named('left.toe', 'camber')]).toEqual(['toe', 'camber'])
    expect([sideOf('front.left.toe'), sideOf('right_toe'), sideOf('toe')]).toEqual(['front.left', 'right', ''])
  })
})

describe('the sheet of a model file', () => {
  const measures: Measure[] = [
    ['left.toe', wave(2)],
    ['right.toe', wave(2)],
    ['left.wheel_travel', wave(1), 'mm'],
    ['held', curve(() => 4), 'mm'],
    ['P.x', wave(1), 'mm', 'point'],
    ['P.z', wave(2), 'mm', 'point'],
  ]
  const asked = (...plots: [y: number[], over: number | null][]) =>
    reportOf(measures, [wave(1)], { plots: plots.map(([y, over]) => ({ y, over })) })

  test('has its plots in its order, over time where it names no abscissa', () => {
    expect(names(asked([[1, 0], 2], [[4], null]))).toEqual([
      ['right.toe', 'left.toe', 'left.wheel_travel'],
      ['P.x', 'time'],
    ])
  })

  test('draws a coordinate of a point over another one as a path', () => {
    expect(sheetOf(asked([[5], 4], [[5], 2])).plots.map(({ path }) => path)).toEqual([true, undefined])
  })

  test('leaves out plots over a quantity at rest, and is that of the mechanism where none is left', () => {
    expect(names(asked([[0], 3], [[1], 2]))).toEqual([['right.toe', 'left.wheel_travel']])
    expect(names(asked([[0], 3]))).toEqual([['left.toe', 'right.toe', 'left.wheel_travel']])
  })
})

describe('the sheet of a linkage', () => {
  const turn = curve((t) => 360 * t)
  const point: Measure[] = [
    ['P.x', wave(1), 'mm', 'point'],
    ['P.y', wave(2), 'mm', 'point'],
    ['P.z', curve(() => 4), 'mm', 'point'],
  ]

  test('opens on what the driver does not prescribe, over the driver, with the path of its point', () => {
    const report = reportOf(
      [['crank_angle', turn], ['rocker_angle', wave(1)], ...point],
      [curve((t) => 2 * Math.PI * t)],
    )
    expect(names(report)).toEqual([
      ['rocker_angle', 'crank_angle'],
      ['P.y', 'P.x'],
    ])
    expect(sheetOf(report).plots[1].path).toBe(true)
  })

  test('begins with the transmission angle', () => {
    const measures: Measure[] = [
      ['crank_angle', turn],
      ['lever', wave(2)],
      ['transmission_angle', wave(1)],
    ]
    expect(names(reportOf(measures, [turn]))[0]).toEqual(['transmission_angle', 'crank_angle'])
  })

  test('is what the run requested', () => {
    const measures: Measure[] = [
      ['crank_angle', turn],
      ['lever', wave(2)],
      ['slide', wave(3), 'mm'],
    ]
    expect(names(reportOf(measures, [turn], { first: 2, over: 1 }))[0]).toEqual(['slide', 'lever'])
  })
})
