import { Vector3 } from 'three'
import type { JointMark } from '../payload'
import type { Mechanism } from './mechanism'

/**
 * Offset of a bearing along its shaft away from another joint at the same place: units, and fraction of the shaft's
 * length.
 */
const ASIDE = { units: 14, part: 0.5 }
/** Joints with glyphs that a bearing in the same place would hide. */
const SHY = ['universal', 'constant_velocity']
/** Cosines of the angles within which hinges are parallel and beyond which they are perpendicular to a link. */
const PARALLEL = 0.999
const SQUARE = 0.05

/**
 * A link that folds on another such link, as Sarrus' plates do: the axis of its two parallel hinges, both perpendicular
 * to it, in its frame.
 */
export function foldAxis(mechanism: Mechanism, body: number): Vector3 | undefined {
  const axis = parallelHinges(mechanism, body)
  const mates = axis
    ? mechanism.jointsOf(body).map(({ joint }) => (joint.body_i === body ? joint.body_j : joint.body_i))
    : []
  return mates.some((mate) => parallelHinges(mechanism, mate)) ? axis : undefined
}

function parallelHinges(mechanism: Mechanism, body: number): Vector3 | undefined {
  if (body === 0 || mechanism.plane || mechanism.vehicle || mechanism.large || mechanism.report.wheels.length > 0)
    return undefined
  const joints = mechanism.jointsOf(body)
  if (
    joints.length !== 2 ||
    mechanism.shapePoints(body).length !== 2 ||
    joints.some(({ joint, axis }) => joint.kind !== 'revolute' || joint.hinge || !axis)
  )
    return undefined
  const [first, second] = joints.map(({ axis }) => axis!.clone().normalize())
  const along = joints[1].at.clone().sub(joints[0].at).normalize()
  return Math.abs(first.dot(second)) > PARALLEL && Math.abs(first.dot(along)) < SQUARE ? first : undefined
}

/**
 * Half the width of a link that folds, and of the part of it that its pin goes through between the eyes of another
 * body, in units.
 */
export const FOLD = { half: 3.4, inner: 1.5 }

/**
 * Axis in the body's frame of the shaft that a body without another place is: where its bearing is drawn aside of the
 * joint there.
 */
export function shaftAxis(mechanism: Mechanism, body: number): Vector3 | undefined {
  const bearing = mechanism
    .jointsOf(body)
    .find(({ joint }) => joint.kind === 'revolute' && (joint.body_i === 0 || joint.body_j === 0) && !joint.hinge)
  if (!bearing?.axis || mechanism.placesOf(body).length !== 1) return undefined
  const place = hingePlaces(mechanism, bearing.joint)[0]
  return mechanism.same(place, new Vector3(...bearing.joint.at_i)) ? undefined : bearing.axis.clone().normalize()
}

/** True if one is ground's: then the other body, its place and axis in its frame; otherwise those of body i. */
export function carried(mechanism: Mechanism, { body_i, body_j, at_i, at_j, axis, axis_j }: JointMark) {
  const moving = body_i > 0 || body_j === 0
  const own = moving ? axis : axis_j
  return {
    body: moving ? body_i : body_j,
    at: new Vector3(...(moving ? at_i : at_j)),
    axis: own ? new Vector3(...own).normalize() : mechanism.into(moving ? body_i : body_j, new Vector3(0, 0, 1)),
  }
}

/**
 * Positions of a hinge, in the frame of body i: at the hardpoints that define its axis, or along the axis from another
 * joint.
 */
export function hingePlaces(mechanism: Mechanism, joint: JointMark): Vector3[] {
  if (joint.hinge && !mechanism.plane) return joint.hinge.map((point) => new Vector3(...point))
  const at = new Vector3(...joint.at_i)
  if (mechanism.plane || !joint.axis || (joint.body_i !== 0 && joint.body_j !== 0)) return [at]
  const { body, at: own, axis } = carried(mechanism, joint)
  const hidden = mechanism
    .jointsOf(body)
    .some((other) => SHY.includes(other.joint.kind) && mechanism.same(other.at, own))
  if (!hidden) return [at]
  const along = mechanism.report.bodies[body].skeleton.map((point) => new Vector3(...point).sub(own).dot(axis))
  const reach = along.reduce((far, one) => (Math.abs(one) > Math.abs(far) ? one : far), 0)
  const by = Math.sign(reach) * Math.min(ASIDE.units * mechanism.unit, ASIDE.part * Math.abs(reach))
  return [at.addScaledVector(mechanism.into(joint.body_i, mechanism.alongAt(body, axis, 0)), by)]
}

/** Centre of the other points of a body, in its frame; the point itself if there are none. */
export function restOf(mechanism: Mechanism, body: number, at: Vector3): Vector3 {
  const others = mechanism.shapePoints(body).filter((point) => !mechanism.same(point, at))
  return others.length > 0
    ? others.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(others.length)
    : at.clone()
}

/** Unit vector in a body's frame from a point on it to its other points; `otherwise` if there are none. */
export function towardsRest(mechanism: Mechanism, body: number, at: Vector3, otherwise: Vector3): Vector3 {
  const direction = restOf(mechanism, body, at).sub(at)
  const shaft = shaftAxis(mechanism, body)
  if (shaft) return shaft.multiplyScalar(Math.sign(shaft.dot(direction)) || 1)
  return direction.length() > 1e-6 * mechanism.size ? direction.normalize() : otherwise.clone()
}
