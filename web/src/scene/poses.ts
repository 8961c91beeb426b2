import { Quaternion, Vector3 } from 'three'
import type { Curve } from '../curve'
import { roundBelow } from '../format'
import type { Arrow } from '../payload'
import type { Variable } from '../report'

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
  const [x, y, z, qw, qx, qy, qz] = poses.subarray(k * STRIDE, (k + 1) * STRIDE)
  return { place: new Vector3(x, y, z), turn: new Quaternion(qx, qy, qz, qw) }
}

const SHIFT = 6

/** The pose of a body whose design is changed, foreseen to first order. */
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

/** How far the points of a body are from one another, as a part of the whole, for them to be the same. */
const SAME = 1e-6

/** The points of a body, gone with the design velocity of the variable. */
export function reshaped(points: [number, number, number][], arrows: Arrow[], body: number, change: number, size: number) {
  return points.map((point): [number, number, number] => {
    const moves = arrows.find((arrow) => arrow.body === body && arrow.at.every((x, k) => Math.abs(x - point[k]) < SAME * size))
    return moves ? [0, 1, 2].map((k) => point[k] + change * moves.v[k]) as [number, number, number] : point
  })
}

/** A change of a variable that moves something by about a tenth of the mechanism. */
export function visibleChange(variable: Variable, size: number): number {
  const moves = variable.arrows.map(({ v }) => Math.hypot(...v))
  for (const shifts of variable.shifts) {
    for (let k = 0; k < shifts.length; k += SHIFT) moves.push(Math.hypot(...shifts.subarray(k, k + 3)))
  }
  const most = Math.max(...moves.filter(Number.isFinite), 0)
  return most > 0 ? roundBelow((0.1 * size) / most) : 0
}

/** The path of a body-fixed point through the whole motion. */
export function path(poses: Curve, point: Vector3, stride = 1): Vector3[] {
  const places: Vector3[] = []
  for (let step = 0; step < poses.length / STRIDE; step += stride) {
    const pose = poseAt(poses, step)
    if (pose) places.push(point.clone().applyQuaternion(pose.turn).add(pose.place))
  }
  return places
}

/** A direction of a body in the world, or nothing where the motion was not solved. */
export function alongAt(poses: Curve, direction: Vector3, step: number): Vector3 | undefined {
  const pose = poseAt(poses, step)
  return pose && direction.clone().applyQuaternion(pose.turn)
}
