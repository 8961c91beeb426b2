/** Kind of a piece of TOML; undefined for spaces and punctuation without a meaning of their own. */
export type Kind = 'comment' | 'heading' | 'key' | 'string' | 'number' | 'atom' | 'bracket' | undefined

/** State of a reader of TOML at the start of a line, or within it. */
export interface Reading {
  /** The quotes that a text over several lines waits for. */
  quotes: string
  /** The brackets that are open in a value, outermost first. */
  open: string
  /** True if a key comes next, or a table's heading where no bracket is open. */
  key: boolean
}

export const start = (): Reading => ({ quotes: '', open: '', key: true })

const SPACE = /\s+/y
const COMMENT = /#.*/y
/** A heading with its keys; one that is not closed ends with its line. */
const HEADING = /\[\[?(?:"(?:\\.|[^"\\])*"|'[^']*'|[^\]"'#])*\]{0,2}/y
/** A line that can be nothing but a heading, whatever bracket was left open above. */
const CERTAIN_HEADING = /^\[\[?[A-Za-z_](?:"(?:\\.|[^"\\])*"|'[^']*'|[^\]"',])*\]\]?\s*(?:#.*)?$/
const LONG = /"""|'''/y
/** A text on one line; one that is not closed ends with the line. */
const SHORT = /"(?:\\.|[^"\\])*"?|'[^']*'?/y
const BARE = /[A-Za-z0-9_-]+/y
const NUMBER = /[+-]?(?:\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d+)?|0x[\da-fA-F_]+|0o[0-7_]+|0b[01_]+)(?![\w:-])/y
const WORD = /[^\s,\]}#"'=[{]+/y

/** The token of a line that begins at `at`, and its end; `reading` continues. */
export function piece(line: string, at: number, reading: Reading): [kind: Kind, to: number] {
  const end = (pattern: RegExp) => ((pattern.lastIndex = at), pattern.test(line) ? pattern.lastIndex : 0)
  if (at === 0 && reading.quotes === '' && (reading.open === '' || CERTAIN_HEADING.test(line)))
    Object.assign(reading, start())
  if (reading.quotes !== '') return ['string', closing(line, at, reading)]
  const { key, open } = reading
  let to: number
  if ((to = end(SPACE))) return [undefined, to]
  if ((to = end(COMMENT))) return ['comment', to]
  if (key && open === '' && (to = end(HEADING))) return ['heading', to]
  if (key && (to = end(SHORT) || end(BARE))) return ['key', to]
  if (!key && (to = end(LONG))) {
    reading.quotes = line.slice(at, to)
    return ['string', closing(line, to, reading)]
  }
  if (!key && (to = end(SHORT))) return ['string', to]
  if (!key && (to = end(NUMBER))) return ['number', to]
  const mark = line[at]
  if (mark === '=') reading.key = false
  else if (mark === ',') reading.key = open.endsWith('{')
  else if ('[{'.includes(mark)) Object.assign(reading, { open: open + mark, key: mark === '{' })
  else if (']}'.includes(mark)) Object.assign(reading, { open: open.slice(0, -1), key: false })
  else return !key && (to = end(WORD)) ? ['atom', to] : [undefined, at + 1]
  return ['[]{}'.includes(mark) ? 'bracket' : undefined, at + 1]
}

/** End on this line of a text over several lines, from `at`. */
function closing(line: string, at: number, reading: Reading): number {
  for (let k = at; k < line.length; k++) {
    if (line[k] === '\\' && reading.quotes === '"""') k++
    else if (line.startsWith(reading.quotes, k)) {
      // Up to two more quotes belong to the text.
      let to = k + 3
      while (to < k + 5 && line[to] === reading.quotes[0]) to++
      reading.quotes = ''
      return to
    }
  }
  return line.length
}

/** The parts of a key such as `measures."front toe".type`. */
export function parts(key: string): string[] {
  return [...key.matchAll(/"((?:\\.|[^"\\])*)"?|'([^']*)'?|([A-Za-z0-9_-]+)/g)].map(
    ([, double, single, bare]) => double?.replace(/\\(["\\])/g, '$1') ?? single ?? bare,
  )
}

/** A name as a key is written: in quotes where it has to be. */
export function quoted(name: string): string {
  return /^[A-Za-z0-9_-]+$/.test(name) ? name : text(name)
}

/** A text as a value. */
export function text(value: string): string {
  // JSON's escapes are some of TOML's.
  return JSON.stringify(value)
}

/** An entry of a text: the heading of a table, or a key with its value. */
export interface Entry {
  /** From the root: `[metrics.bump]` and `at = 5` in it are `metrics bump` and `metrics bump at`. */
  path: string[]
  heading: boolean
  /** Nesting depth of a key in brackets. */
  depth: number
  from: number
  /** The end of the heading, or of the key. */
  to: number
  /** The end of all that belongs to it; of a heading, of the last entry below it. */
  end: number
}

/** Entries of a text, in order; the text need not be valid. */
export function outline(source: string): Entry[] {
  return read(source).entries
}

/** Entry that is about to be written at the end of a text. */
export interface CursorContext {
  /** The table that it belongs to. */
  table: string[]
  /** The path of the key whose value it is, or part of it; none where a key is being written. */
  key?: string[]
  /** The text in quotes, the key, or the word that has been begun. */
  begun: string
  /** True if that is in quotes that are not closed. */
  quoted: boolean
  /** True if it is part of a heading. */
  heading: boolean
}

/** State of a writer at the end of a text; undefined in a comment, or in a text over several lines. */
export function cursorContext(source: string): CursorContext | undefined {
  const { table, around, key, reading, last, kind } = read(source)
  if (kind === 'comment' || reading.quotes !== '') return undefined
  const open = around.at(-1)
  const word = /^\s*$/.test(last) || '=,[{'.includes(last) ? '' : last
  const inQuotes = kind === 'string' && /^"(?:\\.|[^"\\])*$|^'[^']*$/.test(word)
  if ((kind === 'string' && !inQuotes) || kind === 'number' || /^[}\]]$/.test(word)) return undefined
  const begun = inQuotes ? word.slice(1) : word
  const within = { begun, quoted: inQuotes, heading: kind === 'heading' }
  if (kind === 'heading') return { ...within, table: [] }
  if (reading.key)
    return { ...within, table: (key ? key.path : [...(open?.path ?? table?.path ?? []), '']).slice(0, -1) }
  const of = key ?? open
  return of && { ...within, table: of.path.slice(0, -1), key: of.path }
}

function read(source: string) {
  const entries: Entry[] = []
  const reading = start()
  let table: Entry | undefined
  /** The entries whose values are being read, outermost first. */
  let around: (Entry | undefined)[] = []
  /** The key that is being read, part by part, or whose value is. */
  let key: Entry | undefined
  let kind: Kind
  let last = ''
  let offset = 0
  for (const line of source.split('\n')) {
    if (reading.open === '' && reading.quotes === '') (key = undefined), (around = [])
    ;[kind, last] = [undefined, '']
    for (let at = 0, to = 0; at < line.length; at = to) {
      const before = reading.open.length
      ;[kind, to] = piece(line, at, reading)
      last = line.slice(at, to)
      const [from, end] = [offset + at, offset + to]
      if (kind === 'heading') {
        ;[around, key] = [[], undefined]
        table = { path: parts(last), heading: true, depth: 0, from, to: end, end }
        entries.push(table)
      } else if (kind === 'key') {
        const within = around.at(-1)?.path ?? table?.path ?? []
        if (key) key.path.push(...parts(last))
        else
          entries.push(
            (key = {
              path: [...within, ...parts(last)],
              heading: false,
              depth: reading.open.length,
              from,
              to: end,
              end,
            }),
          )
        key.to = key.end = end
      } else if (reading.open.length > before) {
        around.push(key ?? around.at(-1))
        key = undefined
      } else if (reading.open.length < before) {
        key = around.pop()
      } else if (last === ',') key = undefined
      if (kind !== 'comment' && last.trim() !== '')
        for (const one of [table, key, ...around]) if (one) one.end = Math.max(one.end, end)
    }
    offset += line.length + 1
  }
  return { entries, reading, table, around, key, kind, last }
}

/** Names that a text declares in one of its tables, such as `hardpoints`. */
export function namesIn(entries: Entry[], table: string): string[] {
  return [...new Set(entries.filter(({ path }) => path[0] === table && path.length > 1).map(({ path }) => path[1]))]
}
