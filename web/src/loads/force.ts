import { Quaternion, Vector3 } from 'three'
import type { Curve } from '../curve'
import type { Load } from '../report'
import { poseAt } from '../scene/poses'

/** The force at a fractional step, in the world; not a number where it is not known. */
export function forceAt(force: Curve, step: number): Vector3 {
  const last = force.length / 3 - 1
  const before = Math.min(Math.floor(step), last)
  const after = Math.min(before + 1, last)
  const share = Math.min(step - before, 1)
  const at = (axis: number) => {
    const [a, b] = [force[3 * before + axis], force[3 * after + axis]]
    return share > 0 ? a + share * (b - a) : a
  }
  return new Vector3(at(0), at(1), at(2))
}

/** The largest of some forces over the motion, N; 0 where nothing is known. */
export function largestForce(loads: Load[]): number {
  let maximum = 0
  for (const { force } of loads) {
    for (let k = 0; k < force.length; k += 3) {
      const size = Math.hypot(force[k], force[k + 1], force[k + 2])
      if (size > maximum) maximum = size
    }
  }
  return maximum
}

/** When a force is largest: a step. */
export function largestAt(force: Curve): number {
  let [maximum, at] = [-1, 0]
  for (let k = 0; k < force.length / 3; k++) {
    const size = Math.hypot(force[3 * k], force[3 * k + 1], force[3 * k + 2])
    if (size > maximum) [maximum, at] = [size, k]
  }
  return at
}

/** A plane in a body's frame: the two directions that span it, and their names. */
export interface Plane {
  across: [Vector3, Vector3]
  names: [string, string]
}

const AXES = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)]
const NAMES = ['x', 'y', 'z']
/** A component that is no more than this is none. */
const NONE = 1e-6

/**
 * The plane across a direction of a body's frame; it begins at the frame's axis that is most across, in the order x y
 * z.
 */
export function planeAcross(normal: Vector3): Plane {
  const n = normal.clone().normalize()
  const along = n.toArray().map(Math.abs)
  // The axis after the one that the normal is nearest to.
  const first = (along.indexOf(Math.max(...along)) + 1) % 3
  const u = AXES[first].clone().addScaledVector(n, -n.dot(AXES[first])).normalize()
  const v = n.clone().cross(u)
  const name = (direction: Vector3) => {
    const k = direction.toArray().findIndex((x) => Math.abs(Math.abs(x) - 1) < NONE)
    return k < 0 ? '' : `${direction.getComponent(k) < 0 ? '−' : ''}${NAMES[k]}`
  }
  return { across: [u, v], names: [name(u) || `${NAMES[first]}, across`, name(v) || 'perpendicular to it'] }
}

/** A force as a body sees it, in a plane of its frame: two numbers; not a number where it is not known. */
export function seenFrom(force: Vector3, turn: Quaternion, { across: [u, v] }: Plane): [number, number] {
  const inBody = force.clone().applyQuaternion(turn.clone().invert())
  return [inBody.dot(u), inBody.dot(v)]
}

/** The path of a force in body components, N; `sign` -1 for the force on body i. */
export function pathOf(force: Curve, poses: Curve, plane: Plane, sign: 1 | -1): [number, number][] {
  return Array.from({ length: force.length / 3 }, (_, k) => {
    const pose = poseAt(poses, k)
    return pose ? seenFrom(forceAt(force, k).multiplyScalar(sign), pose.turn, plane) : [NaN, NaN]
  })
}
