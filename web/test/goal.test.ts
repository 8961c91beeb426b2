import { describe, expect, test } from 'vitest'
import { setKey } from '../src/editor/toml_edit'
import { boundsToml, goalToml, toleranceToml } from '../src/studio/goal'
import { separateMotions } from '../src/studio/motions'

describe('a key that is set', () => {
  test.each([
    ['[a]\nb = 1 # one\nc = 2\n', ['a'], 'b', '3', '[a]\nb = 3 # one\nc = 2\n'],
    ['[a]\nb = 1\n\n[d]\n', ['a'], 'c', '2', '[a]\nb = 1\nc = 2\n\n[d]\n'],
    ['x = { b = 1 }\n', ['x'], 'c', '2', 'x = { b = 1, c = 2 }\n'],
    ['[d]\nx = {}\n', ['d', 'x'], 'c', '2', '[d]\nx = { c = 2 }\n'],
    ['[o]\ngoals.a = 1\nn = 3\n', ['o', 'goals'], 'b', '2', '[o]\ngoals.a = 1\ngoals.b = 2\nn = 3\n'],
    ['[o]\ngoals = { a = {} }\n', ['o', 'goals'], 'b', '{}', '[o]\ngoals = { a = {}, b = {} }\n'],
    ['[o.goals.a]\nweight = 1\n\n[t]\n', ['o', 'goals'], 'a', '{}', '\n\n[t]\n\n[o.goals]\na = {}\n'],
    ['[o]\nn = 1\n\n[t]\n', ['o', 'goals'], 'a', '{}', '[o]\nn = 1\n\n[o.goals]\na = {}\n\n[t]\n'],
    ['', ['o', 'goals'], 'a b', '{}', '[o.goals]\n"a b" = {}\n'],
    ['[a]\r\nb = 1\r\n', ['a'], 'c', '2', '[a]\r\nb = 1\r\nc = 2\r\n'],
    ['[a]\nb = 1\nc = 2\n', ['a'], 'b', undefined, '[a]\nc = 2\n'],
    ['x = { b = 1, c = 2 }\n', ['x'], 'b', undefined, 'x = { c = 2 }\n'],
    ['x = { b = 1, c = 2 }\n', ['x'], 'c', undefined, 'x = { b = 1 }\n'],
  ])('%j %j', (text, table, key, value, expected) => {
    expect(setKey(text, table, key, value)).toBe(expected)
  })
})

const NONE = { variables: [], goals: [] }

describe('a goal', () => {
  const range = { of: 'left.toe', take: 'range', over: 'left.travel' } as const
  const metric = '[metrics]\nleft_toe_range = { of = "left.toe", over = "left.travel", take = "range" }\n'
  test('of a quantity makes the metric that it needs, alone while no variable has bounds', () => {
    expect(goalToml('name = "x"\n', range, { kind: 'minimise' }, NONE)).toEqual({
      name: 'left_toe_range',
      text: `name = "x"\n\n${metric}`,
    })
  })
  test('is written with the bounds and the goals that are chosen', () => {
    const chosen = {
      variables: [{ name: 'z', bounds: [-1, 2] }],
      goals: [{ metric: 'm', weight: 3, target: 0.5 }],
    } as const
    expect(goalToml('[design]\nz = { move = "p", along = "z" }\n', range, { kind: 'minimise' }, chosen).text).toBe(
      `[design]\nz = { move = "p", along = "z", bounds = [-1, 2] }\n\n${metric}\n` +
        '[optimize.goals]\nm = { target = 0.5, weight = 3 }\nleft_toe_range = {}\n',
    )
  })
  test('of a metric is a target, or a limit', () => {
    const text = '[metrics.m]\nof = "toe"\n\n[optimize.goals]\nm = {}\n'
    expect(goalToml(text, { metric: 'm' }, { kind: 'bring', target: 2 }, NONE).text).toContain('m = { target = 2 }')
    expect(goalToml(text, { metric: 'm' }, { kind: 'keep', min: 1, max: 3 }, NONE).text).toContain(
      '[optimize.limits]\nm = { metric = "m", min = 1, max = 3 }',
    )
  })
})

describe('bounds and tolerances', () => {
  const text = '[design]\nouter = { move = "p", along = "xyz" }\nrack_z = { move = "q", along = "z" }\n'
  test('are written to the entry of the variable', () => {
    expect(boundsToml(text, 'rack_z', [-15, 20])).toContain('rack_z = { move = "q", along = "z", bounds = [-15, 20] }')
    expect(boundsToml(text, 'outer_z', [-1, 1])).toContain('outer = { move = "p", along = "xyz", bounds = [-1, 1] }')
    expect(toleranceToml(text, 'rack_z', 0.2)).toContain('along = "z", tolerance = 0.2 }')
    expect(boundsToml(text, 'p.x', [0, 1])).toBe(undefined)
  })
  test('of a parameter are those of its value', () => {
    const parameters = '[parameters]\nr = 40\narm = { value = 120, unit = "length" }\nsum = "r + 1"\n'
    expect(boundsToml(parameters, 'r', [-1, 2])).toContain('r = { value = 40, bounds = [39, 42] }')
    expect(boundsToml(parameters, 'arm', [-20, 20])).toContain('unit = "length", bounds = [100, 140] }')
    expect(boundsToml(parameters, 'arm', [100, 140], 'value')).toContain('bounds = [100, 140] }')
    expect(boundsToml(parameters, 'sum', [0, 1])).toBe(undefined)
    expect(toleranceToml(parameters, 'r', 0.1)).toContain('r = { value = 40, tolerance = 0.1 }')
  })
  test('of one coordinate of a point has its own tolerance', () => {
    expect(toleranceToml(text, 'outer_z', 0.2)).toContain('[tolerance.variables]\nouter_z = 0.2')
  })
})

describe('cases with one moving driver', () => {
  const text = '[drivers]\nrack = { joint = "slide", law = "30*sin(t)" }\nspring = { joint = "strut", law = 4 }\n'

  test('follow the text, to whose end they are added, in the order of the drivers', () => {
    const made = separateMotions(text, ['spring', 'rack'])!
    expect(made.names).toEqual(['spring', 'rack'])
    expect(made.text).toBe(text + made.added)
    expect(made.added).toContain('[cases.spring]\nlaws = { spring = 4 }')
    expect(made.added).toContain('[cases.rack]\nlaws = { rack = "30*sin(t)" }')
  })

  test('are not derived from a text with cases, or with a law in several lines', () => {
    expect(separateMotions(`${text}[cases.bump]\nlaws = { spring = 4 }\n`, ['spring', 'rack'])).toBeUndefined()
    const points = text.replace('law = 4', 'law = [\n0, 4]')
    expect(separateMotions(points, ['spring', 'rack'])).toBeUndefined()
  })
})
