import { type Camera, type Quaternion, Vector3 } from 'three'
import { el, svg } from '../dom'
import type { AxisLook, Look } from './camera'
import type { Mechanism } from './mechanism'

const REACH = 28
/** Distance from the tip to the centre of a letter; for a word, also sideways. */
const GAP = 8
/** Distance and radius of the mark at the end of an axis that has no letter. */
const BACK = 22
const REST = 3
/** An axis shorter than this part of its length points at the reader. */
const POINTING = 0.15
/** Approximate width of a word next to the box, px. */
const WORD = 28
/** An axis along a direction of the vehicle has at least this cosine with it. */
const ALONG = 0.99

/** A direction that the triad shows. */
interface Direction {
  unit: Vector3
  name: string
}

/**
 * The world's axes in a corner of the view, turned as the camera is; in words where they are those of a vehicle. Both
 * ends of each are buttons of the views from there.
 */
export class Triad {
  readonly element: HTMLElement
  /** Orientation of the camera that it shows. */
  #drawn?: Quaternion
  #axes: (Direction & { line: SVGLineElement; rest: SVGCircleElement; text: SVGTextElement; ends: HTMLElement[] })[]

  /** `looks` are the views from both ends of each axis; `take` shows one. */
  constructor(vehicle: Mechanism['vehicle'], looks: readonly AxisLook[], take: (look: Look) => void) {
    const drawing = svg('svg', { viewBox: '-45 -45 90 90', 'aria-hidden': 'true' })
    this.#axes = directions(vehicle).map((direction, k) => {
      const line = svg('line', { x1: 0, y1: 0 })
      const text = svg('text')
      const rest = svg('circle', { r: REST })
      text.textContent = direction.name
      drawing.append(svg('g', { class: `axis-${'xyz'[k]}` }, line, rest, text))
      const ends = looks.slice(2 * k, 2 * k + 2).map(({ word, look }) =>
        el('button', {
          type: 'button',
          title: word,
          'aria-label': `View: ${word}`,
          'data-testid': `axis-${word.replace(' ', '-')}`,
          onclick: () => take(look),
        }),
      )
      return { ...direction, line, rest, text, ends }
    })
    this.element = el(
      'div',
      { class: 'triad', role: 'group', 'aria-label': 'Views along the axes' },
      drawing,
      ...this.#axes.flatMap(({ ends }) => ends),
    )
    if (vehicle) this.element.style.left = `${WORD}px`
  }

  update(camera: Camera): void {
    if (this.#drawn?.equals(camera.quaternion)) return
    this.#drawn = camera.quaternion.clone()
    const inverse = camera.quaternion.clone().invert()
    for (const { unit, name, line, rest, text, ends } of this.#axes) {
      const seen = unit.clone().applyQuaternion(inverse)
      const isFlat = Math.hypot(seen.x, seen.y) >= POINTING
      rest.setAttribute('cx', String(-seen.x * BACK))
      rest.setAttribute('cy', String(seen.y * BACK))
      rest.style.opacity = isFlat ? '' : '0'
      ends.forEach((end, k) => {
        const [x, y] = k === 0 ? [seen.x, -seen.y] : [-seen.x, seen.y]
        const reach = k === 0 ? REACH + GAP / 2 : BACK
        end.style.transform = `translate(${(x * reach).toFixed(1)}px, ${(y * reach).toFixed(1)}px)`
        // Of an axis that points at the reader the other end is reached with the keyboard: it is behind this one.
        end.style.zIndex = String(Math.round(10 * (k === 0 ? seen.z : -seen.z)) + 10)
      })
      line.setAttribute('x2', String(seen.x * REACH))
      line.setAttribute('y2', String(-seen.y * REACH))
      const word = name.length > 1
      text.setAttribute('x', String(seen.x * (REACH + (word ? 3 : GAP))))
      text.setAttribute('y', String(-seen.y * (REACH + GAP)))
      text.style.textAnchor = word && Math.abs(seen.x) > 0.4 ? (seen.x > 0 ? 'start' : 'end') : 'middle'
      // An axis that points at the reader has no direction on the screen; its name would sit on the origin.
      text.style.opacity = isFlat ? '1' : '0'
    }
  }
}

/** The directions along x, y and z: of a vehicle front, left and up, the way they point. */
export function directions(vehicle?: Mechanism['vehicle']): Direction[] {
  const words: Direction[] = vehicle
    ? [
        { unit: vehicle.forward.clone(), name: 'front' },
        { unit: vehicle.up.clone().cross(vehicle.forward), name: 'left' },
        { unit: vehicle.up.clone(), name: 'up' },
      ]
    : []
  return ['x', 'y', 'z'].map((name, k) => {
    const unit = new Vector3().setComponent(k, 1)
    return words.find((word) => Math.abs(word.unit.dot(unit)) > ALONG) ?? { unit, name }
  })
}
