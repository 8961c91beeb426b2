import type { Payload } from '../src/payload'
import type { Report } from '../src/report'
import type { Palette } from '../src/scene/palette'
import type { Choice } from '../src/state'

/** An empty page. */
export const EMPTY: Payload = {
  title: '',
  description: '',
  file: '',
  generator: 'test',
  units: { length: 'mm', angle: 'deg', time: 's' },
  status: { complete: true, message: '' },
  summary: [],
  notes: [],
  times: [],
  bodies: [],
  joints: [],
  couplers: [],
  drivers: [],
  wheels: [],
  distances: [],
  loads: [],
  vehicle: null,
  quantities: [],
  values: [],
  metrics: null,
  first: null,
  over: null,
  plots: [],
  designs: [],
  named_designs: [],
  maps: [],
  sweep: null,
  margin: null,
  variables: [],
  checks: [],
  model: null,
}

/** Colours, where they do not matter. */
export const PALETTE: Palette = {
  ...{
    view: '#f6f7f9',
    outline: '#2a323a',
    label: '#1c2126',
    bodies: Array(6).fill('#6c7fb8'),
    steel: '#f4f6f8',
    rod: '#8b96a1',
  },
  ...{
    ground: '#66717c',
    hatch: '#39424b',
    rubber: '#4a535c',
    tyre: '#39424b',
    driver: '#e06c00',
    chosen: '#c2185b',
    load: '#b3261e',
  },
  ...{
    trace: '#0b62b8',
    former: '#2a323a',
    grid: '#e4e8ec',
    gridMain: '#d2d8dd',
    axes: { x: '#d55e00', y: '#009e73', z: '#0072b2' },
  },
  ...{ light: { sky: 2, earth: '#c2cad2', sun: 1, shadow: 0.16 }, glass: 0.13 },
}
/** Initial choice. */
export const CHOICE: Choice = {
  quantity: 0,
  variable: 0,
  order: 0,
  labels: false,
  forces: true,
  rigid: true,
  shapes: true,
  traces: [],
}

/** Rotations about z of the crank from one step to the next. */
const QUARTER = Math.PI / 2
const STEPS = 5

/** A crank that makes one turn about the origin in the plane xy, driven at its hinge to ground, in millimetres. */
export function crank(changes: Partial<Report> = {}): Report {
  const turn = (k: number) => [0, 0, 0, Math.cos((k * QUARTER) / 2), 0, 0, Math.sin((k * QUARTER) / 2)]
  const still = () => [0, 0, 0, 1, 0, 0, 0]
  const poses = (pose: (k: number) => number[]) =>
    Float32Array.from(Array.from({ length: STEPS }, (_, k) => pose(k)).flat())
  const travel = Float32Array.from({ length: STEPS }, (_, k) => k * QUARTER)
  const hinge = {
    kind: 'revolute',
    body_i: 0,
    body_j: 1,
    at_i: [0, 0, 0],
    at_j: [0, 0, 0],
    axis: [0, 0, 1],
    axis_j: [0, 0, 1],
  }
  return {
    ...EMPTY,
    title: 'one turn of a crank',
    file: 'crank.toml',
    times: Float32Array.from({ length: STEPS }, (_, k) => 1 + 0.5 * k),
    bodies: [
      { name: 'ground', poses: poses(still), skeleton: [[0, 0, 0]], labels: ['pivot'], roles: ['joint'], mesh: null },
      {
        name: 'crank',
        poses: poses(turn),
        skeleton: [
          [0, 0, 0],
          [200, 0, 0],
        ],
        labels: ['pivot', 'pin'],
        roles: ['joint', 'joint'],
        mesh: null,
      },
    ],
    joints: [
      {
        name: 'hinge',
        ...hinge,
        axis2: null,
        slide: null,
        hinge: null,
        lead: null,
        curve: null,
        draw: null,
        cut: false,
      } as Report['joints'][number],
    ],
    drivers: [{ name: 'motor', law: 'one turn', joint: 0, turns: true, point: null, along: null, travel, alone: [] }],
    loads: [],
    quantities: [],
    designs: [],
    maps: [],
    sweep: undefined,
    margin: undefined,
    clearance: undefined,
    variables: [],
    ...changes,
  }
}
