import { expect, test } from 'vitest'
import type { Curve, Payload, Variable } from '../src/payload'
import { derivativeName, derivativeUnit, groups, ranking, read } from '../src/report'
import { EMPTY } from './mechanisms'

const stored: Float32Array[] = []
const encode = (...values: number[]) => [stored.push(Float32Array.from(values)) - 1]
const decode = (curve: Curve) => (curve.length > 0 ? stored[curve[0]] : new Float32Array())
const curves = (scale: number) => ({ value: encode(scale, -2 * scale), rate: encode(0, 0), accel: encode(0, scale) })

const variable = (name: string, unit: string, scale?: number): Variable => ({
  name,
  unit,
  description: '',
  admissibility: scale === undefined ? 'cannot_follow' : 'admissible',
  note: '',
  arrows: [],
  typical: null,
  tolerance: null,
  bounds: null,
  shifts: [],
  sensitivities: scale === undefined ? [] : [{ quantity: 0, ...curves(scale), fd: null }],
})

const quantity = (name: string, group: string) => ({
  name,
  group,
  kind: 'angle',
  unit: 'deg',
  rate_unit: 'deg/s',
  accel_unit: 'deg/s^2',
  wanted: [],
  ...curves(1),
})

const payload: Payload = {
  ...EMPTY,
  times: encode(0, 1),
  quantities: [quantity('hub.x', 'point'), quantity('toe', 'measure')],
  margin: { value: encode(0.5, 0.25), note: '' },
  variables: [
    variable('small', 'mm', 1),
    variable('tilt', 'deg', 5),
    variable('large', 'mm', -4),
    variable('stuck', 'mm'),
  ],
}
const report = read(payload, decode)
const [hub] = report.quantities

test('variables are ranked by their largest magnitude within one unit', () => {
  const ranks = ranking(report, hub, 0)
  expect([...ranks.keys()]).toEqual(['mm', 'deg'])
  expect(ranks.get('mm')!.map(({ variable, peak, share }) => [variable.name, peak, share])).toEqual([
    ['large', 8, 1],
    ['small', 2, 0.25],
  ])
})

test('where nothing has an influence no share is given', () => {
  expect(
    ranking(report, hub, 1)
      .get('mm')!
      .map(({ share }) => share),
  ).toEqual([0, 0])
})

test('a variable by which there is no derivative is not ranked', () => {
  const variables = [variable('known', 'mm', 1), variable('unknown', 'mm', NaN)]
  const ranks = ranking(read({ ...payload, variables }, decode), hub, 0)
  expect([...ranks.values()].flat().map(({ variable }) => variable.name)).toEqual(['known'])
})

test('measures are offered before other quantities', () => {
  expect(groups(report).map(([name]) => name)).toEqual(['measure', 'point'])
})

test('derivatives are named and measured by what they divide', () => {
  expect(derivativeName(hub, 1, report.variables[0])).toBe('d hub.x velocity / d small')
  expect(derivativeUnit(hub, 1, report.variables[0])).toBe('deg/(s·mm)')
})

test('the margin is decoded, and may be missing', () => {
  expect([...report.margin!.curve]).toEqual([0.5, 0.25])
  expect(read({ ...payload, margin: null }, decode).margin).toBeUndefined()
})

test('curves of sensitivities and shifts are decoded once, and not before they are requested', () => {
  const asked: number[] = []
  const counted = (curve: Curve) => (asked.push(...curve), decode(curve))
  const moving = { ...variable('moving', 'mm', 3), shifts: [encode(1, 2, 3, 4, 5, 6)] }
  const { variables } = read({ ...payload, variables: [moving] }, counted)
  const [sensitivity, shifts] = [moving.sensitivities[0].value[0], moving.shifts[0][0]]
  expect(asked).not.toContain(sensitivity)
  expect(asked).not.toContain(shifts)
  const { shifts: found, sensitivities } = variables[0]
  expect([...found[0], ...sensitivities.get(0)!.peaks, ...variables[0].shifts[0]]).toEqual([
    1, 2, 3, 4, 5, 6, 6, 0, 3, 1, 2, 3, 4, 5, 6,
  ])
  expect(asked.filter((track) => track === shifts || track === sensitivity).sort()).toEqual(
    [sensitivity, shifts].sort(),
  )
})
