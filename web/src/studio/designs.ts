import { namesIn, outline, text as string } from '../editor/toml'
import { setKey } from '../editor/toml_edit'
import type { VariableSetting } from '../engine/protocol'
import type { Design } from '../report'
import { nominalOf } from './goal'
import { free } from './target'

/** Significant digits of a written number: the rest is rounding of the sums that make it. */
const DIGITS = 12
/** Poses of the same design agree to this part of the largest coordinate: curves are of single precision. */
const SAME = 1e-5

/** A model's text with a design in `[designs]`. */
export interface WrittenDesign {
  text: string
  /** The changes as the text has them, of design variables only. */
  settings: VariableSetting[]
  /** Names of the design variables that were added to `[design]`, one for each moved coordinate. */
  added: string[]
}

/**
 * Writes a design as `[designs.NAME]`. A moved coordinate becomes a design variable, unless its point is the mirror
 * image of another one and has no numbers of its own. All else of the text stays as it is.
 */
export function designToml(
  text: string,
  name: string,
  settings: readonly VariableSetting[],
  variables: readonly string[],
): WrittenDesign {
  const written: WrittenDesign = { text, settings: [], added: [] }
  const points = namesIn(outline(text), 'hardpoints')
  for (const { name: changed, by } of settings) {
    if (by === 0) continue
    const [, point, axis] = variables.includes(changed) ? [] : (/^(.*)\.([xyz])$/.exec(changed) ?? [])
    if (point !== undefined && !points.includes(point)) continue
    let variable = changed
    if (point !== undefined) {
      variable = free(`${point}_${axis}`, [...variables, ...namesIn(outline(written.text), 'design')])
      const entry = `{ move = ${string(point)}, along = ${string(axis)} }`
      written.text = setKey(written.text, ['design'], variable, entry)
      written.added.push(variable)
    }
    written.settings.push({ name: variable, by })
  }
  for (const { name: variable, by } of written.settings) {
    const value = Number((by + nominalOf(text, variable)).toPrecision(DIGITS))
    written.text = setKey(written.text, ['designs', name], variable, String(value))
  }
  return written
}

/** True if the bodies of two solved designs have the same poses at all output times. */
export function isSameDesign(a: Design, b: Design): boolean {
  const size = (x: number) => (Number.isNaN(x) ? 0 : Math.abs(x))
  const largest = a.poses.reduce((all, curve) => curve.reduce((max, x) => Math.max(max, size(x)), all), 0)
  const isSame = (x: number, y: number) => Object.is(x, y) || Math.abs(x - y) <= SAME * largest
  return (
    a.poses.length === b.poses.length &&
    a.poses.every((curve, k) => curve.length === b.poses[k].length && curve.every((x, n) => isSame(x, b.poses[k][n])))
  )
}
