import { describe, expect, test } from 'vitest'
import { BLINDNESS, contrast, distance } from './colour'
import { schemes } from './schemes'

/** Every pair of these colours. */
const pairs = (names: string[]) => names.flatMap((a, k) => names.slice(0, k).map((b) => [a, b] as const))

const BODIES = ['body-0', 'body-1', 'body-2', 'body-3', 'body-4', 'body-5']
const MARKS = ['driver', 'chosen', 'trace']

describe.each(Object.entries(schemes))('in the %s scheme', (_, palette) => {
  // Distances at which two adjacent colours are clearly distinguished.
  test.each([
    ['bodies', BODIES, 16],
    ['marks', MARKS, 19],
  ])('the colours of %s differ', (_, names, least) => {
    for (const [a, b] of pairs(names)) expect(distance(palette[a], palette[b]), `${a} and ${b}`).toBeGreaterThan(least)
  })

  test.each(Object.entries(BLINDNESS))('with %s as well', (_, blindness) => {
    for (const [a, b] of [...pairs(BODIES), ...pairs(MARKS)])
      expect(distance(palette[a], palette[b], blindness), `${a} and ${b}`).toBeGreaterThan(11)
  })

  // Less than between bodies, because ground is also hatched.
  test('bodies differ from what is fixed', () => {
    for (const name of BODIES) expect(distance(palette[name], palette.ground), name).toBeGreaterThan(7)
  })

  // 3 is what the accessibility guidelines ask of things that carry meaning, 4.5 of text.
  test('marks stand out from the view', () => {
    for (const name of MARKS) expect(contrast(palette[name], palette.view), name).toBeGreaterThan(3)
  })

  test('the model can be read on the page', () => {
    for (const name of ['code-text', 'code-number', 'accent', 'muted', 'ink'])
      expect(contrast(palette[name], palette.page), name).toBeGreaterThan(4.5)
  })

  test('labels can be read on the view', () => {
    expect(contrast(palette.label, palette.view)).toBeGreaterThan(4.5)
  })
})

test('distances are those of the colour space: black to white is 100', () => {
  expect(distance('#000000', '#ffffff')).toBeCloseTo(100, 1)
  expect(distance('#6c7fb8', '#6c7fb8')).toBe(0)
  expect(contrast('#000000', '#ffffff')).toBeCloseTo(21)
})
