import { Group, Vector3 } from 'three'
import { number } from '../../format'
import type { Load } from '../../report'
import { forceAt, largestForce } from '../../loads/force'
import { ABOVE, straightArrow } from '../arrow'
import type { Draw, Drawable, Frame } from '../drawable'
import { place } from '../kit'
import type { Mechanism } from '../mechanism'

/** The largest force of the motion as a part of the mechanism's size, and its least length in units. */
const LONGEST = { ofSize: 0.24, least: 14 }
/** Radius of the shaft, length of the head, in units. */
const SHAFT = 0.42
const HEAD = 3
/** Below this part of the largest force there is nothing to be seen. */
const SEEN = 2e-3

/**
 * Reactions of joints on their second bodies, forces of springs on their ends, and given forces on their points, in
 * proportion: as long as in the design as loaded.
 */
export const loads: Draw = (mechanism, kit, choice) => {
  const { report, base } = mechanism
  const maximum = largestForce((base ?? mechanism).report.loads)
  if (!choice.forces || maximum === 0) return []
  const longest = Math.max(LONGEST.ofSize * mechanism.size, LONGEST.least * kit.unit)
  return report.loads.flatMap((load, index): Drawable[] => {
    if (load.force.length === 0) return []
    const { at, joint } = load
    const on = report.bodies[at.body].name
    const known = load.is_part ? ', determined part' : ''
    const about = `force on ${on}${known}: at most ${number(largestForce([load]), 3)} N`
    const part =
      joint === null
        ? { kind: 'load' as const, index, name: load.name, about }
        : { kind: 'joint' as const, index: joint, name: load.name, about }
    const length = (step: number) => (forceAt(load.force, step).length() / maximum) * longest
    const arrow = straightArrow(
      kit,
      new Vector3(),
      new Vector3(0, longest, 0),
      { head: HEAD * kit.unit, shaft: { radius: SHAFT * kit.unit } },
      kit.palette.load,
      ABOVE.load,
    )
    const [head, shaft] = arrow.children
    const foot = new Vector3(...at.at).add(mechanism.lift(at.body, mechanism.topLayer + 3))
    const follow = (frame: Frame) => {
      const long = length(frame.step)
      arrow.visible = frame.visible(at.body) && long > SEEN * longest
      if (!arrow.visible) return
      // A head is never longer than its arrow.
      const tip = Math.min(HEAD * kit.unit, 0.6 * long)
      head.scale.setScalar(tip / (HEAD * kit.unit))
      head.position.y = long - tip / 2
      shaft.scale.y = (long - 0.7 * tip) / shaftLength
      shaft.position.y = (long - 0.7 * tip) / 2
      place(arrow, frame.at(at.body, foot), forceAt(load.force, frame.step))
    }
    const shaftLength = longest - 0.7 * Math.min(HEAD * kit.unit, 0.45 * longest)
    return [{ object: new Group().add(arrow), follow, part, overlay: true }]
  })
}

/** Scale of the arrows: `longest force 1200 N`; undefined without any. */
export function forceText({ base, report }: Mechanism): string {
  const maximum = report.loads.some(({ force }: Load) => force.length > 0)
    ? largestForce((base?.report ?? report).loads)
    : 0
  return maximum > 0 ? `Force arrows: up to ${number(maximum, 3)} N` : ''
}
