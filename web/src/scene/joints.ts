import { BoxGeometry, CylinderGeometry, Mesh, OctahedronGeometry, SphereGeometry, Vector3 } from 'three'
import type { JointMark } from '../payload'
import { named, pointing, solid } from './parts'

/** Rods and legs are drawn between their ends instead. */
export const isRod = (joint: JointMark) => joint.kind === 'distance' || joint.kind === 'leg'

/** Text under the pointer. */
export function jointName(joint: JointMark): string {
  return `${joint.name}: ${joint.kind}${joint.cut ? ', cut joint' : ''}`
}

/** The mark of a joint, placed on body i; slightly larger than a hardpoint so that both can be seen. */
export function glyph(joint: JointMark, size: number, color: string): Mesh {
  const mesh = named(new Mesh(shape(joint.kind, size), solid(color)), jointName(joint))
  if (joint.axis) pointing(mesh, new Vector3(...joint.axis))
  mesh.position.set(...joint.at_i)
  return mesh
}

function shape(kind: string, size: number) {
  switch (kind) {
    case 'revolute':
      return new CylinderGeometry(size * 0.017, size * 0.017, size * 0.058, 24)
    case 'cylindrical':
      return new CylinderGeometry(size * 0.016, size * 0.016, size * 0.11, 24)
    case 'translational':
      return new BoxGeometry(size * 0.02, size * 0.16, size * 0.02)
    case 'spherical':
      return new SphereGeometry(size * 0.021, 24, 16)
    default:
      return new OctahedronGeometry(size * 0.028)
  }
}
