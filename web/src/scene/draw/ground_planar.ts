import type { Object3D } from 'three'
import { Basis, type Flat, round } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import type { Foot } from './ground'

/**
 * Dimensions of the triangle: height, half width, half width at the pin, its round head, thickness; half length of the
 * line.
 */
const TRIANGLE = { height: 4, width: 2.5, head: 0.75, eye: 1.35, thickness: 0.5, line: 3.75 }
/** Large models have smaller ones. */
const SMALL = 0.8

/** Triangle and hatched line of ISO 3952 below a pin. */
export function planarFoot(mechanism: Mechanism, kit: Kit, { at, radius, front }: Foot): Object3D[] {
  const { plane, up, pitch, topLayer, large, unit } = mechanism
  const r = radius * (large ? SMALL : 1)
  const height = front ? (topLayer + 1) * pitch : -0.4 * unit
  const basis = new Basis(at.clone().addScaledVector(plane!, height), plane!, up.clone().cross(plane!))
  const [h, w, head] = [TRIANGLE.height * r, TRIANGLE.width * r, TRIANGLE.head * r]
  const outline: Flat[] = [
    [-head, 0],
    [-w, -h],
    [w, -h],
    [head, 0],
  ]
  const line = TRIANGLE.line * r
  return [
    kit.slab(outline, basis, TRIANGLE.thickness * unit, kit.palette.ground),
    kit.slab(round([[0, 0, TRIANGLE.eye * r]]), basis, TRIANGLE.thickness * unit, kit.palette.ground),
    kit.hatchLine(basis.from([-line, -h]), basis.from([line, -h]), basis.y.clone().negate(), r),
  ]
}
