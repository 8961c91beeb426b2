import { Group, type Object3D } from 'three'
import type { JointKind, JointMark } from '../../payload'
import type { Drawable } from '../drawable'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { jointPart } from '../part'
import { constantVelocity } from './joint_constant_velocity'
import { pointOnCurve } from './joint_curve'
import { cylindrical } from './joint_cylindrical'
import { hinge } from './joint_hinge'
import { onLine } from './joint_line'
import { otherJoint } from './joint_other'
import { onPlane } from './joint_plane'
import { massless } from './joint_rod'
import { screw } from './joint_screw'
import { pinInSlot } from './joint_slot'
import { spherical } from './joint_spherical'
import { translational } from './joint_translational'
import { universal } from './joint_universal'
import { weld } from './joint_weld'

/** An object in a body's frame; in the world where there is no body. */
export type Piece = Omit<Drawable, 'part'>
/** Drawing of a kind of joint. */
export type DrawJoint = (mechanism: Mechanism, kit: Kit, joint: JointMark, index: number) => Piece[]

const KINDS: Record<JointKind, DrawJoint> = {
  revolute: hinge,
  spherical,
  universal,
  constant_velocity: constantVelocity,
  cylindrical,
  translational,
  planar: onPlane,
  inplane: onPlane,
  inline: onLine,
  pin_in_slot: pinInSlot,
  point_on_curve: pointOnCurve,
  screw,
  distance: massless,
  leg: massless,
  revolute_spherical: massless,
  dot2: onPlane,
  fixed: weld,
  orientation: otherJoint,
  parallel: otherJoint,
  dot1: otherJoint,
  angle: otherJoint,
  travel: otherJoint,
  heading: otherJoint,
}

/** Every joint by its kind. */
export function joints(mechanism: Mechanism, kit: Kit): Drawable[] {
  return mechanism.report.joints.flatMap((joint, index) => {
    const part = jointPart(mechanism, index)
    return KINDS[joint.kind](mechanism, kit, joint, index).map((piece) => ({ ...piece, part }))
  })
}

/** Objects in a body's frame as one piece. */
export function piece(body: number, ...objects: Object3D[]): Piece {
  return { body, object: objects.length === 1 ? objects[0] : new Group().add(...objects) }
}
