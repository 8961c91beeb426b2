import type { Diagnostic as Mark } from '@codemirror/lint'
import type { Text } from '@codemirror/state'
import { el, prose } from '../dom'
import type { Diagnostic } from '../engine/engine'

/** Range in a text, in the editor's positions. */
export interface Span {
  from: number
  to: number
}

/** Number of characters from a place on, in the editor's count of UTF-16 units; within the text. */
function ahead(text: string, characters: number): number {
  let at = 0
  for (let k = 0; k < characters && at < text.length; k++) at += text.codePointAt(at)! > 0xffff ? 2 : 1
  return at
}

/** The place of a line and column, both from 1, the column in characters; the nearest there is. */
export function placeOf(doc: Text, line: number, column: number): number {
  const { from, text } = doc.line(Math.min(Math.max(line, 1), doc.lines))
  return from + ahead(text, column - 1)
}

/** Range that a message underlines: its place, or else the line. */
export function spanOf(doc: Text, { line, column, length }: Diagnostic): Span | undefined {
  if (line === null) return undefined
  const whole = doc.line(Math.min(line, doc.lines))
  if (column === null) return { from: whole.from, to: whole.to }
  const from = placeOf(doc, line, column)
  const to = from + ahead(doc.sliceString(from, from + 2 * (length ?? 1)), length ?? 1)
  return { from, to: Math.max(from, to) }
}

const WORDS = { error: 'error', warning: 'warning', note: 'note' } as const

/** A message as the editor marks it; of one about the text as a whole, its beginning. */
export function mark(doc: Text, message: Diagnostic): Mark {
  const { from, to } = spanOf(doc, message) ?? { from: 0, to: 0 }
  return {
    from,
    to,
    severity: message.severity === 'note' ? 'info' : message.severity,
    message: message.message,
    renderMessage: () => el('div', { class: 'message-tip' }, ...messageElements(message)),
  }
}

/** All that a message says. */
export function messageElements({ severity, code, message, label, notes, help }: Diagnostic): HTMLElement[] {
  return [
    el(
      'p',
      {},
      el('b', { class: severity }, `${WORDS[severity]} `),
      ...prose(message),
      ' ',
      el('span', { class: 'code' }, code),
    ),
    ...(label ? [el('p', { class: 'aside' }, ...prose(label))] : []),
    ...notes.map((note) => el('p', { class: 'aside' }, ...prose(note))),
    ...(help ? [el('p', { class: 'aside' }, el('b', {}, 'help '), ...prose(help))] : []),
  ]
}

/** `2 errors, 1 warning`; empty if there are none. */
export function counted(messages: readonly Diagnostic[]): string {
  const some = (severity: Diagnostic['severity']) => {
    const count = messages.filter((message) => message.severity === severity).length
    return count === 0 ? [] : [`${count} ${WORDS[severity]}${count === 1 ? '' : 's'}`]
  }
  return [...some('error'), ...some('warning'), ...some('note')].join(', ')
}
