import { Box3, Quaternion, Vector3 } from 'three'
import type { JointMark } from '../payload'
import type { Report } from '../report'
import type { Frame } from './drawable'
import { layers } from './layers'
import { planeOf } from './plane'
import { placed, type Pose, poseAt, turned } from './poses'
import { READER, readerOf } from './reader'
import { type Slide, slideOf } from './slide'
import { bevelsOf } from './shapes/bevel'
import { tints } from './tints'
import { Train } from './train'

/** Enough moments to bound the motion without walking through every one of a long run. */
const SAMPLES = 64
/** Two places nearer to one another than this part of the size are one. */
const SAME = 1e-4
/** Moments at which it is judged from where joints are seen best. */
const SAMPLED_STEPS = 5
/** More bodies than this are drawn without details. */
const MANY = 40
/** The unit as a part of the distance between hardpoints, and its least and largest part of the size. */
const UNIT = { ofDistance: 0.16, least: 0.0012, most: 0.0125 }
/**
 * Least and largest unit on the screen, px: half of the thinnest rod that is seen well, and where zooming in no longer
 * thickens. By these steps it changes.
 */
const SEEN = { least: 0.75, most: 14, step: 1.25 }
/** Thickness of a planar link, and from one layer to the next, in units. */
const THICKNESS = 1
const PITCH = 1.15
/** A glyph's radius as a part of the distance to the nearest other joint, and its least in units. */
const GLYPH = { ofDistance: 0.3, least: 0.35 }

type Place = readonly [number, number, number]

/**
 * A report as it is drawn: sizes, places, colours and layers, worked out once. A changed design takes sizes, colours
 * and layers from the one that it is a change of, so that only what differs is seen to differ.
 */
export class Mechanism {
  /** Steps at which the motion is sampled, where its extent matters. */
  readonly moments: number[]
  /** Diagonal of the box round the sweep. */
  readonly size: number
  /** Unit of all glyphs: about the radius of a rod. It stays within the visible range, see `sizeTo`. */
  unit: number
  /** Normal of a planar mechanism, towards the reader. */
  readonly plane?: Vector3
  readonly up: Vector3
  /** Towards the eye in the first view of a mechanism in space that is no vehicle. */
  readonly reader: Vector3
  readonly vehicle?: { forward: Vector3; up: Vector3 }
  readonly large: boolean
  /** Moving bodies that carry both wheels of a pair. */
  readonly carriers: Set<number>
  readonly topLayer: number
  #natural: number
  #places: Vector3[][]
  #layers: number[]
  #tints: number[]
  #slides: (Slide | undefined)[]
  /** Places of the joints of each body. */
  #joined: Vector3[][]
  #sweep?: Vector3[]
  #box?: Box3
  #shapes = new Map<number, Vector3[]>()

  /** `base`: the loaded design, if this is a change of it. `former`: the design that is drawn dashed. */
  constructor(
    readonly report: Report,
    readonly base?: Mechanism,
    readonly former?: Mechanism,
  ) {
    const last = Math.max(0, report.times.length - 1)
    const stride = Math.max(1, Math.floor(last / SAMPLES))
    this.moments = [...Array.from({ length: Math.ceil(last / stride) }, (_, k) => k * stride), last]
    const joined: Vector3[][] = report.bodies.map(() => [])
    for (const joint of report.joints) {
      joined[joint.body_i].push(new Vector3(...joint.at_i))
      joined[joint.body_j].push(new Vector3(...joint.at_j))
    }
    this.#joined = joined
    this.size = base?.size ?? (this.box.getSize(new Vector3()).length() || 1)
    this.#places = joined.map((places) => this.distinct(places))
    this.#natural = base ? base.#natural : this.#unit()
    this.unit = base?.unit ?? this.#natural
    this.plane = base ? base.plane : planeOf(report, this.#visited(joined, ['wheel', 'measured']), this.size)
    const { vehicle } = report
    this.vehicle = vehicle ? { forward: new Vector3(...vehicle.forward), up: new Vector3(...vehicle.up) } : undefined
    this.up =
      this.plane && Math.abs(this.plane.z) > 0.5 ? new Vector3(0, 1, 0) : (this.vehicle?.up ?? new Vector3(0, 0, 1))
    this.large = report.bodies.length > MANY + 1
    this.carriers = base ? base.carriers : carriersOf(report)
    this.reader = base ? base.reader : this.plane || this.vehicle || this.large ? READER : this.#seenFrom()
    this.#tints = base ? base.#tints : tints(this)
    this.#layers = base ? base.#layers : this.plane ? this.#stack() : report.bodies.map(() => 0)
    this.topLayer = Math.max(0, ...this.#layers)
    this.#slides = report.joints.map((joint) => slideOf(this, joint))
  }

  /** Every place that a hardpoint or joint visits. */
  get sweep(): Vector3[] {
    return (this.#sweep ??= this.#visited(this.#joined))
  }

  get box(): Box3 {
    if (this.#box) return this.#box
    this.#box = new Box3().setFromPoints(this.sweep)
    if (this.#box.isEmpty()) this.#box.expandByPoint(new Vector3())
    return this.#box
  }

  get centre(): Vector3 {
    return this.box.getCenter(new Vector3())
  }

  /**
   * Takes the unit that suits a picture of that many pixels per length; true where what is drawn has to be made anew.
   */
  sizeTo(pixelsPerLength: number): boolean {
    const seen = this.#natural * pixelsPerLength
    if (!(seen > 0 && Number.isFinite(seen))) return false
    const steps = (wanted: number) => Math.log(wanted / seen) / Math.log(SEEN.step)
    const power = Math.max(0, Math.ceil(steps(SEEN.least))) + Math.min(0, Math.floor(steps(SEEN.most)))
    const unit = this.#natural * SEEN.step ** power
    const changed = unit !== this.unit
    this.unit = unit
    return changed
  }

  /** Layer of a body of a planar mechanism; ground's is 0, the lowest. */
  layerOf(body: number): number {
    return this.#layers[body]
  }

  /** Index of a body's colour; -1 for ground. */
  colourOf(body: number): number {
    return this.#tints[body]
  }

  /** Thickness of a planar link. */
  get thickness(): number {
    return THICKNESS * this.unit
  }

  /** From one layer of a planar mechanism to the next. */
  get pitch(): number {
    return PITCH * this.unit
  }

  /** From the plane of the hardpoints to a layer, in a body's frame; nothing for a spatial mechanism. */
  lift(body: number, layer = this.#layers[body]): Vector3 {
    return this.plane ? this.into(body, this.plane).multiplyScalar(layer * this.pitch) : new Vector3()
  }

  /** Joint places of a body in its frame, each once. */
  placesOf(body: number): Vector3[] {
    return this.#places[body]
  }

  /** The slide of a joint, where it is one. */
  slideOf(joint: number): Slide | undefined {
    return this.#slides[joint]
  }

  /** Joints of a body, with the place on it and their axis in its frame. */
  jointsOf(body: number): { joint: JointMark; index: number; at: Vector3; axis?: Vector3 }[] {
    return this.report.joints.flatMap((joint, index) => {
      if (joint.body_i !== body && joint.body_j !== body) return []
      const here = joint.body_i === body
      const axis = here ? joint.axis : (joint.axis_j ?? undefined)
      return [
        {
          joint,
          index,
          at: new Vector3(...(here ? joint.at_i : joint.at_j)),
          axis: axis ? new Vector3(...axis) : undefined,
        },
      ]
    })
  }

  /** The points that shape a body, in its frame: measured points only while there are fewer than three others. */
  shapePoints(body: number): Vector3[] {
    let found = this.#shapes.get(body)
    if (!found) this.#shapes.set(body, (found = this.#shapePoints(body)))
    return found.map((point) => point.clone())
  }

  #shapePoints(body: number): Vector3[] {
    const { skeleton, roles } = this.report.bodies[body]
    const point = (k: number) => new Vector3(...skeleton[k])
    const indices = skeleton.map((_, k) => k)
    const carried = indices.filter((k) => roles[k] === 'joint' || roles[k] === 'hinge').map(point)
    const slotted = this.plane
      ? this.#slides.flatMap((slide) => (slide && slide.rail === body && body > 0 ? ends(slide) : []))
      : []
    const points = this.distinct([...carried, ...this.#places[body], ...slotted])
    if (points.length > 2) return points
    return this.distinct([...points, ...indices.filter((k) => roles[k] === 'measured').map(point)])
  }

  /** Radius of a glyph at a joint's place on a body, so that none hides a link. */
  radiusAt(body: number, at: Vector3): number {
    const others = this.#places[body].filter((place) => !this.same(place, at)).map((place) => place.distanceTo(at))
    return Math.max(Math.min(this.unit, GLYPH.ofDistance * Math.min(...others, Infinity)), GLYPH.least * this.unit)
  }

  /** The same for both bodies of a joint. */
  radiusOf(joint: JointMark): number {
    return Math.min(
      this.radiusAt(joint.body_i, new Vector3(...joint.at_i)),
      this.radiusAt(joint.body_j, new Vector3(...joint.at_j)),
    )
  }

  /** Distance to the nearest other joint of both bodies of a joint. */
  roomOf({ body_i, body_j, at_i, at_j }: JointMark): number {
    const near = (body: number, at: Vector3) =>
      this.#places[body].filter((other) => !this.same(other, at)).map((other) => other.distanceTo(at))
    return Math.min(...near(body_i, new Vector3(...at_i)), ...near(body_j, new Vector3(...at_j)), this.size)
  }

  /** A body's pose, or nothing where the motion was not solved. */
  poseAt(body: number, step: number): Pose | undefined {
    return poseAt(this.report.bodies[body].poses, step)
  }

  /** A point of a body in the world; NaN where the motion was not solved. */
  worldAt(body: number, point: Vector3, step: number): Vector3 {
    return placed(this.poseAt(body, step), point)
  }

  /** A point of a body's skeleton in the world; NaN where the motion was not solved. */
  skeletonAt(body: number, point: number, step: number): Vector3 {
    return this.worldAt(body, new Vector3(...this.report.bodies[body].skeleton[point]), step)
  }

  /** A direction of a body in the world; NaN where the motion was not solved. */
  alongAt(body: number, direction: Vector3, step: number): Vector3 {
    return turned(this.poseAt(body, step), direction)
  }

  /** A direction of the world in a body's frame, in the first position where none is given. */
  into(body: number, direction: Vector3, step = 0): Vector3 {
    const turn = this.poseAt(body, step)?.turn ?? new Quaternion()
    return direction.clone().applyQuaternion(turn.clone().invert())
  }

  /** A place of the world in a body's frame, in the first position where none is given. */
  placeInto(body: number, place: Vector3, step = 0): Vector3 {
    const pose = this.poseAt(body, step)
    return pose ? this.into(body, place.clone().sub(pose.place), step) : place.clone()
  }

  /** The mechanism at one moment. */
  frame(step: number): Frame {
    const poses = this.report.bodies.map((_, body) => this.poseAt(body, step))
    return {
      step,
      at: (body, point) => placed(poses[body], point),
      along: (body, direction) => turned(poses[body], direction),
      visible: (body) => poses[body] !== undefined,
    }
  }

  same(a: Vector3, b: Vector3): boolean {
    return a.distanceTo(b) < SAME * this.size
  }

  distinct(points: Vector3[]): Vector3[] {
    return points.filter((point, k) => points.findIndex((other) => this.same(other, point)) === k)
  }

  /** Places of joints, and of points but those of some roles. */
  #visited(joined: Vector3[][], without: string[] = ['wheel']): Vector3[] {
    return this.report.bodies.flatMap(({ skeleton, roles }, body) => {
      const marked = skeleton.filter((_, k) => !without.includes(roles[k])).map((point: Place) => new Vector3(...point))
      const points = [...marked, ...joined[body]]
      return (body === 0 ? [0] : this.moments).flatMap((step) => {
        const pose = this.poseAt(body, step)
        return pose ? points.map((point) => placed(pose, point)) : []
      })
    })
  }

  /** Direction from which all joints are distinguishable. */
  #seenFrom(): Vector3 {
    const { moments } = this
    const judged = Array.from(
      { length: SAMPLED_STEPS },
      (_, k) => moments[Math.floor((k * (moments.length - 1)) / (SAMPLED_STEPS - 1))],
    )
    const places = (step: number) =>
      this.distinct(this.#places.flatMap((own, body) => own.map((place) => this.worldAt(body, place, step))))
    const solved = judged.map(places).filter((all) => all.every(({ x, y, z }) => Number.isFinite(x + y + z)))
    const backs = this.report.couplers.flatMap((coupler) =>
      coupler.kind === 'bevel' ? (bevelsOf(new Train(this), coupler)?.gears ?? []) : [],
    )
    return readerOf(
      solved,
      this.size,
      backs.map(({ axis }) => axis),
    )
  }

  /** From the lower quartile of the distances from a moving body's joints to its nearest other hardpoint. */
  #unit(): number {
    const distances = this.#places.slice(1).flatMap((places, k) => {
      const all = [...places, ...this.report.bodies[k + 1].skeleton.map((point) => new Vector3(...point))]
      return places.flatMap((place) => {
        const others = all.filter((other) => !this.same(other, place)).map((other) => other.distanceTo(place))
        return others.length > 0 ? [Math.min(...others)] : []
      })
    })
    distances.sort((a, b) => a - b)
    const quartile = distances[Math.floor(distances.length / 4)] ?? this.size
    return Math.min(Math.max(UNIT.ofDistance * quartile, UNIT.least * this.size), UNIT.most * this.size)
  }

  #stack(): number[] {
    const { report } = this
    const lengths = report.bodies.map(({ skeleton }) => {
      const points = skeleton.map((point) => new Vector3(...point))
      return Math.max(0, ...points.flatMap((a) => points.map((b) => a.distanceTo(b))))
    })
    const pins = report.joints.flatMap((joint) => [
      { at: this.worldAt(joint.body_i, new Vector3(...joint.at_i), 0), bodies: [joint.body_i, joint.body_j] },
      { at: this.worldAt(joint.body_j, new Vector3(...joint.at_j), 0), bodies: [joint.body_i, joint.body_j] },
    ])
    const massless = (joint: JointMark) => joint.kind === 'distance' || joint.kind === 'leg'
    const loadedPins = pins.filter((_, k) => !massless(report.joints[Math.floor(k / 2)]))
    const stacked = layers(lengths, loadedPins, 1e-3 * this.size)
    const top = Math.max(0, ...stacked)
    // In front of the wheels that it carries a carrier is seen.
    for (const body of this.carriers) stacked[body] = top + 1
    return stacked
  }
}

function carriersOf({ couplers, joints }: Report): Set<number> {
  const found = couplers.flatMap(({ terms }) => {
    const [first, ...others] = terms
      .filter(({ turns }) => turns)
      .map(({ joint }) => [joints[joint].body_i, joints[joint].body_j])
    return others.length > 0 ? first.filter((body) => body > 0 && others.every((pair) => pair.includes(body))) : []
  })
  return new Set(found)
}

const ends = ({ place, axis, low, high }: Slide) =>
  low <= high ? [low, high].map((t) => place.clone().addScaledVector(axis, t)) : []
