import {
  type BufferGeometry,
  type Camera,
  type Color,
  InstancedMesh,
  LineSegments,
  type Material,
  Matrix4,
  type Mesh,
  type Object3D,
  type Texture,
  Vector3,
} from 'three'
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js'
import type { LabelBox } from '../scene/labels'
import { escaped, round, svgFile, tag } from './markup'

/** Options of a picture of the view. */
interface Picture {
  width: number
  height: number
  title: string
  /** Colours of the background, of outlines, of ground in place of its hatching, and of texts. */
  view: string
  ground: string
  outline: string
  label: string
  labels?: LabelBox[]
}

/**
 * Longer edges than this part of the picture's diagonal are cut, so that what is nearer can be reported by the middle
 * of a piece.
 */
const PIECE = 0.03
/** A fold of faces sharper than this is an edge, as a cosine. */
const FOLD = Math.cos((40 * Math.PI) / 180)
/** Two vertices nearer to one another than this part of the geometry's size are one. */
const SAME = 1e-5
/** Direction of light, from above and slightly from the left, and darkness of the other side. */
const LIGHT = new Vector3(-0.35, 0.7, 0.75).normalize()
const DARKEST = 0.62
/** Faces nearer to the light than this cosine have their full colour: those that face the reader, too. */
const BRIGHT = 0.6
/** Number of shades that are distinguished. */
const SHADES = 12
/** Width of outlines, px. */
const OUTLINE = 0.9
/** Outlines and lines are drawn before faces that are so much farther, as a part of the depth. */
const IN_FRONT = 2e-4

type Point = { x: number; y: number; depth: number }

/** A face or a line on its way to the paper. */
interface Stroke {
  /** Drawn after everything of a lower layer. */
  layer: number
  depth: number
  /** Attributes that neighbours must share to become one path. */
  style: string
  path: string
}

/**
 * The view as vector graphics: faces from the farthest to the nearest (painter's order), their outlines and folds, and
 * lines. Faces that cross one another are not cut; shadows and textures are left out.
 */
export function viewSvg(roots: Object3D[], camera: Camera, picture: Picture): Blob {
  const { width, height, view, label, labels = [] } = picture
  const strokes: Stroke[] = []
  for (const root of roots) {
    root.updateWorldMatrix(true, true)
    root.traverseVisible((object) => strokes.push(...strokesOf(object, camera, picture)))
  }
  strokes.sort((a, b) => a.layer - b.layer || b.depth - a.depth)
  return svgFile(
    width,
    height,
    picture.title,
    tag('rect', { width, height, fill: view }),
    `<g stroke-linejoin="round" stroke-linecap="round">${merged(strokes)}</g>`,
    tag(
      'g',
      { 'font-family': 'system-ui, sans-serif', 'font-size': 11, 'text-anchor': 'middle' },
      ...labels.map(({ spot, x, y }) =>
        tag('line', { x1: spot.x, y1: spot.y, x2: x, y2: y, stroke: label, 'stroke-opacity': 0.6 }),
      ),
      ...labels.map(
        (one) =>
          tag('rect', {
            x: one.x - one.width / 2,
            y: one.y - one.height / 2,
            width: one.width,
            height: one.height,
            rx: 4,
            fill: view,
            'fill-opacity': 0.9,
          }) + tag('text', { x: one.x, y: one.y + 4, fill: label }, escaped(one.spot.text)),
      ),
    ),
  )
}

/** Neighbours in the order that look the same, as one path. */
function merged(strokes: Stroke[]): string {
  const parts: string[] = []
  let path = ''
  strokes.forEach(({ style, path: piece }, k) => {
    path += piece
    if (strokes[k + 1]?.style === style) return
    parts.push(`<path ${style} d="${path}"/>`)
    path = ''
  })
  return parts.join('')
}

function strokesOf(object: Object3D, camera: Camera, picture: Picture): Stroke[] {
  if (object instanceof LineSegments2) return fatLines(object, camera, picture)
  // Thin edges of a mesh are found anew, as outlines.
  if (object instanceof LineSegments || !('isMesh' in object)) return []
  const mesh = object as Mesh
  const material = [mesh.material].flat()[0] as Material
  if (!('color' in material)) return []
  if (!(mesh instanceof InstancedMesh)) return faces(mesh, material, mesh.matrixWorld, camera, picture)
  return Array.from({ length: mesh.count }, (_, k) => {
    const matrix = new Matrix4()
    mesh.getMatrixAt(k, matrix)
    return faces(mesh, material, matrix.premultiply(mesh.matrixWorld), camera, picture)
  }).flat()
}

function projected(place: Vector3, camera: Camera, { width, height }: Picture): Point {
  const depth = -place.clone().applyMatrix4(camera.matrixWorldInverse).z
  const { x, y } = place.clone().project(camera)
  return { x: ((x + 1) * width) / 2, y: ((1 - y) * height) / 2, depth }
}

/** Over everything else, in its order, or among the things that hide one another. */
function layerOf(object: Object3D, { depthTest }: Material): number {
  return depthTest ? 0 : 1 + object.renderOrder
}

function fatLines(line: LineSegments2, camera: Camera, picture: Picture): Stroke[] {
  const { material } = line
  const { instanceStart: start, instanceEnd: end } = line.geometry.attributes
  const at = (k: number, attribute: typeof start) =>
    new Vector3(attribute.getX(k), attribute.getY(k), attribute.getZ(k)).applyMatrix4(line.matrixWorld)
  const { linewidth, opacity, dashed } = material
  const dashes = dashed ? ` stroke-dasharray="${round(4 * linewidth)} ${round(3 * linewidth)}"` : ''
  const width = `stroke-width="${round(linewidth)}"`
  const style = `fill="none" stroke="${hex(material.color)}" ${width} stroke-opacity="${round(opacity)}"${dashes}`
  const layer = layerOf(line, material)
  const strokes: Stroke[] = []
  for (let k = 0; k < start.count; k++) {
    const [from, to] = [at(k, start), at(k, end)]
    const [a, b] = [from, to].map((place) => projected(place, camera, picture))
    if (!visible(a) || !visible(b)) continue
    // Lines over everything need no order, and remain single lines with unbroken dashes.
    if (layer > 0) {
      const before = strokes[strokes.length - 1]
      const joined = before && before.path.endsWith(`L${xy(a)}`)
      if (joined) before.path += `L${xy(b)}`
      else strokes.push({ layer, depth: 0, style, path: `M${xy(a)}L${xy(b)}` })
    } else {
      for (const [p, q] of cut(a, b, picture))
        strokes.push({ layer, depth: ((p.depth + q.depth) / 2) * (1 - IN_FRONT), style, path: `M${xy(p)}L${xy(q)}` })
    }
  }
  return strokes
}

function cut(a: Point, b: Point, { width, height }: Picture): [Point, Point][] {
  const pieces = Math.min(
    200,
    Math.max(1, Math.ceil(Math.hypot(b.x - a.x, b.y - a.y) / (PIECE * Math.hypot(width, height)))),
  )
  const at = (k: number) => mid(a, b, k / pieces)
  return Array.from({ length: pieces }, (_, k) => [at(k), at(k + 1)])
}

function mid(a: Point, b: Point, share: number): Point {
  const mix = (p: number, q: number) => p + share * (q - p)
  return { x: mix(a.x, b.x), y: mix(a.y, b.y), depth: mix(a.depth, b.depth) }
}

function faces(mesh: Mesh, material: Material, matrix: Matrix4, camera: Camera, picture: Picture): Stroke[] {
  const { corners, vertices } = welded(mesh.geometry)
  const places = vertices.map((vertex) => vertex.clone().applyMatrix4(matrix))
  const points = places.map((place) => projected(place, camera, picture))
  const layer = layerOf(mesh, material)
  const clear = material.opacity < 1
  const lit = !('isMeshBasicMaterial' in material)
  const { color, map } = material as Material & { color: Color; map?: Texture | null }
  const colour = map ? picture.ground : hex(color)
  const strokes: Stroke[] = []
  /** Normal of every face at an edge; true if the face is visible. */
  const edges = new Map<string, { a: number; b: number; faces: { normal: Vector3; seen: boolean }[] }>()
  // A mirrored matrix turns the faces inside out.
  const mirrored = matrix.determinant() < 0
  for (let k = 0; k < corners.length; k += 3) {
    const [i, j, l] = mirrored
      ? [corners[k], corners[k + 2], corners[k + 1]]
      : [corners[k], corners[k + 1], corners[k + 2]]
    const [a, b, c] = [points[i], points[j], points[l]]
    if (![a, b, c].every(visible)) continue
    const normal = places[j].clone().sub(places[i]).cross(places[l].clone().sub(places[i])).normalize()
    const towards = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0
    const seen = towards || material.side !== 0
    for (const [from, to] of [
      [i, j],
      [j, l],
      [l, i],
    ]) {
      const key = from < to ? `${from} ${to}` : `${to} ${from}`
      const edge = edges.get(key) ?? { a: from, b: to, faces: [] }
      edges.set(key, edge)
      edge.faces.push({ normal, seen: towards })
    }
    if (!seen) continue
    const outwards = towards ? normal : normal.clone().negate()
    const fill = lit ? shaded(colour, outwards.transformDirection(camera.matrixWorldInverse).dot(LIGHT)) : colour
    // A hair of the same colour closes the gaps between faces.
    const style = clear
      ? `fill="${fill}" fill-opacity="${round(material.opacity)}"`
      : `fill="${fill}" stroke="${fill}" stroke-width="0.4"`
    for (const piece of divided([a, b, c], picture)) {
      strokes.push({
        layer,
        depth: (piece[0].depth + piece[1].depth + piece[2].depth) / 3,
        style,
        path: `M${xy(piece[0])}L${xy(piece[1])}L${xy(piece[2])}z`,
      })
    }
  }
  if (clear || layer > 0) return strokes
  const style = `fill="none" stroke="${picture.outline}" stroke-width="${OUTLINE}"`
  for (const {
    a,
    b,
    faces: [one, other],
  } of edges.values()) {
    const outline = !other || one.seen !== other.seen || (one.seen && one.normal.dot(other.normal) < FOLD)
    if (!outline || !(one.seen || other?.seen || material.side !== 0)) continue
    for (const [p, q] of cut(points[a], points[b], picture)) {
      strokes.push({ layer, depth: ((p.depth + q.depth) / 2) * (1 - IN_FRONT), style, path: `M${xy(p)}L${xy(q)}` })
    }
  }
  return strokes
}

/** Halves the longest side until none is long. */
function divided(triangle: Point[], picture: Picture): Point[][] {
  const limit = PIECE * Math.hypot(picture.width, picture.height) * 2
  const done: Point[][] = []
  const open = [triangle]
  while (open.length > 0) {
    const [a, b, c] = open.pop()!
    const sides = [length(a, b), length(b, c), length(c, a)]
    const longest = Math.max(...sides)
    // Edges far outside the picture are not cut.
    if (longest < limit || done.length + open.length > 400) {
      done.push([a, b, c])
      continue
    }
    const [p, q, r] = longest === sides[0] ? [a, b, c] : longest === sides[1] ? [b, c, a] : [c, a, b]
    const half = mid(p, q, 0.5)
    open.push([p, half, r], [half, q, r])
  }
  return done
}

const length = (a: Point, b: Point) => Math.hypot(a.x - b.x, a.y - b.y)
const visible = ({ x, y, depth }: Point) => depth > 0 && Number.isFinite(x + y)
const xy = ({ x, y }: Point) => `${Math.round(x * 10) / 10} ${Math.round(y * 10) / 10}`
const hex = (color: Color) => `#${color.getHexString()}`

/** A colour in the light of `cosine` between the face and the light. */
function shaded(colour: string, cosine: number): string {
  const step = Math.round(SHADES * Math.min(1, Math.max(0, (cosine + 1) / (BRIGHT + 1)))) / SHADES
  const share = DARKEST + (1 - DARKEST) * step
  const parts = [1, 3, 5].map((k) => Math.round(share * parseInt(colour.slice(k, k + 2), 16)))
  return `#${parts.map((part) => part.toString(16).padStart(2, '0')).join('')}`
}

/** Corners of the faces as indices of vertices, each place once: edges of neighbours are then one. */
function welded(geometry: BufferGeometry): { corners: number[]; vertices: Vector3[] } {
  const { position } = geometry.attributes
  if (!geometry.boundingSphere) geometry.computeBoundingSphere()
  const size = SAME * (geometry.boundingSphere?.radius || 1)
  const known = new Map<string, number>()
  const vertices: Vector3[] = []
  const indices = Array.from({ length: position.count }, (_, k) => {
    const place = new Vector3().fromBufferAttribute(position, k)
    const key = place
      .toArray()
      .map((x) => Math.round(x / size))
      .join(' ')
    const at = known.get(key) ?? vertices.push(place) - 1
    known.set(key, at)
    return at
  })
  const order = geometry.index ? Array.from(geometry.index.array) : indices.map((_, k) => k)
  return { corners: order.map((k) => indices[k]), vertices }
}
