import { type BufferGeometry, InstancedMesh, Matrix4, type Mesh, type Object3D, Vector3 } from 'three'

/** Number of directions miss less than 2 % of a ball's radius. */
const DIRECTIONS = 200
/** The turn by which neighbours on a spiral keep farthest from one another. */
const GOLDEN = Math.PI * (3 - Math.sqrt(5))

/** Spread evenly over the sphere, on a spiral from pole to pole. */
const directions = Array.from({ length: DIRECTIONS }, (_, k) => {
  const z = 1 - (2 * k + 1) / DIRECTIONS
  const r = Math.sqrt(1 - z * z)
  return new Vector3(r * Math.cos(k * GOLDEN), r * Math.sin(k * GOLDEN), z)
})

const known = new WeakMap<BufferGeometry, Vector3[]>()

/** Outermost points in many directions: a shape that holds them holds all points, but for 2 % of a ball's radius. */
export function outermost(points: Vector3[]): Vector3[] {
  if (points.length <= DIRECTIONS) return points
  const found = new Set<Vector3>()
  for (const { x, y, z } of directions) {
    let [farthest, maximum] = [points[0], -Infinity]
    for (const point of points) {
      const reach = point.x * x + point.y * y + point.z * z
      if (reach > maximum) [farthest, maximum] = [point, reach]
    }
    found.add(farthest)
  }
  return [...found]
}

/** Points that bound the visible parts of an object, in its parent frame; the object itself counts as visible. */
export function bounds(object: Object3D, within = new Matrix4()): Vector3[] {
  object.updateMatrix()
  const here = within.clone().multiply(object.matrix)
  const placed = (at: Matrix4) => own.map((point) => point.clone().applyMatrix4(at))
  const { geometry } = object as Partial<Mesh>
  const own = geometry ? ofGeometry(geometry) : []
  const places = object instanceof InstancedMesh ? instances(object).map((one) => one.premultiply(here)) : [here]
  return [
    ...places.flatMap(placed),
    ...object.children.filter(({ visible }) => visible).flatMap((child) => bounds(child, here)),
  ]
}

function ofGeometry(geometry: BufferGeometry): Vector3[] {
  const before = known.get(geometry)
  if (before) return before
  const { position, instanceStart, instanceEnd } = geometry.attributes
  // Of a wide line the positions are those of a stretch that is laid from place to place.
  const places = instanceStart ? [instanceStart, instanceEnd] : position ? [position] : []
  const points = places.flatMap((one) =>
    Array.from({ length: one.count }, (_, k) => new Vector3().fromBufferAttribute(one, k)),
  )
  const found = outermost(points.filter(({ x, y, z }) => Number.isFinite(x + y + z)))
  known.set(geometry, found)
  return found
}

function instances(mesh: InstancedMesh): Matrix4[] {
  return Array.from({ length: mesh.count }, (_, k) => {
    const matrix = new Matrix4()
    mesh.getMatrixAt(k, matrix)
    return matrix
  })
}
