import { Vector3 } from 'three'
import type { Mechanism } from './mechanism'
import { TINTS } from './palette'

/** Distance up to which mirrored points of two bodies are each other's image, relative to the size. */
const MIRRORED = 0.05

/** A colour for every body: neighbours differ, least used first, mirror images agree. Ground has none, -1. */
export function tints(mechanism: Mechanism): number[] {
  const { report, vehicle } = mechanism
  const tint: number[] = report.bodies.map(() => -1)
  const places = report.bodies.map((body, b) =>
    body.skeleton.map((point) => mechanism.worldAt(b, new Vector3(...point), 0)),
  )
  const neighbours = report.bodies.map(() => new Set<number>())
  for (const { body_i, body_j } of report.joints) {
    if (body_i === 0 || body_j === 0) continue
    neighbours[body_i].add(body_j)
    neighbours[body_j].add(body_i)
  }
  const left = vehicle && vehicle.up.clone().cross(vehicle.forward)
  for (let b = 1; b < tint.length; b++) {
    const twin = left
      ? places.findIndex((other, o) => o > 0 && o < b && mirrored(places[b], other, left, MIRRORED * mechanism.size))
      : -1
    if (twin > 0) {
      tint[b] = tint[twin]
      continue
    }
    const used = [...neighbours[b]].map((o) => tint[o])
    const count = (k: number) => tint.filter((other) => other === k).length
    const free = Array.from({ length: TINTS }, (_, k) => k).filter((k) => !used.includes(k))
    tint[b] = free.sort((a, c) => count(a) - count(c) || a - c)[0] ?? b % TINTS
  }
  return tint
}

function mirrored(these: Vector3[], those: Vector3[], left: Vector3, tolerance: number): boolean {
  const image = (point: Vector3) => point.clone().addScaledVector(left, -2 * point.dot(left))
  return (
    these.length > 0 &&
    these.length === those.length &&
    these.every((point) => those.some((other) => other.distanceTo(image(point)) < tolerance))
  )
}
