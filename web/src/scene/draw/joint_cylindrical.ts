import { Vector3 } from 'three'
import { type DrawJoint, piece } from './joint'
import { hinge } from './joint_hinge'
import { guideEnds } from './guide_ends'

/** Radius and length of the pin, and of the sleeve on it. A rod that lies on the pin hides it. */
const PIN = [0.9, 11]
const SLEEVE = [1.75, 5]

/** A sleeve on a pin; seen along its axis, a hinge. */
export const cylindrical: DrawJoint = (mechanism, kit, joint, index) => {
  const axis = new Vector3(...(joint.axis ?? [0, 0, 1]))
  const { plane } = mechanism
  if (plane && Math.abs(mechanism.alongAt(joint.body_i, axis, 0).dot(plane)) > 0.9)
    return hinge(mechanism, kit, joint, index)
  const slide = mechanism.slideOf(index)
  const r = mechanism.radiusOf(joint)
  if (!slide) return []
  const travel = Math.max(0, slide.high - slide.low)
  const length = Math.max(PIN[1] * r, travel + 2 * SLEEVE[1] * r)
  const middle = slide.place
    .clone()
    .addScaledVector(slide.axis, travel > 0 ? (slide.low + slide.high) / 2 : 0)
    .add(mechanism.lift(slide.rail))
  const end = (part: number) => middle.clone().addScaledVector(slide.axis, part * length)
  const own = mechanism.into(slide.block, mechanism.alongAt(slide.rail, slide.axis, 0))
  return [
    piece(
      slide.rail,
      kit.disc(middle, slide.axis, PIN[0] * r, length, kit.palette.steel),
      ...(slide.rail === 0 ? guideEnds(mechanism, kit, end(-0.5), end(0.5), r) : []),
    ),
    piece(
      slide.block,
      kit.disc(
        slide.blockPlace.clone().add(mechanism.lift(slide.block)),
        own,
        SLEEVE[0] * r,
        SLEEVE[1] * r,
        kit.body(slide.block),
      ),
    ),
  ]
}
