import { BufferAttribute, BufferGeometry, Float32BufferAttribute, Vector3 } from 'three'
import { deformed } from '../deform'
import type { Draw, Drawable } from '../drawable'
import type { Mechanism } from '../mechanism'
import { bodyPart } from '../part'

/** Sharper edges than this are drawn, degrees. */
const EDGES = 35
/** A mesh of more triangles has no edges: finding them would take longer than a reader waits. */
const MANY = 60_000

/** Bodies with a mesh, which deforms with the hardpoints when the design changes. */
export const meshes: Draw = (mechanism, kit) =>
  mechanism.report.bodies.flatMap(({ mesh }, body): Drawable[] => {
    if (!mesh) return []
    const triangles = Uint32Array.from(mesh.triangles)
    const geometry = new BufferGeometry()
    geometry.setAttribute('position', new Float32BufferAttribute(asDesigned(mechanism, body, mesh.positions), 3))
    geometry.setIndex(new BufferAttribute(triangles, 1))
    geometry.computeVertexNormals()
    const finish = { open: true, facets: true, edges: triangles.length < 3 * MANY ? EDGES : undefined }
    return [{ body, object: kit.mesh(geometry, kit.body(body), finish), part: bodyPart(mechanism, body) }]
  })

/** The file has the shape as loaded; a changed design has it gone with its hardpoints. */
function asDesigned(mechanism: Mechanism, body: number, positions: Float32Array): Float32Array {
  if (!mechanism.base) return positions
  const [from, to] = [mechanism.base, mechanism].map(({ report }) =>
    report.bodies[body].skeleton.map((point) => new Vector3(...point)),
  )
  return from.length === to.length && from.length > 0 ? deformed(positions, from, to) : positions
}
