import { Quaternion, Vector3 } from 'three'
import type { MovableHardpoint, OpenReply } from '../engine/protocol'
import type { Report } from '../report'
import type { State } from '../state'
import { AXES, mirrors, type Partner, Positions, type SharedVariable, snapped } from './moves'

/** Coordinates that differ by less than this part of the largest one are the same. */
const SAME = 1e-9
/** Length of the step of a variable that moves hardpoints and does nothing else. */
const STRAIGHT = 1e-6

/** Moves hardpoints by the variables and coordinates of the present design, to both sides of a mirror if requested. */
export class Mover {
  readonly grips: readonly MovableHardpoint[]
  /** The plane across which hardpoints have mirror images; `on` if these move as well. */
  readonly mirror?: { axis: number; partner: ReadonlyMap<string, MovableHardpoint>; on: boolean }
  #positions: Positions
  /** Largest coordinate. */
  #size: number

  constructor(
    readonly state: State,
    opened: OpenReply,
  ) {
    this.grips = opened.grips
    this.#size = Math.max(...opened.grips.flatMap(({ place }) => place.map(Math.abs)), 0)
    const found = mirrors(opened.grips)
    this.mirror = found && { ...found, on: true }
    this.#positions = new Positions(opened.grips, sharedVariables(state.report, opened))
  }

  /** Position in the design configuration of the present design. */
  place(grip: MovableHardpoint): Vector3 {
    return this.#positions.of(grip, this.state.settings)
  }

  partner(grip: MovableHardpoint): Partner | undefined {
    const other = this.mirror?.on ? this.mirror.partner.get(grip.name) : undefined
    return other && { axis: this.mirror!.axis, grip: other }
  }

  /** True if two coordinates differ by more than rounding. */
  differ(a: number, b: number): boolean {
    return Math.abs(a - b) > SAME * this.#size
  }

  /**
   * Puts a hardpoint, and its mirror image, at a position rounded to multiples of `snap`; coordinates that are the same
   * as `before` keep their numbers.
   */
  move(grip: MovableHardpoint, place: Vector3, { snap = 0, before = this.place(grip) } = {}): void {
    AXES.forEach((_, k) => {
      const moved = this.differ(place.getComponent(k), before.getComponent(k))
      place.setComponent(k, moved ? snapped(place.getComponent(k), snap) : before.getComponent(k))
    })
    const { settings, bound } = this.#positions.settings(grip, place, this.state.settings, this.partner(grip))
    this.state.bound = bound ? `\`${bound}\` is at its bound` : ''
    this.state.adjust(settings)
  }

  /** Puts several hardpoints at positions, as one change; mirror images stay. */
  moveAll(places: ReadonlyMap<MovableHardpoint, Vector3>): void {
    let present = this.state.settings
    const bounds: string[] = []
    for (const [grip, place] of places) {
      const { settings, bound } = this.#positions.settings(grip, place, present, undefined)
      const names = new Set(settings.map(({ name }) => name))
      present = [...present.filter(({ name }) => !names.has(name)), ...settings]
      if (bound) bounds.push(`\`${bound}\``)
    }
    this.state.bound = bounds.length > 0 ? `${bounds.join(', ')}: at the bound` : ''
    this.state.adjust(present)
  }
}

/** Variables that move hardpoints along straight lines, with the world's displacement of each per unit. */
function sharedVariables({ variables, bodies }: Report, { frames }: OpenReply): SharedVariable[] {
  return variables.flatMap(({ name, arrows, bounds }) => {
    const moves = new Map<string, Vector3>()
    for (const { body, at, v, turn } of arrows) {
      const step = new Vector3(...v)
      if (turn.some((x) => x !== 0) || Math.abs(step.length() - 1) > STRAIGHT) return []
      const [w, x, y, z] = frames[body] ?? [1, 0, 0, 0]
      step.applyQuaternion(new Quaternion(x, y, z, w))
      // A direction along an axis is that to the last digit.
      AXES.forEach((_, k) => {
        const part = step.getComponent(k)
        if (Math.abs(part - Math.round(part)) < STRAIGHT) step.setComponent(k, Math.round(part))
      })
      const { skeleton, labels } = bodies[body]
      const point = skeleton.findIndex((other) =>
        other.every((x, k) => Math.abs(x - at[k]) <= 1e-6 * (1 + Math.abs(x))),
      )
      for (const label of labels[point]?.split(', ') ?? []) moves.set(label, step)
    }
    return moves.size > 0 ? [{ name, bounds, moves }] : []
  })
}
