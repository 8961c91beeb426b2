import { el, setText } from '../dom'
import { figure } from '../format'
import type { Table } from '../payload'
import { rounded } from '../rounding'
import { ORIGINAL, type State } from '../state'
import { isStatic } from './cards'
import { noteAndRows } from './checks'
import { whileSeen } from './tabs'

/** Heading of the column that a table of several cases has. */
const CASE = 'case'
/** Columns that are known of a design as soon as it is solved; the others come with its sensitivities. */
const SOLVED = ['metric', CASE, 'value', 'positive']

/** True for a table of several cases, which a page opens on. */
export function hasCases({ header }: Table): boolean {
  return header.includes(CASE)
}

/**
 * Metrics with their most influential variables, of all cases where they are known. Those of a changed design are known
 * of the case that is shown; the others are those of the original. Values are those of the present design; until its
 * sensitivities are computed, the columns that come with them have the name of their design above them.
 */
export function metrics(state: State): HTMLElement {
  const element = el('section', { class: 'checks metrics', 'data-testid': 'metrics', 'aria-label': 'Metrics' })
  let shown = ''
  let update: (() => void) | undefined
  const render = () => {
    const { outdated, report, sensitivityReport } = state
    const { metrics: all } = report
    const { metrics: known } = sensitivityReport
    const key = JSON.stringify([outdated, known])
    if (key !== shown) {
      shown = key
      const now = known && outdated !== undefined ? ofCase(known, state.case) : known
      const isOfAll = all !== null && hasCases(all) && now !== all
      const isSolved = now && outdated !== undefined
      const table = isSolved ? solvedTable(state, now, outdated) : { rows: now ? noteAndRows(now) : [] }
      update = 'update' in table ? table.update : undefined
      element.replaceChildren(
        ...(isOfAll && now ? [el('h3', {}, `Case ${state.case ?? ''}`)] : []),
        ...table.rows,
        ...(isOfAll ? otherCases(all, state.case) : []),
      )
    }
    update?.()
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  render()
  return element
}

/** A table whose values follow the present design, and whose other columns belong to a design of that name. */
function solvedTable(state: State, { header, rows, ...table }: Table, design: string) {
  const isSolved = (k: number) => SOLVED.includes(header[k])
  const order = [...header.keys()].sort((a, b) => Number(isSolved(b)) - Number(isSolved(a)) || a - b)
  const inOrder = (row: readonly string[]) => order.map((k) => row[k])
  const elements = noteAndRows({ ...table, header: inOrder(header), rows: rows.map(inOrder) })
  const grid = elements.at(-1)!.querySelector('table')!
  const first = order.filter(isSolved).length
  const heading = { scope: 'colgroup', colspan: order.length - first, class: 'of-design', 'data-testid': 'of-design' }
  grid.tHead!.prepend(el('tr', {}, el('td', { colspan: first }), el('th', heading, design)))
  const { values } = state.report
  const column = order.findIndex((k) => header[k] === 'value')
  const update = () => {
    for (const [k, row] of rows.entries()) {
      const index = values.findIndex((value) => value.name === row[0] && !isStatic(value))
      const now = state.value(index)
      setText(grid.tBodies[0].rows[k].cells[column], now === null ? '–' : figure(rounded(now), values[index].unit))
    }
  }
  return { rows: elements, update }
}

/** Metrics of one case, if the table has several. */
function ofCase(table: Table, name: string | undefined): Table {
  if (!hasCases(table)) return table
  const column = table.header.indexOf(CASE)
  return { ...table, rows: table.rows.filter((row) => row[column] === name) }
}

/** Rows of the cases that are not shown, which are those of the original design. */
function otherCases(all: Table, shown: string | undefined): HTMLElement[] {
  const column = all.header.indexOf(CASE)
  const rows = all.rows.filter((row) => row[column] !== shown)
  if (rows.length === 0) return []
  return [el('p', { class: 'of-design', 'data-testid': 'other-cases' }, ORIGINAL), ...noteAndRows({ ...all, rows })]
}
