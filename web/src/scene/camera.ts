import { Box3, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'

/** A motion whose extent along z is below this share of its whole extent is looked at as planar. */
const FLAT = 1e-3
const MARGIN = 1.18

export type Look = 'iso' | 'x' | 'y' | 'z'

/** Where everything is that has to be seen. */
export class Extent {
  readonly centre = new Vector3()
  /** Length of the diagonal; everything drawn is scaled by it. */
  readonly size: number
  readonly lowest: number
  readonly planar: boolean

  constructor(readonly points: Vector3[]) {
    const box = new Box3().setFromPoints(points)
    if (box.isEmpty()) box.expandByPoint(this.centre)
    box.getCenter(this.centre)
    const sides = box.getSize(new Vector3())
    this.size = sides.length() || 1
    this.lowest = box.min.z
    this.planar = sides.z < FLAT * this.size
  }
}

export type Camera = PerspectiveCamera | OrthographicCamera

/** Parallel projection for planar mechanisms, where lengths should compare; perspective for spatial ones. */
export function cameraFor(extent: Extent): Camera {
  const camera = extent.planar ? new OrthographicCamera() : new PerspectiveCamera(22)
  camera.up.set(0, extent.planar ? 1 : 0, extent.planar ? 0 : 1)
  camera.near = extent.size * 0.01
  camera.far = extent.size * 40
  return camera
}

/** From the mechanism to the eye. Straight along `up` there is no telling left from right: a hair beside it there is. */
const HAIR = 1e-4
const DIRECTIONS: Record<Look, Vector3> = {
  iso: new Vector3(0.75, -1, 0.55).normalize(),
  x: new Vector3(1, 0, 0),
  y: new Vector3(0, -1, HAIR),
  z: new Vector3(0, -HAIR, 1),
}

/** Puts the camera where the whole motion fills the picture. */
export function fit(camera: Camera, extent: Extent, look: Look, aspect: number): void {
  const backward = DIRECTIONS[look]
  camera.position.copy(extent.centre).add(backward)
  camera.lookAt(extent.centre)
  camera.updateMatrixWorld()
  const eye = camera.quaternion.clone().invert()
  const seen = extent.points.map((point) => point.clone().sub(extent.centre).applyQuaternion(eye))
  if (camera instanceof PerspectiveCamera) {
    const tangent = Math.tan((camera.fov * Math.PI) / 360)
    const distance = seen.reduce(
      (far, at) => Math.max(far, at.z + (MARGIN * Math.max(Math.abs(at.y), Math.abs(at.x) / aspect)) / tangent),
      extent.size * 0.2,
    )
    camera.position.copy(extent.centre).addScaledVector(backward, distance)
  } else {
    const half = seen.reduce((most, at) => Math.max(most, Math.abs(at.y), Math.abs(at.x) / aspect), extent.size * 0.05)
    camera.zoom = 1
    camera.userData.half = half * MARGIN
    camera.position.copy(extent.centre).addScaledVector(backward, extent.size * 4)
  }
  shapeTo(camera, aspect)
}

/** Follows a new shape of the picture without moving the camera. */
export function shapeTo(camera: Camera, aspect: number): void {
  if (camera instanceof PerspectiveCamera) camera.aspect = aspect
  else {
    const half: number = camera.userData.half ?? 1
    camera.top = half
    camera.bottom = -half
    camera.left = -half * aspect
    camera.right = half * aspect
  }
  camera.updateProjectionMatrix()
}
