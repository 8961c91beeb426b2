import './influence.css'
import { el, keepFocus, onSchemeChange, prose } from '../dom'
import { figure } from '../format'
import { derivativeUnit, orderedName, ranking, type Variable } from '../report'
import type { State } from '../state'
import { originHeading } from '../page/checks'
import { whileSeen } from '../page/tabs'
import { badge } from '../variables'

/** Height of a row, px; the style sheet holds rows to it. */
const ROW = 30
/** Rows beyond the window on either side, so that a fast scroll shows none empty. */
const SPARE = 6
/** Before the window is measured. */
const FIRST_ROWS = 20

/** A row: a variable with its rank among those of its unit, or one that cannot be followed. */
interface Ranking {
  variable: Variable
  rank?: number
  peak: number
  share: number
  unit: string
}

/** Most influential variables of the chosen quantity, largest first within each unit; only visible rows are made. */
export function rankingTable(state: State): HTMLElement {
  const { report, choice } = state
  const heading = el('h2')
  const body = el('tbody')
  const filter = el('input', {
    type: 'search',
    placeholder: 'names',
    'aria-label': 'filter variables',
    oninput: () => show(),
  })
  const [above, below] = [el('div'), el('div')]
  let rows: Ranking[] = []
  let range = [0, 0]
  /** Key of the shown rows. */
  let shown = ''
  let shownReport = state.sensitivityReport
  /** Scroll position and height of the window, px. */
  let top = 0
  let height = FIRST_ROWS * ROW
  let frame = 0

  const show = () => {
    const key = [choice.quantity, choice.order, choice.variable, filter.value].join(' ')
    if (key === shown && shownReport === state.sensitivityReport) return
    ;[shown, shownReport] = [key, state.sensitivityReport]
    const quantity = report.quantities[choice.quantity]
    heading.textContent = quantity ? `Sensitivities of ${orderedName(quantity, choice.order)}` : ''
    const words = filter.value.toLowerCase()
    rows = ranked(state).filter(({ variable }) => variable.name.toLowerCase().includes(words))
    range = [0, 0]
    place()
  }
  /** Makes the rows that a scroll brings into sight. */
  const place = () => {
    frame = 0
    const printing = document.documentElement.classList.contains('printing')
    const first = printing ? 0 : Math.max(0, Math.min(Math.floor(top / ROW), rows.length - 1) - SPARE)
    const last = printing ? rows.length : Math.min(rows.length, Math.ceil((top + height) / ROW) + SPARE)
    if (range[0] === first && range[1] === last) return
    range = [first, last]
    above.style.height = `${first * ROW}px`
    below.style.height = `${(rows.length - last) * ROW}px`
    keepFocus(body, () => body.replaceChildren(...rows.slice(first, last).map((row) => line(state, row))))
  }
  const scroll = el(
    'div',
    {
      class: 'scroll',
      tabindex: 0,
      role: 'region',
      'aria-label': 'variables by influence',
      onscroll: () => {
        top = scroll.scrollTop
        frame ||= requestAnimationFrame(place)
      },
    },
    above,
    el('table', {}, body),
    below,
  )
  new ResizeObserver(([{ contentRect }]) => {
    height = contentRect.height
    place()
  }).observe(scroll)
  show()
  const element = el(
    'section',
    { class: 'ranking', 'data-testid': 'ranking' },
    heading,
    originHeading(state),
    el('p', { class: 'lead' }, 'Largest magnitude over time; bars compare variables of the same unit.'),
    report.variables.length > FIRST_ROWS && el('label', { class: 'field' }, el('span', {}, 'Filter'), filter),
    scroll,
  )
  onSchemeChange(place, state.ended)
  whileSeen(element, (listener) => state.onChoice(listener), show, state.ended)
  return element
}

/** Within each unit the largest first; then those that cannot be followed. */
function ranked({ sensitivityReport: report, choice }: State): Ranking[] {
  const quantity = report.quantities[choice.quantity]
  if (!quantity) return []
  const followed = [...ranking(report, quantity, choice.order)].flatMap(([unit, peers]) =>
    peers.map(
      ({ variable, peak, share }, k): Ranking => ({
        variable,
        rank: k + 1,
        peak,
        share,
        unit: derivativeUnit(quantity, choice.order, { unit }),
      }),
    ),
  )
  const stuck = report.variables.filter(({ admissibility }) => admissibility === 'cannot_follow')
  return [...followed, ...stuck.map((variable): Ranking => ({ variable, peak: NaN, share: 0, unit: '' }))]
}

function line(state: State, { variable, rank, peak, share, unit }: Ranking): HTMLElement {
  const name = el('button', { type: 'button', class: 'plain', name: variable.name }, variable.name)
  const cells = rank
    ? [
        el('td', { class: 'bars' }, el('span', { class: 'share', style: `--share: ${share}` })),
        el('td', { class: 'figure' }, share > 0 ? figure(peak, unit) : '≈ 0'),
      ]
    : [el('td', { class: 'why', colspan: 2, title: variable.note }, ...prose(variable.note))]
  return el(
    'tr',
    {
      class: `${rank === 1 || !rank ? 'first' : ''} ${variable.admissibility}`,
      'aria-current': String(variable.index === state.choice.variable),
      onclick: () => state.choose({ variable: variable.index }),
    },
    el('td', { class: 'rank' }, rank ? String(rank) : '–'),
    el('th', { scope: 'row', title: variable.name }, name, badge(variable)),
    ...cells,
  )
}
