import type { Vector3 } from 'three'

/** Fraction of the largest distance below which a vertex is at a hardpoint and moves with it. */
const AT = 1e-9

/**
 * The vertices of a mesh after its body's hardpoints went from one place to another: each depends on the mean of the
 * hardpoints' ways, weighted with the inverse square of the distance (Shepard 1968). Hardpoints that stay hold what is
 * near them.
 */
export function deformed(positions: Float32Array, from: Vector3[], to: Vector3[]): Float32Array {
  const directions = from.map((point, k) => to[k].clone().sub(point))
  const moved = positions.slice()
  if (directions.every((direction) => direction.lengthSq() === 0)) return moved
  const size = Math.max(...from.map((point) => point.lengthSq()), 1e-30)
  for (let k = 0; k < positions.length; k += 3) {
    const sum = [0, 0, 0]
    let weights = 0
    for (let i = 0; i < from.length; i++) {
      const squared =
        (positions[k] - from[i].x) ** 2 + (positions[k + 1] - from[i].y) ** 2 + (positions[k + 2] - from[i].z) ** 2
      const weight = 1 / Math.max(squared, AT * AT * size)
      weights += weight
      sum[0] += weight * directions[i].x
      sum[1] += weight * directions[i].y
      sum[2] += weight * directions[i].z
    }
    for (let axis = 0; axis < 3; axis++) moved[k + axis] += sum[axis] / weights
  }
  return moved
}
