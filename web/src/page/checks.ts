import { css, el, onSchemeChange, prose } from '../dom'
import { Plot } from '../plot'
import type { Table } from '../payload'
import type { State } from '../state'

/** Tables up to this long are open from the start. */
const SHORT = 12

/**
 * Checks of the run: status, figures of the solver, notes, margin from singular positions, and facts about the model.
 */
export function checks(state: State): HTMLElement {
  const { status, summary, notes, checks, description, generator, file } = state.report
  return el(
    'section',
    { class: 'checks', 'data-testid': 'checks', 'aria-label': 'Checks' },
    description !== '' && el('p', { class: 'lead' }, description),
    el('p', { class: 'status', 'data-testid': 'status' }, ...prose(status.message)),
    el('p', { class: 'origin' }, el('code', {}, file), ` · ${generator}`),
    el(
      'dl',
      { class: 'summary', 'data-testid': 'summary' },
      ...summary.map(({ label, value }) => el('div', {}, el('dt', {}, label), el('dd', {}, value))),
    ),
    notes.length > 0 &&
      el('ul', { class: 'notes', 'data-testid': 'notes' }, ...notes.map((note) => el('li', {}, ...prose(note)))),
    state.report.margin && marginPlot(state),
    ...checks.map(factTable),
  )
}

function marginPlot(state: State): HTMLElement {
  const plot = new Plot(state, 'plot-margin')
  const show = () => {
    const { margin } = state.report
    if (!margin) return
    const lines = [{ label: state.isCompared ? 'original' : 'margin', color: css('--trace'), curve: margin.curve }]
    const present = state.present?.margin
    if (present) {
      Object.assign(lines[0], { color: css('--former'), dash: [6, 4] })
      lines.unshift({ label: 'current design', color: css('--trace'), curve: present })
    }
    plot.show({ title: 'distance from a singular position', unit: '', lines, caption: margin.note, logarithmic: true })
  }
  state.onChoice(show)
  onSchemeChange(show)
  queueMicrotask(show)
  return plot.element
}

/** Facts about the model in rows; long ones are opened by a press. */
export function factTable(table: Table): HTMLElement {
  return el(
    'details',
    { open: table.rows.length <= SHORT },
    el('summary', {}, table.title, el('span', { class: 'count' }, String(table.rows.length))),
    table.note !== '' && el('p', { class: 'lead' }, ...prose(table.note)),
    el(
      'div',
      { class: 'scroll', tabindex: 0 },
      el(
        'table',
        {},
        el('thead', {}, el('tr', {}, ...table.header.map((cell) => el('th', { scope: 'col' }, cell)))),
        el('tbody', {}, ...table.rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, ...prose(cell)))))),
      ),
    ),
  )
}
