import { type Entry, namesIn, outline, text as string } from '../editor/toml'
import { setKey } from '../editor/toml_edit'
import { free } from './target'

/** Reductions of a curve to one number that a goal can have, with their names for readers. */
export const TAKES = {
  range: 'range (max − min)',
  max: 'maximum',
  min: 'minimum',
  mean: 'mean',
  rms: 'RMS',
  value: 'value at',
  slope: 'slope at',
} as const
export type Take = keyof typeof TAKES

/** True if a reduction is at a place of the abscissa. */
export function isPlaced(take: Take): boolean {
  switch (take) {
    case 'value':
    case 'slope':
      return true
    case 'range':
    case 'max':
    case 'min':
    case 'mean':
    case 'rms':
      return false
  }
}

/** Number that is judged: a metric of the model, or one that is made of a quantity. */
export type Judged = { metric: string } | { of: string; take: Take; over?: string; at?: number; case?: string }

/** Purpose of the optimisation as far as one number is concerned. */
export type Aim =
  | { kind: 'minimise' }
  | { kind: 'bring'; target: number }
  | { kind: 'keep'; min?: number; max?: number }

/** Variables with their bounds, and goals, that are chosen in a form and may not be in the text. */
export interface Chosen {
  /** Bounds of the change, or of the value of a parameter. */
  variables: readonly { name: string; bounds: readonly [number, number] }[]
  goals: readonly { metric: string; weight: number; target: number | null }[]
}

/**
 * Adds a goal or a limit to a model's text, with the metric that it needs. A model may hold goals only together with
 * variables that have bounds: these are written as well, as they are chosen; as long as there are none, the text gets
 * the metric alone.
 */
export function goalToml(text: string, judged: Judged, aim: Aim, chosen: Chosen): { text: string; name: string } {
  const [made, name] = 'metric' in judged ? [text, judged.metric] : withMetric(text, judged)
  if (!hasGoals(text) && chosen.variables.length === 0) return { text: made, name }
  const bounded = chosen.variables.reduce(
    (text, { name, bounds }) => boundsToml(text, name, bounds, 'value') ?? text,
    made,
  )
  const goals = ['optimize', 'goals']
  const full = chosen.goals.reduce((text, { metric, weight, target }) => {
    const keys = [target === null ? '' : `target = ${target}`, weight === 1 ? '' : `weight = ${weight}`]
    return setKey(text, goals, metric, table(keys))
  }, bounded)
  switch (aim.kind) {
    case 'minimise':
      return { text: setKey(full, goals, name, '{}'), name }
    case 'bring':
      return { text: setKey(full, goals, name, table([`target = ${aim.target}`])), name }
    case 'keep': {
      const ends = (['min', 'max'] as const).map((end) => (aim[end] === undefined ? '' : `${end} = ${aim[end]}`))
      return { text: setKey(full, ['optimize', 'limits'], name, table([`metric = ${string(name)}`, ...ends])), name }
    }
  }
}

/** True if a text says what it is to be optimised for. */
export function hasGoals(text: string): boolean {
  return outline(text).some(({ path }) => path[0] === 'optimize')
}

function table(pairs: string[]): string {
  const written = pairs.filter((pair) => pair !== '')
  return written.length > 0 ? `{ ${written.join(', ')} }` : '{}'
}

/** Name of the metric that a goal of a quantity makes. */
export function metricName(text: string, { of, take }: Exclude<Judged, { metric: string }>): string {
  return free(`${of.replaceAll(/\W+/g, '_')}_${take}`, namesIn(outline(text), 'metrics'))
}

function withMetric(text: string, judged: Exclude<Judged, { metric: string }>): [text: string, name: string] {
  const keys: [key: string, value: string | undefined][] = [
    ['case', judged.case === undefined ? undefined : string(judged.case)],
    ['of', string(judged.of)],
    ['over', judged.over === undefined ? undefined : string(judged.over)],
    ['take', string(judged.take)],
    ['at', judged.at === undefined ? undefined : String(judged.at)],
  ]
  const written = keys.flatMap(([key, value]) => (value === undefined ? [] : [`${key} = ${value}`]))
  const name = metricName(text, judged)
  return [setKey(text, ['metrics'], name, `{ ${written.join(', ')} }`), name]
}

/**
 * Sets the bounds of a design variable in a model's text; undefined if the text has no entry for it. Those of a
 * parameter are bounds of its value, which `as` says of the numbers given.
 */
export function boundsToml(
  text: string,
  variable: string,
  bounds: readonly [number, number],
  as: 'change' | 'value' = 'change',
): string | undefined {
  const entry = entryOf(text, variable)
  if (!entry) return undefined
  const shift = as === 'change' ? entry.nominal : 0
  const [low, high] = bounds.map((x) => Number((x + shift).toPrecision(12)))
  return setIn(text, entry, 'bounds', `[${low}, ${high}]`)
}

/** Sets the tolerance of a design variable in a model's text. */
export function toleranceToml(text: string, variable: string, tolerance: number): string {
  const entry = entryOf(text, variable)
  // Of a point that makes three variables each may have its own.
  if (entry?.table.at(-1) === variable) return setIn(text, entry, 'tolerance', String(tolerance))
  return setKey(text, ['tolerance', 'variables'], variable, String(tolerance))
}

/** Nominal values of the parameters in a model's text that are numbers, by name. */
export function parameterValues(text: string): ReadonlyMap<string, number> {
  const names = outline(text).flatMap(({ path: [group, name] }) => (group === 'parameters' && name ? [name] : []))
  return new Map(
    [...new Set(names)].flatMap((name): [string, number][] => {
      const entry = entryOf(text, name)
      return entry?.table[0] === 'parameters' ? [[name, entry.nominal]] : []
    }),
  )
}

/** Nominal value of a design variable in a model's text: that of a parameter; 0 for all others, which are changes. */
export function nominalOf(text: string, variable: string): number {
  return entryOf(text, variable)?.nominal ?? 0
}

/** Entry of a text that makes a variable. */
interface VariableEntry {
  table: [group: string, name: string]
  /** Value of a parameter; 0 for all others. */
  nominal: number
  /** True if the entry is the value alone. */
  isPlain: boolean
}

function setIn(text: string, { table: [group, name], isPlain, nominal }: VariableEntry, key: string, value: string) {
  if (isPlain) return setKey(text, [group], name, table([`value = ${nominal}`, `${key} = ${value}`]))
  return setKey(text, [group, name], key, value)
}

/** Entry that makes a variable: its own, or that of a point, of which it is one coordinate. */
function entryOf(text: string, variable: string): VariableEntry | undefined {
  const entries = outline(text)
  const valueOf = ({ to, end }: Entry) => Number(text.slice(to, end).replace(/^\s*=/, '').replaceAll('_', '') || NaN)
  const plain = entries.find(({ path, heading }) => !heading && path.join('\n') === `parameters\n${variable}`)
  if (plain && text[plain.end - 1] !== '}') {
    const nominal = valueOf(plain)
    return Number.isFinite(nominal) ? { table: ['parameters', variable], nominal, isPlain: true } : undefined
  }
  const value = entries.find(({ path }) => path.join('\n') === `parameters\n${variable}\nvalue`)
  if (value) {
    const nominal = valueOf(value)
    return Number.isFinite(nominal) ? { table: ['parameters', variable], nominal, isPlain: false } : undefined
  }
  const found = [variable, variable.replace(/_[xyz]$/, '')].find((name) =>
    entries.some(({ path }) => path[0] === 'design' && path[1] === name),
  )
  return found === undefined ? undefined : { table: ['design', found], nominal: 0, isPlain: false }
}
