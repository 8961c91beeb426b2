import type { Drawable } from '../drawable'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { member } from './joint_rod'
import { formOf } from './strut'

/** Measured distances that are springs or dampers: as the model says, else from ground beside wheels. */
export function distances(mechanism: Mechanism, kit: Kit): Drawable[] {
  const { distances, wheels } = mechanism.report
  return distances.flatMap(({ name, from, to, draw }, index): Drawable[] => {
    const grounded = (from.body === 0) !== (to.body === 0)
    const form = formOf(draw) ?? (grounded && wheels.length > 0 ? 'coilover' : undefined)
    return form
      ? [
          {
            ...member(mechanism, kit, form, from, to),
            part: { kind: 'distance', index, name, about: `measured distance, shown as a ${form}` },
          },
        ]
      : []
  })
}
