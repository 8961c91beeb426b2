import { Quaternion, Vector3 } from 'three'
import { describe, expect, test } from 'vitest'
import type { MovableHardpoint } from '../src/engine/protocol'
import { facingPlane, Positions, type SharedVariable } from '../src/studio/moves'
import { pasted } from '../src/studio/points'
import { stopReason } from '../src/studio/stops'

const grip = (name: string, place: [number, number, number]): MovableHardpoint => {
  const at = (axis: string) => ({ variable: `${name}.${axis}`, sign: 1, bounds: null })
  return { name, place, coordinates: [at('x'), at('y'), at('z')] }
}
const [left, right] = [grip('left', [1, 20, 3]), grip('right', [1, -20, 3])]
const both = (axis: 0 | 1 | 2, bounds: SharedVariable['bounds'] = null): SharedVariable => {
  const along = new Vector3().setComponent(axis, 1)
  const other = along.clone().multiply(new Vector3(1, -1, 1))
  return {
    name: `both_${'xyz'[axis]}`,
    bounds,
    moves: new Map([
      ['left', along],
      ['right', other],
    ]),
  }
}
const partner = { axis: 1, grip: right }
const nonzero = (settings: { name: string; by: number }[]) => settings.filter(({ by }) => by !== 0)

describe('a mirrored move', () => {
  test('changes the variable that moves both sides, and nothing else', () => {
    const positions = new Positions([left, right], [both(1), both(2)])
    const { settings } = positions.settings(left, new Vector3(1, 21, 11.22), [], partner)
    expect(nonzero(settings)).toEqual([
      { name: 'both_y', by: 1 },
      { name: 'both_z', by: 8.22 },
    ])
    expect(positions.of(right, settings).toArray()).toEqual([1, -21, 11.22])
  })

  test('without such a variable changes the coordinates of both', () => {
    const { settings } = new Positions([left, right], []).settings(left, new Vector3(1, 20, 4), [], partner)
    expect(nonzero(settings)).toEqual([
      { name: 'left.z', by: 1 },
      { name: 'right.z', by: 1 },
    ])
  })

  test('stops both at the bound of the variable', () => {
    const positions = new Positions([left, right], [both(2, [-2, 2])])
    const { settings, bound } = positions.settings(left, new Vector3(1.5, 20, 9), [], partner)
    expect(bound).toBe('both_z')
    expect(nonzero(settings)).toEqual([
      { name: 'both_z', by: 2 },
      { name: 'left.x', by: 0.5 },
      { name: 'right.x', by: 0.5 },
    ])
  })
})

test('a hardpoint is where a variable of both sides has moved it', () => {
  const positions = new Positions([left, right], [both(2)])
  const settings = [
    { name: 'both_z', by: 5 },
    { name: 'left.z', by: 1 },
  ]
  expect(positions.of(left, settings).z).toBe(9)
  expect(positions.of(right, settings).z).toBe(8)
})

test('the plane of two axes that faces the eye', () => {
  expect(facingPlane(new Quaternion(), new Vector3(0.9, 0.1, 0.4))).toBe('yz')
  expect(facingPlane(new Quaternion(), new Vector3(0, 0.1, -1))).toBe('xy')
})

describe('rows of a spreadsheet', () => {
  const read = (text: string, first = 0, axis = 0) => {
    const { places, problems } = pasted(text, [left, right], ({ place }) => new Vector3(...place), 'mm', {
      first,
      axis,
    })
    return { places: [...places].map(([{ name }, place]) => [name, ...place.toArray()]), problems }
  }
  test('set hardpoints by name, below a line of titles', () => {
    expect(read('hardpoint\tx\ty\tz\nright\t1,5\t-2\t1 in\r\nleft\t\t7\t\n')).toEqual({
      places: [
        ['right', 1.5, -2, 25.4],
        ['left', 1, 7, 3],
      ],
      problems: [],
    })
  })
  test('have the unit of their titles, or of a line below them', () => {
    const inches = { places: [['left', 152.4, 330.2, -76.2]], problems: [] }
    for (const text of [
      'name\tx [in]\ty [in]\tz [in]\nleft\t6\t13\t-3',
      'name x [in] y [in] z [in]\nleft 6 13 -3',
      'name\tx\ty\tz\n-\tin\tin\tin\nleft\t6\t33,02 cm\t-3',
      ';x;y;z\n;[in];[in];[in]\nleft;6;13;-3',
      '#z [IN]\tPoint\tY (in)\tx [in]\n-3\tleft\t13\t6',
      'unit\tin\tin\tin\nleft\t6\t13\t-3',
      'hardpoint, long. [in], lat. [in], vert. [in]\nleft, 6, 13, -3',
      'x [in]\ty [in]\tz [in]\n6\t13\t-3',
    ])
      expect(read(text), text).toEqual(inches)
    expect(read('Front axle\nhardpoint\tlongitudinal\tlateral\tvertical\nleft\t6\t13\t-3').places).toEqual([
      ['left', 6, 13, -3],
    ])
  })
  test('in units that are unknown or contradict each other are refused', () => {
    const unknown = 'There is no unit `furlong`; use mm, cm, m, in, deg or rad.'
    for (const [text, problem] of [
      ['name\tx [furlong]\ty [furlong]\tz [furlong]', unknown],
      ['name\tx\ty\tz\n-\tfurlong\tfurlong\tfurlong', unknown],
      ['name\tx [deg]\ty [deg]\tz [deg]', 'This is a length, but deg is not a unit of length.'],
      ['name\tx [in]\ty\tz [in]', 'The coordinates have different units: in, none, in.'],
      ['name\tx [m]\ty [m]\tz [m]\n\tin\tin\tin', 'The unit `in` below the titles contradicts `m` in them.'],
    ])
      expect(read(`${text}\nleft\t6\t13\t-3`), text).toEqual({ places: [], problems: [problem] })
  })
  test('without names begin where they are pasted', () => {
    expect(read('8\t9\n', 1, 1).places).toEqual([['right', 1, 8, 9]])
    expect(read('1;2;3\n4;5;6\n7;8;9').problems).toEqual(['There are more rows than hardpoints.'])
  })
  test('that cannot be read are named', () => {
    expect(read('top\t1\t2\t3\nleft\t1\tx\t3')).toEqual({
      places: [],
      problems: ['There is no hardpoint `top`.', '`left`, y: `x` is not a number with a unit.'],
    })
  })
})

describe('the reason why a design is not the requested one', () => {
  test('is about the design in hand, with the time at which it locks', () => {
    const locks = 'the changed design: the mechanism cannot move beyond t = 0.776887 s'
    expect(stopReason(locks, true)).toBe('Locks at t = 0.777 s; shown is the last position that works')
    expect(stopReason('the mechanism cannot move beyond t = 6.038286e-7 s', false)).toMatch(/^Locks at t = 6\.04e−7 s/)
    expect(
      stopReason('the changed design: the mechanism locks at t = 0.5 s: joint `a` cannot stay closed', false),
    ).toBe('Locks at t = 0.5 s: joint `a` cannot stay closed')
    expect(stopReason('the mechanism passes a dead point at t = 1 s', false)).toBe(
      'The mechanism passes a dead point at t = 1 s',
    )
  })
})
