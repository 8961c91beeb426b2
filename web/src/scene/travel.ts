import { Vector3 } from 'three'
import type { Curve } from '../curve'
import type { Driver } from '../report'

/** Minimum and maximum of a driven coordinate; true if it ends above its beginning. */
export interface Travel {
  curve: Curve
  low: number
  high: number
  onwards: boolean
}

/** The travel of a driver in this motion; undefined if nothing was solved. */
export function travelOf(driver: Driver): Travel | undefined {
  const curve = driver.travel
  const solved = curve.filter(Number.isFinite)
  if (solved.length === 0) return undefined
  return {
    curve,
    low: solved.reduce((a, b) => Math.min(a, b)),
    high: solved.reduce((a, b) => Math.max(a, b)),
    onwards: solved[solved.length - 1] >= solved[0],
  }
}

/** Rotations within this of a whole turn are drawn as a whole turn, rad. */
const NEARLY = 0.2
/** Angle drawn for a whole turn, so that both ends are visible, rad. */
const WHOLE = 4.9

/** A drawn arc: from one angle to another, with a head at its end, or at both ends. */
export interface Arc {
  radius: number
  from: number
  to: number
  heads: 'first' | 'last' | 'both'
}

/**
 * The arc of a hinge's travel: at least `minimum` long, as narrow as that allows. Whole turns have one head, in the
 * sense of the turn.
 */
export function arcOf(
  low: number,
  high: number,
  onwards: boolean,
  minimum: number,
  [narrow, wide]: [number, number],
): Arc {
  const swept = high - low
  if (swept > 2 * Math.PI - NEARLY) {
    return { radius: narrow, from: 0.5, to: 0.5 + WHOLE, heads: onwards ? 'last' : 'first' }
  }
  const radius = Math.min(Math.max(narrow, swept > 0 ? minimum / swept : wide), wide)
  const grow = Math.max(0, (minimum / radius - swept) / 2)
  return { radius, from: low - grow, to: high + grow, heads: 'both' }
}

/** A range that is lengthened to both sides until it can be seen. */
export function atLeast(low: number, high: number, minimum: number): [number, number] {
  const grow = Math.max(0, (minimum - (high - low)) / 2)
  return [low - grow, high + grow]
}

/** Unit vector of the component of `direction` perpendicular to an axis; undefined if it is zero. */
export function offAxis(direction: Vector3, axis: Vector3, minimum: number): Vector3 | undefined {
  const rest = direction.clone().addScaledVector(axis, -direction.dot(axis))
  return rest.length() > minimum ? rest.normalize() : undefined
}
