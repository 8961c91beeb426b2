import { type Entry, namesIn, outline, quoted, text as string } from '../editor/toml'
import { endOfLine } from '../editor/toml_edit'

/** A curve that a measure is to follow. */
export interface TargetCurve {
  /** The metric's name; another one is found where it is taken. */
  name: string
  /** The measure, or a coordinate of a point. */
  of: string
  /** The abscissa, time where there is none. */
  over?: string
  /** The case whose motion it is of; every one where there is none. */
  case?: string
  /** With rising abscissas, in the units of the text. */
  points: readonly (readonly [x: number, y: number])[]
}

/**
 * Adds a metric to a model's text: how far a measure is from a curve, where that is drawn. All else of the text stays
 * as it is.
 */
export function targetToml(text: string, curve: TargetCurve): { text: string; name: string } {
  const entries = outline(text)
  const name = free(curve.name, namesIn(entries, 'metrics'))
  const { at, piece } = place(text, entries, name, keysOf(curve))
  const lineBreak = text.includes('\r\n') ? '\r\n' : '\n'
  return { text: text.slice(0, at) + piece.replaceAll('\n', lineBreak) + text.slice(at), name }
}

function keysOf({ case: of, ...curve }: TargetCurve): [key: string, value: string][] {
  const pair = (numbers: readonly number[]) => `[${numbers.join(', ')}]`
  const [first, last] = [curve.points[0], curve.points.at(-1)!]
  return [
    ...(of === undefined ? [] : [['case', string(of)] as [string, string]]),
    ['of', string(curve.of)],
    ...(curve.over === undefined ? [] : [['over', string(curve.over)] as [string, string]]),
    ['take', '"rms"'],
    ['window', pair([first[0], last[0]])],
    ['target', `[${curve.points.map(pair).join(', ')}]`],
  ]
}

/** Place and text of the metric, in the style of the others. */
function place(
  text: string,
  entries: Entry[],
  name: string,
  keys: [key: string, value: string][],
): { at: number; piece: string } {
  const inline = `{ ${keys.map((pair) => pair.join(' = ')).join(', ')} }`
  const headings = entries.filter(({ heading }) => heading)
  const table = `[metrics.${quoted(name)}]\n${keys.map((pair) => pair.join(' = ')).join('\n')}`
  const after = (entry: Entry) => endOfLines(text, entry.end)

  const first = headings[0]?.from ?? text.length
  const atRoot = entries.filter(
    ({ heading, depth, path, from }) => !heading && depth === 0 && path[0] === 'metrics' && from < first,
  )
  const whole = atRoot.find(({ path }) => path.length === 1)
  if (whole && text[whole.end - 1] === '}') {
    // A table on one line ends there, and can go on nowhere else.
    const empty = !entries.some(
      ({ depth, path, from }) => depth === 1 && path[0] === 'metrics' && from > whole.from && from < whole.end,
    )
    const at = text.slice(0, whole.end - 1).trimEnd().length
    return { at, piece: `${empty ? ' ' : ', '}${quoted(name)} = ${inline}${at === whole.end - 1 ? ' ' : ''}` }
  }
  if (atRoot.length > 0) return { at: after(atRoot.at(-1)!), piece: `\nmetrics.${quoted(name)} = ${inline}` }

  const metrics = headings.filter(({ path }) => path[0] === 'metrics')
  const list = metrics.find(({ path }) => path.length === 1)
  if (list) return { at: after(list), piece: `\n${quoted(name)} = ${inline}` }
  const before = metrics.at(-1) ?? headings.findLast(({ path }) => path[0] === 'measures')
  if (before) return { at: after(before), piece: `\n\n${table}` }
  const at = text.trimEnd().length
  return { at, piece: `${at === 0 ? '' : '\n\n'}${table}${text.length > at ? '' : '\n'}` }
}

/**
 * The end of the line at a place, and of the lines with comments that follow it, where they stand with it and not with
 * what comes next.
 */
function endOfLines(text: string, at: number): number {
  const line = endOfLine(text, at)
  const comments = /(?:\r?\n[ \t]*#[^\n]*)*/y
  comments.lastIndex = line
  comments.exec(text)
  const last = endOfLine(text, comments.lastIndex - (text[comments.lastIndex - 1] === '\r' ? 1 : 0))
  return /^$|^\r?\n[ \t]*(?:\r?\n|$)/.test(text.slice(last)) ? last : line
}

/** The name, with a number if it is taken. */
export function free(name: string, taken: string[]): string {
  if (!taken.includes(name)) return name
  for (let k = 2; ; k++) if (!taken.includes(`${name}_${k}`)) return `${name}_${k}`
}
