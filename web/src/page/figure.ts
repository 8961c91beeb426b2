import { el, onSchemeChange } from '../dom'
import { Plot } from '../plot'
import { groups, ORDERS, type Order } from '../report'
import type { State } from '../state'
import type { Zoom } from '../zoom'
import { sensitivityContent, valueContent, type Subject } from './contents'
import { pointing } from './pointing'

export type FigureKind = 'value' | 'sensitivity'

/** Options of a figure. */
interface FigureOptions {
  /** Fixed quantity; the selected one where there is none. */
  quantity?: number
  shown: FigureKind
  testId: string
  /** The first figure controls the selection; others may follow it, and can be removed. */
  leads: boolean
}

/** A plot with selectors of its quantity, its abscissa, and values or sensitivities. */
export class Figure {
  readonly plot: Plot
  #quantity?: number
  #order: Order = 0
  #over?: number
  #shown: FigureKind

  constructor(
    private readonly state: State,
    private readonly options: FigureOptions,
    time: Zoom,
    {
      onRemove,
      onAdd,
      tool,
    }: { onRemove: (figure: Figure) => void; onAdd: () => void; tool?: (figure: Figure) => HTMLElement | undefined },
  ) {
    this.#quantity = options.quantity
    this.#shown = options.shown
    const { report } = state
    const first = options.leads ? [] : [el('option', { value: '' }, 'selected quantity')]
    const quantity = select('quantity', 'Quantity', () => this.#pick(quantity.value), ...first, ...offered(state))
    const over = select(
      'over',
      'Over',
      () => this.#choose({ over: over.value === '' ? undefined : Number(over.value) }),
      el('option', { value: '' }, 'over time'),
      ...groups(report).flatMap(([, members]) =>
        members.map(({ index, name }) => el('option', { value: index }, `over ${name}`)),
      ),
    )
    const order = select(
      'order',
      'Order',
      () => this.#choose({ order: Number(order.value) as Order }),
      ...ORDERS.map((name, k) => el('option', { value: k }, name)),
    )
    const able = report.variables.some(({ sensitivities }) => sensitivities.size > 0)
    const shown = el(
      'button',
      {
        type: 'button',
        class: 'switch',
        'data-testid': 'shown',
        title: 'Show the sensitivities to the design variables',
        onclick: () => {
          this.#shown = this.#shown === 'value' ? 'sensitivity' : 'value'
          this.show()
        },
      },
      'Sensitivity',
    )
    const last = options.leads
      ? icon('add-curve', 'Add a plot', '+', onAdd)
      : icon('remove', 'Remove plot', '×', () => onRemove(this))
    const controls = el('div', { class: 'controls' }, quantity, over, order, able ? shown : undefined, last)
    this.plot = new Plot(state, options.testId, [controls], time)
    this.plot.element.classList.toggle('leads', options.leads)
    pointing(state, this.plot.element, () => this.subject.quantity)
    let extra: HTMLElement | undefined
    this.show = () => {
      const subject = this.subject
      // The studio adds its parts when it has loaded.
      if (!extra && (extra = tool?.(this))) controls.lastElementChild!.before(extra)
      quantity.value = this.#follows && !options.leads ? '' : String(subject.quantity)
      over.value = subject.over === undefined ? '' : String(subject.over)
      order.value = String(subject.order)
      // The field beside it names the quantity already.
      this.plot.element.classList.toggle('untitled', !this.#follows || options.leads ? this.#shown === 'value' : false)
      shown.setAttribute('aria-pressed', String(this.#shown === 'sensitivity'))
      this.plot.show(this.#shown === 'value' ? valueContent(state, subject) : sensitivityContent(state, subject))
    }
    onSchemeChange(() => this.show(), state.ended)
  }

  readonly show: () => void

  /** Subject of the figure. */
  get subject(): Subject {
    const { quantity, order, over } = this.state.choice
    return this.#follows
      ? { quantity, order, over }
      : { quantity: this.#quantity!, order: this.#order, over: this.#over }
  }

  get #follows(): boolean {
    return this.#quantity === undefined
  }

  #pick(value: string): void {
    if (this.options.leads) return this.state.choose({ quantity: Number(value) })
    const { order, over } = this.subject
    this.#quantity = value === '' ? undefined : Number(value)
    this.#order = order
    this.#over = over
    this.show()
  }

  #choose(part: { order?: Order; over?: number }): void {
    if (this.#follows) return this.state.choose(part)
    if ('order' in part) this.#order = part.order!
    else this.#over = part.over
    this.show()
  }
}

function select(testId: string, label: string, onchange: () => void, ...options: HTMLElement[]): HTMLSelectElement {
  return el('select', { 'data-testid': testId, 'aria-label': label, title: label, onchange }, ...options)
}

function offered(state: State): HTMLElement[] {
  const plural = (group: string) => (group === 'body' ? 'bodies' : `${group}s`)
  return groups(state.report).map(([name, members]) =>
    el('optgroup', { label: plural(name) }, ...members.map(({ index, name }) => el('option', { value: index }, name))),
  )
}

function icon(testId: string, title: string, sign: string, onclick: () => void): HTMLElement {
  return el(
    'button',
    { type: 'button', class: 'icon', 'data-testid': testId, title, 'aria-label': title, onclick },
    sign,
  )
}
