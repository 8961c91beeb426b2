import { OctahedronGeometry } from 'three'
import { carried } from '../hinge'
import { type DrawJoint, piece } from './joint'

/** Radius of the mark: its faces are outside a rod that it is on. */
const MARK = 2.1

/** A neutral mark for constraints without a symbol: angles, headings, orientations. */
export const otherJoint: DrawJoint = (mechanism, kit, joint) => {
  const { body, at } = carried(mechanism, joint)
  const mark = kit.mesh(new OctahedronGeometry(MARK * mechanism.radiusOf(joint)), kit.palette.steel, { edges: 20 })
  mark.position.copy(at).add(mechanism.lift(body, mechanism.topLayer + 1))
  return [piece(body, mark)]
}
