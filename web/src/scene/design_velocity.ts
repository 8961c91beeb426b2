import { Vector3 } from 'three'
import type { Arrow } from '../payload'
import type { Variable } from '../report'
import { ABOVE, ringArrow, straightArrow } from './arrow'
import type { Drawn } from './drawn'
import type { Kit } from './kit'
import type { Mechanism } from './mechanism'

/** The longest arrow as a part of the mechanism's size. */
const LONGEST = 0.11
/** Radius of the shaft, length of the head, radius of a ring, in units. */
const SHAFT = 0.5
const HEAD = 3.4
const RING = 5
/** A shorter arrow than this part of the longest is round-off. */
const NOTHING = 1e-9
/** Two places nearer than this part of the size show one arrow. */
const ONE = 1e-3

/** How the hardpoints go with a variable: arrows in proportion, one per place, rings where a body is turned. */
export function designVelocity(mechanism: Mechanism, kit: Kit, variable: Variable, change = 0): Drawn[] {
  const part = { kind: 'mark' as const, index: variable.index, name: variable.name, about: 'design velocity' }
  const { chosen } = kit.palette
  const size = { head: HEAD * kit.unit, shaft: { radius: SHAFT * kit.unit } }
  const straight = moving(mechanism, variable, change).map(({ body, from, to }): Drawn => {
    const lift = mechanism.lift(body, mechanism.topLayer + 3)
    return { body, object: straightArrow(kit, from.add(lift), to.add(lift), size, chosen, ABOVE.velocity), part, overlay: true }
  })
  const most = longest(variable.arrows.map(({ turn }) => turn))
  const turning = variable.arrows.filter(({ turn }) => Math.hypot(...turn) > NOTHING * most)
  const rings = onePerPlace(mechanism, turning).map(({ body, at, v, turn }): Drawn => {
    const place = new Vector3(...at).addScaledVector(new Vector3(...v), change).add(mechanism.lift(body, mechanism.topLayer + 3))
    const ring = ringArrow(kit, place, new Vector3(...turn), RING * kit.unit, HEAD * kit.unit, SHAFT * kit.unit, chosen, ABOVE.velocity)
    return { body, object: ring, part, overlay: true }
  })
  return [...straight, ...rings]
}

/** Tips of the arrows in the first position, which a fitted picture shows too. */
export function velocityTips(mechanism: Mechanism, variable: Variable): Vector3[] {
  return moving(mechanism, variable, 0).map(({ body, to }) => mechanism.worldAt(body, to, 0))
}

function moving(mechanism: Mechanism, { arrows }: Variable, change: number): { body: number; from: Vector3; to: Vector3 }[] {
  const most = longest(arrows.map(({ v }) => v))
  const going = arrows.filter(({ v }) => Math.hypot(...v) > NOTHING * most)
  return onePerPlace(mechanism, going).map(({ body, at, v }) => {
    const velocity = new Vector3(...v)
    const from = new Vector3(...at).addScaledVector(velocity, change)
    return { body, from, to: from.clone().addScaledVector(velocity, (LONGEST * mechanism.size) / most) }
  })
}

function longest(vectors: [number, number, number][]): number {
  return Math.max(0, ...vectors.map((vector) => Math.hypot(...vector)))
}

/** A joint's place is a hardpoint of both its bodies; arrows that differ there are both shown. */
function onePerPlace(mechanism: Mechanism, arrows: Arrow[]): Arrow[] {
  const seen: { place: Vector3; v: Vector3; turn: Vector3 }[] = []
  return arrows.filter(({ body, at, v, turn }) => {
    const one = { place: mechanism.worldAt(body, new Vector3(...at), 0), v: mechanism.alongAt(body, new Vector3(...v), 0), turn: mechanism.alongAt(body, new Vector3(...turn), 0) }
    const same = (a: Vector3, b: Vector3) => a.distanceTo(b) <= ONE * a.length()
    if (seen.some(({ place, v, turn }) => place.distanceTo(one.place) < ONE * mechanism.size && same(v, one.v) && same(turn, one.turn))) return false
    seen.push(one)
    return true
  })
}
