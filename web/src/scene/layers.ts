import type { Vector3 } from 'three'

/** A link shorter than this part of all its neighbours lies above them: a crank. */
const SHORT = 0.6

/**
 * In which layer each body of a planar mechanism lies. Longest first; each takes the lowest layer that no body sharing
 * a joint's place has.
 */
export function layers(lengths: number[], pins: { at: Vector3; bodies: number[] }[], tolerance: number): number[] {
  const spots: { at: Vector3; bodies: Set<number> }[] = []
  for (const pin of pins) {
    const known = spots.find(({ at }) => at.distanceTo(pin.at) < tolerance)
    if (known) pin.bodies.forEach((body) => known.bodies.add(body))
    else spots.push({ at: pin.at, bodies: new Set(pin.bodies) })
  }
  const layer = lengths.map(() => 0)
  const order = lengths
    .map((_, body) => body)
    .slice(1)
    .sort((a, b) => lengths[b] - lengths[a])
  for (const body of order) {
    const neighbours = [
      ...new Set(spots.filter(({ bodies }) => bodies.has(body)).flatMap(({ bodies }) => [...bodies])),
    ].filter((other) => other > 0 && other !== body)
    const used = neighbours.map((other) => layer[other])
    const short = neighbours.length > 0 && neighbours.every((other) => lengths[body] < SHORT * lengths[other])
    let lowest = short ? Math.max(...used) + 1 : 1
    while (used.includes(lowest)) lowest++
    layer[body] = lowest
  }
  return layer
}
