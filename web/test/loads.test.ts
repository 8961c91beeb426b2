import { Box3, Group, Vector3 } from 'three'
import { expect, test } from 'vitest'
import { forceAt, largestAt, largestForce, pathOf, planeAcross } from '../src/loads/force'
import type { Load } from '../src/report'
import { loads } from '../src/scene/draw/load'
import { Kit } from '../src/scene/kit'
import { Mechanism } from '../src/scene/mechanism'
import { CHOICE, crank, PALETTE } from './mechanisms'

/**
 * 30 N to the right all the time on the crank, which makes a quarter of a turn per step; 10 N down on its pin at the
 * third step only.
 */
const steady = Float32Array.from(Array.from({ length: 5 }, () => [30, 0, 0]).flat())
const brief = Float32Array.from([0, 0, 0, 0, 0, 0, 0, -10, 0, NaN, NaN, NaN, NaN, NaN, NaN])
const LOADS: Load[] = [
  { name: 'hinge', joint: 0, at: { body: 1, at: [0, 0, 0] }, force: steady, is_part: false },
  { name: 'push', joint: null, at: { body: 1, at: [200, 0, 0] }, force: brief, is_part: false },
]

test('a force that is goes round as the body sees it, the other way', () => {
  const plane = planeAcross(new Vector3(0, 0, 1))
  expect(plane.names).toEqual(['x', 'y'])
  const seen = pathOf(steady, crank().bodies[1].poses, plane, 1)
  const expected = [
    [30, 0],
    [0, -30],
    [-30, 0],
    [0, 30],
    [30, 0],
  ]
  seen.forEach(([x, y], k) => {
    expect(x).toBeCloseTo(expected[k][0], 4)
    expect(y).toBeCloseTo(expected[k][1], 4)
  })
  // It comes from ground; the force of the crank on ground is opposite.
  for (const [x, y] of pathOf(steady, crank().bodies[0].poses, plane, -1)) expect([x, y]).toEqual([-30, 0])
})

test.each([
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, -1],
  [1, 2, 3],
  [-3, 1, 0.5],
])('a plane across %d %d %d is right-handed and square', (...normal) => {
  const n = new Vector3(...(normal as [number, number, number])).normalize()
  const [u, v] = planeAcross(n).across
  expect(u.clone().cross(v).distanceTo(n)).toBeLessThan(1e-12)
  expect(Math.abs(u.dot(n)) + Math.abs(v.dot(n))).toBeLessThan(1e-12)
})

test('between two steps a force lies between, and it is largest where it is', () => {
  expect(forceAt(brief, 1.5).y).toBe(-5)
  expect(forceAt(brief, 2).toArray()).toEqual([0, -10, 0])
  expect(forceAt(brief, 3).x).toBeNaN()
  expect(largestForce(LOADS)).toBe(30)
  expect([largestForce([LOADS[1]]), largestAt(brief)]).toEqual([10, 2])
})

/** The boxes round the arrows of forces at a step; nothing where one is hidden. */
function boxes(mechanism: Mechanism, step: number): (Box3 | undefined)[] {
  const kit = new Kit(mechanism, PALETTE)
  return loads(mechanism, kit, CHOICE).map(({ object, follow }) => {
    follow!(mechanism.frame(step))
    const arrow = object.children[0]
    const group = new Group().add(object)
    group.updateMatrixWorld(true)
    return arrow.visible ? new Box3().setFromObject(group) : undefined
  })
}

/** Digits that agree: boxes are of corners in `f32`, and some hundred units large. */
const DRAWN = 3

test('arrows begin where forces act, point along them, and are in proportion', () => {
  const mechanism = new Mechanism(crank({ loads: LOADS }))
  const lengths = [0, 2].map((step) => boxes(mechanism, step))
  const [hinge] = lengths[0]
  const long = hinge!.max.x
  expect(long).toBeGreaterThan(10 * mechanism.unit)
  expect(hinge!.min.x).toBeCloseTo(0, DRAWN)
  // No push yet: no arrow; later one from the pin, which then is at -200, a third as long, downwards.
  expect(lengths[0][1]).toBeUndefined()
  const push = lengths[1][1]!
  expect((push.min.x + push.max.x) / 2).toBeCloseTo(-200, DRAWN)
  expect(push.max.y).toBeCloseTo(0, DRAWN)
  expect(-push.min.y).toBeCloseTo(long / 3, DRAWN)
  // Where nothing is known there is nothing.
  expect(boxes(mechanism, 4)[1]).toBeUndefined()
  expect(loads(mechanism, new Kit(mechanism, PALETTE), { ...CHOICE, forces: false })).toEqual([])
})
