import { expect, test } from 'vitest'
import { along, nearest } from '../src/sweep/nearest'

test('designs that are not known on both axes are left out, and the others follow the first', () => {
  expect(along([3, NaN, 1, 2, 1], [1, 1, NaN, 5, 4])).toEqual([4, 3, 0])
})

test('what is nearest is pointed at, and nothing beyond reach', () => {
  const at = (k: number): [number, number] => [10 * k, 0]
  expect(nearest([0, 1, 2], at, [12, 3], 24)).toBe(1)
  expect(nearest([0, 2], at, [12, 3], 24)).toBe(2)
  expect(nearest([0, 1], at, [100, 0], 24)).toBeUndefined()
})
