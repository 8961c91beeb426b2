import { el } from '../dom'
import type { Table } from '../payload'
import { ORIGINAL, type State } from '../state'
import { noteAndRows, originHeading } from './checks'
import { whileSeen } from './tabs'

/** Heading of the column that a table of several cases has. */
const CASE = 'case'

/** True for a table of several cases, which a page opens on. */
export function hasCases({ header }: Table): boolean {
  return header.includes(CASE)
}

/**
 * Metrics with their most influential variables, of all cases where they are known. Those of a changed design are known
 * of the case that is shown; the others are those of the original.
 */
export function metrics(state: State): HTMLElement {
  const heading = originHeading(state)
  const element = el('section', { class: 'checks metrics', 'data-testid': 'metrics', 'aria-label': 'Metrics' }, heading)
  let shown: Table | null | undefined
  const render = () => {
    const { report, sensitivityReport } = state
    const { metrics: all } = report
    const { metrics: now } = sensitivityReport
    if (now === shown) return
    shown = now
    const isOfAll = all !== null && hasCases(all) && sensitivityReport !== report
    element.replaceChildren(
      heading,
      ...(isOfAll && now ? [el('h3', {}, `Case ${state.case ?? ''}`)] : []),
      ...(now ? noteAndRows(now) : []),
      ...(isOfAll ? otherCases(all, state.case) : []),
    )
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  render()
  return element
}

/** Rows of the cases that are not shown, which are those of the original design. */
function otherCases(all: Table, shown: string | undefined): HTMLElement[] {
  const column = all.header.indexOf(CASE)
  const rows = all.rows.filter((row) => row[column] !== shown)
  if (rows.length === 0) return []
  return [el('p', { class: 'of-design', 'data-testid': 'other-cases' }, ORIGINAL), ...noteAndRows({ ...all, rows })]
}
