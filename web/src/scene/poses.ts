import { Quaternion, Vector3 } from 'three'
import type { Curve } from '../curve'

const STRIDE = 7

export interface Pose {
  place: Vector3
  turn: Quaternion
}

/** The pose at a fractional step, or undefined where the motion was not solved. */
export function poseAt(poses: Curve, step: number): Pose | undefined {
  const last = poses.length / STRIDE - 1
  const k = Math.min(Math.floor(step), last)
  const pose = read(poses, k)
  if (step > k && k < last) {
    const next = read(poses, k + 1)
    pose.place.lerp(next.place, step - k)
    pose.turn.slerp(next.turn, step - k)
  }
  return Number.isFinite(pose.place.x + pose.turn.w) ? pose : undefined
}

function read(poses: Curve, k: number): Pose {
  const at = k * STRIDE
  return {
    place: new Vector3(poses[at], poses[at + 1], poses[at + 2]),
    turn: new Quaternion(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]),
  }
}

const SHIFT = 6

/** The pose of a body whose design is changed, predicted to first order. */
export function shifted(pose: Pose, shifts: Curve | undefined, step: number, change: number): Pose {
  if (!shifts) return pose
  const last = shifts.length / SHIFT - 1
  const before = Math.min(Math.floor(step), last)
  const after = Math.min(before + 1, last)
  const number = (k: number) => {
    const [a, b] = [shifts[before * SHIFT + k], shifts[after * SHIFT + k]]
    return (a + (b - a) * Math.min(step - before, 1)) * change
  }
  const [x, y, z, rx, ry, rz] = [0, 1, 2, 3, 4, 5].map(number)
  const turn = new Vector3(rx, ry, rz)
  const angle = turn.length()
  const place = pose.place.clone().add(new Vector3(x, y, z))
  if (angle === 0) return { place, turn: pose.turn }
  return { place, turn: new Quaternion().setFromAxisAngle(turn.divideScalar(angle), angle).multiply(pose.turn) }
}

/** A body-fixed point in the world; NaN where the body has no pose. */
export function placed(pose: Pose | undefined, point: Vector3): Vector3 {
  return pose ? point.clone().applyQuaternion(pose.turn).add(pose.place) : new Vector3(NaN, NaN, NaN)
}

/** A body-fixed direction in the world; NaN where the body has no pose. */
export function turned(pose: Pose | undefined, direction: Vector3): Vector3 {
  return pose ? direction.clone().applyQuaternion(pose.turn) : new Vector3(NaN, NaN, NaN)
}

/** The path of a body-fixed point through the whole motion. */
export function path(poses: Curve, point: Vector3, stride = 1): Vector3[] {
  const places: Vector3[] = []
  for (let step = 0; step < poses.length / STRIDE; step += stride) {
    const pose = poseAt(poses, step)
    if (pose) places.push(placed(pose, point))
  }
  return places
}
