import { type Camera, Vector3 } from 'three'
import { svg } from '../dom'

const REACH = 30

/** The world's axes in a corner of the view, turned as the camera is. */
export class Triad {
  readonly element = svg('svg', { class: 'triad', viewBox: '-45 -45 90 90', 'aria-hidden': 'true' })
  #axes = (['x', 'y', 'z'] as const).map((name, k) => {
    const line = svg('line', { x1: 0, y1: 0 })
    const text = svg('text')
    text.textContent = name
    const group = svg('g', { class: `axis-${name}` }, line, text)
    this.element.append(group)
    return { unit: new Vector3().setComponent(k, 1), line, text }
  })

  update(camera: Camera): void {
    const inverse = camera.quaternion.clone().invert()
    for (const { unit, line, text } of this.#axes) {
      const seen = unit.clone().applyQuaternion(inverse)
      line.setAttribute('x2', String(seen.x * REACH))
      line.setAttribute('y2', String(-seen.y * REACH))
      text.setAttribute('x', String(seen.x * (REACH + 8)))
      text.setAttribute('y', String(-seen.y * (REACH + 8)))
      // An axis that points at the reader has no direction on the screen; its letter would sit on the origin.
      text.style.opacity = Math.hypot(seen.x, seen.y) < 0.15 ? '0' : '1'
    }
  }
}
