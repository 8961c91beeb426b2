import { type Object3D, Vector3 } from 'three'
import type { WheelMark } from '../../payload'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

const BEAM = 1.9
const MIDDLE = 4.2
/** Radii of a bracket at the beam and at its joint. */
const BRACKET = [1.5, 0.9]
/** Nearest that a bracket starts to a hub, as a part of the beam. */
const END = 0.08

/** A beam between the hubs, a ball in its middle, brackets to the joints. */
export function axleBeam(mechanism: Mechanism, kit: Kit, body: number, wheels: WheelMark[]): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const [a, b] = wheels.map(({ centre }) => new Vector3(...centre.at))
  const along = b.clone().sub(a)
  const brackets = mechanism.shapePoints(body).flatMap((point) => {
    const share = Math.min(1 - END, Math.max(END, point.clone().sub(a).dot(along) / along.lengthSq()))
    const root = a.clone().addScaledVector(along, share)
    if (root.distanceTo(point) < 2 * s) return []
    return [
      kit.cylinder(root, point, BRACKET[0] * s, BRACKET[1] * s, colour),
      kit.ball(point, 1.1 * BRACKET[1] * s, colour),
    ]
  })
  const hubs = wheels.map(({ centre, axis, radius }) =>
    kit.disc(new Vector3(...centre.at), new Vector3(...axis), 0.22 * radius, s, colour),
  )
  return [
    kit.cylinder(a, b, BEAM * s, BEAM * s, colour),
    kit.ball(a.clone().addScaledVector(along, 0.5), MIDDLE * s, colour),
    ...brackets,
    ...hubs,
  ]
}
