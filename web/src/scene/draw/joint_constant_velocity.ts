import { SphereGeometry, Vector3 } from 'three'
import type { JointMark } from '../../payload'
import { towardsRest } from '../hinge'
import { place } from '../kit'
import type { Mechanism } from '../mechanism'
import { type DrawJoint, piece } from './joint'

/** Radius of the bell, and its extent on the sphere from its pole, as a fraction of π. */
const BELL = 3
const OPENING = 0.52
/** Rings of the boot: number, radius of the first, reduction per ring, thickness and distance. */
const BOOT = { rings: 4, radius: 2.75, less: 0.45, thickness: 0.75, apart: 1.15, from: 0.9 }
/**
 * Radius of a drive shaft's bell, relative to the wheel's, and at most this fraction of the distance to the next joint.
 */
const OF_WHEEL = 0.17
const OF_DISTANCE = 0.62

/** A bell on body i and a boot on body j. */
export const constantVelocity: DrawJoint = (mechanism, kit, joint) => {
  const r = glyph(mechanism, joint)
  const [p, q] = [new Vector3(...joint.at_i), new Vector3(...joint.at_j)]
  if (mechanism.large) return [piece(joint.body_i, kit.ball(p, 0.6 * kit.unit, kit.palette.steel))]
  const along = (axis: Vector3 | undefined, body: number) => axis ?? mechanism.into(body, new Vector3(1, 0, 0))
  const shaft = joint.axis ? new Vector3(...joint.axis) : undefined
  const other = joint.axis2 ?? joint.axis_j
  const back = towardsRest(mechanism, joint.body_i, p, along(shaft?.clone().negate(), joint.body_i))
  const ahead = towardsRest(mechanism, joint.body_j, q, along(other ? new Vector3(...other) : undefined, joint.body_j))
  const bell = kit.keyed(
    `bell ${r}`,
    () => new SphereGeometry(BELL * r, 28, 14, 0, 2 * Math.PI, 0, OPENING * Math.PI),
    kit.body(joint.body_i),
    { open: true },
  )
  const rings = Array.from({ length: BOOT.rings }, (_, k) =>
    kit.disc(
      q.clone().addScaledVector(ahead, (BOOT.from + BOOT.apart * k) * r),
      ahead,
      (BOOT.radius - BOOT.less * k) * r,
      BOOT.thickness * r,
      kit.palette.rubber,
    ),
  )
  return [piece(joint.body_i, place(bell, p, back)), piece(joint.body_j, ...rings)]
}

/** Size relative to a wheel of the model, limited by the distance of other joints. */
function glyph(mechanism: Mechanism, joint: JointMark): number {
  const minimum = mechanism.radiusOf(joint)
  const wheel = Math.min(...mechanism.report.wheels.map(({ radius }) => radius))
  if (!Number.isFinite(wheel)) return minimum
  return Math.max(minimum, Math.min(OF_WHEEL * wheel, OF_DISTANCE * mechanism.roomOf(joint)) / BELL)
}
