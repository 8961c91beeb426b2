import { Group, Vector3 } from 'three'
import type { WheelMark } from '../../payload'
import type { Drawable } from '../drawable'
import { Basis } from '../flat'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { HALF_WIDTH, RIM, tyreSection } from '../shapes/wheel'

/** Circles on both sides: radius and width relative to the wheel's radius and half width, line in px, opacity. */
const CIRCLES = [
  { radius: 1, side: 0.62, line: 1.1, opacity: 0.55 },
  { radius: RIM, side: 1, line: 1.3, opacity: 0.7 },
  { radius: 0.9, side: 1.04, line: 0.8, opacity: 0.35 },
]
/** Spokes: number, inner radius, offset outboard in half widths, line in px, opacity. */
const SPOKES = { count: 5, from: 0.2, side: 0.25, line: 2.2, opacity: 0.28 }

const X = new Vector3(1, 0, 0)
const Z = new Vector3(0, 0, 1)

/** Road wheels: a tyre that casts a shadow and hides nothing. */
export function wheels(mechanism: Mechanism, kit: Kit): Drawable[] {
  return mechanism.report.wheels.map((wheel, index) => ({
    body: wheel.centre.body,
    object: tyre(kit, wheel, mechanism.into(wheel.centre.body, mechanism.up)),
    part: { kind: 'wheel', index, name: wheel.name, about: 'road wheel' },
  }))
}

function tyre(kit: Kit, { centre, axis, radius }: WheelMark, up: Vector3): Group {
  const { palette } = kit
  const half = HALF_WIDTH * radius
  // Made about its own axis z, so that what it is made of depends on its radius only.
  const basis = new Basis(new Vector3(), Z, X)
  const on = (r: number, angle: number, side: number) =>
    basis.from([r * radius * Math.cos(angle), r * radius * Math.sin(angle)], side * half)
  const rubber = kit.lathe(basis.origin, basis.normal, tyreSection(radius), palette.tyre, { opacity: palette.glass })
  const circles = CIRCLES.flatMap(({ radius: r, side, line, opacity }) =>
    [-side, side].map((height) =>
      kit.line(
        Array.from({ length: 97 }, (_, k) => on(r, (k * Math.PI) / 48, height)),
        palette.tyre,
        line,
        { opacity, key: `circle ${r * radius} ${height * half}` },
      ),
    ),
  )
  const spokes = Array.from({ length: SPOKES.count }, (_, k) => (2 * Math.PI * k) / SPOKES.count).flatMap((angle) => [
    on(SPOKES.from, angle, SPOKES.side),
    on(RIM, angle, SPOKES.side),
  ])
  const wheel = new Group().add(
    rubber,
    kit.shadowOf(rubber),
    ...circles,
    kit.lines(spokes, palette.tyre, SPOKES.line, { opacity: SPOKES.opacity, key: `spokes ${radius}` }),
  )
  wheel.applyMatrix4(new Basis(new Vector3(...centre.at), new Vector3(...axis), up).matrix())
  // Placed by its parts' group, as all that is drawn.
  return new Group().add(wheel)
}
