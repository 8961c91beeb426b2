import type uPlot from 'uplot'
import { el, svg } from '../dom'
import { figure, roundBelow } from '../format'
import type { Overlay, Plot } from '../plot'
import { at, type Point, replaced, roundedIn, smoothed, thinned, upright, written } from './stroke'
import './studio.css'

/**
 * Distance at which a press takes hold of a point, for a mouse and a finger; and the minimum length of a stroke, px.
 */
const NEAR = 10
const FINGER = 22
const CLICK = 4
/** Step of an arrow key relative to the visible range, in round numbers: without and with Shift. */
const STRIDE = 1 / 40
const STEP = 1 / 200
/** Factor on the range of the ordinate, about its middle, to draw beyond the curves. */
const ROOM = 1.6

/** Actions on a drawn curve. */
export interface SketchActions {
  /** The curve is as it should be: points with rising abscissas in the units that are shown; at least two. */
  done: (points: Point[]) => void
  /** The curve is discarded. */
  cancel: () => void
}

/**
 * A curve drawn over a plot, with mouse, pen, touch or keys: freehand, one value at each abscissa, in a handful of
 * points that can be moved. What is drawn over a part takes its place. It is in use from when it is made until it is
 * done, cancelled or `close`d.
 */
export class Sketch implements Overlay {
  /** Drawn points, in the shown units. */
  #points: Point[]
  #plot?: uPlot
  #room = ROOM
  /** The stroke under way, px; or the point that is held. */
  #stroke?: Point[]
  #draggedPoint?: number
  /** Position of the cross that the keys move. */
  #cross?: Point
  #canvas = svg('svg', { 'aria-hidden': 'true' })
  #element = el(
    'div',
    {
      class: 'sketch',
      tabindex: 0,
      role: 'application',
      'data-testid': 'sketch',
      'aria-label':
        'Draw a target: arrow keys move the cross, with Shift in small steps; Enter sets a point, ' +
        'Delete removes the nearest, Page up and Page down go from point to point, Escape ends',
    },
    this.#canvas,
  )
  #reading = el('output', { 'data-testid': 'sketch-reading' })
  #take = el(
    'button',
    { type: 'button', class: 'first', 'data-testid': 'sketch-take', onclick: () => this.#finish() },
    'Use as target',
  )
  #bar: HTMLElement

  constructor(
    private readonly over: Plot,
    private readonly ends: SketchActions,
    points: readonly Point[] = [],
  ) {
    this.#points = [...points]
    const button = (title: string, testId: string, onclick: () => void) =>
      el('button', { type: 'button', 'data-testid': testId, onclick }, title)
    this.#bar = el(
      'div',
      { class: 'sketch-bar', role: 'toolbar', 'aria-label': 'Target curve' },
      this.#take,
      button('Clear', 'sketch-clear', () => this.#set([])),
      button('Extend axis', 'sketch-room', () => {
        this.#room *= ROOM
        this.#rescale()
      }),
      button('Cancel', 'sketch-cancel', () => this.#cancel()),
      this.#reading,
    )
    for (const [event, run] of Object.entries({
      pointerdown: this.#press,
      pointermove: this.#move,
      pointerup: this.#release,
      pointercancel: this.#drop,
    })) {
      this.#element.addEventListener(event, (one) => run.call(this, one as PointerEvent))
    }
    // The plot below means something else by all of these.
    for (const event of ['pointerdown', 'pointermove', 'pointerup', 'dblclick'])
      this.#element.addEventListener(event, (one) => one.stopPropagation())
    this.#element.addEventListener('keydown', (event) => this.#key(event))
    this.#element.addEventListener('focus', () => this.drawn())
    this.#element.addEventListener('blur', () => this.drawn())
    over.area.before(this.#bar)
    over.lay(this)
    this.#element.focus({ preventScroll: true })
  }

  /** Drawn points, in numbers that a person would write. */
  get points(): Point[] {
    return written(this.#points, this.#range())
  }

  /** Takes it away. */
  close(): void {
    this.#element.remove()
    this.#bar.remove()
    if (this.over.overlay === this) this.over.lay(undefined)
  }

  onto(plot: uPlot): void {
    const focused = document.activeElement === this.#element
    this.#plot = plot
    plot.over.append(this.#element)
    if (focused) this.#element.focus({ preventScroll: true })
  }

  reach(low: number, high: number): [low: number, high: number] {
    const ys = this.#points.map(([, y]) => y)
    const half = (this.#room * (high - low)) / 2
    const middle = (low + high) / 2
    return [Math.min(middle - half, ...ys), Math.max(middle + half, ...ys)]
  }

  drawn(): void {
    const places = this.#points.map((point) => this.#toPixels(point))
    const line = (points: readonly Point[]) => points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(' ')
    const parts: SVGElement[] = [svg('polyline', { class: 'drawn', points: line(places) })]
    for (const [x, y] of places) parts.push(svg('circle', { class: 'point', cx: x, cy: y, r: 4 }))
    if (this.#stroke) parts.push(svg('polyline', { class: 'stroke', points: line(this.#stroke) }))
    if (this.#cross && document.activeElement === this.#element) {
      const [x, y] = this.#toPixels(this.#cross)
      parts.push(svg('path', { class: 'cross', d: `M${x} -9999V9999M-9999 ${y}H9999` }))
    }
    this.#canvas.replaceChildren(...parts)
    this.#take.disabled = this.#points.length < 2
    this.#reading.textContent = this.#readingText()
  }

  #readingText(): string {
    const { over, unit } = this.over.content
    const read = ([x, y]: Point) => `${figure(x, over?.unit ?? 's')}: ${figure(y, unit)}`
    const focus =
      this.#draggedPoint === undefined
        ? document.activeElement === this.#element
          ? this.#cross
          : undefined
        : this.#points[this.#draggedPoint]
    const count = this.#points.length
    if (focus) return `${read(focus)}${count > 0 ? ` · ${count} point${count === 1 ? '' : 's'}` : ''}`
    return count === 0
      ? 'Draw the desired curve'
      : `${count} point${count === 1 ? '' : 's'}; draw over a section to change it, or drag a point`
  }

  #toPixels([x, y]: Point): Point {
    return [this.#plot!.valToPos(x, 'x'), this.#plot!.valToPos(y, 'y')]
  }

  #toValues([left, top]: Point): Point {
    return [this.#plot!.posToVal(left, 'x'), this.#plot!.posToVal(top, 'y')]
  }

  /** Visible range of both axes. */
  #range(): [across: number, up: number] {
    const of = (name: string) => {
      const { min, max } = this.#plot!.scales[name]
      return max! - min!
    }
    return [of('x'), of('y')]
  }

  #positionOf({ clientX, clientY }: PointerEvent): Point {
    const { left, top, width, height } = this.#element.getBoundingClientRect()
    return [Math.min(Math.max(clientX - left, 0), width), Math.min(Math.max(clientY - top, 0), height)]
  }

  #press(event: PointerEvent): void {
    if (event.button !== 0) return
    this.#element.setPointerCapture(event.pointerId)
    this.#element.focus({ preventScroll: true })
    const here = this.#positionOf(event)
    this.#cross = undefined
    const held = this.#nearest((point) => Math.hypot(...sub(this.#toPixels(point), here)))
    if (held && held.away <= (event.pointerType === 'touch' ? FINGER : NEAR)) this.#draggedPoint = held.index
    else this.#stroke = [here]
    this.drawn()
  }

  #move(event: PointerEvent): void {
    if (this.#draggedPoint !== undefined) this.#drag(this.#draggedPoint, this.#toValues(this.#positionOf(event)))
    else if (this.#stroke) {
      // A fast hand moves several times in a frame.
      const all = event.getCoalescedEvents?.() ?? []
      this.#stroke.push(...(all.length > 0 ? all : [event]).map((one) => this.#positionOf(one)))
      this.drawn()
    }
  }

  #release(): void {
    const stroke = this.#stroke
    this.#drop()
    if (!stroke) return
    const [xs, ys] = [stroke.map(([x]) => x), stroke.map(([, y]) => y)]
    const moved = Math.hypot(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys))
    if (moved < CLICK) return this.#setPoint(this.#toValues(stroke[0]))
    const part = thinned(smoothed(upright(stroke))).map((point) => this.#toValues(point))
    this.#set(replaced(this.#points, part, this.#range()[0]))
  }

  #drop(): void {
    this.#stroke = this.#draggedPoint = undefined
    this.drawn()
  }

  /** Moves a point between its neighbours. */
  #drag(index: number, [x, y]: Point): void {
    const room = this.#range()[0] * STEP
    const low = (this.#points[index - 1]?.[0] ?? -Infinity) + room
    const high = (this.#points[index + 1]?.[0] ?? Infinity) - room
    if (low <= high)
      this.#set(this.#points.map((point, k): Point => (k === index ? [Math.min(Math.max(x, low), high), y] : point)))
  }

  /** Sets a point, in place of one at that abscissa. */
  #setPoint(point: Point): void {
    const near = this.#range()[0] * STEP
    this.#set([...this.#points.filter(([x]) => Math.abs(x - point[0]) >= near), point].sort((a, b) => a[0] - b[0]))
  }

  #nearest(away: (point: Point) => number): { index: number; away: number } | undefined {
    return this.#points.map((point, index) => ({ index, away: away(point) })).sort((a, b) => a.away - b.away)[0]
  }

  #set(points: Point[]): void {
    this.#points = points
    this.drawn()
  }

  #rescale(): void {
    this.over.rescale()
  }

  #key(event: KeyboardEvent): void {
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : this.#action(event)
    if (!action) return
    event.preventDefault()
    // Nor the plot nor the page means anything by it.
    event.stopPropagation()
    action()
    this.drawn()
  }

  #action({ key, shiftKey }: KeyboardEvent): (() => void) | undefined {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key]
    if (by) return () => this.#moveCross(by[0], by[1], shiftKey ? STEP : STRIDE)
    const cross = this.#cross
    switch (key) {
      case 'Enter':
      case ' ':
        return () => this.#setPoint((this.#cross ??= this.#start()))
      case 'Delete':
      case 'Backspace':
        return () => {
          const nearest = cross && this.#nearest(([x]) => Math.abs(x - cross[0]))
          if (nearest) this.#set(this.#points.filter((_, k) => k !== nearest.index))
        }
      case 'PageUp':
        return () => (this.#cross = this.#points.findLast(([x]) => x < (cross?.[0] ?? Infinity)) ?? cross)
      case 'PageDown':
        return () => (this.#cross = this.#points.find(([x]) => x > (cross?.[0] ?? -Infinity)) ?? cross)
      case 'Escape':
        return () => this.#cancel()
    }
    return undefined
  }

  #moveCross(right: number, up: number, part: number): void {
    const [across, high] = this.#range()
    const [x, y] = (this.#cross ??= this.#start())
    const { x: horizontal, y: vertical } = this.#plot!.scales
    const within = (value: number, { min, max }: uPlot.Scale) => Math.min(Math.max(value, min!), max!)
    const by = (count: number, range: number) => count * roundBelow(part * range)
    this.#cross = [
      roundedIn(within(x + by(right, across), horizontal), across),
      roundedIn(within(y + by(up, high), vertical), high),
    ]
  }

  /** In the middle, on the curve where there is one. */
  #start(): Point {
    const [across, high] = this.#range()
    const { x, y } = this.#plot!.scales
    const middle = roundedIn((x.min! + x.max!) / 2, across)
    return [middle, at(this.#points, middle) ?? roundedIn((y.min! + y.max!) / 2, high)]
  }

  #finish(): void {
    const { points } = this
    this.close()
    this.ends.done(points)
  }

  #cancel(): void {
    this.close()
    this.ends.cancel()
  }
}

function sub(a: Point, b: Point): [number, number] {
  return [a[0] - b[0], a[1] - b[1]]
}
