import { el } from '../dom'
import { effects } from '../effect'
import { groups } from '../report'
import { abscissaNamed } from '../sheet'
import type { State } from '../state'
import { Zoom } from '../zoom'
import { Figure, type FigureKind, type FigureMemory } from './figure'

/** Curves one below the other: the selected quantity, its sensitivities, and the sheet of the mechanism. */
export class Curves {
  readonly element: HTMLElement
  readonly figures: Figure[] = []
  #list = el('div', { class: 'figures' })
  #made = 0
  /** Visible part of the time, in all figures. */
  #time = new Zoom()

  /** `tool` makes the controls of a figure, as soon as it has contents; `former` are the figures of the page before. */
  constructor(
    private readonly state: State,
    private readonly tool?: (figure: Figure) => HTMLElement | undefined,
    former?: readonly FigureMemory[],
  ) {
    const heading = el('h2', { class: 'hidden' }, 'Curves')
    const attributes = { class: 'curves', 'aria-label': 'Curves', 'data-testid': 'curves' }
    this.element = el('section', attributes, heading, this.#list)
    if (former && former.length > 0) for (const memory of former) this.#recall(memory)
    else this.#open()
    state.onChoice(() => this.#show())
    // uPlot measures its place, so it has to be in the page first.
    queueMicrotask(() => this.#show())
  }

  /** Choices of all figures. */
  get memory(): FigureMemory[] {
    return this.figures.map(({ memory }) => memory)
  }

  /** The leading figure with its sensitivities, then the rest of the sheet. */
  #open(): void {
    const { state } = this
    const [first, ...others] = state.sheet.plots
    this.#add('value', { also: first?.y.slice(1), path: first?.path })
    if (effects(state.report, state.choice.quantity, 0).length > 0) this.#add('sensitivity')
    for (const { y, over, path } of others) this.#add('value', { quantity: y[0], also: y.slice(1), over, path })
    if (this.figures.length < 2 && state.report.quantities.length > 1) this.#add('value', { quantity: this.#unseen() })
  }

  /** A figure of a former page, if its quantities are still there. */
  #recall(memory: FigureMemory): void {
    const { quantities } = this.state.report
    const find = (name: string | undefined) => quantities.find((one) => one.name === name)?.index
    const quantity = find(memory.quantity)
    if (memory.quantity !== undefined && quantity === undefined && this.figures.length > 0) return
    const also = memory.also.flatMap((name) => find(name) ?? [])
    const leads = this.figures.length === 0
    const options = {
      quantity: leads ? undefined : quantity,
      over: abscissaNamed(this.state.report, memory.over),
      also,
      path: memory.path,
    }
    this.#add(memory.kind, options).recall(memory)
  }

  #add(
    shown: FigureKind,
    options: { quantity?: number; over?: number; also?: readonly number[]; path?: boolean } = {},
  ): Figure {
    const number = this.#made++
    const figure = new Figure(
      this.state,
      { ...options, shown, testId: `plot-${number}`, leads: number === 0 },
      this.#time,
      { onRemove: (gone) => this.#remove(gone), onAdd: () => this.#addNext(), tool: this.tool },
    )
    this.figures.push(figure)
    this.#list.append(figure.plot.element)
    return figure
  }

  #addNext(): void {
    const figure = this.#add('value', { quantity: this.#unseen(), over: this.state.sheet.travel })
    figure.show()
    figure.plot.element.scrollIntoView({ block: 'nearest' })
    figure.plot.element.querySelector('select')?.focus()
  }

  #remove(figure: Figure): void {
    this.figures.splice(this.figures.indexOf(figure), 1)
    figure.plot.remove()
  }

  /** The first quantity that no figure shows yet. */
  #unseen(): number {
    const seen = this.figures.flatMap(({ subject: { quantity, also = [] } }) => [quantity, ...also])
    const all = groups(this.state.report).flatMap(([, members]) => members)
    return (all.find(({ index }) => !seen.includes(index)) ?? all[0]).index
  }

  #show(): void {
    for (const figure of this.figures) figure.show()
  }
}
