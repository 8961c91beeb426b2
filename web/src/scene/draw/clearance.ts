import { BufferAttribute, BufferGeometry, Float32BufferAttribute, Group, Object3D, PlaneGeometry, Vector3 } from 'three'
import { nearest } from '../../clearance'
import type { Shape } from '../../report'
import { above, ABOVE } from '../arrow'
import type { Draw, Drawable, Frame, Part } from '../drawable'
import type { Flat } from '../flat'
import { type Kit, place, stretch } from '../kit'
import type { Mechanism } from '../mechanism'

/** Opacity of shapes: what they surround is seen. */
const OPACITY = 0.32
/** Points of a quarter of a circle in a profile. */
const QUARTER = 8
/** Side of a plane's square, relative to the size of the mechanism. */
const SQUARE = 0.8
/** Width of the line between nearest points, px, and radius of its ends in units. */
const LINE = 2
const END = 0.35
const UP = new Vector3(0, 1, 0)

/** Shapes between which clearances are measured, translucent in the colours of their bodies. */
export const shapes: Draw = (mechanism, kit, { shapes: shown }) => {
  const marks = mechanism.report.clearance?.shapes ?? []
  return shown ? marks.map((shape, index) => drawnShape(mechanism, kit, shape, index)) : []
}

function drawnShape(mechanism: Mechanism, kit: Kit, shape: Shape, index: number): Drawable {
  const { name, kind, body, places } = shape
  const about = `${kind} on ${mechanism.report.bodies[body].name}`
  const part: Part = { kind: 'shape', index, name, about }
  const colour = kit.body(body)
  // A rod without a body of its own goes from one body to another.
  if (places.length === 2 && places.some((end) => end.body !== body)) return { part, ...between(kit, shape, colour) }
  return { body, object: fixed(mechanism, kit, shape, colour), part }
}

/** A shape in the frame of its body. */
function fixed(mechanism: Mechanism, kit: Kit, shape: Shape, colour: string): Object3D {
  const { radius, half_width: half, round } = shape
  const points = shape.places.map(({ at }) => new Vector3(...at))
  const axis = new Vector3(...(shape.axis ?? [0, 1, 0]))
  const finish = { opacity: OPACITY }
  switch (shape.kind) {
    case 'sphere':
      return kit.ball(points[0], radius, colour, finish)
    case 'ring':
      return kit.lathe(points[0], axis, circle(radius, round), colour, finish)
    case 'tyre':
      return kit.lathe(points[0], axis, drum(radius, half, round), colour, finish)
    case 'capsule':
    case 'cylinder': {
      const [from, to] = points
      const length = from.distanceTo(to)
      const profile = shape.kind === 'capsule' ? capsule(radius, length / 2) : drum(radius, length / 2, round)
      const along = length > 0 ? to.clone().sub(from) : UP
      return kit.lathe(from.clone().lerp(to, 0.5), along, profile, colour, finish)
    }
    case 'plane': {
      const side = SQUARE * mechanism.size
      const square = new PlaneGeometry(side, side).rotateX(-Math.PI / 2)
      return place(kit.mesh(square, colour, finish), points[0], axis)
    }
    default:
      return faceted(kit, shape, points, colour)
  }
}

/** A hull between its corners, or a mesh. */
function faceted(kit: Kit, { vertices, triangles }: Shape, corners: Vector3[], colour: string): Object3D {
  const positions = vertices.length > 0 ? vertices : Float32Array.from(corners.flatMap((corner) => corner.toArray()))
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setIndex(new BufferAttribute(Uint32Array.from(triangles), 1))
  geometry.computeVertexNormals()
  return kit.mesh(geometry, colour, { opacity: OPACITY, facets: true })
}

/** A capsule or cylinder whose ends are on two bodies. */
function between(kit: Kit, shape: Shape, colour: string): Pick<Drawable, 'object' | 'follow'> {
  const { places, radius, round, kind } = shape
  const finish = { opacity: OPACITY }
  // A cap is made above its place; that of a cylinder lies below, by its edge.
  const inset = kind === 'capsule' ? 0 : round
  const cap: Flat[] = kind === 'capsule' ? arc(radius, 0, 0) : [...arc(round, radius - round, 0), [0, round]]
  const side = kit.lathe(
    new Vector3(),
    UP,
    [
      [radius, -0.5],
      [radius, 0.5],
    ],
    colour,
    finish,
  )
  const ends = [0, 1].map(() => kit.lathe(new Vector3(), UP, cap, colour, finish))
  const object = new Group().add(side, ...ends)
  const follow = (frame: Frame) => {
    const [from, to] = places.map(({ body, at }) => frame.at(body, new Vector3(...at)))
    const along = to.clone().sub(from)
    object.visible = along.length() > 2 * inset
    if (!object.visible) return
    const by = along.clone().setLength(inset)
    const [low, high] = [from.clone().add(by), to.clone().sub(by)]
    stretch(side, low, high)
    place(ends[0], low, along.clone().negate())
    place(ends[1], high, along)
  }
  return { object, follow }
}

/** A quarter of a circle about (r, h), from outside to the end. */
function arc(radius: number, r: number, h: number): Flat[] {
  return Array.from({ length: QUARTER + 1 }, (_, k): Flat => {
    const angle = (k * Math.PI) / (2 * QUARTER)
    return [r + radius * Math.cos(angle), h + radius * Math.sin(angle)]
  })
}

/** Profile of a shape from its lower to its upper end, from that of the upper half. */
function mirrored(upper: Flat[]): Flat[] {
  return [...upper.map(([r, h]): Flat => [r, -h]).reverse(), ...upper]
}

/** Profile of a capsule whose ends are `half` from its middle. */
function capsule(radius: number, half: number): Flat[] {
  return mirrored(arc(radius, 0, half))
}

/** Profile of a cylinder with rounded edges. */
export function drum(radius: number, half: number, round: number): Flat[] {
  const edge = round > 0 ? arc(round, radius - round, half - round) : [[radius, half] as Flat]
  return mirrored([...edge, [0, half]])
}

/** Profile of a ring: the circle of its bar. */
function circle(radius: number, round: number): Flat[] {
  return Array.from({ length: 4 * QUARTER + 1 }, (_, k): Flat => {
    const angle = (k * Math.PI) / (2 * QUARTER)
    return [radius + round * Math.cos(angle), round * Math.sin(angle)]
  })
}

/** The line between the nearest points of each clearance; red where the shapes touch. */
export const nearestLines: Draw = (mechanism, kit, { shapes: shown }) => {
  const { report } = mechanism
  const marks = (shown && report.clearance?.clearances) || []
  return marks.map(({ name }, index): Drawable => {
    const { label, load } = kit.palette
    const drawn = [label, load].map((colour) => lineOf(kit, colour))
    const object = new Group().add(...drawn.map(({ object }) => object))
    const follow = ({ step }: Frame) => {
      const found = nearest(report, index, step)
      object.visible = found !== undefined
      if (!found) return
      const touching = Number(found.distance < 0)
      const [p, q] = found.points.map((point) => new Vector3(...point))
      drawn.forEach((one, k) => {
        one.object.visible = k === touching
        one.put(p, q)
      })
    }
    return { object, follow, part: { kind: 'mark', index, name, about: 'least distance of shapes' }, overlay: true }
  })
}

function lineOf(kit: Kit, colour: string): { object: Group; put: (p: Vector3, q: Vector3) => void } {
  const half = UP.clone().multiplyScalar(0.5)
  const line = kit.line([half.clone().negate(), half], colour, LINE, { over: true })
  const ends = [0, 1].map(() => {
    const ball = kit.ball(new Vector3(), END * kit.unit, colour)
    ball.material = kit.flat(colour, { over: true })
    return ball
  })
  const object = new Group().add(...[line, ...ends].map((one) => above(one, ABOVE.dimension)))
  return {
    object,
    put: (p, q) => {
      stretch(line, p, q)
      ends.forEach((ball, k) => ball.position.copy([p, q][k]))
    },
  }
}
