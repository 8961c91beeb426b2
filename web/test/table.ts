import { readFileSync } from 'node:fs'

/** Reads a CSV table into columns by their headings; cells without a number are NaN. */
export function table(text: string): Map<string, number[]> {
  const [header, ...rows] = text.trim().split(/\r?\n/).map(cells)
  return new Map(header.map((name, k) => [name, rows.map((row) => (row[k] === '' ? NaN : Number(row[k])))]))
}

/** The cells of a line; quoted ones may hold commas. */
function cells(line: string): string[] {
  return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map(
    ([, quoted, plain]) => quoted?.replaceAll('""', '"') ?? plain,
  )
}

/** The motion that the command wrote next to a report: columns by their names without units. */
export function motionBeside(report: string): Map<string, number[]> {
  const columns = table(readFileSync(new URL('motion.csv', report), 'utf8'))
  return new Map([...columns].map(([heading, values]) => [heading.replace(/ \[[^\]]*\]$/, ''), values]))
}
