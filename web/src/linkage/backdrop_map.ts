import type { Place } from './linkage'

/**
 * From a picture to a plane: the pixel (u, v), v downwards, is at `at` + `scale` R(`turn`) (u, -v). The scale is in
 * units of length per pixel, the turn in radians.
 */
export interface PictureMap {
  at: Place
  scale: number
  turn: number
}

/** Changes that two clicked points with their distance make, beyond the scale. */
export interface Alignment {
  /** The first point becomes the origin. */
  isOrigin: boolean
  /** The second point lies in the direction of x from the first one. */
  isHorizontal: boolean
}

/** Least distance of the two points, pixels of the picture. */
const LEAST = 2

/** Place of a pixel of a picture in the plane. */
export function placeOf({ at, scale, turn }: PictureMap, [u, v]: Place): Place {
  const [c, s] = [scale * Math.cos(turn), scale * Math.sin(turn)]
  return [at[0] + c * u + s * v, at[1] + s * u - c * v]
}

/** Pixel of a picture at a place of the plane. */
export function pixelOf({ at, scale, turn }: PictureMap, [x, y]: Place): Place {
  const [c, s] = [Math.cos(turn) / scale, Math.sin(turn) / scale]
  const [dx, dy] = [x - at[0], y - at[1]]
  return [c * dx + s * dy, s * dx - c * dy]
}

/** A picture that fills the middle of what is seen. */
export function fitted([width, height]: Place, middle: Place, seen: Place): PictureMap {
  const scale = Math.min(seen[0] / width, seen[1] / height)
  return { at: [middle[0] - (scale * width) / 2, middle[1] + (scale * height) / 2], scale, turn: 0 }
}

/**
 * The map by which two places of the plane, on the picture as it is now, get a real distance; the first one stays where
 * it is unless it becomes the origin. A sentence where that is impossible.
 */
export function calibrated(
  map: PictureMap,
  [first, second]: readonly [Place, Place],
  distance: number,
  { isOrigin, isHorizontal }: Alignment,
): PictureMap | string {
  const [a, b] = [pixelOf(map, first), pixelOf(map, second)]
  const [du, dv] = [b[0] - a[0], b[1] - a[1]]
  const pixels = Math.hypot(du, dv)
  if (pixels < LEAST) return 'The two points are at the same place of the picture. Click two that are apart.'
  if (!(distance > 0)) return 'The distance of the two points must be positive.'
  const scale = distance / pixels
  const turn = isHorizontal ? Math.atan2(dv, du) : map.turn
  const [x, y] = placeOf({ at: [0, 0], scale, turn }, a)
  const [toX, toY] = isOrigin ? [0, 0] : first
  return { at: [toX - x, toY - y], scale, turn }
}
