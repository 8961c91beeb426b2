import { el } from '../dom'
import { number, pretty } from '../format'
import { noise, rounded } from '../rounding'
import type { State } from '../state'
import { whileSeen } from './tabs'

/** A column of the comparison. */
interface Column {
  name: string
  value: (index: number) => number | null
}

/** Values of the original, the present and all compared designs, side by side, with the change to the reference. */
export function comparison(state: State): HTMLElement {
  const { values } = state.report
  const [head, body] = [el('thead'), el('tbody')]
  const table = el('div', { class: 'scroll', tabindex: 0 }, el('table', {}, head, body))
  const lead = el('p', { class: 'lead' })
  const element = el('section', { class: 'checks', 'data-testid': 'comparison', 'aria-label': 'Compare' }, lead, table)
  const render = () => {
    const columns = columnsOf(state)
    const [reference] = columns
    const present = columns[1]
    lead.textContent = present
      ? `Values of the designs, and the change from ${reference.name} to ${present.name}.`
      : 'Change a variable or drag a point, or compare named designs (Designs ▾): their values are listed here.'
    const header = ['value', ...columns.map(({ name }) => name), ...(present ? ['change'] : []), 'unit']
    head.replaceChildren(el('tr', {}, ...header.map((text) => el('th', { scope: 'col' }, text))))
    body.replaceChildren(
      ...values.map(({ name, what, unit }, index) => {
        const found = columns.map(({ value }) => value(index))
        const [before, now] = found
        const cells = found.map(text)
        if (present) cells.push(before === null || now === null ? '–' : changeText(now - before, now))
        return el(
          'tr',
          {},
          el('th', { scope: 'row', title: what }, name),
          ...cells.map((cell) => el('td', { class: 'figure' }, cell)),
          el('td', { class: 'unit' }, pretty(unit) || '–'),
        )
      }),
    )
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  render()
  return element
}

/** The reference first, then the present design if it differs, then the others. */
function columnsOf(state: State): Column[] {
  const { report, former, designs, choice, isCompared } = state
  const original: Column = { name: 'original', value: (index) => report.values[index].value }
  const of = (k: number): Column => ({ name: designs[k].name, value: (index) => designs[k].values[index] ?? null })
  const present: Column = { name: 'current', value: (index) => state.value(index) }
  const reference = choice.compared !== undefined && former ? of(choice.compared) : original
  const others = (choice.overlays ?? []).filter((k) => designs[k] && k !== choice.compared).map(of)
  const last = reference === original || !state.changed ? [] : [original]
  return [reference, ...(isCompared ? [present] : []), ...others, ...last]
}

function text(value: number | null): string {
  return value === null ? '–' : number(rounded(value), 5)
}

function changeText(by: number, size: number): string {
  return Math.abs(by) <= noise(size) ? '0' : `${by > 0 ? '+' : ''}${number(by, 3)}`
}
