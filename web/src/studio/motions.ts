import { outline, quoted } from '../editor/toml'
import { moverOf } from '../page/contents'
import type { Report } from '../report'
import { hasOneFreedom, isTravel } from '../sheet'

/** A text with a case for each driver, in which that driver alone moves, and one in which all move as before. */
export interface SeparateMotions {
  text: string
  /** Lines at the end of the text that are not in the original. */
  added: string
  /** Names of the cases with one moving driver, the first of which is to be shown. */
  names: string[]
}

/**
 * Names of the drivers of a motion with wheel travel, if several move independently; the driver that moves the wheel
 * most comes first. Undefined for other motions, and for those of a model with cases.
 */
export function independentDrivers(report: Report): string[] | undefined {
  const travel = report.quantities.find(isTravel)
  if (!travel || hasOneFreedom(report)) return undefined
  const mover = moverOf(report, travel.index)?.name
  const drivers = [...report.drivers].sort((a, b) => Number(b.name === mover) - Number(a.name === mover))
  return drivers.map(({ name }) => name)
}

/**
 * Adds a case for each of these drivers to a text: over wheel travel, curves are then lines instead of loops. Undefined
 * for a text that has cases, and for laws that are not written in one line.
 */
export function separateMotions(text: string, drivers: readonly string[]): SeparateMotions | undefined {
  if (caseNames(text).length > 0) return undefined
  const entries = outline(text)
  const isMirrored = entries.some(({ path }) => path[0] === 'mirror')
  const laws = new Map<string, string>()
  for (const name of drivers) {
    const law = entries.find(({ path, heading }) => !heading && path.join('\n') === `drivers\n${name}\nlaw`)
    // A mirrored case gives both sides the law of one.
    const title = isMirrored ? name.replace(/(left|right)[_-]?/, '') : name
    if (!law || laws.has(title)) continue
    const value = text.slice(law.to, law.end).replace(/^\s*=\s*/, '')
    if (value.includes('\n')) return undefined
    laws.set(title, `\n[cases.${quoted(title)}]\nlaws = { ${quoted(name)} = ${value} }\n`)
  }
  if (laws.size < 2) return undefined
  const all = '\n[cases.all_drivers]\nother_drivers = "as_in_model"\n'
  const added = [...laws.values(), all].join('')
  return { text: `${text.trimEnd()}\n${added}`, added, names: [...laws.keys()] }
}

/** Names of the cases that a text has. */
export function caseNames(text: string): string[] {
  const names = outline(text).flatMap(({ path: [table, name] }) => (table === 'cases' && name ? [name] : []))
  return [...new Set(names)]
}
