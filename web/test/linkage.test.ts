import { execFileSync } from 'node:child_process'
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { describe, expect, inject, test } from 'vitest'
import {
  changed,
  EMPTY,
  lacking,
  type Linkage,
  linkageToml,
  renamed,
  withBar,
  withCorner,
  withoutBar,
  withoutPin,
  withPin,
} from '../src/linkage/linkage'

const { hardpoint } = inject('samples')

/** Joints A, B, ... at these places, with bars between each and the next. */
const chain = (...places: [number, number][]): Linkage => {
  const pins = places.reduce(withPin, EMPTY)
  return pins.pins.slice(1).reduce((made, { name }, k) => withBar(made, pins.pins[k].name, name), pins)
}
const fourBar = () => {
  const bars = chain([0, 0], [35, 60], [250, 190], [300, 0])
  const plate = withCorner(withPin(bars, [130, 200]), 'bar_2', 'E')
  return ['A', 'D'].reduce((made, name) => changed(made, name, { support: 'ground' }), plate)
}
const driven = (linkage: Linkage, name: string, motor: 'turn' | 'swing' = 'turn') => changed(linkage, name, { motor })

/** Result of the command for a text: degrees of freedom and solved steps, or the codes of its errors. */
function solve(linkage: Linkage): { summary?: { mobility: number; solved: number }; codes: string[] } {
  const folder = mkdtempSync(join(tmpdir(), 'hardpoint-linkage-'))
  try {
    const file = join(folder, 'linkage.toml')
    writeFileSync(file, linkageToml(linkage, 'mm'))
    const run = () => execFileSync(hardpoint, ['check', file, '--json'], { encoding: 'utf8', stdio: 'pipe' })
    try {
      const { model, steps } = JSON.parse(run())
      return { summary: { mobility: model.counts.mobility, solved: steps.solved }, codes: [] }
    } catch (error) {
      const { stdout } = error as { stdout: string }
      return { codes: JSON.parse(stdout).diagnostics.map(({ code }: { code: string }) => code) }
    }
  } finally {
    rmSync(folder, { recursive: true })
  }
}

describe('the text of a linkage', () => {
  test('is a whole model, in the order of the format', () => {
    expect(linkageToml(driven(fourBar(), 'A'), 'mm')).toBe(`# A planar linkage, drawn on the page.

name = "linkage"
units = { length = "mm", angle = "deg" }
planar = "xy"

[hardpoints]
A = [0, 0]
B = [35, 60]
C = [250, 190]
D = [300, 0]
E = [130, 200]

# Bodies by their hardpoints: where two have the same one, there is a pin of that name.
[bodies]
ground = ["A", "D"]
bar_1 = ["A", "B"]
bar_2 = ["B", "C", "E"]
bar_3 = ["C", "D"]

[drivers]
A_motor = { joint = "A", law = "360*t" }

[design]
A = { move = "A", along = "xy" }
B = { move = "B", along = "xy" }
C = { move = "C", along = "xy" }
D = { move = "D", along = "xy" }
E = { move = "E", along = "xy" }

[measures]
A_angle = { type = "coordinate", joint = "A" }
D_angle = { type = "coordinate", joint = "D" }

[page]
plots = [{ y = ["D_angle"], over = "A_angle" }]

[time]
end = 1
steps = 180
`)
  })

  test('of a four-bar is solved by the command for a whole turn', () => {
    const { summary, codes } = solve(driven(fourBar(), 'A'))
    expect(codes).toEqual([])
    expect(summary).toEqual({ mobility: 1, solved: 181 })
  })

  test('of a slider-crank along an inclined rail is solved, whichever end is driven', () => {
    const bars = chain([0, 0], [30, 40], [200, 10])
    const slider = { support: 'slider', direction: 12.5 } as const
    const crank = changed(changed(bars, 'A', { support: 'ground' }), 'C', slider)
    const text = linkageToml(driven(crank, 'A'), 'mm')
    expect(text).toContain('axis = [0.97629600712, 0.216439613938]')
    expect(text).toContain('plots = [{ y = ["C_travel"], over = "A_angle" }]')
    expect(solve(driven(crank, 'A')).summary).toEqual({ mobility: 1, solved: 181 })
    const pushed = changed(driven(crank, 'C'), 'C', { amplitude: 5 })
    // A slider moves to and fro: it has no whole turn.
    expect(linkageToml(pushed, 'mm')).toContain('C_motor = { joint = "C_slide", law = "5*sin(2*pi*t)" }')
    expect(solve(pushed).summary).toEqual({ mobility: 1, solved: 181 })
  })

  test('with several bars at one pin is solved: a six-bar', () => {
    const four = driven(fourBar(), 'A', 'swing')
    const more = withBar(withPin(four, [420, 60]), 'C', 'F')
    const six = changed(more, 'F', { support: 'slider' })
    // Angle and travel have different units, and a plot each.
    const plots = 'plots = [{ y = ["D_angle"], over = "A_angle" }, { y = ["F_travel"], over = "A_angle" }]'
    expect(linkageToml(six, 'mm')).toContain(plots)
    expect(solve(six).summary).toEqual({ mobility: 1, solved: 181 })
  })

  test('has no variable and no measure of a pivot without a bar', () => {
    const text = linkageToml(changed(withPin(driven(fourBar(), 'A'), [9, 9]), 'F', { support: 'ground' }), 'mm')
    expect(text).toContain('ground = ["A", "D", "F"]')
    expect(text).not.toMatch(/^F(_angle)? = \{/m)
  })

  test('that does not move, or is not driven, has the diagnostics of the command', () => {
    // Nothing drives it; two drivers for one freedom; a triangle on the ground.
    expect(solve(fourBar()).codes).toContain('HP0301')
    expect(solve(driven(driven(fourBar(), 'A'), 'D', 'swing')).codes).toContain('HP0302')
    const braced = withBar(driven(fourBar(), 'A', 'swing'), 'A', 'C')
    expect(solve(braced).codes).toContain('HP0303')
  })
})

describe('changes of a linkage', () => {
  test('a bar is there once, and needs two joints', () => {
    const two = chain([0, 0], [1, 0])
    expect(withBar(two, 'A', 'B')).toBe(two)
    expect(withBar(two, 'A', 'A')).toBe(two)
    expect(withCorner(two, 'bar_1', 'A').bars).toEqual(two.bars)
  })

  test('joints after Z have two characters, and a name that was freed is used again', () => {
    const many = Array.from({ length: 28 }, (_, k): [number, number] => [k, 0]).reduce(withPin, EMPTY)
    expect(many.pins.slice(24).map(({ name }) => name)).toEqual(['Y', 'Z', 'A1', 'B1'])
    expect(withPin(withoutPin(many, 'C'), [0, 0]).pins.at(-1)!.name).toBe('C')
  })

  test('without a joint, bars of two are gone and plates stay', () => {
    const rest = withoutPin(fourBar(), 'B')
    expect(rest.bars).toEqual([
      { name: 'bar_2', pins: ['C', 'E'] },
      { name: 'bar_3', pins: ['C', 'D'] },
    ])
    expect(withoutBar(rest, 'bar_3').bars).toHaveLength(1)
    // The next bar takes no name that is there.
    expect(withBar(rest, 'A', 'E').bars.at(-1)!.name).toBe('bar_4')
  })

  test('a new name is used everywhere; one that is taken or would need quotes is refused', () => {
    const named = renamed(driven(fourBar(), 'A'), 'pin', 'A', 'crank_pivot') as Linkage
    const text = linkageToml(named, 'mm')
    expect(text).toContain('crank_pivot_motor = { joint = "crank_pivot", law = "360*t" }')
    expect(text).toContain('bar_1 = ["crank_pivot", "B"]')
    expect(linkageToml(renamed(named, 'bar', 'bar_1', 'crank') as Linkage, 'mm')).toContain(
      'crank = ["crank_pivot", "B"]',
    )
    expect(renamed(named, 'pin', 'B', 'C')).toBe('`C` is there already.')
    expect(renamed(named, 'bar', 'bar_1', 'ground')).toBe('`ground` is there already.')
    for (const name of ['', '1', 'a b', 'ä', 'a.b']) expect(renamed(named, 'pin', 'B', name)).toMatch(/^A name has/)
    expect(renamed(named, 'pin', 'B', 'B')).toBe(named)
  })

  test('a joint without a support has no motor', () => {
    expect(driven(fourBar(), 'B').pins[1].motor).toBeUndefined()
    expect(changed(driven(fourBar(), 'A'), 'A', { support: 'free' }).pins[0].motor).toBeUndefined()
  })

  test('the next step is named until the engine can judge', () => {
    const steps = [EMPTY, withPin(EMPTY, [0, 0]), chain([0, 0], [1, 0]), fourBar(), driven(fourBar(), 'A')]
    const words = ['first joint', 'other end', 'Fixed pivot', 'Motor', undefined]
    steps.forEach((step, k) => {
      const said = lacking(step)
      if (words[k] === undefined) expect(said).toBeUndefined()
      else expect(said).toContain(words[k])
    })
  })
})
