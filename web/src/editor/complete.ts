import { namesIn, outline, quoted, cursorContext, text } from './toml'

/** The keywords of JSON Schema that are used here. */
export interface Schema {
  description?: string
  $ref?: string
  $defs?: Record<string, Schema>
  type?: string | string[]
  properties?: Record<string, Schema>
  additionalProperties?: Schema | boolean
  items?: Schema | boolean
  prefixItems?: Schema[]
  anyOf?: Schema[]
  oneOf?: Schema[]
  allOf?: Schema[]
  enum?: unknown[]
  const?: unknown
}

/** A completion of the word at the cursor. */
export interface Suggestion {
  label: string
  /** Text to insert. */
  insert: string
  /** Description in a word. */
  detail?: string
  about?: string
}

/** The tables whose entries a key names. */
const NAMED: Record<string, string[]> = {
  at: ['hardpoints'],
  through: ['hardpoints'],
  position: ['hardpoints'],
  centre: ['hardpoints'],
  move: ['hardpoints'],
  hardpoint: ['hardpoints'],
  between: ['hardpoints', 'design'],
  from: ['hardpoints', 'points'],
  to: ['hardpoints', 'points'],
  body: ['bodies'],
  bodies: ['bodies'],
  joint: ['joints'],
  joints: ['joints'],
  length: ['joints'],
  tilt: ['joints'],
  point: ['points', 'hardpoints'],
  points: ['points', 'hardpoints'],
  wheel: ['wheels'],
  axle: ['axles'],
  driver: ['drivers'],
  of: ['measures'],
  over: ['measures'],
  measure: ['measures'],
  measures: ['measures'],
  curves: ['measures'],
  metric: ['metrics'],
  metrics: ['metrics'],
  case: ['cases'],
  variables: ['design', 'parameters'],
}

/** One of each kind, as its table is called. */
const ONE: Record<string, string> = {
  hardpoints: 'hardpoint',
  bodies: 'body',
  joints: 'joint',
  points: 'point',
  wheels: 'wheel',
  axles: 'axle',
  drivers: 'driver',
  measures: 'measure',
  metrics: 'metric',
  cases: 'case',
  design: 'design variable',
  parameters: 'parameter',
}

/**
 * Possible entries at a place of a text, and the start of the word that they would replace; undefined where nothing is
 * known.
 */
export function suggest(
  source: string,
  at: number,
  schema?: Schema,
): { from: number; suggestions: Suggestion[] } | undefined {
  const here = cursorContext(source.slice(0, at))
  if (!here) return undefined
  const { table, key, begun, quoted: inQuotes, heading } = here
  const from = at - begun.length
  const entries = outline(source)
  if (heading) {
    // Of `[joints.` the name is the writer's own.
    const [head] = begun.match(/^\[\[?/)!
    if (/[.\]]/.test(begun) || !schema) return undefined
    return { from: from + head.length, suggestions: keysOf(schema, schema, (one) => one) }
  }
  if (!key) {
    const nodes = schema ? schemasAt(schema, table) : []
    const present = new Set(
      entries
        .filter(({ path }) => path.length === table.length + 1 && table.every((part, k) => path[k] === part))
        .map(({ path }) => path.at(-1)!),
    )
    const suggestions = nodes
      .flatMap((node) => keysOf(node, schema!, (name) => `${name} = `))
      .filter(({ label }) => !present.has(label) || label === begun)
    return suggestions.length > 0 ? { from, suggestions: unique(suggestions) } : undefined
  }
  const write = (value: string) => (inQuotes ? value : text(value))
  const tables = NAMED[key.at(-1)!] ?? []
  const names = tables.flatMap((kind) =>
    [...(kind === 'bodies' ? ['ground'] : []), ...namesIn(entries, kind)].map((name) => ({
      label: name,
      insert: write(name),
      detail: ONE[kind],
    })),
  )
  const words = schema
    ? schemasAt(schema, key)
        .flatMap((node) => valuesOf(node, schema))
        .map((word) => ({ ...word, insert: write(word.label) }))
    : []
  const suggestions = unique([...names, ...words])
  return suggestions.length > 0 ? { from, suggestions } : undefined
}

function unique(suggestions: Suggestion[]): Suggestion[] {
  return [...new Map(suggestions.map((one) => [one.label, one])).values()]
}

/** Forms of a schema: itself, its references, and each of several alternatives. */
function forms(node: Schema, root: Schema, seen = new Set<Schema>()): Schema[] {
  if (seen.has(node)) return []
  seen.add(node)
  const named = node.$ref?.startsWith('#/$defs/') ? root.$defs?.[node.$ref.slice('#/$defs/'.length)] : undefined
  return [
    node,
    ...[named, ...(node.anyOf ?? []), ...(node.oneOf ?? []), ...(node.allOf ?? [])].flatMap((one) =>
      one ? forms(one, root, seen) : [],
    ),
  ]
}

/** Those of a list's elements, and theirs. */
function elements(node: Schema, root: Schema): Schema[] {
  return forms(node, root).flatMap((form) => [
    form,
    ...[form.items, ...(form.prefixItems ?? [])].flatMap((item) =>
      item && typeof item === 'object' ? elements(item, root) : [],
    ),
  ])
}

/** Schemas of the value at a path. */
function schemasAt(root: Schema, path: string[]): Schema[] {
  let nodes = [root]
  for (const part of path) {
    nodes = nodes
      .flatMap((node) => elements(node, root))
      .flatMap((form) => {
        const { properties, additionalProperties: others } = form
        const own = properties?.[part] ?? (others && typeof others === 'object' ? others : undefined)
        return own ? [own] : []
      })
  }
  return nodes
}

function keysOf(node: Schema, root: Schema, insert: (name: string) => string): Suggestion[] {
  return elements(node, root).flatMap(({ properties = {} }) =>
    Object.entries(properties).map(([name, { description }]) => ({
      label: name,
      insert: insert(quoted(name)),
      about: description,
    })),
  )
}

function valuesOf(node: Schema, root: Schema): { label: string; about?: string }[] {
  return elements(node, root).flatMap(({ enum: several = [], const: one, description }) =>
    [...several, one].flatMap((value) =>
      typeof value === 'string' ? [{ label: value, about: one === undefined ? undefined : description }] : [],
    ),
  )
}
