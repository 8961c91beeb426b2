import { type Order, type Report, type Sensitivity, type Variable } from './report'
import { rounded } from './rounding'

/** Effect of a variable on the selected quantity. */
export interface Effect {
  variable: Variable
  sensitivity: Sensitivity
  /** The sensitivity where it is largest in size, with its sign. */
  extreme: number
  /** Size of the effect relative to the largest among variables of the same unit, or of all typical changes; 0 to 1. */
  share: number
}

/**
 * Variables with a sensitivity of the quantity, largest effect first: by their typical changes where all of them have
 * one, else by peak over time within each unit, units in the order of their first variable. Those without effect come
 * last.
 */
export function effects(report: Report, quantity: number, order: Order): Effect[] {
  const found: Effect[] = []
  for (const variable of report.variables) {
    const sensitivity = variable.sensitivities.get(quantity)
    // Of body origins, velocities and accelerations may be left out.
    if (sensitivity?.curves[order].length)
      found.push({ variable, sensitivity, extreme: sensitivity.extremes[order], share: 0 })
  }
  const typical = found.length > 0 && found.every(({ variable }) => variable.typical !== null)
  const size = ({ variable, extreme }: Effect) => Math.abs(extreme) * (typical ? Math.abs(variable.typical ?? 0) : 1)
  const kind = ({ variable }: Effect) => (typical ? '' : variable.unit)
  const kinds = [...new Set(found.map(kind))]
  const largest = new Map(
    kinds.map((name) => [name, Math.max(...found.filter((item) => kind(item) === name).map(size))]),
  )
  for (const item of found) {
    const maximum = largest.get(kind(item)) ?? 0
    item.share = maximum > 0 ? rounded(size(item) / maximum) : 0
  }
  return found.sort(
    (a, b) =>
      Number(a.share === 0) - Number(b.share === 0) ||
      kinds.indexOf(kind(a)) - kinds.indexOf(kind(b)) ||
      b.share - a.share ||
      a.variable.index - b.variable.index,
  )
}
