import { Group, TorusGeometry, Vector3 } from 'three'
import type { Drawable } from '../drawable'
import { across } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { bodyPart, jointPart } from '../part'
import type { Shaft, Train } from '../train'

/** Radius of a shaft, and its overhang beyond the parts on it. */
const SHAFT = { radius: 1.1, beyond: 3.2 }
/** Bearing: radii of ring and section; its foot: where it starts and ends, its radius, the plate's side. */
const BEARING = { ring: 2.1, section: 0.85 }
const FOOT = { from: 2.4, to: 5, radius: 0.9, plate: 5.2 }
/** A motor at a shaft's free end: from the bearing, radius, length; its ring: from the end, radius, height. */
const MOTOR = { from: 5, radius: 4.6, length: 10 }
const RING = { from: 1, radius: 4.75, height: 1.2 }

/** A shaft through everything on it, with a bearing; a motor at the end of a driven one. */
export function shafts(mechanism: Mechanism, kit: Kit, train: Train): Drawable[] {
  return mechanism.plane ? [] : train.shafts.flatMap((shaft) => shaftOn(mechanism, kit, shaft))
}

function shaftOn(mechanism: Mechanism, kit: Kit, shaft: Shaft): Drawable[] {
  const { report } = mechanism
  const { joint, body, at, axis, low, high } = shaft
  const s = kit.unit
  const { body_i, body_j } = report.joints[joint]
  const frame = body_j > 0 ? body_i : body_j
  const on = (t: number) => at.clone().addScaledVector(axis, t)
  const driven = frame === 0 && report.drivers.some((driver) => driver.joint === joint && driver.turns)
  // On the side where there is less on the shaft.
  const side = high > -low ? -1 : 1
  const free = side < 0 ? low : high
  const mount = free + side * MOTOR.from * s
  const ends = [low - SHAFT.beyond * s, high + SHAFT.beyond * s]
  if (driven) ends[side < 0 ? 0 : 1] = mount
  const [from, to] = ends.map((t) => mechanism.placeInto(body, on(t)))
  const bar = kit.cylinder(from, to, SHAFT.radius * s, SHAFT.radius * s, kit.body(body))
  const drawn: Drawable[] = [{ body, object: bar, part: bodyPart(mechanism, body) }]
  drawn.push({ body: frame, object: bearing(mechanism, kit, frame, at, axis), part: jointPart(mechanism, joint) })
  if (!driven) return drawn
  const can = kit.cylinder(
    on(mount),
    on(mount + side * MOTOR.length * s),
    MOTOR.radius * s,
    MOTOR.radius * s,
    kit.palette.ground,
  )
  const ring = kit.disc(on(mount + side * RING.from * s), axis, RING.radius * s, RING.height * s, kit.palette.driver)
  return [...drawn, { body: 0, object: new Group().add(can, ring), part: bodyPart(mechanism, 0) }]
}

/** A ring, on a foot where it is ground's. */
function bearing(mechanism: Mechanism, kit: Kit, frame: number, place: Vector3, axis: Vector3): Group {
  const s = kit.unit
  const at = mechanism.placeInto(frame, place)
  const along = mechanism.into(frame, axis)
  const ring = kit.keyed(
    `bearing ${s}`,
    () => new TorusGeometry(BEARING.ring * s, BEARING.section * s, 12, 28),
    kit.body(frame),
  )
  ring.position.copy(at)
  ring.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), along)
  if (frame > 0) return new Group().add(ring)
  const down = mechanism.up.clone().negate()
  if (Math.abs(down.dot(axis)) > 0.6) down.copy(across(axis))
  down.addScaledVector(axis, -down.dot(axis)).normalize()
  const foot = at.clone().addScaledVector(down, FOOT.to * s)
  const leg = kit.cylinder(
    at.clone().addScaledVector(down, FOOT.from * s),
    foot,
    FOOT.radius * s,
    FOOT.radius * s,
    kit.palette.ground,
  )
  return new Group().add(ring, leg, kit.footPlate(foot, down, axis, FOOT.plate * s))
}
