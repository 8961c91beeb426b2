import { Box3, type BufferGeometry, type EventDispatcher, type Mesh, type Object3D, Vector3 } from 'three'
import { describe, expect, inject, test, vi } from 'vitest'
import { Assembly } from '../src/scene/assembly'
import { cameraFor, fit, looksOf } from '../src/scene/camera'
import { marks, matter } from '../src/scene/draw'
import type { Drawable, Part } from '../src/scene/drawable'
import { Kit } from '../src/scene/kit'
import { Mechanism } from '../src/scene/mechanism'
import { Outlines } from '../src/scene/outlines'
import { paletteOf } from '../src/scene/palette'
import { Stock } from '../src/scene/stock'
import { State } from '../src/state'
import { reportOf } from './payload'
import { schemes } from './schemes'

const { models } = inject('samples')

const LIGHT = paletteOf((name) => schemes.light[name])
/** Pixels of a view. */
const [WIDTH, HEIGHT] = [860, 600]

// A hatch is painted on a canvas, which Node does not have; only geometry is counted here.
const brush = new Proxy({}, { get: () => () => undefined })
vi.stubGlobal('document', { createElement: () => ({ getContext: () => brush }) })

/** Everything that is drawn of a model as it opens. */
async function drawing(address: string): Promise<{ mechanism: Mechanism; kit: Kit; drawn: Drawable[] }> {
  const report = await reportOf(address)
  const mechanism = new Mechanism(report)
  const kit = new Kit(mechanism, LIGHT)
  return {
    mechanism,
    kit,
    drawn: [...matter, ...marks].flatMap((draw) => draw(mechanism, kit, new State(report).choice)),
  }
}

/** Vertices of an object at its pose. */
function vertices(object: Object3D): Vector3[] {
  object.updateMatrixWorld(true)
  const found: Vector3[] = []
  object.traverse((one) => {
    const { geometry } = one as { geometry?: BufferGeometry }
    const { position, instanceStart, instanceEnd } = geometry?.attributes ?? {}
    // Of a wide line the positions are those of a stretch that is laid from place to place.
    for (const places of instanceStart ? [instanceStart, instanceEnd] : [position]) {
      for (let k = 0; k < (places?.count ?? 0); k++)
        found.push(new Vector3().fromBufferAttribute(places, k).applyMatrix4(one.matrixWorld))
    }
  })
  return found
}

/** Geometries and materials of what is drawn, by what they are of. */
function held(drawn: Drawable[]): Map<EventDispatcher<{ dispose: object }>, string> {
  const found = new Map<EventDispatcher<{ dispose: object }>, string>()
  for (const { object, part } of drawn)
    object.traverse((one) => {
      const { geometry, material } = one as Partial<Mesh>
      for (const held of [geometry, material].flat()) if (held) found.set(held, `${held.type} of ${part.name}`)
    })
  return found
}

describe.each(Object.entries(models))('of %s', async (_, address) => {
  const { mechanism, kit, drawn } = await drawing(address)
  const { report } = mechanism
  const count = (kind: Part['kind'], index: number) =>
    drawn.filter(({ part }) => part.kind === kind && part.index === index).length

  test('every body, joint, coupler, driver and wheel is drawn', () => {
    const missing = (kind: Part['kind'], list: { name: string }[]) =>
      list.filter((_, index) => count(kind, index) === 0).map(({ name }) => `${kind} ${name}`)
    // A slider is the block of its joint, a cam the plate of its curve: parts fixed to such a body represent it.
    const bodies = report.bodies.filter((_, index) => !drawn.some(({ body }) => body === index))
    // A linear relation has no look, and that of a screw is its joint's.
    const seen = report.couplers.filter(({ kind }) => kind !== 'linear' && kind !== 'screw').map(({ name }) => name)
    expect([
      ...bodies.map(({ name }) => `body ${name}`),
      ...missing('joint', report.joints),
      ...missing('coupler', report.couplers).filter((coupler) => seen.some((name) => coupler === `coupler ${name}`)),
      ...missing('driver', report.drivers),
      ...missing('wheel', report.wheels),
    ]).toEqual([])
  })

  test('everything drawn has a name and says what it is', () => {
    for (const { part } of drawn) {
      expect(part.name, part.kind).not.toBe('')
      expect(part.about, part.name).not.toBe('')
    }
  })

  test('everything stays finite and near the mechanism at every moment', () => {
    // Four times the mechanism's own size round its middle: wheels, arrows and rails reach beyond hardpoints, but not
    // far.
    const room = new Box3().setFromCenterAndSize(mechanism.centre, new Vector3(4, 4, 4).multiplyScalar(mechanism.size))
    for (const { object, part } of drawn) {
      const points = vertices(object)
      expect(
        points.every(({ x, y, z }) => Number.isFinite(x + y + z)),
        part.name,
      ).toBe(true)
    }
    for (const step of [0, Math.floor(report.times.length / 3), report.times.length - 1]) {
      const frame = mechanism.frame(step)
      for (const { object, part, body, follow } of drawn) {
        follow?.(frame)
        if (!object.visible || (body !== undefined && !frame.visible(body))) continue
        const outside = vertices(object).find(
          (point) => !room.containsPoint(body === undefined ? point : frame.at(body, point)),
        )
        expect(outside, `${part.kind} ${part.name} at step ${step}`).toBeUndefined()
      }
    }
  })

  test('two bodies that a joint joins have two colours, and what is fixed has its own', () => {
    expect(mechanism.colourOf(0)).toBe(-1)
    for (const { name, body_i, body_j } of report.joints)
      expect(mechanism.colourOf(body_i), name).not.toBe(mechanism.colourOf(body_j))
  })

  test('glyphs are no larger than the grammar allows', () => {
    expect(mechanism.unit).toBeGreaterThanOrEqual(0.0012 * mechanism.size)
    expect(mechanism.unit).toBeLessThanOrEqual(0.0125 * mechanism.size)
    for (const joint of report.joints) expect(mechanism.radiusOf(joint), joint.name).toBeLessThanOrEqual(mechanism.unit)
  })

  test('a fitted picture shows everything at every moment, and little else', () => {
    const assemblies = [matter, marks].map(
      (draws) => new Assembly(mechanism, LIGHT, new State(report).choice, draws, new Outlines(), 0),
    )
    const camera = cameraFor(mechanism, looksOf(mechanism)[0].parallel)
    fit(
      camera,
      assemblies.flatMap(({ reach }) => reach),
      mechanism.size,
      looksOf(mechanism)[0],
      WIDTH,
      HEIGHT,
    )
    const seen = new Box3()
    const last = report.times.length - 1
    for (const step of [0, 1, 2, 3, 4, 5].map((k) => Math.round((k * last) / 5))) {
      for (const assembly of assemblies) {
        assembly.pose(mechanism.frame(step))
        for (const group of assembly.groups.filter(({ visible }) => visible))
          for (const point of vertices(group)) seen.expandByPoint(point.project(camera))
      }
    }
    expect(seen.max.x).toBeLessThan(1)
    expect(seen.min.x).toBeGreaterThan(-1)
    expect(seen.min.y).toBeGreaterThan(-1)
    // Below the buttons.
    expect(seen.max.y).toBeLessThan(1 - (2 * 34) / HEIGHT)
    // From side to side or from top to bottom; what is nearest to the eye at another moment leaves some air at this
    // one.
    expect(
      Math.max((seen.max.x - seen.min.x) / 2, (seen.max.y - seen.min.y) / (2 - (2 * 34) / HEIGHT)),
    ).toBeGreaterThan(0.85)
  })

  test('a design takes what it has in common with the one drawn before, which is freed with the last of them', () => {
    const stock = new Stock()
    const kits = [0, 1].map(() => new Kit(mechanism, LIGHT, stock))
    const [before, after] = kits.map((kit) =>
      held(matter.flatMap((draw) => draw(mechanism, kit, new State(report).choice))),
    )
    const shared = new Map([...after].filter(([one]) => before.has(one)))
    expect(shared.size).toBeGreaterThan(0.75 * after.size)
    for (const one of shared.keys()) one.addEventListener('dispose', () => shared.delete(one))
    const { size } = shared
    kits[0].dispose()
    expect(shared.size).toBe(size)
    kits[1].dispose()
    expect([...shared.values()]).toEqual([])
  })

  test('nothing drawn stays on the graphics card when its kit is freed', () => {
    const kept = held(drawn)
    for (const one of kept.keys()) one.addEventListener('dispose', () => kept.delete(one))
    expect(kept.size).toBeGreaterThan(0)
    kit.dispose()
    expect([...kept.values()]).toEqual([])
  })

  test.skipIf(!mechanism.plane)('links of one pin lie in different layers', () => {
    for (const { name, kind, body_i, body_j } of report.joints)
      if (kind === 'revolute') expect(mechanism.layerOf(body_i), name).not.toBe(mechanism.layerOf(body_j))
  })
})

const PLANAR = [
  'cam',
  'dwell',
  'excavator',
  'four_bar',
  'four_bar_by_lengths',
  'four_bar_inverse',
  'jansen',
  'klann',
  'pantograph',
  'peaucellier',
  'press',
  'quick_return',
  'scissor_lift',
  'slider_crank',
  'three_rrr',
  'watt_six_bar',
]

test('planar models are known to be planar, and no others', async () => {
  const reports = await Promise.all(Object.values(models).map(reportOf))
  expect(Object.keys(models).filter((_, k) => new Mechanism(reports[k]).plane)).toEqual(PLANAR)
})
