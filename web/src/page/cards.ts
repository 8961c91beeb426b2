import { type Course, type Curve, courseRange, slopeAt, slopeAlone, stepAt } from '../curve'
import { el, setAttribute, setText } from '../dom'
import { number, per, pretty, signed } from '../format'
import { aboutQuantity } from '../glossary'
import type { Value } from '../payload'
import type { Report } from '../report'
import { noise, rounded, tolerated } from '../rounding'
import { hasOneFreedom, isTravel, onSideOf } from '../sheet'
import type { State } from '../state'
import { moverOf } from './contents'
import { pointing } from './pointing'

type Target = [low: number | null, high: number | null]

/** Digits of a number on a card. */
const DIGITS = 4
/** Smallest length of a bar, as a fraction of its largest number: closer numbers have the same digits on the card. */
const SHORTEST = 10 ** -DIGITS
/** With more cards than this, those of quantities that the sheet does not show are behind a button. */
const MANY = 14
/** Kinds of values that are taken at one position of the whole motion. */
const STATIC = ['design configuration', 'at the start']

/** A value with its element. */
interface Card {
  element: HTMLElement
  show: () => void
}

/**
 * Metrics of the design, then its measures with their range over the motion and their slope over wheel travel, each
 * with the change to the reference design and the target; a click selects the quantity.
 */
export function cards(state: State): HTMLElement {
  const { values } = state.report
  const shown = values.map((value, index) => card(state, value, index))
  const sheet = new Set(state.sheet.plots.flatMap(({ y }) => y))
  const minor = values.map((value) => isStatic(value) && !value.target && !sheet.has(value.quantity ?? -1))
  const count = minor.filter(Boolean).length
  const more = el('button', {
    type: 'button',
    class: 'card more',
    'data-testid': 'more-cards',
    onclick: () => unfold(more.getAttribute('aria-expanded') !== 'true'),
  })
  const unfold = (all: boolean) => {
    minor.forEach((isMinor, k) => (shown[k].element.hidden = isMinor && !all))
    more.setAttribute('aria-expanded', String(all))
    more.textContent = all ? 'fewer' : `+ ${count} more`
    sync()
  }
  const sync = () => {
    for (const { show, element } of shown) if (!element.hidden) show()
  }
  const folds = values.length > MANY && count > 0 && count < values.length
  more.hidden = !folds
  unfold(!folds)
  state.onChoice(sync)
  const order = [...shown.keys()].sort((a, b) => Number(minor[a]) - Number(minor[b]) || a - b)
  return el(
    'section',
    { class: 'values', 'aria-label': 'Values', 'data-testid': 'values', tabindex: -1 },
    ...order.map((k) => shown[k].element),
    more,
  )
}

/** True for the value of a measure at one position, whose curve says more. */
export function isStatic({ what, quantity }: Value): boolean {
  return quantity !== null && STATIC.includes(what)
}

/** A metric or a value of a measure; a dash where it is not known. */
export function valueText(value: number | null): string {
  return value === null ? '–' : number(rounded(value), DIGITS)
}

function card(state: State, value: Value, index: number): Card {
  const unit = pretty(value.unit)
  const figure = el('span', { class: 'figure-now', 'data-testid': 'card-value' })
  const change = el('span', { class: 'delta', 'data-testid': 'card-change' })
  const scale = el('span', { class: 'target', 'data-testid': 'card-target', 'aria-hidden': 'true' })
  const verdict = el('span', { class: 'hidden' })
  const motion = el('span', { class: 'card-motion', 'data-testid': 'card-motion' })
  const what = whatOf(state.report, value)
  const about = value.quantity === null ? undefined : aboutQuantity(state.report.quantities[value.quantity])
  const element = el(
    'button',
    {
      type: 'button',
      class: 'card',
      'data-testid': `card-${value.name}`,
      title: `${value.name} ${what}${about ? `: ${about}` : ''}`,
      onclick: () => select(state, value),
    },
    el('span', { class: 'card-name' }, el('b', {}, value.name), ` ${what}`),
    el('span', { class: 'card-figures' }, figure, el('span', { class: 'unit' }, unit), change),
    isStatic(value) ? motion : undefined,
    value.target ? scale : undefined,
    verdict,
  )
  pointing(state, element, () => value.quantity ?? undefined)
  const over = value.quantity === null ? undefined : travelOf(state.report, value.quantity)
  const show = () => {
    const now = state.value(index)
    const before = state.former ? (state.former.values[index] ?? null) : value.value
    setText(figure, valueText(now))
    const by = now === null || before === null ? null : now - before
    const known = state.isCompared && by !== null && (!isStatic(value) || Math.abs(by) > noise(now!))
    change.hidden = !known
    if (known) showChange(change, now!, by!, value.target)
    if (isStatic(value)) setText(motion, motionText(state, value, over))
    setAttribute(element, 'aria-pressed', value.quantity !== null && value.quantity === state.choice.quantity)
    if (value.target) setText(verdict, showTarget(scale, value.target, now))
  }
  return { element, show }
}

/** `at ride height` for a wheel, `at design position` for a linkage; other kinds as they are. */
function whatOf({ wheels }: Report, { what }: Value): string {
  if (what !== STATIC[0]) return what
  return wheels.length > 0 ? 'at ride height' : 'at design position'
}

/** Minimum and maximum of the curve over the motion with their changes, and the slope over wheel travel. */
function motionText(state: State, { quantity, time, unit }: Value, over: number | undefined): string {
  const index = quantity!
  const { times, quantities } = state.report
  const range = courseRange(state.course(index), times)
  if (!range) return ''
  const reference = state.former?.quantities[index] ?? quantities[index].curves
  const before = state.isCompared ? referenceRange(reference, times) : undefined
  const size = Math.max(...range.map(Math.abs))
  const ends = range.map((value, k) => endText(value, before?.[k], size)).join(' … ')
  const gradient = over === undefined ? '' : slopeText(state, index, over, time ?? 0, unit)
  return [range[1] - range[0] > noise(size) && ends, gradient].filter(Boolean).join(' · ')
}

/** Ranges of reference courses, which stay while the design is dragged. */
const referenceRanges = new WeakMap<Course, { times: Curve; range: [number, number] | undefined }>()

function referenceRange(course: Course, times: Curve): [number, number] | undefined {
  let found = referenceRanges.get(course)
  if (found?.times !== times) {
    found = { times, range: courseRange(course, times) }
    referenceRanges.set(course, found)
  }
  return found.range
}

/** An end of a range of numbers of some size, with its change to the former one. */
export function endText(value: number, former: number | undefined, size: number): string {
  const by = former === undefined ? 0 : value - former
  const changed = Math.abs(by) > noise(size) ? ` (${signed(by, 2)})` : ''
  // Between the steps of a dwell the interpolation leaves a rest.
  return `${number(Math.abs(value) <= noise(size) ? 0 : value, 3)}${changed}`
}

/** The wheel travel on the side of a quantity; undefined where there is none, and of the travel itself. */
function travelOf(report: Report, index: number): number | undefined {
  const travel = report.quantities.find(isTravel)?.index
  const over = travel === undefined ? undefined : onSideOf(report, travel, index)
  return over === index ? undefined : over
}

/**
 * Slope of a quantity over wheel travel at a time: of the motion itself if it has one degree of freedom, else while the
 * driver that moves the wheel moves alone, as far as that is known of the present design.
 */
function slopeText(state: State, index: number, over: number, time: number, unit: string): string {
  const { report, sensitivityReport } = state
  const step = Math.round(stepAt(report.times, time))
  let value = NaN
  if (hasOneFreedom(report)) {
    const orders = (quantity: number) => [0, 1, 2].map((order) => state.curve(quantity, order as 0))
    const [y, x] = [orders(index), orders(over)]
    if (y[1].length > 0 && y[2].length > 0) value = slopeAt([y[0], y[1], y[2]], [x[0], x[1], x[2]])(step)
  } else if (state.outdated === undefined) {
    const alone = moverOf(sensitivityReport, over)?.alone
    if (alone?.[index]?.length && alone[over]?.length) value = slopeAlone(alone[index], alone[over])[step]
  }
  if (!Number.isFinite(value)) return ''
  return `slope ${number(rounded(value), 3)} ${per(unit, report.quantities[over].units[0])}`
}

function select(state: State, { quantity, time }: Value): void {
  if (quantity !== null) state.choose({ quantity, order: 0 })
  if (time === null) return
  state.pause()
  state.goToTime(time)
}

/** Better and worse are said only against a target, by colour and arrow. */
function showChange(change: HTMLElement, now: number, by: number, target: Target | null): void {
  const isSame = Math.abs(by) <= noise(now)
  const closer = target && !isSame ? miss(now - by, target) - miss(now, target) : 0
  const verdict = closer > 0 ? 'better' : closer < 0 ? 'worse' : ''
  setText(change, isSame ? '±0' : `${signed(by, 3)}${verdict ? ` ${verdict}` : ''}`)
  setAttribute(change, 'class', `delta ${verdict}`.trimEnd())
}

function miss(value: number, [low, high]: Target): number {
  return Math.max(0, (low ?? -Infinity) - value, value - (high ?? Infinity))
}

/** True if a value misses its target by more than the accuracy with which a search ends on a limit. */
export function isMissed(value: number, target: Target): boolean {
  return miss(value, target) > tolerated(sizeOf([...target, value]))
}

/** Positions of the band of a target and of the value on the bar of a card, from 0 to 1. */
export function placesOf([low, high]: Target, now: number | null): { from: number; to: number; tick: number } {
  const ends = [low, high, now].filter((end) => end !== null)
  const [minimum, maximum] = [Math.min(...ends), Math.max(...ends)]
  const size = sizeOf(ends)
  const room = Math.max(maximum - minimum || size || 1, SHORTEST * size) * 0.35
  const at = (value: number) => (value - minimum + room) / (maximum - minimum + 2 * room)
  return { from: low === null ? 0 : at(low), to: high === null ? 1 : at(high), tick: now === null ? -0.1 : at(now) }
}

function sizeOf(numbers: (number | null)[]): number {
  return Math.max(...numbers.map((x) => Math.abs(x ?? 0)))
}

/** Places band and tick, and describes the value relative to its target. */
function showTarget(scale: HTMLElement, target: Target, now: number | null): string {
  const [low, high] = target
  for (const [name, place] of Object.entries(placesOf(target, now)))
    scale.style.setProperty(`--${name}`, `${100 * place}%`)
  const wanted =
    low === null
      ? `at most ${number(high ?? NaN)}`
      : high === null
        ? `at least ${number(low)}`
        : `${number(low)} to ${number(high)}`
  scale.title = `wanted: ${wanted}`
  const missed = now !== null && isMissed(now, target)
  scale.classList.toggle('missed', missed)
  return now === null ? '' : `${missed ? 'misses' : 'meets'} the target, ${wanted}`
}
