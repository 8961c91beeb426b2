import { Vector3 } from 'three'
import { across, Basis, farthest, type Flat, hull } from './flat'
import type { Mechanism } from './mechanism'

/**
 * The centre lines of a body in its frame, each once: its hull in its plane, what is inside hung on the nearest corner.
 */
export function centreLines(mechanism: Mechanism, body: number): [Vector3, Vector3][] {
  const points = mechanism.shapePoints(body)
  if (points.length < 2) return []
  const wheel = mechanism.report.wheels.find(({ centre }) => centre.body === body)
  if (wheel) return spokes(points, new Vector3(...wheel.centre.at), new Vector3(...wheel.axis))
  if (points.length === 2) return [[points[0], points[1]]]
  const basis = planeThrough(points)
  const flat = points.map((point) => basis.to(point))
  const corners = hull(flat).map((corner) => flat.indexOf(corner))
  if (corners.length < 3) {
    const [a, b] = farthest(points, (p, q) => p.distanceTo(q))
    return [[a, b]]
  }
  const ring = corners.map((corner, k): [Vector3, Vector3] => [
    points[corner],
    points[corners[(k + 1) % corners.length]],
  ])
  const inner = points.flatMap((point, k): [Vector3, Vector3][] =>
    corners.includes(k) ? [] : [[point, points[nearest(flat, corners, flat[k])]]],
  )
  return [...ring, ...inner]
}

/** From the spindle, where it is nearest to the joints, to each of them and to the wheel's centre. */
function spokes(points: Vector3[], centre: Vector3, axis: Vector3): [Vector3, Vector3][] {
  const mean = points.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(points.length)
  const root = centre.clone().addScaledVector(axis, mean.sub(centre).dot(axis))
  return points.map((point): [Vector3, Vector3] => [root, point])
}

function nearest(flat: Flat[], corners: number[], [x, y]: Flat): number {
  const distance = (k: number) => Math.hypot(flat[k][0] - x, flat[k][1] - y)
  return corners.reduce((best, corner) => (distance(corner) < distance(best) ? corner : best))
}

/** The plane through the two points that are farthest apart and the one farthest from their line. */
function planeThrough(points: Vector3[]): Basis {
  const [a, b] = farthest(points, (p, q) => p.distanceTo(q))
  const along = b.clone().sub(a)
  const normals = points.map((point) => along.clone().cross(point.clone().sub(a)))
  const normal = normals.reduce((best, one) => (one.length() > best.length() ? one : best))
  return normal.length() > 1e-6 * along.lengthSq() ? new Basis(a, normal, along) : new Basis(a, across(along), along)
}

/** True if a body of the former design is anywhere else, or of another form, at any of the moments. */
export function differs(present: Mechanism, former: Mechanism, body: number, minimum: number): boolean {
  const [now, was] = [present, former].map((mechanism) => mechanism.shapePoints(body))
  if (now.length !== was.length) return true
  return present.moments.some((step) =>
    now.some((point, k) => present.worldAt(body, point, step).distanceTo(former.worldAt(body, was[k], step)) > minimum),
  )
}
