import { Vector3 } from 'three'
import type { CouplerMark } from '../../payload'
import { Basis } from '../flat'
import type { Train } from '../train'
import { gearOutline } from './toothing'

/** Two bevel gears: cones with one tip, rolling on one line. */
export interface BevelPair {
  tip: Vector3
  /** Unit vector from the tip along the line on which they roll. */
  line: Vector3
  /** Length of that line. */
  length: number
  gears: [Bevel, Bevel]
}

export interface Bevel {
  /** Unit vector from the tip towards the wide end. */
  axis: Vector3
  /** Pitch radius at the wide end, and how far that is from the tip. */
  radius: number
  distance: number
}

interface Shaft {
  at: Vector3
  axis: Vector3
  /** Coefficient of its angle in the relation between the two. */
  coefficient: number
}

/** Distances of a bevel's wide end from the joint, and of its rim from the other shaft, relative to the distance. */
const NEAR = 0.85
const RIM = 0.92
/** Sine of the least angle between shafts that still cross. */
const CROSSING = 0.1

/** The pair that turns as the relation says; nothing for shafts that are parallel. */
export function bevelPair(a: Shaft, b: Shaft): BevelPair | undefined {
  const [u, v] = [a.axis.clone().normalize(), b.axis.clone().normalize()]
  const cosine = u.dot(v)
  const rest = 1 - cosine * cosine
  if (rest < CROSSING ** 2) return undefined
  const between = b.at.clone().sub(a.at)
  const tip = a.at.clone().addScaledVector(u, (between.dot(u) - cosine * between.dot(v)) / rest)
  // Where the cones touch both have one velocity: the relative turning is about the line on which they roll.
  const line = u.clone().multiplyScalar(b.coefficient).addScaledVector(v, a.coefficient).normalize()
  if (!(line.lengthSq() > 0)) return undefined
  const [p, q] = [a.at.clone().sub(tip), b.at.clone().sub(tip)]
  const larger =
    Math.abs(line.dot(u)) < Math.abs(line.dot(v))
      ? [line.dot(u) * p.dot(u), line.dot(v) * q.dot(v)]
      : [line.dot(v) * q.dot(v), line.dot(u) * p.dot(u)]
  // On the side of both joints, or else with the larger gear on its joint's side.
  if (larger[0] < 0 || (larger[0] === 0 && larger[1] < 0)) line.negate()
  const shafts: [Vector3, Vector3][] = [
    [u, p],
    [v, q],
  ]
  const room = Math.min(...shafts.map(([, place]) => place.length()).filter((length) => length > 0))
  const limits = shafts.map(([axis, place]) => {
    const along = line.dot(axis)
    const rim = (RIM * room) / Math.sqrt(1 - along * along)
    return along * place.dot(axis) > 0 ? Math.min(rim, (NEAR * place.length()) / Math.abs(along)) : rim
  })
  const length = Math.min(...limits)
  if (!Number.isFinite(length) || length <= 0) return undefined
  const gear = (axis: Vector3): Bevel => {
    const along = line.dot(axis)
    return {
      axis: axis.clone().multiplyScalar(Math.sign(along) || 1),
      radius: length * Math.sqrt(1 - along * along),
      distance: length * Math.abs(along),
    }
  }
  return { tip, line, length, gears: [gear(u), gear(v)] }
}

/** The pair that a coupler is, where both its shafts are hinges. */
export function bevelsOf(train: Train, { terms }: CouplerMark): BevelPair | undefined {
  const shafts = terms.flatMap(({ joint, turns, coefficient }) => {
    const shaft = turns ? train.shaftOf(joint) : undefined
    return shaft ? [{ at: shaft.at, axis: shaft.axis, coefficient }] : []
  })
  return shafts.length === 2 ? bevelPair(shafts[0], shafts[1]) : undefined
}

/**
 * Triangles of a toothed cone, three by three: from its wide end `width` along the cone towards the tip, closed at both
 * ends. The middle of a tooth is at the angle `phase` from `towards`.
 */
export function bevelCorners(
  tip: Vector3,
  { axis, radius, distance }: Bevel,
  towards: Vector3,
  teeth: number,
  height: number,
  phase: number,
  width: number,
): Vector3[] {
  const outline = gearOutline(teeth, radius, height, phase)
  const wide = new Basis(tip.clone().addScaledVector(axis, distance), axis, towards)
  const share = Math.max(0.3, 1 - width / Math.hypot(radius, distance))
  const narrow = new Basis(tip.clone().addScaledVector(axis, share * distance), axis, towards)
  const rim = outline.map((point) => wide.from(point))
  const toe = outline.map(([x, y]) => narrow.from([share * x, share * y]))
  return rim.flatMap((corner, k) => {
    const next = (k + 1) % rim.length
    return [
      corner,
      rim[next],
      toe[next],
      corner,
      toe[next],
      toe[k],
      wide.origin,
      rim[next],
      corner,
      narrow.origin,
      toe[k],
      toe[next],
    ].map((point) => point.clone())
  })
}
