import { afterAll, describe, expect, test, vi } from 'vitest'
import { type Content, drawnRange, drawnSteps, headingOf, type Line } from '../src/content'
import { changeFrom, crossings } from '../src/curve'
import { linearAxis, ticks } from '../src/export/axis'
import { sensitivityContent, valueContent } from '../src/page/contents'
import { measuredOf as measuredFile, type MeasuredSubject } from '../src/page/measured'
import type { Variable } from '../src/report'
import { State } from '../src/state'
import { crank } from './mechanisms'

const curve = (...values: number[]) => Float32Array.from(values)
const line = (values: Float32Array, over?: Float32Array): Line => ({ label: 'toe', color: '#000', curve: values, over })

describe('the change of a curve', () => {
  test('over time is the difference step by step', () => {
    expect([...changeFrom([curve(1, 3, 2)], [curve(1, 1, 1)])]).toEqual([0, 2, 1])
  })

  test('over another quantity is taken at the same abscissa, on the same branch', () => {
    // There and back: y is x on the way there and x + 10 on the way back.
    const [x, y] = [curve(0, 1, 2, 1, 0), curve(0, 1, 2, 11, 10)]
    const [moved, raised] = [x.map((v) => v * 0.5), curve(5, 5.5, 6, 15.5, 15)]
    expect([...changeFrom([raised, moved], [y, x])]).toEqual([5, 5, 5, 5, 5])
    expect(changeFrom([curve(1), curve(9)], [curve(0, 1), curve(0, 1)])[0]).toBeNaN()
  })
})

describe('a plot over a quantity that goes back and forth along one line', () => {
  const x = curve(0, 1, 2, 1, 0, -1, -2, -1, 0)
  const content: Content = { title: 'toe', unit: 'deg', lines: [], over: { label: 'travel', unit: 'mm', curve: x } }

  test('is drawn once, from end to end', () => {
    expect(drawnSteps(line(x), { ...content, once: true }, x)).toEqual([2, 6])
    expect(drawnSteps(line(x), content, x)).toEqual([0, 8])
    // A way back with other values, as of a crank that turns, is drawn as well. The bend between steps is no
    // difference.
    const loop = curve(0, 1, 2, 3, 4, 5, 6, 7, 8)
    expect(drawnSteps(line(loop), { ...content, once: true }, x)).toEqual([0, 8])
    const bent = x.map((value) => Math.sin(value / 2))
    const late = x.map((value, k) => (k < 3 ? value : value - 0.3))
    const sine = late.map((value) => Math.sin(value / 2))
    expect(drawnSteps(line(bent), { ...content, once: true }, x)).toEqual([2, 6])
    expect(drawnSteps(line(sine, late), { ...content, once: true }, x)).toEqual([2, 6])
    // Measured points are all drawn.
    expect(drawnSteps({ ...line(x), free: true }, { ...content, once: true }, x)).toEqual([0, 8])
  })

  test('has the range of all lines that are not hidden, each over its own abscissa', () => {
    const lines = [line(curve(1, 2), curve(0, 1)), { ...line(curve(50, 60), curve(0, 1)), hidden: true }]
    expect(drawnRange({ ...content, lines }, x)).toEqual([1, 2])
    expect(drawnRange({ ...content, lines, part: [0, 0.5] }, x)).toEqual([1, 1.5])
  })
})

describe('columns of exported curves', () => {
  vi.stubGlobal('document', { documentElement: { classList: { contains: () => false } } })
  vi.stubGlobal('matchMedia', () => ({ matches: false }))
  vi.stubGlobal('getComputedStyle', () => ({ getPropertyValue: () => '#000' }))
  afterAll(() => void vi.unstubAllGlobals())
  const STEPS = 3
  const quantity = (index: number, name: string) => ({
    ...{ index, name, group: 'measure', kind: 'angle', units: ['deg', 'deg/s', 'deg/s^2'] as const },
    curves: [curve(0, 1, 2), curve(1, 1, 1), curve(0, 0, 0)] as const,
    wanted: curve(),
  })
  const variable = (index: number, name: string): Variable => ({
    ...crank().variables[0],
    ...{ index, name, unit: 'mm', typical: null, note: '' },
    sensitivities: new Map([
      [0, { curves: [curve(1, 2, 3 + index), curve(), curve()], peaks: [3, 0, 0], extremes: [3 + index, 0, 0] }],
    ]),
  })
  const report = crank({
    times: curve(...Array(STEPS).keys()),
    quantities: [quantity(0, 'toe'), quantity(1, 'camber')],
    variables: [variable(0, 'st_y'), variable(1, 'ti_z')],
  })
  const headings = (content: Content) => content.lines.map((line) => headingOf(line, content))

  test('name the quantity, also in a plot of several', () => {
    const subject = { quantity: 0, order: 0 as const, also: [1] }
    const values = valueContent(new State(report), subject)
    expect([values.title, ...headings(values)]).toEqual(['toe, camber', 'toe', 'camber'])
    const changes = valueContent(new State(report), { ...subject, difference: true })
    expect([changes.title, ...headings(changes)]).toEqual(['Δ toe, camber', 'Δ toe', 'Δ camber'])
  })

  test('name the variable of each derivative, whichever is selected', () => {
    const content = sensitivityContent(new State(report), { quantity: 0, order: 0 })
    expect(content.title).toBe('Sensitivities of toe')
    expect(headings(content).sort()).toEqual(['d toe / d st_y', 'd toe / d ti_z'])
  })
})

describe('an axis of a single value', () => {
  test('has it in the middle, with round numbers on both sides', () => {
    for (const value of [1, 0.3, -2e6, 0]) {
      const { at, ticks } = linearAxis([value, value], 0, 100, 4)
      expect(at(value)).toBeCloseTo(50, 9)
      expect(ticks.length).toBeGreaterThan(2)
      expect(ticks.every((tick) => at(tick.value) >= 0 && at(tick.value) <= 100)).toBe(true)
    }
  })
})

describe('values at an abscissa', () => {
  test('are those wherever a curve reaches it, in the order of the motion', () => {
    const [x, y] = [curve(0, 10, 20, 10, 0), curve(0, 1, 4, 7, 9)]
    const at = (value: number) => crossings([x], [y], x, value, [0, 4])
    expect(at(10)).toEqual([1, 7])
    expect(at(15).map((found) => Number(found.toFixed(6)))).toEqual([2.5, 5.5])
    expect(at(30)).toEqual([])
    expect(crossings([x], [y], x, 10, [0, 2])).toEqual([1])
  })

  test('are interpolated by polynomials of the fifth degree where rates are known', () => {
    // y = sin(t) over x = t², whose values are known in closed form.
    const times = curve(1, 1.5, 2)
    const of = (f: (t: number) => number) => times.map(f)
    const y = [of(Math.sin), of(Math.cos), of((t) => -Math.sin(t))]
    const x = [of((t) => t * t), of((t) => 2 * t), of(() => 2)]
    expect(crossings(x, y, times, 3, [0, 2])[0]).toBeCloseTo(Math.sin(Math.sqrt(3)), 6)
    expect(crossings([times], y, times, 1.7, [0, 2])[0]).toBeCloseTo(Math.sin(1.7), 6)
    expect(crossings([times], y.slice(0, 2), times, 1.7, [0, 2])[0]).toBeCloseTo(Math.sin(1.7), 3)
    expect(Math.abs(crossings([times], y.slice(0, 1), times, 1.7, [0, 2])[0] - Math.sin(1.7))).toBeGreaterThan(0.01)
  })
})

describe('measured data', () => {
  const measuredOf = (text: string, file: string, subject: MeasuredSubject) => measuredFile(text, file, subject).curves
  const angles = ['toe', 'camber'].map((name) => ({ name, unit: 'deg' }))
  const subject = { quantities: angles, over: { name: 'wheel_travel', unit: 'mm' } }

  test('are columns by their names, or the first two', () => {
    const named = measuredOf('wheel_travel [mm],camber (deg)\n-10,1.5\n10,2\n', 'rig.csv', subject)
    expect(named.map(({ label, x, y }) => [label, ...x, ...y])).toEqual([['camber, rig.csv', -10, 10, 1.5, 2]])
    const bare = measuredOf('# a rig\n-10;1,5\n10;2\n', 'rig.csv', subject)
    expect(bare.map(({ label, x, y }) => [label, ...x, ...y])).toEqual([['toe, rig.csv', -10, 10, 1.5, 2]])
  })

  test('are converted to the units of the plot, which may be over a force', () => {
    const loaded = { quantities: angles, over: { name: 'left_side', unit: 'N' } }
    const [rig] = measuredOf('left_side [kN],toe [rad]\n-1,0\n0.5,0.01\n', 'rig.csv', loaded)
    expect([...rig.x]).toEqual([-1000, 500])
    expect(rig.y[1]).toBeCloseTo(0.573, 3)
    const inSI = { quantities: [{ name: 'toe', unit: 'rad' }], over: { name: 'left_align', unit: 'N*m' } }
    const [turned] = measuredOf('left_align (N mm);toe (deg)\n1000;180\n', 'rig.csv', inSI)
    expect([turned.x[0], turned.y[0]]).toEqual([1, Math.fround(Math.PI)])
    // Words in brackets that are no unit.
    expect([...measuredOf('left_side,toe (front)\n1,2\n', 'rig.csv', loaded)[0].y]).toEqual([2])
    const wrong = () => measuredOf('left_side [mm],toe [deg]\n1,2\n', 'rig.csv', loaded)
    expect(wrong).toThrow('`left_side [mm]` of `rig.csv` is no N, as left_side is')
  })

  test('are converted from units that are made of others, and refused where the page has no such unit', () => {
    const speed = { quantities: [{ name: 'speed', unit: 'deg/s' }], over: { name: 'time', unit: 's' } }
    const read = (text: string, subject: MeasuredSubject = speed) => measuredOf(text, 'rig.csv', subject)[0]
    const rig = read('time [min],speed [rad/s]\n0.5,1\n')
    expect([rig.x[0], rig.y[0]]).toEqual([30, Math.fround(180 / Math.PI)])
    expect(read('time [ms],speed [rpm]\n500,1\n').y[0]).toBeCloseTo(6, 5)
    const stiff = { quantities: [{ name: 'rate', unit: 'N*mm/deg' }], over: { name: 'a', unit: 'mm/s^2' } }
    const both = read('a [m/s²],rate [N m/rad]\n2,180\n', stiff)
    expect([both.x[0], both.y[0]]).toEqual([2000, Math.fround(180_000 * (Math.PI / 180))])
    expect(() => read('time [s],speed [furlong/s]\n0,1\n')).toThrow('the page has no unit `furlong/s`')
    expect(() => read('time [s],speed (ft/lap)\n0,1\n')).toThrow('the page has no unit `ft/lap`')
    expect(() => read('time [s],speed [rad]\n0,1\n')).toThrow('is no deg/s, as speed is')
  })

  test('of another measure or over another one are no data of this plot', () => {
    const known = ['toe', 'camber', 'wheel_travel']
    const read =
      (text: string, isForUnnamed = true) =>
      () =>
        measuredOf(text, 'rig.csv', { ...subject, known, isForUnnamed })
    expect(read('time [s],toe [deg]\n0,1\n')).toThrow(
      '`rig.csv` has no column `wheel_travel`: it has time [s], toe [deg]',
    )
    // `t` is time in the tables of the command.
    expect(read('t,toe\n0,1\n')).toThrow('`rig.csv` has no column `wheel_travel`')
    const overTime = { quantities: angles, over: { name: 'time', unit: 's' } }
    expect(measuredOf('toe,camber,t [ms]\n1,2,500\n', 'rig.csv', overTime)[1].x[0]).toBe(0.5)
    expect(read('wheel_travel,time\n0,1\n')).toThrow('`rig.csv` has no column `toe`')
    expect(read('Travel,Toe at rig\n0,1\n')()[0].y[0]).toBe(1)
    expect(read('Travel,Toe at rig\n0,1\n', false)).toThrow('`rig.csv` has no column `wheel_travel`')
    // A rate has its own name, or says by its unit that it is one.
    const velocity = { name: 'toe velocity', unit: 'deg/s', rateOf: 'toe' }
    const rate = (text: string) => () =>
      measuredOf(text, 'rig.csv', { quantities: [velocity], over: subject.over, known })
    expect(rate('wheel_travel,toe [rad/s]\n0,1\n')()[0].y[0]).toBeCloseTo(180 / Math.PI, 4)
    expect(rate('wheel_travel,toe [deg]\n0,1\n')).toThrow('`rig.csv` has no column `toe velocity`')
  })

  test('have lines that cannot be read, which are counted', () => {
    const read = (text: string) => {
      const { curves, unread } = measuredFile(text, 'rig.csv', subject)
      return [...curves.map(({ y }) => [...y].filter((value) => !Number.isNaN(value))), unread]
    }
    expect(read('wheel_travel,toe\n-50,1,25\n0,0.5,\n')).toEqual([
      [0.5],
      'Line 2 of `rig.csv` could not be read: `-50,1,25`',
    ])
    expect(read('# rig\nwheel_travel;toe\n\n-50;1.250,5\n0;0,5\n10;\n60\n')).toEqual([
      [0.5],
      '3 lines of `rig.csv` could not be read. The first is line 4: `-50;1.250,5`',
    ])
    // An empty cell is no value.
    expect(read('wheel_travel,toe,camber\n0,1,\n1,,2\n')).toEqual([[1], [2], ''])
  })

  test('with numbers that are not finite are refused', () => {
    for (const [x, y] of [
      ['1e400', '1'],
      ['1', '1e400'],
      ['1', '-Infinity'],
      ['1', '1e39'],
    ])
      expect(() => measuredOf(`wheel_travel,toe\n0,0\n${x},${y}\n`, 'rig.csv', subject)).toThrow(
        `Line 3 of \`rig.csv\`: \`${x === '1' ? y : x}\` is not finite`,
      )
  })

  test('that are none are refused by name', () => {
    expect(() => measuredOf('only one\n', 'rig.csv', subject)).toThrow('`rig.csv` needs two columns of numbers')
    expect(() => measuredOf('a,b\nx,y\n', 'rig.csv', subject)).toThrow('no numbers')
  })
})

test('an ordinate has at least three numbers, whatever its range', () => {
  for (let k = 0; k < 200; k++) {
    const low = -3 + 0.037 * k
    expect(ticks([low, low + 0.01 * 1.07 ** k], 3).length).toBeGreaterThanOrEqual(3)
  }
})
