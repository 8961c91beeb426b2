import { el, setText } from '../dom'
import { number, titled } from '../format'
import { abscissaOf, type Content, drawnLines } from '../content'
import type { Curve } from '../curve'
import { extent, linearAxis } from '../export/axis'

/** Approximate number of rows at first. */
const ROWS = 6

/** Values of all curves of a plot at chosen abscissas. */
export class ValueTable {
  readonly element: HTMLElement
  #field = el('input', {
    type: 'text',
    'data-testid': 'abscissas',
    'aria-label': 'abscissas of the table, separated by spaces',
    onchange: () => this.#change(),
  })
  #name = el('span')
  #head = el('thead')
  #body = el('tbody')
  #chosen?: number[]
  #shown?: { content: Content; times: Curve; time: string }

  constructor() {
    const label = el('label', { class: 'field' }, this.#name, this.#field)
    const table = el('table', { class: 'numbers' }, this.#head, this.#body)
    this.element = el('div', { class: 'value-table', hidden: true, 'data-testid': 'value-table' }, label, table)
  }

  /** The abscissas that the reader chose; undefined for round ones. */
  get abscissas(): number[] | undefined {
    return this.#chosen
  }

  set abscissas(chosen: number[] | undefined) {
    this.#chosen = chosen
    if (this.#shown) this.show(this.#shown.content, this.#shown.times, this.#shown.time)
  }

  show(content: Content, times: Curve, time: string): void {
    this.#shown = { content, times, time }
    if (this.element.hidden) return
    const lines = drawnLines(content)
    const name = content.over ? titled(content.over.label, content.over.unit) : titled('time', time)
    const at = this.#chosen ?? this.#round(content.over?.curve ?? times)
    setText(this.#name, `Values at ${name}`)
    if (document.activeElement !== this.#field) this.#field.value = at.map((value) => number(value)).join('  ')
    const cell = (text: string) => el('td', { class: 'figure' }, text)
    const header = [name, ...lines.map(({ label }) => label)]
    this.#head.replaceChildren(el('tr', {}, ...header.map((text) => el('th', { scope: 'col' }, text))))
    this.#body.replaceChildren(
      ...at.map((x) => {
        const values = lines.map((line) => crossing(abscissaOf(line, content, times), line.curve, x))
        return el('tr', {}, el('th', { scope: 'row' }, number(x)), ...values.map((value) => cell(number(value, 4))))
      }),
    )
  }

  #round(curve: Curve): number[] {
    const [low, high] = extent([curve]) ?? [0, 0]
    return low < high ? linearAxis([low, high], 0, 1, ROWS).ticks.map(({ value }) => value) : [low]
  }

  #change(): void {
    const words = this.#field.value.split(/[\s;]+/).filter(Boolean)
    const numbers = words.map((word) => Number(word.replace('−', '-').replace(',', '.'))).filter(Number.isFinite)
    this.#field.blur()
    this.abscissas = numbers.length > 0 ? numbers : undefined
  }
}

/** The value of a curve where it first reaches an abscissa; NaN if it never does. */
export function crossing(xs: Curve, ys: Curve, x: number): number {
  const near = Math.max(1, Math.abs(x)) * NEAR
  for (let k = 0; k < xs.length; k++) if (Math.abs(xs[k] - x) <= near && !Number.isNaN(ys[k])) return ys[k]
  for (let k = 1; k < xs.length; k++) {
    if (!((xs[k - 1] - x) * (xs[k] - x) < 0)) continue
    const value = ys[k - 1] + ((ys[k] - ys[k - 1]) * (x - xs[k - 1])) / (xs[k] - xs[k - 1])
    if (!Number.isNaN(value)) return value
  }
  return NaN
}

/** Abscissas in single precision count as the same within this part. */
const NEAR = 1e-6
