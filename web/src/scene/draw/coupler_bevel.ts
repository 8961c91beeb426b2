import { Vector3 } from 'three'
import { bevelCorners, bevelsOf } from '../shapes/bevel'
import { drawnTeeth, toothHeight } from '../shapes/toothing'
import { reach } from '../train'
import type { DrawCoupler } from './coupler'

/** Face width as a part of the cone's length, at most, and in face widths of spur gears. */
const WIDTH = { ofLength: 0.35, faces: 1.3 }

/** Two toothed cones that meet where the shafts cross. */
export const bevels: DrawCoupler = ({ mechanism, kit, train, coupler }) => {
  const shafts = coupler.terms.flatMap(({ joint, turns }) => (turns ? (train.shaftOf(joint) ?? []) : []))
  if (shafts.length !== 2 || coupler.sizes.length < 2) return []
  const pair = bevelsOf(train, coupler)
  if (!pair) return []
  const teeth = drawnTeeth([Math.abs(coupler.sizes[0]), Math.abs(coupler.sizes[1])])
  const height = Math.min(...pair.gears.map(({ radius }, k) => toothHeight(teeth[k], radius)))
  const width = Math.min(WIDTH.ofLength * pair.length, WIDTH.faces * train.face)
  return pair.gears.map((gear, k) => {
    const { body, axis, at } = shafts[k]
    reach(shafts[k], pair.tip.clone().addScaledVector(gear.axis, gear.distance).sub(at).dot(axis))
    const into = (direction: Vector3) => mechanism.into(body, direction)
    const tip = mechanism.placeInto(body, pair.tip)
    const phase = k === 0 ? 0 : Math.PI / teeth[1]
    const corners = bevelCorners(
      tip,
      { ...gear, axis: into(gear.axis) },
      into(pair.line),
      teeth[k],
      height,
      phase,
      width,
    )
    return { body, object: kit.triangles(corners, kit.body(body), { facets: true, edges: 50, open: true }) }
  })
}
