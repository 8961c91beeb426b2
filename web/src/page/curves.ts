import { el } from '../dom'
import { effects } from '../effect'
import { groups } from '../report'
import type { State } from '../state'
import { Zoom } from '../zoom'
import { Figure, type FigureKind } from './figure'

/** Curves one below the other: the selected quantity, and more that can be added and taken away. */
export class Curves {
  readonly element: HTMLElement
  readonly figures: Figure[] = []
  #list = el('div', { class: 'figures' })
  #made = 0
  /** Visible part of the time, in all figures. */
  #time = new Zoom()

  /** `tool` makes the controls of a figure, as soon as it has contents. */
  constructor(
    private readonly state: State,
    private readonly tool?: (figure: Figure) => HTMLElement | undefined,
  ) {
    this.element = el('section', { class: 'curves', 'aria-label': 'Curves', 'data-testid': 'curves' }, this.#list)
    this.#add('value')
    const { quantity } = state.choice
    if (effects(state.report, quantity, 0).length > 0) this.#add('sensitivity')
    else if (state.report.quantities.length > 1) this.#add('value', this.#unseen())
    state.onChoice(() => this.#show())
    // uPlot measures its place, so it has to be in the page first.
    queueMicrotask(() => this.#show())
  }

  #add(shown: FigureKind, quantity?: number): Figure {
    const number = this.#made++
    const figure = new Figure(
      this.state,
      { quantity, shown, testId: `plot-${number}`, leads: number === 0 },
      this.#time,
      { onRemove: (gone) => this.#remove(gone), onAdd: () => this.#addNext(), tool: this.tool },
    )
    this.figures.push(figure)
    this.#list.append(figure.plot.element)
    return figure
  }

  #addNext(): void {
    const figure = this.#add('value', this.#unseen())
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
    const seen = this.figures.map(({ subject }) => subject.quantity)
    const all = groups(this.state.report).flatMap(([, members]) => members)
    return (all.find(({ index }) => !seen.includes(index)) ?? all[0]).index
  }

  #show(): void {
    for (const figure of this.figures) figure.show()
  }
}
