import { Group, type Material, type Mesh, type Vector3 } from 'three'
import type { Choice } from '../state'
import { bounds, outermost } from './bounds'
import type { Draw, Drawable, Frame } from './drawable'
import { Kit } from './kit'
import type { Mechanism } from './mechanism'
import { OVER, type Outlines } from './outlines'
import type { Palette } from './palette'
import type { Stock } from './stock'

/** Half the least number of pixels that a detail is drawn with. */
const DETAIL = 1

/** Everything that some `Draw`s made of a mechanism, in groups that move with the bodies. */
export class Assembly {
  /** One per body, then that of the world. */
  readonly groups: Group[]
  readonly drawn: Drawable[]
  /** Numbers of the parts in the picture of part numbers. */
  readonly numbers: { part: Drawable['part']; number: number }[] = []
  #kit: Kit
  #frame?: Frame
  #reach?: Vector3[]

  /** Numbers start after `first`, so that those of two assemblies differ. */
  constructor(
    readonly mechanism: Mechanism,
    palette: Palette,
    choice: Choice,
    draws: Draw[],
    outlines: Outlines,
    first: number,
    stock?: Stock,
  ) {
    this.#kit = new Kit(mechanism, palette, stock)
    this.drawn = draws.flatMap((draw) => draw(mechanism, this.#kit, choice))
    this.groups = [...mechanism.report.bodies, mechanism].map(() => new Group())
    const world = this.groups[this.groups.length - 1]
    let number = first
    for (const { body, object, part, overlay } of this.drawn) {
      object.userData.part = part
      const target = body === undefined ? world : this.groups[body]
      target.add(object)
      const byMaterial = new Map<Material, number>()
      object.traverse((one) => {
        if (overlay) return one.layers.set(OVER)
        const { material, isMesh } = one as Mesh
        if (
          !isMesh ||
          Array.isArray(material) ||
          material.transparent ||
          !('wireframe' in material) ||
          'isLineSegments2' in one
        )
          return
        if (!byMaterial.has(material)) {
          byMaterial.set(material, ++number)
          this.numbers.push({ part, number })
        }
        outlines.number(one, byMaterial.get(material)!)
      })
    }
  }

  /** Puts everything where it is at a moment. */
  pose(frame: Frame): void {
    this.#frame = frame
    this.mechanism.report.bodies.forEach((_, body) => {
      const group = this.groups[body]
      group.visible = frame.visible(body)
      if (!group.visible) return
      const pose = this.mechanism.poseAt(body, frame.step)!
      group.position.copy(pose.place)
      group.quaternion.copy(pose.turn)
    })
    for (const { follow } of this.drawn) follow?.(frame)
  }

  /** Leaves out details that are smaller than some pixels; true where that changes the picture. */
  refine(pixelsPerLength: number): boolean {
    let changed = false
    for (const { object, detail } of this.drawn) {
      if (detail === undefined) continue
      const seen = detail * pixelsPerLength >= DETAIL
      changed ||= seen !== object.visible
      object.visible = seen
    }
    return changed
  }

  /** Points that bound everything drawn over the whole motion. */
  get reach(): Vector3[] {
    return (this.#reach ??= this.#bounded())
  }

  dispose(): void {
    for (const group of this.groups) group.removeFromParent()
    this.#kit.dispose()
  }

  #bounded(): Vector3[] {
    const { mechanism, drawn } = this
    const world = this.groups.length - 1
    const still = this.groups.map((_, k) =>
      outermost(
        drawn.filter(({ body = world, follow }) => body === k && !follow).flatMap(({ object }) => bounds(object)),
      ),
    )
    const followed = drawn.filter(({ follow }) => follow)
    const found = mechanism.moments.flatMap((step) => {
      const frame = mechanism.frame(step)
      const into = (body: number | undefined, points: Vector3[]) =>
        body === undefined ? points : points.map((point) => frame.at(body, point))
      const carried = mechanism.report.bodies.flatMap((_, body) =>
        body > 0 || step === 0 ? into(body, still[body]) : [],
      )
      const following = followed.flatMap(({ body, object, follow }) => {
        follow!(frame)
        return object.visible ? into(body, bounds(object)) : []
      })
      return [...carried, ...following]
    })
    if (this.#frame) this.pose(this.#frame)
    return [...still[world], ...found].filter(({ x, y, z }) => Number.isFinite(x + y + z))
  }
}
