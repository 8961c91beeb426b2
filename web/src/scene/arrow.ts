import {
  type BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Group,
  type Mesh,
  type Object3D,
  TorusGeometry,
  Vector3,
} from 'three'
import { type Kit, place } from './kit'

/** Drawing order of the layers above the mechanism, from the lowest to the highest. */
export const ABOVE = { casing: 1, former: 2, trace: 3, driver: 4, dimension: 5, load: 6, velocity: 7 }

/** Radius of a head as a part of its length. */
const HEAD = 0.42
/** No head is longer than this part of its arrow. */
const HEAD_SHARE = 0.45
const Y = new Vector3(0, 1, 0)

/** Sizes of an arrow's parts. */
export interface ArrowSize {
  /** Length of a head. */
  head: number
  /** Radius of the shaft, or its width in pixels where it is a line. */
  shaft: { radius: number } | { pixels: number }
}

/** An arrow between two points, over everything; it has two heads for motion in both directions. */
export function straightArrow(
  kit: Kit,
  from: Vector3,
  to: Vector3,
  { head, shaft }: ArrowSize,
  colour: string,
  layer: number,
  both = false,
): Group {
  const along = to.clone().sub(from)
  const length = along.length()
  const tip = Math.min(head, HEAD_SHARE * length)
  // The shaft ends inside the head.
  const [foot, end] = [both ? 0.7 * tip : 0, length - 0.7 * tip]
  const group = new Group().add(cone(kit, new Vector3(0, length, 0), Y, tip, colour))
  if (both) group.add(cone(kit, new Vector3(), Y.clone().negate(), tip, colour))
  if ('pixels' in shaft)
    group.add(kit.line([new Vector3(0, foot, 0), new Vector3(0, end, 0)], colour, shaft.pixels, { over: true }))
  else
    group.add(
      place(
        over(
          kit,
          `shaft ${shaft.radius} ${end - foot}`,
          () => new CylinderGeometry(shaft.radius, shaft.radius, end - foot, 12),
          colour,
        ),
        new Vector3(0, (foot + end) / 2, 0),
      ),
    )
  return above(place(group, from, length > 0 ? along : Y), layer)
}

/** Three quarters of a ring about an axis, with a head that shows the right-handed sense of the turn. */
export function ringArrow(
  kit: Kit,
  at: Vector3,
  axis: Vector3,
  ring: number,
  head: number,
  radius: number,
  colour: string,
  layer: number,
): Group {
  const sweep = 1.5 * Math.PI
  const angle = sweep - head / ring
  const arc = over(kit, `arc ${ring} ${radius} ${angle}`, () => new TorusGeometry(ring, radius, 8, 48, angle), colour)
  // The torus lies in xy; laid down, its axis is the y that `place` expects.
  const flat = new Group().add(arc, arcHead(kit, ring, sweep, 1, head, colour))
  flat.rotation.x = -Math.PI / 2
  return above(place(new Group().add(flat), at, axis), layer)
}

/** Points of an arc about z from one angle to another. */
export function arcPoints(radius: number, from: number, to: number): Vector3[] {
  const count = Math.max(2, Math.ceil(Math.abs(to - from) / 0.08))
  return Array.from({ length: count + 1 }, (_, k) => onArc(radius, from + (k / count) * (to - from)))
}

/** The head of an arc about z; `sense` 1 is counter-clockwise. */
export function arcHead(kit: Kit, radius: number, angle: number, sense: 1 | -1, head: number, colour: string): Mesh {
  // Its middle is on the arc, so that it neither leaves nor enters the circle.
  const middle = angle - (sense * head) / (2 * radius)
  const along = new Vector3(-Math.sin(middle), Math.cos(middle), 0).multiplyScalar(sense)
  return cone(kit, onArc(radius, middle).addScaledVector(along, head / 2), along, head, colour)
}

/** Draws an object and its children over everything in the given layer. */
export function above<T extends Object3D>(object: T, layer: number): T {
  object.traverse((one) => (one.renderOrder = layer))
  return object
}

function onArc(radius: number, angle: number): Vector3 {
  return new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), 0)
}

function cone(kit: Kit, tip: Vector3, along: Vector3, length: number, colour: string): Mesh {
  return place(
    over(kit, `head ${length}`, () => new ConeGeometry(HEAD * length, length, 20), colour),
    tip.clone().addScaledVector(along, -length / 2),
    along,
  )
}

/** A mesh without light that nothing hides; the key names all that its geometry depends on. */
export function over(kit: Kit, key: string, make: () => BufferGeometry, colour: string): Mesh {
  const mesh = kit.keyed(key, make, colour)
  mesh.material = kit.flat(colour, { over: true })
  mesh.castShadow = false
  return mesh
}
