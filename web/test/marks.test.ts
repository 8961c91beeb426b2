import { Box3, Group, Matrix4, Vector3 } from 'three'
import { describe, expect, test } from 'vitest'
import { number } from '../src/format'
import type { Report } from '../src/report'
import type { Drawable } from '../src/scene/drawable'
import { centreLines } from '../src/scene/centre_lines'
import { deformed } from '../src/scene/deform'
import { marks, matter } from '../src/scene/draw'
import { paths } from '../src/scene/draw/paths'
import { equalTimes, pieces } from '../src/scene/draw/trace'
import { Kit } from '../src/scene/kit'
import { distanceLabels, hardpointLabels, partLabels } from '../src/scene/label_layer'
import { placeLabels, type Spot } from '../src/scene/labels'
import { Mechanism } from '../src/scene/mechanism'
import { directions } from '../src/scene/triad'
import { arcOf, atLeast } from '../src/scene/travel'
import { type Choice, State } from '../src/state'
import { CHOICE, crank, PALETTE } from './mechanisms'

function drawn(mechanism: Mechanism, choice: Partial<Choice> = {}): Drawable[] {
  return marks.flatMap((draw) => draw(mechanism, new Kit(mechanism, PALETTE), { ...CHOICE, ...choice }))
}

/** The box round an object that is in a body's frame or the world, at a step. */
function boxOf(mechanism: Mechanism, { body, object, follow }: Drawable, step = 0): Box3 {
  follow?.(mechanism.frame(step))
  const group = new Group().add(object)
  const pose = body === undefined ? undefined : mechanism.poseAt(body, step)
  if (pose) group.applyMatrix4(new Matrix4().compose(pose.place, pose.turn, new Vector3(1, 1, 1)))
  group.updateMatrixWorld(true)
  return new Box3().setFromObject(group)
}

const variable = (changes: object) => ({
  ...{ index: 0, name: 'length', description: '', unit: 'mm', admissibility: 'admissible' as const, note: '' },
  ...{ typical: null, tolerance: null, bounds: null as never, shifts: [], sensitivities: new Map(), arrows: [] },
  ...changes,
})

describe('labels', () => {
  const room = { width: 400, height: 300, top: 34 }
  const middle = { x: 200, y: 150 }

  test('stand outwards from the middle, as near as they can', () => {
    const [one] = placeLabels([{ x: 300, y: 150, text: 'pin' }], room, middle)
    expect(one.y).toBeCloseTo(150)
    expect(one.x - one.width / 2).toBeCloseTo(322)
  })

  test('cover neither one another nor the edges nor the title, and what finds no place is left out', () => {
    const crowd = Array.from(
      { length: 80 },
      (_, k): Spot => ({ x: 180 + (k % 9) * 5, y: 30 + Math.floor(k / 9) * 5, text: `hardpoint_${k}` }),
    )
    const placed = placeLabels(crowd, room, middle)
    expect(placed.length).toBeGreaterThan(3)
    expect(placed.length).toBeLessThan(80)
    placed.forEach((a, k) => {
      expect(a.x - a.width / 2).toBeGreaterThanOrEqual(4)
      expect(a.x + a.width / 2).toBeLessThanOrEqual(396)
      expect(a.y - a.height / 2).toBeGreaterThanOrEqual(34)
      for (const b of placed.slice(k + 1)) {
        expect(Math.abs(a.x - b.x) >= (a.width + b.width) / 2 || Math.abs(a.y - b.y) >= (a.height + b.height) / 2).toBe(
          true,
        )
      }
    })
  })

  test('too long for the picture, or in a picture of no size, are left out', () => {
    expect(placeLabels([{ x: 200, y: 150, text: 'x'.repeat(500) }], room, middle)).toEqual([])
    expect(placeLabels([{ x: 0, y: 0, text: 'x' }], { width: 0, height: 0, top: 34 }, { x: 0, y: 0 })).toEqual([])
  })

  test('name each place once', () => {
    const mechanism = new Mechanism(crank())
    const frame = mechanism.frame(1)
    const labels = hardpointLabels(mechanism, frame)
    expect(labels.map(({ text }) => text)).toEqual(['pivot', 'pin'])
    expect(labels[1].at.distanceTo(new Vector3(0, 200, 0))).toBeLessThan(1e-4)
    expect(partLabels(mechanism, frame, { kind: 'joint', index: 0, name: 'hinge', about: '' })[0].text).toBe('hinge')
  })
})

describe('a mesh', () => {
  const from = [new Vector3(0, 0, 0), new Vector3(100, 0, 0)]

  test('goes with the hardpoints: at one as it, between two half, all alike as a whole', () => {
    const positions = Float32Array.from([0, 0, 0, 100, 0, 0, 50, 7, 0])
    const bent = deformed(positions, from, [from[0], new Vector3(100, 0, 10)])
    ;[0, 10, 5].forEach((z, k) => expect(bent[3 * k + 2]).toBeCloseTo(z, 6))
    const moved = deformed(
      positions,
      from,
      from.map((point) => point.clone().add(new Vector3(1, 2, 3))),
    )
    for (let k = 0; k < 9; k++) expect(moved[k] - positions[k]).toBeCloseTo([1, 2, 3][k % 3], 5)
    expect(deformed(positions, [], [])).toEqual(positions)
  })

  test('is drawn in place of our shape, changed with the design', () => {
    const mesh = {
      file: 'crank.stl',
      positions: Float32Array.from([0, 0, 0, 200, 0, 0, 0, 50, 0]),
      triangles: Float32Array.from([0, 1, 2]),
    }
    const report = crank()
    const bodies = report.bodies.map((body, k) => (k === 1 ? { ...body, mesh } : body))
    const today = new Mechanism({ ...report, bodies })
    const changed = new Mechanism(
      {
        ...report,
        bodies: bodies.map((body, k) =>
          k === 1
            ? {
                ...body,
                skeleton: [
                  [0, 0, 0],
                  [300, 0, 0],
                ],
              }
            : body,
        ),
      },
      today,
      today,
    )
    const draw = (mechanism: Mechanism) =>
      matter
        .flatMap((draw) => draw(mechanism, new Kit(mechanism, PALETTE), CHOICE))
        .filter(({ part }) => part.name === 'crank')
    expect(boxOf(today, draw(today)[0]).max.x).toBeCloseTo(200)
    expect(boxOf(changed, draw(changed)[0]).max.x).toBeCloseTo(300)
  })
})

describe('travel', () => {
  test('is an arc at least so long, and no wider than it must be', () => {
    const arc = arcOf(-0.5, 1, true, 9, [4.4, 8])
    expect(arc.radius).toBeCloseTo(6)
    expect([arc.from, arc.to, arc.heads]).toEqual([-0.5, 1, 'both'])
    const small = arcOf(0, 0.1, true, 9, [4.4, 8])
    expect(small.radius).toBe(8)
    expect((small.to - small.from) * small.radius).toBeCloseTo(9)
    expect(arcOf(0, 0, true, 9, [4.4, 8]).radius).toBe(8)
  })

  test('of whole turns has one head in the sense of the turn', () => {
    expect(arcOf(0, 20, true, 9, [4.4, 8])).toEqual({ radius: 4.4, from: 0.5, to: 5.4, heads: 'last' })
    expect(arcOf(-20, 0, false, 9, [4.4, 8]).heads).toBe('first')
  })

  test('of a length is lengthened to both sides', () => {
    expect(atLeast(2, 4, 9)).toEqual([-1.5, 7.5])
    expect(atLeast(0, 20, 9)).toEqual([0, 20])
  })

  test('of a hinge is drawn round it over the angle that the body sweeps', () => {
    const report = crank()
    // A quarter turn only.
    const travel = Float32Array.from([0, Math.PI / 2, NaN, NaN, NaN])
    const mechanism = new Mechanism({ ...report, drivers: report.drivers.map((driver) => ({ ...driver, travel })) })
    const [arrow] = drawn(mechanism)
    const { min, max } = boxOf(mechanism, arrow)
    const s = mechanism.unit
    expect(arrow.part.name).toBe('motor')
    // In the first quadrant, but for the heads.
    expect(min.x).toBeGreaterThan(-1.2 * s)
    expect(min.y).toBeGreaterThan(-1.2 * s)
    expect(max.x).toBeLessThan(9.2 * s)
    expect(max.x).toBeGreaterThan(4 * s)
  })

  test('of nothing solved is not drawn', () => {
    const report = crank()
    const nothing = new Float32Array(5).fill(NaN)
    expect(
      drawn(new Mechanism({ ...report, drivers: report.drivers.map((driver) => ({ ...driver, travel: nothing })) })),
    ).toEqual([])
  })

  test('of a point goes along its line', () => {
    const report = crank()
    const travel = Float32Array.from([0, 200, 0, -200, 0])
    const point = {
      ...report.drivers[0],
      joint: null,
      turns: false,
      point: { body: 1, at: [200, 0, 0] as [number, number, number] },
      along: [0, 1, 0] as [number, number, number],
      travel,
    }
    const mechanism = new Mechanism({ ...report, drivers: [point] })
    const [arrow] = drawn(mechanism)
    for (const step of [0, 1]) {
      const { min, max } = boxOf(mechanism, arrow, step)
      expect(min.y).toBeCloseTo(-200, 3)
      expect(max.y).toBeCloseTo(200, 3)
    }
  })
})

describe('design velocities', () => {
  const arrows = [
    { body: 0, at: [0, 0, 0], v: [0, 0.5, 0], turn: [0, 0, 0] },
    { body: 1, at: [200, 0, 0], v: [1, 0, 0], turn: [0, 0, 0] },
  ]

  test('are in proportion, the longest 0.11 of the size, one per place', () => {
    const mechanism = new Mechanism(
      crank({ variables: [variable({ arrows: [...arrows, arrows[1]] }) as never], drivers: [] }),
    )
    const velocities = drawn(mechanism)
    expect(velocities).toHaveLength(2)
    expect(boxOf(mechanism, velocities[1]).max.x).toBeCloseTo(200 + 0.11 * mechanism.size, 3)
    expect(boxOf(mechanism, velocities[0]).max.y).toBeCloseTo(0.055 * mechanism.size, 3)
  })

  test('are no towers over a long low mechanism, and say for which change they are drawn', () => {
    const skeleton: [number, number, number][] = [
      [0, 0, 0],
      [10_000, 0, 0],
      [0, 250, 0],
    ]
    const report = crank({ variables: [variable({ arrows: [{ ...arrows[0], v: [0, 2, 0] }] }) as never], drivers: [] })
    const still = report.bodies[0].poses
    const bodies = report.bodies.map((body) => ({
      ...body,
      poses: still,
      skeleton,
      labels: ['', '', ''],
      roles: skeleton.map(() => 'joint' as const),
    }))
    const mechanism = new Mechanism({ ...report, bodies })
    const [arrow] = drawn(mechanism)
    const { y } = boxOf(mechanism, arrow).max
    expect(y).toBeCloseTo(Math.max(0.75 * 250, 9 * mechanism.unit), 3)
    expect(y).toBeLessThan(0.11 * mechanism.size)
    expect(arrow.part.about).toContain(`scaled to ${number(y / 2, 2)} mm`)
  })

  test('of a turn are rings; of none, nothing', () => {
    const turning = { body: 1, at: [200, 0, 0], v: [0, 0, 0], turn: [0, 0, 2] }
    const mechanism = new Mechanism(crank({ variables: [variable({ arrows: [turning] }) as never], drivers: [] }))
    const [ring] = drawn(mechanism)
    const { min, max } = boxOf(mechanism, ring)
    expect(max.x - min.x).toBeGreaterThan(10 * mechanism.unit)
    expect(drawn(new Mechanism(crank({ drivers: [] })))).toEqual([])
  })
})

describe('paths', () => {
  test('have gaps where there is no solution', () => {
    const at = (step: number) => new Vector3([2, 3, 6].includes(step) ? NaN : step, 0, 0)
    expect(pieces(9, at).map((piece) => piece.map(({ x }) => x))).toEqual([
      [0, 1],
      [4, 5],
      [7, 8],
    ])
  })

  test('have dots at equal, round times', () => {
    const times = Float32Array.from({ length: 101 }, (_, k) => k / 100)
    const steps = equalTimes(times)
    expect(steps.length).toBeGreaterThanOrEqual(12)
    expect(steps[1] - steps[0]).toBeCloseTo(5)
    expect(equalTimes(Float32Array.from([1]))).toEqual([])
  })

  test('show where the point is', () => {
    const mechanism = new Mechanism(crank({ drivers: [] }))
    const [, present] = drawn(mechanism, { traces: [[1, 1]] })
    expect(boxOf(mechanism, present, 1).getCenter(new Vector3()).y).toBeCloseTo(200, 3)
    const both = drawn(mechanism, {
      traces: [
        [1, 0],
        [1, 1],
      ],
    })
    expect(both.filter(({ follow }) => follow).map(({ part }) => part.name)).toEqual(['pivot', 'pin'])
  })
})

describe('the reference design', () => {
  test('is drawn of bodies that differ only', () => {
    const today = new Mechanism(crank({ drivers: [] }))
    const longer = crank({ drivers: [] })
    longer.bodies[1].skeleton[1] = [240, 0, 0]
    const changed = new Mechanism(longer, today, today)
    const ghosts = drawn(changed)
    expect(ghosts.map(({ part }) => part.name)).toEqual(['crank'])
    expect(boxOf(changed, ghosts[0], 1).max.y).toBeCloseTo(200, 0)
    expect(drawn(new Mechanism(crank({ drivers: [] }), today, today))).toEqual([])
  })

  test('of a body that one hardpoint represents has no line', () => {
    const block = (x: number) => {
      const report = crank({ drivers: [] })
      return {
        ...report,
        bodies: report.bodies.map((body, k) =>
          k === 1
            ? { ...body, skeleton: [[x, 0, 0] as [number, number, number]], labels: ['pin'], roles: ['joint' as const] }
            : body,
        ),
      }
    }
    const today = new Mechanism(block(0))
    expect(drawn(new Mechanism(block(40), today, today))).toEqual([])
  })

  test('has every line once', () => {
    const report = crank()
    const square = [
      [0, 0, 0],
      [200, 0, 0],
      [200, 200, 0],
      [0, 200, 0],
      [80, 90, 0],
    ] as [number, number, number][]
    const bodies = report.bodies.map((body, k) =>
      k === 1
        ? { ...body, skeleton: square, labels: square.map(() => ''), roles: square.map(() => 'joint' as const) }
        : body,
    )
    const lines = centreLines(new Mechanism({ ...report, bodies }), 1)
    const names = lines.map(([a, b]) =>
      [a, b]
        .map((p) => p.toArray().join())
        .sort()
        .join(' '),
    )
    expect(new Set(names).size).toBe(5)
    expect(lines).toHaveLength(5)
  })
})

test('a measured distance is a line as long as it, beside it', () => {
  const distances = [{ name: 'd', from: { body: 0, at: [0, 0, 0] }, to: { body: 1, at: [200, 0, 0] }, draw: null }]
  const mechanism = new Mechanism(crank({ drivers: [], distances: distances as never }))
  const [line] = drawn(mechanism, { distance: 0 })
  const { min, max } = boxOf(mechanism, line, 0)
  expect(min.x).toBeCloseTo(0, 3)
  expect(max.x).toBeCloseTo(200, 3)
})

describe('a measured distance that is pointed at', () => {
  const distances = ['near', 'far'].map((name) => ({
    name,
    from: { body: 0, at: [0, 0, 0] },
    to: { body: 1, at: [200, 0, 0] },
    draw: null,
  }))
  const quantities = ['angle', 'far', 'near'].map((name, index) => ({
    index,
    name,
    group: '',
    kind: '',
    units: ['mm', 'mm/s', 'mm/s^2'],
    curves: [[], [], []],
    wanted: [],
  }))
  const report = crank({ drivers: [], distances: distances as never, quantities: quantities as never })

  test('comes before the selected one until the pointer leaves, and listeners hear of changes only', () => {
    const state = new State(report)
    let heard = 0
    state.onPoint(() => heard++)
    state.choose({ quantity: 0 })
    expect(state.choice.distance).toBeUndefined()
    state.point(1)
    expect(state.choice.distance).toBe(1)
    state.point(1)
    state.choose({ quantity: 2 })
    expect(state.choice.distance).toBe(1)
    state.point()
    expect(state.choice.distance).toBe(0)
    state.point(0)
    expect([state.choice.distance, heard]).toEqual([0, 2])
  })

  test('has its value at the middle between its places', () => {
    const mechanism = new Mechanism(report)
    const labels = distanceLabels(mechanism, mechanism.frame(1), 1, (quantity) => (quantity === 1 ? 123.456 : NaN))
    expect(labels.map(({ text }) => text)).toEqual(['far 123.5 mm'])
    expect(labels[0].at.distanceTo(new Vector3(0, 100, 0))).toBeLessThan(1e-4)
    expect(distanceLabels(mechanism, mechanism.frame(1), undefined, () => 1)).toEqual([])
  })
})

test('the unit stays between what is seen and what is clumsy, and comes back', () => {
  const mechanism = new Mechanism(crank())
  const { unit } = mechanism
  expect(mechanism.sizeTo(5 / unit)).toBe(false)
  expect(mechanism.sizeTo(200 / unit)).toBe(true)
  const zoomed = (200 / unit) * mechanism.unit
  expect(zoomed).toBeLessThanOrEqual(14)
  expect(zoomed).toBeGreaterThan(14 / 1.25)
  expect(mechanism.sizeTo(0.1 / unit)).toBe(true)
  const far = (0.1 / unit) * mechanism.unit
  expect(far).toBeGreaterThanOrEqual(0.75)
  expect(far).toBeLessThan(0.75 * 1.25)
  for (const nothing of [0, NaN, Infinity]) expect(mechanism.sizeTo(nothing)).toBe(false)
  expect(mechanism.sizeTo(5 / unit)).toBe(true)
  expect(mechanism.unit).toBe(unit)
})

test('axes of a vehicle are words that point its way', () => {
  const vehicle = { forward: new Vector3(-1, 0, 0), up: new Vector3(0, 0, 1) }
  expect(directions(vehicle).map(({ name, unit }) => [name, unit.x, unit.y + 0, unit.z])).toEqual([
    ['front', -1, 0, 0],
    ['left', 0, -1, 0],
    ['up', 0, 0, 1],
  ])
  expect(directions().map(({ name }) => name)).toEqual(['x', 'y', 'z'])
})

describe('the path of a point', () => {
  const shown = (role: 'joint' | 'measured', changes: Partial<Report> = {}) => {
    const report = crank(changes)
    report.bodies[1].roles = ['joint', role]
    const mechanism = new Mechanism(report)
    return paths(mechanism, new Kit(mechanism, PALETTE), CHOICE).map((one) =>
      boxOf(mechanism, one).getSize(new Vector3()),
    )
  }

  test('that is measured and that no joint holds is as large as its way', () => {
    const [size, ...others] = shown('measured')
    expect(others).toEqual([])
    // The corners of a square: the motion's only steps.
    expect(size.x).toBeCloseTo(400)
    expect(size.y).toBeCloseTo(400)
  })

  test('that is a joint, or is at rest, or belongs to a vehicle is not drawn', () => {
    expect(shown('joint')).toEqual([])
    expect(shown('measured', { vehicle: { forward: [1, 0, 0], up: [0, 0, 1] } })).toEqual([])
    const still = crank().bodies.map((body) => ({ ...body, poses: crank().bodies[0].poses }))
    expect(shown('measured', { bodies: still })).toEqual([])
  })
})
