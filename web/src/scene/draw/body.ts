import { Group, type Object3D } from 'three'
import type { Drawable } from '../drawable'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { bodyPart } from '../part'
import { axleBeam } from './body_axle'
import { flatLink, thinLink } from './body_planar'
import { spatialBody } from './body_spatial'
import { upright } from './body_upright'

/**
 * Every moving body by its hardpoints, those that a coupler or a curve shapes left to them; a mesh of its own
 * represents all that.
 */
export function bodies(mechanism: Mechanism, kit: Kit): Drawable[] {
  const { report } = mechanism
  return report.bodies.flatMap(({ mesh }, body): Drawable[] => {
    if (body === 0 || mesh) return []
    const pieces = piecesOf(mechanism, kit, body)
    if (pieces.length === 0) return []
    return [{ body, object: new Group().add(...pieces), part: bodyPart(mechanism, body) }]
  })
}

function piecesOf(mechanism: Mechanism, kit: Kit, body: number): Object3D[] {
  const { report } = mechanism
  const wheels = report.wheels.filter(({ centre }) => centre.body === body)
  if (wheels.length > 1) return axleBeam(mechanism, kit, body, wheels)
  if (wheels.length === 1) return upright(mechanism, kit, body, wheels[0])
  if (report.joints.some(({ curve, body_i }) => curve && body_i === body)) return []
  if (mechanism.plane) return mechanism.large ? thinLink(mechanism, kit, body) : flatLink(mechanism, kit, body)
  return spatialBody(mechanism, kit, body)
}
