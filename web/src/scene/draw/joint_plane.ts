import { type Object3D, Vector3 } from 'three'
import { Basis, type Flat } from '../flat'
import type { JointMark } from '../../payload'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { type DrawJoint, piece } from './joint'
import { slottedPin } from './joint_slot'

/** Minimum side of the plate, thickness, margin around the moving points, and opacity. */
const PLATE = { side: 10, thickness: 0.25, room: 3, opacity: 0.5 }
const BALL = 1.2
/** Radius and height of a foot that lies flat on the plate. */
const FOOT = [2.2, 0.8]

/** Joint on a plane of the other body: a ball or a flat foot on a plate; seen along the plane, a pin in a slot. */
export const onPlane: DrawJoint = (mechanism, kit, joint, index) => {
  const flat = joint.kind === 'planar'
  if (mechanism.plane && !flat) return slottedPin(mechanism, kit, joint, index)
  const r = mechanism.radiusOf(joint)
  const normal = new Vector3(...(joint.axis ?? [0, 0, 1])).normalize()
  const place = new Vector3(...joint.at_j)
  const basis = new Basis(
    new Vector3(...joint.at_i),
    normal,
    joint.axis2 && joint.kind === 'planar' ? new Vector3(...joint.axis2) : undefined,
  )
  const spots = visited(mechanism, joint, place).map((spot) => basis.to(spot))
  const [x, y] = [0, 1].map((k) => spots.map((spot) => spot[k]))
  const edges = ([x, y] as const).map((values) => {
    const [low, high] = [Math.min(...values), Math.max(...values)]
    const half = Math.max((PLATE.side / 2) * r, (high - low) / 2 + PLATE.room * r)
    return [(low + high) / 2 - half, (low + high) / 2 + half]
  })
  const [[left, right], [bottom, top]] = edges
  const outline: Flat[] = [
    [left, bottom],
    [right, bottom],
    [right, top],
    [left, top],
  ]
  const plate = kit.slab(outline, basis, PLATE.thickness * r, kit.body(joint.body_i), [], {
    opacity: PLATE.opacity,
    edges: 20,
  })
  const own = joint.axis_j
    ? new Vector3(...joint.axis_j)
    : mechanism.into(joint.body_j, mechanism.alongAt(joint.body_i, normal, 0))
  const rider = flat
    ? kit.disc(place, own, FOOT[0] * r, FOOT[1] * r, kit.body(joint.body_j))
    : kit.ball(place, BALL * r, kit.palette.steel)
  const hatch = joint.body_i === 0 ? hatched(mechanism, kit, basis, outline, r) : []
  return [piece(joint.body_i, plate, ...hatch), piece(joint.body_j, rider)]
}

/** Ground's strokes: below a surface seen from its side, round one seen from above. */
function hatched({ plane }: Mechanism, kit: Kit, basis: Basis, outline: Flat[], r: number): Object3D[] {
  const corners = outline.map((corner) => basis.from(corner))
  const sides = corners.map((corner, k) => [corner, corners[(k + 1) % corners.length]] as const)
  if (!plane) return sides.map(([a, b]) => kit.hatchLine(a, b, b.clone().sub(a).cross(basis.normal), r))
  const seen = sides.find(([a, b]) => Math.abs(b.clone().sub(a).normalize().dot(plane)) < 0.1)
  return seen ? [kit.hatchLine(seen[0], seen[1], basis.normal.clone().negate(), r)] : []
}

/** Positions of a point of body j on body i. */
function visited(mechanism: Mechanism, { body_i, body_j, at_i }: JointMark, place: Vector3): Vector3[] {
  const spots = mechanism.moments
    .map((step) => mechanism.placeInto(body_i, mechanism.worldAt(body_j, place, step), step))
    .filter(({ x, y, z }) => Number.isFinite(x + y + z))
  return spots.length > 0 ? spots : [new Vector3(...at_i)]
}
