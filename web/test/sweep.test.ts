import { expect, test } from 'vitest'
import { along, nearest } from '../src/sweep/nearest'
import { settingsAt } from '../src/sweep/settings'

test('designs that are not known on both axes are left out, and the others follow the first', () => {
  expect(along([3, NaN, 1, 2, 1], [1, 1, NaN, 5, 4])).toEqual([4, 3, 0])
})

test('what is nearest is pointed at, and nothing beyond reach', () => {
  const at = (k: number): [number, number] => [10 * k, 0]
  expect(nearest([0, 1, 2], at, [12, 3], 24)).toBe(1)
  expect(nearest([0, 2], at, [12, 3], 24)).toBe(2)
  expect(nearest([0, 1], at, [100, 0], 24)).toBeUndefined()
})

test('a point of a front is a design: the changes of its variables, and nothing of goals', () => {
  const axis = (name: string, nominal: number | null, values: number[]) => ({
    ...{ name, unit: 'mm', metric: nominal === null, nominal, target: null },
    values: new Float32Array(values),
  })
  const axes = [axis('track', null, [0.5, 0.9]), axis('lca_y', 0, [0, -15]), axis('length', 300, [300, 310])]
  const front = { what: 'point', designs: 2, step: 1, indices: [], axes }
  const report = (change: number[], bounds: [number, number] | null = null) =>
    ({
      variables: ['lca_y', 'length'].map((name) => ({ name, bounds: name === 'lca_y' ? bounds : null })),
      designs: change.length > 0 ? [{ kind: 'exact', change }] : [],
    }) as unknown as Parameters<typeof settingsAt>[0]
  expect(settingsAt(report([]), front, 0)).toEqual([])
  expect(settingsAt(report([]), front, 1)).toEqual([
    { name: 'lca_y', by: -15 },
    { name: 'length', by: 10 },
  ])
  // Values are rounded: the bound of a variable is kept, and a design of the report at the point is exact.
  const bounded = [-14.9999, 15] as [number, number]
  expect(settingsAt(report([], bounded), front, 1)[0]).toEqual({ name: 'lca_y', by: -14.9999 })
  expect(settingsAt(report([-14.99995, 10.0001]), front, 1)).toEqual([
    { name: 'lca_y', by: -14.99995 },
    { name: 'length', by: 10.0001 },
  ])
  expect(settingsAt(report([-14.99995, 3]), front, 1)[1]).toEqual({ name: 'length', by: 10 })
})
