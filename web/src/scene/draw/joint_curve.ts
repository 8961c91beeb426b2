import { Vector3 } from 'three'
import { Basis, type Flat, round } from '../flat'
import type { JointCurve, JointMark } from '../../payload'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { camProfile, grooveOutline, rollerRadius } from '../shapes/cam'
import { type DrawJoint, type Piece, piece } from './joint'

/** Radii of the roller on a cam and of the one in a groove, at most. */
const ROLLER = { cam: 4.2, groove: 1.6 }
/** Heights in the thickness of a planar link: cam, roller, its pin. */
const HEIGHT = { cam: 1, roller: 1.3, pin: 3 }
const PIN = 1.1
/** A groove is a little wider than its roller, and its band this much wider again. */
const GROOVE = { play: 1.06, band: 1.5 }
/** A dot that shows a cam's turning, at this part of the way to its curve. */
const DOT = { radius: 0.8, height: 1.3, part: 0.5 }
/** Dashed line of the pitch curve in px. */
const LINE = 1.2
/** Radii of the struts from a groove to the joints of its body. */
const STRUT = [1.5, 1.1]

/** A roller on a plate cam, or in the groove of a curve that does not close. */
export const pointOnCurve: DrawJoint = (mechanism, kit, joint) => {
  const { curve, body_i, body_j } = joint
  if (!curve || curve.points.length < 3) return []
  const normal = new Vector3(...curve.normal).normalize()
  if (mechanism.plane && mechanism.alongAt(body_i, normal, 0).dot(mechanism.plane) < 0) normal.negate()
  const lift = mechanism.lift(body_i)
  const basis = new Basis(new Vector3(...joint.at_i).add(lift), normal)
  const points = curve.points.map((point): Flat => basis.to(new Vector3(...point)))
  const radius = rollerRadius(points, curve.closed, (curve.closed ? ROLLER.cam : ROLLER.groove) * kit.unit)
  const carrier = curve.closed
    ? cam(mechanism, kit, joint, curve, basis, points, radius)
    : groove(mechanism, kit, joint, basis, points, radius)
  const own = mechanism.into(body_j, mechanism.alongAt(body_i, normal, 0))
  // The roller runs in the layer of its curve.
  const place = new Vector3(...joint.at_j).add(mechanism.lift(body_j, mechanism.layerOf(body_i)))
  const t = mechanism.thickness
  const { steel } = kit.palette
  return [
    carrier,
    piece(
      body_j,
      kit.disc(place, own, radius, HEIGHT.roller * t, steel),
      kit.disc(place, own, Math.min(PIN * kit.unit, 0.4 * radius), HEIGHT.pin * t, kit.body(body_j)),
    ),
  ]
}

function cam(
  mechanism: Mechanism,
  kit: Kit,
  joint: JointMark,
  curve: JointCurve,
  basis: Basis,
  points: Flat[],
  radius: number,
): Piece {
  const t = mechanism.thickness
  const body = joint.body_i
  const hinge = mechanism.jointsOf(body).find((other) => other.joint.kind === 'revolute')
  const centre = basis.to(hinge?.at ?? new Vector3(...joint.at_i))
  const above = (point: Flat) => basis.from(point, 0.9 * t)
  const first = points[0]
  const dot = basis.from([centre[0] + DOT.part * (first[0] - centre[0]), centre[1] + DOT.part * (first[1] - centre[1])])
  return piece(
    body,
    kit.slab(camProfile(points, radius), basis, HEIGHT.cam * t, kit.body(body)),
    kit.line([...points, ...(curve.closed ? [first] : [])].map(above), kit.palette.label, LINE, { dashed: true }),
    kit.disc(dot, basis.normal, DOT.radius * kit.unit, DOT.height * t, kit.palette.view),
  )
}

/** A band with a slot along the curve, and struts to the other joints of the body. */
function groove(mechanism: Mechanism, kit: Kit, joint: JointMark, basis: Basis, points: Flat[], radius: number): Piece {
  const body = joint.body_i
  const half = GROOVE.play * radius
  const band = half + GROOVE.band * kit.unit
  const places =
    body === 0
      ? []
      : mechanism
          .placesOf(body)
          .map((at) => basis.to(at))
          .filter((at) => distance(points, at) > band)
  const struts = places.map((at) => {
    const near = points.reduce((best, point) =>
      Math.hypot(point[0] - at[0], point[1] - at[1]) < Math.hypot(best[0] - at[0], best[1] - at[1]) ? point : best,
    )
    const direction = Math.hypot(near[0] - at[0], near[1] - at[1])
    // It ends within the band, short of the slot.
    const share = Math.max(0, (direction - half - 0.75 * GROOVE.band * kit.unit) / direction)
    const end: Flat = [at[0] + share * (near[0] - at[0]), at[1] + share * (near[1] - at[1])]
    return kit.slab(
      round([
        [...at, STRUT[0] * kit.unit],
        [...end, 0.7 * STRUT[1] * kit.unit],
      ]),
      basis,
      mechanism.thickness,
      kit.body(body),
    )
  })
  const plate = kit.slab(
    grooveOutline(points, band),
    basis,
    mechanism.thickness,
    kit.body(body),
    [grooveOutline(points, half)],
    { edges: 50 },
  )
  return piece(body, plate, ...struts)
}

function distance(points: Flat[], [x, y]: Flat): number {
  return Math.min(...points.map((point) => Math.hypot(point[0] - x, point[1] - y)))
}
