import { type Course, courseRange } from '../curve'
import { el } from '../dom'
import { number, pretty, signed, titled } from '../format'
import { noise } from '../rounding'
import type { Design } from '../report'
import type { State } from '../state'
import { isStatic, valueText } from './cards'
import { whileSeen } from './tabs'

/** Significant digits of coordinates. */
const PLACE = 8

/** A design of the comparison. */
interface Column {
  name: string
  value: (index: number) => number | null
  course: (quantity: number) => Course
}

/**
 * Metrics, and minimum and maximum of the measures over the motion, of the original, the present and all compared
 * designs, side by side, with the change to the reference.
 */
export function comparison(state: State): HTMLElement {
  const { values } = state.report
  const [head, body] = [el('thead'), el('tbody')]
  const table = el('div', { class: 'scroll', tabindex: 0 }, el('table', { class: 'numbers' }, head, body))
  const lead = el('p', { class: 'lead' })
  const section = el('section', { class: 'checks', 'data-testid': 'comparison', 'aria-label': 'Compare' }, lead, table)
  const points = el('section', { class: 'checks', 'data-testid': 'hardpoints', 'aria-label': 'Hardpoints' })
  const element = el('div', {}, section, points)
  const offer = () => (points.hidden = !state.hardpoints)
  state.onChoice(offer)
  offer()
  const render = () => {
    showHardpoints(points, state)
    const columns = columnsOf(state)
    const [reference] = columns
    const present = columns[1]
    lead.textContent = present
      ? `Metrics, and ranges of the measures over the motion; change from ${reference.name} to ${present.name}.`
      : 'Change a variable or drag a point, or compare named designs (Designs ▾): their values are listed here.'
    const header = ['value', ...columns.map(({ name }) => name), ...(present ? ['change'] : []), 'unit']
    head.replaceChildren(el('tr', {}, ...header.map((text) => el('th', { scope: 'col' }, text))))
    body.replaceChildren(
      ...values.map((item, index) => {
        const { name, what, unit, quantity } = item
        const isRange = isStatic(item)
        const found = columns.map(({ value, course }) =>
          isRange ? (courseRange(course(quantity!), state.report.times) ?? [null, null]) : [value(index)],
        )
        const join = (words: string[]) => [...new Set(words)].join(' … ')
        const cells = found.map((numbers) => join(numbers.map(valueText)))
        const [before, now] = found
        const changed = (value: number | null, k: number) =>
          value === null || before[k] === null ? '–' : changeText(value - before[k], value)
        if (present) cells.push(join(now.map(changed)))
        return el(
          'tr',
          {},
          el('th', { scope: 'row', title: `${name}: ${isRange ? 'minimum and maximum over the motion' : what}` }, name),
          ...cells.map((cell) => el('td', { class: 'figure' }, cell)),
          el('td', { class: 'unit' }, pretty(unit) || '–'),
        )
      }),
    )
  }
  whileSeen(element, (listener) => state.onChoice(listener), render, state.ended)
  render()
  return element
}

/** Table of the hardpoints: the original coordinates, and the present ones with their changes. */
function showHardpoints(element: HTMLElement, { hardpoints, report }: State): void {
  const all = hardpoints?.() ?? []
  const axes = ['x', 'y', 'z']
  const cells = (before: readonly number[], now: readonly number[]) => {
    const changes = axes.map((_, k) => changeText(now[k] - before[k], now[k]))
    const text = (list: string[]) => list.map((cell) => el('td', { class: 'figure' }, cell))
    return changes.every((change) => change === '0')
      ? [...text(axes.map((_, k) => number(before[k], PLACE))), ...text(Array(6).fill(''))]
      : [before, now].flatMap((place) => text(axes.map((_, k) => number(place[k], PLACE)))).concat(text(changes))
  }
  const header = ['original', 'current', 'change'].flatMap((what) => axes.map((axis) => `${axis} ${what}`))
  element.replaceChildren(
    el('h3', {}, titled('Hardpoints', report.units.length)),
    el(
      'div',
      { class: 'scroll', tabindex: 0 },
      el(
        'table',
        { class: 'numbers' },
        el('thead', {}, el('tr', {}, ...['hardpoint', ...header].map((text) => el('th', { scope: 'col' }, text)))),
        el(
          'tbody',
          {},
          ...all.map(({ name, before, now }) => el('tr', {}, el('th', { scope: 'row' }, name), ...cells(before, now))),
        ),
      ),
    ),
  )
}

/** The reference first, then the present design if it differs, then the others. */
function columnsOf(state: State): Column[] {
  const { report, former, rigid, designs, choice, isCompared } = state
  const original: Column = {
    name: 'original',
    value: (index) => report.values[index].value,
    course: (quantity) => report.quantities[quantity].curves,
  }
  const of = (design: Design): Column => ({
    name: design.name,
    value: (index) => design.values[index] ?? null,
    course: (quantity) => design.quantities[quantity] ?? [new Float32Array()],
  })
  const present: Column = {
    name: 'current',
    value: (index) => state.value(index),
    course: (quantity) => state.course(quantity),
  }
  const reference = choice.compared !== undefined && former ? of(former) : original
  const last = reference === original || !state.changed ? [] : [original]
  const others = [...state.overlays.map((index) => designs[index]), ...(rigid ? [rigid] : [])]
  return [reference, ...(isCompared ? [present] : []), ...others.map(of), ...last]
}

function changeText(by: number, size: number): string {
  return Math.abs(by) <= noise(size) ? '0' : signed(by, 3)
}
