import { Group, Vector3 } from 'three'
import { Basis } from '../flat'
import type { Kit } from '../kit'
import { type BeltPath, beltPath } from '../shapes/belt'
import type { Drawable } from '../drawable'
import type { DrawCoupler } from './coupler'

/** Thickness of the band in units, and its width in face widths. */
const BAND = { thickness: 0.9, width: 0.8 }
/** A raised middle on both faces of a pulley: its radius and width, and holes that show the turning. */
const HUB = { radius: 0.72, width: 1.06 }
const DOT = { at: 0.5, radius: 0.09 }

/** Two pulleys and the band round both. */
export const belt: DrawCoupler = ({ mechanism, kit, train, coupler, index }) => {
  const pair = train.pair(index)
  if (!pair || coupler.sizes.length < 2) return []
  const [a, b] = pair
  const radii = coupler.sizes.map(Math.abs)
  const between = b.centre.clone().sub(a.centre)
  const crossed = a.coefficient * b.coefficient * a.shaft.axis.dot(b.shaft.axis) > 0
  const width = mechanism.plane ? mechanism.thickness : train.face
  const pulleys = pair.map(({ shaft, body, centre }, k): Omit<Drawable, 'part'> => {
    const at = mechanism.placeInto(body, centre).add(mechanism.lift(body))
    const axis = mechanism.into(body, shaft.axis)
    const colour = kit.body(body)
    const dot = new Basis(at, axis, mechanism.into(body, between)).from([DOT.at * radii[k], 0])
    return {
      body,
      object: new Group().add(
        kit.disc(at, axis, radii[k], width, colour),
        kit.disc(at, axis, HUB.radius * radii[k], HUB.width * width, colour, { edges: 60 }),
        kit.disc(dot, axis, DOT.radius * radii[k], (HUB.width + 0.04) * width, kit.palette.view),
      ),
    }
  })
  const path = beltPath(radii[0], radii[1], between.length(), crossed)
  if (!path) return pulleys
  // The frame that both pulleys turn in.
  const { body_i, body_j } = mechanism.report.joints[a.shaft.joint]
  const frame = body_j > 0 ? body_i : body_j
  const middle = mechanism.placeInto(frame, a.centre).add(mechanism.lift(a.shaft.body))
  const basis = new Basis(middle, mechanism.into(frame, a.shaft.axis), mechanism.into(frame, between))
  return [...pulleys, { body: frame, object: band(kit, basis, path, BAND.width * width) }]
}

function band(kit: Kit, basis: Basis, { points, normals }: BeltPath, width: number) {
  const t = BAND.thickness * kit.unit
  const corners = points.map(([x, y], k): Vector3[] => {
    const [u, v] = normals[k]
    return [
      [0, -1],
      [1, -1],
      [1, 1],
      [0, 1],
    ].map(([out, side]) => basis.from([x + out * t * u, y + out * t * v], (side * width) / 2))
  })
  const faces = corners.flatMap((here, k) => {
    const next = corners[(k + 1) % corners.length]
    return here.flatMap((corner, i) => {
      const j = (i + 1) % here.length
      return [corner, next[i], next[j], corner, next[j], here[j]].map((point) => point.clone())
    })
  })
  return kit.triangles(faces, kit.palette.rubber, { facets: true, open: true })
}
