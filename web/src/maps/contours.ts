import { contours } from 'd3-contour'
import { extent, roundStep } from '../export/axis'

/** A table of numbers, row by row, over the places of two drivers; NaN where there is none. */
export interface Grid {
  columns: readonly number[]
  rows: readonly number[]
  values: ArrayLike<number>
}

/** Points of a line in the drivers' units. */
export type Line = [number, number][]

/** Region where the values are at least a level: an outline and its holes. */
export interface Area {
  level: number
  outlines: Line[]
}

/** Approximate number of levels between minimum and maximum. */
const LEVELS = 8

/** Round numbers between minimum and maximum; none if all are equal. */
export function levels(values: ArrayLike<number>): number[] {
  const [low, high] = extent([values]) ?? [0, 0]
  if (!(high > low)) return []
  const step = roundStep((high - low) / LEVELS)
  const first = Math.ceil(low / step)
  // From whole numbers, so that zero is zero.
  const all = Array.from({ length: Math.max(0, Math.floor(high / step) - first + 1) }, (_, k) => (first + k) * step)
  return all.filter((level) => level > low && level < high)
}

/** The areas above each level. Between places all is linear. */
export function areas({ columns, rows, values }: Grid, at: readonly number[]): Area[] {
  const find = contours().size([columns.length, rows.length]).smooth(true)
  const table = Array.from(values, (x) => (Number.isFinite(x) ? x : NaN))
  return at.map((level) => ({
    level,
    outlines: find
      .contour(table, level)
      .coordinates.flat()
      .map((ring) => ring.map(([x, y]): [number, number] => [along(columns, x), along(rows, y)])),
  }))
}

/** The place at a number of d3's grid, whose cells have their values in their middles. */
function along(places: readonly number[], at: number): number {
  const k = Math.min(Math.max(at - 0.5, 0), places.length - 1)
  const below = Math.min(Math.floor(k), places.length - 2)
  return places[below] + (places[below + 1] - places[below]) * (k - below)
}

/** Value at any point of the grid, by linear interpolation; NaN outside, and next to gaps. */
export function valueAt({ columns, rows, values }: Grid, x: number, y: number): number {
  const [i, s] = within(columns, x)
  const [j, t] = within(rows, y)
  if (i < 0 || j < 0) return NaN
  const value = (row: number, column: number) => values[row * columns.length + column]
  const edge = (row: number) => mixed(value(row, i), value(row, i + 1), s)
  return mixed(edge(j), edge(j + 1), t)
}

/** A value with zero weight may be missing. */
function mixed(a: number, b: number, part: number): number {
  return part === 0 ? a : part === 1 ? b : a + (b - a) * part
}

/** Interval that contains a number, and the fraction within it. */
function within(places: readonly number[], x: number): [interval: number, part: number] {
  const last = places.length - 1
  if (!(x >= places[0] && x <= places[last])) return [-1, 0]
  const above = places.findIndex((place) => place > x)
  const k = above < 0 ? last - 1 : above - 1
  return [k, (x - places[k]) / (places[k + 1] - places[k])]
}
