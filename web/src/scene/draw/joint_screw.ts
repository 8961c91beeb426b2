import { CylinderGeometry, Quaternion, Vector3 } from 'three'
import { place } from '../kit'
import { Helix } from '../shapes/helix'
import { type DrawJoint, piece } from './joint'
import { guideEnds } from './guide_ends'

/** Radius of the rod and its least length; the thread's line, and from one turn of it to the next. */
const ROD = { radius: 1.15, length: 26 }
const THREAD = { radius: 1.25, pitch: 1.1, width: 1 }
/** Points per turn of the line. */
const ROUND = 16
/** Radius and height of the nut. */
const NUT = [2.9, 2.4]
const Y = new Vector3(0, 1, 0)

/** A threaded rod on body i with a hexagonal nut on body j. */
export const screw: DrawJoint = (mechanism, kit, joint) => {
  const { steel, outline } = kit.palette
  const r = mechanism.radiusOf(joint)
  const axis = new Vector3(...(joint.axis ?? [0, 0, 1])).normalize()
  const at = new Vector3(...joint.at_i)
  const nutAt = new Vector3(...joint.at_j)
  const travel = mechanism.moments
    .map((step) =>
      mechanism
        .placeInto(joint.body_i, mechanism.worldAt(joint.body_j, nutAt, step), step)
        .sub(at)
        .dot(axis),
    )
    .filter(Number.isFinite)
  const [low, high] = [Math.min(0, ...travel), Math.max(0, ...travel)]
  const room = Math.max((ROD.length * r - (high - low)) / 2, NUT[1] * r)
  const [from, to] = [low - room, high + room].map((t) => at.clone().addScaledVector(axis, t))
  const length = from.distanceTo(to)
  const turns = Math.max(1, Math.round(length / (THREAD.pitch * r)))
  const helix = new Helix(THREAD.radius * r, length, turns)
  const turn = new Quaternion().setFromUnitVectors(Y, axis)
  const thread = Array.from({ length: turns * ROUND + 1 }, (_, k) =>
    helix
      .getPoint(k / (turns * ROUND))
      .applyQuaternion(turn)
      .add(from),
  )
  const nut = kit.mesh(new CylinderGeometry(NUT[0] * r, NUT[0] * r, NUT[1] * r, 6), kit.body(joint.body_j), {
    edges: 30,
    facets: true,
  })
  const own = joint.axis_j
    ? new Vector3(...joint.axis_j)
    : mechanism.into(joint.body_j, mechanism.alongAt(joint.body_i, axis, 0))
  return [
    piece(
      joint.body_i,
      kit.cylinder(from, to, ROD.radius * r, ROD.radius * r, steel),
      kit.line(thread, outline, THREAD.width, { opacity: 0.7 }),
      ...(joint.body_i === 0 ? guideEnds(mechanism, kit, from, to, r) : []),
    ),
    piece(joint.body_j, place(nut, nutAt, own)),
  ]
}
