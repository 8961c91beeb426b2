import { el } from '../dom'
import type { Table } from '../payload'
import type { State } from '../state'
import { noteAndRows, originHeading } from './checks'
import { whileSeen } from './tabs'

/** True for a table of several cases, which a page opens on. */
export function hasCases({ header }: Table): boolean {
  return header.includes('case')
}

/** Metrics with their most influential variables: of all cases where they are known, else of the present design. */
export function metrics(state: State): HTMLElement {
  const heading = originHeading(state)
  const element = el('section', { class: 'checks metrics', 'data-testid': 'metrics', 'aria-label': 'Metrics' }, heading)
  let shown: Table | undefined
  const render = () => {
    const { report, sensitivityReport } = state
    const own = report.metrics
    const table = (own && hasCases(own) ? own : sensitivityReport.metrics) ?? own ?? undefined
    if (!table || table === shown) return
    shown = table
    heading.classList.toggle('hidden', hasCases(table))
    element.replaceChildren(heading, ...noteAndRows(table))
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  render()
  return element
}
