import { Vector3 } from 'three'
import type { JointMark } from '../payload'
import type { Mechanism } from './mechanism'

/** How far a bearing is moved along its shaft away from another joint in its place: units, and part of the shaft's length. */
const ASIDE = { units: 14, part: 0.5 }
/** Joints with glyphs that a bearing in the same place would hide. */
const SHY = ['universal', 'constant_velocity']

/** Whether one is ground's: then the other body, its place and axis in its frame; otherwise those of body i. */
export function carried(mechanism: Mechanism, { body_i, body_j, at_i, at_j, axis, axis_j }: JointMark) {
  const moving = body_i > 0 || body_j === 0
  const own = moving ? axis : axis_j
  return {
    body: moving ? body_i : body_j,
    at: new Vector3(...(moving ? at_i : at_j)),
    axis: own ? new Vector3(...own).normalize() : mechanism.into(moving ? body_i : body_j, new Vector3(0, 0, 1)),
  }
}

/** Where a hinge is drawn, in the frame of body i: at the hardpoints that its axis is given by, or along the axis from where another joint is. */
export function hingePlaces(mechanism: Mechanism, joint: JointMark): Vector3[] {
  if (joint.hinge && !mechanism.plane) return joint.hinge.map((point) => new Vector3(...point))
  const at = new Vector3(...joint.at_i)
  if (mechanism.plane || !joint.axis || (joint.body_i !== 0 && joint.body_j !== 0)) return [at]
  const { body, at: own, axis } = carried(mechanism, joint)
  const hidden = mechanism.jointsOf(body).some((other) => SHY.includes(other.joint.kind) && mechanism.same(other.at, own))
  if (!hidden) return [at]
  const along = mechanism.report.bodies[body].skeleton.map((point) => new Vector3(...point).sub(own).dot(axis))
  const reach = along.reduce((far, one) => (Math.abs(one) > Math.abs(far) ? one : far), 0)
  const by = Math.sign(reach) * Math.min(ASIDE.units * mechanism.unit, ASIDE.part * Math.abs(reach))
  return [at.addScaledVector(mechanism.into(joint.body_i, mechanism.alongAt(body, axis, 0)), by)]
}

/** The middle of what else of a body is at hand, in its frame; the place itself where there is nothing else. */
export function restOf(mechanism: Mechanism, body: number, at: Vector3): Vector3 {
  const others = mechanism.shapePoints(body).filter((point) => !mechanism.same(point, at))
  return others.length > 0 ? others.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(others.length) : at.clone()
}

/** Unit vector in a body's frame from a place on it to the rest of it; `otherwise` where there is no rest. */
export function towardsRest(mechanism: Mechanism, body: number, at: Vector3, otherwise: Vector3): Vector3 {
  const way = restOf(mechanism, body, at).sub(at)
  return way.length() > 1e-6 * mechanism.size ? way.normalize() : otherwise.clone()
}
