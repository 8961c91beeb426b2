import { Vector3 } from 'three'

/** From where mechanisms in space that are no vehicles are usually seen first. */
export const READER = new Vector3(0.75, -1, 0.55)
/** The other three corners, seen from as high. */
const OTHERS = [new Vector3(-0.75, -1, 0.55), new Vector3(0.75, 1, 0.55), new Vector3(-0.75, 1, 0.55)]
/** Another corner must be better than the usual one by this factor: readers know where to look for x and y. */
const BETTER = 0.85
/** Joints nearer to one another in the picture than this part of the mechanism's size cover one another. */
const COVERED = 0.04

/** Penalty of a view direction for a wheel from behind, with its teeth away from the viewer. */
const BEHIND = 0.5

/**
 * The corner from which joints cover one another least, and wheels with teeth on one face show it; `moments` has the
 * places of the joints at several times, `backs` the directions in which those wheels turn their backs.
 */
export function readerOf(moments: Vector3[][], size: number, backs: Vector3[] = []): Vector3 {
  const cost = (corner: Vector3) =>
    (1 + crowding(moments, corner, size)) * (1 + BEHIND * backs.filter((back) => back.dot(corner) > 0).length)
  const usual = cost(READER)
  const costs = OTHERS.map(cost)
  const minimum = Math.min(...costs)
  return (minimum < BETTER * usual ? OTHERS[costs.indexOf(minimum)] : READER).clone()
}

/** Large where many joints lie closer to one another as seen along a direction than they are. */
function crowding(moments: Vector3[][], direction: Vector3, size: number): number {
  const line = direction.clone().normalize()
  const near = COVERED * size
  let sum = 0
  for (const places of moments) {
    const seen = places.map((place) => place.clone().addScaledVector(line, -place.dot(line)))
    const closeness = (a: Vector3, b: Vector3) => 1 / (1 + a.distanceToSquared(b) / near ** 2)
    for (let k = 1; k < places.length; k++)
      for (let l = 0; l < k; l++) sum += closeness(seen[k], seen[l]) - closeness(places[k], places[l])
  }
  return sum
}
