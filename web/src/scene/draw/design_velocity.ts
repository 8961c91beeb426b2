import { Vector3 } from 'three'
import { number, pretty } from '../../format'
import type { Arrow } from '../../payload'
import type { Variable } from '../../report'
import { rounded } from '../../rounding'
import { ABOVE, ringArrow, straightArrow } from '../arrow'
import type { Draw, Drawable } from '../drawable'
import { hingePlaces } from '../hinge'
import type { Mechanism } from '../mechanism'

/**
 * The longest arrow as a part of the mechanism's size and of its height across its longest side, but long enough to be
 * seen, in units.
 */
const LONGEST = { ofSize: 0.11, ofHeight: 0.75, least: 9 }
/** Radius of the shaft, length of the head, radius of a ring, in units. */
const SHAFT = 0.5
const HEAD = 3.4
const RING = 5
/** Places that a turn moves by less than this part of the size per radian are where it turns about. */
const STILL = 1e-9
/** Two places nearer than this part of the size show one arrow. */
const ONE = 1e-3

/** Design velocity of the chosen variable: arrows in proportion, one per point, rings for rotations. */
export const designVelocity: Draw = (mechanism, kit, choice) => {
  const variable = mechanism.report.variables[choice.variable]
  if (!variable) return []
  const change = shownChange(mechanism, variable)
  const about = change === undefined ? 'design velocity' : `design velocity, scaled to ${changeText(change, variable)}`
  const part = { kind: 'mark' as const, index: variable.index, name: variable.name, about }
  const { chosen } = kit.palette
  const size = { head: HEAD * kit.unit, shaft: { radius: SHAFT * kit.unit } }
  const straight = moving(mechanism, variable, change ?? 0).map(({ body, from, to }): Drawable => {
    const lift = mechanism.lift(body, mechanism.topLayer + 3)
    return {
      body,
      object: straightArrow(kit, from.add(lift), to.add(lift), size, chosen, ABOVE.velocity),
      part,
      overlay: true,
    }
  })
  const maximum = longest(variable.arrows.map(({ turn }) => turn))
  const turning = variable.arrows.filter(({ turn }) => rounded(Math.hypot(...turn), maximum) > 0)
  const rings = onePerPlace(mechanism, turning).map(({ body, at, turn }): Drawable => {
    const place = turnedAt(mechanism, body, placeOf(mechanism, body, at)).add(
      mechanism.lift(body, mechanism.topLayer + 3),
    )
    const ring = ringArrow(
      kit,
      place,
      new Vector3(...turn),
      RING * kit.unit,
      HEAD * kit.unit,
      SHAFT * kit.unit,
      chosen,
      ABOVE.velocity,
    )
    return { body, object: ring, part, overlay: true }
  })
  return [...straight, ...rings]
}

/** Change of a variable at which its arrows have the length of the displacements; undefined if no hardpoint moves. */
export function shownChange(mechanism: Mechanism, { arrows }: Variable): number | undefined {
  const maximum = longest(arrows.map(({ v }) => v))
  return maximum > STILL * mechanism.size * longest(arrows.map(({ turn }) => turn))
    ? longestArrow(mechanism) / maximum
    : undefined
}

/** A change with its unit, as short as it may be said. */
export const changeText = (change: number, { unit }: Variable) => `${number(change, 2)} ${pretty(unit)}`.trim()

/** Maximum length of arrows; in proportion to a long chain they would be too long. */
function longestArrow(mechanism: Mechanism): number {
  const { base, size, unit } = mechanism
  // The box of a changed design would be that of its whole motion, made anew for each one.
  const [, height] = (base ?? mechanism).box
    .getSize(new Vector3())
    .toArray()
    .sort((a, b) => b - a)
  return Math.min(LONGEST.ofSize * size, Math.max(LONGEST.ofHeight * height, LONGEST.least * unit))
}

function moving(
  mechanism: Mechanism,
  { arrows }: Variable,
  change: number,
): { body: number; from: Vector3; to: Vector3 }[] {
  if (change === 0) return []
  const maximum = longest(arrows.map(({ v }) => v))
  const going = arrows.filter(({ v }) => rounded(Math.hypot(...v), maximum) > 0)
  return onePerPlace(mechanism, going).map(({ body, at, v }) => {
    const velocity = new Vector3(...v)
    const from = placeOf(mechanism, body, at)
    return { body, from, to: from.clone().addScaledVector(velocity, change) }
  })
}

/** A hardpoint given as loaded, where the design drawn has it. */
function placeOf({ base, report }: Mechanism, body: number, at: Arrow['at']): Vector3 {
  const place = new Vector3(...at)
  if (!base) return place
  const point = base.report.bodies[body].skeleton.findIndex((one) => base.same(new Vector3(...one), place))
  return point < 0 ? place : new Vector3(...report.bodies[body].skeleton[point])
}

/** Position of a rotation's ring: on the bearing that is drawn aside of another joint, which the ring would hide. */
function turnedAt(mechanism: Mechanism, body: number, at: Vector3): Vector3 {
  const aside = mechanism.report.joints.flatMap((joint) => {
    const own = joint.body_i === body ? joint.at_i : joint.body_j === body ? joint.at_j : undefined
    if (!own || joint.kind !== 'revolute' || joint.hinge || !mechanism.same(new Vector3(...own), at)) return []
    return hingePlaces(mechanism, joint).map((place) =>
      mechanism.placeInto(body, mechanism.worldAt(joint.body_i, place, 0)),
    )
  })
  return aside[0]?.clone() ?? at
}

function longest(vectors: [number, number, number][]): number {
  return Math.max(0, ...vectors.map((vector) => Math.hypot(...vector)))
}

/** A joint's place is a hardpoint of both its bodies; arrows that differ there are both shown. */
function onePerPlace(mechanism: Mechanism, arrows: Arrow[]): Arrow[] {
  const seen: { place: Vector3; v: Vector3; turn: Vector3 }[] = []
  return arrows.filter(({ body, at, v, turn }) => {
    const one = {
      place: mechanism.worldAt(body, new Vector3(...at), 0),
      v: mechanism.alongAt(body, new Vector3(...v), 0),
      turn: mechanism.alongAt(body, new Vector3(...turn), 0),
    }
    const same = (a: Vector3, b: Vector3) => a.distanceTo(b) <= ONE * a.length()
    if (
      seen.some(
        ({ place, v, turn }) =>
          place.distanceTo(one.place) < ONE * mechanism.size && same(v, one.v) && same(turn, one.turn),
      )
    )
      return false
    seen.push(one)
    return true
  })
}
