import { Vector3 } from 'three'

/** From where mechanisms in space that are no vehicles are usually seen first. */
export const READER = new Vector3(0.75, -1, 0.55)
/** The other three corners, seen from as high. */
const OTHERS = [new Vector3(-0.75, -1, 0.55), new Vector3(0.75, 1, 0.55), new Vector3(-0.75, 1, 0.55)]
/** Another corner must be better than the usual one by this factor: readers know where to look for x and y. */
const BETTER = 0.85
/** Joints nearer to one another in the picture than this part of the mechanism's size cover one another. */
const COVERED = 0.04

/** The corner from which joints cover one another least; `moments` has the places of the joints at several times. */
export function readerOf(moments: Vector3[][], size: number): Vector3 {
  const usual = crowding(moments, READER, size)
  const costs = OTHERS.map((corner) => crowding(moments, corner, size))
  const least = Math.min(...costs)
  return (least < BETTER * usual ? OTHERS[costs.indexOf(least)] : READER).clone()
}

/** Large where many joints lie close to one another as seen along a direction. */
function crowding(moments: Vector3[][], direction: Vector3, size: number): number {
  const line = direction.clone().normalize()
  const near = COVERED * size
  let sum = 0
  for (const places of moments) {
    const seen = places.map((place) => place.clone().addScaledVector(line, -place.dot(line)))
    seen.forEach((a, k) => seen.slice(k + 1).forEach((b) => (sum += 1 / (1 + a.distanceToSquared(b) / near ** 2))))
  }
  return sum
}
