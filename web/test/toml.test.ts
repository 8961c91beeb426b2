import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import { describe, expect, test } from 'vitest'
import { changes } from '../src/editor/changes'
import { suggest, type Schema } from '../src/editor/complete'
import { type Kind, outline, parts, piece, quoted, start } from '../src/editor/toml'

const MODELS = join(import.meta.dirname, '../../models')
const models = readdirSync(MODELS)
  .filter((file) => file.endsWith('.toml'))
  .map((file) => readFileSync(join(MODELS, file), 'utf8'))
const schema = JSON.parse(readFileSync(join(MODELS, 'hardpoint.schema.json'), 'utf8')) as Schema

/** The pieces of a text that are of a kind. */
function pieces(text: string, wanted: Kind): string[] {
  const reading = start()
  return text.split('\n').flatMap((line) => {
    const found: string[] = []
    for (let at = 0; at < line.length; ) {
      const [kind, to] = piece(line, at, reading)
      if (kind === wanted) found.push(line.slice(at, to))
      at = to
    }
    return found
  })
}

describe('pieces of TOML', () => {
  test('keys, values and comments are distinguished, in tables within a line too', () => {
    const text = 'a.b = { x = 1.5e-3, "y z" = [true, "#no", 1979-05-27] } # yes'
    expect(pieces(text, 'key')).toEqual(['a', 'b', 'x', '"y z"'])
    expect(pieces(text, 'number')).toEqual(['1.5e-3'])
    expect(pieces(text, 'atom')).toEqual(['true', '1979-05-27'])
    expect(pieces(text, 'string')).toEqual(['"#no"'])
    expect(pieces(text, 'comment')).toEqual(['# yes'])
  })

  test('a text over several lines ends where its quotes do', () => {
    const text = 'a = """one # no\n[no]\nthree\\""""\nb = \'\'\'x\'\'\'\n[c]'
    expect(pieces(text, 'string')).toEqual(['"""one # no', '[no]', 'three\\""""', "'''x'''"])
    expect(pieces(text, 'heading')).toEqual(['[c]'])
  })

  test('what is not closed does not swallow what follows', () => {
    const text = 'a = "open\nb = [1, { c = 2\n[joints."x]y"]\nd = 4'
    expect(pieces(text, 'heading')).toEqual(['[joints."x]y"]'])
    expect(pieces(text, 'key')).toEqual(['a', 'b', 'c', 'd'])
  })

  test('a list may begin its lines with brackets', () => {
    expect(pieces('a = [\n[1, 2],\n["x"],\n]\nb = 1', 'heading')).toEqual([])
    expect(pieces('a = [\n[1, 2],\n["x"],\n]\nb = 1', 'key')).toEqual(['a', 'b'])
  })

  test('every piece of every model goes on', () => {
    for (const text of models) expect(pieces(text, 'heading')).toEqual(text.match(/^\[.*\]/gm) ?? [])
  })

  test('names that need quotes have them', () => {
    for (const name of ['toe', 'front toe', 'a"b\\c', 'ä']) expect(parts(`x.${quoted(name)}`)).toEqual(['x', name])
    expect(quoted('toe_2')).toBe('toe_2')
  })
})

test('an outline has the paths and ends of headings and keys', () => {
  const text =
    'name = "x"\n\n[metrics.a]   # one\nof = "toe"\ntarget = [\n  [0, 1],\n]\n\n' +
    '# about b\n[design]\nb = { move = "p", along = "x" }\n'
  const entries = outline(text)
  expect(entries.map(({ path }) => path.join('/'))).toEqual([
    'name',
    'metrics/a',
    'metrics/a/of',
    'metrics/a/target',
    'design',
    'design/b',
    'design/b/move',
    'design/b/along',
  ])
  const [, metric, , target, , b] = entries
  expect(text.slice(metric.from, metric.end)).toBe('[metrics.a]   # one\nof = "toe"\ntarget = [\n  [0, 1],\n]')
  expect(text.slice(target.from, target.end)).toBe('target = [\n  [0, 1],\n]')
  expect(text.slice(b.from, b.end)).toBe('b = { move = "p", along = "x" }')
})

describe('the smallest changes', () => {
  const apply = (text: string, list: ReturnType<typeof changes>) =>
    [...list].reverse().reduce((made, { from, to, insert }) => made.slice(0, from) + insert + made.slice(to), text)
  const between = (a: string, b: string) => changes(a.split('\n'), b.split('\n'))

  test('make the one text of the other, whatever they are', () => {
    const texts = ['', 'a', 'a\nb', 'b\na', 'a\nb\nc', 'a\nx\nb\nc', 'a\nb\nc\n', '\n', '\n\na', 'x\ny\nz\nw']
    for (const a of texts) for (const b of texts) expect(apply(a, between(a, b))).toBe(b)
  })

  test('touch only the numbers that are others', () => {
    expect(between('a = [1, 2]\n# note\nb = [3, 4]\nend', 'a = [1, 5]\n# note\nb = [3, 44]\nend')).toEqual([
      { from: 8, to: 9, insert: '5' },
      { from: 27, to: 27, insert: '4' },
    ])
    expect(between('same', 'same')).toEqual([])
  })
})

describe('what could stand at a place', () => {
  const text = models.find((model) => model.includes('MacPherson strut'))!
  /** With the cursor at `|`, after the model. */
  const labels = (written: string, before = text) =>
    suggest(`${before}\n${written}`, before.length + 1 + written.length, schema)?.suggestions.map(
      ({ label }) => label,
    ) ?? []

  test('are the hardpoints and bodies of the model', () => {
    expect(labels('[joints.new]\nat = "')).toContain('tie_rod_inner')
    expect(labels('[joints.new]\nbodies = ["ground", "kn')).toEqual(['ground', 'lca', 'knuckle', 'strut', 'rack'])
    expect(labels('[design]\nx = { move = "')).toContain('strut_top')
    expect(labels('[joints.new]\naxis = { through = ["lca_rear", ')).toContain('lca_front')
  })

  test('are the words and keys of the format, but those that are there', () => {
    expect(labels('[joints.new]\ntype = "')).toContain('revolute')
    expect(labels('[metrics.new]\nof = "toe"\nta')).toEqual(expect.arrayContaining(['take', 'target']))
    expect(labels('[metrics.new]\nof = "toe"\nt')).not.toContain('of')
    expect(labels('[metrics]\nnew = { of = "toe", ')).toContain('over')
    expect(labels('[met')).toContain('metrics')
  })

  test('are nothing in a comment, a number or a text that is closed', () => {
    expect(labels('# bodies = "')).toEqual([])
    expect(labels('[joints.new]\nat = "x"')).toEqual([])
    expect(labels('[time]\nend = 10')).toEqual([])
  })
})
