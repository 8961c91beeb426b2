import type { Drawn } from '../drawn'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { member } from './joint_rod'
import { formOf } from './strut'

/** Measured distances that are springs or dampers: as given in the model, otherwise those from ground near wheels. */
export function distances(mechanism: Mechanism, kit: Kit): Drawn[] {
  const { distances, wheels } = mechanism.report
  return distances.flatMap(({ name, from, to, draw }, index): Drawn[] => {
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
