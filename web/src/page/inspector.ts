import './measuring.css'
import { Vector3 } from 'three'
import { fromRadians } from '../amount'
import { valueAt } from '../curve'
import { el } from '../dom'
import { figure, number, pretty } from '../format'
import { rounded } from '../rounding'
import type { Part } from '../scene/drawable'
import type { View } from '../scene/view'
import type { State } from '../state'

/** With more points than this only neighbours are measured. */
const ALL_PAIRS = 4
/** Corners of the view, in the order of preference. */
interface Corner {
  isRight: boolean
  isLow: boolean
}
const CORNERS: readonly Corner[] = [false, true].flatMap((isLow) =>
  [false, true].map((isRight) => ({ isRight, isLow })),
)
/** Distance from the edges of the view, and from its top below the buttons, px. */
const EDGE = 10
const HEAD = 44
/** Digits of a coordinate. */
const DIGITS = 5

/** Properties of the selected body or joint at the moment shown: coordinates, lengths, angles, joints, values. */
export class Inspector {
  readonly element = el('section', {
    class: 'inspector',
    hidden: true,
    'aria-label': 'Selection',
    'data-testid': 'inspector',
  })
  #body = el('div')
  #title = el('h2')
  #shown?: Part

  constructor(
    private readonly view: View,
    private readonly state: State,
  ) {
    const close = el(
      'button',
      {
        type: 'button',
        class: 'icon',
        'aria-label': 'Close the inspector',
        onclick: () => state.choose({ selected: undefined }),
      },
      '×',
    )
    this.element.append(el('div', { class: 'head' }, this.#title, close), this.#body)
    view.onDrawn(() => this.#show())
  }

  #show(): void {
    const { selected } = this.state.choice
    this.element.hidden = !selected
    if (!selected) return ((this.#shown = undefined), undefined)
    this.#title.textContent = this.#title.title = selected.name
    this.#fill(el('div', {}, el('p', { class: 'muted' }, selected.about), ...this.#facts(selected)))
    if (selected === this.#shown) return
    this.#shown = selected
    this.#dock(selected)
  }

  /** Moves it into the corner of the view where it hides least of the motion and of the selection. */
  #dock(selected: Part): void {
    const { clientWidth: width, clientHeight: height } = this.view.element
    const { offsetWidth: wide, offsetHeight: tall } = this.element
    const moved = this.view.mechanism.sweep.map((place) => this.view.project(place))
    const chosen = this.#places(selected).map((place) => this.view.project(place))
    const hidden = ({ isRight, isLow }: Corner) => {
      const covers = ({ x, y }: { x: number; y: number }) =>
        (isRight ? x > width - wide - EDGE : x < wide + EDGE) && (isLow ? y > height - tall - EDGE : y < tall + HEAD)
      const share = (places: { x: number; y: number }[]) => places.filter(covers).length / Math.max(places.length, 1)
      return share(moved) + 2 * share(chosen)
    }
    const { isRight, isLow } = CORNERS.reduce((a, b) => (hidden(b) < hidden(a) ? b : a))
    this.element.classList.toggle('right', isRight)
    this.element.classList.toggle('low', isLow)
  }

  /** Shows facts, if they are others: a link that is being pressed stays, and so does the focus. */
  #fill(facts: HTMLElement): void {
    if (facts.textContent === this.#body.textContent) return
    const former = this.#body.querySelector<HTMLElement>(':focus')?.dataset.part
    this.#body.replaceChildren(...facts.childNodes)
    if (former) this.#body.querySelector<HTMLElement>(`[data-part="${CSS.escape(former)}"]`)?.focus()
  }

  #places(part: Part): Vector3[] {
    const { mechanism } = this.view
    const { step } = this.state
    const joint = part.kind === 'joint' ? mechanism.report.joints[part.index] : undefined
    if (joint) return [mechanism.worldAt(joint.body_i, new Vector3(...joint.at_i), step)]
    if (part.kind !== 'body') return []
    return mechanism.shapePoints(part.index).map((point) => mechanism.worldAt(part.index, point, step))
  }

  #facts(part: Part): HTMLElement[] {
    switch (part.kind) {
      case 'body':
        return this.#bodyFacts(part.index)
      case 'joint':
        return this.#jointFacts(part.index)
      case 'wheel':
      case 'coupler':
      case 'driver':
      case 'distance':
      case 'load':
      case 'mark':
        return this.#values(part.name)
      case 'shape':
        return this.#shapeFacts(part.index)
    }
  }

  #bodyFacts(body: number): HTMLElement[] {
    const { mechanism } = this.view
    const { step } = this.state
    const { length } = this.state.report.units
    const track = mechanism.report.bodies[body]
    const named = track.skeleton.flatMap((point, k) => {
      const name = track.labels[k]?.split(', ')[0]
      return name ? [{ name, at: mechanism.worldAt(body, new Vector3(...point), step) }] : []
    })
    const distinct = named.filter(({ at }, k) => named.findIndex((other) => mechanism.same(other.at, at)) === k)
    const pairs = distinct.flatMap((a, k) =>
      distinct.slice(k + 1).flatMap((b, near) => (distinct.length <= ALL_PAIRS || near === 0 ? [[a, b]] : [])),
    )
    const joints = mechanism.jointsOf(body)
    return [
      ...section(`Points, ${pretty(length)}`, coordinateTable(distinct)),
      ...(pairs.length > 0
        ? section(
            'Lengths',
            table(pairs.map(([a, b]) => [`${a.name} – ${b.name}`, figure(a.at.distanceTo(b.at), length)])),
          )
        : []),
      ...(body > 0 ? section('Rotation since the start', el('p', {}, this.#rotation(body))) : []),
      ...(joints.length > 0
        ? section(
            'Joints',
            ...joints.map(({ joint, index }) => {
              const other = mechanism.report.bodies[joint.body_i === body ? joint.body_j : joint.body_i]
              return this.#link({ kind: 'joint', index, name: joint.name, about: joint.kind }, ` to ${other.name}`)
            }),
          )
        : []),
    ]
  }

  #jointFacts(index: number): HTMLElement[] {
    const { mechanism } = this.view
    const { step } = this.state
    const { report } = mechanism
    const { name, body_i, body_j, at_i, at_j, axis, cut } = report.joints[index]
    const [a, b] = [
      mechanism.worldAt(body_i, new Vector3(...at_i), step),
      mechanism.worldAt(body_j, new Vector3(...at_j), step),
    ]
    const along = axis && mechanism.alongAt(body_i, new Vector3(...axis), step)
    const places = mechanism.same(a, b)
      ? [{ name: 'location', at: a }]
      : [
          { name: `on ${report.bodies[body_i].name}`, at: a },
          { name: `on ${report.bodies[body_j].name}`, at: b },
        ]
    const { length } = this.state.report.units
    return [
      ...section(
        'Bodies',
        ...[body_i, body_j].map((body) =>
          this.#link({ kind: 'body', index: body, name: report.bodies[body].name, about: 'body' }),
        ),
      ),
      ...section(
        `Location, ${pretty(length)}`,
        coordinateTable([...places, ...(along ? [{ name: 'axis', at: along }] : [])]),
      ),
      ...(places.length > 1 ? section('Distance', el('p', {}, figure(a.distanceTo(b), length))) : []),
      ...this.#values(name),
      el('p', { class: 'muted' }, cut ? 'Closes a loop (cut joint).' : 'Part of the spanning tree.'),
    ]
  }

  /** Distances of a shape from those that are the nearest of a clearance at some moment. */
  #shapeFacts(index: number): HTMLElement[] {
    const { report } = this.view.mechanism
    const { length } = report.units
    const own = (report.clearance?.pairs ?? []).filter(({ shapes }) => shapes.includes(index))
    const rows = own.map(({ shapes: [a, b], distance }) => {
      const other = report.clearance!.shapes[a === index ? b : a]
      return [other.name, figure(valueAt(distance, this.state.step), length)]
    })
    return rows.length > 0 ? section('Distances', table(rows)) : []
  }

  /** Values of the quantities that are named after an entry. */
  #values(name: string): HTMLElement[] {
    const { quantities } = this.state.report
    const own = quantities.filter(
      (one) => one.name === name || (/^[ .]/.test(one.name.slice(name.length)) && one.name.startsWith(name)),
    )
    const rows = own.map((quantity) => {
      const value = valueAt(this.state.curve(quantity.index, 0), this.state.step)
      return [quantity.name === name ? 'value' : quantity.name.slice(name.length + 1), figure(value, quantity.units[0])]
    })
    return rows.length > 0 ? section('Now', table(rows)) : []
  }

  #rotation(body: number): string {
    const { mechanism } = this.view
    const [start, now] = [0, this.state.step].map((step) => mechanism.poseAt(body, step)?.turn)
    if (!start || !now) return '–'
    const by = now.clone().multiply(start.clone().invert())
    const turn = 2 * Math.acos(Math.min(1, Math.abs(by.w)))
    const { angle } = this.state.report.units
    return figure(rounded(fromRadians(turn, angle)), angle)
  }

  #link(part: Part, after = ''): HTMLElement {
    const select = () => this.state.choose({ selected: part })
    const button = el(
      'button',
      { type: 'button', class: 'plain link', 'data-part': `${part.kind} ${part.index}`, onclick: select },
      part.name,
    )
    return el(
      'div',
      {},
      button,
      el('span', { class: 'muted' }, `${part.kind === 'joint' ? ` ${part.about}` : ''}${after}`),
    )
  }
}

function section(title: string, ...content: HTMLElement[]): HTMLElement[] {
  return [el('h3', {}, title), ...content]
}

function coordinateTable(rows: { name: string; at: Vector3 }[]): HTMLElement {
  const size = Math.max(...rows.flatMap(({ at }) => at.toArray().map(Math.abs)))
  return table(
    rows.map(({ name, at }) => [name, ...at.toArray().map((x) => number(rounded(x, size), DIGITS))]),
    ['', 'x', 'y', 'z'],
  )
}

function table(rows: string[][], header?: string[]): HTMLElement {
  return el(
    'table',
    {},
    header &&
      el(
        'thead',
        {},
        el('tr', {}, ...header.map((cell) => el(cell ? 'th' : 'td', { scope: cell ? 'col' : undefined }, cell))),
      ),
    el(
      'tbody',
      {},
      ...rows.map(([name, ...cells]) =>
        el('tr', {}, el('th', { scope: 'row', title: name }, name), ...cells.map((cell) => el('td', {}, cell))),
      ),
    ),
  )
}
