import type { Flat } from '../flat'

/** Fewest and most teeth that are still distinguished; real counts between them are drawn as they are. */
const FEWEST = 12
const MOST = 48
/** Most teeth of a gear whose mate has few enough: its teeth are as large as that one's. */
const MATE = 144
/** Maximum error of the ratio of drawn teeth: after a turn they are less than a tenth of a tooth apart. */
const RATIO_ERROR = 1e-3
/** Height of a tooth as a part of the pitch, and its most as a part of the smaller gear's radius. */
const HEIGHT = { ofPitch: 0.62, ofRadius: 0.16 }
/** Corners of a tooth, relative to the pitch from its middle: its foot and its tip. */
const FOOT = 0.26
const TIP = 0.1

/** Number of teeth that are drawn on two gears: in their ratio, so that they mesh while they turn. */
export function drawnTeeth([a, b]: [number, number]): [number, number] {
  const [few, many] = a < b ? [a, b] : [b, a]
  if (Number.isInteger(a) && Number.isInteger(b) && few >= FEWEST && few <= MOST && many <= MATE) return [a, b]
  const error = (n: number) => Math.abs((n * many) / few - Math.round((n * many) / few)) / ((n * many) / few)
  const counts = Array.from({ length: MOST - FEWEST + 1 }, (_, k) => FEWEST + k)
  const fewer =
    counts.find((n) => error(n) < RATIO_ERROR) ?? counts.reduce((best, n) => (error(n) < error(best) ? n : best))
  const more = Math.round((fewer * many) / few)
  return a < b ? [fewer, more] : [more, fewer]
}

/** Height of the teeth of a gear and of all that mesh with it, none of which is smaller. */
export function toothHeight(teeth: number, radius: number): number {
  return Math.min((HEIGHT.ofPitch * 2 * Math.PI * radius) / teeth, HEIGHT.ofRadius * radius)
}

/**
 * Outline of a gear about the origin, the middle of a tooth at angle `phase`; an internal gear's teeth point inwards.
 */
export function gearOutline(teeth: number, radius: number, height: number, phase = 0, internal = false): Flat[] {
  const half = height / 2
  const [root, tip] = internal ? [radius + half, radius - half] : [radius - half, radius + half]
  const corners: [number, number][] = [
    [-FOOT, root],
    [-TIP, tip],
    [TIP, tip],
    [FOOT, root],
  ]
  return Array.from({ length: teeth }, (_, k) => k).flatMap((k) =>
    corners.map(([part, r]): Flat => {
      const angle = phase + ((k + part) * 2 * Math.PI) / teeth
      return [r * Math.cos(angle), r * Math.sin(angle)]
    }),
  )
}

/** Outline of a rack along x, its teeth towards +y and its pitch line on y = 0; the middle of a gap at x = 0. */
export function rackOutline(pitch: number, from: number, to: number, height: number, depth: number): Flat[] {
  const first = Math.ceil(from / pitch - 0.5)
  const last = Math.max(first, Math.floor(to / pitch - 0.5))
  const middles = Array.from({ length: last - first + 1 }, (_, k) => (first + k + 0.5) * pitch)
  const tooth = (x: number): Flat[] => [
    [x + FOOT * pitch, -height / 2],
    [x + TIP * pitch, height / 2],
    [x - TIP * pitch, height / 2],
    [x - FOOT * pitch, -height / 2],
  ]
  const [left, right] = [(first + 0) * pitch, (last + 1) * pitch]
  return [
    [left, -depth],
    [right, -depth],
    [right, -height / 2],
    ...middles.reverse().flatMap(tooth),
    [left, -height / 2],
  ]
}
