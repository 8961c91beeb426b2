import type { Vector3 } from 'three'
import type { JointMark } from '../../payload'
import { carried, FOLD, foldAxis, hingePlaces } from '../hinge'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { shaftJoints } from '../shafts'
import { type DrawJoint, piece } from './joint'

/** A pin's radius and length, and a bush's, in radii of the glyph. */
const PIN = [1, 5.2]
const BUSH = [1.65, 2]
/** The dashed line of a hinge's axis: overhang on either side in radii, and width in px. */
const AXIS = { reach: 7, line: 1.3 }
/** Radius of a shaft to a bearing that is drawn aside of another joint. */
const SHAFT = 1.1
/** A pin through links that fold, in units. */
const WIDE = 2 * FOLD.half + 0.8
/** From above: radii of ring and dot, and length of the pin beyond the thickness of its links, in layers. */
const FLAT = { ring: 0.85, dot: 0.28, longer: 1.2 }
/** A pin in a large model, in units. */
const SMALL = 0.6

/** A pin; with a bush at each of two hardpoints where the hinge is given so. */
export const hinge: DrawJoint = (mechanism, kit, joint, index) => {
  const { steel, outline } = kit.palette
  const { body, at, axis } = carried(mechanism, joint)
  const r = mechanism.radiusOf(joint)
  if (mechanism.plane) {
    const { pitch, topLayer } = mechanism
    const normal = mechanism.into(body, mechanism.plane)
    const above = (layers: number) => at.clone().addScaledVector(normal, layers * pitch)
    if (mechanism.large)
      return [piece(body, kit.disc(above(topLayer + 0.6), normal, SMALL * kit.unit, 0.2 * kit.unit, steel))]
    const bodies = [joint.body_i, joint.body_j]
    const [low, links] = bodies.map((one) => mechanism.layerOf(one)).sort((a, b) => a - b)
    // A cam has its foot in front of it.
    const cam = bodies.some((one) => mechanism.report.joints.some(({ curve, body_i }) => curve && body_i === one))
    const high = cam ? Math.max(links, topLayer + 1) : links
    return [
      piece(
        body,
        kit.disc(above((low + high) / 2), normal, FLAT.ring * r, (high - low + FLAT.longer) * pitch, steel),
        kit.disc(above(high + 0.62), normal, FLAT.dot * r, 0.1 * kit.unit, outline),
      ),
    ]
  }
  if (mechanism.large) return [piece(body, kit.ball(at, SMALL * kit.unit, steel))]
  if (shaftJoints(mechanism.report).has(index)) return []
  const places = hingePlaces(mechanism, joint).map((place) =>
    mechanism.placeInto(body, mechanism.worldAt(joint.body_i, place, 0)),
  )
  const bushed = joint.body_j > 0 ? joint.body_j : joint.body_i
  const bushes = joint.hinge
    ? places.map((place) => kit.disc(place, axis, BUSH[0] * r, BUSH[1] * r, kit.body(bushed)))
    : []
  const wide = [joint.body_i, joint.body_j].some((one) => foldAxis(mechanism, one))
  const pins = places.map((place) => kit.disc(place, axis, PIN[0] * r, wide ? WIDE * kit.unit : PIN[1] * r, steel))
  return [
    piece(
      body,
      ...pins,
      ...axisLine(mechanism, kit, joint, places, axis, r),
      ...bushes,
      ...places
        .filter((place) => !joint.hinge && !mechanism.same(place, at))
        .map((place) => shaft(kit, at, place, r, kit.body(body))),
    ),
  ]
}

/** The axis itself, for hinges with different axes. */
function axisLine(
  { vehicle, report }: Mechanism,
  kit: Kit,
  { hinge }: JointMark,
  places: Vector3[],
  axis: Vector3,
  r: number,
) {
  if (hinge || vehicle || report.wheels.length > 0) return []
  const end = (place: Vector3, side: number) => place.clone().addScaledVector(axis, side * AXIS.reach * r)
  return places.map((place) =>
    kit.line([end(place, -1), end(place, 1)], kit.palette.label, AXIS.line, { dashed: true, opacity: 0.75 }),
  )
}

/** From a joint in the bearing's place to the bearing and a little through it. */
function shaft(kit: Kit, from: Vector3, bearing: Vector3, r: number, colour: string) {
  const along = bearing.clone().sub(from).normalize()
  return kit.cylinder(from, bearing.clone().addScaledVector(along, PIN[1] * r), SHAFT * r, SHAFT * r, colour)
}
