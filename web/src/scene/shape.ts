import { Vector3 } from 'three'
import type { Curve } from '../curve'
import type { Arrow, BodyPlace, JointMark } from '../payload'
import type { Design, Report } from '../report'
import type { State } from '../state'
import { Mechanism } from './mechanism'
import { poseAt, shifted } from './poses'

type Place = [number, number, number]
type Move = (body: number, at: Place) => Place

/** Distance up to which points are the same hardpoint, relative to the size. */
const SAME = 1e-6

/**
 * The design drawn solid: as loaded, as the changes of variables make it to first order, or another exact design
 * that the report brings. Its `former` is the design drawn dashed, where there is one.
 */
export function present(original: Mechanism, state: State): Mechanism {
  const { report, size } = original
  const known = (design?: Design) => (design && design.poses.length === report.bodies.length ? design : undefined)
  const exact = known(state.present)
  const other = known(state.former ?? (state.isCompared ? undefined : state.rigid))
  const former = other ? new Mechanism(solved(report, other, size), original) : original
  if (exact) return new Mechanism(solved(report, exact, size), original, former)
  if (state.changed) return new Mechanism(predicted(report, state.changes, size), original, former)
  return other ? new Mechanism(report, original, former) : original
}

/** A report as changes of its variables make it to first order. */
export function predicted(report: Report, changes: number[], size: number): Report {
  const changed = report.variables.filter(({ index }) => changes[index])
  const poses = report.bodies.map((body, b) => {
    const shifts = sum(changed.map((variable) => ({ curve: variable.shifts[b], by: changes[variable.index] })))
    return shifts ? moved(body.poses, shifts, 1) : body.poses
  })
  const arrowsAt = (body: number, at: Place): { arrow: Arrow; by: number }[] =>
    changed.flatMap(({ index, arrows }) =>
      arrows
        .filter((arrow) => arrow.body === body && distance(arrow.at, at) <= SAME * size)
        .slice(0, 1)
        .map((arrow) => ({ arrow, by: changes[index] })),
    )
  const move: Move = (body, at) => arrowsAt(body, at).reduce((place, { arrow, by }) => added(place, arrow.v, by), at)
  const turn = (body: number, at: Place, axis: Place): Place => {
    const unit = new Vector3(...axis)
    const turned = unit.clone()
    for (const { arrow, by } of arrowsAt(body, at)) turned.addScaledVector(new Vector3(...arrow.turn).cross(unit), by)
    return turned.normalize().toArray()
  }
  const redrawn = redraw(report, poses, move)
  const joints = redrawn.joints.map((joint, k) => {
    const { body_i, body_j, at_i, at_j } = report.joints[k]
    const { axis, axis_j, hinge } = joint
    return {
      ...joint,
      axis: axis && !hinge ? turn(body_i, at_i, axis) : axis,
      axis_j: axis_j ? turn(body_j, at_j, axis_j) : axis_j,
    }
  })
  // Forces have no prediction.
  const loads = redrawn.loads.map((load) => ({ ...load, force: new Float32Array() }))
  return { ...redrawn, joints, loads }
}

/** Combined shifts of several variables, to first order; undefined without shifts. */
function sum(items: { curve: Curve | undefined; by: number }[]): Curve | undefined {
  let total: Curve | undefined
  for (const { curve, by } of items) {
    if (!curve || curve.length === 0) continue
    total ??= new Float32Array(curve.length)
    for (let k = 0; k < curve.length; k++) total[k] += by * curve[k]
  }
  return total
}

/** A report as a re-solved design has it. */
export function solved(report: Report, design: Design, size: number): Report {
  const move: Move = (body, at) => {
    const k = report.bodies[body].skeleton.findIndex((point) => distance(point, at) <= SAME * size)
    return design.skeletons[body]?.[k] ?? at
  }
  const redrawn = redraw(report, design.poses, move)
  return {
    ...redrawn,
    loads: redrawn.loads.map((load, k) => ({ ...load, force: design.loads[k] ?? new Float32Array() })),
    clearance: design.clearance ? ofDesign(report, design.clearance) : redrawn.clearance,
  }
}

/** Shapes of another design, with the meshes as loaded. */
function ofDesign({ clearance }: Report, { shapes, pairs }: NonNullable<Design['clearance']>): Report['clearance'] {
  return (
    clearance && {
      ...clearance,
      shapes: shapes.map((shape, k) => ({ ...shape, vertices: clearance.shapes[k].vertices })),
      pairs,
    }
  )
}

function redraw(report: Report, poses: Curve[], move: Move): Report {
  const place = ({ body, at }: BodyPlace): BodyPlace => ({ body, at: move(body, at) })
  return {
    ...report,
    bodies: report.bodies.map((body, b) => ({
      ...body,
      poses: poses[b],
      skeleton: body.skeleton.map((point) => move(b, point)),
    })),
    joints: report.joints.map((joint) => ({ ...joint, at_j: move(joint.body_j, joint.at_j), ...onBodyI(joint, move) })),
    wheels: report.wheels.map((wheel) => ({
      ...wheel,
      centre: place(wheel.centre),
      kingpin: wheel.kingpin && [place(wheel.kingpin[0]), place(wheel.kingpin[1])],
    })),
    distances: report.distances.map((distance) => ({
      ...distance,
      from: place(distance.from),
      to: place(distance.to),
    })),
    loads: report.loads.map((load) => ({ ...load, at: place(load.at) })),
    // Distances are known of solved designs only.
    clearance: report.clearance && {
      ...report.clearance,
      shapes: report.clearance.shapes.map((shape) => ({ ...shape, places: shape.places.map(place) })),
      pairs: [],
    },
    drivers: report.drivers.map((driver) => ({ ...driver, point: driver.point && place(driver.point) })),
  }
}

/** Place and axis on body i; of a hinge given by two hardpoints the place keeps its share of the way between them. */
function onBodyI({ body_i, at_i, axis, hinge }: JointMark, move: Move): Pick<JointMark, 'at_i' | 'axis' | 'hinge'> {
  if (!hinge) return { at_i: move(body_i, at_i), axis, hinge }
  const [a, b] = hinge
  const [c, d] = [move(body_i, a), move(body_i, b)]
  const [before, after] = [minus(b, a), minus(d, c)]
  const length = before.lengthSq()
  if (length === 0 || after.lengthSq() === 0 || !axis) return { at_i: move(body_i, at_i), axis, hinge: [c, d] }
  const share = minus(at_i, a).dot(before) / length
  const sense = Math.sign(before.dot(new Vector3(...axis))) || 1
  return {
    at_i: added(c, after.toArray(), share),
    axis: after.normalize().multiplyScalar(sense).toArray(),
    hinge: [c, d],
  }
}

function moved(poses: Curve, shifts: Curve, change: number): Curve {
  const out = Float32Array.from(poses)
  for (let step = 0; step * 7 < poses.length; step++) {
    const pose = poseAt(poses, step)
    if (!pose) continue
    const { place, turn } = shifted(pose, shifts, step, change)
    out.set([place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z], step * 7)
  }
  return out
}

const distance = (a: Place, b: Place) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])
const minus = (a: Place, b: Place) => new Vector3(a[0] - b[0], a[1] - b[1], a[2] - b[2])
const added = (a: Place, v: Place, share: number): Place => [
  a[0] + share * v[0],
  a[1] + share * v[1],
  a[2] + share * v[2],
]
