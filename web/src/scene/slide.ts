import { Vector3 } from 'three'
import type { JointMark } from '../payload'
import { across } from './flat'
import type { Mechanism } from './mechanism'

/**
 * A joint in which one body slides along another: which is the rail, and how far the other travels on it in this
 * motion.
 */
export interface Slide {
  rail: number
  block: number
  /** Unit vector in the rail's frame. */
  axis: Vector3
  /** Origin of the travel, in the rail's frame. */
  place: Vector3
  /** The joint's place on the block, in its frame. */
  blockPlace: Vector3
  low: number
  high: number
}

/** The slide of a joint; ground is the rail, else the body that is longer along the axis. */
export function slideOf(mechanism: Mechanism, joint: JointMark): Slide | undefined {
  if (!joint.slide || !joint.axis) return undefined
  const { along, either } = joint.slide
  const { plane } = mechanism
  // Seen along its line, a point on a line is a pin.
  if (along && !either && plane && Math.abs(mechanism.alongAt(joint.body_i, new Vector3(...along), 0).dot(plane)) > 0.9)
    return undefined
  let slide = {
    rail: joint.body_i,
    block: joint.body_j,
    axis: new Vector3(...(along ?? joint.axis)),
    place: new Vector3(...joint.at_i),
    blockPlace: new Vector3(...joint.at_j),
  }
  if (!along) {
    const normal = slide.axis
    slide.axis = plane ? mechanism.into(slide.rail, plane).cross(normal).normalize() : across(normal)
  } else if (either) {
    const axis = mechanism.into(slide.block, mechanism.alongAt(slide.rail, slide.axis, 0))
    const grounded = slide.rail === 0 || slide.block === 0
    const longer = length(mechanism, slide.block, axis) > length(mechanism, slide.rail, slide.axis)
    if (grounded ? slide.block === 0 : longer)
      slide = { rail: slide.block, block: slide.rail, axis, place: slide.blockPlace, blockPlace: slide.place }
  }
  const { rail, block } = slide
  const travelled = mechanism.moments
    .map((step) =>
      mechanism
        .into(
          rail,
          mechanism.worldAt(block, slide.blockPlace, step).sub(mechanism.worldAt(rail, slide.place, step)),
          step,
        )
        .dot(slide.axis),
    )
    .filter(Number.isFinite)
  return { ...slide, low: Math.min(...travelled, Infinity), high: Math.max(...travelled, -Infinity) }
}

function length(mechanism: Mechanism, body: number, axis: Vector3): number {
  const along = mechanism.report.bodies[body].skeleton.map((point) => new Vector3(...point).dot(axis))
  return along.length > 0 ? Math.max(...along) - Math.min(...along) : 0
}
