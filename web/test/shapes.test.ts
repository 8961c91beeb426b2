import { Vector3 } from 'three'
import { describe, expect, test } from 'vitest'
import type { Flat } from '../src/scene/flat'
import { beltPath } from '../src/scene/shapes/belt'
import { bevelCorners, bevelPair } from '../src/scene/shapes/bevel'
import { camProfile, grooveOutline, leastCurvature, rollerRadius } from '../src/scene/shapes/cam'
import { Helix } from '../src/scene/shapes/helix'
import { drawnTeeth, gearOutline, rackOutline, toothHeight } from '../src/scene/shapes/toothing'

const radius = ([x, y]: Flat) => Math.hypot(x, y)
const circle = (r: number, count = 360): Flat[] =>
  Array.from({ length: count }, (_, k) => [
    r * Math.cos((2 * Math.PI * k) / count),
    r * Math.sin((2 * Math.PI * k) / count),
  ])

/** True if a point is inside an outline. */
function inside([x, y]: Flat, outline: Flat[]): boolean {
  return outline.reduce((odd, [ax, ay], k) => {
    const [bx, by] = outline[(k + 1) % outline.length]
    return ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax) ? !odd : odd
  }, false)
}

describe('gears', () => {
  test('tips and roots are half a tooth from the pitch circle', () => {
    const half = toothHeight(20, 30) / 2
    const radii = gearOutline(20, 30, 2 * half).map(radius)
    expect(Math.max(...radii)).toBeCloseTo(30 + half)
    expect(Math.min(...radii)).toBeCloseTo(30 - half)
  })

  test.each([
    [20, 80, 20, 80],
    [20, 160, 12, 96],
    [80, 160, 12, 24],
    [15, 45, 15, 45],
    [1, 1, 12, 12],
    [3, 1, 36, 12],
    [7, 400, 12, 686],
  ])('%i and %i teeth are drawn as %i and %i', (a, b, x, y) => {
    expect(drawnTeeth([a, b])).toEqual([x, y])
  })

  test('teeth mesh while they turn: no tip is inside the other gear', () => {
    const [n, m, r] = [12, 36, 10]
    const apart = 4 * r
    const height = toothHeight(n, r)
    for (let turn = 0; turn < 0.6; turn += 0.05) {
      const a = gearOutline(n, r, height, turn)
      // A gap faces the other's tooth, at the angle π.
      const b = gearOutline(m, 3 * r, height, Math.PI + Math.PI / m - (turn * n) / m).map(
        ([x, y]): Flat => [x + apart, y],
      )
      const tips = (outline: Flat[], about: number, limit: number) =>
        outline.filter(([x, y]) => Math.hypot(x - about, y) > limit)
      for (const tip of tips(a, 0, r)) expect(inside(tip, b)).toBe(false)
      for (const tip of tips(b, apart, 3 * r)) expect(inside(tip, a)).toBe(false)
    }
  })

  test('a rack has the gear teeth of its pitch, with a gap at the origin', () => {
    const rack = rackOutline(2, -9, 9, 1, 3)
    expect(inside([0, 0], rack)).toBe(false)
    expect(inside([1, 0], rack)).toBe(true)
    expect(inside([-7, 0.4], rack)).toBe(true)
    expect(Math.min(...rack.map(([, y]) => y))).toBe(-3)
  })
})

describe('bevels', () => {
  const z = { at: new Vector3(150, 60, 300), axis: new Vector3(0, 0, 1), coefficient: 15 }
  const x = { at: new Vector3(100, 60, 250), axis: new Vector3(1, 0, 0), coefficient: 45 }

  test('cones meet at the crossing of the axes and have the ratio of the teeth', () => {
    const pair = bevelPair(z, x)!
    expect(pair.tip.distanceTo(new Vector3(150, 60, 250))).toBeLessThan(1e-9)
    expect(pair.gears[1].radius / pair.gears[0].radius).toBeCloseTo(3)
  })

  test('where they touch both have one velocity', () => {
    const { line } = bevelPair(z, x)!
    const speed = z.axis.clone().multiplyScalar(x.coefficient).cross(line)
    expect(speed.distanceTo(x.axis.clone().multiplyScalar(-z.coefficient).cross(line))).toBeLessThan(1e-9)
  })

  test('the larger gear is on the side of its joint, within it', () => {
    const { gears } = bevelPair(z, x)!
    expect(gears[1].axis.x).toBeCloseTo(-1)
    expect(gears[1].distance).toBeLessThan(50)
    expect(gears[1].radius).toBeLessThan(50)
  })

  test('parallel shafts have none', () => {
    expect(bevelPair(z, { ...z, at: x.at })).toBeUndefined()
  })

  test('all corners are finite, the widest at the rim', () => {
    const { tip, gears, line } = bevelPair(z, x)!
    const corners = bevelCorners(tip, gears[1], line, 45, 2, 0, 10)
    expect(corners.length % 3).toBe(0)
    const widest = Math.max(...corners.map((corner) => Math.hypot(corner.y - tip.y, corner.z - tip.z)))
    expect(widest).toBeCloseTo(gears[1].radius + 1)
  })
})

describe('belts', () => {
  const along = (points: Flat[]) =>
    points.reduce((sum, a, k) => {
      const b = points[(k + 1) % points.length]
      return sum + Math.hypot(a[0] - b[0], a[1] - b[1])
    }, 0)

  test('between equal pulleys it is a circumference and twice the distance', () => {
    expect(beltPath(40, 40, 150)!.length).toBeCloseTo(2 * Math.PI * 40 + 300)
  })

  test.each([false, true])('its points have its length, crossed: %s', (crossed) => {
    const { points, length } = beltPath(40, 60, 150, crossed)!
    expect(along(points) / length).toBeCloseTo(1, 3)
  })

  test('a crossed belt is 2 sqrt(d² - (a+b)²) + (a+b)(π + 2 asin((a+b)/d))', () => {
    const [sum, distance] = [50, 150]
    const expected = 2 * Math.sqrt(distance ** 2 - sum ** 2) + sum * (Math.PI + 2 * Math.asin(sum / distance))
    expect(beltPath(20, 30, distance, true)!.length).toBeCloseTo(expected)
  })

  test('pulleys within one another have none', () => {
    expect(beltPath(40, 200, 100)).toBeUndefined()
    expect(beltPath(40, 60, 100, true)).toBeUndefined()
  })
})

describe('cams', () => {
  test.each([circle(50), circle(50).reverse()])(
    'the profile of a round cam is the roller within its pitch curve',
    (...pitch) => {
      for (const point of camProfile(pitch, 8)) expect(radius(point)).toBeCloseTo(42, 2)
    },
  )

  test('the least radius of curvature of an ellipse is b²/a', () => {
    const ellipse = circle(1, 2000).map(([x, y]): Flat => [30 * x, 20 * y])
    expect(leastCurvature(ellipse, true)).toBeCloseTo(400 / 30, 2)
    expect(rollerRadius(ellipse, true, 100)).toBeCloseTo((0.4 * 400) / 30, 2)
    expect(rollerRadius(ellipse, true, 2)).toBe(2)
  })

  test('a straight curve bends nowhere', () => {
    expect(
      leastCurvature(
        [
          [0, 0],
          [1, 0],
          [2, 0],
        ],
        false,
      ),
    ).toBe(Infinity)
  })

  test('a groove reaches its half width all round its curve', () => {
    const groove = grooveOutline(
      [
        [0, 0],
        [10, 0],
        [20, 0],
      ],
      2,
    )
    for (const point of [
      [10, 1.9],
      [10, -1.9],
      [21.8, 0],
      [-1.8, 0],
    ] as Flat[])
      expect(inside(point, groove)).toBe(true)
    for (const point of [
      [10, 2.1],
      [22.2, 0],
      [-2.2, 0],
    ] as Flat[])
      expect(inside(point, groove)).toBe(false)
  })
})

test('a helix keeps its radius and climbs evenly', () => {
  const helix = new Helix(3, 12, 6)
  const point = helix.getPoint(0.25)
  expect(point.y).toBeCloseTo(3)
  expect(Math.hypot(point.x, point.z)).toBeCloseTo(3)
})
