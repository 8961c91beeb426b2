import { Quaternion, Vector3 } from 'three'
import type { Curve } from '../curve'
import type { Report } from '../report'

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

/** The path of a body-fixed point through the whole motion. */
export function path(poses: Curve, point: Vector3, stride = 1): Vector3[] {
  const places: Vector3[] = []
  for (let step = 0; step < poses.length / STRIDE; step += stride) {
    const pose = poseAt(poses, step)
    if (pose) places.push(point.clone().applyQuaternion(pose.turn).add(pose.place))
  }
  return places
}

/** Enough steps to bound the motion without walking through every one of a long run. */
const SAMPLES = 64

/** Every place that a hardpoint or joint visits. */
export function visited(report: Report): Vector3[] {
  const points = report.bodies.map((body) => body.skeleton.map((point) => new Vector3(...point)))
  for (const joint of report.joints) {
    points[joint.body_i].push(new Vector3(...joint.at_i))
    points[joint.body_j].push(new Vector3(...joint.at_j))
  }
  const stride = Math.max(1, Math.floor(report.times.length / SAMPLES))
  return report.bodies.flatMap((body, index) => points[index].flatMap((point) => path(body.poses, point, stride)))
}
