import { el, prose, setAttribute, svg } from '../dom'
import type { History, Snapshot, Step } from './history'
import './studio.css'

/** Actions of the page for the bar. */
export interface HistoryActions {
  /** Shows another design. */
  show: (step: Step) => void
  /** Compares with designs that were given a name, the last of them as the reference; with none of them if empty. */
  compare: (snapshots: readonly Snapshot[]) => void
  /** Writes a design to the model's text, and returns what was done. */
  write: (snapshot: Snapshot) => Promise<string>
}

/** An arrow that turns back, and the same that turns forth. */
const BACK = 'M3.5 6.5h6a3.5 3.5 0 0 1 0 7h-3M6.5 3.5l-3 3l3 3'
const FORTH = 'M12.5 6.5h-6a3.5 3.5 0 0 0 0 7h3M9.5 3.5l3 3l-3 3'

/**
 * Buttons for undo, redo, reset and the designs that were given a name; and their keys, wherever the focus is but in a
 * text.
 */
export function historyBar(history: History, { show, compare, write }: HistoryActions): HTMLElement {
  const icon = (path: string) => svg('svg', { viewBox: '0 0 16 16', 'aria-hidden': 'true' }, svg('path', { d: path }))
  const undo = () => history.undo()
  const redo = () => history.redo()
  const move = (by: () => Step | undefined) => {
    const step = by()
    if (step) show(step)
  }
  const back = el(
    'button',
    { type: 'button', class: 'icon', 'data-testid': 'undo', onclick: () => move(undo) },
    icon(BACK),
  )
  const forth = el(
    'button',
    { type: 'button', class: 'icon', 'data-testid': 'redo', onclick: () => move(redo) },
    icon(FORTH),
  )
  const reset = el(
    'button',
    {
      type: 'button',
      title: 'Back to the original design',
      'data-testid': 'reset-design',
      onclick: () => show(history.reset()),
    },
    'Reset',
  )
  const sync = () => {
    for (const [button, what, keys, of] of [
      [back, 'Undo', 'Ctrl+Z', history.undoable],
      [forth, 'Redo', 'Ctrl+Y', history.redoable],
    ] as const) {
      button.disabled = of === undefined
      const title = of === undefined ? `${what} (${keys})` : `${what}: ${of} (${keys})`
      setAttribute(button, 'title', title)
      setAttribute(button, 'aria-label', title)
    }
    reset.disabled = !history.changed
  }
  history.onChange(sync)
  sync()
  document.addEventListener('keydown', (event) => {
    const by = stepOf(event)
    if (
      !by ||
      event.defaultPrevented ||
      (event.target as HTMLElement).closest('input:not([type=range]), textarea, [contenteditable=true], dialog')
    )
      return
    event.preventDefault()
    move(by === 'undo' ? undo : redo)
  })
  return el(
    'div',
    { class: 'history', role: 'group', 'aria-label': 'Designs' },
    back,
    forth,
    reset,
    snapshots(history, { show, compare, write }),
  )
}

/** Action of a key with Ctrl, or with the command key. */
function stepOf({ key, ctrlKey, metaKey, altKey, shiftKey }: KeyboardEvent): 'undo' | 'redo' | undefined {
  if (ctrlKey === metaKey || altKey) return undefined
  const letter = key.toLowerCase()
  if (letter === 'z') return shiftKey ? 'redo' : 'undo'
  return letter === 'y' && !shiftKey ? 'redo' : undefined
}

/** A button that opens the named designs: save the current one; open, compare, rename and delete others. */
function snapshots(history: History, { show, compare, write }: HistoryActions): HTMLElement {
  const name = el('input', {
    type: 'text',
    placeholder: 'name of this design',
    'aria-label': 'Name of this design',
    'data-testid': 'snapshot-name',
  })
  const form = el('form', { class: 'keep' }, name, el('button', { 'data-testid': 'snapshot-keep' }, 'Keep'))
  const list = el('ul', { 'aria-label': 'Named designs', 'data-testid': 'snapshots' })
  const done = el('p', { class: 'done', role: 'status', 'data-testid': 'snapshot-done' })
  const panel = el('div', { class: 'menu designs', hidden: true }, form, list, done)
  const button = el('button', {
    type: 'button',
    'aria-expanded': 'false',
    'data-testid': 'designs',
    onclick: () => open(!!panel.hidden),
  })
  const element = el('div', { class: 'dropdown' }, button, panel)
  const open = (wanted: boolean) => {
    panel.hidden = !wanted
    done.replaceChildren()
    button.setAttribute('aria-expanded', String(wanted))
    if (wanted) name.focus()
  }
  const toggle = (snapshot: Snapshot) => {
    const { compared } = history
    const others = compared.filter((one) => one !== snapshot)
    history.compareWith(others.length < compared.length ? others : [...others, snapshot])
    compare(history.compared)
  }
  const row = (snapshot: Snapshot): HTMLElement =>
    snapshotRow(snapshot, history.compared.includes(snapshot), {
      rename: (text) => history.rename(snapshot, text),
      open: () => (show(history.restore(snapshot)), open(false), button.focus()),
      compare: () => toggle(snapshot),
      write: async () => done.replaceChildren(...prose(await write(snapshot))),
      remove: () => {
        if (history.compared.includes(snapshot)) toggle(snapshot)
        history.remove(snapshot)
        name.focus()
      },
    })
  let shown = ''
  const render = () => {
    const ids = (all: readonly Snapshot[]) => all.map(({ id }) => id).join()
    const key = `${ids(history.compared)} ${ids(history.snapshots)}`
    if (key === shown) return
    shown = key
    const focused = (document.activeElement as HTMLButtonElement | null)?.name
    list.replaceChildren(...history.snapshots.map(row))
    list.hidden = history.snapshots.length === 0
    button.textContent = `Designs${history.snapshots.length > 0 ? ` ${history.snapshots.length}` : ''} ▾`
    for (const one of list.querySelectorAll('button')) if (focused && one.name === focused) one.focus()
  }
  form.addEventListener('submit', (event) => {
    event.preventDefault()
    history.save(name.value)
    name.value = ''
  })
  element.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || panel.hidden) return
    event.preventDefault()
    open(false)
    button.focus()
  })
  // Only if the focus moves to another element: rebuilding a list moves it to none.
  element.addEventListener('focusout', ({ relatedTarget }) => {
    if (relatedTarget && !element.contains(relatedTarget as Node)) open(false)
  })
  document.addEventListener('pointerdown', ({ target }) => {
    if (!panel.hidden && !element.contains(target as Node)) open(false)
  })
  history.onChange(render)
  shown = '-'
  render()
  return element
}

interface RowActions {
  rename: (text: string) => void
  open: () => void
  compare: () => void
  write: () => void
  remove: () => void
}

/** A named design with its field and its buttons. */
function snapshotRow(
  snapshot: Snapshot,
  isCompared: boolean,
  { rename, open, compare, write, remove }: RowActions,
): HTMLElement {
  const field = el('input', {
    type: 'text',
    value: snapshot.name,
    'data-testid': 'snapshot-rename',
    onchange: () => (rename(field.value), label()),
  })
  const action = (title: string, name: string, run: () => void) =>
    el(
      'button',
      {
        type: 'button',
        name: `${name} ${snapshot.id}`,
        title,
        'data-testid': `snapshot-${name.toLowerCase()}`,
        onclick: run,
      },
      name,
    )
  const actions = [
    action('Open this design', 'Open', open),
    action('Draw this design together with the current one', 'Compare', compare),
    ...(snapshot.isOfFile
      ? []
      : [
          action('Write this design to the model file, as an entry of [designs]', 'Write', write),
          action('Delete this design', 'Delete', remove),
        ]),
  ]
  if (snapshot.isOfFile) {
    field.readOnly = true
    field.title = 'A design of the model’s text: [designs]'
  }
  actions[1].setAttribute('aria-pressed', String(isCompared))
  const label = () => {
    field.value = snapshot.name
    field.setAttribute('aria-label', `Name of ${snapshot.name}`)
    for (const one of actions) one.setAttribute('aria-label', `${one.title}: ${snapshot.name}`)
  }
  label()
  return el('li', {}, field, ...actions)
}
