import { Group, InstancedMesh, Matrix4, type Mesh, SphereGeometry, Vector3 } from 'three'
import { stepAt } from '../../curve'
import { roundBelow } from '../../format'
import { above, ABOVE, over } from '../arrow'
import type { PathPoint } from '../../state'
import type { Draw, Drawable, Frame } from '../drawable'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

/** Width of the line, px; of the former design's. */
const LINE = 2.2
const FORMER = 1.5
/** Radius of the dots, and of the present point, in units. */
const DOT = 0.6
const PRESENT = 1.05
/** Minimum number of marked times, uniformly spaced. */
const DOTS = 12

/** The paths of the chosen points. */
export const traces: Draw = (mechanism, kit, choice) => choice.traces.flatMap((at) => trace(mechanism, kit, at))

/**
 * The path of a point, with dots at equal times, which show its speed, and a larger one where it is; gaps
 * where there is no solution.
 */
function trace(mechanism: Mechanism, kit: Kit, [body, point]: PathPoint): Drawable[] {
  const track = mechanism.report.bodies[body]
  const place = new Vector3(...track.skeleton[point])
  const { trace: colour, former } = kit.palette
  const part = { kind: 'mark' as const, index: body, name: track.labels[point] || track.name, about: 'path' }
  const lift = mechanism.lift(0, mechanism.topLayer + 2)
  const at = (step: number) => mechanism.worldAt(body, place, step).add(lift)

  const group = new Group()
  const was = mechanism.former
  if (was) {
    const formerPlace = new Vector3(...was.report.bodies[body].skeleton[point])
    const before = pieces(was.report.times.length, (step) => was.worldAt(body, formerPlace, step).add(lift))
    for (const piece of before)
      group.add(above(kit.line(piece, former, FORMER, { dashed: true, over: true }), ABOVE.former))
  }
  for (const piece of pieces(mechanism.report.times.length, at))
    group.add(above(kit.line(piece, colour, LINE, { over: true }), ABOVE.trace))
  group.add(dots(kit, equalTimes(mechanism.report.times).map(at).filter(solved)))

  const present = above(dot(kit, PRESENT * kit.unit, colour), ABOVE.trace)
  const follow = (frame: Frame) => {
    present.visible = frame.visible(body)
    if (present.visible) present.position.copy(frame.at(body, place)).add(lift)
  }
  return [
    { object: group, part, overlay: true },
    { object: present, part, follow, overlay: true },
  ]
}

/** The runs of steps that have a solution, each at least two long. */
export function pieces(steps: number, at: (step: number) => Vector3): Vector3[][] {
  const found: Vector3[][] = [[]]
  for (let step = 0; step < steps; step++) {
    const place = at(step)
    if (solved(place)) found[found.length - 1].push(place)
    else if (found[found.length - 1].length > 0) found.push([])
  }
  return found.filter((piece) => piece.length > 1)
}

/** Fractional steps at round, equal times. */
export function equalTimes(times: Float32Array): number[] {
  const last = times[times.length - 1]
  const span = last - times[0]
  if (!(span > 0)) return []
  const interval = roundBelow(span / DOTS)
  const count = Math.floor(span / interval + 1e-6)
  return Array.from({ length: count + 1 }, (_, k) => stepAt(times, Math.min(times[0] + k * interval, last)))
}

function dot(kit: Kit, radius: number, colour: string): Mesh {
  return over(kit, `dot ${radius}`, () => new SphereGeometry(radius, 20, 14), colour)
}

function dots(kit: Kit, places: Vector3[]): InstancedMesh {
  const one = dot(kit, DOT * kit.unit, kit.palette.trace)
  const all = new InstancedMesh(one.geometry, one.material, places.length)
  places.forEach((place, k) => all.setMatrixAt(k, new Matrix4().setPosition(place)))
  return above(all, ABOVE.trace)
}

function solved({ x, y, z }: Vector3): boolean {
  return Number.isFinite(x + y + z)
}
