import type { Curve } from '../curve'

/** A curve that was read from a file. */
export interface Measured {
  label: string
  x: Curve
  y: Curve
}

/** Separators of columns, the first that is found in the heading counts. */
const SEPARATORS = [';', '\t', ',']

/**
 * Curves of a file of comma-separated values for a plot of some quantities over another one, or over time: columns by
 * their names, else the first two columns. An error says what is missing.
 */
export function measuredOf(
  text: string,
  file: string,
  { names, over }: { names: readonly string[]; over: string },
): Measured[] {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== '' && !line.startsWith('#'))
  const separator = SEPARATORS.find((one) => lines[0]?.includes(one)) ?? ','
  const rows = lines.map((line) => cells(line, separator))
  const hasHeading = rows[0]?.some((cell) => cell !== '' && Number.isNaN(numberOf(cell, separator)))
  const heading = hasHeading ? rows.shift()!.map(nameOf) : []
  const width = Math.max(0, ...rows.map((row) => row.length))
  if (width < 2 || rows.length < 1) throw new Error(`\`${file}\` needs two columns of numbers: ${over} and ${names[0]}`)
  const column = (k: number) => Float32Array.from(rows, (row) => numberOf(row[k] ?? '', separator))
  const x = Math.max(0, heading.indexOf(over))
  const named = names.flatMap((name) => (heading.indexOf(name) >= 0 ? [{ name, k: heading.indexOf(name) }] : []))
  const found = named.length > 0 ? named : [{ name: names[0], k: x === 0 ? 1 : 0 }]
  const abscissa = column(x)
  const curves = found.map(({ name, k }) => ({ label: `${name}, ${file}`, x: abscissa, y: column(k) }))
  if (curves.every(({ x, y }) => !y.some((value, k) => Number.isFinite(value + x[k]))))
    throw new Error(`\`${file}\` has no numbers in its columns for ${over} and ${names[0]}`)
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

/** `toe` of `toe [deg]` and `toe (deg)`. */
function nameOf(cell: string): string {
  return cell.replace(/\s*[[(].*$/, '').trim()
}
