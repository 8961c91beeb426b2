import { Vector3 } from 'three'
import { towardsRest } from '../hinge'
import { type DrawJoint, piece } from './joint'

/** Radius and thickness of a flange; half the side of the square in the plane, and its height in layers. */
const FLANGE = [2.2, 0.7]
const SQUARE = { half: 1.1, height: 0.3 }

/** Two bodies that are one: a flange of each; in a planar mechanism the filled square of a rigid joint. */
export const weld: DrawJoint = (mechanism, kit, joint) => {
  const r = mechanism.radiusOf(joint)
  const at = [new Vector3(...joint.at_i), new Vector3(...joint.at_j)]
  const bodies = [joint.body_i, joint.body_j]
  if (mechanism.plane) {
    const body = joint.body_j
    const top = Math.max(...bodies.map((one) => mechanism.layerOf(one)))
    const place = at[1].clone().add(mechanism.lift(body, top + 0.6))
    const normal = mechanism.into(body, mechanism.plane)
    const side = 2 * SQUARE.half * r
    return [
      piece(
        body,
        kit.brick(
          place,
          mechanism.into(body, mechanism.up),
          normal,
          [side, SQUARE.height * kit.unit, side],
          kit.palette.outline,
        ),
      ),
    ]
  }
  const direction = towardsRest(mechanism, joint.body_j, at[1], mechanism.into(joint.body_j, mechanism.up))
  const axes = [mechanism.into(joint.body_i, mechanism.alongAt(joint.body_j, direction, 0)), direction]
  return bodies.map((body, k) => {
    const middle = at[k].clone().addScaledVector(axes[k], (k - 0.5) * FLANGE[1] * r)
    return piece(body, kit.disc(middle, axes[k], FLANGE[0] * r, FLANGE[1] * r, kit.body(body), { edges: 30 }))
  })
}
