import { Vector3 } from 'three'
import { carried, hingePlaces } from '../hinge'
import { shaftJoints } from '../shafts'
import { type DrawJoint, piece } from './joint'

/** A pin's radius and length, and a bush's, in radii of the glyph. */
const PIN = [1, 3.9]
const BUSH = [1.65, 2]
/** From above: the ring's radius, the dot's, and by how many layers the pin is longer than its links are thick. */
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
    if (mechanism.large) return [piece(body, kit.disc(above(topLayer + 0.6), normal, SMALL * kit.unit, 0.2 * kit.unit, steel))]
    const [low, high] = [joint.body_i, joint.body_j].map((one) => mechanism.layerOf(one)).sort((a, b) => a - b)
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
  const places = hingePlaces(mechanism, joint).map((place) => mechanism.placeInto(body, mechanism.worldAt(joint.body_i, place, 0)))
  const held = joint.body_j > 0 ? joint.body_j : joint.body_i
  const bushes = joint.hinge ? places.map((place) => kit.disc(place, axis, BUSH[0] * r, BUSH[1] * r, kit.body(held))) : []
  return [piece(body, ...places.map((place: Vector3) => kit.disc(place, axis, PIN[0] * r, PIN[1] * r, steel)), ...bushes)]
}
