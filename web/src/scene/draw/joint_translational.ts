import { Group, type Object3D, Vector3 } from 'three'
import type { JointMark } from '../../payload'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { rackJoints } from '../shafts'
import type { Slide } from '../slide'
import { type DrawJoint, type Piece, piece } from './joint'
import { hatchedRails } from './rails'
import { type Form, formOf, strut } from './strut'

/**
 * Sides of a block: along the slide, across, and height in space; in a link's slot; of one that carries another slide.
 */
const BLOCK = { length: 5.2, across: 3.2, height: 3, width: 3.8 }
const SLOTTED = { length: 4.6, across: 2.9 }
const CARRIAGE = 9.5
/** Distance from the middle of a slide to its hatched lines, and their overhang beyond the travel. */
const LINE = { aside: 1.75, room: 3.9 }
/** A tube round a bar: outer and inner radius, length on ground and on a body. */
const TUBE = { outer: 1.9, inner: 1.35, onGround: 9, onBody: 7 }
/** Foot: down to the plate, radius, side of the plate. */
const FOOT = { down: 4.2, radius: 1.2, plate: 6 }
/** Rail in space: room beyond the travel; bars on a body: distance from the middle and radius. */
const RAIL = { room: 4.2, aside: 1.6, bar: 0.55 }

/**
 * A block on a rail or in a slot; a bar in a tube where the slider is a bar; a spring strut where the model says so.
 */
export const translational: DrawJoint = (mechanism, kit, joint, index) => {
  const slide = mechanism.slideOf(index)
  if (!slide) return []
  const form = formOf(joint.draw)
  if (form && form !== 'rod' && !mechanism.plane) return [slidingStrut(mechanism, kit, joint, slide, form)]
  if (mechanism.plane) return inPlane(mechanism, kit, slide)
  const { rail, block, place, blockPlace } = slide
  if (isBar(mechanism, slide, block, blockPlace) || rackJoints(mechanism.report).has(index))
    return inTube(mechanism, kit, rail, place, slide.axis)
  // A slider on a body that is a bar is a sleeve round it.
  if (rail > 0 && isBar(mechanism, slide, rail, place))
    return inTube(mechanism, kit, block, blockPlace, mechanism.into(block, mechanism.alongAt(rail, slide.axis, 0)))
  return onRail(mechanism, kit, slide)
}

function inPlane(mechanism: Mechanism, kit: Kit, slide: Slide): Piece[] {
  const { rail, block, blockPlace, axis } = slide
  const s = kit.unit
  const normal = mechanism.into(block, mechanism.plane!)
  const along = mechanism.into(block, mechanism.alongAt(rail, axis, 0))
  const grounded = rail === 0
  const [length, width] = grounded ? [BLOCK.length, BLOCK.across] : [SLOTTED.length, SLOTTED.across]
  const carries = mechanism.report.joints.some((_, k) => {
    const other = mechanism.slideOf(k)
    return other !== undefined && other.rail === block && mechanism.same(other.place, blockPlace)
  })
  // A carriage is seen on both sides of the slot in it, and lies behind that.
  const layer = carries
    ? mechanism.layerOf(block) - 0.6
    : grounded
      ? mechanism.layerOf(block)
      : mechanism.layerOf(rail) + 0.3
  const middle = blockPlace.clone().add(mechanism.lift(block, layer))
  const body = kit.brick(
    middle,
    along,
    normal.clone().cross(along),
    [(carries ? CARRIAGE : length) * s, width * s, 1.05 * mechanism.thickness],
    kit.body(block),
  )
  return grounded
    ? [piece(0, ...hatchedRails(mechanism, kit, slide, LINE.aside, LINE.room + (carries ? 2 : 0))), piece(block, body)]
    : [piece(block, body)]
}

/** True if a body lies along the slide at a place of it. */
function isBar(mechanism: Mechanism, { rail, axis }: Slide, body: number, at: Vector3): boolean {
  const along = mechanism.into(body, mechanism.alongAt(rail, axis, 0))
  return (
    mechanism.shapePoints(body).filter((point) => point.clone().sub(at).cross(along).length() < 0.02 * mechanism.size)
      .length > 1
  )
}

function inTube(mechanism: Mechanism, kit: Kit, rail: number, place: Vector3, axis: Vector3): Piece[] {
  const s = kit.unit
  const length = (rail === 0 ? TUBE.onGround : TUBE.onBody) * s
  const pieces: Object3D[] = [kit.tube(place, axis, TUBE.outer * s, TUBE.inner * s, length, kit.body(rail))]
  if (rail === 0) {
    const down = below(mechanism, axis)
    const foot = place.clone().addScaledVector(down, FOOT.down * s)
    pieces.push(
      kit.cylinder(
        place.clone().addScaledVector(down, TUBE.outer * s * 0.9),
        foot,
        FOOT.radius * s,
        FOOT.radius * s,
        kit.palette.ground,
      ),
      kit.footPlate(foot, down, axis, FOOT.plate * s),
    )
  }
  return [piece(rail, ...pieces)]
}

function onRail(mechanism: Mechanism, kit: Kit, slide: Slide): Piece[] {
  const { rail, block, place, blockPlace, axis } = slide
  const s = kit.unit
  const down = mechanism.into(rail, below(mechanism, mechanism.alongAt(rail, axis, 0)))
  const side = axis.clone().cross(down).normalize()
  const [low, high] = slide.low <= slide.high ? [slide.low, slide.high] : [0, 0]
  const [from, to] = [low - RAIL.room * s, high + RAIL.room * s].map((t) => place.clone().addScaledVector(axis, t))
  const middle = from.clone().lerp(to, 0.5)
  const length = from.distanceTo(to)
  const way =
    rail === 0
      ? [
          kit.brick(
            middle.clone().addScaledVector(down, 1.9 * s),
            axis,
            down,
            [length, s, 2.2 * s],
            kit.palette.ground,
          ),
          kit.hatched(middle.clone().addScaledVector(down, 2.6 * s), axis, down, [length, 0.5 * s, 5 * s]),
        ]
      : [-1, 1].map((sign) => {
          const aside = side.clone().multiplyScalar(sign * RAIL.aside * s)
          return kit.cylinder(
            from.clone().add(aside),
            to.clone().add(aside),
            RAIL.bar * s,
            RAIL.bar * s,
            kit.body(rail),
          )
        })
  const own = (direction: Vector3) => mechanism.into(block, mechanism.alongAt(rail, direction, 0))
  return [
    piece(rail, ...way),
    piece(
      block,
      kit.brick(
        blockPlace,
        own(axis),
        own(down),
        [BLOCK.length * s, BLOCK.height * s, BLOCK.width * s],
        kit.body(block),
      ),
    ),
  ]
}

/** A member between the far ends of the two bodies. */
function slidingStrut(mechanism: Mechanism, kit: Kit, joint: JointMark, slide: Slide, form: Form): Piece {
  const [one, other] = farthest(
    mechanism,
    endsOf(mechanism, joint, slide.rail, slide),
    endsOf(mechanism, joint, slide.block, slide),
  )
  const high = ({ body, at }: End) => mechanism.worldAt(body, at, 0).dot(mechanism.up)
  const [upper, lower] = high(one) > high(other) ? [one, other] : [other, one]
  const length = mechanism.worldAt(upper.body, upper.at, 0).distanceTo(mechanism.worldAt(lower.body, lower.at, 0))
  const { object, span } = strut(kit, form, length)
  return {
    object: new Group().add(object),
    follow: (frame) => span(frame.at(upper.body, upper.at), frame.at(lower.body, lower.at)),
  }
}

/** A hardpoint on the axis of a slide. */
interface End {
  body: number
  at: Vector3
  /** True if another joint holds the body there. */
  isJoined: boolean
}

/** Tolerance of a hardpoint on the axis, relative to the mechanism's size. */
const ON_AXIS = 1e-3

/** In a changed design, the hardpoints that were on the axis as loaded: they move with it. */
function endsOf(mechanism: Mechanism, joint: JointMark, body: number, own: Slide): End[] {
  const base = mechanism.base ?? mechanism
  const slide = base.slideOf(mechanism.report.joints.indexOf(joint)) ?? own
  const onBlock = body === slide.block
  const [place, axis] = onBlock
    ? [slide.blockPlace, base.into(body, base.alongAt(slide.rail, slide.axis, 0))]
    : [slide.place, slide.axis]
  const isOnAxis = (point: [number, number, number]) =>
    new Vector3(...point).sub(place).cross(axis).length() < ON_AXIS * base.size
  const onAxis = base.report.bodies[body].skeleton.flatMap((point, k) =>
    isOnAxis(point) ? [new Vector3(...mechanism.report.bodies[body].skeleton[k])] : [],
  )
  const others = mechanism.jointsOf(body).filter((other) => other.joint !== joint)
  const ends = onAxis.length > 0 ? onAxis : [onBlock ? own.blockPlace : own.place]
  return ends.map((at) => ({ body, at, isJoined: others.some((other) => mechanism.same(other.at, at)) }))
}

/** The two ends that other joints hold; where that leaves a choice, those farthest apart. */
function farthest(mechanism: Mechanism, some: End[], others: End[]): [End, End] {
  const far = ([a, b]: [End, End]) => mechanism.worldAt(a.body, a.at, 0).distanceTo(mechanism.worldAt(b.body, b.at, 0))
  const rank = (pair: [End, End]) =>
    (Number(pair[0].isJoined) + Number(pair[1].isJoined)) * 2 * mechanism.size + far(pair)
  const pairs = some.flatMap((a) => others.map((b): [End, End] => [a, b]))
  return pairs.reduce((best, pair) => (rank(pair) > rank(best) ? pair : best))
}

/** The axis of the world that is most downwards and perpendicular to a slide. */
function below(mechanism: Mechanism, axis: Vector3): Vector3 {
  const down = mechanism.up.clone().negate()
  const directions = [0, 1, 2].flatMap((k) => [1, -1].map((sign) => new Vector3().setComponent(k, sign)))
  const best = directions
    .filter((way) => Math.abs(way.dot(axis)) < 0.6)
    .reduce((a, b) => (b.dot(down) > a.dot(down) + 1e-9 ? b : a))
  return best.addScaledVector(axis, -best.dot(axis)).normalize()
}
