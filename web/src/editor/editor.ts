import {
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  type CompletionContext,
  type CompletionResult,
  completionKeymap,
} from '@codemirror/autocomplete'
import {
  defaultKeymap,
  history,
  historyKeymap,
  indentWithTab,
  redo,
  redoDepth,
  toggleComment,
  undo,
  undoDepth,
} from '@codemirror/commands'
import { bracketMatching, indentUnit } from '@codemirror/language'
import { lintGutter, nextDiagnostic, previousDiagnostic, setDiagnostics } from '@codemirror/lint'
import { highlightSelectionMatches, openSearchPanel, search, searchKeymap } from '@codemirror/search'
import { Annotation, EditorState, type Extension, type Transaction } from '@codemirror/state'
import {
  drawSelection,
  dropCursor,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  keymap,
  lineNumbers,
  type Rect,
} from '@codemirror/view'
import { el, prose } from '../dom'
import type { Checker, Diagnostic } from '../engine/engine'
import { changes } from './changes'
import { type Schema, suggest } from './complete'
import { toml } from './language'
import { counted, mark, placeOf, messageElements } from './messages'
import { theme } from './theme'

/** Milliseconds without a change after which a text is checked. */
const PAUSE = 250
/** Milliseconds within which typing on is one step of undo. */
const STEP = 500
/** Maximum number of requests of a check that fails: its worker may have been ended for another request. */
const TRIES = 3
/** Messages that are listed; the status counts all. */
const LISTED = 100

export interface Options {
  text: string
  check: Checker
  /** A text that was typed is valid: the page can show it. */
  onValid: (text: string) => void
  /** The text was changed: it may be valid or not. */
  onEdit?: () => void
  /** Schema of the file, for the completion of keys and words. */
  schema?: Schema
}

/** The model's text, checked while it is typed. */
export interface Editor {
  readonly element: HTMLElement
  /** Present text, valid or not. */
  readonly text: string
  /** Present text, unless the page shows it: it has errors, or is not checked yet. */
  readonly unshown: string | undefined
  /**
   * Puts another text in its place, valid and shown by the page already, by the smallest change: the cursor, what is
   * seen and the steps of undo stay. It is one step, or part of the one before where that came from outside too
   * (`sameStep`), as in a drag.
   */
  setText(text: string, sameStep?: boolean): void
  /** Adds what solving the text reported to what checking it reported; until it changes. */
  showMessages(messages: Diagnostic[]): void
  /** Puts the cursor at a line and column, both from 1, the column in characters, and shows it. */
  reveal(line: number, column: number): void
  focus(): void
  /** Takes it away for good. */
  destroy(): void
}

/** Mark of a change that was not typed; true if it continues the one before. */
const outside = Annotation.define<{ sameStep: boolean }>()

/** Makes the pane of the model's text; put its element into the page before it is given the focus. */
export function editor({ text, check, onValid, onEdit, schema }: Options): Editor {
  let lineBreak = lineBreakOf(text)
  /** The text that the page shows: the last valid one. */
  let shown = ''
  /** Diagnostics of the present text: from the check, and from solving it. */
  let checked: Diagnostic[] = []
  let solved: Diagnostic[] = []
  let waiting: ReturnType<typeof setTimeout> | undefined
  /** Counts the changes, so that a check of a former text is ignored. */
  let version = 0

  const status = el('p', { class: 'model-status', role: 'status', 'data-testid': 'model-status' })
  const list = el('ul', {
    class: 'model-messages',
    'aria-label': 'Messages about the model',
    'data-testid': 'model-messages',
  })
  const { element: tools, back, forth } = toolbar(() => view, status)
  const view = new EditorView({
    state: EditorState.create({
      doc: text,
      extensions: [
        editing(schema),
        undoHistory(),
        EditorView.updateListener.of(({ docChanged }) => {
          back.disabled = undoDepth(view.state) === 0
          forth.disabled = redoDepth(view.state) === 0
          if (docChanged) later()
        }),
      ],
    }),
  })
  const present = () => view.state.doc.toString().replaceAll('\n', lineBreak)

  const later = () => {
    version++
    solved = []
    element.setAttribute('aria-busy', 'true')
    clearTimeout(waiting)
    waiting = setTimeout(() => void examine(), PAUSE)
    onEdit?.()
  }
  const examine = async (tries = TRIES) => {
    const [mine, text] = [version, present()]
    try {
      const found = await check.check(text)
      if (mine !== version) return
      checked = found
    } catch (error) {
      if (mine !== version) return
      if (tries > 1) {
        waiting = setTimeout(() => void examine(tries - 1), PAUSE)
        return
      }
      checked = [failure(error)]
    }
    element.setAttribute('aria-busy', 'false')
    const valid = !checked.some(isError)
    const other = valid && text !== shown
    if (valid) shown = text
    render()
    if (other) onValid(text)
  }
  const render = () => {
    const messages = [...checked, ...solved]
    view.dispatch(
      setDiagnostics(
        view.state,
        messages.map((message) => mark(view.state.doc, message)),
      ),
    )
    const count = counted(messages)
    const stale = checked.some(isError)
    status.classList.toggle('stale', stale)
    status.textContent = stale ? `${count}. The page shows the last valid model.` : count
    list.replaceChildren(
      ...messages
        .slice(0, LISTED)
        .map((message) => el('li', { class: message.severity }, messageEntry(message, reveal))),
      ...(messages.length > LISTED ? [el('li', {}, `and ${messages.length - LISTED} more`)] : []),
    )
    list.hidden = messages.length === 0
  }
  const reveal = (line: number, column: number) => {
    const at = placeOf(view.state.doc, line, column)
    view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: 'center' }) })
    view.focus()
  }

  const element = el(
    'section',
    { class: 'model', 'aria-label': 'Model', 'data-testid': 'model-pane' },
    tools,
    el('div', { class: 'model-text' }, view.dom),
    list,
  )
  shown = present()
  back.disabled = forth.disabled = true
  list.hidden = true
  void examine()
  return {
    element,
    get text() {
      return present()
    },
    get unshown() {
      const text = present()
      return text === shown ? undefined : text
    },
    setText: (text, sameStep = false) => {
      lineBreak = lineBreakOf(text)
      const made = changes(view.state.doc.toString().split('\n'), text.split(/\r\n?|\n/))
      if (made.length > 0) view.dispatch({ changes: made, annotations: outside.of({ sameStep }) })
      shown = present()
      onEdit?.()
    },
    showMessages: (messages) => {
      solved = messages
      render()
    },
    reveal,
    focus: () => view.focus(),
    destroy: () => {
      clearTimeout(waiting)
      version++
      view.destroy()
      element.remove()
    },
  }
}

/** Buttons for the text, with the status of its check. */
function toolbar(view: () => EditorView, status: HTMLElement) {
  const button = (name: string, title: string, run: (view: EditorView) => void) =>
    el(
      'button',
      {
        type: 'button',
        title,
        'data-testid': `model-${name.toLowerCase()}`,
        onclick: () => (run(view()), view().focus()),
      },
      name,
    )
  const back = button('Undo', 'Undo typing (Ctrl+Z)', undo)
  const forth = button('Redo', 'Redo typing (Ctrl+Y)', redo)
  const find = el(
    'button',
    {
      type: 'button',
      title: 'Find and replace (Ctrl+F)',
      'data-testid': 'model-find',
      onclick: () => openSearchPanel(view()),
    },
    'Find',
  )
  const element = el(
    'div',
    { class: 'model-tools', role: 'toolbar', 'aria-label': 'Model text' },
    back,
    forth,
    button('Comment', 'Comment or uncomment lines (Ctrl+/)', toggleComment),
    button('Next', 'Next message (F8)', nextDiagnostic),
    find,
    status,
  )
  return { element, back, forth }
}

/** Editing of TOML with completion, keys and accessible focus. */
function editing(schema: Options['schema']): Extension {
  return [
    lineNumbers(),
    highlightActiveLineGutter(),
    lintGutter(),
    highlightSpecialChars(),
    drawSelection(),
    dropCursor(),
    highlightActiveLine(),
    EditorState.allowMultipleSelections.of(true),
    indentUnit.of('  '),
    bracketMatching(),
    closeBrackets(),
    highlightSelectionMatches(),
    search({ top: true }),
    autocompletion({ override: [(context) => complete(context, schema)], icons: false, positionInfo: beside }),
    toml(),
    theme(),
    keymap.of([
      { key: 'F8', run: nextDiagnostic, shift: previousDiagnostic },
      ...closeBracketsKeymap,
      ...completionKeymap,
      ...searchKeymap,
      ...historyKeymap,
      ...defaultKeymap,
      indentWithTab,
      // Only where it closes nothing.
      { key: 'Escape', run: (view) => (view.setTabFocusMode(true), false) },
    ]),
    EditorView.contentAttributes.of({
      'aria-label': 'Model, TOML. Press Escape, then Tab to leave the text.',
      'data-testid': 'model-text',
      tabindex: '0',
      spellcheck: 'false',
    }),
    // The Tab key continues to move the focus for those who came by it; typing or clicking into the text edits it.
    EditorView.domEventHandlers({
      focus: (_, view) => view.setTabFocusMode(true),
      pointerup: (_, view) => view.setTabFocusMode(false),
      keydown: ({ key }, view) => {
        if (!['Escape', 'Tab', 'Shift'].includes(key)) view.setTabFocusMode(false)
      },
    }),
  ]
}

/**
 * Undo history: adjacent typing within a short time is one step; a change from outside joins the previous one where
 * that is requested.
 */
function undoHistory(): Extension {
  let before: { outside: boolean; time: number } = { outside: false, time: -Infinity }
  const joins = (transaction: Transaction, adjacent: boolean): boolean => {
    const foreign = transaction.annotation(outside)
    return foreign ? foreign.sameStep && before.outside : adjacent && !before.outside && Date.now() - before.time < STEP
  }
  return [
    history({ newGroupDelay: Infinity, joinToEvent: joins }),
    EditorView.updateListener.of(({ docChanged, transactions }) => {
      if (docChanged) before = { outside: transactions.some((one) => one.annotation(outside)), time: Date.now() }
    }),
  ]
}

/** A message of the list; a click goes to its place, where it has one. */
function messageEntry(message: Diagnostic, reveal: (line: number, column: number) => void): HTMLElement {
  const { line, column } = message
  if (line === null) return el('div', {}, ...messageElements(message))
  return el(
    'button',
    { type: 'button', class: 'plain', onclick: () => reveal(line, column ?? 1) },
    el('span', { class: 'line' }, `line ${line}`),
    el('span', {}, ...messageElements(message)),
  )
}

const isError = ({ severity }: Diagnostic) => severity === 'error'

function lineBreakOf(text: string): string {
  return text.includes('\r\n') ? '\r\n' : '\n'
}

/** Diagnostic for a failure of the check itself. */
function failure(error: unknown): Diagnostic {
  const message = `the text could not be checked: ${error instanceof Error ? error.message : String(error)}`
  return {
    severity: 'error',
    code: '',
    message,
    file: null,
    line: null,
    column: null,
    length: null,
    element: null,
    label: null,
    notes: [],
    help: null,
  }
}

/** Longer texts are read through for a completion only when it is requested, characters. */
const LONG = 200_000

function complete({ state, pos, explicit }: CompletionContext, schema?: Schema): CompletionResult | null {
  if (state.doc.length > LONG && !explicit) return null
  const found = suggest(state.doc.toString(), pos, schema)
  if (!found || (!explicit && found.from === pos && state.sliceDoc(pos - 1, pos) !== '"')) return null
  const options = found.suggestions.map(({ label, insert, detail, about }) => ({
    label,
    apply: insert,
    detail,
    info: about === undefined ? undefined : () => el('p', {}, ...prose(about)),
  }))
  return { from: found.from, options, validFor: /^[\w-]*$/ }
}

/** The description of a word is below or above the list of words, so that it hides none of them. */
function beside(_: EditorView, list: Rect, __: Rect, info: Rect, space: Rect): { style: string } {
  const fits = list.bottom + info.bottom - info.top <= space.bottom
  return { style: `left: 0; ${fits ? 'top' : 'bottom'}: calc(100% + 2px)` }
}
