import { type Object3D, Vector3 } from 'three'
import type { WheelMark } from '../../payload'
import { area, Basis, hull } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

const SPINDLE = 1.5
const BEARING = { radius: 2.8, height: 2.2 }
/** Radii of an arm at the bearing and at its joint. */
const ARM = [1.7, 1]
/** The hub's disc, and the least distance of the bearing from it, as parts of the wheel's radius. */
const HUB = 0.22
const INBOARD = 0.12
/** More joints than this make a ring with short arms instead of a star. */
const STAR = 3

/** Knuckle of a wheel: spindle, bearing and arms to its joints. */
export function upright(mechanism: Mechanism, kit: Kit, body: number, wheel: WheelMark): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const hub = new Vector3(...wheel.centre.at)
  const axis = new Vector3(...wheel.axis).normalize()
  const points = mechanism.shapePoints(body).filter((point) => point.distanceTo(hub) > s)
  const offsets = points.map((point) => point.clone().sub(hub).dot(axis))
  const mean = offsets.reduce((sum, offset) => sum + offset, 0) / (offsets.length || 1)
  const side = Math.sign(mean) || -1
  const root = hub.clone().addScaledVector(axis, side * Math.max(Math.abs(mean), INBOARD * wheel.radius))
  const pieces: Object3D[] = [
    kit.cylinder(root, hub, SPINDLE * s, SPINDLE * s, colour),
    kit.disc(root, axis, BEARING.radius * s, BEARING.height * s, colour),
    kit.disc(hub.clone().addScaledVector(axis, side * 0.5 * s), axis, HUB * wheel.radius, s, colour),
  ]
  const arm = (from: Vector3, to: Vector3) => {
    if (from.distanceTo(to) < s) return
    pieces.push(kit.cylinder(from, to, ARM[0] * s, ARM[1] * s, colour), kit.ball(to, 1.1 * ARM[1] * s, colour))
  }
  if (points.length > STAR) pieces.push(...frame(kit, points, root, axis, colour, arm))
  else points.forEach((point) => arm(root, point))
  return pieces
}

/** Many joints: a frame through them all, seen along the spin axis, that the bearing sits in. */
function frame(
  kit: Kit,
  points: Vector3[],
  root: Vector3,
  axis: Vector3,
  colour: string,
  arm: (from: Vector3, to: Vector3) => void,
): Object3D[] {
  const s = kit.unit
  const basis = new Basis(root, axis)
  const flat = points.map((point) => basis.to(point))
  const corners = hull(flat)
  if (corners.length < 3 || area(corners) < 20 * s * s) {
    points.forEach((point) => arm(root, point))
    return []
  }
  const ring = corners.map((corner) => points[flat.indexOf(corner)])
  const pieces: Object3D[] = ring.flatMap((point, k) => {
    const next = ring[(k + 1) % ring.length]
    return [
      kit.cylinder(point, next, ARM[1] * s, ARM[1] * s, colour),
      kit.triangles([root, point, next], colour, { open: true, facets: true }),
      kit.ball(point, 1.2 * ARM[1] * s, colour),
    ]
  })
  for (const point of points) if (!ring.includes(point)) arm(root, point)
  return pieces
}
