import { Group } from 'three'
import type { Drawable } from '../drawable'
import { carried, hingePlaces, restOf } from '../hinge'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { bodyPart } from '../part'
import { shaftJoints } from '../shafts'

/** From the pin to the can, its radius and length, and of the ring in the driver's colour. */
const CAN = { from: 2.2, radius: 2.5, length: 5.4 }
const RING = { at: 2.6, radius: 2.65, height: 0.8 }

/** A motor on every driven hinge of ground in space, on the side where it hides least; shafts have theirs at an end. */
export function motors(mechanism: Mechanism, kit: Kit): Drawable[] {
  const { report, plane, large } = mechanism
  if (plane || large) return []
  const shafts = shaftJoints(report)
  return report.drivers.flatMap(({ joint, turns }): Drawable[] => {
    if (joint === null || !turns || shafts.has(joint)) return []
    const mark = report.joints[joint]
    if (mark.kind !== 'revolute' || (mark.body_i !== 0 && mark.body_j !== 0)) return []
    const { body, at, axis } = carried(mechanism, mark)
    const out = mechanism.alongAt(body, axis, 0)
    // Away from the body on the hinge, otherwise from the viewer.
    const beyond = at
      .clone()
      .sub(restOf(mechanism, body, at))
      .dot(axis)
    const side = Math.abs(beyond) > kit.unit ? Math.sign(beyond) : -Math.sign(out.dot(mechanism.reader)) || 1
    out.multiplyScalar(side)
    const s = Math.min(kit.unit, 1.4 * mechanism.radiusOf(mark))
    const places = hingePlaces(mechanism, mark).map((place) => mechanism.worldAt(mark.body_i, place, 0))
    const pin = places.reduce((far, place) => (place.dot(out) > far.dot(out) ? place : far))
    const on = (t: number) => pin.clone().addScaledVector(out, t * s)
    const can = kit.cylinder(
      on(CAN.from),
      on(CAN.from + CAN.length),
      CAN.radius * s,
      CAN.radius * s,
      kit.palette.ground,
    )
    const ring = kit.disc(on(RING.at), out, RING.radius * s, RING.height * s, kit.palette.driver)
    return [{ body: 0, object: new Group().add(can, ring), part: bodyPart(mechanism, 0) }]
  })
}
