import { el, prose, setProse } from '../dom'
import { effects, type Effect } from '../effect'
import { figure, pretty, roundBelow, signed } from '../format'
import { derivativeUnit, orderedName, type Variable } from '../report'
import type { State } from '../state'
import { parameterValues } from '../studio/goal'
import { badge, limited } from '../variables'
import { NumberField } from './number_field'
import { reach } from './reach'

/** With more variables than this they can be searched. */
const MANY = 12
/** Steps of a slider to either side. */
const STEPS = 50

/** Keeps bounds and tolerances of variables in the model. */
export interface VariableLimits {
  /** Returns a sentence where it is not possible. */
  setBounds: (name: string, bounds: readonly [number, number]) => string | undefined
  setTolerance: (name: string, tolerance: number) => void
}

interface Row {
  variable: Variable
  element: HTMLElement
  /** Shows the change, and highlights the row if it is selected. */
  sync: () => void
  /** Shows the effect of the variable on the selected quantity. */
  rank: (effect: Effect | undefined, unit: string) => void
  focus: () => void
}

/** The design variables, largest effect on the selected quantity first, each with its change. */
export function variables(state: State, limits?: VariableLimits): HTMLElement {
  const { report, choice } = state
  const list = el('ul', { 'aria-label': 'Design variables' })
  const about = el('span', { class: 'muted' })
  const resetAll = el(
    'button',
    { type: 'button', class: 'plain', 'data-testid': 'reset-all', onclick: () => state.reset() },
    'reset all',
  )
  const search = el('input', {
    type: 'search',
    placeholder: 'find a variable',
    'aria-label': 'Find a variable',
    'data-testid': 'variable-search',
    oninput: () => filter(),
  })
  search.hidden = report.variables.length <= MANY
  const shortfall = el('span', { class: 'shortfall', role: 'status', 'data-testid': 'shortfall' })
  const description = el('span', { 'aria-live': 'polite' })
  const note = el('p', { class: 'note', 'data-testid': 'variable-note' }, shortfall, description)
  const values = parameterValues(report.model?.text ?? '')
  const rows = report.variables.map((variable) => row(state, variable, values.get(variable.name), limits))
  let order = rows

  const filter = () => {
    const wanted = search.value.trim().toLowerCase()
    for (const { variable, element } of rows) {
      element.hidden = wanted !== '' && !`${variable.name} ${variable.description}`.toLowerCase().includes(wanted)
    }
  }
  let ranked = ''
  let sensitivityReport = state.sensitivityReport
  const arrange = () => {
    const key = `${choice.quantity} ${choice.order}`
    const again = key === ranked
    if (again && sensitivityReport === state.sensitivityReport) return
    ;[ranked, sensitivityReport] = [key, state.sensitivityReport]
    const quantity = report.quantities[choice.quantity]
    const all = quantity ? effects(state.sensitivityReport, choice.quantity, choice.order) : []
    about.textContent = quantity ? `by effect on ${orderedName(quantity, choice.order)}` : ''
    const place = new Map(all.map(({ variable }, rank) => [variable.index, rank]))
    for (const item of rows) {
      const effect = all[place.get(item.variable.index) ?? -1]
      item.rank(effect, quantity ? derivativeUnit(quantity, choice.order, item.variable) : '')
    }
    rank = (variable) => place.get(variable.index) ?? rows.length + Number(variable.admissibility === 'cannot_follow')
    if (!again) list.scrollTop = 0
    sort(!again)
  }
  let rank: (variable: Variable) => number = ({ index }) => index
  /** Sorts the rows; under the hand that changes one of them, they keep their places until it has left. */
  const sort = (isForced = false) => {
    const held = list.matches(':hover') || list.matches(':focus-within')
    const sorted = [...rows].sort((a, b) => rank(a.variable) - rank(b.variable) || a.variable.index - b.variable.index)
    if (sorted.every((item, k) => item === order[k]) && list.childElementCount > 0) return
    if (held && !isForced) return
    order = sorted
    list.replaceChildren(...order.map(({ element }) => element))
  }
  list.addEventListener('pointerleave', () => sort())
  list.addEventListener('focusout', ({ relatedTarget }) => list.contains(relatedTarget as Node | null) || sort())
  let shown = -1
  const sync = () => {
    arrange()
    for (const item of rows) item.sync()
    resetAll.hidden = !state.changed
    const variable = report.variables[choice.variable]
    setProse(shortfall, state.shortfall && `${state.shortfall} `)
    setProse(description, statusOf(state) + capitalised(variable?.note || variable?.description || ''))
    if (choice.variable === shown) return
    shown = choice.variable
    const { element } = rows[shown]
    bringIntoView(list, element)
  }
  list.addEventListener('keydown', (event) => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key]
    if (!by || (event.target as HTMLElement).closest('input')) return
    event.preventDefault()
    const visible = order.filter(({ element }) => !element.hidden)
    const next = visible[visible.findIndex(({ variable }) => variable.index === choice.variable) + by]
    if (!next) return
    state.choose({ variable: next.variable.index })
    next.focus()
  })
  state.onChoice(sync)
  sync()
  const head = el('div', { class: 'head' }, el('h2', { class: 'hidden' }, 'Variables'), about, search, resetAll)
  return el('section', { class: 'variables', 'aria-label': 'Variables', 'data-testid': 'variables' }, head, list, note)
}

/** A sentence with a capital letter, unless it begins with a name. */
function capitalised(text: string): string {
  return text.replace(/^[a-z]+(?= )/, ([first, ...rest]) => first.toUpperCase() + rest.join(''))
}

function statusOf(state: State): string {
  if (state.isPredicted) return 'Changes are predicted to first order. '
  if (state.hasCurrentSensitivities) return ''
  const { unsolved } = state
  return unsolved ? `Sensitivities of this design are not known: ${unsolved}. ` : 'Sensitivities are being updated. '
}

/** Scrolls a list to one of its rows; scrollIntoView would move the whole page on a phone. */
function bringIntoView(list: HTMLElement, { offsetTop: top, offsetHeight: height }: HTMLElement): void {
  if (top < list.scrollTop || top + height > list.scrollTop + list.clientHeight) {
    list.scrollTop = top - list.clientHeight / 3
  }
}

/** A row of a variable; one with a `nominal` value is a parameter, whose fields have values instead of changes. */
function row(state: State, variable: Variable, nominal: number | undefined, limits: VariableLimits | undefined): Row {
  const { index, name, unit, admissibility } = variable
  const able = admissibility !== 'cannot_follow'
  const [low, high] = able ? reach(state.report, variable) : [0, 0]
  const step = high > low ? roundBelow((high - low) / (2 * STEPS)) : 0
  const button = el(
    'button',
    {
      type: 'button',
      class: 'name',
      name,
      title: variable.description || name,
      onclick: () => state.choose({ variable: index }),
    },
    name,
  )
  /** Shown rows; a choice changes two of many. */
  let shown = ''
  const change = (by: number) => {
    // The slider and the field are not what was shown: the design may stay as it is.
    shown = ''
    state.change(index, by)
  }
  const { slider, field, reset } = rowControls(change, variable, nominal, [low, high], step)
  const bounded = able && limits ? limitControls(variable, nominal ?? 0, [low, high], limits) : undefined
  const bar = el('span', { class: 'bar-of', 'aria-hidden': 'true' })
  const size = el('span', { class: 'size' })
  const effect = el('span', { class: 'effect', 'data-testid': 'effect' }, bar, size)
  const range = step > 0 ? slider : el('span', { class: 'no-range' }, limits ? 'no range: set bounds by ±' : 'no range')
  const controls = able
    ? [range, el('span', { class: 'amount' }, field.input, el('span', { class: 'unit' }, pretty(unit)))]
    : []
  const element = el(
    'li',
    { class: `${admissibility} ${controls.length > 0 ? '' : 'fixed'}`, 'data-testid': `variable-${name}` },
    el('span', { class: 'who' }, button, able ? badge(variable) : undefined, bounded?.button),
    ...controls,
    able
      ? effect
      : el(
          'span',
          { class: 'why', title: variable.note },
          ...prose(variable.note || 'not possible for this mechanism'),
        ),
    controls.length > 0 && reset,
    bounded?.fields,
  )
  // A press anywhere in the row selects it, in addition to the action of a button or field.
  element.addEventListener('pointerdown', (event) => {
    if (!(event.target as HTMLElement).closest('button') && state.choice.variable !== index)
      state.choose({ variable: index })
  })
  const digits = step > 0 ? Math.max(0, -Math.floor(Math.log10(step))) : 0
  return {
    variable,
    element,
    sync: () => {
      const chosen = state.choice.variable === index
      const by = state.changes[index]
      const key = `${chosen} ${by}`
      if (shown === key) return
      element.setAttribute('aria-current', String(chosen))
      button.tabIndex = chosen ? 0 : -1
      if (bounded) bounded.sync(chosen)
      slider.tabIndex = field.input.tabIndex = reset.tabIndex = chosen ? 0 : -1
      widen(slider, by, step)
      if (Number(slider.value) !== by) slider.value = String(by)
      field.show(added(nominal, Number(by.toFixed(Math.max(digits, 3)))))
      slider.setAttribute('aria-valuetext', figure(added(nominal, by), unit))
      reset.classList.toggle('away', by === 0)
      element.classList.toggle('changed', by !== 0)
      shown = key
    },
    rank: (found, symbol) => {
      bar.style.setProperty('--share', String(found?.share ?? 0))
      bar.classList.toggle('negative', (found?.extreme ?? 0) < 0)
      size.textContent = !found ? 'not known' : found.share === 0 ? '≈ 0' : `${signed(found.extreme, 3)} ${symbol}`
    },
    focus: () => button.focus(),
  }
}

/** Extends a slider by whole steps to a value outside its range. */
function widen(slider: HTMLInputElement, value: number, step: number): void {
  if (step === 0) return
  if (value > Number(slider.max)) slider.max = String(Math.ceil(value / step) * step)
  if (value < Number(slider.min)) slider.min = String(Math.floor(value / step) * step)
}

/** Slider and field for the change of a variable, and the button that resets it. */
function rowControls(
  change: (by: number) => void,
  variable: Variable,
  nominal: number | undefined,
  [low, high]: [number, number],
  step: number,
) {
  const { name, unit } = variable
  const what = nominal === undefined ? 'change' : 'value'
  let pending: number | undefined
  const changeSoon = (by: number) => {
    // A slider reports more often than a frame can be drawn.
    if (pending === undefined)
      requestAnimationFrame(() => {
        const last = pending!
        pending = undefined
        change(last)
      })
    pending = by
  }
  const slider = el('input', {
    type: 'range',
    min: low,
    max: high,
    step,
    value: 0,
    'data-testid': 'change',
    'aria-label': `${what} of ${name}`,
    oninput: () => changeSoon(Number(slider.value)),
  })
  const field = new NumberField({
    label: `${what} of ${name} in ${pretty(unit) || 'its unit'}`,
    testId: 'change-value',
    unit,
    step: step || 1,
    plus: nominal === undefined ? 'sign' : 'adds',
    apply: (typed) => {
      const by = added(typed, -(nominal ?? 0))
      const kept = limited(by, variable.bounds)
      change(kept)
      field.show(added(nominal, kept))
      return kept === by ? undefined : `The bound of \`${name}\` is ${figure(added(nominal, kept), unit)}.`
    },
  })
  const reset = el(
    'button',
    {
      type: 'button',
      class: 'icon',
      title: `reset ${name}`,
      'aria-label': `reset ${name}`,
      'data-testid': 'reset',
      onclick: () => change(0),
    },
    '↺',
  )
  return { slider, field, reset }
}

/** Sum with as few digits as its parts. */
function added(a = 0, b: number): number {
  return Number((a + b).toPrecision(12))
}

/** Fields for the bounds and the tolerance of a variable, below its row, and the button that opens them. */
function limitControls(
  variable: Variable,
  nominal: number,
  [low, high]: [number, number],
  { setBounds, setTolerance }: VariableLimits,
) {
  const { name, unit, bounds, tolerance } = variable
  const step = high > low ? roundBelow((high - low) / (2 * STEPS)) : 1
  const ends = [0, 1].map((k) => (bounds?.[k] == null ? undefined : added(nominal, bounds[k])))
  const field = (
    label: string,
    testId: string,
    value: number | undefined,
    apply: (x: number) => string | undefined,
  ) => {
    const made = new NumberField({ label: `${label} of ${name}`, testId, unit, step, plus: 'sign', apply })
    if (value !== undefined) made.show(value)
    made.input.placeholder = 'none'
    return made.input
  }
  const end = (k: 0 | 1) => (x: number) => {
    ends[k] = x
    const [a, b] = ends
    if (a === undefined || b === undefined) return `Enter the ${a === undefined ? 'lower' : 'upper'} bound as well.`
    return a < b
      ? setBounds(name, [added(a, -nominal), added(b, -nominal)])
      : `The lower bound of \`${name}\` is not below its upper bound.`
  }
  const label = (text: string, input: HTMLElement) => el('label', {}, el('span', { class: 'muted' }, text), input)
  const fields = el('div', { class: 'limit-fields', hidden: true })
  /** Makes the fields when they are first shown. */
  const fill = () =>
    fields.append(
      label('lowest', field('lower bound', 'bound-low', ends[0], end(0))),
      label('highest', field('upper bound', 'bound-high', ends[1], end(1))),
      label(
        'tolerance ±',
        field('tolerance', 'tolerance-of', tolerance ?? undefined, (x) =>
          x > 0 ? (setTolerance(name, x), undefined) : 'A tolerance is above zero.',
        ),
      ),
      el('span', { class: 'unit' }, pretty(unit)),
    )
  const button = el(
    'button',
    {
      type: 'button',
      class: 'icon limits-button',
      'aria-expanded': 'false',
      title: `bounds and tolerance of ${name}`,
      'aria-label': `bounds and tolerance of ${name}`,
      'data-testid': 'limits',
      onclick: () => {
        if (fields.childElementCount === 0) fill()
        fields.hidden = !fields.hidden
        button.setAttribute('aria-expanded', String(!fields.hidden))
      },
    },
    '±',
  )
  const sync = (chosen: boolean) => {
    button.tabIndex = chosen ? 0 : -1
    if (!chosen) fields.hidden = true
    button.setAttribute('aria-expanded', String(!fields.hidden))
  }
  return { fields, button, sync }
}
