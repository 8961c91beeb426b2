import { describe, expect, test } from 'vitest'
import { designToml, isSameDesign } from '../src/studio/designs'

const TEXT = `name = "rig" # measured
[parameters]
arm = { value = 120, unit = "length", bounds = [100, 140] }

[hardpoints]
ball = [1, 2, 3]

[design]
rack_z = { move = "rack", along = "z" }
`

describe('a design in a text', () => {
  test('is a table of its changes, of a parameter its value; all else stays', () => {
    const settings = [
      { name: 'rack_z', by: 0.1 + 0.2 },
      { name: 'arm', by: -4 },
    ]
    const { text, added } = designToml(TEXT, 'stiff', settings, ['rack_z', 'arm'])
    expect(text).toBe(`${TEXT}\n[designs.stiff]\nrack_z = 0.3\narm = 116\n`)
    expect(added).toEqual([])
  })
  test('goes below the designs that are there, with its name in quotes where it has to be', () => {
    const before = `${TEXT}\n[designs.stiff]\nrack_z = 1 # mm\n\n[page]\nplots = []\n`
    expect(designToml(before, 'design 1', [{ name: 'rack_z', by: 2 }], ['rack_z', 'arm']).text).toBe(
      before.replace('1 # mm\n', '1 # mm\n\n[designs."design 1"]\nrack_z = 2\n'),
    )
  })
  test('makes a design variable of a moved coordinate, and none of a mirror image', () => {
    const settings = [
      { name: 'ball.z', by: 2 },
      { name: 'ball_image.z', by: 2 },
      { name: 'ball.x', by: 0 },
    ]
    const written = designToml(TEXT.replace('rack_z =', 'ball_z ='), 'a', settings, ['ball_z', 'arm'])
    expect(written.added).toEqual(['ball_z_2'])
    expect(written.settings).toEqual([{ name: 'ball_z_2', by: 2 }])
    expect(written.text).toContain('\nball_z_2 = { move = "ball", along = "z" }\n')
    expect(written.text).toMatch(/\[designs\.a\]\nball_z_2 = 2\n$/)
  })
})

test('designs are the same where all poses are, to single precision', () => {
  const of = (...curves: number[][]) =>
    ({ poses: curves.map((curve) => Float32Array.from(curve)) }) as Parameters<typeof isSameDesign>[0]
  expect(isSameDesign(of([0, 100]), of([0.0005, 100]))).toBe(true)
  expect(isSameDesign(of([0, 100]), of([0.005, 100]))).toBe(false)
  expect(isSameDesign(of([0, 100]), of([0, 100], [0, 100]))).toBe(false)
  expect(isSameDesign(of([0, 100]), of([0, NaN]))).toBe(false)
})
