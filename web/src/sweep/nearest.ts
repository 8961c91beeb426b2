/** The points that both coordinates are known of, in the order of the first. */
export function along(xs: ArrayLike<number>, ys: ArrayLike<number>): number[] {
  const known = Array.from({ length: xs.length }, (_, k) => k).filter(
    (k) => Number.isFinite(xs[k]) && Number.isFinite(ys[k]),
  )
  return known.sort((a, b) => xs[a] - xs[b] || ys[a] - ys[b] || a - b)
}

/** Nearest point to a position on the screen, if one is within reach. */
export function nearest(
  points: readonly number[],
  at: (k: number) => [number, number],
  [x, y]: [number, number],
  reach: number,
): number | undefined {
  let best: number | undefined
  let minimum = reach
  for (const k of points) {
    const [a, b] = at(k)
    const distance = Math.hypot(a - x, b - y)
    if (distance < minimum) [best, minimum] = [k, distance]
  }
  return best
}
