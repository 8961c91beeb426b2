import type { Curve } from '../curve'
import { conversion } from '../units'

/** A curve that was read from a file. */
export interface Measured {
  label: string
  x: Curve
  y: Curve
}

/** Curves of a file, and a sentence on lines that could not be read; empty if there are none. */
export interface MeasuredCurves {
  curves: Measured[]
  unread: string
}

/** Quantity of a plot that a column may hold. */
export interface MeasuredQuantity {
  name: string
  unit: string
  /** Name of the quantity whose rate this is: a column of that name is it only with a unit that says so. */
  rateOf?: string
}

/** Quantities of the plot that a file is read for. */
export interface MeasuredSubject {
  quantities: readonly MeasuredQuantity[]
  over: MeasuredQuantity
  /** Names of all quantities of the report: a column of one of them, or of time, is no other. */
  known?: readonly string[]
  /** True if columns without these names may be those of the plot. */
  isForUnnamed?: boolean
}

/** Name of time in plots, and its heading in the tables of the program. */
const TIME = 'time'
const TIME_HEADING = 't'

/** Separators of columns, the first that is found in the heading counts. */
const SEPARATORS = [';', '\t', ',']

/**
 * Curves of a file of comma-separated values for a plot of some quantities over another one, or over time: columns by
 * their names, else the first two columns unless these have names of other quantities. An error says what is missing,
 * or which number is not finite.
 */
export function measuredOf(
  text: string,
  file: string,
  { quantities, over, known = [], isForUnnamed = true }: MeasuredSubject,
): MeasuredCurves {
  const numbered = text
    .split(/\r?\n/)
    .map((line, k) => ({ line, number: k + 1 }))
    .filter(({ line }) => line.trim() !== '' && !line.startsWith('#'))
  const lines = numbered.map(({ line }) => line)
  const separator = SEPARATORS.find((one) => lines[0]?.includes(one)) ?? ','
  const rows = lines.map((line) => cells(line, separator))
  const hasHeading = rows[0]?.some((cell) => cell !== '' && Number.isNaN(numberOf(cell, separator)))
  const titles = hasHeading ? rows.shift()! : []
  if (hasHeading) numbered.shift()
  const [{ name: first }] = quantities
  const width = Math.max(0, ...rows.map((row) => row.length))
  if (width < 2 || rows.length < 1)
    throw new Error(`\`${file}\` needs two columns of numbers: ${over.name} and ${first}`)
  // A decimal comma between commas moves the numbers into other columns.
  const isTooLong = (row: string[]) => row.slice(titles.length || 2).some((cell) => cell !== '')
  const column = (k: number, of: MeasuredQuantity) => {
    const factor = factorOf(titles[k] ?? '', of, file)
    return Float32Array.from(rows, (row, line) => {
      const value = isTooLong(row) ? NaN : numberOf(row[k] ?? '', separator) * factor
      if (Math.abs(Math.fround(value)) === Infinity)
        throw new Error(`Line ${numbered[line].number} of \`${file}\`: \`${row[k]}\` is not finite`)
      return value
    })
  }
  const place = (of: MeasuredQuantity) => titles.findIndex((title) => isNamed(title, of))
  const named = quantities.map((of) => ({ of, k: place(of) })).filter(({ k }) => k >= 0)
  const unnamed = (of: MeasuredQuantity, taken: readonly number[]) => {
    const k = [0, 1].find((k) => !taken.includes(k)) ?? -1
    if (k < 0 || !isForUnnamed || [TIME, TIME_HEADING, ...known].includes(nameOf(titles[k] ?? '')))
      throw new Error(
        `\`${file}\` has no column \`${of.name}\`${titles.length > 0 ? `: it has ${titles.join(', ')}` : ''}`,
      )
    return k
  }
  const at = place(over)
  const x =
    at >= 0
      ? at
      : unnamed(
          over,
          named.map(({ k }) => k),
        )
  const found = named.length > 0 ? named : [{ of: quantities[0], k: unnamed(quantities[0], [x]) }]
  const abscissa = column(x, over)
  const curves = found.map(({ of, k }) => ({ label: `${of.name}, ${file}`, x: abscissa, y: column(k, of) }))
  const isRead = (y: Curve, row: number) => Number.isFinite(y[row] + abscissa[row])
  if (!curves.some(({ y }) => y.some((_, row) => isRead(y, row))))
    throw new Error(`\`${file}\` has no numbers in its columns for ${over.name} and ${first}`)
  const isEmpty = (k: number, row: number) => (rows[row][k] ?? '') === ''
  const unread = numbered.filter(
    (_, row) =>
      !curves.some(({ y }) => isRead(y, row)) ||
      curves.some(({ y }, n) => !isRead(y, row) && !isEmpty(found[n].k, row)),
  )
  return { curves, unread: unread.length > 0 ? unreadLines(unread, file) : '' }
}

function unreadLines(lines: readonly { line: string; number: number }[], file: string): string {
  const [{ line, number }] = lines
  const text = `\`${line.trim()}\``
  return lines.length === 1
    ? `Line ${number} of \`${file}\` could not be read: ${text}`
    : `${lines.length} lines of \`${file}\` could not be read. The first is line ${number}: ${text}`
}

function cells(line: string, separator: string): string[] {
  return line.split(separator).map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'))
}

/** A decimal comma is read where the comma separates no columns. */
function numberOf(cell: string, separator: string): number {
  const text = separator === ',' ? cell : cell.replace(',', '.')
  return text.trim() === '' ? NaN : Number(text.replace('−', '-'))
}

/** True for a column of a quantity, by its heading. */
function isNamed(title: string, { name, unit, rateOf }: MeasuredQuantity): boolean {
  const named = nameOf(title)
  if (named === name || (name === TIME && named === TIME_HEADING)) return true
  return named === rateOf && Number.isFinite(conversion(unitIn(title) ?? '', unit))
}

/** Unit of a heading such as `side [kN]`, else of `side (kN)`. */
function unitIn(title: string): string | undefined {
  return (/\[\s*([^\]]+?)\s*\]/.exec(title) ?? /\(\s*(.+?)\s*\)\s*$/.exec(title))?.[1]
}

/** Factor from the unit of a heading to that of the quantity; 1 for a heading without a unit. */
function factorOf(title: string, { name, unit }: MeasuredQuantity, file: string): number {
  const written = unitIn(title)
  if (written === undefined) return 1
  const factor = conversion(written, unit)
  // A word in round brackets may be a remark.
  if (factor === undefined && !title.includes('[') && !/[*/^·²³\d]/.test(written)) return 1
  if (factor === undefined) throw new Error(`\`${title}\` of \`${file}\`: the page has no unit \`${written}\``)
  if (Number.isNaN(factor))
    throw new Error(`\`${title}\` of \`${file}\` is no ${unit || 'plain number'}, as ${name} is`)
  return factor
}

/** `toe` of `toe [deg]` and `toe (deg)`. */
function nameOf(cell: string): string {
  return cell.replace(/\s*[[(].*$/, '').trim()
}
