import {
  AnimationClip,
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  type KeyframeTrack,
  LineSegments,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  type Object3D,
  QuaternionKeyframeTrack,
  type Texture,
  VectorKeyframeTrack,
} from 'three'
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js'
import type { LineSegments2 } from 'three/addons/lines/LineSegments2.js'
import type { Drawable } from '../scene/drawable'
import type { Mechanism } from '../scene/mechanism'

/** glTF is in metres; other units stay as they are. */
const METRES: Record<string, number> = { mm: 1e-3, cm: 1e-2, m: 1, in: 0.0254, ft: 0.3048 }

/**
 * The whole motion as a binary glTF file: one node per body under its name, one animation. Arrows and other marks are
 * left out. Everything drawn is put in its place for every output time, and left at the time `step`.
 */
export async function motionGltf(mechanism: Mechanism, drawn: Drawable[], step: number): Promise<Blob> {
  const { scene, clip } = motionScene(mechanism, drawn, step)
  const file = await new GLTFExporter().parseAsync(scene, { binary: true, animations: [clip], onlyVisible: false })
  return new Blob([file as ArrayBuffer], { type: 'model/gltf-binary' })
}

/** Scene to write: the drawn things with materials that glTF knows, and their motion. */
function motionScene(mechanism: Mechanism, drawn: Drawable[], step: number): { scene: Object3D; clip: AnimationClip } {
  const { report } = mechanism
  const materials = new Map<Material, Material>()
  const matter = drawn.filter(({ overlay }) => !overlay)
  const bodies = report.bodies.map(({ name }) => named(new Group(), name))
  const loose = new Group()
  /** Drawn objects, and their copies in the file. */
  const pairs: [Object3D, Object3D][] = []
  for (const { body, object, part } of matter) {
    const copied = copy(object, materials, pairs)
    ;(body === undefined ? loose : bodies[body]).add(named(copied, part.name))
  }
  const clip = new AnimationClip('motion', -1, tracks(mechanism, matter, bodies, pairs, step))
  // Ours is z up, glTF's is y up.
  const scene = named(new Group().add(...bodies, loose), report.title)
  scene.rotation.x = -Math.PI / 2
  scene.scale.setScalar(METRES[report.units.length] ?? 1)
  return { scene: new Group().add(scene), clip }
}

function named<T extends Object3D>(object: T, name: string): T {
  object.name = name
  return object
}

/** Copies everything that has a form, with its place. */
function copy(object: Object3D, materials: Map<Material, Material>, pairs: [Object3D, Object3D][]): Object3D {
  const copied = form(object, materials)
  copied.position.copy(object.position)
  copied.quaternion.copy(object.quaternion)
  copied.scale.copy(object.scale)
  pairs.push([object, copied])
  for (const child of object.children) if (!isEdges(child)) copied.add(copy(child, materials, pairs))
  return copied
}

/** The dark edges of a mesh are only for the screen. */
function isEdges(object: Object3D): boolean {
  return object instanceof LineSegments
}

function form(object: Object3D, materials: Map<Material, Material>): Object3D {
  if ('isLineSegments2' in object) return strokes(object as LineSegments2)
  if (!(object instanceof Mesh)) return new Group()
  const material = [object.material].flat()[0] as Material
  const known = materials.get(material) ?? matt(material)
  materials.set(material, known)
  return new Mesh(object.geometry, known)
}

function strokes({ geometry, material }: LineSegments2): LineSegments {
  const { instanceStart: start, instanceEnd: end } = geometry.attributes
  const places: number[] = []
  for (let k = 0; k < start.count; k++)
    places.push(start.getX(k), start.getY(k), start.getZ(k), end.getX(k), end.getY(k), end.getZ(k))
  const lines = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(places, 3))
  // The exporter has a word on the console about any other material without light.
  return new LineSegments(lines, new MeshBasicMaterial({ color: material.color }))
}

function matt(material: Material): Material {
  const { color, map } = material as { color?: Color; map?: Texture | null }
  const { opacity, transparent, side } = material
  return new MeshStandardMaterial({
    color: color ?? new Color(),
    map: map ?? null,
    metalness: 0,
    roughness: 1,
    opacity,
    transparent,
    side,
  })
}

/** Positions of an object at all times at which it has one. */
class Path {
  #times: number[] = []
  #place: number[] = []
  #turn: number[] = []
  #size: number[] = []

  add(time: number, { position, quaternion, scale }: Object3D): void {
    if (!Number.isFinite(position.x + position.y + position.z + quaternion.w + scale.x + scale.y + scale.z)) return
    this.#times.push(time)
    this.#place.push(...position.toArray())
    this.#turn.push(...quaternion.toArray())
    this.#size.push(...scale.toArray())
  }

  /** Tracks of properties that change. */
  tracks({ uuid }: Object3D): KeyframeTrack[] {
    const times = this.#times
    return [
      ...(changes(this.#place, 3) ? [new VectorKeyframeTrack(`${uuid}.position`, times, this.#place)] : []),
      ...(changes(this.#turn, 4) ? [new QuaternionKeyframeTrack(`${uuid}.quaternion`, times, this.#turn)] : []),
      ...(changes(this.#size, 3) ? [new VectorKeyframeTrack(`${uuid}.scale`, times, this.#size)] : []),
    ]
  }
}

function changes(numbers: number[], stride: number): boolean {
  return numbers.some((number, k) => number !== numbers[k % stride])
}

function tracks(
  mechanism: Mechanism,
  matter: Drawable[],
  bodies: Object3D[],
  pairs: [Object3D, Object3D][],
  step: number,
): KeyframeTrack[] {
  const { times } = mechanism.report
  const followers = matter.filter(({ follow }) => follow)
  const bodyPaths = bodies.map(() => new Path())
  const moved = new Set(followers.flatMap(({ object }) => within(object)))
  const paths = pairs.filter(([object]) => moved.has(object)).map((pair) => ({ pair, path: new Path() }))
  const show = (at: number) => {
    const frame = mechanism.frame(at)
    for (const { follow } of followers) follow!(frame)
    bodies.forEach((group, body) => {
      const pose = mechanism.poseAt(body, at)
      if (pose) group.position.copy(pose.place), group.quaternion.copy(pose.turn)
    })
    return frame
  }
  for (let k = 0; k < times.length; k++) {
    const frame = show(k)
    const time = times[k] - times[0]
    bodyPaths.forEach((path, body) => frame.visible(body) && path.add(time, bodies[body]))
    for (const { pair, path } of paths) path.add(time, pair[0])
  }
  show(step)
  for (const {
    pair: [object, copied],
  } of paths)
    copied.position.copy(object.position), copied.quaternion.copy(object.quaternion), copied.scale.copy(object.scale)
  return [
    ...bodyPaths.flatMap((path, body) => path.tracks(bodies[body])),
    ...paths.flatMap(({ pair, path }) => path.tracks(pair[1])),
  ]
}

function within(object: Object3D): Object3D[] {
  const all: Object3D[] = []
  object.traverse((one) => all.push(one))
  return all
}
