import { roundBelow } from '../format'
import type { Report, Variable } from '../report'

/** A change that is seen: so far the hardpoints go, as a part of the mechanism's size. */
const SEEN = 0.08
/** And so far they turn at most, rad. */
const TURNED = 0.2

/** Range of a slider in both directions: up to the bounds of the model, or until the change is visible. */
export function reach(report: Report, { arrows, bounds, typical, tolerance }: Variable): [low: number, high: number] {
  const speed = Math.max(0, ...arrows.map(({ v }) => Math.hypot(...v)))
  const turn = Math.max(0, ...arrows.map(({ turn }) => Math.hypot(...turn)))
  const seen = Math.min(speed > 0 ? (SEEN * sizeOf(report)) / speed : Infinity, turn > 0 ? TURNED / turn : Infinity)
  const usual = Number.isFinite(seen) ? roundBelow(seen) : Math.max(10 * (typical ?? 0), 10 * (tolerance ?? 0))
  return [bounds?.[0] ?? -usual, bounds?.[1] ?? usual]
}

/** Diagonal of the box round the hardpoints, each in the frame of its body: good enough for the length of a slider. */
function sizeOf({ bodies }: Report): number {
  let square = 0
  for (let axis = 0; axis < 3; axis++) {
    const along = bodies.flatMap(({ skeleton, poses }) => skeleton.map((point) => point[axis] + (poses[axis] || 0)))
    if (along.length > 0)
      square +=
        along
          .reduce((low, x) => [Math.min(low[0], x), Math.max(low[1], x)], [Infinity, -Infinity])
          .reduce((low, high) => high - low) ** 2
  }
  return Math.sqrt(square)
}
