import { describe, expect, test } from 'vitest'
import { amount, entry } from '../src/amount'

const value = (text: string, unit = 'mm') => {
  const found = amount(text, unit)
  return typeof found === 'string' ? found : found.value
}

describe('a typed number', () => {
  test.each([
    ['12', 12],
    ['2,5', 2.5],
    ['2.5', 2.5],
    ['.5', 0.5],
    ['-3', -3],
    ['−3', -3],
    ['1e3', 1000],
    ['1.5e-3 m', 1.5],
    ['3 MM', 3],
    ['3mm', 3],
    ['1/2 in', 12.7],
    ['1 1/2 in', 38.1],
    ['-1/4in', -6.35],
    ['2 cm', 20],
  ])('%s is %d mm', (text, expected) => expect(value(text)).toBe(expected))

  test('of an angle has units of angle', () => {
    expect(value('0.5deg', 'deg')).toBe(0.5)
    expect(value('3.141592653589793 rad', 'deg')).toBe(180)
    expect(value('2°', 'deg')).toBe(2)
  })

  test('adds with a plus, and steps from the present value with += and -=', () => {
    expect(amount('+2', 'mm')).toEqual({ value: 2, form: 'plus' })
    expect(amount('+=2', 'mm')).toEqual({ value: 2, form: 'step' })
    expect(amount('-=1/2 in', 'mm')).toEqual({ value: -12.7, form: 'step' })
    expect(amount('-2', 'mm')).toEqual({ value: -2, form: 'plain' })
  })

  test.each([
    ['', 'mm', /^Enter a number/],
    ['abc', 'mm', '`abc` is not a number with a unit.'],
    ['1e400', 'mm', '`1e400` is not finite.'],
    ['1/0', 'mm', '`1/0` is not finite.'],
    ['1,234.5', 'mm', '`1,234.5` is not a number with a unit.'],
    ['2 furlong', 'mm', 'There is no unit `furlong`; use mm, cm, m, in, deg or rad.'],
    ['2 deg', 'mm', 'This is a length, but deg is not a unit of length.'],
    ['2 mm', 'deg', 'This is an angle, but mm is not a unit of angle.'],
    ['2 mm', '1', 'This is dimensionless, but the unit `mm` was given.'],
    ['2 mm', 'N', 'The unit here is N; leave out `mm`.'],
  ])('%s in %s is refused with the reason', (text, unit, why) => {
    if (typeof why === 'string') expect(value(text, unit)).toBe(why)
    else expect(value(text, unit)).toMatch(why)
  })

  test('is shown without digits that are rounding', () => {
    expect(entry(0.1 + 0.2)).toBe('0.3')
    expect(entry(-59.69)).toBe('-59.69')
  })
})
