import { css, el, onSchemeChange, prose, setText } from '../dom'
import { Plot } from '../plot'
import type { Fact, StudyTables, Table } from '../payload'
import type { Report } from '../report'
import type { State } from '../state'
import { whileSeen } from './tabs'

/** Tables up to this long are open from the start. */
const SHORT = 12

/**
 * Checks of the run: status, figures of the solver, notes, margin from singular positions, and facts about the model.
 * They are those of the present design as soon as it is solved with its sensitivities; until then they have a heading
 * that names their design.
 */
export function checks(state: State): HTMLElement {
  const heading = originHeading(state)
  const facts = el('div')
  const margin = state.report.margin && marginPlot(state)
  const element = el(
    'section',
    { class: 'checks', 'data-testid': 'checks', 'aria-label': 'Checks' },
    heading,
    facts,
    margin?.element,
  )
  let shown: Report | undefined
  const render = () => {
    margin?.show()
    if (shown === state.sensitivityReport) return
    shown = state.sensitivityReport
    const open = new Set([...element.querySelectorAll('details[open] summary')].map(titleOf))
    const closed = new Set([...element.querySelectorAll('details:not([open]) summary')].map(titleOf))
    const tables = shown.checks.map(factTable)
    for (const table of tables) {
      const title = titleOf(table.querySelector('summary')!)
      if (open.has(title) || closed.has(title)) table.open = open.has(title)
    }
    element.replaceChildren(heading, facts, ...(margin ? [margin.element] : []), ...tables)
    facts.replaceChildren(...factsOf(shown))
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  // uPlot measures its place, so it has to be in the page first.
  queueMicrotask(render)
  return element
}

/** Result of the study of which this is the page; nothing of it changes with the design. */
export function studyTables(state: State, study: StudyTables): HTMLElement {
  const heading = el('p', { class: 'of-design', role: 'status' }, 'Result of the study, not of the present design')
  const sync = () => (heading.hidden = state.isRecorded)
  state.onChoice(sync)
  sync()
  return el(
    'section',
    { class: 'checks', 'data-testid': 'study', 'aria-label': study.title },
    heading,
    answerOf(study),
    ...study.tables.map(factTable),
  )
}

/** Lines that answer the question of a study. */
export function answerOf({ answer }: StudyTables): HTMLElement {
  const line = ({ label, value }: Fact) => el('div', {}, el('dt', {}, label), el('dd', {}, ...prose(value)))
  return el('dl', { class: 'answer', 'data-testid': 'answer' }, ...answer.map(line))
}

/** Heading over numbers of another design than the present one; hidden otherwise. */
export function originHeading(state: State): HTMLElement {
  const heading = el('p', { class: 'of-design', role: 'status', 'data-testid': 'of-design' })
  const sync = () => {
    heading.hidden = state.outdated === undefined
    setText(heading, state.outdated ?? '')
  }
  state.onChoice(sync)
  sync()
  return heading
}

function factsOf({ status, summary, notes, description, generator, file }: Report): Node[] {
  const nodes = [
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
  ]
  return nodes.filter((node) => node !== false)
}

function marginPlot(state: State): { element: HTMLElement; show: () => void } {
  const plot = new Plot(state, 'plot-margin')
  const show = () => {
    const { margin } = state.report
    if (!margin) return
    const lines = [{ label: state.isCompared ? 'original' : 'margin', color: css('--trace'), curve: margin.curve }]
    const present = state.present?.margin
    if (present) {
      Object.assign(lines[0], { color: css('--former'), dash: [6, 4] })
      lines.unshift({ label: 'current', color: css('--trace'), curve: present })
    }
    const { outdated, sensitivityReport } = state
    const note = sensitivityReport.margin?.note ?? ''
    const caption = outdated && note ? `${outdated}: ${note}` : note
    plot.show(() => ({ title: 'distance from a singular position', unit: '', lines, caption, logarithmic: true }))
  }
  onSchemeChange(show, state.ended)
  return { element: plot.element, show }
}

function titleOf(summary: Element): string {
  return summary.firstChild?.textContent ?? ''
}

/** Facts about the model in rows; long ones are opened by a press. */
export function factTable(table: Table): HTMLDetailsElement {
  return el(
    'details',
    { open: table.rows.length <= SHORT },
    el('summary', {}, table.title, el('span', { class: 'count' }, String(table.rows.length))),
    ...noteAndRows(table),
  )
}

/** Note of a table, if there is one, and its rows. */
export function noteAndRows({ note, header, rows }: Table): HTMLElement[] {
  const grid = el(
    'div',
    { class: 'scroll', tabindex: 0 },
    el(
      'table',
      {},
      el('thead', {}, el('tr', {}, ...header.map((cell) => el('th', { scope: 'col' }, cell)))),
      el('tbody', {}, ...rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, ...prose(cell)))))),
    ),
  )
  return note === '' ? [grid] : [el('p', { class: 'lead' }, ...prose(note)), grid]
}
