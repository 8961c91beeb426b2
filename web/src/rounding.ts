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

/** The change of a number of some size up to which it is as good as none. */
export function noise(size: number): number {
  return Math.max(RESOLUTION * Math.abs(size), ROUNDING)
}
