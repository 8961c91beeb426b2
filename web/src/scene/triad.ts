import { type Camera, Vector3 } from 'three'
import { svg } from '../dom'
import type { Mechanism } from './mechanism'

const REACH = 28
/** Distance from the tip to the centre of a letter; for a word, also sideways. */
const GAP = 8
/** Approximate width of a word next to the box, px. */
const WORD = 28
/** An axis along a direction of the vehicle has at least this cosine with it. */
const ALONG = 0.99

/** A direction that the triad shows. */
interface Direction {
  unit: Vector3
  name: string
}

/** The world's axes in a corner of the view, turned as the camera is; in words where they are those of a vehicle. */
export class Triad {
  readonly element = svg('svg', { class: 'triad', viewBox: '-45 -45 90 90', 'aria-hidden': 'true' })
  #axes: (Direction & { line: SVGLineElement; text: SVGTextElement })[]

  constructor(vehicle?: Mechanism['vehicle']) {
    this.#axes = directions(vehicle).map((direction, k) => {
      const line = svg('line', { x1: 0, y1: 0 })
      const text = svg('text')
      text.textContent = direction.name
      this.element.append(svg('g', { class: `axis-${'xyz'[k]}` }, line, text))
      return { ...direction, line, text }
    })
    // Words reach beyond the box of the letters.
    this.element.style.overflow = 'visible'
    if (vehicle) this.element.style.left = `${WORD}px`
  }

  update(camera: Camera): void {
    const inverse = camera.quaternion.clone().invert()
    for (const { unit, name, line, text } of this.#axes) {
      const seen = unit.clone().applyQuaternion(inverse)
      line.setAttribute('x2', String(seen.x * REACH))
      line.setAttribute('y2', String(-seen.y * REACH))
      const word = name.length > 1
      text.setAttribute('x', String(seen.x * (REACH + (word ? 3 : GAP))))
      text.setAttribute('y', String(-seen.y * (REACH + GAP)))
      text.style.textAnchor = word && Math.abs(seen.x) > 0.4 ? (seen.x > 0 ? 'start' : 'end') : 'middle'
      // An axis that points at the reader has no direction on the screen; its name would sit on the origin.
      text.style.opacity = Math.hypot(seen.x, seen.y) < 0.15 ? '0' : '1'
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
