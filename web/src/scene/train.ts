import { Vector3 } from 'three'
import type { CouplerMark } from '../payload'
import type { Mechanism } from './mechanism'

/**
 * Face width of gears, how far the first is from its bearing, and from one wheel on a shaft to the next; in units and
 * face widths.
 */
const FACE = 3.4
const FIRST = 7
const NEXT = 2.2
/** Cosine of the least angle at which axes are no longer parallel. */
const PARALLEL = 0.999
/** Wheels on one shaft that differ by less than this part of their radius are one. */
const SAME = 1e-3

/** A shaft: a hinge that couplers turn, in the first position, in the world. */
export interface Shaft {
  joint: number
  /** The body that turns on it. */
  body: number
  at: Vector3
  axis: Vector3
  /** Distance from `at` along the axis of the nearest part on it. */
  low: number
  high: number
}

/** A wheel that a coupler puts on a shaft, in the first position, in the world. */
export interface Wheel {
  shaft: Shaft
  /** The body that it is fixed to: of a planetary train not the carrier, so it may be ground. */
  body: number
  centre: Vector3
  coefficient: number
}

/** Positions of the wheels of all couplers along their shafts: several on one shaft are spaced in file order. */
export class Train {
  readonly face: number
  #shafts = new Map<number, Shaft>()
  #pairs = new Map<number, [Wheel, Wheel]>()
  #toothed: { body: number; centre: Vector3; teeth: number; radius: number; towards: Vector3; phase: number }[] = []

  constructor(private readonly mechanism: Mechanism) {
    this.face = FACE * mechanism.unit
    const levels = new Map<number, number>()
    mechanism.report.couplers.forEach((coupler, index) => {
      for (const { joint, turns } of coupler.terms) if (turns) this.shaftOf(joint)
      const pair = this.#pairOf(coupler)
      if (!pair) return
      const [a, b] = pair.map(({ shaft }) => shaft)
      const level = Math.max(...[a, b].map(({ joint }) => (levels.get(joint) ?? -1) + 1))
      for (const { joint } of [a, b]) levels.set(joint, level)
      const along = mechanism.plane ? 0 : FIRST * mechanism.unit + level * NEXT * this.face
      pair[0].centre = a.at.clone().addScaledVector(a.axis, along)
      const beside = pair[0].centre.clone().sub(b.at).dot(b.axis)
      pair[1].centre = b.at.clone().addScaledVector(b.axis, beside)
      reach(a, along)
      reach(b, beside)
      this.#pairs.set(index, pair)
    })
  }

  get shafts(): Shaft[] {
    return [...this.#shafts.values()]
  }

  /** The shaft of a joint, where it is a hinge. */
  shaftOf(joint: number): Shaft | undefined {
    const known = this.#shafts.get(joint)
    const mark = this.mechanism.report.joints[joint]
    if (known || mark?.kind !== 'revolute' || !mark.axis) return known
    const shaft = {
      joint,
      body: mark.body_j > 0 ? mark.body_j : mark.body_i,
      at: this.mechanism.worldAt(mark.body_i, new Vector3(...mark.at_i), 0),
      axis: this.mechanism.alongAt(mark.body_i, new Vector3(...mark.axis), 0).normalize(),
      low: 0,
      high: 0,
    }
    this.#shafts.set(joint, shaft)
    return shaft
  }

  /** The two wheels of a pair on parallel shafts, in one plane. */
  pair(coupler: number): [Wheel, Wheel] | undefined {
    return this.#pairs.get(coupler)
  }

  /** The angle from a direction to the middle of a tooth of a wheel, if another coupler has drawn it. */
  toothing(wheel: Wheel, teeth: number, radius: number, towards: Vector3): number | undefined {
    const known = this.#toothed.find(
      (one) =>
        one.body === wheel.body &&
        one.teeth === teeth &&
        Math.abs(one.radius - radius) < SAME * radius &&
        one.centre.distanceTo(wheel.centre) < SAME * radius,
    )
    if (!known) return undefined
    const from = towards.clone().normalize()
    const to = known.towards.clone().normalize()
    return known.phase + Math.atan2(from.clone().cross(to).dot(wheel.shaft.axis), from.dot(to))
  }

  /** Stores the orientation of a wheel: the middle of a tooth is at the angle `phase` from a direction. */
  tooth({ body, centre }: Wheel, teeth: number, radius: number, towards: Vector3, phase: number): void {
    this.#toothed.push({ body, centre, teeth, radius, towards, phase })
  }

  #bodiesOf({ joint }: Shaft): number[] {
    const { body_i, body_j } = this.mechanism.report.joints[joint]
    return [body_i, body_j]
  }

  #pairOf({ kind, terms }: CouplerMark): [Wheel, Wheel] | undefined {
    if ((kind !== 'gear' && kind !== 'belt') || terms.length !== 2) return undefined
    const wheels = terms.flatMap(({ joint, coefficient, turns }): Wheel[] => {
      const shaft = turns ? this.shaftOf(joint) : undefined
      return shaft ? [{ shaft, body: shaft.body, centre: shaft.at, coefficient }] : []
    })
    if (wheels.length !== 2) return undefined
    const [a, b] = wheels
    const [ofA, ofB] = wheels.map(({ shaft }) => this.#bodiesOf(shaft))
    const carriers = ofA.filter((body) => ofB.includes(body))
    // The carrier in which both rotate is not fixed to either.
    if (carriers.length === 1) {
      const fixed = (bodies: number[]) => bodies.find((body) => body !== carriers[0])!
      a.body = fixed(ofA)
      b.body = fixed(ofB)
    }
    return Math.abs(a.shaft.axis.dot(b.shaft.axis)) > PARALLEL ? [a, b] : undefined
  }
}

/** A shaft extends through everything on it. */
export function reach(shaft: Shaft, along: number): void {
  shaft.low = Math.min(shaft.low, along)
  shaft.high = Math.max(shaft.high, along)
}
