import { Group, type Object3D, TubeGeometry, Vector3 } from 'three'
import type { Kit } from '../kit'
import { stretch } from '../kit'
import { Helix } from '../shapes/helix'

/** Drawing of a massless member. */
export type Form = 'rod' | 'cylinder' | 'damper' | 'spring' | 'coilover'

const FORMS: Form[] = ['rod', 'cylinder', 'damper', 'spring', 'coilover']

/** The form that a model names, if it does. */
export function formOf(draw: string | null | undefined): Form | undefined {
  return FORMS.find((form) => form === draw)
}

/** A member drawn between two places of the world. */
export interface Strut {
  object: Object3D
  /** Puts its ends at the two places; the first is its upper end where that matters. */
  span(from: Vector3, to: Vector3): void
}

/** Radius of a rod. */
const ROD = 0.72
/**
 * A cylinder: radius of barrel and collar, thickness of the collar, radii of piston rod and neck, the neck's length.
 */
const BARREL = { radius: 1.75, collar: 2, collarHeight: 1.1, piston: 0.8, neck: 0.9, neckLength: 1.7 }
/** A damper is a slimmer cylinder. */
const SLIM = 0.75
/**
 * Spring: radius of the coil and of its wire, turns; radius and thickness of its seats, and their positions along the
 * length.
 */
const COIL = { radius: 3.2, wire: 0.55, turns: 6.5, seat: 3.9, seatHeight: 0.7, from: 0.06, to: 0.66, step: 1.05 }
/** Body and rod of the damper inside a spring. */
const INSIDE = { body: 1.7, rod: 0.7, bodyFrom: 0.5, rodTo: 0.6 }

/** `length` is that in the first position; `barrel` that of a cylinder's barrel, the same at all times. */
export function strut(kit: Kit, form: Form, length: number, barrel = 0.6 * length): Strut {
  switch (form) {
    case 'rod':
      return rod(kit)
    case 'cylinder':
      return cylinder(kit, 1, barrel)
    case 'damper':
      return cylinder(kit, SLIM, barrel)
    case 'spring':
      return spring(kit, length, false)
    case 'coilover':
      return spring(kit, length, true)
  }
}

/** A round bar of length 1 along y about the origin, to be stretched. */
const bar = (kit: Kit, radius: number, colour: string) => {
  const mesh = kit.disc(new Vector3(), new Vector3(0, 1, 0), 1, 1, colour)
  mesh.scale.set(radius, 1, radius)
  return mesh
}

function rod(kit: Kit): Strut {
  const mesh = bar(kit, ROD * kit.unit, kit.palette.rod)
  return { object: mesh, span: (from, to) => void stretch(mesh, from, to) }
}

function cylinder(kit: Kit, slim: number, length: number): Strut {
  const s = slim * kit.unit
  const { rod: grey, steel } = kit.palette
  const [neck, barrel, collar] = [BARREL.neck, BARREL.radius, BARREL.collar].map((radius) => bar(kit, radius * s, grey))
  const piston = bar(kit, BARREL.piston * s, steel)
  const span = (from: Vector3, to: Vector3) => {
    const along = to.clone().sub(from).normalize()
    const at = (t: number) => from.clone().addScaledVector(along, t)
    // A short leg still shows its barrel.
    const mouth = Math.max(length, 2 * BARREL.neckLength * s)
    stretch(neck, from, at(BARREL.neckLength * s))
    stretch(barrel, at((BARREL.neckLength - 0.1) * s), at(mouth))
    stretch(collar, at(mouth - (BARREL.collarHeight * s) / 2), at(mouth + (BARREL.collarHeight * s) / 2))
    stretch(piston, at(mouth), to)
  }
  return { object: new Group().add(neck, barrel, collar, piston), span }
}

function spring(kit: Kit, length: number, damped: boolean): Strut {
  const s = kit.unit
  const { rod: grey, steel } = kit.palette
  // Made with about its initial length, so that stretching hardly changes its wire; small changes of a design share it.
  const height = COIL.step ** Math.round(Math.log(Math.max((COIL.to - COIL.from) * length, s)) / Math.log(COIL.step))
  const wound = () =>
    new TubeGeometry(new Helix(COIL.radius * s, height, COIL.turns), 240, COIL.wire * s, 8).translate(0, -height / 2, 0)
  const coil = kit.keyed(`coil ${s} ${height}`, wound, grey)
  const seats = [0, 1].map(() => bar(kit, COIL.seat * s, grey))
  const [body, piston] = [bar(kit, INSIDE.body * s, grey), bar(kit, (damped ? INSIDE.rod : ROD) * s, steel)]
  const object = new Group().add(coil, ...seats, piston, ...(damped ? [body] : []))
  const span = (from: Vector3, to: Vector3) => {
    const at = (share: number) => from.clone().lerp(to, share)
    const half = (COIL.seatHeight * s) / 2 / Math.max(from.distanceTo(to), Number.MIN_VALUE)
    stretch(coil, at(COIL.from), at(COIL.to))
    coil.scale.y /= height
    ;[COIL.from, COIL.to].forEach((share, k) => stretch(seats[k], at(share - half), at(share + half)))
    stretch(piston, from, at(damped ? INSIDE.rodTo : 1))
    stretch(body, at(INSIDE.bodyFrom), to)
  }
  return { object, span }
}
