import type { Object3D, Vector3 } from 'three'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

/** Side of a hatched plate in radii of the glyph, and half length of a hatched line. */
const PLATE = 5.4
const LINE = 2.6

/**
 * Supports of a bar or rod on ground: a hatched plate at either end, in a planar mechanism a hatched line across it.
 */
export function guideEnds(mechanism: Mechanism, kit: Kit, from: Vector3, to: Vector3, r: number): Object3D[] {
  const along = to.clone().sub(from).normalize()
  const { plane } = mechanism
  if (!plane)
    return [
      kit.footPlate(from, along.clone().negate(), undefined, PLATE * r),
      kit.footPlate(to, along, undefined, PLATE * r),
    ]
  const aside = plane.clone().cross(along)
  return [from, to].map((end, k) => {
    const out = along.clone().multiplyScalar(k === 0 ? -1 : 1)
    const corner = (side: number) => end.clone().addScaledVector(aside, side * (k === 0 ? -1 : 1) * LINE * r)
    return kit.hatchLine(corner(1), corner(-1), out, r)
  })
}
