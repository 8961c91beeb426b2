import { type Object3D, type Vector3 } from 'three'
import { Basis, round } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { downwards, type Foot } from './ground'

/** From the pin to the plate, and the plate's side. */
const DOWN = 3.6
const PLATE = 5.4
/**
 * A lug is smaller than other feet, by this factor; of a plate that folds the cheeks' distance from the middle, and the
 * plate's side.
 */
const LUG = 0.72
const FOLD = { aside: 2.1, plate: 7.4 }
/** Two cheeks: distance from the middle and thickness in units, eye and half width at the plate in radii. */
const CHEEK = { aside: 1.35, thickness: 0.55, eye: 1.5, width: 1.6 }
/** Radii of the cone at the plate and at the ball. */
const CONE = [1.9, 1]
/** Maximum number of times its usual height a foot is. */
const HIGHEST = 6
/** A foot is a little larger than the pin that it holds. */
const ROOM = 1.15

/** Two cheeks and a hatched plate, away from the body on the hinge. */
export function hingeFoot(mechanism: Mechanism, kit: Kit, foot: Foot): Object3D[] {
  const r = ROOM * foot.radius
  const lug = foot.form === 'lug' ? LUG : 1
  const fold = foot.form === 'fold' ? FOLD : { aside: CHEEK.aside, plate: PLATE }
  const axis = foot.axis!
  const down = downwards(mechanism, foot)
  const height = heightOf(foot, down, lug * DOWN * r, fold.plate * r)
  const outline = round([
    [0, 0, CHEEK.eye * r],
    [-CHEEK.width * r, -height, 0],
    [CHEEK.width * r, -height, 0],
  ])
  const cheeks = [-1, 1].map((side) => {
    const middle = foot.at.clone().addScaledVector(axis, side * fold.aside * kit.unit)
    const basis = new Basis(middle, axis, down.clone().cross(axis).negate())
    // The basis' y points along or against the way down; the outline goes with the former.
    const outwards = basis.y.dot(down) < 0 ? outline : outline.map(([x, y]): [number, number] => [-x, -y])
    return kit.slab(outwards, basis, CHEEK.thickness * kit.unit, kit.palette.ground)
  })
  return [...cheeks, kit.footPlate(foot.at.clone().addScaledVector(down, height), down, axis, lug * fold.plate * r)]
}

/** A cone and a hatched plate. */
export function ballFoot(mechanism: Mechanism, kit: Kit, foot: Foot): Object3D[] {
  const r = ROOM * foot.radius
  const down = downwards(mechanism, foot)
  const base = foot.at.clone().addScaledVector(down, heightOf(foot, down, DOWN * r, PLATE * r))
  return [
    kit.cylinder(base, foot.at.clone().addScaledVector(down, 0.4 * r), CONE[0] * r, CONE[1] * r, kit.palette.ground),
    kit.footPlate(base, down, undefined, PLATE * r),
  ]
}

/**
 * A mesh that reaches farther than a foot is usually high has a higher one, up to some times as high: a plate must not
 * cut into it.
 */
function heightOf({ clear, radius }: Foot, down: Vector3, usual: number, plate: number): number {
  const reach = clear?.(down, 0.75 * plate) ?? 0
  return reach > usual - radius ? Math.min(reach + radius, HIGHEST * usual) : usual
}
