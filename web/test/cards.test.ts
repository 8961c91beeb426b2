import { expect, test } from 'vitest'
import { endText, isMissed, placesOf } from '../src/page/cards'

test('a value on its limit to the accuracy of a search meets it', () => {
  expect(isMissed(0.05 * (1 + 1e-9), [null, 0.05])).toBe(false)
  expect(isMissed(1200 - 1e-6, [1200, 1300])).toBe(false)
  expect(isMissed(1e-12, [null, 0])).toBe(false)
  expect(isMissed(0.05 * (1 + 1e-6), [null, 0.05])).toBe(true)
  expect(isMissed(1200 - 1e-4, [1200, 1300])).toBe(true)
})

test('a value on its limit is at the end of its band, not a bar of rounding errors apart', () => {
  const { from, to, tick } = placesOf([null, 0.05], 0.05 * (1 + 1e-9))
  expect(from).toBe(0)
  expect(tick - to).toBeGreaterThan(0)
  expect(tick - to).toBeLessThan(1e-4)
  // Numbers that differ on the card are apart.
  const apart = placesOf([null, 0.05], 0.06)
  expect(apart.tick - apart.to).toBeGreaterThan(0.5)
  expect(placesOf([-1, 1], 0)).toEqual({ from: 0.35 / 1.7, to: 1.35 / 1.7, tick: 0.5 })
  expect(placesOf([0, 0], null).tick).toBe(-0.1)
})

test('an end of a range that is a rest of the interpolation is zero', () => {
  expect(endText(-8e-5, undefined, 20)).toBe('0')
  expect(endText(-8e-5, -7e-5, 20)).toBe('0')
  expect(endText(-0.08, 0.02, 20)).toBe('−0.08 (−0.1)')
})
