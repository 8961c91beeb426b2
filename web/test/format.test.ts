import { expect, test } from 'vitest'
import { figure, number, per, pretty, roundBelow, titled } from '../src/format'

test('numbers carry five significant digits and no more zeros than needed', () => {
  expect(number(341.23456)).toBe('341.23')
  expect(number(-0.5)).toBe('−0.5')
  expect(number(200)).toBe('200')
  expect(number(1e-7)).toBe('1e−7')
  expect(number(-1.2345678e9)).toBe('−1.2346e9')
  expect(number(0)).toBe('0')
  expect(number(NaN)).toBe('–')
})

test('a pure number shows no unit', () => {
  expect(figure(2, 'mm')).toBe('2 mm')
  expect(figure(2, '1')).toBe('2')
  expect(titled('ratio', '1')).toBe('ratio')
  expect(titled('toe', 'deg/s^2')).toBe('toe [deg/s²]')
})

test('units of derivatives divide by the unit of the variable', () => {
  expect(per('deg', 'mm')).toBe('deg/mm')
  expect(per('deg/s', 'mm')).toBe('deg/(s·mm)')
  expect(per('deg/s^2', 'mm')).toBe('deg/(s²·mm)')
  expect(per('deg/(s*kg)', 'mm')).toBe('deg/(s·kg·mm)')
  expect(per('1', 'mm')).toBe('1/mm')
  expect(per('deg', 'N*m')).toBe('deg/(N·m)')
  expect(per('mm', 'N*m')).toBe('mm/(N·m)')
  expect(per('deg', 'N*m/deg')).toBe('deg/(N·m/deg)')
  expect(per('mm/s', '1')).toBe('mm/s')
  expect(per('deg', 'mm/s')).toBe('deg/(mm/s)')
  expect(per('deg/mm', 'mm')).toBe('deg/mm²')
  expect(per('mm/deg^2', 'deg')).toBe('mm/deg³')
  expect(per('deg/(s*mm)', 'mm')).toBe('deg/(s·mm²)')
  expect(per('deg/s^2', 'mm/s')).toBe('deg/(s²·(mm/s))')
})

test('powers in units are set as such', () => {
  expect(pretty('mm/s^2')).toBe('mm/s²')
})

test('rounding below gives 1, 2 or 5 times a power of ten', () => {
  expect([0.99, 1, 3.4, 60, 499].map(roundBelow)).toEqual([0.5, 1, 2, 50, 200])
})
