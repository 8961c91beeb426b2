import { el } from '../dom'
import { prefer, preference } from '../preferences'
import type { State } from '../state'

/** Key in the browser's store: the hint was closed, in some report. */
const KEY = 'first-steps'

let closed = false

/** Three steps for a first visit, each ticked when it is done; closed for good by the reader, or when all are done. */
export function firstSteps(state: State, grips: () => void): HTMLElement | undefined {
  if (closed || preference(KEY)) return undefined
  const close = () => {
    closed = true
    element.remove()
    prefer(KEY, 'closed')
  }
  const step = (name: string, title: string, onclick: () => void) =>
    el('button', { type: 'button', title, 'data-testid': `step-${name}`, onclick }, title)
  const focusVariable = () =>
    document.querySelector<HTMLInputElement>('.variables [aria-current=true] input[type=range]')?.focus()
  const steps = [
    step('play', '1 Play the motion (Space)', () => state.toggle()),
    step('drag', '2 Drag a point (M), or a variable’s slider', grips),
    step('compare', '3 Compare: dashed is the original, Δ shows the change', focusVariable),
  ]
  const done = [false, false, false]
  const tick = (index: number) => {
    done[index] = true
    steps[index].classList.add('done')
    if (done.every(Boolean)) close()
  }
  state.onTime(() => state.playing && tick(0))
  state.onChange(() => tick(1))
  document.addEventListener(
    'click',
    ({ target }) =>
      (target as Element).closest?.('[data-testid=difference], [data-testid=snapshot-compare]') && tick(2),
    { signal: state.ended },
  )
  const element = el(
    'div',
    { class: 'first-steps', role: 'note', 'aria-label': 'First steps', 'data-testid': 'first-steps' },
    ...steps,
    el('button', { type: 'button', class: 'icon', 'aria-label': 'close first steps', onclick: close }, '×'),
  )
  return element
}
