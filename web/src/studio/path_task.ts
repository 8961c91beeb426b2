import { text as string } from '../editor/toml'

/** Least number of points of a path that determine anything. */
export const LEAST_POINTS = 3

/** A path that a point of a linkage is to follow. */
export interface PathTask {
  /** In the plane of the mechanism, in the unit of length. */
  points: [x: number, y: number][]
  /** True if the path returns to its first point with every turn of the crank. */
  isClosed: boolean
  isFullTurn: boolean
}

/** Text of a task file for `hardpoint synthesize`. */
export function taskToml(
  { points, isClosed, isFullTurn }: PathTask,
  { model, units, axes }: { model: string; units: { length: string; angle: string }; axes: string },
): string {
  const row = (all: PathTask['points']) => `    ${all.map(([x, y]) => `[${x}, ${y}]`).join(', ')},`
  const rows = Array.from({ length: Math.ceil(points.length / 5) }, (_, k) => row(points.slice(5 * k, 5 * k + 5)))
  return [
    `# Points of a path in the ${axes} plane, from the picture of ${string(model)}.`,
    '#',
    '#   hardpoint synthesize path.toml -o results/path',
    '',
    'name = "path"',
    `units = { length = ${string(units.length)}, angle = ${string(units.angle)} }`,
    '',
    'points = [',
    ...rows,
    ']',
    `closed = ${isClosed}`,
    ...(isFullTurn ? ['full_turn = true'] : []),
    '',
  ].join('\n')
}
