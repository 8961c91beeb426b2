import { type Quaternion, Vector3 } from 'three'
import { svg } from '../dom'
import type { View } from '../scene/view'
import { AXES } from './moves'

/** An axis arrow, px: from the point, its least length, and what is added where it is seen in full length. */
const ARROW = { from: 13, least: 14, full: 44, head: 9 }
/** An axis that is seen shorter than this points at the reader and has no arrow. */
const END_ON = 0.12

export type Axis = (typeof AXES)[number]

/** Listeners of what is dragged after it was pressed. */
type Dragging = Record<'onpointermove' | 'onpointerup' | 'onpointercancel', (event: PointerEvent) => void>

interface Arrow {
  axis: Axis
  element: SVGGElement
  lines: SVGLineElement[]
  head: SVGPathElement
  letter: SVGTextElement
}

/** Arrows along the axes of the model at a hardpoint, by which it is dragged along one of them. */
export class AxisArrows {
  readonly element = svg('svg', { class: 'guide handles', 'aria-hidden': 'true' })
  #arrows: Arrow[]

  constructor(
    private readonly view: View,
    readonly axes: readonly Axis[],
    onGrab: (event: PointerEvent, axis: Axis, held: Element) => void,
    { onpointermove, onpointerup, onpointercancel }: Dragging,
  ) {
    this.#arrows = axes.map((axis) => {
      const lines = ['reach', ''].map((name) => svg('line', { class: name }))
      const [head, letter] = [svg('path'), svg('text')]
      letter.textContent = axis
      const element = svg('g', { class: `arrow axis-${axis}`, 'data-testid': `arrow-${axis}` }, ...lines, head, letter)
      element.addEventListener('pointerdown', (event) => onGrab(event, axis, element))
      element.addEventListener('pointermove', onpointermove)
      element.addEventListener('pointerup', onpointerup)
      element.addEventListener('pointercancel', onpointercancel)
      return { axis, element, lines, head, letter }
    })
    this.element.append(...this.#arrows.map(({ element }) => element))
  }

  /** Draws them at a place of the world; `turn` rotates directions of the design configuration into the world. */
  draw(at: Vector3, turn: Quaternion): void {
    const { x, y } = this.view.project(at)
    const [right, up] = [0, 1].map((k) => new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, k))
    for (const { axis, element, lines, head, letter } of this.#arrows) {
      const along = new Vector3().setComponent(AXES.indexOf(axis), 1).applyQuaternion(turn)
      const [dx, dy] = [along.dot(right), -along.dot(up)]
      const seen = Math.hypot(dx, dy)
      element.style.display = seen < END_ON ? 'none' : ''
      if (seen < END_ON) continue
      const [ux, uy] = [dx / seen, dy / seen]
      const tip = ARROW.from + ARROW.least + ARROW.full * seen
      for (const line of lines) {
        line.setAttribute('x1', String(x + ARROW.from * ux))
        line.setAttribute('y1', String(y + ARROW.from * uy))
        line.setAttribute('x2', String(x + (tip - ARROW.head / 2) * ux))
        line.setAttribute('y2', String(y + (tip - ARROW.head / 2) * uy))
      }
      const corner = (ahead: number, aside: number) =>
        `${(x + (tip + ahead) * ux - aside * uy).toFixed(1)} ${(y + (tip + ahead) * uy + aside * ux).toFixed(1)}`
      head.setAttribute('d', `M${corner(0, 0)}L${corner(-ARROW.head, 4)}L${corner(-ARROW.head, -4)}Z`)
      letter.setAttribute('x', String(x + (tip + 8) * ux))
      letter.setAttribute('y', String(y + (tip + 8) * uy))
    }
  }
}
