import './path_points.css'
import { Plane, Vector3 } from 'three'
import { el, svg } from '../dom'
import { save } from '../export/save'
import { messageOf, number, roundBelow } from '../format'
import { Backdrop, type Picture } from '../linkage/backdrop'
import type { View } from '../scene/view'
import type { State } from '../state'
import { LEAST_POINTS, type PathTask, taskToml } from './path_task'

/** Resolution of a click, and step of the arrow keys, as parts of the mechanism's size. */
const FINE = 1e-3
const STEP = 1e-2

/** Action of a server on a task. */
type Synthesis = (task: string) => Promise<void>

/**
 * Precision points of a path on the view of a planar mechanism: a click adds one, its handle is dragged, and the task
 * is saved as a file or solved by a server.
 */
export class PathPoints {
  readonly button = el(
    'button',
    {
      type: 'button',
      title: 'Points of a path, for which linkages are sought',
      'aria-pressed': 'false',
      'data-testid': 'path-points',
      onclick: () => this.toggle(),
    },
    'path points',
  )
  /** Over the view; takes the clicks. */
  readonly element = el('div', {
    class: 'grips path-overlay',
    hidden: true,
    'data-testid': 'path-overlay',
    onclick: (event: MouseEvent) => event.target === this.element && this.#add(event),
    onwheel: (event: WheelEvent) => this.view.canvas.dispatchEvent(new WheelEvent('wheel', event)),
  })
  readonly pane: HTMLElement
  #line = svg('svg', { class: 'ruler', 'aria-hidden': 'true' })
  #handles: HTMLButtonElement[] = []
  #summary = el('output', { 'data-testid': 'path-summary' })
  #failure = el('p', { class: 'wrong', role: 'alert' })
  #actions: HTMLButtonElement[]
  #held?: number
  #backdrop?: Backdrop
  /** The plane of the hardpoints, with its directions to the right and upwards in the world. */
  #plane: Plane
  #axes: [right: Vector3, up: Vector3]

  constructor(
    private readonly view: View,
    private readonly state: State,
    private readonly task: PathTask,
    normal: Vector3,
    /** Picture behind the view. */
    private readonly picture: Picture,
    synthesis: Synthesis | undefined,
  ) {
    const { report } = state
    const up = new Vector3(0, Math.abs(normal.z) > 0.5 ? 1 : 0, Math.abs(normal.z) > 0.5 ? 0 : 1)
    this.#axes = [up.clone().cross(normal).normalize(), up]
    const body = report.bodies.findIndex(({ skeleton }) => skeleton.length > 0)
    this.#plane = new Plane().setFromNormalAndCoplanarPoint(normal, view.original.skeletonAt(body, 0, 0))
    const option = (name: string, testId: string, key: 'isClosed' | 'isFullTurn') => {
      const box = el('input', {
        type: 'checkbox',
        checked: task[key],
        'data-testid': testId,
        onchange: () => ((task[key] = box.checked), this.#show()),
      })
      return el('label', {}, box, ' ', name)
    }
    const action = (name: string, testId: string, run: () => void | Promise<void>) =>
      el('button', { type: 'button', 'data-testid': testId, onclick: () => void this.#run(run) }, name)
    const file = () => save(new Blob([this.#toml], { type: 'application/toml' }), 'path.toml')
    this.#actions = [
      action('Task file', 'path-file', file),
      ...(synthesis ? [action('Synthesise', 'path-run', () => synthesis(this.#toml))] : []),
    ]
    this.pane = el(
      'section',
      {
        class: 'measuring path-pane',
        hidden: true,
        'aria-label': 'Path points',
        'data-testid': 'path-pane',
        onkeydown: (event: KeyboardEvent) => event.key === 'Escape' && this.toggle(),
      },
      option('closed', 'path-closed', 'isClosed'),
      option('crank turns fully', 'path-full', 'isFullTurn'),
      action('Remove last', 'path-remove', () => void this.#remove(task.points.length - 1)),
      action('Clear', 'path-clear', () => ((task.points.length = 0), this.#show())),
      ...this.#actions,
      action('Picture…', 'path-picture', () => this.#openPicture()),
      action('Done', 'path-done', () => this.toggle()),
      this.#summary,
      this.#failure,
    )
    this.element.append(this.#line)
    view.onDrawn(() => this.#follow())
    this.#show()
  }

  get on(): boolean {
    return !this.pane.hidden
  }

  toggle(): void {
    this.pane.hidden = this.element.hidden = this.on
    this.button.setAttribute('aria-pressed', String(this.on))
    if (this.on && this.picture.image) this.#openPicture()
    this.#show()
  }

  /** Adds the controls of the picture behind the view. */
  #openPicture(): void {
    const { original, element } = this.view
    const surface = {
      element: this.element,
      unit: this.state.report.units.length,
      project: ([x, y]: [number, number]) => this.view.project(this.#world([x, y])),
      seen: () => ({
        middle: this.#axes.map((axis) => original.centre.dot(axis)) as [number, number],
        size: [original.size, (original.size * element.clientHeight) / element.clientWidth] as [number, number],
      }),
    }
    this.#backdrop ??= new Backdrop(surface, this.picture)
    this.pane.append(this.#backdrop.tools)
  }

  get #toml(): string {
    const axes = this.#axes.map((axis) => ['x', 'y', 'z'].find((_, k) => Math.abs(axis.getComponent(k)) > 0.9) ?? '?')
    return taskToml(this.task, { model: this.state.report.file, units: this.state.report.units, axes: axes.join('-') })
  }

  async #run(action: () => void | Promise<void>): Promise<void> {
    this.#failure.textContent = ''
    try {
      await action()
    } catch (error) {
      this.#failure.textContent = messageOf(error)
    }
  }

  /** Place of a click in the plane; undefined where the view is along the plane. */
  #at({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] | undefined {
    const { left, top } = this.view.element.getBoundingClientRect()
    const place = this.view.sight(clientX - left, clientY - top).intersectPlane(this.#plane, new Vector3())
    return place ? (this.#axes.map((axis) => place.dot(axis)) as [number, number]) : undefined
  }

  #rounded(point: [number, number]): [number, number] {
    const by = roundBelow(FINE * this.view.original.size)
    return point.map((x) => Number((Math.round(x / by) * by).toPrecision(12))) as [number, number]
  }

  #world([x, y]: [number, number]): Vector3 {
    const [right, up] = this.#axes
    const origin = this.#plane.coplanarPoint(new Vector3())
    return origin.addScaledVector(right, x - origin.dot(right)).addScaledVector(up, y - origin.dot(up))
  }

  #add(event: MouseEvent): void {
    const point = this.#at(event)
    if (!point || this.#backdrop?.click(point)) return
    this.task.points.push(this.#rounded(point))
    this.#show()
    this.#handles.at(-1)?.focus()
  }

  #remove(k: number): void {
    if (k < 0) return
    this.task.points.splice(k, 1)
    this.#show()
    this.#handles[Math.min(k, this.#handles.length - 1)]?.focus()
  }

  #key(event: KeyboardEvent, k: number): void {
    const by = {
      ArrowRight: [1, 0],
      ArrowLeft: [-1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    }[event.key]
    if (event.key === 'Delete' || event.key === 'Backspace') this.#remove(k)
    else if (event.key === 'Escape') this.toggle(), this.button.focus()
    else if (by) {
      const step = (event.shiftKey ? FINE : STEP) * this.view.original.size
      const moved = this.task.points[k].map((x, axis) => x + by[axis] * roundBelow(step)) as [number, number]
      this.task.points[k] = this.#rounded(moved)
      this.#show()
    } else return
    event.preventDefault()
    event.stopPropagation()
  }

  #handle(k: number): HTMLButtonElement {
    const button = el('button', {
      type: 'button',
      class: 'grip path-handle',
      'data-testid': `path-${k}`,
      onkeydown: (event: KeyboardEvent) => this.#key(event, k),
      onpointerdown: (event: PointerEvent) => {
        if (event.button !== 0) return
        button.setPointerCapture(event.pointerId)
        this.#held = k
      },
      onpointermove: (event: PointerEvent) => {
        const point = this.#held === k ? this.#at(event) : undefined
        if (!point) return
        this.task.points[k] = this.#rounded(point)
        this.#show()
      },
      onpointerup: () => (this.#held = undefined),
      onpointercancel: () => (this.#held = undefined),
    })
    return button
  }

  #show(): void {
    const { points, isClosed } = this.task
    while (this.#handles.length > points.length) this.#handles.pop()!.remove()
    while (this.#handles.length < points.length) {
      const handle = this.#handle(this.#handles.length)
      this.#handles.push(handle)
      this.element.append(handle)
    }
    const { length } = this.state.report.units
    this.#handles.forEach((handle, k) => {
      const name = `point ${k + 1}: ${points[k].map((x) => number(x)).join(', ')} ${length}`
      handle.title = name
      handle.setAttribute('aria-label', name)
      handle.textContent = String(k + 1)
    })
    const missing = LEAST_POINTS - points.length
    this.#actions.forEach((button) => (button.disabled = missing > 0))
    this.#summary.textContent =
      missing > 0
        ? `Click the points of the path in their order; ${missing} more at least. ` +
          'Handles are dragged; Delete removes one.'
        : `${points.length} points, ${isClosed ? 'closed' : 'open'}. ` +
          'Linkages are sought whose point follows them in this order.'
    this.#follow()
  }

  /** Puts the handles where their points are in the picture. */
  #follow(): void {
    if (!this.on) return
    this.#backdrop?.follow()
    const places = this.task.points.map((point) => this.#world(point))
    this.#handles.forEach((handle, k) => this.view.put(handle, places[k]))
    const screen = places.map((place) => this.view.project(place))
    const ends = this.task.isClosed && screen.length > 2 ? [...screen, screen[0]] : screen
    this.#line.replaceChildren(
      ...ends.slice(1).map((b, k) => svg('line', { x1: ends[k].x, y1: ends[k].y, x2: b.x, y2: b.y })),
    )
  }
}
