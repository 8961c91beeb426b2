import { Group, type Object3D, Vector3 } from 'three'
import type { Kit } from '../kit'
import { orient, place } from '../kit'
import type { BodyPlace } from '../../payload'
import type { Mechanism } from '../mechanism'
import type { DrawJoint, Piece } from './joint'
import { type Form, formOf, strut } from './strut'

/** Radius of the ball at an end; from above the eye's radius, its pin's, and both heights. */
const BALL = 1.25
const EYE = { radius: 1.15, pin: 0.62, height: 1, pinHeight: 1.1 }
/** Radius and length of the eye round a hinge's pin at an end in space, and of the pin. */
const HINGE = { radius: 1.5, length: 2.2, pin: 0.9, pinLength: 3.4 }
/** A barrel is at most this part of the mean length, and never longer than the shortest less two units. */
const BARREL = { ofMean: 0.62, ofLeast: 0.9 }
/** Height of a rod of a planar mechanism above the links that it connects, in layers. */
const ABOVE = 0.95

/** A rod, a cylinder, or the appearance in the model, between points of two bodies. */
export const massless: DrawJoint = (mechanism, kit, joint) => {
  const form = formOf(joint.draw) ?? (joint.kind === 'leg' ? 'cylinder' : 'rod')
  const hinge = joint.kind === 'revolute_spherical' && joint.axis ? new Vector3(...joint.axis) : undefined
  return [
    member(mechanism, kit, form, { body: joint.body_i, at: joint.at_i }, { body: joint.body_j, at: joint.at_j }, hinge),
  ]
}

/** `hinge`: axis of a hinge at the first end, in its body's frame. */
export function member(
  mechanism: Mechanism,
  kit: Kit,
  form: Form,
  from: BodyPlace,
  to: BodyPlace,
  hinge?: Vector3,
): Piece {
  const { plane } = mechanism
  const [a, b] = orderedEnds(mechanism, form, from, to)
  const places = [a, b].map(({ at }) => new Vector3(...at))
  const lengths = mechanism.moments
    .map((step) => mechanism.worldAt(a.body, places[0], step).distanceTo(mechanism.worldAt(b.body, places[1], step)))
    .filter(Number.isFinite)
  const minimum = Math.min(...lengths, Infinity)
  const mean = lengths.reduce((sum, one) => sum + one, 0) / (lengths.length || 1)
  const barrel = Math.min(BARREL.ofMean * mean, Math.max(BARREL.ofLeast * minimum - kit.unit, 0.35 * mean))
  const { object, span } = strut(kit, form, lengths[0] ?? mean, barrel)
  const ends = [0, 1].map((k) =>
    plane ? eye(kit) : hinge && k === 0 ? hingedEye(kit) : kit.ball(new Vector3(), BALL * kit.unit, kit.palette.steel),
  )
  const lift = plane
    ?.clone()
    .multiplyScalar((Math.max(mechanism.layerOf(a.body), mechanism.layerOf(b.body)) + ABOVE) * mechanism.pitch)
  const group = new Group().add(object, ...ends)
  return {
    object: group,
    follow: (frame) => {
      group.visible = frame.visible(a.body) && frame.visible(b.body)
      if (!group.visible) return
      const spots = [frame.at(a.body, places[0]), frame.at(b.body, places[1])]
      if (lift) for (const spot of spots) spot.add(lift)
      span(spots[0], spots[1])
      const along = spots[1].clone().sub(spots[0])
      ends.forEach((end, k) => {
        if (plane) place(end, spots[k], plane)
        else if (hinge && k === 0) orient(end, spots[k], frame.along(a.body, hinge), along)
        else end.position.copy(spots[k])
      })
    },
  }
}

/** The upper end first, where up and down matter. */
function orderedEnds(mechanism: Mechanism, form: Form, from: BodyPlace, to: BodyPlace): [BodyPlace, BodyPlace] {
  if (form !== 'coilover' && form !== 'spring') return [from, to]
  const height = ({ body, at }: BodyPlace) => mechanism.worldAt(body, new Vector3(...at), 0).dot(mechanism.up)
  return height(from) < height(to) ? [to, from] : [from, to]
}

function eye(kit: Kit): Object3D {
  const s = kit.unit
  const [origin, y] = [new Vector3(), new Vector3(0, 1, 0)]
  return new Group().add(
    kit.disc(origin, y, EYE.radius * s, EYE.height * s, kit.palette.rod),
    kit.disc(new Vector3(0, 0.2 * s, 0), y, EYE.pin * s, EYE.pinHeight * s, kit.palette.steel),
  )
}

function hingedEye(kit: Kit): Object3D {
  const s = kit.unit
  const [origin, y] = [new Vector3(), new Vector3(0, 1, 0)]
  return new Group().add(
    kit.disc(origin, y, HINGE.radius * s, HINGE.length * s, kit.palette.rod),
    kit.disc(origin, y, HINGE.pin * s, HINGE.pinLength * s, kit.palette.steel),
  )
}
