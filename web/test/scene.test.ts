import { BoxGeometry, Group, Mesh, OrthographicCamera, PerspectiveCamera, SphereGeometry, Vector3 } from 'three'
import { describe, expect, test } from 'vitest'
import type { Report } from '../src/report'
import { bounds, outermost } from '../src/scene/bounds'
import { fit } from '../src/scene/camera'
import { shownChange } from '../src/scene/draw/design_velocity'
import { foldAxis } from '../src/scene/hinge'
import { Mechanism } from '../src/scene/mechanism'
import { path, poseAt, shifted } from '../src/scene/poses'
import { READER, readerOf } from '../src/scene/reader'
import { Train } from '../src/scene/train'
import { crank } from './mechanisms'

const QUARTER = Math.SQRT1_2
/** At the origin, then at (2, 0, 0) and turned by 90° about z, then not solved. */
const poses = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 2, 0, 0, QUARTER, 0, 0, QUARTER, ...Array(7).fill(NaN)])

const close = (actual: Vector3, x: number, y: number, z: number) =>
  expect(actual.distanceTo(new Vector3(x, y, z))).toBeLessThan(1e-6)

test('a pose carries body points into the world', () => {
  close(path(poses, new Vector3(1, 0, 0))[1], 2, 1, 0)
})

test('a changed design shifts and turns a body in proportion', () => {
  const shifts = Float32Array.from([0, 0, 1, 0, 0, 0, 0, 0, 3, 0, 0, Math.PI / 4])
  close(shifted(poseAt(poses, 0)!, shifts, 0, 2).place, 0, 0, 2)
  const { place, turn } = shifted(poseAt(poses, 1)!, shifts, 1, 2)
  close(place, 2, 0, 6)
  // A quarter turn further than the pose's own.
  close(new Vector3(1, 0, 0).applyQuaternion(turn), -1, 0, 0)
  close(shifted(poseAt(poses, 0)!, shifts, 0.5, 1).place, 0, 0, 2)
})

test('between two steps the body is half way and half turned', () => {
  const { place, turn } = poseAt(poses, 0.5)!
  close(place, 1, 0, 0)
  close(new Vector3(1, 0, 0).applyQuaternion(turn), QUARTER, QUARTER, 0)
})

test('steps that were not solved have no pose and leave no path', () => {
  expect(poseAt(poses, 2)).toBeUndefined()
  expect(poseAt(poses, 1.5)).toBeUndefined()
  expect(path(poses, new Vector3())).toHaveLength(2)
})

test('few points bound a ball, but for 2 % of its radius', () => {
  const ball = new SphereGeometry(1, 200, 100)
  const few = bounds(new Mesh(ball))
  expect(few.length).toBeLessThanOrEqual(200)
  const places = ball.getAttribute('position')
  const ways = Array.from({ length: places.count }, (_, k) => new Vector3().fromBufferAttribute(places, k))
  expect(Math.min(...ways.map((way) => Math.max(...few.map((point) => point.dot(way)))))).toBeGreaterThan(0.98)
})

test('bounds stand where the object does, and keep every point of a few', () => {
  const object = new Group().add(new Mesh(new BoxGeometry(2, 2, 2)))
  object.position.set(10, 0, 0)
  object.children[0].scale.setScalar(2)
  expect(bounds(object)).toHaveLength(24)
  for (const { x, y } of bounds(object)) expect([Math.abs(x - 10), Math.abs(y)]).toEqual([2, 2])
  expect(outermost([new Vector3(1, 2, 3)])).toEqual([new Vector3(1, 2, 3)])
})

describe('the camera', () => {
  const points = [new Vector3(-50, -50, 3), new Vector3(200, 50, 3), new Vector3(20, 10, 700)]
  const directions = [new Vector3(0.75, -1, 0.55), new Vector3(1, 0, 1e-4), new Vector3(0, -1e-4, 1)].map((one) =>
    one.normalize(),
  )
  const size = 750

  test.each(directions)('sees the whole motion from %s, below the buttons', (direction) => {
    for (const camera of [new PerspectiveCamera(22), new OrthographicCamera()]) {
      for (const [width, height] of [
        [600, 1000],
        [1400, 1000],
      ]) {
        camera.up.set(0, 0, 1)
        camera.near = 0.02 * size
        camera.far = 60 * size
        fit(camera, points, size, { name: '', title: '', direction, parallel: false }, width, height)
        for (const point of points) {
          const seen = point.clone().project(camera)
          for (const side of seen.toArray()) expect(Math.abs(side)).toBeLessThan(1)
          expect(((1 - seen.y) / 2) * height).toBeGreaterThan(34)
        }
      }
    }
  })
})

describe('wheels of a pair', () => {
  const bodies = ['ground', 'carrier', 'sun', 'planet'].map((name) => ({ ...crank().bodies[0], name }))
  const hinge = (name: string, body_i: number, body_j: number, x = 0) => ({
    ...crank().joints[0],
    name,
    body_i,
    body_j,
    at_i: [x, 0, 0],
    at_j: [x, 0, 0],
  })
  const joints = [hinge('carrier', 1, 0), hinge('sun', 1, 2), hinge('planet', 3, 1, 60)] as Report['joints']
  const term = (joint: number, coefficient: number) => ({ joint, coefficient, turns: true })
  const coupler = (name: string, terms: ReturnType<typeof term>[]) => ({ name, kind: 'gear', terms, sizes: [20, 60] })
  const couplers = [
    coupler('inner', [term(1, 1), term(2, 1)]),
    coupler('ring', [term(2, 1), term(0, -3)]),
  ] as Report['couplers']

  test('of a planetary train are not fixed to the carrier, and the ring is fixed to ground', () => {
    const train = new Train(new Mechanism({ ...crank(), bodies, joints, couplers, drivers: [] }))
    const names = [0, 1].map((k) => train.pair(k)!.map(({ body }) => bodies[body].name))
    expect(names).toEqual([
      ['sun', 'planet'],
      ['planet', 'ground'],
    ])
  })

  // A planar train, where both pairs lie in one plane.
  const mechanism = new Mechanism({ ...crank(), bodies, joints, couplers, drivers: [] })

  test('are in front of the carrier nowhere', () => {
    const heights = bodies.map((_, body) => mechanism.layerOf(body))
    expect(mechanism.carriers).toEqual(new Set([1]))
    expect(heights[1]).toBeGreaterThan(Math.max(heights[2], heights[3]))
  })

  test('are known again by another coupler, by the direction that it counts from', () => {
    const train = new Train(mechanism)
    const [[, planet], [again]] = [train.pair(0)!, train.pair(1)!]
    const inwards = new Vector3(-1, 0, 0)
    expect(train.toothing(again, 20, 30, inwards)).toBeUndefined()
    train.tooth(planet, 20, 30, inwards, 0.1)
    expect(train.toothing(again, 20, 30, inwards)).toBeCloseTo(0.1)
    // A quarter turn about z on, the same tooth is a quarter turn back.
    expect(train.toothing(again, 20, 30, new Vector3(0, -1, 0))).toBeCloseTo(0.1 - Math.PI / 2)
    expect(train.toothing(again, 24, 30, inwards)).toBeUndefined()
    expect(train.toothing(again, 20, 36, inwards)).toBeUndefined()
  })
})

describe('the corner that a mechanism is seen from', () => {
  const size = 100
  const behind = (corner: Vector3) => [[new Vector3(), corner.clone().setLength(40), new Vector3(0, 0, 60)]]

  test('is the usual one where nothing is covered', () => {
    expect(readerOf([[new Vector3(), new Vector3(60, 0, 0), new Vector3(0, 0, 60)]], size)).toEqual(READER)
  })

  test('is another where one joint is before another', () => {
    const reader = readerOf(behind(READER), size)
    expect(reader.clone().normalize().dot(READER.clone().normalize())).toBeLessThan(0.9)
  })

  test('does not change for joints that are in one place from everywhere', () => {
    expect(readerOf([[new Vector3(), new Vector3(), new Vector3(0, 0, 60)]], size)).toEqual(READER)
  })

  test('shows the teeth of a wheel that has them on its face', () => {
    expect(readerOf([[]], size, [new Vector3(0, -1, 0)]).y).toBeGreaterThan(0)
  })
})

describe('a link', () => {
  const link = { ...crank().bodies[1], poses: crank().bodies[0].poses, roles: ['joint', 'joint'] as const }
  const pin = (body_i: number, body_j: number, x: number, axis: [number, number, number]) => ({
    ...crank().joints[0],
    body_i,
    body_j,
    at_i: [x, 0, 0],
    at_j: [x, 0, 0],
    axis,
    axis_j: axis,
  })
  const at = (...places: number[]) =>
    ({ ...link, skeleton: places.map((x) => [x, 0, 0]) }) as unknown as Report['bodies'][number]
  /** Two links in a row and a platform, hinged about y but for the last hinge, which makes it a mechanism in space. */
  const chain = (middle: [number, number, number]) => {
    const joints = [
      pin(0, 1, 0, [0, 1, 0]),
      pin(1, 2, 100, middle),
      pin(2, 3, 200, [0, 1, 0]),
      pin(3, 0, 300, [0, 0, 1]),
    ] as Report['joints']
    return new Mechanism({ ...crank(), bodies: [at(0), at(0, 100), at(100, 200), at(200, 300)], joints, drivers: [] })
  }

  test('between parallel hinges folds on another such link', () => {
    expect([1, 2, 3].map((body) => foldAxis(chain([0, 1, 0]), body)?.toArray())).toEqual([
      [0, 1, 0],
      [0, 1, 0],
      undefined,
    ])
  })

  test('between hinges across one another does not', () => {
    expect([1, 2, 3].map((body) => foldAxis(chain([0, 0, 1]), body))).toEqual([undefined, undefined, undefined])
  })
})

describe('arrows of a variable', () => {
  const arrow = (v: number, turn: number) => ({ body: 1, at: [200, 0, 0], v: [v, 0, 0], turn: [0, 0, turn] })
  const shown = (v: number, turn: number) =>
    shownChange(new Mechanism(crank()), { arrows: [arrow(v, turn)] } as unknown as Report['variables'][number])

  test('stand for no change where a turn leaves its place but for rounding', () => {
    expect(shown(1e-15, 1)).toBeUndefined()
    expect(shown(0, 0)).toBeUndefined()
  })

  test('are as long for a small move alone as for a large one', () => {
    expect(shown(1e-15, 0)! * 1e-15).toBeCloseTo(shown(1, 0)!)
    expect(shown(1, 1)).toBeCloseTo(shown(1, 0)!)
  })
})
