import { el } from '../dom'
import type { State } from '../state'
import { menu, type Item } from './menu'

/** What the bar offers beside the title. */
export interface Offers {
  find?: HTMLElement
  exports: () => Item[]
  help: () => void
}

/** Title and file, what is compared, search, export and help. */
export function bar(state: State, { find, exports, help }: Offers): HTMLElement {
  const { title, file } = state.report
  return el(
    'header',
    { class: 'bar' },
    el('h1', { 'data-testid': 'title', title }, title),
    el('span', { class: 'file muted' }, file),
    el('span', { class: 'space' }),
    find,
    comparison(state),
    menu('Export', 'export', exports),
    el('button', { type: 'button', class: 'help-button', 'aria-label': 'keys and lines', title: 'Keys and lines (?)', 'data-testid': 'help', onclick: help }, '?'),
  )
}

/** With which design the present one is compared, where there is a choice. */
function comparison(state: State): HTMLElement | undefined {
  const { designs } = state.report
  if (designs.length === 0) return undefined
  const select = el(
    'select',
    { 'data-testid': 'compare', onchange: () => state.choose({ compared: select.value === '' ? undefined : Number(select.value) }) },
    el('option', { value: '' }, 'as loaded'),
    ...designs.map(({ name }, index) => el('option', { value: index }, name)),
  )
  return el('label', { class: 'compare' }, el('span', { class: 'muted' }, 'Compare with'), select)
}
