import { atFixedAbscissa, slope, withGaps, type Curve } from './curve'
import { el, hue, HUES, css, onSchemeChange } from './dom'
import { figure, number, pretty } from './format'
import { Plot, type Content, type Line } from './plot'
import { derivativeName, derivativeUnit, groups, ORDERS, orderedName, ranking, type Margin, type Order } from './report'
import type { State } from './state'

/** How many sensitivities are drawn before the reader asks for all: one per colour. */
const FEW = HUES

/** The quantity, its sensitivities side by side, and the selected one against finite differences. */
export function plots(state: State): HTMLElement {
  const hasVariables = state.report.variables.length > 0
  const all = el('input', { type: 'checkbox', 'data-testid': 'all', onchange: () => state.choose({ all: all.checked }) })
  const toggle = el('label', { class: 'toggle' }, all, 'all variables')
  const value = new Plot(state, 'plot-value')
  const peers = new Plot(state, 'plot-peers', toggle)
  const check = new Plot(state, 'plot-check')
  const margin = state.report.margin && new Plot(state, 'plot-margin')
  // The legend keeps its height when the unit, and with it the number of lines, changes.
  peers.element.classList.toggle('many', state.report.variables.length > FEW / 2)
  const show = () => {
    value.show(over(state, valueContent(state)))
    if (margin) margin.show(marginContent(state.report.margin!))
    if (!hasVariables) return
    const content = peersContent(state)
    toggle.hidden = content.total <= FEW
    peers.show(over(state, content))
    check.show(over(state, checkContent(state)))
  }
  state.onChoice(show)
  onSchemeChange(show)
  const derivatives = hasVariables ? [peers.element, check.element] : []
  const column = el('div', { class: 'plots' }, chooser(state), value.element, ...derivatives, margin?.element)
  // uPlot measures its place, so it has to be in the page first.
  queueMicrotask(show)
  return column
}

function chooser(state: State): HTMLElement {
  const options = groups(state.report).map(([name, members]) =>
    el('optgroup', { label: plural(name) }, ...members.map(({ index, name }) => el('option', { value: index }, name))),
  )
  const quantity = el(
    'select',
    { 'data-testid': 'quantity', onchange: () => state.choose({ quantity: Number(quantity.value) }) },
    ...options,
  )
  const names = groups(state.report).flatMap(([, members]) => members.map(({ index, name }) => el('option', { value: index }, name)))
  const abscissa = el(
    'select',
    { 'data-testid': 'over', onchange: () => state.choose({ over: abscissa.value === '' ? undefined : Number(abscissa.value) }) },
    el('option', { value: '' }, 'time'),
    ...names,
  )
  const orders = ORDERS.map((name, index) => {
    const input = el('input', {
      type: 'radio',
      name: 'order',
      value: index,
      'data-testid': `order-${name}`,
      onchange: () => state.choose({ order: index as Order }),
    })
    return el('label', {}, input, el('span', {}, name))
  })
  const sync = () => {
    quantity.value = String(state.choice.quantity)
    abscissa.value = state.choice.over === undefined ? '' : String(state.choice.over)
    orders.forEach((label, index) => (label.control as HTMLInputElement).checked = index === state.choice.order)
  }
  state.onChoice(sync)
  sync()
  return el(
    'div',
    { class: 'bar' },
    el('label', { class: 'field' }, el('span', {}, 'Quantity'), quantity),
    el('label', { class: 'field' }, el('span', {}, 'over'), abscissa),
    el('fieldset', { class: 'segments' }, el('legend', { class: 'hidden' }, 'Order'), ...orders),
  )
}

function plural(group: string): string {
  return group === 'body' ? 'bodies' : `${group}s`
}

/** The same over the quantity chosen for that; its sensitivities then are those at a fixed abscissa. */
function over({ report, choice }: State, content: Content): Content {
  if (choice.over === undefined || content.message) return content
  const quantity = report.quantities[choice.over]
  return { ...content, over: { label: quantity.name, unit: quantity.units[0], curve: quantity.curves[0] } }
}

/** How the sensitivities of the chosen quantity are shown: as they are, or at a fixed abscissa; or why that cannot be. */
function shift({ report, choice }: State): ((curve: Curve, variable: number, differences: boolean) => Curve) | string {
  if (choice.over === undefined) return (curve) => curve
  const [y, x] = [report.quantities[choice.quantity], report.quantities[choice.over]]
  if (choice.order > 0) return 'Over another quantity, sensitivities are those of values; choose the value, or time.'
  if ([y, x].some(({ curves }) => curves[1].length === 0 || curves[2].length === 0)) {
    return `How ${y.name} goes with ${x.name} is not known along the motion, for one of them has no rate; choose time.`
  }
  const along = slope(y.curves, x.curves)
  return (curve, variable, differences) => {
    const of = report.variables[variable].sensitivities.get(x.index)
    const dx = differences ? of?.differences?.curves[0] : of?.curves[0]
    return dx ? atFixedAbscissa(curve, dx, along) : curve
  }
}

function valueContent({ report, choice }: State): Content {
  const quantity = report.quantities[choice.quantity]
  const title = orderedName(quantity, choice.order)
  const unit = quantity.units[choice.order]
  const line = { label: title, color: css('--ink'), curve: quantity.curves[choice.order] }
  if (line.curve.length === 0) return { title, unit, lines: [], message: unknown(title) }
  return { title, unit, lines: [line] }
}

function unknown(title: string): string {
  return `There is no ${title}: the motion is solved up to accelerations, and what goes by a driver up to its value.`
}

function peersContent(state: State): Content & { total: number } {
  const { report, choice } = state
  const quantity = report.quantities[choice.quantity]
  const selected = report.variables[choice.variable]
  const ranks = ranking(report, quantity, choice.order)
  // A variable that cannot be followed has no curves, but those of its unit are still worth seeing.
  const unit = selected && ranks.has(selected.unit) ? selected.unit : ([...ranks.keys()][0] ?? selected?.unit ?? '1')
  const peers = ranks.get(unit) ?? []
  const symbol = derivativeUnit(quantity, choice.order, { unit })
  const shown = peers.filter(({ variable }, rank) => choice.all || rank < FEW || variable === selected)
  const name = orderedName(quantity, choice.order)
  const content = { title: `d ${name} / d each variable in ${pretty(unit) || 'pure numbers'}`, unit: symbol }
  const seen = shift(state)
  if (quantity.curves[choice.order].length === 0) return { ...content, lines: [], message: unknown(name), total: 0 }
  if (typeof seen === 'string') return { ...content, lines: [], message: seen, total: 0 }
  const lines = shown.map(({ variable, sensitivity }, rank): Line => ({
    label: variable.name,
    color: hue(rank),
    curve: seen(sensitivity.curves[choice.order], variable.index, false),
    width: variable === selected ? 3 : 1.4,
    dash: rank < HUES ? undefined : [6, 3],
    pick: () => state.choose({ variable: variable.index }),
  }))
  if (lines.length === 0) return { ...content, lines, message: 'No sensitivities were computed.', total: 0 }
  const left = peers.length - shown.length
  const caption = left > 0 ? `The ${shown.length} largest of ${peers.length}.` : undefined
  return { ...content, lines, caption, total: peers.length }
}

function marginContent({ curve, note }: Margin): Content {
  const line = { label: 'margin', color: css('--ink'), curve }
  return { title: 'distance from a singular position', unit: '', lines: [line], caption: note, logarithmic: true }
}

function checkContent(state: State): Content {
  const { report, choice } = state
  const quantity = report.quantities[choice.quantity]
  const variable = report.variables[choice.variable]
  const { order } = choice
  const title = derivativeName(quantity, order, variable)
  const sensitivity = variable.sensitivities.get(quantity.index)
  const unit = derivativeUnit(quantity, order, variable)
  if (!sensitivity?.curves[order].length) return { title, unit, lines: [], message: variable.note || `There is no ${title}.` }
  const seen = shift(state)
  if (quantity.curves[order].length === 0) return { title, unit, lines: [], message: unknown(orderedName(quantity, order)) }
  if (typeof seen === 'string') return { title, unit, lines: [], message: seen }
  const analytic = seen(sensitivity.curves[order], variable.index, false)
  const lines: Line[] = [{ label: 'analytic', color: css('--accent'), curve: analytic, width: 2 }]
  const { differences } = sensitivity
  if (!differences) return { title, unit, lines, caption: 'Not compared with finite differences in this run.' }
  const curve = seen(differences.curves[order], variable.index, true)
  lines.push({ label: 'finite difference', color: css('--ink'), curve, marks: withGaps(curve) })
  const caption =
    `Designs re-solved ±${figure(Number(differences.step.toPrecision(2)), differences.unit)} away; ` +
    `largest relative disagreement ${number(differences.worst[order], 2)}.`
  return { title, unit, lines, caption }
}
