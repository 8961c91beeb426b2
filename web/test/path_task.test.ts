import { expect, test } from 'vitest'
import { taskToml } from '../src/studio/path_task'

test('a path is a task file: five points in a row, in the units of the model', () => {
  const points = Array.from({ length: 6 }, (_, k): [number, number] => [k, -0.5 * k])
  const context = { model: 'a "b".toml', units: { length: 'mm', angle: 'deg' }, axes: 'x-z' }
  expect(taskToml({ points, isClosed: true, isFullTurn: true }, context)).toBe(
    [
      '# Points of a path in the x-z plane, from the picture of "a \\"b\\".toml".',
      '#',
      '#   hardpoint synthesize path.toml -o results/path',
      '',
      'name = "path"',
      'units = { length = "mm", angle = "deg" }',
      '',
      'points = [',
      '    [0, 0], [1, -0.5], [2, -1], [3, -1.5], [4, -2],',
      '    [5, -2.5],',
      ']',
      'closed = true',
      'full_turn = true',
      '',
    ].join('\n'),
  )
  expect(taskToml({ points, isClosed: false, isFullTurn: false }, context)).toMatch(/\nclosed = false\n$/)
})
