import { Box3, Group, type Material, type Mesh, type Object3D, Vector3 } from 'three'
import type { Choice } from '../state'
import type { Draw, Drawn, Frame } from './drawn'
import { Kit } from './kit'
import type { Mechanism } from './mechanism'
import { OVER, type Outlines } from './outlines'
import type { Palette } from './palette'

/** Everything that some `Draw`s made of a mechanism, in groups that move with the bodies. */
export class Assembly {
  /** One per body, then what is in the world. */
  readonly groups: Group[]
  readonly drawn: Drawn[]
  /** Which numbers a part has in the picture of part numbers. */
  readonly numbers: { part: Drawn['part']; number: number }[] = []
  #kit: Kit

  /** Numbers start after `first`, so that those of two assemblies differ. */
  constructor(
    readonly mechanism: Mechanism,
    palette: Palette,
    choice: Choice,
    draws: Draw[],
    outlines: Outlines,
    first: number,
  ) {
    this.#kit = new Kit(mechanism, palette)
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
        if (!isMesh || Array.isArray(material) || material.transparent || !('wireframe' in material) || 'isLineSegments2' in one) return
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

  /** Corners of the boxes round everything drawn. */
  corners(): Vector3[] {
    return this.groups.flatMap((group) => {
      group.updateMatrixWorld()
      const found: Vector3[] = []
      group.traverseVisible((object) => found.push(...cornersOf(object)))
      return found
    })
  }

  dispose(): void {
    for (const group of this.groups) group.removeFromParent()
    this.#kit.dispose()
  }
}

function cornersOf(object: Object3D): Vector3[] {
  const { geometry } = object as Partial<Mesh>
  if (!geometry) return []
  if (!geometry.boundingBox) geometry.computeBoundingBox()
  const { min, max } = geometry.boundingBox ?? new Box3()
  const corners = [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))))
  return corners.map((corner) => corner.applyMatrix4(object.matrixWorld)).filter(({ x, y, z }) => Number.isFinite(x + y + z))
}
