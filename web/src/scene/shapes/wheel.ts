import type { Flat } from '../flat'

/** Half of a tyre's width and the rim's radius as parts of the wheel's radius. */
export const HALF_WIDTH = 0.3
export const RIM = 0.66

/** Section of a tyre: radius and height along the axis, round the rubber from one bead to the other and back. */
export function tyreSection(radius: number): Flat[] {
  const half = HALF_WIDTH * radius
  const shoulder: Flat[] = [
    [0.86, 1.05],
    [0.95, 0.92],
    [1, 0.62],
  ]
  const outer = shoulder.map(([r, w]): Flat => [r * radius, w * half])
  const inner = shoulder.map(([r, w]): Flat => [r * radius, -w * half]).reverse()
  const bead = RIM * radius
  return [[bead, half], ...outer, ...inner, [bead, -half], [bead, half]]
}
