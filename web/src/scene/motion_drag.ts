import type { Vector3 } from 'three'
import type { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import type { State } from '../state'
import type { Part } from './drawable'
import type { Mechanism } from './mechanism'
import { STILL } from './pointer'

/** A point that moves less than this on the screen, px, is not dragged: the view is turned instead. */
const MOVES = 12
/** Part of the motion to either side that is searched for a nearer position. */
const AHEAD = 0.02
/** First and last positions nearer than this, px, are one: the motion is a cycle. */
const CLOSED = 2

interface Screen {
  x: number
  y: number
}

/** Parts of the view that a drag needs. */
interface Scene {
  find: (x: number, y: number) => { part: Part; point: Vector3 } | undefined
  mechanism: () => Mechanism
  project: (place: Vector3) => Screen
}

/** Moves the mechanism along its motion, by dragging one of its bodies. */
export class MotionDrag {
  #path?: Screen[]
  #from?: Screen & { id: number }
  #moving = false

  constructor(
    canvas: HTMLCanvasElement,
    controls: OrbitControls,
    private readonly state: State,
    private readonly scene: Scene,
  ) {
    const signal = state.ended
    // Before the controls, which would turn the view.
    canvas.addEventListener(
      'pointerdown',
      (event) => {
        if (event.button !== 0 || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey || this.#from) return
        this.#path = this.#pathAt(event.offsetX, event.offsetY)
        if (!this.#path) return
        this.#from = { x: event.offsetX, y: event.offsetY, id: event.pointerId }
        controls.enabled = false
        canvas.setPointerCapture(event.pointerId)
      },
      { capture: true, signal },
    )
    const drag = ({ offsetX: x, offsetY: y, pointerId }: PointerEvent) => {
      const from = this.#from
      if (!from || !this.#path || pointerId !== from.id) return
      this.#moving ||= Math.hypot(x - from.x, y - from.y) > STILL
      if (!this.#moving) return
      state.pause()
      canvas.style.cursor = 'grabbing'
      state.goToStep(nearest(this.#path, { x, y }, state.step))
    }
    canvas.addEventListener('pointermove', drag, { signal })
    const end = ({ pointerId }: PointerEvent) => {
      if (pointerId !== this.#from?.id) return
      this.#path = this.#from = undefined
      this.#moving = false
      controls.enabled = true
      canvas.style.cursor = ''
    }
    canvas.addEventListener('pointerup', end, { signal })
    canvas.addEventListener('pointercancel', end, { signal })
  }

  /** Positions on the screen of the point of a body under the pointer, step by step, if it moves. */
  #pathAt(x: number, y: number): Screen[] | undefined {
    const hit = this.scene.find(x, y)
    const mechanism = this.scene.mechanism()
    const body = hit && bodyOf(hit.part, mechanism)
    if (!hit || !body || this.state.lastStep === 0) return undefined
    const place = mechanism.placeInto(body, hit.point, this.state.step)
    const path = Array.from({ length: this.state.lastStep + 1 }, (_, k) =>
      this.scene.project(mechanism.worldAt(body, place, k)),
    )
    const solved = path.filter((at) => Number.isFinite(at.x + at.y))
    const reach = Math.max(0, ...solved.map((at) => Math.hypot(at.x - x, at.y - y)))
    return reach < MOVES ? undefined : path
  }
}

/** Moving body that a part belongs to; 0 for none. */
function bodyOf({ kind, index }: Part, { report }: Mechanism): number {
  switch (kind) {
    case 'body':
      return index
    case 'wheel':
      return report.wheels[index].centre.body
    case 'shape':
      return report.clearance!.shapes[index].body
    case 'joint':
      return report.joints[index].body_j || report.joints[index].body_i
    case 'coupler':
    case 'driver':
    case 'distance':
    case 'load':
    case 'mark':
      return 0
  }
}

/**
 * Fractional step at which a path is nearest to the pointer, found by going downhill from the present one: where the
 * path crosses itself, it stays on its branch.
 */
export function nearest(path: readonly Screen[], at: Screen, from: number): number {
  const last = path.length - 1
  const closed = distance(path[0], path[last]) < CLOSED
  const index = (k: number) => (closed ? ((k % last) + last) % last : Math.min(Math.max(k, 0), last))
  const far = (k: number) => (known(k) ? distance(path[index(k)], at) : Infinity)
  const ahead = Math.max(1, Math.round(AHEAD * last))
  const known = (k: number) => Number.isFinite(path[index(k)].x)
  let best = Math.round(from)
  for (let walked = 0; walked <= last; ) {
    const near = Array.from({ length: 2 * ahead + 1 }, (_, k) => best + k - ahead)
    const next = near.reduce((a, b) => (far(b) < far(a) - 1e-9 ? b : a), best)
    if (next === best) break
    walked += Math.abs(next - best)
    best = next
  }
  const fractions = [best - 1, best]
    .filter((k) => known(k) && known(k + 1))
    .map((k) => {
      const [a, b] = [path[index(k)], path[index(k + 1)]]
      const length = (b.x - a.x) ** 2 + (b.y - a.y) ** 2
      const part = length > 0 ? ((at.x - a.x) * (b.x - a.x) + (at.y - a.y) * (b.y - a.y)) / length : 0
      const t = Math.min(Math.max(part, 0), 1)
      return { step: k + t, far: distance({ x: a.x + t * (b.x - a.x), y: a.y + t * (b.y - a.y) }, at) }
    })
  const found = fractions.reduce((a, b) => (b.far < a.far ? b : a), { step: best, far: far(best) }).step
  return closed ? ((found % last) + last) % last : Math.min(Math.max(found, 0), last)
}

function distance(a: Screen, b: Screen): number {
  return Math.hypot(a.x - b.x, a.y - b.y)
}
