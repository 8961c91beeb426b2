import { Group, Vector3 } from 'three'
import { valueAt } from '../../curve'
import type { JointMark } from '../../payload'
import type { Driver } from '../../report'
import { above, ABOVE, arcHead, arcPoints, straightArrow } from '../arrow'
import type { Draw, Drawable, Frame } from '../drawable'
import { across, Basis, square } from '../flat'
import { type Kit, place } from '../kit'
import type { Mechanism } from '../mechanism'
import { arcOf, atLeast, offAxis, type Travel, travelOf } from '../travel'

/** Sizes in units: the least length of an arrow, its head, radii of an arc. */
const LEAST = 9
const HEAD = 2.6
const ARC: [number, number] = [4.4, 8]
/** Width of the line, px. */
const LINE = 2.6
/** Offset of the arrow from a slide, a jack, a leg and a point, and in front of a hinge, in units. */
const BESIDE = { slide: 4.2, jack: 5.4, leg: 3.6, point: 3.6, hinge: 3.2 }
/** Offset outboard of a wheel's centre, relative to its radius. */
const OUTBOARD = 0.36
/** Position of the arrow along a leg. */
const ALONG_LEG = 0.55

/** Driven coordinates, as arrows with the travel of this motion. */
export const drivers: Draw = (mechanism, kit) =>
  mechanism.report.drivers.flatMap((driver, index): Drawable[] => {
    const travel = travelOf(driver)
    const arrow = travel && arrowOf(mechanism, kit, driver, travel)
    if (!arrow) return []
    const part = { kind: 'driver' as const, index, name: driver.name, about: driver.law }
    return [{ ...arrow, part, overlay: true }]
  })

type Arrow = Pick<Drawable, 'body' | 'object' | 'follow'>

function arrowOf(mechanism: Mechanism, kit: Kit, driver: Driver, travel: Travel): Arrow | undefined {
  if (driver.joint === null) return driver.point ? pointArrow(mechanism, kit, driver, travel) : undefined
  const joint = mechanism.report.joints[driver.joint]
  if (driver.turns) return joint.axis ? hingeArrow(mechanism, kit, joint, travel) : undefined
  return mechanism.slideOf(driver.joint)
    ? slideArrow(mechanism, kit, joint, driver.joint)
    : legArrow(mechanism, kit, joint, travel)
}

/** An arc about the hinge, in the frame of the body that carries it. */
function hingeArrow(mechanism: Mechanism, kit: Kit, joint: JointMark, { curve, low, high, onwards }: Travel): Arrow {
  const s = kit.unit
  // The arc is on ground where the hinge does, else on the first body.
  const turned = joint.body_j === 0
  const [base, moving] = turned ? [joint.body_j, joint.body_i] : [joint.body_i, joint.body_j]
  const place0 = new Vector3(...(turned ? joint.at_j : joint.at_i))
  const axisI = new Vector3(...joint.axis!)
  const first = Math.max(0, curve.findIndex(Number.isFinite))
  const axis = turned ? mechanism.into(base, mechanism.alongAt(joint.body_i, axisI, first), first) : axisI.clone()
  // As the second body turns against the first; the first against the second turns the other way.
  if (turned) axis.negate()
  const hub = mechanism.worldAt(base, place0, first)
  const ray = mechanism
    .shapePoints(moving)
    .map((point) => offAxis(mechanism.into(base, mechanism.worldAt(moving, point, first).sub(hub), first), axis, 2 * s))
    .find((direction) => direction !== undefined)
  const now = curve[first]
  const arc = arcOf(low - now, high - now, onwards, LEAST * s, [ARC[0] * s, ARC[1] * s])
  const basis = new Basis(place0.clone().add(before(mechanism, base, axis)), axis, ray ?? across(axis))
  const head = HEAD * s
  // The line ends inside the heads.
  const trim = (0.8 * head) / arc.radius
  const { driver: colour } = kit.palette
  const [from, to] = [arc.heads === 'last' ? arc.from : arc.from + trim, arc.heads === 'first' ? arc.to : arc.to - trim]
  const group = new Group().add(kit.line(arcPoints(arc.radius, from, to), colour, LINE, { over: true }))
  if (arc.heads !== 'first') group.add(arcHead(kit, arc.radius, arc.to, 1, head, colour))
  if (arc.heads !== 'last') group.add(arcHead(kit, arc.radius, arc.from, -1, head, colour))
  group.applyMatrix4(basis.matrix())
  return { body: base, object: above(group, ABOVE.driver) }
}

/** In front of the hinge, on the reader's side. */
function before(mechanism: Mechanism, body: number, axis: Vector3): Vector3 {
  if (mechanism.plane) return mechanism.lift(body, mechanism.topLayer + 2)
  const towards = mechanism.into(body, mechanism.reader).dot(axis) < 0 ? -1 : 1
  return axis.clone().multiplyScalar(towards * BESIDE.hinge * mechanism.unit)
}

/** A double arrow along the rail, in its frame. */
function slideArrow(mechanism: Mechanism, kit: Kit, joint: JointMark, index: number): Arrow | undefined {
  const slide = mechanism.slideOf(index)!
  if (slide.low > slide.high) return undefined
  const side = sideways(mechanism, slide.rail, slide.axis)
  const foot = slide.place.clone().addScaledVector(side, (joint.draw ? BESIDE.jack : BESIDE.slide) * kit.unit)
  foot.add(mechanism.lift(slide.rail, mechanism.topLayer + 1))
  return { body: slide.rail, object: double(kit, foot, slide.axis, atLeast(slide.low, slide.high, LEAST * kit.unit)) }
}

/** Perpendicular to an axis in the plane of the mechanism, or upwards. */
function sideways(mechanism: Mechanism, body: number, axis: Vector3): Vector3 {
  return mechanism.plane
    ? mechanism.into(body, mechanism.plane).cross(axis)
    : square(mechanism.into(body, mechanism.up), axis)
}

/** A double arrow along a leg, which moves with it. */
function legArrow(mechanism: Mechanism, kit: Kit, joint: JointMark, { low, high }: Travel): Arrow {
  const [minimum, maximum] = atLeast(low, high, LEAST * kit.unit)
  const half = (maximum - minimum) / 2
  const object = double(kit, new Vector3(), new Vector3(0, 1, 0), [-half, half])
  const [a, b] = [new Vector3(...joint.at_i), new Vector3(...joint.at_j)]
  const follow = (frame: Frame) => {
    const [from, to] = [frame.at(joint.body_i, a), frame.at(joint.body_j, b)]
    const along = to.clone().sub(from).normalize()
    const middle = from.clone().lerp(to, ALONG_LEG)
    // On the outside of the whole.
    const outwards = middle.clone().sub(mechanism.centre)
    const plane = mechanism.plane ?? (mechanism.vehicle ? mechanism.vehicle.forward : mechanism.reader)
    const side = plane.clone().cross(along).normalize()
    if (side.dot(outwards) < 0) side.negate()
    object.visible = frame.visible(joint.body_i) && frame.visible(joint.body_j)
    if (object.visible) place(object, middle.addScaledVector(side, BESIDE.leg * kit.unit), along)
  }
  return { object, follow }
}

/** A double arrow next to a driven point, in the world; outboard if the body carries a wheel. */
function pointArrow(mechanism: Mechanism, kit: Kit, driver: Driver, { curve, low, high }: Travel): Arrow | undefined {
  const { body, at } = driver.point!
  if (!driver.along) return undefined
  const along = new Vector3(...driver.along)
  const point = new Vector3(...at)
  const wheel = mechanism.report.wheels.find(({ centre }) => centre.body === body)
  const object = new Group().add(double(kit, new Vector3(), along, atLeast(low, high, LEAST * kit.unit)))
  const follow = (frame: Frame) => {
    object.visible = frame.visible(body)
    if (!object.visible) return
    const aside = wheel
      ? frame.along(body, new Vector3(...wheel.axis)).multiplyScalar(OUTBOARD * wheel.radius)
      : sideways(mechanism, 0, along).multiplyScalar(BESIDE.point * kit.unit)
    // The arrow is fixed on its line; the point moves along it.
    object.position.copy(frame.at(body, point)).addScaledVector(along, -valueAt(curve, frame.step)).add(aside)
  }
  return { object, follow }
}

function double(kit: Kit, foot: Vector3, along: Vector3, [low, high]: [number, number]): Group {
  const at = (t: number) => foot.clone().addScaledVector(along, t)
  return straightArrow(
    kit,
    at(low),
    at(high),
    { head: HEAD * kit.unit, shaft: { pixels: LINE } },
    kit.palette.driver,
    ABOVE.driver,
    true,
  )
}
