import { type Intersection, type Material, type Mesh, type Object3D, Raycaster, Vector2, type Vector3 } from 'three'
import { el } from '../dom'
import type { Camera } from './camera'
import type { Part } from './drawable'

/** Distance from a line at which the pointer finds it, px. */
const REACH = 6
/** Distance between press and release up to which it is a click and not a drag, px. */
export const STILL = 4

/** Part under the pointer: names it next to the pointer, and selects it with a click. */
export class Pointer {
  readonly tip = el('div', { class: 'tip', hidden: true, 'data-testid': 'tip' })
  hovered?: Part
  #ray = new Raycaster()
  #down?: { x: number; y: number }
  #pending = false

  /**
   * `roots` holds what can be found; `hover` is called when something else is under the pointer, `choose` on a click.
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: () => Camera,
    private readonly roots: () => Object3D[],
    private readonly hover: () => void,
    choose: (part: Part | undefined) => void,
    signal: AbortSignal,
  ) {
    this.#ray.layers.enableAll()
    this.#ray.params.Line2 = { threshold: REACH }
    canvas.addEventListener('pointermove', (event) => this.#move(event), { signal })
    canvas.addEventListener('pointerleave', () => this.#show(undefined), { signal })
    canvas.addEventListener('pointerdown', ({ offsetX: x, offsetY: y }) => (this.#down = { x, y }), { signal })
    const release = ({ offsetX: x, offsetY: y, button }: PointerEvent) => {
      const down = this.#down
      this.#down = undefined
      if (button === 0 && down && Math.hypot(x - down.x, y - down.y) <= STILL) choose(this.hit(x, y)?.part)
    }
    canvas.addEventListener('pointerup', release, { signal })
  }

  #move(event: PointerEvent): void {
    // While it drags the view there is nothing to be named.
    if (event.buttons !== 0) return this.#show(undefined)
    if (this.#pending) return
    this.#pending = true
    const { offsetX: x, offsetY: y } = event
    requestAnimationFrame(() => {
      this.#pending = false
      this.#show(this.hit(x, y)?.part, x, y)
    })
  }

  /** Part at a position, and where it is seen: translucent parts only where nothing solid is. */
  hit(x: number, y: number): { part: Part; point: Vector3 } | undefined {
    const { clientWidth: width, clientHeight: height } = this.canvas
    this.#ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera())
    const hits = this.#ray.intersectObjects(this.roots()).filter(({ object }) => partOf(object) && shown(object))
    const solid = hits.find(({ object }) => !clear(object))
    const first = over(hits) ?? solid ?? hits[0]
    const part = partOf(first?.object)
    return part && { part, point: first.point }
  }

  #show(part: Part | undefined, x = 0, y = 0): void {
    if (part !== this.hovered) {
      this.hovered = part
      this.hover()
    }
    this.tip.hidden = !part
    this.canvas.style.cursor = part ? 'pointer' : ''
    if (!part) return
    this.tip.replaceChildren(el('strong', {}, part.name), el('div', {}, part.about))
    const { clientWidth: width, clientHeight: height } = this.canvas
    // To the left of the pointer in the right half, above it in the lower, so that the text never leaves the view.
    const [toLeft, toTop] = [x > width / 2, y > height / 2]
    Object.assign(this.tip.style, {
      left: toLeft ? 'auto' : `${x + 14}px`,
      right: toLeft ? `${width - x + 14}px` : 'auto',
      top: toTop ? 'auto' : `${y + 10}px`,
      bottom: toTop ? `${height - y + 10}px` : 'auto',
    })
  }
}

/** The part that an object belongs to. */
function partOf(object: Object3D | undefined): Part | undefined {
  for (let at = object ?? null; at; at = at.parent) if (at.userData.part) return at.userData.part as Part
  return undefined
}

function shown(object: Object3D): boolean {
  for (let at: Object3D | null = object; at; at = at.parent) if (!at.visible) return false
  return true
}

const material = (object: Object3D) => (object as Mesh).material as Material | undefined
const clear = (object: Object3D) => (material(object)?.opacity ?? 1) < 1
const over = (hits: Intersection[]) => hits.find(({ object }) => material(object)?.depthTest === false)
