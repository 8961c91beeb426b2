import './measuring.css'
import type { Vector3 } from 'three'
import { fromRadians } from '../amount'
import { el, svg } from '../dom'
import { figure, number } from '../format'
import { rounded } from '../rounding'
import type { View } from '../scene/view'
import type { State } from '../state'

/** A hardpoint that can be measured from and to. */
interface Spot {
  name: string
  body: number
  point: number
  button: HTMLButtonElement
}

/** Steps of choosing: two points for a distance, a third for the angle at the second. */
const ORDER = ['from', 'to', 'and to'] as const

/** Measures the distance between two points, and the angle of three, at every moment and in every design. */
export class Measuring {
  readonly button = el(
    'button',
    {
      type: 'button',
      title: 'Distance of two points, angle of three (D)',
      'aria-pressed': 'false',
      'data-testid': 'measure',
      onclick: () => this.toggle(),
    },
    'measure',
  )
  /** Over the view. */
  readonly overlay = el('div', { class: 'grips', hidden: true })
  /** Docked below the view. */
  readonly pane = el('section', {
    class: 'measuring',
    hidden: true,
    'aria-label': 'Measuring',
    'data-testid': 'measuring',
  })
  #lines = svg('svg', { class: 'ruler', 'aria-hidden': 'true' })
  #result = el('output', { 'data-testid': 'measured' })
  #selects: HTMLSelectElement[]
  #spots: Spot[]
  #chosen: (Spot | undefined)[] = [undefined, undefined, undefined]

  constructor(
    private readonly view: View,
    private readonly state: State,
  ) {
    const found = new Map<string, Spot>()
    // Of the bodies that share a hardpoint the last, which moves.
    state.report.bodies.forEach(({ labels }, body) =>
      labels.forEach((label, point) => {
        const name = label.split(', ')[0]
        if (name) found.set(name, { name, body, point, button: this.#dot(name) })
      }),
    )
    this.#spots = [...found.values()]
    this.#selects = ORDER.map((step, k) =>
      el(
        'select',
        { 'aria-label': `measure ${step}`, 'data-testid': `measure-${k}`, onchange: () => this.#pick(k) },
        el('option', { value: '' }, k === 2 ? 'angle to…' : '–'),
        ...this.#spots.map(({ name }) => el('option', { value: name }, name)),
      ),
    )
    view.onDrawn(() => this.#show())
  }

  get on(): boolean {
    return !this.pane.hidden
  }

  toggle(): void {
    if (!this.pane.hasChildNodes()) this.#fill()
    this.pane.hidden = this.overlay.hidden = this.on
    this.button.setAttribute('aria-pressed', String(this.on))
    this.#show()
  }

  /** Adds a button and options for every point, which the page does without until it measures. */
  #fill(): void {
    this.overlay.append(this.#lines, ...this.#spots.map(({ button }) => button))
    this.pane.append(
      ...ORDER.flatMap((step, k) => [el('span', { class: 'muted' }, step), this.#selects[k]]),
      el('button', { type: 'button', onclick: () => this.#clear() }, 'Clear'),
      el('button', { type: 'button', title: 'Leave', onclick: () => this.toggle() }, 'Done'),
      this.#result,
    )
  }

  #dot(name: string): HTMLButtonElement {
    return el('button', {
      type: 'button',
      class: 'ruler-point',
      style: 'pointer-events: auto',
      title: name,
      // The selects are for the keyboard.
      tabindex: -1,
      'aria-label': `measure ${name}`,
      'data-testid': `spot-${name}`,
      onclick: (event: MouseEvent) => this.#add(event.detail > 0 ? this.#nearest(event) : name),
    })
  }

  /** Name of the point nearest to a click: their buttons may lie on each other. */
  #nearest({ clientX, clientY }: MouseEvent): string {
    const { left, top } = this.view.element.getBoundingClientRect()
    const far = (spot: Spot) => {
      const { x, y } = this.view.project(this.#place(spot))
      return Math.hypot(x - (clientX - left), y - (clientY - top))
    }
    return this.#spots.filter(({ button }) => !button.hidden).reduce((a, b) => (far(b) < far(a) ? b : a)).name
  }

  /** Adds a point; after three the next begins anew. */
  #add(name: string): void {
    const spot = this.#spots.find((spot) => spot.name === name)
    const free = this.#chosen.indexOf(undefined)
    if (this.#chosen.includes(spot)) return
    if (free < 0) this.#chosen = [spot, undefined, undefined]
    else this.#chosen[free] = spot
    this.#show()
  }

  #pick(k: number): void {
    this.#chosen[k] = this.#spots.find(({ name }) => name === this.#selects[k].value)
    this.#show()
  }

  #clear(): void {
    this.#chosen = [undefined, undefined, undefined]
    this.#show()
  }

  #place({ body, point }: Spot): Vector3 {
    return this.view.mechanism.skeletonAt(body, point, this.state.step)
  }

  #show(): void {
    if (!this.on) return
    for (const spot of this.#spots) {
      this.view.put(spot.button, this.#place(spot))
      spot.button.setAttribute('aria-pressed', String(this.#chosen.includes(spot)))
    }
    this.#selects.forEach((select, k) => (select.value = this.#chosen[k]?.name ?? ''))
    const places = this.#chosen.map((spot) => spot && this.#place(spot))
    const ends = places.filter((place) => place !== undefined)
    const screen = ends.map((place) => this.view.project(place))
    this.#lines.replaceChildren(
      ...screen.slice(1).map((b, k) => {
        const a = screen[k]
        return svg('line', { x1: a.x, y1: a.y, x2: b.x, y2: b.y })
      }),
    )
    this.#result.replaceChildren(...this.#words(places))
  }

  #words([a, b, c]: (Vector3 | undefined)[]): (Node | string)[] {
    const { length, angle } = this.state.report.units
    if (!a || !b) return ['Click two points for their distance, a third one for the angle at the second.']
    const by = b.clone().sub(a)
    const parts = ['x', 'y', 'z'].map((axis, k) => `Δ${axis} ${number(rounded(by.getComponent(k), by.length()))}`)
    const words: (Node | string)[] = [el('b', {}, figure(by.length(), length)), ` (${parts.join(', ')})`]
    if (!c) return words
    const turn = a.clone().sub(b).angleTo(c.clone().sub(b))
    return [...words, ', angle ', el('b', {}, figure(fromRadians(turn, angle), angle))]
  }
}
