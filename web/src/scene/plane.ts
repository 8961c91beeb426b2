import { Box3, Vector3 } from 'three'
import type { Report } from '../report'
import { poseAt, turned } from './poses'

/** A mechanism whose joints and hardpoints leave a plane by less than this part of its size is planar. */
const FLAT = 2e-3
/** Least cosine between two hinges that count as parallel. */
const PARALLEL = 0.999

/**
 * The normal of the plane that a mechanism moves in, towards the reader; none for a spatial one. `sweep`: the places of
 * its joints and hardpoints. A measured point may be beside the plane, as that of a coupler in front of its rod.
 */
export function planeOf(report: Report, sweep: Vector3[], size: number): Vector3 | undefined {
  if (report.wheels.length > 0 || report.vehicle) return undefined
  const hinges = report.joints
    .filter((joint) => joint.kind === 'revolute' && joint.axis)
    .map((joint) => turned(poseAt(report.bodies[joint.body_i].poses, 0), new Vector3(...joint.axis!)))
    .filter(({ x }) => Number.isFinite(x))
  const normal = hinges[0]?.clone().normalize()
  if (!normal || !hinges.every((axis) => Math.abs(axis.dot(normal)) > PARALLEL)) return undefined
  const heights = new Box3().setFromPoints(sweep.map((point) => new Vector3(point.dot(normal), 0, 0)))
  if (heights.max.x - heights.min.x > FLAT * size) return undefined
  return normal.multiplyScalar(towardsReader(normal))
}

/** x and z point to the viewer, y away: in the plane xz, z points up and x to the right. */
function towardsReader({ x, y, z }: Vector3): number {
  const maximum = Math.max(Math.abs(x), Math.abs(y), Math.abs(z))
  if (Math.abs(z) === maximum) return Math.sign(z)
  return Math.abs(y) === maximum ? -Math.sign(y) : Math.sign(x)
}
