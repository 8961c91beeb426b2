import { readFileSync } from 'node:fs'
import { join } from 'node:path'
import { expect, test } from 'vitest'
import { unpack } from '../src/unpack'

// Written by the tests of `crates/hardpoint-report/src/encoding.rs`.
const { payload, decode } = await unpack(readFileSync(join(import.meta.dirname, 'packed.txt'), 'utf8'))
const steps = Array.from({ length: 40 }, (_, k) => k)

test('the block holds the payload', () => {
  expect(payload.title).toBe('packed')
})

test('what is computed with comes back to the bit', () => {
  expect([...decode(payload.times)]).toEqual(steps.map((k) => Math.fround(0.1 * k)))
})

test('numbers of one step stand together', () => {
  const poses = decode(payload.bodies[0].poses)
  expect([...poses.slice(7, 14)]).toEqual([1, 0, 0, 1, 0, 0, 0])
})

test('gaps stay gaps, and what is around them keeps its place', () => {
  const margin = decode(payload.margin!.value)
  expect([...margin]).toEqual(steps.map((k) => (k === 3 || k === 4 ? NaN : Math.fround(Math.sin(0.1 * k)))))
})

test('what is drawn comes back to 1e-5 of its range', () => {
  const [{ value, rate, accel }] = payload.variables[0].sensitivities
  decode(value).forEach((found, k) => expect(Math.abs(found - Math.cos(0.1 * k))).toBeLessThan(2e-5))
  expect([...decode(rate)]).toEqual(steps.map(() => NaN))
  expect(decode(accel).length).toBe(0)
})
