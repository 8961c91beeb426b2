import { breakable, el, keepFocus, prose } from './dom'
import { figure, number, pretty } from './format'
import { derivativeName, derivativeUnit, groups, orderedName, ORDERS, ranking, type Quantity, type Variable } from './report'
import type { State } from './state'
import { badge } from './variables'

/** Which variables matter for the chosen quantity, largest first within each unit. */
export function rankingTable(state: State): HTMLElement {
  const { report, choice } = state
  const heading = el('h2')
  const body = el('tbody')
  const show = () => {
    const quantity = report.quantities[choice.quantity]
    heading.textContent = `What moves ${orderedName(quantity, choice.order)}`
    body.replaceChildren()
    for (const [unit, peers] of ranking(report, quantity, choice.order)) {
      const symbol = derivativeUnit(quantity, choice.order, { unit })
      peers.forEach(({ variable, peak, share }, rank) => {
        const bar = el('td', { class: 'bars' }, el('span', { class: 'share', style: `--share: ${share}` }))
        const reading = el('td', { class: 'figure' }, share > 0 ? figure(peak, symbol) : '≈ 0')
        body.append(row(variable, rank + 1, bar, reading))
      })
    }
    for (const variable of report.variables.filter(({ admissibility }) => admissibility === 'cannot_follow')) {
      body.append(row(variable, undefined, el('td', { class: 'why', colspan: 2 }, ...prose(variable.note))))
    }
  }
  const row = (variable: Variable, rank: number | undefined, ...cells: HTMLElement[]) => {
    const name = el('button', { type: 'button', class: 'plain', name: variable.name }, variable.name)
    return el(
      'tr',
      {
        class: `${rank === 1 || !rank ? 'first' : ''} ${variable.admissibility}`,
        'aria-current': String(variable.index === choice.variable),
        onclick: () => state.choose({ variable: variable.index }),
      },
      el('td', { class: 'rank' }, rank ? String(rank) : '–'),
      el('th', { scope: 'row' }, name, badge(variable)),
      ...cells,
    )
  }
  state.onChoice(() => keepFocus(body, show))
  show()
  const head = el(
    'thead',
    {},
    el('tr', {}, el('th', {}), el('th', {}, 'variable'), el('th', { colspan: 2 }, 'largest magnitude over time')),
  )
  return el(
    'section',
    { class: 'ranking', 'data-testid': 'ranking' },
    heading,
    el('p', { class: 'lead' }, 'Bars compare variables of the same unit.'),
    el('div', { class: 'scroll', tabindex: 0 }, el('table', {}, head, body)),
  )
}

/** Every quantity of a group against every variable. */
export function heatMap(state: State): HTMLElement {
  const { report, choice } = state
  const offered = groups(report)
  const group = el(
    'select',
    { 'aria-label': 'quantities shown', onchange: () => show() },
    ...offered.map(([name]) => el('option', { value: name }, name)),
  )
  const table = el('table')
  const order = el('span', {})
  const show = () => {
    const quantities = offered.find(([name]) => name === group.value)?.[1] ?? []
    order.textContent = choice.order === 0 ? '' : ` (${ORDERS[choice.order]})`
    const head = el(
      'tr',
      {},
      el('th', {}),
      ...quantities.map((quantity) =>
        el(
          'th',
          { scope: 'col', 'aria-current': String(quantity.index === choice.quantity) },
          el('button', { type: 'button', class: 'plain', name: quantity.name, onclick: () => state.choose({ quantity: quantity.index }) }, ...breakable(quantity.name)),
        ),
      ),
    )
    table.replaceChildren(el('thead', {}, head), el('tbody', {}, ...heatRows(state, quantities)))
  }
  state.onChoice(() => keepFocus(table, show))
  show()
  const picker = offered.length > 1 ? el('label', { class: 'field' }, el('span', {}, 'Quantities'), group) : undefined
  return el(
    'section',
    { class: 'heat', 'data-testid': 'heat' },
    el('h2', {}, 'Sensitivity map', order),
    el('p', { class: 'lead' }, 'Largest magnitude over time; the darkest cell of a column is its largest among variables of one unit.'),
    picker,
    el('div', { class: 'scroll', tabindex: 0 }, table),
  )
}

function heatRows({ report, choice }: State, quantities: Quantity[]): HTMLElement[] {
  const ranks = quantities.map((quantity) => ranking(report, quantity, choice.order))
  const units = [...new Set(report.variables.map(({ unit }) => unit))]
  return units.flatMap((unit) => {
    const members = report.variables.filter((variable) => variable.unit === unit && variable.sensitivities.size > 0)
    return members.map((variable, row) => {
      const cells = quantities.map((quantity, column) => {
        const item = ranks[column].get(unit)?.find((item) => item.variable === variable)
        if (!item) return el('td', { class: 'none' })
        const symbol = derivativeUnit(quantity, choice.order, variable)
        const title = `${derivativeName(quantity, choice.order, variable)}: ${figure(item.peak, symbol)}`
        return el('td', { style: `--share: ${item.share}`, title }, item.share > 0 ? number(item.peak, 2) : '0')
      })
      const name = el('th', { scope: 'row' }, variable.name, el('span', { class: 'unit' }, `per ${pretty(unit) || 'unit'}`))
      return el('tr', { class: row === 0 ? 'first' : '' }, name, ...cells)
    })
  })
}
