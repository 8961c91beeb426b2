import { SphereGeometry, Vector3 } from 'three'
import { carried, towardsRest } from '../hinge'
import { Basis } from '../flat'
import { place } from '../kit'
import { type DrawJoint, piece } from './joint'

/** Radii of ball and cup, and the cup's opening as a part of π from its pole. */
const BALL = 1.55
const CUP = 1.95
const OPENING = 0.42
/** From above: ball, the arc round it, half its angle in radians, and its line in px. */
const FLAT = { ball: 1.45, arc: 2.1, half: 1.92, line: 2.4 }

/** A ball in a cup. */
export const spherical: DrawJoint = (mechanism, kit, joint) => {
  const { steel, outline } = kit.palette
  const r = mechanism.radiusOf(joint)
  const { body, at } = carried(mechanism, joint)
  if (mechanism.large) return [piece(body, kit.ball(at, 0.6 * kit.unit, steel))]
  if (mechanism.plane) {
    const normal = mechanism.into(body, mechanism.plane)
    const layers = (mechanism.layerOf(joint.body_i) + mechanism.layerOf(joint.body_j)) / 2
    const middle = at.clone().addScaledVector(normal, layers * mechanism.pitch)
    const on = joint.body_j
    const own = new Vector3(...joint.at_j)
    const up = mechanism.into(on, mechanism.plane)
    const basis = new Basis(
      own.clone().addScaledVector(up, layers * mechanism.pitch + 1.6 * kit.unit),
      up,
      towardsRest(mechanism, on, own, mechanism.into(on, mechanism.up)),
    )
    const arc = Array.from({ length: 33 }, (_, k) => {
      const angle = FLAT.half * (k / 16 - 1)
      return basis.from([FLAT.arc * r * Math.cos(angle), FLAT.arc * r * Math.sin(angle)])
    })
    return [piece(body, kit.ball(middle, FLAT.ball * r, steel)), piece(on, kit.line(arc, outline, FLAT.line))]
  }
  const grounded = joint.body_i === 0 || joint.body_j === 0
  const on = grounded ? 0 : joint.body_j
  const own = new Vector3(...(on === joint.body_j ? joint.at_j : joint.at_i))
  const up = mechanism.into(on, mechanism.up)
  // The cup of ground is on the side of the ball opposite to the other body.
  const direction = grounded
    ? mechanism
        .into(on, mechanism.alongAt(body, towardsRest(mechanism, body, at, mechanism.into(body, mechanism.up)), 0))
        .negate()
    : towardsRest(mechanism, on, own, up)
  const cup = kit.keyed(
    `cup ${r}`,
    () => new SphereGeometry(CUP * r, 24, 12, 0, 2 * Math.PI, 0, OPENING * Math.PI),
    kit.body(on),
    {
      open: true,
    },
  )
  return [piece(body, kit.ball(at, BALL * r, steel)), piece(on, place(cup, own, direction))]
}
