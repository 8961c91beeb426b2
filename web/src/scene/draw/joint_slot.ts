import { Vector3 } from 'three'
import { Basis, type Flat, round } from '../flat'
import { type DrawJoint, piece } from './joint'
import { hatchedRails } from './rails'

/** Radius of the pin, half width of its slot, and of the plate round it. */
const PIN = 0.95
const SLOT = 1.05
const PLATE = { half: 2.6, thickness: 1.2 }
/** Length of the pin in space. */
const LENGTH = 4.4

/** A pin along `axis` in a straight slot along `axis2` of the other body. */
export const pinInSlot: DrawJoint = (mechanism, kit, joint, index) => {
  if (mechanism.plane) return slottedPin(mechanism, kit, joint, index)
  const slide = mechanism.slideOf(index)
  const axis = new Vector3(...(joint.axis ?? [0, 0, 1])).normalize()
  if (!slide || slide.low > slide.high) return []
  const r = mechanism.radiusOf(joint)
  const basis = new Basis(slide.place, axis, slide.axis)
  const ends: Flat[] = [
    [slide.low, 0],
    [slide.high, 0],
  ]
  const outline = (half: number) => round(ends.map(([x, y]) => [x, y, half * r]))
  const own = joint.axis_j
    ? new Vector3(...joint.axis_j)
    : mechanism.into(slide.block, mechanism.alongAt(slide.rail, axis, 0))
  return [
    piece(
      slide.rail,
      kit.slab(outline(PLATE.half), basis, PLATE.thickness * r, kit.body(slide.rail), [outline(SLOT)], { edges: 50 }),
    ),
    piece(slide.block, kit.disc(slide.blockPlace, own, PIN * r, LENGTH * r, kit.palette.steel)),
  ]
}

/** The pin of a planar mechanism; the link has the slot, and ground hatched lines. */
export const slottedPin: DrawJoint = (mechanism, kit, _, index) => {
  const slide = mechanism.slideOf(index)
  if (!slide || !mechanism.plane) return []
  const { block, blockPlace, rail } = slide
  const layers = [rail, block].map((body) => mechanism.layerOf(body))
  const normal = mechanism.into(block, mechanism.plane)
  const middle = blockPlace.clone().add(mechanism.lift(block, (layers[0] + layers[1]) / 2))
  const length = (Math.abs(layers[0] - layers[1]) + 1.3) * mechanism.pitch
  const pin = piece(block, kit.disc(middle, normal, PIN * kit.unit, length, kit.palette.steel))
  return rail === 0 ? [piece(0, ...hatchedRails(mechanism, kit, slide, SLOT + 0.15, 2)), pin] : [pin]
}
