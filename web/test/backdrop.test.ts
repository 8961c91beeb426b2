import { expect, test } from 'vitest'
import { calibrated, fitted, type PictureMap, pixelOf, placeOf } from '../src/linkage/backdrop_map'
import type { Place } from '../src/linkage/linkage'

const map: PictureMap = { at: [3, -2], scale: 0.25, turn: 0.4 }
const free = { isOrigin: false, isHorizontal: false }
const close = (a: Place, b: Place) => expect(Math.hypot(a[0] - b[0], a[1] - b[1])).toBeLessThan(1e-12)

test('pixels and places correspond, and v points down', () => {
  close(pixelOf(map, placeOf(map, [17, 40])), [17, 40])
  close(placeOf({ at: [1, 1], scale: 2, turn: 0 }, [3, 4]), [7, -7])
})

test('a new picture is in the middle, as large as it fits', () => {
  const made = fitted([200, 100], [10, 5], [50, 50])
  close(placeOf(made, [0, 0]), [-15, 17.5])
  close(placeOf(made, [200, 100]), [35, -7.5])
})

test('two points get their distance; the first one stays, and so does the angle', () => {
  const [a, b]: Place[] = [placeOf(map, [10, 20]), placeOf(map, [40, 60])]
  const made = calibrated(map, [a, b], 125, free) as PictureMap
  // 50 pixels apart.
  expect(made.scale).toBeCloseTo(2.5, 12)
  expect(made.turn).toBe(map.turn)
  close(placeOf(made, [10, 20]), a)
  const [x, y] = placeOf(made, [40, 60])
  expect(Math.hypot(x - a[0], y - a[1])).toBeCloseTo(125, 10)
})

test('on request the first point is the origin, and the second is to its right', () => {
  const ends = [placeOf(map, [10, 20]), placeOf(map, [40, 60])] as const
  const made = calibrated(map, [ends[0], ends[1]], 125, { isOrigin: true, isHorizontal: true }) as PictureMap
  close(placeOf(made, [10, 20]), [0, 0])
  close(placeOf(made, [40, 60]), [125, 0])
})

test('one place for both points, or no distance, is refused with the reason', () => {
  expect(
    calibrated(
      map,
      [
        [0, 0],
        [0.1, 0],
      ],
      10,
      free,
    ),
  ).toMatch(/same place/)
  for (const distance of [0, -1, NaN])
    expect(
      calibrated(
        map,
        [
          [0, 0],
          [90, 0],
        ],
        distance,
        free,
      ),
    ).toMatch(/positive/)
})
