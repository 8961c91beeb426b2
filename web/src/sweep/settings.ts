import type { VariableSetting } from '../engine/protocol'
import { extent } from '../export/axis'
import type { Report, Sweep } from '../report'

/** Error of the points of a sweep, which the page has in fewer digits: this part of the range of their axis. */
const POINT_ERROR = 1e-4

/**
 * Changes of the variables at a point; none where points are no designs. Points have rounded values: a design of the
 * report at the point is exact, and all others are within the bounds of their variables.
 */
export function settingsAt(
  { variables, designs }: Pick<Report, 'variables' | 'designs'>,
  sweep: Sweep,
  k: number,
): VariableSetting[] {
  const axes = sweep.axes.flatMap(({ name, nominal, values }) => {
    const variable = variables.findIndex((one) => one.name === name)
    const [low, high] = extent([values]) ?? [0, 0]
    return nominal === null ? [] : [{ name, variable, by: values[k] - nominal, error: POINT_ERROR * (high - low) }]
  })
  const exact = designs.find(
    ({ kind, change }) =>
      kind === 'exact' &&
      axes.every(({ variable, by, error }) => variable >= 0 && Math.abs((change[variable] ?? 0) - by) <= error) &&
      change.every((by, index) => by === 0 || axes.some(({ variable }) => variable === index)),
  )
  return axes.flatMap(({ name, variable, by }) => {
    const [low, high] = variables[variable]?.bounds ?? [null, null]
    const within = exact?.change[variable] ?? Math.min(Math.max(by, low ?? -Infinity), high ?? Infinity)
    return within === 0 ? [] : [{ name, by: within }]
  })
}
