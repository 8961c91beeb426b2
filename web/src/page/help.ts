import { el, prose } from '../dom'
import { TERMS } from '../glossary'

type Pairs = [keys: string, meaning: string][]

const PAGE: Pairs = [
  ['Space', 'play or pause'],
  ['← →', 'previous or next step'],
  ['Home End', 'first or last step'],
  ['/', 'find a quantity or a variable'],
  ['↑ ↓', 'previous or next row of the focused list'],
  ['?', 'this help'],
  ['Escape', 'close dialogs, menus and a maximised plot; clear the selection'],
]

const VIEW: Pairs = [
  ['drag', 'on a body: move the mechanism along its motion; elsewhere, or with Alt: orbit'],
  ['right drag', 'pan; also by dragging with Ctrl'],
  ['wheel', 'zoom; also by pinching'],
  ['click', 'select a body, joint or force; on the background: clear the selection'],
  ['1 … 5', 'standard views, in the order of their buttons'],
  ['F', 'fit the mechanism to the view'],
  ['L', 'show names of hardpoints'],
  ['N', 'show forces as arrows, if the model has masses or forces'],
  ['H', 'show shapes and their nearest points, if the model has shapes'],
  ['D', 'measure distances and angles'],
]

const PLOTS: Pairs = [
  ['drag', 'set the time; along an axis or with Shift: zoom'],
  ['wheel', 'on the vertical axis: zoom'],
  ['double click', 'maximise or restore; on an axis: reset its zoom'],
  ['+ − 0', 'zoom in, zoom out, reset'],
  ['Shift ← →', 'scroll along the axis'],
  ['Shift ↑ ↓', 'zoom the vertical axis'],
  ['Enter', 'maximise or restore'],
  ['drop a file', 'measured data (CSV): columns named as the plotted quantities, or the first two'],
]

const DESIGN: Pairs = [
  ['M', 'drag points, or stop'],
  ['X Y Z', 'drag along an axis'],
  ['Ctrl Z', 'undo'],
  ['Ctrl Y', 'redo (also Ctrl Shift Z)'],
  ['Ctrl S', 'save the model, where it was opened by `hardpoint studio`'],
  ['F8', 'in the model’s text: next message'],
]

const MARKS: Pairs = [
  ['solid', 'the current design'],
  ['dashed', 'the reference design: the original, or one that is compared'],
  ['dash-dotted', 'further compared designs'],
  ['thin', 'the rigid mechanism; dashed in the view'],
  ['dotted', 'prediction (first or second order), error bound, or target'],
  ['rings', 'check by re-solving (finite differences)'],
]

/** The keys and line styles of the page, in a dialog of their own. */
export function help(): HTMLDialogElement {
  const pairs = (list: Pairs, tag: 'kbd' | 'span') =>
    el(
      'dl',
      { class: 'pairs' },
      ...list.flatMap(([key, meaning]) => [el('dt', {}, el(tag, {}, key)), el('dd', {}, ...prose(meaning))]),
    )
  const dialog = el(
    'dialog',
    { class: 'help', 'data-testid': 'keys', 'aria-label': 'Keys and lines' },
    el(
      'p',
      { class: 'lead' },
      'This page shows a mechanism, its motion, and how every result depends on the design. Change a variable or ' +
        'drag a point: everything is solved again. The page needs no connection.',
    ),
    el('h2', {}, 'Page'),
    pairs(PAGE, 'kbd'),
    el('h2', {}, 'View'),
    pairs(VIEW, 'kbd'),
    el('h2', {}, 'Plots'),
    pairs(PLOTS, 'kbd'),
    el('h2', {}, 'Design'),
    pairs(DESIGN, 'kbd'),
    el('h2', {}, 'Lines'),
    pairs(MARKS, 'span'),
    el('h2', {}, 'Terms'),
    pairs(TERMS, 'span'),
    el('form', { method: 'dialog' }, el('button', {}, 'Close')),
  )
  return dialog
}
