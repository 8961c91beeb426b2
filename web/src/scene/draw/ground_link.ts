import { Group, Vector3 } from 'three'
import type { Drawable } from '../drawable'
import { Basis, hull, round } from '../flat'
import { FOLD, foldAxis } from '../hinge'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { bodyPart } from '../part'

/** Tolerance of points from a plane, relative to the size, for a plate through them. */
const FLAT = 0.01
/** The plate: margin around the points, thickness, opacity. */
const PLATE = { round: 2.5, thickness: 0.6, opacity: 0.28 }

/** The fixed link of a spatial mechanism that is no vehicle: a dashed line between two places, a plate through more. */
export function fixedLink(mechanism: Mechanism, kit: Kit): Drawable[] {
  const { report, plane, vehicle } = mechanism
  if (plane || vehicle || report.wheels.length > 0 || report.couplers.length > 0) return []
  const places = mechanism.placesOf(0).flatMap((place) => acrossFold(mechanism, place))
  if (places.length < 2) return []
  const { ground } = kit.palette
  const drawn = (...pieces: Parameters<Group['add']>): Drawable => ({
    body: 0,
    object: new Group().add(...pieces),
    part: bodyPart(mechanism, 0),
  })
  if (places.length === 2) return [drawn(kit.line(places, ground, 2, { dashed: true }))]
  const [a, b] = [places[1].clone().sub(places[0]), places.slice(2).map((place) => place.clone().sub(places[0]))]
  const widest = b
    .map((side) => a.clone().cross(side))
    .reduce((maximum, one) => (one.length() > maximum.length() ? one : maximum), new Vector3())
  if (widest.length() < FLAT * mechanism.size * a.length())
    return [drawn(kit.line(places, ground, 2, { dashed: true }))]
  const basis = new Basis(places[0], widest)
  if (places.some((place) => Math.abs(place.clone().sub(places[0]).dot(basis.normal)) > FLAT * mechanism.size))
    return []
  const corners = hull(places.map((place) => basis.to(place)))
  const outline = round(corners.map(([x, y]) => [x, y, PLATE.round * kit.unit]))
  const edge = [...corners, corners[0]].map((corner) => basis.from(corner))
  return [
    drawn(
      kit.slab(outline, basis, PLATE.thickness * kit.unit, ground, [], { opacity: PLATE.opacity }),
      kit.line(edge, ground, 1.5, { dashed: true }),
    ),
  ]
}

/** The ends of a hinge at a place of ground that a plate folds about; of others the place alone. */
function acrossFold(mechanism: Mechanism, place: Vector3): Vector3[] {
  const fold = mechanism
    .jointsOf(0)
    .find(({ joint, at }) => mechanism.same(at, place) && foldAxis(mechanism, joint.body_i || joint.body_j))
  if (!fold?.axis) return [place]
  return [-1, 1].map((side) =>
    place.clone().addScaledVector(fold.axis!.clone().normalize(), side * FOLD.half * mechanism.unit),
  )
}
