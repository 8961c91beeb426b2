import { Quaternion, type Ray, Vector3 } from 'three'
import type { MovableHardpoint, VariableSetting } from '../engine/protocol'

/**
 * Direction in which a hardpoint is moved: in the plane of the picture, along an axis of the model, or in the plane of
 * two axes.
 */
export type DragDirection = 'free' | 'x' | 'y' | 'z' | 'xy' | 'yz' | 'zx'
export const DRAG_DIRECTIONS: readonly DragDirection[] = ['free', 'x', 'y', 'z', 'xy', 'yz', 'zx']
export const AXES = ['x', 'y', 'z'] as const

/** Sine of the angle between a line of sight and an axis or plane below which they count as parallel. */
const GRAZING = 0.02
/** Two hardpoints are mirror images to this part of the size of the mechanism. */
const MIRRORED = 1e-6

/** Unit vectors of a drag direction in the design configuration; none for the plane of the screen. */
function directions(way: DragDirection): Vector3[] {
  return way === 'free' ? [] : [...way].map((axis) => new Vector3().setComponent(AXES.indexOf(axis as 'x'), 1))
}

/**
 * Displacement of a point, in the world, that follows the line of sight in a drag direction; `turn` rotates directions
 * of the design configuration into the world, `facing` points to the eye. Undefined where the line of sight is nearly
 * parallel to the axis or plane.
 */
export function followed(
  ray: Ray,
  place: Vector3,
  way: DragDirection,
  turn: Quaternion,
  facing: Vector3,
): Vector3 | undefined {
  const along = directions(way).map((axis) => axis.applyQuaternion(turn))
  if (along.length === 1) {
    // The point of the axis that is nearest to the line of sight.
    const [axis] = along
    const across = axis.clone().cross(ray.direction)
    if (across.length() < GRAZING) return undefined
    const between = ray.origin.clone().sub(place)
    const far = between.cross(ray.direction).dot(across) / across.lengthSq()
    return axis.clone().multiplyScalar(far)
  }
  const normal = along.length === 2 ? along[0].clone().cross(along[1]) : facing
  const steep = normal.dot(ray.direction)
  if (Math.abs(steep) < GRAZING) return undefined
  const far = place.clone().sub(ray.origin).dot(normal) / steep
  return ray.origin.clone().addScaledVector(ray.direction, far).sub(place)
}

/** Rotation of a body since the design configuration: `frame` is its frame there, w x y z, `pose` the present one. */
export function turnOf(frame: readonly number[], pose: Quaternion): Quaternion {
  const [w, x, y, z] = frame
  return pose.clone().multiply(new Quaternion(x, y, z, w).invert())
}

/** A coordinate rounded to a multiple of the snap; unchanged without a snap. */
export function snapped(value: number, snap: number): number {
  return snap > 0 ? Number((Math.round(value / snap) * snap).toPrecision(12)) : value
}

/** Position of a hardpoint in the design configuration of the design with these changes. */
export function placeOf(grip: MovableHardpoint, settings: readonly VariableSetting[]): Vector3 {
  const by = new Map(settings.map(({ name, by }) => [name, by]))
  const [x, y, z] = grip.coordinates.map(({ variable, sign }, k) => grip.place[k] + sign * (by.get(variable) ?? 0))
  return new Vector3(x, y, z)
}

/**
 * Settings that put a hardpoint at a position, within the bounds of its variables, and the variable whose bound is
 * reached.
 */
export function settingsFor(grip: MovableHardpoint, place: Vector3): { settings: VariableSetting[]; bound?: string } {
  let bound: string | undefined
  const settings = grip.coordinates.map(({ variable, sign, bounds }, k) => {
    const wanted = (place.getComponent(k) - grip.place[k]) / sign
    const by = bounds ? Math.min(Math.max(wanted, bounds[0]), bounds[1]) : wanted
    if (Math.abs(by - wanted) > 1e-9 * (1 + Math.abs(wanted))) bound = variable
    return { name: variable, by }
  })
  return { settings, bound }
}

/**
 * The axis across which hardpoints have mirror images, and whose image each is, by name; nothing where hardly any has
 * one.
 */
export function mirrors(
  grips: readonly MovableHardpoint[],
): { axis: number; partner: Map<string, MovableHardpoint> } | undefined {
  const size = Math.max(1e-9, ...grips.flatMap(({ place }) => place.map(Math.abs)))
  const near = MIRRORED * size
  const found = AXES.map((_, axis) => {
    const partner = new Map<string, MovableHardpoint>()
    for (const grip of grips) {
      if (Math.abs(grip.place[axis]) <= near) continue
      const image = grip.place.map((x, k) => (k === axis ? -x : x))
      const other = grips.find(({ place }) => place.every((x, k) => Math.abs(x - image[k]) <= near))
      if (other) partner.set(grip.name, other)
    }
    return { axis, partner }
  })
  const [best] = found.sort((a, b) => b.partner.size - a.partner.size)
  return best.partner.size >= 4 ? best : undefined
}

const UNITS: Record<string, number> = { mm: 1e-3, cm: 1e-2, m: 1, in: 0.0254, ft: 0.3048 }

/** A length as typed, in the unit of the model, like `12`, `12 mm`, `0.5in`; nothing where it is none. */
export function lengthOf(text: string, unit: string): number | undefined {
  const found = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([a-z]*)\s*$/i.exec(text.replace('−', '-'))
  if (!found) return undefined
  const [, number, symbol] = found
  if (symbol === '' || symbol === unit) return Number(number)
  const [from, to] = [UNITS[symbol], UNITS[unit]]
  return from && to ? (Number(number) * from) / to : undefined
}
