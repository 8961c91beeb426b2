import { el } from '../dom'

const KEYS: [keys: string, meaning: string][] = [
  ['Space', 'play or pause'],
  ['← →', 'one step back or forth'],
  ['Home End', 'first or last step'],
  ['F', 'fit the mechanism into the view'],
  ['L', 'names of hardpoints'],
  ['N', 'forces as arrows, of a model with masses or forces'],
  ['1 … 5', 'standard views, in the order of their buttons'],
  ['↑ ↓', 'another row of a list, when it has the focus'],
  ['+ − 0', 'in a plot: closer, further, the whole'],
  ['Shift ← →', 'in a plot: what is before or after'],
  ['drag', 'in a plot: the time; along its axis or with Shift: what is seen; double click: the whole'],
  ['/', 'find a quantity or a variable'],
  ['?', 'these keys'],
  ['Escape', 'close what is open, select nothing in the view'],
]

const MARKS: [mark: string, meaning: string][] = [
  ['solid', 'the present design'],
  ['dashed', 'the design that it is compared with'],
  ['dotted', 'predicted to first or second order, or an error bound'],
  ['rings', 'finite differences of re-solved designs'],
]

/** The keys and line styles of the page, in a dialog of their own. */
export function help(): HTMLDialogElement {
  const pairs = (list: [string, string][], tag: 'kbd' | 'span') =>
    el(
      'dl',
      { class: 'pairs' },
      ...list.flatMap(([key, meaning]) => [el('dt', {}, el(tag, {}, key)), el('dd', {}, meaning)]),
    )
  const dialog = el(
    'dialog',
    { class: 'help', 'data-testid': 'keys', 'aria-label': 'Keys and lines' },
    el('h2', {}, 'Keys'),
    pairs(KEYS, 'kbd'),
    el('h2', {}, 'Lines'),
    pairs(MARKS, 'span'),
    el('form', { method: 'dialog' }, el('button', {}, 'Close')),
  )
  return dialog
}
