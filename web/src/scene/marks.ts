import type { Variable } from '../report'
import { designVelocity } from './design_velocity'
import { dimension } from './dimension'
import type { Drawn } from './drawn'
import type { Kit } from './kit'
import type { Mechanism } from './mechanism'
import { trace, type Traced } from './trace'

/** What the reader has chosen to see on the mechanism. */
export interface Marked {
  /** The variable whose design velocity is shown, and by how much the design drawn is changed by it. */
  variable?: Variable
  change?: number
  /** Points whose paths are drawn. */
  traced?: Traced[]
  /** The measured distance whose value is pointed at, an index into the report's distances. */
  distance?: number
}

/** Arrows, paths and dimension lines of what is chosen; made anew when the choice changes. */
export function marks(mechanism: Mechanism, kit: Kit, { variable, change = 0, traced = [], distance }: Marked): Drawn[] {
  return [
    ...traced.flatMap((one) => trace(mechanism, kit, one)),
    ...(distance === undefined ? [] : dimension(mechanism, kit, distance)),
    ...(variable ? designVelocity(mechanism, kit, variable, change) : []),
  ]
}
