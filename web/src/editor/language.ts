import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language'
import type { Extension } from '@codemirror/state'
import { tags } from '@lezer/highlight'
import { piece, type Reading, start } from './toml'

/** TOML as the editor knows it: colours, comments and brackets. */
export function toml(): Extension {
  const language = StreamLanguage.define<Reading>({
    name: 'toml',
    startState: start,
    copyState: (reading) => ({ ...reading }),
    token: (stream, reading) => {
      const [kind, to] = piece(stream.string, stream.pos, reading)
      stream.pos = to
      return kind ?? null
    },
    tokenTable: { heading: tags.heading, key: tags.propertyName, atom: tags.atom, bracket: tags.bracket },
    languageData: { commentTokens: { line: '#' }, closeBrackets: { brackets: ['[', '{', '"'] } },
  })
  const colours = HighlightStyle.define([
    { tag: tags.comment, color: 'var(--muted)', fontStyle: 'italic' },
    { tag: tags.heading, color: 'var(--accent)', fontWeight: '650' },
    { tag: tags.propertyName, color: 'var(--ink)' },
    { tag: tags.string, color: 'var(--code-text)' },
    { tag: tags.number, color: 'var(--code-number)' },
    { tag: tags.atom, color: 'var(--code-number)' },
    { tag: tags.bracket, color: 'var(--muted)' },
  ])
  return [language, syntaxHighlighting(colours)]
}
