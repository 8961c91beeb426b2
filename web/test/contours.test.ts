import { expect, test } from 'vitest'
import { areas, levels, valueAt } from '../src/maps/contours'

const columns = [-2, -1, 0, 3]
const rows = [0, 10, 30]
/** A plane: linear everywhere, however uneven the places are. */
const plane = { columns, rows, values: rows.flatMap((y) => columns.map((x) => 2 * x + 0.5 * y + 1)) }

test('levels are round numbers between the least value and the greatest', () => {
  expect(levels([-0.97, 1.1])).toEqual([-0.5, 0, 0.5, 1])
  expect(levels([0, 8])).toEqual([1, 2, 3, 4, 5, 6, 7])
  expect(levels([3, 3, NaN])).toEqual([])
  expect(levels([NaN])).toEqual([])
})

test('lines of a plane are straight, and where the plane has their level', () => {
  const found = areas(plane, [5])
  expect(found).toHaveLength(1)
  const inner = found[0].outlines.flat().filter(([x, y]) => x > -2 + 1e-9 && x < 3 - 1e-9 && y > 1e-9 && y < 30 - 1e-9)
  expect(inner.length).toBeGreaterThan(1)
  for (const [x, y] of inner) expect(2 * x + 0.5 * y + 1).toBeCloseTo(5, 9)
})

test('a value between places is linear, and unknown beyond and beside gaps', () => {
  expect(valueAt(plane, 1.7, 12)).toBeCloseTo(2 * 1.7 + 0.5 * 12 + 1, 12)
  expect(valueAt(plane, 3, 30)).toBeCloseTo(22, 12)
  expect(valueAt(plane, 3.1, 12)).toBeNaN()
  const gap = { ...plane, values: plane.values.map((value, k) => (k === 5 ? NaN : value)) }
  expect(valueAt(gap, -1, 10)).toBeNaN()
  expect(valueAt(gap, -1.5, 3)).toBeNaN()
  // A known point does not depend on its neighbours.
  expect(valueAt(gap, -2, 10)).toBeCloseTo(2, 12)
  expect(valueAt(gap, 3, 30)).toBeCloseTo(22, 12)
})
