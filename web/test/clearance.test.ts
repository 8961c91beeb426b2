import { spawnSync } from 'node:child_process'
import { Box3, Group } from 'three'
import { describe, expect, inject, test, vi } from 'vitest'
import { below, clearanceOf, contacts, contactSentences, nearest, united } from '../src/clearance'
import { answer } from '../src/engine/answer'
import type { DesignReply, Request } from '../src/engine/protocol'
import { valueContent } from '../src/page/contents'
import type { BodyPlace } from '../src/payload'
import { design, type Clearance, type Pair, type Report, type Shape } from '../src/report'
import { nearestLines, shapes } from '../src/scene/draw/clearance'
import { Kit } from '../src/scene/kit'
import { clearanceLabels } from '../src/scene/label_layer'
import { Mechanism } from '../src/scene/mechanism'
import { present } from '../src/scene/shape'
import { State } from '../src/state'
import { CHOICE, crank, PALETTE } from './mechanisms'
import { reportOf } from './payload'

const curve = (...values: number[]) => Float32Array.from(values)

describe('intervals of contact', () => {
  const times = curve(0, 1, 2, 3, 4, 5)

  test('begin and end where the distance is 0 between the steps', () => {
    expect(below(times, curve(1, 1, -1, -3, 1, 1))).toEqual([[1.5, 3.75]])
    expect(below(times, curve(-1, 1, 1, -1, 1, 0))).toEqual([
      [0, 0.5],
      [2.5, 3.5],
    ])
  })

  test('that reach the ends, or a gap, end there', () => {
    expect(below(times, curve(-1, -1, -1, -1, -1, -1))).toEqual([[0, 5]])
    expect(below(times, curve(1, -1, NaN, NaN, NaN, NaN))).toEqual([[0.5, 1]])
    expect(below(times, curve(1, 1, 1, 1, 1, 0))).toEqual([])
  })

  test('of several pairs are one where they overlap', () => {
    expect(
      united([
        [3, 4],
        [0, 1],
        [0.5, 2],
        [4, 5],
      ]),
    ).toEqual([
      [0, 2],
      [3, 5],
    ])
  })
})

const on = (body: number, ...at: [number, number, number]): BodyPlace => ({ body, at })

function shape(kind: Shape['kind'], places: BodyPlace[], more: Partial<Shape> = {}): Shape {
  const [none, numbers] = [new Float32Array(), { radius: 0, half_width: 0, round: 0 }]
  return { name: kind, kind, body: 1, places, axis: null, ...numbers, vertices: none, triangles: none, ...more }
}

/** Two pairs of one clearance over five steps: the second one is the nearer at the end, and touches. */
function pairs(): Pair[] {
  const points = (...ends: [number, number][]) => Float32Array.from(ends.flatMap(([p, q]) => [p, 0, 0, q, 0, 0]))
  const known = { clearances: [0], touching: null, minima: [] }
  return [
    {
      ...known,
      shapes: [0, 1],
      distance: curve(4, 4, 4, 4, 4),
      points: points([0, 4], [0, 4], [0, 4], [0, 4], [0, 4]),
    },
    {
      ...known,
      shapes: [0, 2],
      distance: curve(8, 6, 2, 1, -1),
      points: points([0, 8], [0, 6], [0, 2], [0, 1], [1, 0]),
    },
  ]
}

function clearance(changes: Partial<Clearance> = {}): Clearance {
  const ball = (name: string) => ({ ...shape('sphere', [on(1, 0, 0, 0)], { radius: 1 }), name })
  return {
    shapes: ['hook', 'bolt', 'nut'].map(ball),
    clearances: [{ name: 'gap', quantities: [0], min: 2, beyond: null }],
    pairs: pairs(),
    ...changes,
  }
}

const MEASURE: Report['quantities'][number] = {
  index: 0,
  name: 'gap',
  group: 'measure',
  kind: 'clearance',
  units: ['mm', 'mm/s', 'mm/s^2'],
  curves: [curve(4, 4, 2, 1, -1), new Float32Array(), new Float32Array()],
  wanted: new Float32Array(),
}

describe('the nearest points of a clearance', () => {
  const report = crank({ clearance: clearance() })

  test('are those of the pair that is nearest at the moment', () => {
    expect(nearest(report, 0, 0)).toMatchObject({ distance: 4, pair: { shapes: [0, 1] } })
    expect(nearest(report, 0, 2.5)).toMatchObject({
      distance: 1.5,
      points: [
        [0, 0, 0],
        [1.5, 0, 0],
      ],
    })
  })

  test('are not shown beyond what the clearance lists', () => {
    const [mark] = report.clearance!.clearances
    const near = crank({ clearance: clearance({ clearances: [{ ...mark, beyond: 3 }] }) })
    expect([0, 2].map((step) => nearest(near, 0, step)?.distance)).toEqual([undefined, 2])
  })

  test('have a line, and a label with both names that warns of contact', () => {
    const mechanism = new Mechanism(report)
    const [{ object, follow }] = nearestLines(mechanism, new Kit(mechanism, PALETTE), CHOICE)
    const [plain, red] = object.children
    follow!(mechanism.frame(0))
    expect([plain.visible, red.visible]).toEqual([true, false])
    follow!(mechanism.frame(4))
    expect([plain.visible, red.visible]).toEqual([false, true])
    expect(clearanceLabels(mechanism, 0)).toMatchObject([{ text: 'hook – bolt 4 mm', alert: false, at: { x: 2 } }])
    expect(clearanceLabels(mechanism, 4)).toMatchObject([{ text: 'hook – nut −1 mm', alert: true }])
    expect(nearestLines(mechanism, new Kit(mechanism, PALETTE), { ...CHOICE, shapes: false })).toEqual([])
  })
})

describe('contacts of a design', () => {
  test('are the located ones of the design as loaded', () => {
    const [first, second] = pairs()
    const located = clearance({ pairs: [first, { ...second, touching: [[2.75, 3]] }] })
    expect(contacts(new State(crank({ clearance: located })))).toEqual([[2.75, 3]])
    expect(contacts(new State(crank({ clearance: clearance() })))).toEqual([[2.75, 3]])
    expect(contacts(new State(crank()))).toEqual([])
  })

  test('are in words: which shapes, how deep, and when', () => {
    const state = new State(crank({ clearance: clearance(), quantities: [MEASURE] }))
    expect(contactSentences(state)).toEqual(['`hook` touches `nut`, 1 mm deep at 3 s.'])
    // Of a prediction only the measure is known.
    state.adjust([{ name: 'unknown', by: 1 }])
    expect(contactSentences(state)).toEqual(['Shapes of `gap` touch, 1 mm deep at 3 s.'])
  })

  test('and the required distance are shaded behind the curve of its measure, over time', () => {
    const other = { ...MEASURE, index: 1, name: 'other', kind: 'distance' }
    const state = new State(crank({ clearance: clearance(), quantities: [MEASURE, other] }))
    vi.stubGlobal('document', { documentElement: { classList: { contains: () => false } } })
    vi.stubGlobal('matchMedia', () => ({ matches: false }))
    vi.stubGlobal('getComputedStyle', () => ({ getPropertyValue: () => '#000' }))
    const content = valueContent(state, { quantity: 0, order: 0 })
    expect(content.contacts).toEqual([[2.75, 3]])
    expect(content.wanted).toEqual([{ low: 2, high: null }])
    expect(content.caption).toBe('Shaded: at least the 2 mm that `gap` requires. Red: shapes touch.')
    expect(valueContent(state, { quantity: 1, order: 0 }).contacts).toBeUndefined()
    expect(valueContent(state, { quantity: 0, order: 0, over: 1 }).contacts).toBeUndefined()
    expect([0, 1].map((quantity) => clearanceOf(state.report, quantity))).toEqual([0, undefined])
  })
})

/** Digits that agree: vertices are `f32`, and some hundred units large. */
const DRAWN = 3

describe('shapes are drawn as large as they are', () => {
  const round = (...sides: number[]) => sides
  test.each([
    ['sphere', shape('sphere', [on(1, 50, 0, 0)], { radius: 10 }), round(40, 60, -10, 10, -10, 10)],
    ['capsule', shape('capsule', [on(1, 0, 0, 0), on(1, 200, 0, 0)], { radius: 8 }), round(-8, 208, -8, 8, -8, 8)],
    [
      'ring',
      shape('ring', [on(1, 0, 0, 0)], { radius: 40, round: 5, axis: [0, 0, 1] }),
      round(-45, 45, -45, 45, -5, 5),
    ],
    [
      'cylinder',
      shape('cylinder', [on(1, 0, 0, -20), on(1, 0, 0, 20)], { radius: 30, round: 4 }),
      round(-30, 30, -30, 30, -20, 20),
    ],
    [
      'tyre with plain edges',
      shape('tyre', [on(1, 100, 0, 0)], { radius: 50, half_width: 12, axis: [0, 1, 0] }),
      round(50, 150, -12, 12, -50, 50),
    ],
    ['plane', shape('plane', [on(1, 0, 0, -5)], { axis: [0, 0, 1] }), round(-80, 80, -80, 80, -5, -5)],
    [
      'hull',
      shape('hull', [on(1, 0, 0, 0), on(1, 9, 0, 0), on(1, 0, 7, 0)], { triangles: curve(0, 1, 2) }),
      round(0, 9, 0, 7, 0, 0),
    ],
    [
      'mesh',
      shape('mesh', [], { vertices: curve(1, 2, 3, 4, 2, 3, 1, 6, 3), triangles: curve(0, 1, 2) }),
      round(1, 4, 2, 6, 3, 3),
    ],
    // Its far end goes with the crank, a quarter of a turn later.
    [
      'rod between bodies',
      shape('capsule', [on(0, 0, 100, 0), on(1, 200, 0, 0)], { radius: 6, body: 0 }),
      round(-6, 6, 94, 206, -6, 6),
    ],
  ])('%s', (_, one, [x0, x1, y0, y1, z0, z1]) => {
    const mechanism = new Mechanism(crank({ clearance: clearance({ shapes: [one], pairs: [] }) }))
    const [{ object, follow, body, part }] = shapes(mechanism, new Kit(mechanism, PALETTE), CHOICE)
    expect(part).toMatchObject({ kind: 'shape', index: 0, name: one.kind })
    expect(body).toBe(follow ? undefined : 1)
    follow?.(mechanism.frame(1))
    const group = new Group().add(object)
    group.updateMatrixWorld(true)
    const { min, max } = new Box3().setFromObject(group, true)
    const found = [min.x, max.x, min.y, max.y, min.z, max.z]
    const side = mechanism.size * 0.4
    const wanted = one.kind === 'plane' ? [-side, side, -side, side, z0, z1] : [x0, x1, y0, y1, z0, z1]
    found.forEach((value, k) => expect(value).toBeCloseTo(wanted[k], DRAWN))
  })

  test('unless they are hidden', () => {
    const mechanism = new Mechanism(crank({ clearance: clearance() }))
    expect(shapes(mechanism, new Kit(mechanism, PALETTE), { ...CHOICE, shapes: false })).toEqual([])
  })
})

test('a design that the engine solves has its own shapes, pairs and contacts', async () => {
  const report = await reportOf(inject('samples').knee)
  const model = { ...report.model!, shown: null }
  const change = [{ name: 'C.y', by: 3 }]
  const requests: Request[] = [
    { ask: 'open', model },
    { ask: 'design', change, from: null, solid: false },
  ]
  const input = requests.map((request) => JSON.stringify(request)).join('\n')
  const { stdout, status, stderr } = spawnSync(inject('samples').answers, {
    input,
    maxBuffer: 2 ** 30,
    encoding: 'utf8',
  })
  expect(status, stderr).toBe(0)
  const block = Uint8Array.from(Buffer.from(stdout.trim().split('\n')[1], 'base64')).buffer
  const { json, decode } = answer<DesignReply>(block)
  const state = new State(report)
  const before = contacts(state)
  state.adjust(change)
  state.solved(design(json.design!, decode), change, { last: true })
  // The rod is nearer to the screws, and touches for longer.
  expect(before[0][0]).toBeCloseTo(0.321025628612, 9)
  expect(contacts(state)[0][0]).toBeLessThan(before[0][0])
  expect(contactSentences(state)[0]).toMatch(/^`coupler_rod` touches `screw1`, [\d.]+ mm deep at 0\.\d+ s\.$/)
  const changed = present(new Mechanism(report), state)
  const [was, is] = [report, changed.report].map(
    ({ clearance }) => clearance!.shapes.find(({ name }) => name === 'coupler_rod')!,
  )
  expect(is.places[1].at[1] === was.places[1].at[1] && is.places[1].at[0] === was.places[1].at[0]).toBe(false)
  expect(nearest(changed.report, 0, 38)!.distance).toBeLessThan(nearest(report, 0, 38)!.distance - 1)
})
