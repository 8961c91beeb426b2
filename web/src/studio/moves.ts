import { Quaternion, type Ray, Vector3 } from 'three'
import type { MovableHardpoint, VariableSetting } from '../engine/protocol'
import { limited } from '../variables'

/**
 * Direction in which a hardpoint is moved: in the plane of two axes that faces the reader, along an axis of the model,
 * in the plane of two axes, or in the plane of the picture.
 */
export type DragDirection = 'auto' | 'x' | 'y' | 'z' | 'xy' | 'yz' | 'zx' | 'free'
export const AXES = ['x', 'y', 'z'] as const

/** Sine of the angle between a line of sight and an axis or plane below which they count as parallel. */
const GRAZING = 0.02
/** Two hardpoints are mirror images to this part of the size of the mechanism. */
const MIRRORED = 1e-6
/** A change below this is rounding of the sums that make it, in any unit of a model. */
const ROUNDING = 1e-10

/** Directions that can be chosen, the usual one first: in a planar mechanism those in its plane. */
export function directionsOffered(plane: Vector3 | undefined): DragDirection[] {
  if (!plane) return ['auto', 'x', 'y', 'z', 'xy', 'yz', 'zx', 'free']
  const within = AXES.filter((_, k) => Math.abs(plane.getComponent(k)) < GRAZING)
  return ['free', ...(within.length === 2 ? within : AXES)]
}

/** The plane of two axes that faces the reader; `turn` rotates directions of the design into the world. */
export function facingPlane(turn: Quaternion, facing: Vector3): 'xy' | 'yz' | 'zx' {
  const seen = AXES.map((_, k) => Math.abs(new Vector3().setComponent(k, 1).applyQuaternion(turn).dot(facing)))
  return (['yz', 'zx', 'xy'] as const)[seen.indexOf(Math.max(...seen))]
}

/** Unit vectors of a drag direction in the design configuration; none for the plane of the screen. */
function directions(way: DragDirection): Vector3[] {
  return way === 'free' || way === 'auto'
    ? []
    : [...way].map((axis) => new Vector3().setComponent(AXES.indexOf(axis as 'x'), 1))
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

/** Effect of a design variable on hardpoints: displacement of each, by name, per unit of the variable. */
export interface SharedVariable {
  name: string
  bounds: readonly [number | null, number | null] | null
  moves: ReadonlyMap<string, Vector3>
}

/** A hardpoint that moves as the mirror image of another one. */
export interface Partner {
  axis: number
  grip: MovableHardpoint
}

/** Settings that put hardpoints at a position, and the variable whose bound is reached. */
export interface Placing {
  settings: VariableSetting[]
  bound?: string
}

/** Positions of hardpoints in the design configuration, as functions of what moves them. */
export class Positions {
  /** By hardpoint: the variables that move it, other than its own coordinates. */
  readonly #shared = new Map<string, SharedVariable[]>()

  constructor(grips: readonly MovableHardpoint[], variables: readonly SharedVariable[]) {
    for (const { name, coordinates } of grips) {
      const own = coordinates.map(({ variable }) => variable)
      this.#shared.set(
        name,
        variables.filter((variable) => variable.moves.has(name) && !own.includes(variable.name)),
      )
    }
  }

  /** Position of a hardpoint in the design with these changes. */
  of(grip: MovableHardpoint, settings: readonly VariableSetting[]): Vector3 {
    return this.#at(grip, changesOf(settings))
  }

  /**
   * Settings that put a hardpoint at a position, and its mirror image at the mirrored one, within the bounds of the
   * variables. A variable that moves exactly these two is changed, where there is one.
   */
  settings(
    grip: MovableHardpoint,
    place: Vector3,
    present: readonly VariableSetting[],
    partner: Partner | undefined,
  ): Placing {
    const by = changesOf(present)
    const changed = new Map<string, number>()
    let bound: string | undefined
    const set = (name: string, wanted: number, bounds: SharedVariable['bounds'] | undefined) => {
      const value = limited(wanted, bounds)
      const isLimited = Math.abs(value - wanted) > 1e-9 * (1 + Math.abs(wanted))
      if (isLimited) bound = name
      changed.set(name, value)
      by.set(name, value)
      return isLimited
    }
    const target = place.clone()
    if (partner)
      for (const k of [0, 1, 2]) {
        const shared = this.#symmetric(grip, partner, k)
        if (!shared) continue
        const missing = place.getComponent(k) - this.#at(grip, by).getComponent(k)
        const rate = shared.moves.get(grip.name)!.getComponent(k)
        const isLimited = set(shared.name, exact((by.get(shared.name) ?? 0) + missing / rate), shared.bounds)
        // Where its bound stops both, neither goes on by itself.
        if (isLimited) target.setComponent(k, this.#at(grip, by).getComponent(k))
      }
    const put = (one: MovableHardpoint, at: Vector3) => {
      const carried = this.#carried(one, by)
      one.coordinates.forEach(({ variable, sign, bounds }, k) => {
        const wanted = (at.getComponent(k) - one.place[k] - carried.getComponent(k)) / sign
        set(variable, exact(wanted), bounds)
      })
    }
    put(grip, target)
    if (partner) put(partner.grip, mirrored(target, partner.axis))
    return { settings: settingsOf(changed), bound }
  }

  #at(grip: MovableHardpoint, by: ReadonlyMap<string, number>): Vector3 {
    const [x, y, z] = grip.coordinates.map(({ variable, sign }) => sign * (by.get(variable) ?? 0))
    return new Vector3(...grip.place).add(new Vector3(x, y, z)).add(this.#carried(grip, by))
  }

  /** Displacement by variables other than its own coordinates. */
  #carried({ name }: MovableHardpoint, by: ReadonlyMap<string, number>): Vector3 {
    const sum = new Vector3()
    for (const { name: variable, moves } of this.#shared.get(name) ?? [])
      sum.addScaledVector(moves.get(name)!, by.get(variable) ?? 0)
    return sum
  }

  /** The variable that moves a hardpoint and its mirror image along an axis, and nothing else. */
  #symmetric(grip: MovableHardpoint, { axis, grip: other }: Partner, k: number): SharedVariable | undefined {
    return this.#shared.get(grip.name)?.find(({ moves }) => {
      const [a, b] = [moves.get(grip.name), moves.get(other.name)]
      const alone = a && AXES.every((_, other) => (other === k) === Math.abs(a.getComponent(other)) > MIRRORED)
      return alone && b && moves.size === 2 && mirrored(a, axis).distanceTo(b) < MIRRORED
    })
  }
}

/** Changes by name. */
export function changesOf(settings: readonly VariableSetting[]): Map<string, number> {
  return new Map(settings.map(({ name, by }) => [name, by]))
}

/** Settings of changes by name. */
export function settingsOf(changes: ReadonlyMap<string, number>): VariableSetting[] {
  return [...changes].map(([name, by]) => ({ name, by }))
}

/** Without the last digits, which are rounding; nothing of a difference that is rounding. */
function exact(value: number): number {
  const round = Number(value.toPrecision(12))
  return Math.abs(round) < ROUNDING ? 0 : round
}

function mirrored(place: Vector3, axis: number): Vector3 {
  return place.clone().setComponent(axis, -place.getComponent(axis))
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
