/**
 * Smaller is rounding: as a share of the largest of its kind, and of a size in the reader's units, whatever it is of.
 */
const ROUNDING = 1e-9

/** Relative variation below which a quantity counts as constant. */
export const RESOLUTION = 1e-5

/** A number, 0 where it is rounding next to the largest of its kind. */
export function rounded(value: number, largest = 1): number {
  return Math.abs(value) <= ROUNDING * largest ? 0 : value
}

/** Relative excess over a limit up to which it is met: that to which a search keeps its limits (`LIMIT_KEPT`). */
const AT_LIMIT = 1e-8

/** The change of a number of some size up to which it is as good as none. */
export function noise(size: number): number {
  return Math.max(RESOLUTION * Math.abs(size), ROUNDING)
}

/** Excess of a number of some size over a limit up to which the limit is met. */
export function tolerated(size: number): number {
  return Math.max(AT_LIMIT * Math.abs(size), ROUNDING)
}
