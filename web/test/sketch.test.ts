import { readFileSync } from 'node:fs'
import { join } from 'node:path'
import { describe, expect, test } from 'vitest'
import { outline } from '../src/editor/toml'
import { at, type Point, replaced, smoothed, thinned, upright, written } from '../src/studio/stroke'
import { targetToml } from '../src/studio/target'

const wave = (count: number, to = 300): Point[] =>
  Array.from({ length: count + 1 }, (_, k) => [(to * k) / count, 50 * Math.sin((2 * Math.PI * k) / count)])
const farthest = (curve: readonly Point[], from: readonly Point[]) =>
  Math.max(...from.map(([x, y]) => Math.abs(at(curve, x)! - y)))

describe('a curve drawn by hand', () => {
  test('has one value at each abscissa: what was drawn last', () => {
    expect(
      upright([
        [0, 0],
        [10, 10],
        [20, 0],
      ]),
    ).toEqual([
      [0, 0],
      [10, 10],
      [20, 0],
    ])
    expect(
      upright([
        [20, 5],
        [10, 5],
        [0, 5],
      ]),
    ).toEqual([
      [0, 5],
      [10, 5],
      [20, 5],
    ])
    // To the right, and back over it higher up.
    expect(
      upright([
        [0, 0],
        [10, 0],
        [20, 0],
        [12, 8],
        [4, 8],
      ]),
    ).toEqual([
      [0, 0],
      [4, 8],
      [12, 8],
      [20, 0],
    ])
    expect(
      upright([
        [5, 1],
        [5, 9],
      ]),
    ).toEqual([[5, 9]])
    const xs = upright(Array.from({ length: 200 }, (_, k) => [50 * Math.cos(k / 7) + k, k])).map(([x]) => x)
    expect(xs).toEqual([...xs].sort((a, b) => a - b))
  })

  test('loses its tremble and keeps its form and its ends', () => {
    const trembling = wave(150).map(([x, y], k): Point => [x, y + (k % 2 ? 2 : -2)])
    const calm = smoothed(trembling)
    expect(farthest(calm, wave(150).slice(8, -8))).toBeLessThan(1)
    expect([calm[0], calm.at(-1)]).toEqual([trembling[0], trembling.at(-1)])
    // A straight line stays where it is.
    expect(
      farthest(
        smoothed([
          [0, 0],
          [40, 20],
          [100, 50],
        ]),
        [
          [10, 5],
          [77, 38.5],
        ],
      ),
    ).toBeLessThan(1e-9)
  })

  test('is a handful of points, none of the others far from it', () => {
    const few = thinned(wave(300))
    expect(few.length).toBeLessThan(16)
    expect(few.length).toBeGreaterThan(5)
    expect(farthest(few, wave(300))).toBeLessThan(3)
    expect(
      thinned([
        [0, 0],
        [5, 5],
        [10, 10],
      ]),
    ).toEqual([
      [0, 0],
      [10, 10],
    ])
    expect(
      thinned([
        [0, 0],
        [5, 20],
        [0, 0],
      ]),
    ).toHaveLength(3)
  })

  test('takes the place of a part, and leaves the rest', () => {
    const line: Point[] = [
      [0, 0],
      [100, 100],
    ]
    const made = replaced(
      line,
      [
        [40, 80],
        [60, 80],
      ],
      100,
    )
    expect(made).toEqual([
      [0, 0],
      [37, 37],
      [40, 80],
      [60, 80],
      [63, 63],
      [100, 100],
    ])
    expect(
      replaced(
        line,
        [
          [90, 0],
          [110, 0],
        ],
        100,
      ),
    ).toEqual([
      [0, 0],
      [87, 87],
      [90, 0],
      [110, 0],
    ])
    expect(
      replaced(
        [],
        [
          [1, 2],
          [3, 4],
        ],
        100,
      ),
    ).toEqual([
      [1, 2],
      [3, 4],
    ])
    expect(replaced(line, [], 100)).toEqual(line)
  })

  test('is written in numbers of few digits, with rising abscissas', () => {
    expect(
      written(
        [
          [-39.98713, 0.40022],
          [-39.98, 0.3],
          [0.0123, -0.123456],
        ],
        [80, 1],
      ),
    ).toEqual([
      [-40, 0.4],
      [0, -0.123],
    ])
    expect(written([[1e-7, 2.34567e-6]], [1e-6, 1e-5])).toEqual([[1e-7, 2.35e-6]])
  })
})

describe('a target in the text', () => {
  const points = [
    [-40, 0.4],
    [40, 0],
  ] as const
  const curve = { name: 'toe_error', of: 'toe', over: 'wheel_travel', points }
  const table =
    '[metrics.toe_error]\nof = "toe"\nover = "wheel_travel"\ntake = "rms"\n' +
    'window = [-40, 40]\ntarget = [[-40, 0.4], [40, 0]]'
  const inline =
    '{ of = "toe", over = "wheel_travel", take = "rms", window = [-40, 40], target = [[-40, 0.4], [40, 0]] }'

  test('is after the measures where there are no metrics', () => {
    const text = 'name = "x"\n\n[measures.toe]\ntype = "toe" # deg\n\n# The times.\n[time]\nend = 1\n'
    expect(targetToml(text, curve)).toEqual({
      name: 'toe_error',
      text: `name = "x"\n\n[measures.toe]\ntype = "toe" # deg\n\n${table}\n\n# The times.\n[time]\nend = 1\n`,
    })
  })

  test('is with the other metrics, under another name where its own is taken', () => {
    const text = '[metrics.toe_error]\nof = "toe"\n# at = 5\n\n[time]\nend = 1\n'
    const made = targetToml(text, curve)
    expect(made.name).toBe('toe_error_2')
    expect(made.text).toBe(
      `[metrics.toe_error]\nof = "toe"\n# at = 5\n\n${table.replace('toe_error', 'toe_error_2')}\n\n[time]\nend = 1\n`,
    )
    expect(targetToml(made.text, curve).name).toBe('toe_error_3')
  })

  test('leaves a comment with what follows it', () => {
    const text = '[metrics.a]\nof = "toe"\n# The times.\n[time]\n'
    expect(targetToml(text, curve).text).toBe(`[metrics.a]\nof = "toe"\n\n${table}\n# The times.\n[time]\n`)
  })

  test('continues with metrics that are listed in one table', () => {
    expect(targetToml('[metrics]\na = { of = "x", take = "range" } # one\n\n[time]\n', curve).text).toBe(
      `[metrics]\na = { of = "x", take = "range" } # one\ntoe_error = ${inline}\n\n[time]\n`,
    )
    expect(targetToml('[metrics]\n', curve).text).toBe(`[metrics]\ntoe_error = ${inline}\n`)
    expect(targetToml('metrics = { a = { of = "x", take = "max" } }\nname = "x"\n', curve).text).toBe(
      `metrics = { a = { of = "x", take = "max" }, toe_error = ${inline} }\nname = "x"\n`,
    )
    expect(targetToml('metrics = {}\n', curve).text).toBe(`metrics = { toe_error = ${inline} }\n`)
    expect(targetToml('metrics.a.of = "x"\nname = "x"\n[time]\n', curve).text).toBe(
      `metrics.a.of = "x"\nmetrics.toe_error = ${inline}\nname = "x"\n[time]\n`,
    )
  })

  test('is at the end where nothing indicates better, in the line breaks of the text', () => {
    expect(targetToml('name = "x"', curve).text).toBe(`name = "x"\n\n${table}\n`)
    expect(targetToml('name = "x"\r\n[measures.toe]\r\ntype = "toe"\r\n', curve).text).toBe(
      `name = "x"\n[measures.toe]\ntype = "toe"\n\n${table}\n`.replaceAll('\n', '\r\n'),
    )
  })

  test('is over time, of a case, and of names in quotes where it has to be', () => {
    const made = targetToml('', { name: 'front toe', of: 'a"b', case: 'bump', points })
    expect(made.text).toBe(
      '[metrics."front toe"]\ncase = "bump"\nof = "a\\"b"\ntake = "rms"\n' +
        'window = [-40, 40]\ntarget = [[-40, 0.4], [40, 0]]\n',
    )
  })

  test('adds its own keys to a model, and nothing else changes', () => {
    const strut = readFileSync(join(import.meta.dirname, '../../models/studies/strut_toe.toml'), 'utf8')
    const paths = (text: string) => outline(text).map(({ path }) => path.join('/'))
    const made = targetToml(strut, curve)
    const before = paths(strut)
    expect(paths(made.text).filter((path) => !before.includes(path))).toEqual(
      ['', '/of', '/over', '/take', '/window', '/target'].map((key) => `metrics/toe_error_2${key}`),
    )
    expect(made.text.replace(/\n\n\[metrics.toe_error_2\][^#[]*\[[^#]*?\]\]/, '')).toBe(strut)
  })
})
