import { type Curve, extreme, quiet, spread } from './curve'
import { per } from './format'
import type * as wire from './payload'
import { rounded } from './rounding'
import type { Decode } from './unpack'

/** 0 the quantity itself, 1 its velocity, 2 its acceleration. */
export type Order = 0 | 1 | 2
export const ORDERS = ['value', 'velocity', 'acceleration'] as const

type ByOrder<T> = readonly [T, T, T]
type Curves = { value: wire.Curve; rate: wire.Curve; accel: wire.Curve }

export interface Body extends Omit<wire.BodyTrack, 'poses' | 'mesh'> {
  /** 7 numbers per step: x y z, quaternion w x y z. */
  poses: Curve
  mesh: Mesh | null
}

/** A triangle mesh in the body's frame: three coordinates per vertex, three vertices per triangle. */
export interface Mesh {
  file: string
  positions: Curve
  triangles: Curve
}

export interface Driver extends Omit<wire.DriverMark, 'travel' | 'alone'> {
  /** The driven coordinate, one number per step. */
  travel: Curve
  /** If several drivers move: rates of the first quantities by this one alone; empty if unknown. */
  alone: Curve[]
}

export interface Quantity {
  index: number
  name: string
  group: string
  /** Type of the measure, such as `toe`; `position` for a coordinate of a point or body. */
  kind: string
  units: ByOrder<string>
  curves: ByOrder<Curve>
  /** Target of a metric, one number per step; empty without one. */
  wanted: Curve
}

export interface Sensitivity {
  curves: ByOrder<Curve>
  /** The value that is largest in magnitude over time, with its sign. */
  extremes: ByOrder<number>
  /** Largest magnitude over time. */
  peaks: ByOrder<number>
  differences?: { curves: ByOrder<Curve>; worst: ByOrder<number>; step: number; unit: string }
}

export interface Variable extends Omit<wire.Variable, 'sensitivities' | 'shifts'> {
  index: number
  /** Per body 6 numbers per step: translation and rotation of its frame, per unit of the variable. */
  shifts: Curve[]
  /** By the quantity's index. */
  sensitivities: Map<number, Sensitivity>
}

export interface Margin {
  curve: Curve
  note: string
}

/** A force on a body. */
export interface Load extends Omit<wire.LoadMark, 'force'> {
  /** Three numbers per step, in the world, N; empty where the design's forces are not known. */
  force: Curve
}

/** Another design over the same times; unknown data are empty or missing. */
export interface Design extends Omit<wire.Design, 'poses' | 'loads' | 'quantities' | 'margin' | 'clearance'> {
  poses: Curve[]
  /** The force of each of the report's loads. */
  loads: Curve[]
  /** By the quantity's index. */
  quantities: (ByOrder<Curve> | undefined)[]
  margin?: Curve
  /** Shapes of the design, without the vertices of meshes, and their distances. */
  clearance?: Omit<Clearance, 'clearances'>
}

/** A shape in the frames of its bodies. */
export interface Shape extends Omit<wire.ShapeMark, 'vertices' | 'triangles'> {
  vertices: Curve
  triangles: Curve
}

/** Distance of two shapes over the motion. */
export interface Pair extends Omit<wire.PairTrack, 'distance' | 'points'> {
  distance: Curve
  /** Two points of the world per step. */
  points: Curve
}

/** Shapes, and their distances over the motion. */
export interface Clearance {
  shapes: Shape[]
  clearances: wire.ClearanceMark[]
  pairs: Pair[]
}

/** True for a given force, whose law no design changes. */
export function isGiven({ group }: Quantity): boolean {
  return group === 'force'
}

/** A quantity of a design; no values where the design does not have it. */
export function curveOf({ quantities }: Design, quantity: number, order: Order): Curve {
  return quantities[quantity]?.[order] ?? new Float32Array()
}

/** Measures over two drivers; tables row by row, a row for each place of the second. */
export interface GridMap extends Omit<wire.GridMap, 'quantities'> {
  quantities: {
    name: string
    unit: string
    values: Curve
    sensitivities: { variable: string; unit: string; values: Curve }[]
  }[]
}

/** Designs that were swept over; point k of every axis is design `k * step`. */
export interface Sweep extends Omit<wire.SweepPlot, 'axes'> {
  axes: SweepAxis[]
}

export interface SweepAxis extends Omit<wire.SweepAxis, 'values'> {
  values: Curve
}

/** The payload with its curves decoded. */
export interface Report
  extends Omit<
    wire.Payload,
    | 'times'
    | 'bodies'
    | 'drivers'
    | 'loads'
    | 'quantities'
    | 'margin'
    | 'variables'
    | 'designs'
    | 'maps'
    | 'sweep'
    | 'clearance'
  > {
  times: Curve
  bodies: Body[]
  drivers: Driver[]
  loads: Load[]
  quantities: Quantity[]
  margin?: Margin
  variables: Variable[]
  designs: Design[]
  maps: GridMap[]
  sweep?: Sweep
  clearance?: Clearance
}

export function read(payload: wire.Payload, decode: Decode): Report {
  const steps = decode(payload.times).length
  return {
    ...payload,
    times: decode(payload.times),
    bodies: payload.bodies.map((body) => ({ ...body, poses: decode(body.poses), mesh: mesh(body.mesh, decode) })),
    drivers: payload.drivers.map((driver) => ({
      ...driver,
      travel: decode(driver.travel),
      alone: driver.alone.map(decode),
    })),
    loads: payload.loads.map((load) => ({ ...load, force: decode(load.force) })),
    quantities: payload.quantities.map((quantity, index) => ({
      index,
      name: quantity.name,
      group: quantity.group,
      kind: quantity.kind,
      units: [quantity.unit, quantity.rate_unit, quantity.accel_unit],
      curves: curves(quantity, decode),
      wanted: decode(quantity.wanted),
    })),
    maps: payload.maps.map((map) => ({
      ...map,
      quantities: map.quantities.map((quantity) => ({
        ...quantity,
        values: quiet(decode(quantity.values), 1),
        sensitivities: quantity.sensitivities.map((item) => ({ ...item, values: quiet(decode(item.values), 1) })),
      })),
    })),
    sweep: payload.sweep
      ? { ...payload.sweep, axes: payload.sweep.axes.map((axis) => ({ ...axis, values: decode(axis.values) })) }
      : undefined,
    margin: payload.margin ? { curve: decode(payload.margin.value), note: payload.margin.note } : undefined,
    variables: payload.variables.map((variable, index) => {
      const shifts = once(() => variable.shifts.map(decode))
      return {
        ...variable,
        index,
        get shifts() {
          return shifts()
        },
        sensitivities: new Map(variable.sensitivities.map((item) => [item.quantity, sensitivity(item, steps, decode)])),
      }
    }),
    designs: payload.designs.map((item) => design(item, decode)),
    clearance: payload.clearance && { ...payload.clearance, ...distances(payload.clearance, decode) },
  }
}

/** Another design with its curves decoded. */
export function design(item: wire.Design, decode: Decode): Design {
  return {
    ...item,
    poses: item.poses.map(decode),
    loads: item.loads.map(decode),
    quantities: item.quantities.map((item) => (item ? curves(item, decode) : undefined)),
    margin: item.margin ? decode(item.margin) : undefined,
    clearance: item.clearance && distances(item.clearance, decode),
  }
}

function distances({ shapes, pairs }: wire.DesignShapes, decode: Decode): Omit<Clearance, 'clearances'> {
  return {
    shapes: shapes.map((shape) => ({
      ...shape,
      vertices: decode(shape.vertices),
      triangles: decode(shape.triangles),
    })),
    pairs: pairs.map((pair) => ({ ...pair, distance: decode(pair.distance), points: decode(pair.points) })),
  }
}

function mesh(item: wire.Mesh | null, decode: Decode): Mesh | null {
  return item && { file: item.file, positions: decode(item.positions), triangles: decode(item.triangles) }
}

function curves(item: Curves, decode: Decode): ByOrder<Curve> {
  return [decode(item.value), decode(item.rate), decode(item.accel)]
}

/** Curves are decoded when they are requested: of a large model, most never are. */
function sensitivity(item: wire.Sensitivity, steps: number, decode: Decode): Sensitivity {
  const analytic = once(() => curves(item, decode))
  const extremes = once((): ByOrder<number> => byOrder(analytic().map(extreme)))
  const peaks = once((): ByOrder<number> => byOrder(extremes().map(Math.abs)))
  const compared = once(() => (item.fd ? differences(item.fd, steps, decode) : undefined))
  return {
    get curves() {
      return analytic()
    },
    get extremes() {
      return extremes()
    },
    get peaks() {
      return peaks()
    },
    get differences() {
      return compared()
    },
  }
}

function byOrder<T>([value, rate, accel]: T[]): ByOrder<T> {
  return [value, rate, accel]
}

/** Value of a function, computed at the first request. */
function once<T>(find: () => T): () => T {
  let found: { it: T } | undefined
  return () => (found ??= { it: find() }).it
}

/** The differences at their own steps, gaps between. */
function differences(fd: wire.FiniteDifference, steps: number, decode: Decode): Sensitivity['differences'] {
  const [value, rate, accel] = curves(fd, decode).map((curve) => spread(curve, fd.stride, steps))
  return { curves: [value, rate, accel], worst: fd.worst, step: fd.step, unit: fd.step_unit }
}

/** `toe`, `toe velocity`. */
export function orderedName(quantity: Quantity, order: Order): string {
  return order === 0 ? quantity.name : `${quantity.name} ${ORDERS[order]}`
}

/** `d toe / d lca_x`. */
export function derivativeName(quantity: Quantity, order: Order, variable: Variable): string {
  return `d ${orderedName(quantity, order)} / d ${variable.name}`
}

export function derivativeUnit(quantity: Quantity, order: Order, variable: { unit: string }): string {
  return per(quantity.units[order], variable.unit)
}

interface RankedVariable {
  variable: Variable
  sensitivity: Sensitivity
  peak: number
  /** Peak relative to the largest among variables of the same unit, 0 to 1. */
  share: number
}

/** Variables with a sensitivity of the quantity, largest first within each unit. */
export function ranking(report: Report, quantity: Quantity, order: Order): Map<string, RankedVariable[]> {
  const byUnit = new Map<string, RankedVariable[]>()
  for (const variable of report.variables) {
    const sensitivity = variable.sensitivities.get(quantity.index)
    // Of body origins, velocities and accelerations may be left out; a curve without numbers is not known.
    if (!sensitivity?.curves[order].some(Number.isFinite)) continue
    const peers = byUnit.get(variable.unit) ?? []
    byUnit.set(variable.unit, peers)
    peers.push({ variable, sensitivity, peak: sensitivity.peaks[order], share: 0 })
  }
  for (const peers of byUnit.values()) {
    peers.sort((a, b) => b.peak - a.peak || a.variable.index - b.variable.index)
    const largest = peers[0].peak
    for (const item of peers) {
      item.share = largest > 0 ? rounded(item.peak / largest) : 0
    }
  }
  return byUnit
}

/** The groups in the order of first appearance, measures first. */
export function groups(report: Report): [name: string, members: Quantity[]][] {
  const found = new Map<string, Quantity[]>()
  for (const quantity of report.quantities) {
    found.set(quantity.group, [...(found.get(quantity.group) ?? []), quantity])
  }
  return [...found].sort(([a], [b]) => Number(b === 'measure') - Number(a === 'measure'))
}
