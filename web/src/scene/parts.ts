import {
  BoxGeometry,
  BufferGeometry,
  type ColorRepresentation,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Object3D,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from 'three'
import type { Body } from '../report'

const UP = new Vector3(0, 1, 0)

export const solid = (color: ColorRepresentation) => new MeshLambertMaterial({ color })
/** Drawn over everything else and without shading: annotations, not matter. */
export const overlay = (color: ColorRepresentation) =>
  new MeshBasicMaterial({ color, depthTest: false, depthWrite: false, transparent: true })

/** Text under the pointer. */
export function named<T extends Object3D>(object: T, name: string): T {
  object.userData.name = name
  return object
}

export function ball(at: Vector3, radius: number, material: Material): Mesh {
  const mesh = new Mesh(new SphereGeometry(radius, 20, 14), material)
  mesh.position.copy(at)
  return mesh
}

export function cube(at: Vector3, side: number, material: Material): Mesh {
  const mesh = new Mesh(new BoxGeometry(side, side, side), material)
  mesh.position.copy(at)
  return mesh
}

/** A round bar of length 1; `stretch` puts it between two points. */
export function bar(radius: number, material: Material): Mesh {
  return new Mesh(new CylinderGeometry(radius, radius, 1, 14), material)
}

export function stretch(mesh: Mesh, from: Vector3, to: Vector3): Mesh {
  const along = to.clone().sub(from)
  const length = along.length()
  mesh.visible = length > 0
  mesh.position.copy(from).addScaledVector(along, 0.5)
  if (length > 0) mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length))
  mesh.scale.set(1, length, 1)
  return mesh
}

/** Turns an object made along y so that it points along `axis`. */
export function pointing<T extends Object3D>(object: T, axis: Vector3): T {
  object.quaternion.setFromUnitVectors(UP, axis.clone().normalize())
  return object
}

export function arrow(from: Vector3, along: Vector3, radius: number, material: Material): Group {
  const length = along.length()
  const head = Math.min(radius * 6, length * 0.5)
  const shaft = new Mesh(new CylinderGeometry(radius, radius, length - head, 10), material)
  shaft.position.y = (length - head) / 2
  const tip = new Mesh(new ConeGeometry(head * 0.42, head, 16), material)
  tip.position.y = length - head / 2
  const group = pointing(new Group().add(shaft, tip), along)
  group.position.copy(from)
  return group
}

/** Three quarters of a ring about `axis`, with a head that shows the right-handed sense of the turn. */
export function ringArrow(at: Vector3, axis: Vector3, ring: number, radius: number, material: Material): Group {
  const sweep = 1.5 * Math.PI
  const head = radius * 6
  const arc = new Mesh(new TorusGeometry(ring, radius, 8, 48, sweep - head / ring), material)
  const tip = new Mesh(new ConeGeometry(head * 0.42, head, 16), material)
  const angle = sweep - head / (2 * ring)
  tip.position.set(ring * Math.cos(angle), ring * Math.sin(angle), 0)
  tip.rotation.z = angle
  // The torus lies in xy; laid down, its axis is the y that `pointing` expects.
  const flat = new Group().add(arc, tip)
  flat.rotation.x = -Math.PI / 2
  const group = pointing(new Group().add(flat), axis)
  group.position.copy(at)
  return group
}

/** A body as bars between its hardpoints: a block for one, a bar for two, a plate for three, a star from the centroid for more. */
export function skeleton(body: Body, size: number, color: string): Group {
  const group = new Group()
  const material = solid(color)
  const points = body.skeleton.map((point) => new Vector3(...point))
  const spots = distinct(points, size * 1e-6)
  const link = (from: Vector3, to: Vector3) =>
    group.add(named(stretch(bar(size * 0.008, material), from, to), body.name))
  if (spots.length === 1) group.add(named(cube(spots[0], size * 0.04, material), body.name))
  if (spots.length === 2) link(spots[0], spots[1])
  if (spots.length === 3) {
    spots.forEach((spot, k) => link(spot, spots[(k + 1) % 3]))
    group.add(named(plate(spots, color), body.name))
  }
  if (spots.length > 3) {
    const centre = spots.reduce((sum, spot) => sum.add(spot), new Vector3()).divideScalar(spots.length)
    for (const spot of spots) link(centre, spot)
    group.add(named(ball(centre, size * 0.011, material), body.name))
  }
  points.forEach((point, k) => group.add(named(ball(point, size * 0.014, material), label(body, k))))
  return group
}

/** Ground's hardpoints: small blocks without bars, since ground is everywhere. */
export function groundMarks(body: Body, size: number, color: string): Group {
  const material = solid(color)
  const marks = body.skeleton.map((point, k) => named(cube(new Vector3(...point), size * 0.03, material), label(body, k)))
  return new Group().add(...marks)
}

function label(body: Body, point: number): string {
  const name = body.labels[point]
  return name ? `${name} (${body.name})` : body.name
}

function plate(corners: Vector3[], color: string): Mesh {
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(corners.flatMap((corner) => corner.toArray()), 3))
  const material = new MeshBasicMaterial({ color, opacity: 0.22, transparent: true, side: DoubleSide, depthWrite: false })
  return new Mesh(geometry, material)
}

function distinct(points: Vector3[], tolerance: number): Vector3[] {
  return points.filter((point, k) => points.findIndex((other) => other.distanceTo(point) <= tolerance) === k)
}
