import { Group, type Object3D, Vector3 } from 'three'
import { Basis } from '../flat'
import { gearOutline, rackOutline, toothHeight } from '../shapes/toothing'
import { reach } from '../train'
import type { DrawCoupler } from './coupler'
import { pitchCircles } from './coupler_gear'

/** Teeth of the pinion, minimum of the rack, and teeth of the rack beyond the travel at either end. */
const TEETH = { pinion: 16, rack: 14, beyond: 3 }
/** From the pitch line to the rack's back. */
const DEPTH = 2.6
/** The sliding bar: radius, and overhang beyond travel and tube. */
const BAR = { radius: 1.3, beyond: 7 }
/** Sides of the arm between rack and bar. */
const ARM = [5, 2]

/** A pinion and the toothed bar that it moves. */
export const rack: DrawCoupler = ({ mechanism, kit, train, coupler }) => {
  const [slide, turn] = coupler.terms
  const mark = mechanism.report.joints[slide?.joint]
  const shaft = turn?.turns ? train.shaftOf(turn.joint) : undefined
  if (!mark?.axis || !shaft) return []
  const ratio = -turn.coefficient / slide.coefficient
  const radius = Math.abs(coupler.sizes[0] ?? ratio)
  const moving = mark.body_j > 0 ? mark.body_j : mark.body_i
  const way = mechanism.alongAt(mark.body_i, new Vector3(...mark.axis), 0).normalize()
  const out = way
    .clone()
    .cross(shaft.axis)
    .multiplyScalar(Math.sign(ratio) || 1)
  if (!(radius > 0) || out.length() < 0.5) return []
  out.normalize()
  const fixed = mechanism.worldAt(mark.body_i, new Vector3(...mark.at_i), 0)
  const along = fixed.clone().sub(shaft.at).dot(shaft.axis)
  const centre = shaft.at.clone().addScaledVector(shaft.axis, along)
  reach(shaft, along)
  const pitch = (2 * Math.PI * radius) / TEETH.pinion
  const height = toothHeight(TEETH.pinion, radius)
  const width = mechanism.plane ? mechanism.thickness : train.face

  const own = {
    at: mechanism.placeInto(shaft.body, centre).add(mechanism.lift(shaft.body)),
    axis: mechanism.into(shaft.body, shaft.axis),
  }
  const round = new Basis(own.at, own.axis, mechanism.into(shaft.body, out))
  const pinion = kit.slab(gearOutline(TEETH.pinion, radius, height), round, width, kit.body(shaft.body), [], {
    edges: 50,
  })

  // The rack's travel, counted from where it is at first.
  const place = new Vector3(...(moving === mark.body_j ? mark.at_j : mark.at_i))
  const start = mechanism.worldAt(moving, place, 0)
  const travel = mechanism.moments
    .map((step) => mechanism.worldAt(moving, place, step).sub(start).dot(way))
    .filter(Number.isFinite)
  const room = Math.max(
    TEETH.beyond * pitch,
    (TEETH.rack * pitch - (Math.max(0, ...travel) - Math.min(0, ...travel))) / 2,
  )
  const [from, to] = [-Math.max(0, ...travel) - room, -Math.min(0, ...travel) + room]
  const contact = centre.clone().addScaledVector(out, radius)
  const into = (direction: Vector3) => mechanism.into(moving, direction)
  const at = (point: Vector3) => mechanism.placeInto(moving, point).add(mechanism.lift(moving))
  const depth = DEPTH * kit.unit + height / 2
  // Teeth towards the pinion: y is against `out`, so the outline's x is along the way of the basis that has it so.
  const x = out.clone().negate().cross(shaft.axis)
  const forward = Math.sign(x.dot(way)) || 1
  const basis = new Basis(at(contact), into(shaft.axis), into(x))
  const outline =
    forward > 0 ? rackOutline(pitch, from, to, height, depth) : rackOutline(pitch, -to, -from, height, depth)
  const teeth = kit.slab(outline, basis, width, kit.body(moving), [], { edges: 50 })

  // The bar in its guide, and an arm from the rack's back to it where they are apart.
  const guide = start.clone().addScaledVector(way, contact.clone().sub(start).dot(way))
  const back = contact.clone().addScaledVector(out, depth - 0.5 * kit.unit)
  const gap = guide.clone().sub(back)
  const aside = gap.dot(out)
  const pieces: Object3D[] = [teeth]
  const reachOf = fixed.clone().sub(start).dot(way)
  const ends = [
    Math.min(from + contact.clone().sub(start).dot(way), reachOf - Math.max(0, ...travel)) - BAR.beyond * kit.unit,
    Math.max(to + contact.clone().sub(start).dot(way), reachOf - Math.min(0, ...travel)) + BAR.beyond * kit.unit,
  ]
  const [low, high] = ends.map((t) => at(start.clone().addScaledVector(way, t)))
  if (Math.abs(aside) > depth / 2) {
    pieces.push(kit.cylinder(low, high, BAR.radius * kit.unit, BAR.radius * kit.unit, kit.body(moving)))
    for (const share of [0.25, 0.75]) {
      const t = from + share * (to - from)
      const middle = back.clone().lerp(guide, 0.5).addScaledVector(way, t)
      pieces.push(
        kit.brick(
          at(middle),
          into(gap),
          into(way),
          [gap.length(), ARM[0] * kit.unit, ARM[1] * kit.unit],
          kit.body(moving),
        ),
      )
    }
  }
  return [
    { body: shaft.body, object: new Group().add(pinion, ...pitchCircles(kit, round, radius, width)) },
    { body: moving, object: new Group().add(...pieces) },
  ]
}
