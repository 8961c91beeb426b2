import {
  BoxGeometry,
  BufferGeometry,
  CanvasTexture,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  ExtrudeGeometry,
  Float32BufferAttribute,
  FrontSide,
  Group,
  LatheGeometry,
  LineBasicMaterial,
  LineSegments,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type MeshLambertMaterialParameters,
  type Object3D,
  Path,
  Quaternion,
  RepeatWrapping,
  Shape,
  SphereGeometry,
  SRGBColorSpace,
  Vector2,
  Vector3,
} from 'three'
import { Line2 } from 'three/addons/lines/Line2.js'
import { LineGeometry } from 'three/addons/lines/LineGeometry.js'
import { LineMaterial } from 'three/addons/lines/LineMaterial.js'
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js'
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js'
import { across, type Basis, type Flat, square } from './flat'
import type { Mechanism } from './mechanism'
import type { Palette } from './palette'
import { Stock } from './stock'

/** Finish of a mesh that is not a plain solid. */
export interface Finish {
  /** Translucent things have no outline and cast no shadow. */
  opacity?: number
  /** Draws the edges that are sharper than this angle, in degrees. */
  edges?: number
  /** Seen from both sides. */
  open?: boolean
  /** Flat faces instead of a round look. */
  facets?: boolean
}

/** Style of a line. */
export interface Stroke {
  dashed?: boolean
  opacity?: number
  /** Over everything else. */
  over?: boolean
  /** Names all that the points depend on, where that is shorter than the points. */
  key?: string
}

/** Dashes and gaps in units. */
const DASH = { on: 1.4, off: 1.1 }
/** Strength of edges within a part. */
const EDGE = 0.55
const Y = new Vector3(0, 1, 0)

/** Builder of all objects, in the frame of the given points; frees memory of the graphics card. */
export class Kit {
  /** Unit of all sizes. */
  readonly unit: number
  /** Taken from the stock, by key. */
  readonly #taken = new Map<string, Material | BufferGeometry | CanvasTexture>()
  /** Geometries that are of this kit alone. */
  #own: BufferGeometry[] = []

  constructor(
    readonly mechanism: Mechanism,
    readonly palette: Palette,
    private readonly stock = new Stock(),
  ) {
    this.unit = mechanism.unit
  }

  /** Colour of a body; ground's own for ground. */
  body(body: number): string {
    const tint = this.mechanism.colourOf(body)
    return tint < 0 ? this.palette.ground : this.palette.bodies[tint]
  }

  /** A lit material; one per colour and finish. */
  solid(colour: string, { opacity = 1, open = false, facets = false }: Finish = {}): Material {
    return this.#take(`solid ${colour} ${opacity} ${open} ${facets}`, () => {
      const clear = opacity < 1
      return lit({
        color: colour,
        transparent: clear,
        opacity,
        depthWrite: !clear,
        side: clear || open ? DoubleSide : FrontSide,
        flatShading: facets,
        // Back and front of a translucent part are of one colour: one pass draws both, and needs one program.
        forceSinglePass: true,
      })
    })
  }

  /** A material without light, for marks; `over` draws it over everything else. */
  flat(colour: string, { over = false, opacity = 1 }: { over?: boolean; opacity?: number } = {}): Material {
    return this.#take(
      `flat ${colour} ${over} ${opacity}`,
      () => new MeshBasicMaterial({ color: colour, transparent: true, opacity, depthTest: !over, depthWrite: !over }),
    )
  }

  /** Any geometry as a part's mesh. */
  mesh(geometry: BufferGeometry, colour: string, finish: Finish = {}): Mesh {
    this.#own.push(geometry)
    const mesh = this.#mesh(geometry, colour, finish)
    if (finish.edges) this.#own.push(this.#addEdges(mesh, new EdgesGeometry(geometry, finish.edges)))
    return mesh
  }

  /** A geometry as a part's mesh, where the key names all that the geometry depends on. */
  keyed(key: string, make: () => BufferGeometry, colour: string, finish: Finish = {}): Mesh {
    const geometry = this.#take(key, make)
    const mesh = this.#mesh(geometry, colour, finish)
    const { edges } = finish
    if (edges)
      this.#addEdges(
        mesh,
        this.#take(`edges ${edges} ${key}`, () => new EdgesGeometry(geometry, edges)),
      )
    return mesh
  }

  /** A round bar; `r2` is the radius at `to`. */
  cylinder(from: Vector3, to: Vector3, r1: number, r2: number, colour: string, finish: Finish = {}): Mesh {
    const along = to.clone().sub(from)
    const length = along.length()
    const straight = r1 === r2
    const mesh = straight
      ? this.keyed('rod', () => new CylinderGeometry(1, 1, 1, 20), colour, finish)
      : this.keyed(`cone ${r1} ${r2}`, () => new CylinderGeometry(r2, r1, 1, 20), colour, finish)
    if (straight) mesh.scale.set(r1, 1, r1)
    mesh.scale.y = length
    mesh.visible = length > 0
    return place(mesh, from.clone().addScaledVector(along, 0.5), length > 0 ? along : Y)
  }

  ball(at: Vector3, radius: number, colour: string, finish: Finish = {}): Mesh {
    const mesh = this.keyed('ball', () => new SphereGeometry(1, 20, 14), colour, finish)
    mesh.scale.setScalar(radius)
    mesh.position.copy(at)
    return mesh
  }

  /** A round plate or pin of height `height` about its middle. */
  disc(at: Vector3, axis: Vector3, radius: number, height: number, colour: string, finish: Finish = {}): Mesh {
    const mesh = this.keyed('disc', () => new CylinderGeometry(1, 1, 1, 36), colour, finish)
    mesh.scale.set(radius, height, radius)
    return place(mesh, at, axis)
  }

  /** A sleeve about its middle. */
  tube(
    at: Vector3,
    axis: Vector3,
    outer: number,
    inner: number,
    height: number,
    colour: string,
    finish: Finish = {},
  ): Mesh {
    const half = height / 2
    return this.lathe(
      at,
      axis,
      [
        [inner, -half],
        [outer, -half],
        [outer, half],
        [inner, half],
        [inner, -half],
      ],
      colour,
      { open: true, ...finish },
    )
  }

  /** A body of revolution about `axis` through `at`; the profile as radius and height along the axis. */
  lathe(at: Vector3, axis: Vector3, profile: Flat[], colour: string, finish: Finish = {}): Mesh {
    const points = () => profile.map(([r, h]) => new Vector2(r, h))
    return place(
      this.keyed(`lathe ${profile.join()}`, () => new LatheGeometry(points(), 48), colour, finish),
      at,
      axis,
    )
  }

  /** The shadow of a mesh that casts none itself, because it is translucent. */
  shadowOf({ geometry, position, quaternion, scale }: Mesh): Mesh {
    const material = this.#take(
      'shadow',
      () => new MeshBasicMaterial({ colorWrite: false, depthWrite: false, transparent: true }),
    )
    const caster = new Mesh(geometry, material)
    caster.position.copy(position)
    caster.quaternion.copy(quaternion)
    caster.scale.copy(scale)
    caster.castShadow = true
    caster.raycast = () => {}
    return caster
  }

  /** A box with its sides along x, y (made perpendicular to x) and their normal. */
  brick(
    at: Vector3,
    x: Vector3,
    y: Vector3,
    sides: [number, number, number],
    colour: string,
    finish: Finish = { edges: 30 },
  ): Mesh {
    const unit = x.clone().normalize()
    const up = square(y, unit)
    const pose = new Matrix4().makeBasis(unit, up, unit.clone().cross(up)).setPosition(at)
    const make = () => new BoxGeometry(...sides).applyMatrix4(pose)
    return this.keyed(`brick ${sides} ${pose.elements}`, make, colour, finish)
  }

  /** A plate of the given outline, its middle in the plane of the basis. */
  slab(
    outline: Flat[],
    basis: Basis,
    thickness: number,
    colour: string,
    holes: Flat[][] = [],
    finish: Finish = {},
  ): Mesh {
    const pose = basis.matrix()
    const make = () => {
      const shape = new Shape(outline.map(([x, y]) => new Vector2(x, y)))
      for (const hole of holes) shape.holes.push(new Path(hole.map(([x, y]) => new Vector2(x, y))))
      const geometry = new ExtrudeGeometry(shape, { depth: thickness, bevelEnabled: false })
      return geometry.translate(0, 0, -thickness / 2).applyMatrix4(pose)
    }
    return this.keyed(`slab ${outline};${holes.join(';')} ${thickness} ${pose.elements}`, make, colour, finish)
  }

  /** Triangles given by their corners, three by three. */
  triangles(corners: Vector3[], colour: string, finish: Finish = {}): Mesh {
    const numbers = corners.flatMap((corner) => corner.toArray())
    const make = () => {
      const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(numbers, 3))
      geometry.computeVertexNormals()
      return geometry
    }
    return this.keyed(`triangles ${numbers}`, make, colour, finish)
  }

  /** A line of some pixels' width through points. */
  line(points: Vector3[], colour: string, width: number, stroke: Stroke = {}): Line2 {
    const numbers = points.flatMap((point) => point.toArray())
    return new Line2(
      this.#laid('line', numbers, stroke, () => new LineGeometry().setPositions(numbers)),
      this.#stroke(colour, width, stroke),
    )
  }

  /** Separate lines, each from an even point to the odd one after it. */
  lines(points: Vector3[], colour: string, width: number, stroke: Stroke = {}): LineSegments2 {
    const numbers = points.flatMap((point) => point.toArray())
    return new LineSegments2(
      this.#laid('lines', numbers, stroke, () => new LineSegmentsGeometry().setPositions(numbers)),
      this.#stroke(colour, width, stroke),
    )
  }

  /** The hatched line of ISO 3952 from a to b: strokes on the side of `outwards`, one every 1.25 r. */
  hatchLine(a: Vector3, b: Vector3, outwards: Vector3, r: number): Object3D {
    const along = b.clone().sub(a)
    const count = Math.max(3, Math.round(along.length() / (1.25 * r)))
    const step = along.divideScalar(count)
    const away = outwards
      .clone()
      .normalize()
      .multiplyScalar(1.3 * r)
    const strokes = Array.from({ length: count }, (_, k) => a.clone().addScaledVector(step, k + 1))
    return new Group().add(
      this.line([a, b], this.palette.hatch, 2),
      this.lines(
        strokes.flatMap((foot) => [foot, foot.clone().addScaledVector(step, -0.9).add(away)]),
        this.palette.hatch,
        1.2,
      ),
    )
  }

  /** A hatched plate of ground, its face perpendicular to `down`, one side along `axis` where that is given. */
  footPlate(at: Vector3, down: Vector3, axis: Vector3 | undefined, size: number): Mesh {
    const up = down.clone().normalize().negate()
    return this.hatched(at, square(axis ?? across(up), up).cross(up), up, [size, 0.14 * size, 0.8 * size])
  }

  /** A hatched box of ground, as `brick`. */
  hatched(at: Vector3, x: Vector3, y: Vector3, sides: [number, number, number]): Mesh {
    // About two strokes per 2.5 units on every face, independent of its size.
    const scale = 1 / (2.5 * this.unit)
    const unit = x.clone().normalize()
    const up = square(y, unit)
    const pose = new Matrix4().makeBasis(unit, up, unit.clone().cross(up)).setPosition(at)
    const make = () => {
      const geometry = new BoxGeometry(...sides)
      const { uv, normal } = geometry.attributes
      for (let k = 0; k < uv.count; k++) {
        const [nx, ny] = [Math.abs(normal.getX(k)), Math.abs(normal.getY(k))]
        const width = nx > 0.5 ? sides[2] : sides[0]
        const height = ny > 0.5 ? sides[2] : sides[1]
        uv.setXY(k, uv.getX(k) * width * scale, uv.getY(k) * height * scale)
      }
      return geometry.applyMatrix4(pose)
    }
    const mesh = this.keyed(`hatched ${sides} ${scale} ${pose.elements}`, make, this.palette.ground)
    const { ground, view } = this.palette
    const map = this.#take(`hatching ${ground} ${view}`, () => hatching(this.palette))
    mesh.material = this.#take(`hatched ${ground} ${view}`, () => lit({ map }))
    return mesh
  }

  /** Frees graphics memory that no other kit uses. */
  dispose(): void {
    for (const key of this.#taken.keys()) this.stock.release(key)
    for (const one of this.#own) one.dispose()
    this.#taken.clear()
    this.#own = []
  }

  #mesh(geometry: BufferGeometry, colour: string, finish: Finish): Mesh {
    const mesh = new Mesh(geometry, this.solid(colour, finish))
    mesh.castShadow = (finish.opacity ?? 1) >= 1
    return mesh
  }

  #addEdges(mesh: Mesh, geometry: EdgesGeometry): EdgesGeometry {
    const edges = new LineSegments(geometry, this.#edge())
    edges.raycast = () => {}
    mesh.add(edges)
    return geometry
  }

  /** The geometry of a line, with the distances along it if it is dashed. */
  #laid<T extends LineSegmentsGeometry>(kind: string, numbers: number[], { dashed, key }: Stroke, make: () => T): T {
    return this.#take(`${kind} ${dashed} ${key ?? numbers}`, () => {
      const geometry = make()
      if (dashed) new LineSegments2(geometry).computeLineDistances()
      return geometry
    })
  }

  #edge(): Material {
    return this.#take(
      `edge ${this.palette.outline}`,
      () => new LineBasicMaterial({ color: this.palette.outline, transparent: true, opacity: EDGE }),
    )
  }

  #stroke(colour: string, width: number, { dashed = false, opacity = 1, over = false }: Stroke): LineMaterial {
    return this.#take(
      `line ${colour} ${width} ${dashed && this.unit} ${opacity} ${over}`,
      () =>
        new LineMaterial({
          color: colour,
          linewidth: width,
          dashed,
          dashSize: DASH.on * this.unit,
          gapSize: DASH.off * this.unit,
          transparent: opacity < 1 || over,
          opacity,
          depthTest: !over,
          depthWrite: !over,
        }),
    )
  }

  #take<T extends Material | BufferGeometry | CanvasTexture>(key: string, make: () => T): T {
    const known = this.#taken.get(key)
    if (known) return known as T
    const made = this.stock.take(key, make)
    this.#taken.set(key, made)
    return made
  }
}

/** The texture of hatched ground. */
function hatching({ ground, view }: Palette): CanvasTexture {
  const canvas = document.createElement('canvas')
  const side = (canvas.width = canvas.height = 32)
  const brush = canvas.getContext('2d')!
  brush.fillStyle = ground
  brush.fillRect(0, 0, side, side)
  brush.strokeStyle = view
  brush.lineWidth = 7
  for (let k = -side; k < 2 * side; k += side / 2) {
    brush.beginPath()
    brush.moveTo(k, side + 2)
    brush.lineTo(k + side + 4, -2)
    brush.stroke()
  }
  const texture = new CanvasTexture(canvas)
  texture.wrapS = texture.wrapT = RepeatWrapping
  texture.colorSpace = SRGBColorSpace
  texture.anisotropy = 4
  return texture
}

/** Parts cast shadows on the floor only; without code for shadows on themselves their programs are half as long. */
function unshaded(program: { vertexShader: string; fragmentShader: string }): void {
  program.vertexShader = `#undef USE_SHADOWMAP\n${program.vertexShader}`
  program.fragmentShader = `#undef USE_SHADOWMAP\n${program.fragmentShader}`
}

/** A lit material of a part, on whose edges lines can be drawn. */
function lit(parameters: MeshLambertMaterialParameters): MeshLambertMaterial {
  const behindLines = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }
  const material = new MeshLambertMaterial({ ...parameters, ...behindLines })
  material.onBeforeCompile = unshaded
  return material
}

/** Puts an object made along y in its place, along `axis`. */
export function place<T extends Object3D>(object: T, at: Vector3, axis?: Vector3): T {
  object.position.copy(at)
  if (axis) object.quaternion.setFromUnitVectors(Y, axis.clone().normalize())
  return object
}

/**
 * Puts an object of length 1 along y, its middle at the origin, between two points; hides it where there is no length.
 */
export function stretch<T extends Object3D>(object: T, from: Vector3, to: Vector3): T {
  const along = to.clone().sub(from)
  const length = along.length()
  object.visible = length > 0
  if (!object.visible) return object
  object.scale.y = length
  return place(object, from.clone().addScaledVector(along, 0.5), along)
}

/**
 * Puts an object made along y at a place so that y is along `axis` and z along the part of `towards` that is
 * perpendicular to it.
 */
export function orient<T extends Object3D>(object: T, at: Vector3, axis: Vector3, towards: Vector3): T {
  const y = axis.clone().normalize()
  const z = square(towards, y)
  object.position.copy(at)
  object.quaternion.copy(new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(y.clone().cross(z), y, z)))
  return object
}
