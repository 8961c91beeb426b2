import { Group, type Object3D, Vector3 } from 'three'
import { Basis, type Flat, round } from '../flat'
import type { Kit } from '../kit'
import { drawnTeeth, gearOutline, toothHeight } from '../shapes/toothing'
import type { DrawCoupler } from './coupler'

/** Holes: number, relative radius of their circle, size, and minimum wheel radius in units. */
const HOLES = { count: 5, at: 0.56, radius: 0.17, above: 14 }
/** Width of an internal gear's rim as a part of its radius. */
const RING = 0.18
/** Points of the pitch circle. */
const ROUND = 96

/** Two spur gears whose teeth mesh. */
export const gears: DrawCoupler = ({ mechanism, kit, train, coupler, index }) => {
  const pair = train.pair(index)
  if (!pair || coupler.sizes.length < 2) return []
  const [a, b] = pair
  const between = b.centre.clone().sub(a.centre)
  const distance = between.length()
  const sense = Math.sign(a.coefficient * b.coefficient * a.shaft.axis.dot(b.shaft.axis))
  const sizes: [number, number] = [Math.abs(coupler.sizes[0]), Math.abs(coupler.sizes[1])]
  const [n, m] = drawnTeeth(sizes)
  const internal = sense < 0
  const share = internal ? distance / Math.abs(sizes[0] - sizes[1]) : distance / (sizes[0] + sizes[1])
  const radii = sizes.map((size) => size * share)
  if (!(distance > 1e-6 * mechanism.size) || !radii.every(Number.isFinite)) return []
  const height = Math.min(toothHeight(n, radii[0]), toothHeight(m, radii[1]))
  // From a's centre to where they touch, and from b's.
  const touchA = between.clone().multiplyScalar(internal && sizes[0] < sizes[1] ? -1 : 1)
  const touchB = between.clone().multiplyScalar(internal && sizes[0] < sizes[1] ? -1 : internal ? 1 : -1)
  // A wheel of another coupler is not changed; the teeth of its mate go into its gaps.
  const [atA, atB] = [train.toothing(a, n, radii[0], touchA), train.toothing(b, m, radii[1], touchB)]
  const turned = (internal ? 1 : -1) * Math.sign(a.shaft.axis.dot(b.shaft.axis))
  const phaseA = atA ?? (atB === undefined ? 0 : (turned * m * (atB - Math.PI / m)) / n)
  const phaseB = atB ?? (turned * n * phaseA) / m + Math.PI / m
  if (atA === undefined) train.tooth(a, n, radii[0], touchA, phaseA)
  if (atB === undefined) train.tooth(b, m, radii[1], touchB, phaseB)
  return [
    {
      wheel: a,
      teeth: n,
      radius: radii[0],
      towards: touchA,
      phase: phaseA,
      ring: internal && sizes[0] > sizes[1],
      known: atA !== undefined,
    },
    {
      wheel: b,
      teeth: m,
      radius: radii[1],
      towards: touchB,
      phase: phaseB,
      ring: internal && sizes[1] > sizes[0],
      known: atB !== undefined,
    },
  ]
    .filter(({ known }) => !known)
    .map(({ wheel, teeth, radius, towards, phase, ring }) => {
      const { body } = wheel
      const into = (direction: Vector3) => mechanism.into(body, direction)
      const centre = mechanism.placeInto(body, wheel.centre).add(mechanism.lift(body))
      const basis = new Basis(centre, into(wheel.shaft.axis), into(towards))
      const outline = gearOutline(teeth, radius, height, phase, ring)
      const width = mechanism.plane ? mechanism.thickness : train.face
      const pieces = ring
        ? [kit.slab(round([[0, 0, radius * (1 + RING)]]), basis, width, kit.body(body), [outline], { edges: 50 })]
        : [kit.slab(outline, basis, width, kit.body(body), holes(radius, kit.unit), { edges: 50 })]
      return { body, object: new Group().add(...pieces, ...pitchCircles(kit, basis, radius, width)) }
    })
}

/** Holes show that a large gear turns. */
function holes(radius: number, unit: number): Flat[][] {
  if (radius <= HOLES.above * unit) return []
  return Array.from({ length: HOLES.count }, (_, k) => (2 * Math.PI * k) / HOLES.count).map((angle) =>
    round([[HOLES.at * radius * Math.cos(angle), HOLES.at * radius * Math.sin(angle), HOLES.radius * radius]]),
  )
}

/** The dashed pitch circle on both faces. */
export function pitchCircles(kit: Kit, basis: Basis, radius: number, width: number): Object3D[] {
  return [-1, 1].map((side) => {
    const circle = Array.from({ length: ROUND + 1 }, (_, k) => {
      const angle = (2 * Math.PI * k) / ROUND
      return basis.from([radius * Math.cos(angle), radius * Math.sin(angle)], side * (width / 2 + 0.06 * kit.unit))
    })
    return kit.line(circle, kit.palette.outline, 1, { dashed: true, opacity: 0.8 })
  })
}
