import { type Camera as AnyCamera, OrthographicCamera, type Scene, Vector3, type WebGLRenderer } from 'three'
import { el } from '../dom'
import { fit, type Look } from './camera'
import type { Mechanism } from './mechanism'
import { OVER } from './outlines'

/** Ratio of length to height above which a large mechanism has an overview above the view of a part. */
const LONG = 6
/** Height of the whole's strip, as a part of the view and in pixels at most. */
const STRIP = { share: 0.22, most: 110 }
/** Length of the part below, in heights, per aspect ratio of the view. */
const PART = 4

/** The whole of a long mechanism in a strip at the top of the view; a click there moves the part seen below. */
export class Overview {
  readonly element = el('div', { class: 'overview', 'aria-hidden': 'true' })
  readonly #camera = new OrthographicCamera()
  readonly #along: Vector3
  readonly #height: number

  /** The overview of a mechanism, where it needs one; `go` moves the view to a place. */
  static of(mechanism: Mechanism, look: Look, go: (place: Vector3) => void): Overview | undefined {
    const right = mechanism.up.clone().cross(look.direction).normalize()
    const [length, height] = [right, mechanism.up].map((axis) => extent(mechanism.sweep, axis))
    return mechanism.large && length > LONG * height ? new Overview(mechanism, look, right, height, go) : undefined
  }

  private constructor(
    private readonly mechanism: Mechanism,
    private readonly look: Look,
    along: Vector3,
    height: number,
    go: (place: Vector3) => void,
  ) {
    this.#along = along
    this.#height = Math.max(height, 4 * mechanism.unit)
    this.#camera.up.copy(mechanism.up)
    this.#camera.near = 0.02 * mechanism.size
    this.#camera.far = 60 * mechanism.size
    Object.assign(this.element.style, {
      position: 'absolute',
      insetInline: '0',
      top: '0',
      cursor: 'pointer',
      borderBottom: '1px solid var(--grid-main)',
    })
    this.element.addEventListener('pointerdown', ({ offsetX }) => {
      const x = (2 * offsetX) / this.element.clientWidth - 1
      go(new Vector3(x, 0, 0).unproject(this.#camera))
    })
  }

  /** Height of the strip in a view of this number of pixels. */
  strip(height: number): number {
    return Math.round(Math.min(STRIP.share * height, STRIP.most))
  }

  /** Points around a place that the view is to show. */
  part(points: Vector3[], place: Vector3, aspect: number): Vector3[] {
    const reach = (PART * this.#height * aspect) / 2
    const [low, high] = [-1, 1].map(
      (sign) => sign * points.reduce((most, point) => Math.max(most, sign * point.dot(this.#along)), -Infinity),
    )
    const middle = Math.max(low + reach, Math.min(high - reach, place.dot(this.#along)))
    const near = points.filter((point) => Math.abs(point.dot(this.#along) - middle) <= reach)
    return near.length > 0 ? near : points
  }

  resize(points: Vector3[], width: number, height: number): void {
    this.element.style.height = `${this.strip(height)}px`
    fit(this.#camera, points, this.mechanism.size, this.look, width, this.strip(height), { top: 0 })
  }

  /** Draws the strip over the picture of the part. */
  draw(renderer: WebGLRenderer, scene: Scene, width: number, height: number): void {
    const strip = this.strip(height)
    renderer.setViewport(0, height - strip, width, strip)
    renderer.setScissor(0, height - strip, width, strip)
    renderer.setScissorTest(true)
    renderer.clear()
    for (const layer of [0, OVER]) {
      this.#camera.layers.set(layer)
      renderer.render(scene, this.#camera as AnyCamera)
    }
    renderer.setScissorTest(false)
    renderer.setViewport(0, 0, width, height)
  }
}

function extent(points: Vector3[], axis: Vector3): number {
  const along = points.map((point) => point.dot(axis))
  return along.reduce((a, b) => Math.max(a, b), -Infinity) - along.reduce((a, b) => Math.min(a, b), Infinity)
}
