import { expect, test, vi } from 'vitest'
import { atLeast, between, inside, moved, seenRange, scaled, stepsWithin, within, Zoom } from '../src/zoom'

const curve = (...values: number[]) => Float32Array.from(values)

test('a drag to the left sees the same as one to the right', () => {
  expect(between(3, 1)).toEqual([1, 3])
  expect(between(1, 3)).toEqual([1, 3])
})

test('what is pointed at stays where it is when the part is scaled', () => {
  const [low, high] = scaled([0, 10], 0.5, 2)
  expect([low, high]).toEqual([1, 6])
  expect((2 - low) / (high - low)).toBe((2 - 0) / (10 - 0))
})

test('a part moves by a share of its width, and stops at the ends of the whole', () => {
  expect(moved([2, 4], 0.25)).toEqual([2.5, 4.5])
  expect(within([-1, 1], [0, 10])).toEqual([0, 2])
  expect(within([9, 12], [0, 10])).toEqual([7, 10])
  expect(within([3, 4], [0, 10])).toEqual([3, 4])
})

test('a part as wide as the whole is the whole; so is every part of a single moment', () => {
  expect(within([-5, 20], [0, 10])).toBeUndefined()
  expect(within([0, 10], [0, 10])).toBeUndefined()
  expect(within([5, 5], [5, 5])).toBeUndefined()
})

test('no part is narrower than a two hundredth', () => {
  expect(atLeast([4, 4], [0, 10])).toEqual([3.975, 4.025])
  expect(atLeast([4, 5], [0, 10])).toEqual([4, 5])
})

test('values within a part are those of its steps and those at its edges', () => {
  const seen = (values: Float32Array, abscissa: Float32Array, part: [number, number]) =>
    inside(values, abscissa, part).sort((a, b) => a - b)
  expect(seen(curve(0, 10, 0, -10), curve(0, 1, 2, 3), [0.5, 1.5])).toEqual([5, 5, 10])
  // Between two steps only the edges are left.
  expect(seen(curve(0, 10), curve(0, 1), [0.25, 0.5])).toEqual([2.5, 5])
  // An abscissa may come back.
  expect(seen(curve(0, 1, 5, 7), curve(0, 2, 2, 0), [1, 3])).toEqual([0.5, 1, 5, 6])
})

test('the vertical axis is that of what is seen; of everything where nothing is', () => {
  const [x, y] = [curve(0, 1, 2, 3), curve(1, 2, 50, NaN)]
  expect(seenRange([[y, x]], undefined)).toEqual([1, 50])
  expect(seenRange([[y, x]], [0, 1])).toEqual([1, 2])
  expect(seenRange([[y, x]], [2.5, 2.9])).toEqual([1, 50])
  expect(seenRange([[curve(-1, 2, 3, 4), x]], [0, 1], true)).toEqual([2, 2])
  expect(seenRange([[[null, 2, null, null], x]], [0.5, 1.5])).toEqual([2, 2])
  // Each curve has its own abscissa.
  expect(
    seenRange(
      [
        [y, x],
        [curve(7, 8), curve(0.5, 20)],
      ],
      [0, 1],
    ),
  ).toEqual([1, 7 + 0.5 / 19.5])
})

test('the steps of a part are those whose stretches are seen', () => {
  expect([...stepsWithin(curve(0, 1, 2, 3, 4), [1.2, 1.8])].sort()).toEqual([1, 2])
  expect([...stepsWithin(curve(0, 1, 0, -1), [0.5, 2])].sort()).toEqual([0, 1, 2])
})

test('all that show a part hear of it', () => {
  const zoom = new Zoom()
  const heard = [vi.fn(), vi.fn()]
  for (const one of heard) zoom.onChange(one)
  zoom.show([1, 2])
  expect(zoom.part).toEqual([1, 2])
  zoom.show(undefined)
  expect(zoom.part).toBeUndefined()
  for (const one of heard) expect(one).toHaveBeenCalledTimes(2)
})
