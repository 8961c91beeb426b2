import type { Curve } from '../curve'
import { titled } from '../format'

/** A column of numbers with its heading. */
export interface Column {
  label: string
  /** Empty or `1` for a pure number. */
  unit: string
  curve: Curve
}

/**
 * Curves side by side as comma-separated values (RFC 4180): a heading with the units, then one row per step; no number,
 * empty field.
 */
export function csvOf(columns: Column[]): Blob {
  return new Blob([csvText(columns)], { type: 'text/csv;charset=utf-8' })
}

/** The text of `csvOf`. */
export function csvText(columns: Column[]): string {
  const rows = Math.max(0, ...columns.map(({ curve }) => curve.length))
  const lines = [columns.map(({ label, unit }) => field(noFormula(titled(label, unit))))]
  for (let k = 0; k < rows; k++) lines.push(columns.map(({ curve }) => decimal(curve[k])))
  return lines.map((cells) => `${cells.join(',')}\r\n`).join('')
}

/** The shortest decimal that reads back as the same single-precision number, which is all that the page holds. */
export function decimal(value: number | undefined): string {
  if (value === undefined || !Number.isFinite(value)) return ''
  for (let digits = 6; digits < 9; digits++) {
    const rounded = Number(value.toPrecision(digits))
    if (Math.fround(rounded) === Math.fround(value)) return String(rounded)
  }
  return String(Number(value.toPrecision(9)))
}

/** A text that spreadsheets do not take for a formula: they do not show the apostrophe. */
export function noFormula(text: string): string {
  return /^[=+\-@\t\r]/.test(text) ? `'${text}` : text
}

function field(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text
}
