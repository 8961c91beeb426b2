import type { Object3D } from 'three'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import type { Slide } from '../slide'

/**
 * Hatched lines on both sides of a slide on ground, in the plane of a planar mechanism; `aside` from its middle and
 * `room` beyond its travel, in units.
 */
export function hatchedRails(mechanism: Mechanism, kit: Kit, slide: Slide, aside: number, room: number): Object3D[] {
  if (slide.low > slide.high) return []
  const s = kit.unit
  const across = mechanism.plane!.clone().cross(slide.axis).normalize()
  const end = (t: number, side: number) =>
    slide.place
      .clone()
      .addScaledVector(slide.axis, t)
      .addScaledVector(across, side * aside * s)
      .addScaledVector(mechanism.plane!, -0.3 * s)
  const [from, to] = [slide.low - room * s, slide.high + room * s]
  // The strokes lean alike when seen from outside.
  return [
    kit.hatchLine(end(to, 1), end(from, 1), across, s),
    kit.hatchLine(end(from, -1), end(to, -1), across.clone().negate(), s),
  ]
}
