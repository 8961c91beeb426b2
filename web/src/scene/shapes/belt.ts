import type { Flat } from '../flat'

/** A belt round two pulleys, seen along their axes: the first at the origin, the second at (distance, 0). */
export interface BeltPath {
  points: Flat[]
  /** Unit normals, away from the pulley that the belt lies on. */
  normals: Flat[]
  length: number
}

/** Points per turn round a pulley. */
const ROUND = 72

/** Nothing where the pulleys are too near to one another. */
export function beltPath(first: number, second: number, distance: number, crossed = false): BeltPath | undefined {
  const other = crossed ? -second : second
  const slope = (first - other) / distance
  if (!(Math.abs(slope) < 1)) return undefined
  // The belt leaves the first pulley where its radius is at this angle to the line of centres.
  const leave = Math.acos(slope)
  const points: Flat[] = []
  const normals: Flat[] = []
  const wrap = (centre: number, radius: number, from: number, to: number, side: number) => {
    const count = Math.max(2, Math.ceil((ROUND * Math.abs(to - from)) / (2 * Math.PI)))
    for (let k = 0; k <= count; k++) {
      const angle = from + ((to - from) * k) / count
      const normal: Flat = [Math.cos(angle), Math.sin(angle)]
      points.push([centre + radius * normal[0], radius * normal[1]])
      normals.push([side * normal[0], side * normal[1]])
    }
  }
  wrap(0, first, leave, 2 * Math.PI - leave, 1)
  if (crossed) wrap(distance, second, Math.PI - leave, leave - Math.PI, -1)
  else wrap(distance, second, -leave, leave, 1)
  const straight = Math.sqrt(distance ** 2 - (first - other) ** 2)
  const turned = crossed
    ? (first + second) * (2 * Math.PI - 2 * leave)
    : first * (2 * Math.PI - 2 * leave) + second * 2 * leave
  return { points, normals, length: 2 * straight + turned }
}
