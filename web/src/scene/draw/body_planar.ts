import type { Object3D } from 'three'
import { area, Basis, farthest, type Flat, hull, inset, round } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

/**
 * Radius of a link's ends, of those of a link with a slot, of what carries wheels, of a disc, and of a link in a large
 * model.
 */
const END = 1.55
const SLOTTED = 2.6
const CARRIER = 3.2
const DISC = 2.4
const THIN = 0.95
/** Half widths of a slot for a block and for a pin. */
const SLOT = { block: 1.5, pin: 1.05 }
/** A hull of less area than this part of its length squared is a bar. */
const NARROW = 0.04
/** A window: distance inside the points, minimum area; opacity and thickness of its pane. */
const WINDOW = { inside: 1.25, area: 10, opacity: 0.34, thickness: 0.5 }
/** Radii of the struts that inner points hang on. */
const STRUT = [1.5, 0.9]

/** A body of a planar mechanism: bar with round ends, plate with a window, disc; in its layer. */
export function flatLink(mechanism: Mechanism, kit: Kit, body: number): Object3D[] {
  const s = kit.unit
  const { thickness } = mechanism
  const colour = kit.body(body)
  const { basis, points } = layOut(mechanism, body)
  if (points.length === 0) return []
  const slab = (outline: Flat[], holes: Flat[][] = []) => kit.slab(outline, basis, thickness, colour, holes)
  const slides = mechanism.report.joints.flatMap((joint, k) => {
    const slide = mechanism.slideOf(k)
    return slide ? [{ joint, slide }] : []
  })
  if (points.length === 1)
    return slides.some(({ slide }) => slide.block === body) ? [] : [slab(round([[...points[0], DISC * s]]))]

  const holes = slides
    .filter(({ slide }) => slide.rail === body && slide.low <= slide.high)
    .map(({ joint, slide }) => {
      const half = (joint.kind === 'inplane' ? SLOT.pin : SLOT.block) * s
      const ends = [slide.low, slide.high].map((t) => basis.to(slide.place.clone().addScaledVector(slide.axis, t)))
      return round(ends.map(([x, y]) => [x, y, half]))
    })
  const radius = (holes.length > 0 ? SLOTTED : mechanism.carriers.has(body) ? CARRIER : END) * s
  const corners = hull(points)
  const ends = farthest(points, distance)
  const length = distance(...ends)
  if (holes.length > 0 || corners.length < 3 || area(corners) <= NARROW * length * length) {
    const aside = holes.length > 0 || corners.length < 3 ? [] : points.filter((point) => !ends.includes(point))
    const struts = aside.flatMap((point) =>
      ends.map((end) =>
        slab(
          round([
            [...point, 0.9 * radius],
            [...end, 0.7 * radius],
          ]),
        ),
      ),
    )
    return [slab(round(ends.map(([x, y]) => [x, y, radius])), holes), ...struts]
  }
  const outline = round(corners.map(([x, y]) => [x, y, radius]))
  const window = inset(corners, WINDOW.inside * s)
  if (window.length < 3 || area(window) < WINDOW.area * s * s) return [slab(outline)]
  const pane = kit.slab(window, basis, WINDOW.thickness * thickness, colour, [], { opacity: WINDOW.opacity })
  const struts = points
    .filter((point) => !corners.includes(point))
    .flatMap((point) => {
      const nearest = corners
        .slice()
        .sort((a, b) => distance(a, point) - distance(b, point))
        .slice(0, 2)
      return nearest.map((corner) =>
        slab(
          round([
            [...point, STRUT[0] * s],
            [...corner, STRUT[1] * s],
          ]),
        ),
      )
    })
  return [slab(outline, [window]), pane, ...struts]
}

/** A body of a large planar mechanism: a bar without details. */
export function thinLink(mechanism: Mechanism, kit: Kit, body: number): Object3D[] {
  const { basis, points } = layOut(mechanism, body)
  if (points.length < 2) return []
  const corners = hull(points)
  const outline = round(
    (corners.length > 2 ? corners : farthest(points, distance)).map(([x, y]) => [x, y, THIN * kit.unit]),
  )
  return [kit.slab(outline, basis, mechanism.thickness, kit.body(body))]
}

/** The points that shape a body, in the plane of its layer. */
function layOut(mechanism: Mechanism, body: number): { basis: Basis; points: Flat[] } {
  const shape = mechanism.shapePoints(body)
  const normal = mechanism.into(body, mechanism.plane!)
  // Hardpoints of a planar mechanism may differ a little in height; the first represents all.
  const basis = new Basis((shape[0] ?? normal.clone().setScalar(0)).clone().add(mechanism.lift(body)), normal)
  return { basis, points: shape.map((point) => basis.to(point)) }
}

const distance = (a: Flat, b: Flat) => Math.hypot(a[0] - b[0], a[1] - b[1])
