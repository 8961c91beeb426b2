import { Vector3 } from 'three'
import { across, Basis, square } from '../flat'
import { towardsRest } from '../hinge'
import { type DrawJoint, type Piece, piece } from './joint'

/** Pin of the cross: radius, and half its length. */
const PIN = { radius: 0.75, half: 2.6 }
/** Yoke: radius and thickness of its eyes, radius of its arms, and the distance behind the cross at which they meet. */
const YOKE = { eye: 1.15, thickness: 0.9, arm: 0.7, behind: 3.6 }
/**
 * The cross is what indicates the joint from a ball: so much larger than other glyphs, where it leaves other joints
 * this part of the way to it and is on no block.
 */
const LARGE = { units: 1.8, part: 0.09 }
/** From above: radius of the circle, and its lines in px. */
const FLAT = { circle: 1.9, line: 2 }

/** A cross whose pins turn in the yokes of both bodies. */
export const universal: DrawJoint = (mechanism, kit, joint) => {
  const { steel, outline } = kit.palette
  const r = mechanism.radiusOf(joint)
  const at = [new Vector3(...joint.at_i), new Vector3(...joint.at_j)]
  if (mechanism.large) return [piece(joint.body_i, kit.ball(at[0], 0.6 * kit.unit, steel))]
  if (mechanism.plane) {
    const body = joint.body_j
    const normal = mechanism.into(body, mechanism.plane)
    const layers = Math.max(mechanism.layerOf(joint.body_i), mechanism.layerOf(body)) + 0.6
    const middle = at[1].clone().addScaledVector(normal, layers * mechanism.pitch)
    const basis = new Basis(middle.clone().addScaledVector(normal, kit.unit), normal)
    const on = (angle: number) => basis.from([FLAT.circle * r * Math.cos(angle), FLAT.circle * r * Math.sin(angle)])
    const circle = Array.from({ length: 49 }, (_, k) => on((k * Math.PI) / 24))
    const cross = [1, 5, 3, 7].map((eighth) => on((eighth * Math.PI) / 4))
    return [
      piece(
        body,
        kit.disc(middle, normal, FLAT.circle * r, 1.2 * kit.unit, steel),
        kit.line(circle, outline, FLAT.line),
        kit.lines(cross, outline, FLAT.line),
      ),
    ]
  }
  const onBlock = [joint.body_i, joint.body_j].some((body) =>
    mechanism.report.joints.some((_, k) => mechanism.slideOf(k)?.block === body),
  )
  const large = onBlock ? r : Math.max(r, Math.min(LARGE.units * kit.unit, LARGE.part * mechanism.roomOf(joint)))
  const first = joint.axis ? new Vector3(...joint.axis) : new Vector3(0, 0, 1)
  const second = joint.axis2
    ? new Vector3(...joint.axis2)
    : mechanism.into(joint.body_j, across(mechanism.alongAt(joint.body_i, first, 0)))
  const half = (body: number, middle: Vector3, axis: Vector3): Piece => {
    const pin = axis.clone().normalize()
    const end = (side: number, reach = PIN.half) => middle.clone().addScaledVector(pin, side * reach * large)
    const back = square(towardsRest(mechanism, body, middle, across(pin)), pin)
    const root = middle.clone().addScaledVector(back, YOKE.behind * large)
    const colour = kit.body(body)
    const sides = [-1, 1].flatMap((side) => {
      const eye = end(side, PIN.half - YOKE.thickness / 2)
      const corner = eye.clone().addScaledVector(back, 0.55 * YOKE.behind * large)
      return [
        kit.disc(eye, pin, YOKE.eye * large, YOKE.thickness * large, colour),
        kit.cylinder(eye, corner, YOKE.arm * large, YOKE.arm * large, colour),
        kit.ball(corner, YOKE.arm * large, colour),
        kit.cylinder(corner, root, YOKE.arm * large, YOKE.arm * large, colour),
      ]
    })
    return piece(body, kit.cylinder(end(-1), end(1), PIN.radius * large, PIN.radius * large, steel), ...sides)
  }
  return [half(joint.body_i, at[0], first), half(joint.body_j, at[1], second)]
}
