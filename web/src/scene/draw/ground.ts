import { Group, Vector3 } from 'three'
import type { Drawable } from '../drawable'
import type { JointMark } from '../../payload'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { bodyPart } from '../part'
import { foldAxis, hingePlaces } from '../hinge'
import { shaftJoints } from '../shafts'
import { planarFoot } from './ground_planar'
import { ballFoot, hingeFoot } from './ground_spatial'

/** A place that ground holds something at. */
export interface Foot {
  /** In the world. */
  at: Vector3
  /** Axis of the hinge there; a ball or the like where there is none. */
  axis?: Vector3
  /** Direction to the rest of the supported part, in the world. */
  towards: Vector3
  radius: number
  /** Minimum reach of the supported part's mesh towards the plate; 0 without one. */
  clear?: (down: Vector3, half: number) => number
  /**
   * One of the two of a hinge between hardpoints, which are lugs; a plate that folds has its cheeks outside its eye.
   */
  form?: 'lug' | 'fold'
  /** In front of a cam that would cover it. */
  front: boolean
}

/** Joints that are mounted on a foot; rails and shafts have their own. */
const HINGES = ['revolute', 'inline', 'cylindrical']
const BALLS = ['spherical', 'universal', 'constant_velocity', 'distance', 'leg', 'point_coincident']

/** Ground: the feet of all joints with ground, each place once. */
export function ground(mechanism: Mechanism, kit: Kit): Drawable[] {
  const part = bodyPart(mechanism, 0)
  const kept: Foot[] = []
  for (const foot of feet(mechanism))
    if (!kept.some(({ at }) => at.distanceTo(foot.at) < 1e-3 * mechanism.size)) kept.push(foot)
  return kept.map((foot) => {
    const pieces = mechanism.plane
      ? planarFoot(mechanism, kit, foot)
      : foot.axis
        ? hingeFoot(mechanism, kit, foot)
        : ballFoot(mechanism, kit, foot)
    return { body: 0, object: new Group().add(...pieces), part, detail: foot.radius }
  })
}

function feet(mechanism: Mechanism): Foot[] {
  const { report } = mechanism
  const turning = shaftJoints(mechanism.report)
  const front = (body: number) => report.joints.some(({ curve, body_i }) => curve && body_i === body)
  const joints = report.joints.flatMap((joint, index): Foot[] => {
    const { body_i, body_j, kind } = joint
    if ((body_i !== 0 && body_j !== 0) || turning.has(index)) return []
    const hinge = HINGES.includes(kind)
    if (!hinge && !BALLS.includes(kind)) return []
    // The slider is at the ends of its travel.
    if ((kind === 'cylindrical' || kind === 'inline') && !(mechanism.plane && square(mechanism, joint))) return []
    const [body, place, own] = body_i === 0 ? [body_j, joint.at_i, joint.at_j] : [body_i, joint.at_j, joint.at_i]
    const at = mechanism.worldAt(0, new Vector3(...place), 0)
    const held = new Vector3(...own)
    const axis =
      hinge && joint.axis ? mechanism.alongAt(joint.body_i, new Vector3(...joint.axis), 0).normalize() : undefined
    const radius = mechanism.radiusAt(body, held)
    const rod = kind === 'distance' || kind === 'leg'
    const spots = axis ? hingePlaces(mechanism, joint).map((point) => mechanism.worldAt(body_i, point, 0)) : [at]
    const aside = mechanism
      .shapePoints(body)
      .map((point) => mechanism.worldAt(body, point, 0))
      .filter((point) => !axis || point.clone().sub(at).cross(axis).length() > 2e-3 * mechanism.size)
    const form = joint.hinge ? ('lug' as const) : foldAxis(mechanism, body) ? ('fold' as const) : undefined
    return spots.map((spot) => ({
      at: spot,
      axis,
      radius,
      form,
      clear: clearance(mechanism, body, spot),
      front: front(body),
      towards: rod ? mechanism.worldAt(body, held, 0) : mean(aside, spot),
    }))
  })
  const distances =
    report.wheels.length === 0
      ? []
      : report.distances.flatMap(({ from, to }): Foot[] => {
          if (from.body !== 0 && to.body !== 0) return []
          const [fixed, other] = from.body === 0 ? [from, to] : [to, from]
          const [at, towards] = [fixed, other].map((place) =>
            mechanism.worldAt(place.body, new Vector3(...place.at), 0),
          )
          return [{ at, towards, radius: mechanism.unit, front: false }]
        })
  return [...joints, ...distances]
}

const mean = (points: Vector3[], none: Vector3) =>
  points.length > 0
    ? points.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(points.length)
    : none.clone()

/** True if an axis is perpendicular to the plane: a slide along it is a pin there. */
const square = (mechanism: Mechanism, { axis, body_i }: JointMark) =>
  axis !== null && Math.abs(mechanism.alongAt(body_i, new Vector3(...axis), 0).dot(mechanism.plane!)) > 0.9

/** Preference of the downward direction. */
const DOWNWARDS = 0.25

/** World axis that points away from the mounted body, preferably downwards, never along the hinge. */
export function downwards(mechanism: Mechanism, { at, axis, towards }: Foot): Vector3 {
  const away = at.clone().sub(towards)
  if (away.length() < 1e-6 * mechanism.size) away.copy(mechanism.up).negate()
  away.normalize()
  const directions = [0, 1, 2].flatMap((k) => [1, -1].map((sign) => new Vector3().setComponent(k, sign)))
  const worth = (direction: Vector3) => direction.dot(away) + (direction.dot(mechanism.up) < -0.5 ? DOWNWARDS : 0)
  const free = directions.filter((direction) => !axis || Math.abs(direction.dot(axis)) < 0.6)
  const best = free.reduce((a, b) => (worth(b) > worth(a) ? b : a))
  return axis ? best.addScaledVector(axis, -best.dot(axis)).normalize() : best
}

/** Maximum number of sampled vertices of a mesh, and stride of the sampled steps. */
const VERTICES = 3000
const EVERY = 8

/** Reach of a body's own shape from a point in a direction, within a lateral distance, over the whole motion. */
function clearance(mechanism: Mechanism, body: number, at: Vector3): Foot['clear'] {
  const { mesh } = mechanism.report.bodies[body]
  if (!mesh) return undefined
  const stride = 3 * Math.max(1, Math.ceil(mesh.positions.length / 3 / VERTICES))
  const vertices = Array.from({ length: Math.floor(mesh.positions.length / stride) }, (_, k) =>
    new Vector3().fromArray(mesh.positions, k * stride),
  )
  return (down, half) => {
    const reach = mechanism.moments
      .filter((_, k) => k % EVERY === 0)
      .flatMap((step) =>
        vertices
          .map((vertex) => mechanism.worldAt(body, vertex, step).sub(at))
          .map((from) => [from.dot(down), from.clone().cross(down).length()] as const),
      )
    return reach.reduce((maximum, [along, aside]) => (aside < half && along > maximum ? along : maximum), 0)
  }
}
