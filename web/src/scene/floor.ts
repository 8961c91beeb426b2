import {
  BufferGeometry,
  Color,
  DirectionalLight,
  Float32BufferAttribute,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  type Material,
  Mesh,
  type Object3D,
  PlaneGeometry,
  ShadowMaterial,
  Vector3,
} from 'three'
import { roundBelow } from '../format'
import { across } from './flat'
import type { Mechanism } from './mechanism'
import { OVER } from './outlines'
import type { Palette } from './palette'

/** Visible radius of the grid, and its strength for a planar mechanism, relative to its reach and colour. */
const FADE = 1.05
const FLAT_GRID = 0.55
/** Direction of the sun that casts shadows. */
const SUN = new Vector3(0.35, -0.45, 1)
/** Side of the picture of shadows; they are soft, so that it need not be finer. */
const SHADOW_PICTURE = 1024

/** Light, floor, shadow and grid. */
export class Floor {
  readonly object = new Group()
  /** Side of the grid's cell, in the model's length unit. */
  readonly cell: number
  /** Receives the shadows; a planar mechanism has none. */
  readonly shadow?: Object3D
  readonly #own: (BufferGeometry | Material)[] = []

  /** `lowest` is the lowest coordinate of the drawing along `up`; vehicles are on the road. */
  constructor(mechanism: Mechanism, palette: Palette, lowest: number) {
    const { plane, up, size, centre, report } = mechanism
    const reach = size + 2 * Math.max(0, ...report.wheels.map(({ radius }) => radius))
    this.cell = roundBelow(reach / 5)
    const normal = plane ?? up
    const height = plane ? plane.dot(centre) - 3 * mechanism.unit : (road(mechanism) ?? lowest - 0.002 * size)
    const middle = centre.clone().addScaledVector(normal, height - centre.dot(normal))

    const { light } = palette
    const sun = new DirectionalLight(0xffffff, light.sun)
    const right = up.clone().cross(normal)
    const from = plane ? plane.clone().addScaledVector(up, 0.5).addScaledVector(right, -0.4) : SUN.clone()
    sun.position.copy(centre).addScaledVector(from.normalize(), 3 * size)
    sun.target.position.copy(centre)
    const sky = new HemisphereLight(0xffffff, light.earth, light.sky)
    sky.position.copy(plane ?? up)
    // Programs depend on the lights: with others, or none, what is over the parts would need programs of its own.
    for (const light of [sun, sky]) light.layers.enable(OVER)
    this.object.add(sky, sun, sun.target, this.#grid(middle, normal, reach, plane !== undefined, palette))
    if (plane) return

    sun.castShadow = true
    sun.shadow.mapSize.set(SHADOW_PICTURE, SHADOW_PICTURE)
    sun.shadow.radius = 3
    sun.shadow.bias = -0.0005
    Object.assign(sun.shadow.camera, {
      left: -reach,
      bottom: -reach,
      right: reach,
      top: reach,
      near: 0.1 * size,
      far: 8 * size,
    })
    const material = new ShadowMaterial({ opacity: light.shadow })
    const ground = new Mesh(new PlaneGeometry(12 * reach, 12 * reach), material)
    ground.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal)
    ground.position.copy(middle)
    ground.receiveShadow = true
    this.#own.push(material, ground.geometry)
    this.shadow = ground
    this.object.add(ground)
  }

  dispose(): void {
    for (const one of this.#own) one.dispose()
    this.object.traverse((object) => {
      if (object instanceof DirectionalLight) object.dispose()
    })
  }

  /** Lines on round coordinates; on a floor they fade out with the distance from the middle. */
  #grid(middle: Vector3, normal: Vector3, reach: number, flat: boolean, palette: Palette): Object3D {
    const { cell } = this
    const main = Math.abs(normal.x) < 0.5 ? new Vector3(1, 0, 0) : across(normal)
    const other = normal.clone().cross(main)
    const count = 2 * Math.ceil(((flat ? 3 : 1.1) * reach) / cell)
    const snap = (axis: Vector3) => Math.round(middle.dot(axis) / cell) * cell
    const origin = normal
      .clone()
      .multiplyScalar(middle.dot(normal) - 1e-3 * reach)
      .addScaledVector(main, snap(main))
      .addScaledVector(other, snap(other))
    const view = new Color(palette.view)
    const line = new Color(palette.gridMain)
    const positions: number[] = []
    const colours: number[] = []
    for (const [along, aside] of [
      [main, other],
      [other, main],
    ]) {
      for (let k = -count / 2; k <= count / 2; k++) {
        for (let i = -count / 2; i < count / 2; i++) {
          for (const end of [i, i + 1]) {
            const at = origin
              .clone()
              .addScaledVector(aside, k * cell)
              .addScaledVector(along, end * cell)
            const share = flat ? FLAT_GRID : Math.max(0, 1 - at.distanceTo(middle) / (FADE * reach))
            positions.push(at.x, at.y, at.z)
            colours.push(...view.clone().lerp(line, share).toArray())
          }
        }
      }
    }
    const geometry = new BufferGeometry()
    geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
    geometry.setAttribute('color', new Float32BufferAttribute(colours, 3))
    const material = new LineBasicMaterial({ vertexColors: true })
    this.#own.push(geometry, material)
    return new LineSegments(geometry, material)
  }
}

/** The lowest contact height in the design configuration; undefined without wheels. */
function road(mechanism: Mechanism): number | undefined {
  const heights = mechanism.report.wheels.map(({ centre, axis, radius }) => {
    const spin = mechanism.alongAt(centre.body, new Vector3(...axis), 0)
    // The lowest point of a leaning wheel is nearer to its centre than its radius.
    const upright = Math.sqrt(Math.max(0, 1 - spin.dot(mechanism.up) ** 2))
    return mechanism.worldAt(centre.body, new Vector3(...centre.at), 0).dot(mechanism.up) - radius * upright
  })
  return heights.length > 0 ? Math.min(...heights) : undefined
}
