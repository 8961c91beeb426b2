import type { Flat } from '../flat'

/** Radius of a cam's roller as a part of the pitch curve's least radius of curvature, at most. */
const ROLLER = 0.4

/** Least radius of curvature of a curve through points. */
export function leastCurvature(points: Flat[], closed: boolean): number {
  const count = points.length
  const radii = points.flatMap((here, k) => {
    if (!closed && (k === 0 || k === count - 1)) return []
    const [before, after] = [points[(k + count - 1) % count], points[(k + 1) % count]]
    const [a, b, c] = [gap(before, here), gap(here, after), gap(before, after)]
    const twiceArea = Math.abs(
      (here[0] - before[0]) * (after[1] - before[1]) - (here[1] - before[1]) * (after[0] - before[0]),
    )
    return twiceArea > 0 ? [(a * b * c) / (2 * twiceArea)] : []
  })
  return Math.min(...radii, Infinity)
}

/**
 * Radius of the roller on a pitch curve: as wanted, but never so large that it could not reach into the curve's bends.
 */
export function rollerRadius(points: Flat[], closed: boolean, wanted: number): number {
  return Math.min(wanted, ROLLER * leastCurvature(points, closed))
}

/** A curve moved to its left by some distance, to its right where that is negative. */
export function offset(points: Flat[], by: number, closed: boolean): Flat[] {
  const count = points.length
  return points.map((here, k): Flat => {
    const before = points[closed ? (k + count - 1) % count : Math.max(0, k - 1)]
    const after = points[closed ? (k + 1) % count : Math.min(count - 1, k + 1)]
    const length = gap(before, after) || 1
    return [here[0] - (by * (after[1] - before[1])) / length, here[1] + (by * (after[0] - before[0])) / length]
  })
}

/** Profile of a plate cam: its pitch curve less the roller's radius. */
export function camProfile(pitch: Flat[], roller: number): Flat[] {
  return offset(pitch, Math.sign(signedArea(pitch)) * roller, true)
}

/** Outline of a groove or slot of some half width along an open curve, with round ends. */
export function grooveOutline(points: Flat[], half: number): Flat[] {
  const right = offset(points, -half, false)
  const left = offset(points, half, false)
  const last = points.length - 1
  return [...right, ...cap(points[last], right[last], half), ...left.reverse(), ...cap(points[0], left[last], half)]
}

/** A half circle about `centre` from a point next to it, counter-clockwise, without its ends. */
function cap(centre: Flat, beside: Flat, radius: number): Flat[] {
  const start = Math.atan2(beside[1] - centre[1], beside[0] - centre[0])
  return Array.from({ length: 11 }, (_, k): Flat => {
    const angle = start + ((k + 1) * Math.PI) / 12
    return [centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)]
  })
}

const gap = (a: Flat, b: Flat) => Math.hypot(a[0] - b[0], a[1] - b[1])

function signedArea(points: Flat[]): number {
  return (
    points.reduce((sum, a, k) => {
      const b = points[(k + 1) % points.length]
      return sum + a[0] * b[1] - b[0] * a[1]
    }, 0) / 2
  )
}
