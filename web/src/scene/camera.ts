import { OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'
import type { Mechanism } from './mechanism'
import { directions } from './triad'

export type Camera = PerspectiveCamera | OrthographicCamera

/** A standard view. */
export interface Look {
  name: string
  title: string
  /** From the mechanism to the eye. */
  direction: Vector3
  /** True if lengths are to compare: a parallel projection. */
  parallel: boolean
}

/** Vertical opening of the perspective, in degrees. */
const OPENING = 22
/** Margin of the picture. */
const MARGIN = 1.06
/** Height of a row of buttons at the top of the view, px. */
const TOP = 34

/** Room that buttons and captions take at the top and at the bottom of the view, px. */
export interface Insets {
  top?: number
  bottom?: number
}
/** Insets leave at least this part of half the height. */
const LEAST = 0.1
/** The eye stays so far before the nearest point, as a part of the mechanism's size. */
const AHEAD = 0.2
/** Along `up` left and right are undefined, so views deviate from it by this. */
const HAIR = 1e-4
/** One less the cosine of the angle up to which two directions of view are the same. */
export const STRAIGHT = 1e-6

/** A view along an axis of the triad, from one of its ends. */
export interface AxisLook {
  /** `top`, `rear`; `along x` of an axis without such a name. */
  word: string
  look: Look
}

/** The views offered, the first of them at the start. */
export function looksOf(mechanism: Mechanism): Look[] {
  const { plane, up, vehicle, report } = mechanism
  if (plane) {
    const right = up.clone().cross(plane)
    const tilt = plane.clone().addScaledVector(up, 0.45).addScaledVector(right, 0.55)
    return [
      look('straight', 'normal to the plane', plane.clone(), true),
      look('tilt', 'seen from the side and above', tilt, true),
    ]
  }
  if (vehicle) {
    const { forward } = vehicle
    const left = up.clone().cross(forward)
    const from = (ahead: number, aside: number, above: number) =>
      forward.clone().multiplyScalar(ahead).addScaledVector(left, aside).addScaledVector(up, above)
    const wheels = report.wheels.map(({ centre }) =>
      mechanism.worldAt(centre.body, new Vector3(...centre.at), 0).dot(left),
    )
    // With one wheel from inboard, so that the wheel is behind its knuckle.
    const outboard = wheels.length === 1 ? Math.sign(wheels[0]) || 1 : 1
    const corner = wheels.length > 1 ? from(0.95, -0.62, 0.5) : from(0.85, -0.8 * outboard, 0.42)
    return [
      look('corner', 'seen from the front corner', corner),
      look('front', 'seen from ahead, to scale', from(1, 0, HAIR), true),
      look('side', `seen from its ${outboard > 0 ? 'left' : 'right'}, to scale`, from(0, outboard, HAIR), true),
      look('top', 'seen from above, ahead is up, to scale', from(-HAIR, 0, 1), true),
      look('rear', 'seen from behind, to scale', from(-1, 0, HAIR), true),
    ]
  }
  return [
    look('corner', 'seen from the corner', mechanism.reader.clone()),
    look('front', 'seen along y, to scale', new Vector3(0, -1, HAIR), true),
    look('side', 'seen against x, to scale', new Vector3(1, 0, HAIR), true),
    look('top', 'seen from above, to scale', new Vector3(0, -HAIR, 1), true),
  ]
}

/** Views from both ends of each axis of the triad; those that are standard views are these. */
export function axisLooksOf({ vehicle, plane, up }: Mechanism, looks: readonly Look[]): AxisLook[] {
  const ahead = vehicle?.forward ?? plane?.clone().negate() ?? new Vector3(0, 1, 0)
  return directions(vehicle).flatMap(({ unit, name }) =>
    [1, -1].map((sign): AxisLook => {
      const eye = unit.clone().multiplyScalar(sign)
      const upright = eye.dot(up)
      const isUpright = Math.abs(upright) > 1 - STRAIGHT
      eye.addScaledVector(isUpright ? ahead : up, isUpright ? -HAIR * Math.sign(upright) : HAIR).normalize()
      const same = looks.find(({ direction, parallel }) => parallel && direction.dot(eye) > 1 - STRAIGHT)
      const end = isUpright ? (upright > 0 ? 'top' : 'bottom') : ENDS[name]?.[sign > 0 ? 0 : 1]
      const word = end ?? same?.name ?? `${sign > 0 ? 'against' : 'along'} ${name}`
      return { word, look: same ?? look(word, `${word}, to scale`, eye, true) }
    }),
  )
}

/** Both ends of a vehicle's axes. */
const ENDS: Partial<Record<string, [string, string]>> = { front: ['front', 'rear'], left: ['left', 'right'] }

const look = (name: string, title: string, direction: Vector3, parallel = false): Look => ({
  name,
  title,
  direction: direction.normalize(),
  parallel,
})

/** Camera of parallel projection, or of perspective. */
export function cameraFor({ up, size }: Mechanism, parallel: boolean): Camera {
  const camera = parallel ? new OrthographicCamera() : new PerspectiveCamera(OPENING)
  camera.up.copy(up)
  camera.near = size * 0.02
  camera.far = size * 60
  return camera
}

/**
 * Puts the camera where all points fill the picture but for the insets; the point in their middle, to be turned about.
 */
export function fit(
  camera: Camera,
  points: Vector3[],
  size: number,
  { direction }: Look,
  width: number,
  height: number,
  { top = TOP, bottom = 0 }: Insets = {},
): Vector3 {
  camera.position.copy(direction)
  camera.lookAt(0, 0, 0)
  camera.updateMatrixWorld()
  const [right, up, back] = [0, 1, 2].map((k) => new Vector3().setFromMatrixColumn(camera.matrixWorld, k))
  const aspect = width / height
  // Limits of the picture upwards and downwards: 1 is all of it.
  const [ceiling, floor] = [top, bottom].map((inset) => Math.max(1 - (2 * inset) / height, LEAST))
  const bound = (measure: (x: number, y: number, z: number) => number) =>
    points.reduce(
      (maximum, point) => Math.max(maximum, measure(point.dot(right), point.dot(up), point.dot(back))),
      -Infinity,
    )
  const nearest = bound((_, __, z) => z)
  const middle = (nearest - bound((_, __, z) => -z)) / 2
  const tangent = camera instanceof PerspectiveCamera ? Math.tan((camera.fov * Math.PI) / 360) : 0
  const [sides, above, below] = [aspect, ceiling, floor].map((limit) => (tangent * limit) / MARGIN)
  const [east, west] = [bound((x, _, z) => x + sides * z), bound((x, _, z) => -x + sides * z)]
  const [north, south] = [bound((_, y, z) => y + above * z), bound((_, y, z) => -y + below * z)]
  let centre: [x: number, y: number]
  let distance: number
  if (camera instanceof PerspectiveCamera) {
    distance = Math.max((east + west) / (2 * sides), (north + south) / (above + below), nearest + AHEAD * size)
    centre = [(east - west) / 2, (north - above * distance + below * distance - south) / 2]
  } else {
    const half = Math.max((north + south) / (ceiling + floor), (east + west) / 2 / aspect, 0.02 * size) * MARGIN
    camera.zoom = 1
    camera.userData.half = half
    distance = middle + 4 * size
    centre = [(east - west) / 2, (north - south) / 2 + ((floor - ceiling) / 2) * half]
  }
  const target = new Vector3()
    .addScaledVector(right, centre[0])
    .addScaledVector(up, centre[1])
    .addScaledVector(back, middle)
  camera.position.copy(target).addScaledVector(back, distance - middle)
  shapeTo(camera, aspect)
  return target
}

/** Pixels of the page per length at the place that the view turns about. */
export function pixelsPerLength(camera: Camera, target: Vector3, height: number): number {
  if (camera instanceof OrthographicCamera) return (height * camera.zoom) / (camera.top - camera.bottom)
  return height / (2 * Math.tan((camera.fov * Math.PI) / 360) * camera.position.distanceTo(target))
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
  camera.updateMatrixWorld()
}
