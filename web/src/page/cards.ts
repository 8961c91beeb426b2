import { el } from '../dom'
import { number, pretty } from '../format'
import type { Value } from '../payload'
import { noise, rounded } from '../rounding'
import type { State } from '../state'
import { pointing } from './pointing'

type Target = [low: number | null, high: number | null]

/** Digits of a number on a card. */
const DIGITS = 4

/**
 * Metrics of the design, each with its change and its target; a click selects their quantity.
 */
export function cards(state: State): HTMLElement {
  const shown = state.report.values.map((value, index) => card(state, value, index))
  const sync = () => {
    for (const { show } of shown) show()
  }
  state.onChoice(sync)
  sync()
  return el(
    'section',
    { class: 'values', 'aria-label': 'Values', 'data-testid': 'values', tabindex: -1 },
    ...shown.map(({ element }) => element),
  )
}

function card(state: State, value: Value, index: number): { element: HTMLElement; show: () => void } {
  const unit = pretty(value.unit)
  const figure = el('span', { class: 'figure-now', 'data-testid': 'card-value' })
  const change = el('span', { class: 'delta', 'data-testid': 'card-change' })
  const scale = el('span', { class: 'target', 'data-testid': 'card-target', 'aria-hidden': 'true' })
  const verdict = el('span', { class: 'hidden' })
  const element = el(
    'button',
    {
      type: 'button',
      class: 'card',
      'data-testid': `card-${value.name}`,
      title: `${value.name}, ${value.what}`,
      onclick: () => select(state, value),
    },
    el('span', { class: 'card-name' }, el('b', {}, value.name), ` ${value.what}`),
    el('span', { class: 'card-figures' }, figure, el('span', { class: 'unit' }, unit), change),
    value.target ? scale : undefined,
    verdict,
  )
  pointing(state, element, () => value.quantity ?? undefined)
  const show = () => {
    const now = state.value(index)
    const before = state.former ? (state.former.values[index] ?? null) : value.value
    figure.textContent = now === null ? '–' : number(rounded(now), DIGITS)
    const by = now === null || before === null ? null : now - before
    const known = state.isCompared && by !== null
    change.hidden = !known
    change.className = 'delta'
    if (known) showChange(change, now!, by!, value.target)
    element.setAttribute('aria-pressed', String(value.quantity !== null && value.quantity === state.choice.quantity))
    if (value.target) verdict.textContent = showTarget(scale, value.target, now)
  }
  return { element, show }
}

function select(state: State, { quantity, time }: Value): void {
  if (quantity !== null) state.choose({ quantity, order: 0 })
  if (time === null) return
  state.pause()
  state.goToTime(time)
}

/** Better and worse are said only against a target, by colour and arrow. */
function showChange(change: HTMLElement, now: number, by: number, target: Target | null): void {
  if (Math.abs(by) <= noise(now)) {
    change.textContent = '±0'
    return
  }
  const closer = target ? miss(now - by, target) - miss(now, target) : 0
  const verdict = closer > 0 ? 'better' : closer < 0 ? 'worse' : ''
  change.textContent = `${by > 0 ? '+' : ''}${number(by, 3)}${verdict ? ` ${verdict}` : ''}`
  if (verdict) change.classList.add(verdict)
}

function miss(value: number, [low, high]: Target): number {
  return Math.max(0, (low ?? -Infinity) - value, value - (high ?? Infinity))
}

/** Places band and tick, and describes the value relative to its target. */
function showTarget(scale: HTMLElement, target: Target, now: number | null): string {
  const [low, high] = target
  const ends = [low, high, now].filter((end) => end !== null)
  const [minimum, maximum] = [Math.min(...ends), Math.max(...ends)]
  const room = (maximum - minimum || Math.abs(maximum) || 1) * 0.35
  const at = (value: number) => `${(100 * (value - minimum + room)) / (maximum - minimum + 2 * room)}%`
  scale.style.setProperty('--from', low === null ? '0%' : at(low))
  scale.style.setProperty('--to', high === null ? '100%' : at(high))
  scale.style.setProperty('--tick', now === null ? '-10%' : at(now))
  const wanted =
    low === null
      ? `at most ${number(high ?? NaN)}`
      : high === null
        ? `at least ${number(low)}`
        : `${number(low)} to ${number(high)}`
  scale.title = `wanted: ${wanted}`
  const missed = now !== null && miss(now, target) > 0
  scale.classList.toggle('missed', missed)
  return now === null ? '' : `${missed ? 'misses' : 'meets'} the target, ${wanted}`
}
