import { Group, Vector3 } from 'three'
import type { Draw, Drawable } from '../drawable'
import { bodyPart } from '../part'
import { pieces } from './trace'

/** More measured points than this on moving bodies, and their paths would hide the mechanism. */
const MOST = 3
/** Width of the line, px, and its opacity. */
const LINE = { width: 1.4, opacity: 0.7 }
/** A path that stays within this part of the size is a point. */
const STILL = 0.01

/** Paths of measured points, where a body visibly reaches them and no joint holds them. */
export const paths: Draw = (mechanism, kit) => {
  const { report, vehicle, large } = mechanism
  if (vehicle || large || report.wheels.length > 0) return []
  const points = report.bodies.flatMap(({ skeleton, roles }, body) => {
    const reached = body === 0 ? [] : mechanism.shapePoints(body)
    return skeleton.flatMap((point, k) => {
      const at = new Vector3(...point)
      return roles[k] === 'measured' && reached.some((one) => mechanism.same(one, at)) ? [{ body, at }] : []
    })
  })
  if (points.length > MOST) return []
  return points.flatMap(({ body, at }): Drawable[] => {
    const lift = mechanism.lift(0)
    const runs = pieces(report.times.length, (step) => mechanism.worldAt(body, at, step).add(lift))
    const wide = runs.flat().some((place) => place.distanceTo(runs[0][0]) > STILL * mechanism.size)
    if (!wide) return []
    const lines = runs.map((run) => kit.line(run, kit.palette.trace, LINE.width, { opacity: LINE.opacity }))
    return [{ body: 0, object: new Group().add(...lines), part: bodyPart(mechanism, body) }]
  })
}
