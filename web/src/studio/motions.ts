import { outline, quoted } from '../editor/toml'
import { moverOf } from '../page/contents'
import type { Report } from '../report'
import { hasOneFreedom, isTravel } from '../sheet'

/** A text with its cases, the first of which is to be shown. */
export interface SeparateMotions {
  text: string
  first: string
}

/**
 * Adds a case for each driver of a text, in which that driver alone moves, and one in which all move as before: over
 * wheel travel, curves are then lines instead of loops. The driver that moves the wheel most comes first. Undefined for
 * a motion with one degree of freedom, without wheel travel, or with laws that are not written in one line.
 */
export function separateMotions(text: string, report: Report): SeparateMotions | undefined {
  const travel = report.quantities.find(isTravel)
  if (!travel || hasOneFreedom(report)) return undefined
  const entries = outline(text)
  const isMirrored = entries.some(({ path }) => path[0] === 'mirror')
  const laws = new Map<string, string>()
  const mover = moverOf(report, travel.index)?.name
  const drivers = [...report.drivers].sort((a, b) => Number(b.name === mover) - Number(a.name === mover))
  for (const { name } of drivers) {
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
  return { text: `${text.trimEnd()}\n${[...laws.values(), all].join('')}`, first: [...laws.keys()][0] }
}
