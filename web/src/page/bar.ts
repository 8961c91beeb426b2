import { el } from '../dom'
import type { Design } from '../report'
import type { State } from '../state'
import { menu, type Item, type ItemRow } from './menu'

/** Controls of the bar next to the title. */
export interface Offers {
  find?: HTMLElement
  exports: () => (Item | ItemRow)[]
  help: () => void
}

/** Title and file, compared design, search, export and help. */
export function bar(state: State, { find, exports, help }: Offers): HTMLElement {
  const { title, file } = state.report
  const bar = el(
    'header',
    { class: 'topbar' },
    models(),
    el('h1', { 'data-testid': 'title', title }, title),
    el('span', { class: 'file muted' }, file),
    el('span', { class: 'space' }),
    find,
    comparison(state),
    menu('Export', 'export', exports),
    el(
      'button',
      {
        type: 'button',
        class: 'help-button',
        'aria-label': 'keys and lines',
        title: 'Keys and lines (?)',
        'data-testid': 'help',
        onclick: help,
      },
      '?',
    ),
  )
  // The drawer begins below the bar, which may have several rows.
  const observer = new ResizeObserver(() => {
    if (bar.isConnected) document.body.style.setProperty('--bar', `${bar.offsetHeight}px`)
  })
  observer.observe(bar)
  return bar
}

/** Link to the page of all models, of which this page is one. */
function models(): HTMLElement | undefined {
  const href = document.querySelector('link[rel=up]')?.getAttribute('href')
  return href ? el('a', { class: 'up', href, title: 'All models', 'data-testid': 'up' }, '‹ Models') : undefined
}

/** True for edges of bands of curves, which are drawn with them and compared with nothing. */
function isBand({ kind }: Design): boolean {
  return kind === 'band'
}

/** Selector of the design for comparison, if there is a choice. */
function comparison(state: State): HTMLElement | undefined {
  const { designs } = state.report
  if (designs.every(isBand)) return undefined
  const select = el(
    'select',
    {
      'data-testid': 'compare',
      onchange: () => state.choose({ compared: select.value === '' ? undefined : Number(select.value) }),
    },
    el('option', { value: '' }, 'original'),
    ...designs.flatMap((design, index) => (isBand(design) ? [] : [el('option', { value: index }, design.name)])),
  )
  return el('label', { class: 'compare' }, el('span', { class: 'muted' }, 'Compare with'), select)
}
