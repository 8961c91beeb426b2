import { Group, Vector3 } from 'three'
import { above, ABOVE, straightArrow } from '../arrow'
import type { Draw, Frame } from '../drawable'
import { square } from '../flat'
import { place, stretch } from '../kit'
import type { Mechanism } from '../mechanism'

/** Offset of the dimension line, its heads, and the overhang of its ends, in units. */
const BESIDE = 7
const HEAD = 2.2
const OVER = 1
/** Width of the line, px. */
const LINE = 1.6

/** The highlighted measured distance, as a dashed dimension line next to its two points. */
export const dimension: Draw = (mechanism, kit, { distance: index }) => {
  if (index === undefined) return []
  const { name, from, to } = mechanism.report.distances[index]
  const s = kit.unit
  const { label: colour } = kit.palette
  const [a, b] = [from, to].map(({ at }) => new Vector3(...at))
  const ends = (frame: Frame) => [frame.at(from.body, a), frame.at(to.body, b)]
  const longest = Math.max(
    ...mechanism.moments.map((step) => span(ends(mechanism.frame(step)))).filter(Number.isFinite),
    s,
  )
  const y = new Vector3(0, 1, 0)
  const line = above(
    kit.line([y.clone().multiplyScalar(-longest / 2), y.clone().multiplyScalar(longest / 2)], colour, LINE, {
      dashed: true,
      over: true,
    }),
    ABOVE.dimension,
  )
  // Its heads are at both ends, at any length.
  const heads = [0, 1].map(() =>
    straightArrow(
      kit,
      new Vector3(0, -2 * HEAD * s, 0),
      new Vector3(),
      { head: HEAD * s, shaft: { pixels: LINE } },
      colour,
      ABOVE.dimension,
    ),
  )
  const feet = [0, 1].map(() =>
    above(
      kit.line([new Vector3(), y.clone().multiplyScalar((BESIDE + OVER) * s)], colour, 1, { over: true }),
      ABOVE.dimension,
    ),
  )
  const object = new Group().add(line, ...heads.map((head) => new Group().add(head)), ...feet)
  const follow = (frame: Frame) => {
    const [p, q] = ends(frame)
    const length = span([p, q])
    object.visible = length > 0
    if (!object.visible) return
    const along = q.clone().sub(p).normalize()
    const side = aside(mechanism, p.clone().lerp(q, 0.5), along)
    const [low, high] = [p, q].map((end) => end.clone().addScaledVector(side, BESIDE * s))
    stretch(line, low, high)
    line.scale.y /= longest
    place(object.children[1], low, along.clone().negate())
    place(object.children[2], high, along)
    feet.forEach((foot, k) => place(foot, [p, q][k], side))
  }
  return [{ object, follow, part: { kind: 'distance', index, name, about: 'measured distance' }, overlay: true }]
}

function span([p, q]: Vector3[]): number {
  return p.distanceTo(q)
}

/** Perpendicular to the line, away from the middle of the mechanism. */
function aside(mechanism: Mechanism, middle: Vector3, along: Vector3): Vector3 {
  const outwards = middle.sub(mechanism.centre)
  if (!mechanism.plane) return square(outwards, along)
  const side = mechanism.plane.clone().cross(along)
  return side.dot(outwards) < 0 ? side.negate() : side
}
