import { describe, expect, test } from 'vitest'
import { type Content, drawnRange, drawnSteps, type Line } from '../src/content'
import { changeFrom } from '../src/curve'
import { ticks } from '../src/export/axis'
import { measuredOf } from '../src/page/measured'
import { crossing } from '../src/page/value_table'

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
    // Measured points are all drawn.
    expect(drawnSteps({ ...line(x), free: true }, { ...content, once: true }, x)).toEqual([0, 8])
  })

  test('has the range of all lines that are not hidden, each over its own abscissa', () => {
    const lines = [line(curve(1, 2), curve(0, 1)), { ...line(curve(50, 60), curve(0, 1)), hidden: true }]
    expect(drawnRange({ ...content, lines }, x)).toEqual([1, 2])
    expect(drawnRange({ ...content, lines, part: [0, 0.5] }, x)).toEqual([1, 1.5])
  })
})

test('values at an abscissa are those where the curve first reaches it', () => {
  const [x, y] = [curve(0, 10, 20, 10, 0), curve(0, 1, 4, 7, 9)]
  expect(crossing(x, y, 10)).toBe(1)
  expect(crossing(x, y, 15)).toBe(2.5)
  expect(crossing(x, y, 30)).toBeNaN()
})

describe('measured data', () => {
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
