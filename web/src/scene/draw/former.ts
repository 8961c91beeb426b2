import { Group, type Object3D, Vector3 } from 'three'
import type { JointMark } from '../../payload'
import { above, ABOVE } from '../arrow'
import { centreLines, differs } from '../centre_lines'
import type { Draw, Drawable, Frame } from '../drawable'
import { type Kit, stretch } from '../kit'
import type { Mechanism } from '../mechanism'

/** Nearer than this part of the size, a body is where it was. */
const SAME = 2e-4
/** Width of the dashes, and of the casing that separates them from the background, px. */
const DASHES = 2
const CASING = { width: 5, opacity: 0.75 }

/** The former design: its centre lines, dashed, of the bodies and rods that differ. */
export const formerDesign: Draw = (mechanism, kit) => {
  const { former, report } = mechanism
  if (!former) return []
  const minimum = SAME * mechanism.size
  const bodies = report.bodies.flatMap(({ name }, body): Drawable[] => {
    if (body === 0 || !differs(mechanism, former, body, minimum)) return []
    const lines = centreLines(former, body)
    // A block that one hardpoint represents has none.
    if (lines.length === 0) return []
    const lift = former.lift(body, former.topLayer + 2)
    const object = new Group().add(...lines.flatMap(([a, b]) => dashes(kit, a.clone().add(lift), b.clone().add(lift))))
    const follow = ({ step }: Frame) => {
      const pose = former.poseAt(body, step)
      object.visible = pose !== undefined
      if (pose) object.position.copy(pose.place), object.quaternion.copy(pose.turn)
    }
    return [{ object, follow, part: { kind: 'mark', index: body, name, about: 'reference design' }, overlay: true }]
  })
  const rods = former.report.joints.flatMap((joint, index): Drawable[] => {
    const rod = joint.kind === 'distance' || joint.kind === 'leg'
    if (!rod || !mechanism.moments.some((step) => separation(mechanism, former, index, step) > minimum)) return []
    const { object, follow } = formerRod(kit, former, joint)
    return [
      { object, follow, part: { kind: 'mark', index, name: joint.name, about: 'reference design' }, overlay: true },
    ]
  })
  return [...bodies, ...rods]
}

function formerRod(kit: Kit, former: Mechanism, joint: JointMark): Pick<Drawable, 'object' | 'follow'> {
  const [a, b] = [new Vector3(...joint.at_i), new Vector3(...joint.at_j)]
  const ends = (step: number) => [former.worldAt(joint.body_i, a, step), former.worldAt(joint.body_j, b, step)]
  const lengths = former.moments.map((step) => ends(step)[0].distanceTo(ends(step)[1])).filter(Number.isFinite)
  const length = Math.max(...lengths, 0)
  // Made as long as it ever is, so that the dashes keep their length within a little.
  const line = new Group().add(...dashes(kit, new Vector3(0, -length / 2, 0), new Vector3(0, length / 2, 0)))
  const object = new Group().add(line)
  const lift = former.lift(0, former.topLayer + 2)
  const follow = ({ step }: Frame) => {
    const [from, to] = ends(step).map((end) => end.add(lift))
    object.visible = Number.isFinite(from.x + to.x)
    if (!object.visible) return
    stretch(line, from, to)
    line.scale.y /= length || 1
  }
  return { object, follow }
}

function separation(present: Mechanism, former: Mechanism, joint: number, step: number): number {
  const [now, was] = [present, former].map((mechanism) => {
    const { body_i, body_j, at_i, at_j } = mechanism.report.joints[joint]
    return [
      mechanism.worldAt(body_i, new Vector3(...at_i), step),
      mechanism.worldAt(body_j, new Vector3(...at_j), step),
    ]
  })
  return Math.max(now[0].distanceTo(was[0]), now[1].distanceTo(was[1]))
}

function dashes(kit: Kit, a: Vector3, b: Vector3): Object3D[] {
  const { view, former } = kit.palette
  return [
    above(kit.line([a, b], view, CASING.width, { opacity: CASING.opacity, over: true }), ABOVE.casing),
    above(kit.line([a, b], former, DASHES, { dashed: true, over: true }), ABOVE.former),
  ]
}
