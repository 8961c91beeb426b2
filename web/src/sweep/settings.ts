import type { VariableSetting } from '../engine/protocol'
import type { Sweep } from '../report'

/** Changes of the variables at a point; none where points are no designs. */
export function settingsAt(sweep: Sweep, k: number): VariableSetting[] {
  return sweep.axes.flatMap(({ name, nominal, values }) =>
    nominal === null || values[k] === nominal ? [] : [{ name, by: values[k] - nominal }],
  )
}
