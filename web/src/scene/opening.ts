import { Vector3 } from 'three'
import type { Mechanism } from './mechanism'

/** A planar mechanism that is narrower than this part of its length is seen as a line. */
const LINE = 0.06
/** The first moment is shown at which it is at least this part of its greatest width. */
const OPEN = 0.8

/**
 * Step at which the links of a mechanism are seen best, if at the start they lie on one line, as those of a press
 * at its dead centre do; 0 for all others.
 */
export function openingStep(mechanism: Mechanism): number {
  const { plane, moments, report } = mechanism
  if (!plane) return 0
  const places = report.bodies.flatMap((_, body) => mechanism.placesOf(body).map((place) => ({ body, place })))
  const width = (step: number) => {
    const points = places.map(({ body, place }) => mechanism.worldAt(body, place, step))
    return points.every(({ x, y, z }) => Number.isFinite(x + y + z)) ? narrowest(points, plane) : 0
  }
  const [length, start] = [mechanism.size, width(0)]
  if (start > LINE * length) return 0
  const widths = moments.map(width)
  const greatest = Math.max(...widths)
  return greatest > 2 * start ? moments[widths.findIndex((one) => one >= OPEN * greatest)] : 0
}

/** Extent of points in the direction of their plane in which it is least. */
function narrowest(points: Vector3[], plane: Vector3): number {
  const ANGLES = 18
  const first = new Vector3(...(Math.abs(plane.x) < 0.9 ? [1, 0, 0] : [0, 1, 0])).cross(plane).normalize()
  return Math.min(
    ...Array.from({ length: ANGLES }, (_, k) => {
      const along = first.clone().applyAxisAngle(plane, (Math.PI * k) / ANGLES)
      const at = points.map((point) => point.dot(along))
      return Math.max(...at) - Math.min(...at)
    }),
  )
}
