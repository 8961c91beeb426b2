import { describe, expect, test } from 'vitest'
import { setKey } from '../src/editor/toml_edit'
import { boundsToml, goalToml, toleranceToml } from '../src/studio/goal'

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

describe('a goal', () => {
  test('of a quantity makes the metric that it needs', () => {
    expect(
      goalToml('name = "x"\n', { of: 'left.toe', take: 'range', over: 'left.travel' }, { kind: 'minimise' }),
    ).toEqual({
      name: 'left_toe_range',
      text:
        'name = "x"\n\n[metrics]\nleft_toe_range = { of = "left.toe", over = "left.travel", take = "range" }\n\n' +
        '[optimize.goals]\nleft_toe_range = {}\n',
    })
  })
  test('of a metric is a target, or a limit', () => {
    const text = '[metrics.m]\nof = "toe"\n\n[optimize.goals]\nm = {}\n'
    expect(goalToml(text, { metric: 'm' }, { kind: 'bring', target: 2 }).text).toContain('m = { target = 2 }')
    expect(goalToml(text, { metric: 'm' }, { kind: 'keep', min: 1, max: 3 }).text).toContain(
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
  test('of one coordinate of a point has its own tolerance', () => {
    expect(toleranceToml(text, 'outer_z', 0.2)).toContain('[tolerance.variables]\nouter_z = 0.2')
  })
})
