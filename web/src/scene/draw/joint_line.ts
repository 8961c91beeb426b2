import { Vector3 } from 'three'
import { type DrawJoint, piece } from './joint'
import { hinge } from './joint_hinge'
import { slottedPin } from './joint_slot'
import { guideEnds } from './guide_ends'

/** Radius of the bar, its overhang beyond the travel, and radius of the bead on it. */
const BAR = { radius: 0.6, room: 4 }
const BEAD = 1.5

/** A point on a line: a bead on a bar; in a planar mechanism a pin, or a pin in a slot. */
export const onLine: DrawJoint = (mechanism, kit, joint, index) => {
  const axis = new Vector3(...(joint.axis ?? [0, 0, 1]))
  const { plane } = mechanism
  if (plane && Math.abs(mechanism.alongAt(joint.body_i, axis, 0).dot(plane)) > 0.9)
    return hinge(mechanism, kit, joint, index)
  if (plane) return slottedPin(mechanism, kit, joint, index)
  const slide = mechanism.slideOf(index)
  if (!slide || slide.low > slide.high) return []
  const r = mechanism.radiusOf(joint)
  const ends = [slide.low - BAR.room * r, slide.high + BAR.room * r].map((t) =>
    slide.place.clone().addScaledVector(slide.axis, t),
  )
  return [
    piece(
      slide.rail,
      kit.cylinder(
        ends[0],
        ends[1],
        BAR.radius * r,
        BAR.radius * r,
        slide.rail === 0 ? kit.palette.ground : kit.palette.steel,
      ),
      ...(slide.rail === 0 ? guideEnds(mechanism, kit, ends[0], ends[1], r) : []),
    ),
    piece(slide.block, kit.ball(slide.blockPlace, BEAD * r, kit.body(slide.block))),
  ]
}
