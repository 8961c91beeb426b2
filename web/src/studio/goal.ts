import { namesIn, outline, text as string } from '../editor/toml'
import { setKey } from '../editor/toml_edit'

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

/** Adds a goal or a limit to a model's text, with the metric that it needs. */
export function goalToml(text: string, judged: Judged, aim: Aim): { text: string; name: string } {
  const [made, metric] = 'metric' in judged ? [text, judged.metric] : withMetric(text, judged)
  switch (aim.kind) {
    case 'minimise':
      return { text: setKey(made, ['optimize', 'goals'], metric, '{}'), name: metric }
    case 'bring':
      return { text: setKey(made, ['optimize', 'goals'], metric, `{ target = ${aim.target} }`), name: metric }
    case 'keep': {
      const ends = (['min', 'max'] as const).flatMap((end) => (aim[end] === undefined ? [] : [`${end} = ${aim[end]}`]))
      const limit = `{ metric = ${string(metric)}, ${ends.join(', ')} }`
      return { text: setKey(made, ['optimize', 'limits'], metric, limit), name: metric }
    }
  }
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
  const taken = namesIn(outline(text), 'metrics')
  const wanted = `${judged.of.replaceAll(/\W+/g, '_')}_${judged.take}`
  let name = wanted
  for (let k = 2; taken.includes(name); k++) name = `${wanted}_${k}`
  return [setKey(text, ['metrics'], name, `{ ${written.join(', ')} }`), name]
}

/** Sets the bounds of a design variable in a model's text; undefined if the text has no entry for it. */
export function boundsToml(text: string, variable: string, bounds: readonly [number, number]): string | undefined {
  const table = entryOf(text, variable)
  return table && setKey(text, table, 'bounds', `[${bounds.join(', ')}]`)
}

/** Sets the tolerance of a design variable in a model's text. */
export function toleranceToml(text: string, variable: string, tolerance: number): string {
  const table = entryOf(text, variable)
  // Of a point that makes three variables each may have its own.
  if (table?.at(-1) === variable) return setKey(text, table, 'tolerance', String(tolerance))
  return setKey(text, ['tolerance', 'variables'], variable, String(tolerance))
}

/** Entry that makes a variable: its own, or that of a point, of which it is one coordinate. */
function entryOf(text: string, variable: string): string[] | undefined {
  const entries = outline(text)
  const point = variable.replace(/_[xyz]$/, '')
  for (const name of [variable, point])
    for (const table of ['design', 'parameters']) {
      const found = entries.find(({ path }) => path.length === 2 && path[0] === table && path[1] === name)
      const isTable = found && (found.heading || text[found.end - 1] === '}')
      if (isTable || entries.some(({ path }) => path.length > 2 && path[0] === table && path[1] === name))
        return [table, name]
    }
  return undefined
}
