import type { Curve } from '../curve'

/** A curve that was read from a file. */
export interface Measured {
  label: string
  x: Curve
  y: Curve
}

/** Quantity of a plot that a column may hold. */
export interface MeasuredQuantity {
  name: string
  unit: string
}

/** Units by dimension, with their factors to the first. */
const UNITS: Record<string, number>[] = [
  { N: 1, kN: 1000, lbf: 4.4482216152605 },
  { 'N*m': 1, Nm: 1, 'kN*m': 1000, kNm: 1000, 'N*mm': 0.001, Nmm: 0.001 },
  { mm: 1, cm: 10, m: 1000, in: 25.4 },
  { deg: 1, '°': 1, rad: 180 / Math.PI },
  { s: 1, ms: 0.001 },
]

/** Separators of columns, the first that is found in the heading counts. */
const SEPARATORS = [';', '\t', ',']

/**
 * Curves of a file of comma-separated values for a plot of some quantities over another one, or over time: columns by
 * their names, else the first two columns. An error says what is missing.
 */
export function measuredOf(
  text: string,
  file: string,
  { quantities, over }: { quantities: readonly MeasuredQuantity[]; over: MeasuredQuantity },
): Measured[] {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== '' && !line.startsWith('#'))
  const separator = SEPARATORS.find((one) => lines[0]?.includes(one)) ?? ','
  const rows = lines.map((line) => cells(line, separator))
  const hasHeading = rows[0]?.some((cell) => cell !== '' && Number.isNaN(numberOf(cell, separator)))
  const titles = hasHeading ? rows.shift()! : []
  const heading = titles.map(nameOf)
  const [{ name: first }] = quantities
  const width = Math.max(0, ...rows.map((row) => row.length))
  if (width < 2 || rows.length < 1)
    throw new Error(`\`${file}\` needs two columns of numbers: ${over.name} and ${first}`)
  const column = (k: number, of: MeasuredQuantity) => {
    const factor = factorOf(titles[k] ?? '', of, file)
    return Float32Array.from(rows, (row) => numberOf(row[k] ?? '', separator) * factor)
  }
  const x = Math.max(0, heading.indexOf(over.name))
  const named = quantities.flatMap((of) => (heading.includes(of.name) ? [{ of, k: heading.indexOf(of.name) }] : []))
  const found = named.length > 0 ? named : [{ of: quantities[0], k: x === 0 ? 1 : 0 }]
  const abscissa = column(x, over)
  const curves = found.map(({ of, k }) => ({ label: `${of.name}, ${file}`, x: abscissa, y: column(k, of) }))
  if (curves.every(({ x, y }) => !y.some((value, k) => Number.isFinite(value + x[k]))))
    throw new Error(`\`${file}\` has no numbers in its columns for ${over.name} and ${first}`)
  return curves
}

function cells(line: string, separator: string): string[] {
  return line.split(separator).map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'))
}

/** A decimal comma is read where the comma separates no columns. */
function numberOf(cell: string, separator: string): number {
  const text = separator === ',' ? cell : cell.replace(',', '.')
  return text.trim() === '' ? NaN : Number(text.replace('−', '-'))
}

/** Factor from the unit of a heading, such as `side [kN]`, to that of the quantity; 1 for a heading without a unit. */
function factorOf(title: string, { name, unit }: MeasuredQuantity, file: string): number {
  const written = /[[(]\s*([^\])]+?)\s*[\])]/.exec(title)?.[1].replace(/\s|·/g, '*').replace(/\*+/g, '*')
  if (written === undefined || written === unit) return 1
  const known = UNITS.find((units) => written in units)
  // Other words in brackets are no unit.
  if (!known) return 1
  if (!(unit in known)) throw new Error(`\`${title}\` of \`${file}\` is no ${unit || 'plain number'}, as ${name} is`)
  return known[written] / known[unit]
}

/** `toe` of `toe [deg]` and `toe (deg)`. */
function nameOf(cell: string): string {
  return cell.replace(/\s*[[(].*$/, '').trim()
}
