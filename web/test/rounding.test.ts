import { expect, test } from 'vitest'
import { quiet } from '../src/curve'
import { noise, rounded } from '../src/rounding'

test('a number is rounding relative to 1e9 times its size, or below the smallest number shown', () => {
  expect([rounded(2e-9), rounded(-1e-9), rounded(-2e-6, 1000), rounded(1e-6, 1000)]).toEqual([2e-9, 0, -2e-6, 0])
  expect(rounded(NaN)).toBeNaN()
})

test('a change is as good as none by the size of what changes', () => {
  expect([noise(-200), noise(0)]).toEqual([2e-3, 1e-9])
})

test('a curve loses its rounding, and all of itself where it is rounding next to others', () => {
  expect([...quiet(Float32Array.of(4, 3e-9, -1), 5)]).toEqual([4, 0, -1])
  expect([...quiet(Float32Array.of(4e-7, 3e-8, NaN), 1000)]).toEqual([0, 0, NaN])
  // It is small, but the only value.
  expect([...quiet(Float32Array.of(0.5, 0.25), 1)]).toEqual([0.5, 0.25])
})
