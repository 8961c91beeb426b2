import { el } from '../dom'

const KEYS: [keys: string, meaning: string][] = [
  ['Space', 'play or pause'],
  ['← →', 'previous or next step'],
  ['Home End', 'first or last step'],
  ['F', 'fit the mechanism to the view'],
  ['L', 'show names of hardpoints'],
  ['N', 'show forces as arrows, if the model has masses or forces'],
  ['1 … 5', 'standard views, in the order of their buttons'],
  ['M', 'drag hardpoints; X Y Z choose an axis, arrow keys step, with Shift finer; Escape leaves'],
  ['D', 'measure distances and angles'],
  ['↑ ↓', 'previous or next row of the focused list'],
  ['+ − 0', 'in a plot: zoom in, zoom out, reset'],
  ['Shift ← →', 'in a plot: scroll along the axis'],
  ['drag', 'in the view: a body moves the mechanism along its motion; elsewhere, or with Alt, the view turns'],
  ['drag', 'in a plot: set the time; along its axis or with Shift: zoom; double click: reset'],
  ['/', 'find a quantity or a variable'],
  ['?', 'these keys'],
  ['Escape', 'close dialogs and menus, clear the selection'],
]

const MARKS: [mark: string, meaning: string][] = [
  ['solid', 'the current design'],
  ['dashed', 'the reference design'],
  ['dotted', 'prediction (first or second order), error bound, or target'],
  ['rings', 'check by re-solving (finite differences)'],
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
