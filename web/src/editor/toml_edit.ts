import { type Entry, outline, quoted } from './toml'

/**
 * Sets a key of a table of a text, in the style of what is there; `value` is written as it is, and undefined removes
 * the key. All else of the text stays as it is.
 */
export function setKey(text: string, table: readonly string[], key: string, value: string | undefined): string {
  const lineBreak = text.includes('\r\n') ? '\r\n' : '\n'
  const put = (at: number, piece: string, until = at) =>
    text.slice(0, at) + piece.replaceAll('\n', lineBreak) + text.slice(until)
  const entries = outline(text)
  const whole = [...table, key]
  const present = entries.find(({ path, heading }) => !heading && same(path, whole))
  if (present) return value === undefined ? without(text, present) : put(present.to, ` = ${value}`, present.end)
  const section = entries.find(({ path, heading }) => heading && same(path, whole))
  if (section) return setKey(text.slice(0, section.from) + text.slice(endOfLine(text, section.end)), table, key, value)
  if (value === undefined) return text

  const pair = `${quoted(key)} = ${value}`
  const heading = entries.find((entry) => entry.heading && same(entry.path, table))
  if (heading) return put(endOfLine(text, heading.end), `\n${pair}`)
  // A table on one line, or one of the tables around it.
  const inline = entries.findLast(
    ({ path, heading, end }) => !heading && text[end - 1] === '}' && same(path, table.slice(0, path.length)),
  )
  if (inline) {
    const rest = table.slice(inline.path.length)
    const isEmpty = !entries.some(({ from, depth }) => from > inline.to && from < inline.end && depth > inline.depth)
    const at = text.slice(0, inline.end - 1).trimEnd().length
    return put(at, `${isEmpty ? ' ' : ', '}${[...rest.map(quoted), pair].join('.')} `, inline.end - 1)
  }
  // Dotted keys such as `goals.toe = 1` below `[optimize]`.
  const dotted = entries.findLast(
    ({ path, heading, depth }) =>
      !heading && depth === 0 && path.length > table.length && same(path.slice(0, table.length), table),
  )
  const owner = dotted && entries.findLast(({ heading, from }) => heading && from < dotted.from)
  if (dotted && (owner?.path.length ?? 0) < table.length) {
    const below = table.slice(owner?.path.length ?? 0)
    return put(endOfLine(text, dotted.end), `\n${[...below.map(quoted), pair].join('.')}`)
  }
  const related = entries.findLast(({ path, heading }) => heading && path[0] === table[0])
  const block = `[${table.map(quoted).join('.')}]\n${pair}`
  if (related) return put(endOfLine(text, related.end), `\n\n${block}`)
  const at = text.trimEnd().length
  return put(at, `${at === 0 ? '' : '\n\n'}${block}${text.length > at ? '' : '\n'}`)
}

function same(a: readonly string[], b: readonly string[]): boolean {
  return a.length === b.length && a.every((part, k) => part === b[k])
}

/** End of the line at a place, before its line break. */
export function endOfLine(text: string, at: number): number {
  const next = text.indexOf('\n', at)
  if (next < 0) return text.length
  return text[next - 1] === '\r' ? next - 1 : next
}

/** The text without an entry: its line, or its part of a table on one line. */
function without(text: string, { from, end, depth }: Entry): string {
  if (depth === 0) {
    const next = text.indexOf('\n', end)
    return text.slice(0, text.lastIndexOf('\n', from) + 1) + (next < 0 ? '' : text.slice(next + 1))
  }
  const after = /^\s*,\s*/.exec(text.slice(end))
  if (after) return text.slice(0, from) + text.slice(end + after[0].length)
  return text.slice(0, from).replace(/,?\s*$/, ' ') + text.slice(end).trimStart()
}
