import './sweep.css'
import { el, svg } from '../dom'
import { extent, linearAxis, type Axis } from '../export/axis'
import { figure, number, titled } from '../format'
import type { Sweep, SweepAxis } from '../report'
import { along, nearest } from './nearest'

const MARGIN = { left: 70, right: 16, top: 10, bottom: 46 }
/** About one number of an axis on that many pixels. */
const TICK = 70
/** A design is pointed at from so far, px. */
const REACH = 24

/** Number of points below which they are drawn larger. */
const FEW = 200

/**
 * Swept designs as points over two of their variables and metrics, and what Sobol's indices say of the metric that is
 * shown. The index of a point that is pressed, or dragged along, is passed on. Above the plot is the answer of the
 * study.
 */
export function sweepPlot(sweep: Sweep, setDesign?: (point: number) => void, answer?: HTMLElement): HTMLElement {
  return new Scatter(sweep, setDesign, answer).element
}

class Scatter {
  readonly element: HTMLElement
  readonly #x: HTMLSelectElement
  readonly #y: HTMLSelectElement
  readonly #picture = svg('svg', { role: 'img' })
  readonly #reading = el('output', { class: 'reading', 'aria-live': 'polite', 'data-testid': 'sweep-reading' })
  readonly #bars = el('div', { class: 'bars', 'data-testid': 'sweep-indices' })
  readonly #frame: HTMLElement
  #axes?: { x: Axis; y: Axis }
  #points: number[] = []
  #size = [0, 0]
  #chosen?: number

  constructor(
    private readonly sweep: Sweep,
    private readonly setDesign?: (point: number) => void,
    answer?: HTMLElement,
  ) {
    const render = () => this.#render()
    const choice = (name: string, chosen: number) =>
      el(
        'select',
        { 'aria-label': `${name} axis`, 'data-testid': `sweep-${name}`, onchange: render },
        ...sweep.axes.map((axis, k) => el('option', { value: k, selected: k === chosen }, axis.name)),
      )
    this.#x = choice('x', this.#strongest())
    this.#y = choice(
      'y',
      Math.max(
        0,
        sweep.axes.findIndex(({ metric }) => metric),
      ),
    )
    this.#frame = el(
      'div',
      {
        class: 'picture',
        tabindex: 0,
        role: 'application',
        'aria-label': `${sweep.what}s: left and right arrow go through them in the order of the x axis`,
        onpointermove: (event: PointerEvent) => this.#point(event, event.buttons === 1),
        onpointerdown: (event: PointerEvent) => this.#point(event, true),
        onkeydown: (event: KeyboardEvent) => this.#key(event),
      },
      this.#picture,
    )
    const drawn = sweep.axes[0]?.values.length ?? 0
    const note =
      drawn < sweep.designs
        ? `${number(drawn)} of ${number(sweep.designs, 10)} ${sweep.what}s are shown: every ${sweep.step}th.`
        : `${number(drawn)} ${sweep.what}s.`
    const hint = this.#isOfDesigns() ? ' Press a point, or drag along: the mechanism and its curves follow.' : ''
    const axes = el('p', { class: 'choice' }, el('label', {}, 'Y axis ', this.#y), el('label', {}, 'X axis ', this.#x))
    this.element = el(
      'section',
      { class: 'sweep', 'data-testid': 'sweep' },
      el(
        'div',
        { class: 'front' },
        answer,
        axes,
        el(
          'div',
          { class: 'sides' },
          this.#frame,
          el('div', { class: 'words' }, this.#reading, el('p', { class: 'note' }, note + hint)),
        ),
      ),
      this.#bars,
    )
    render()
    new ResizeObserver(([entry]) => {
      const { width, height } = entry.contentRect
      const size = [width, height].map(Math.round)
      if (size.includes(0) || size.every((length, k) => length === this.#size[k])) return
      this.#size = size
      render()
    }).observe(this.#frame)
  }

  /** The variable with the largest Sobol index of the first metric; by default the first. */
  #strongest(): number {
    const first = this.sweep.axes.findIndex(({ metric }) => metric)
    const of = this.sweep.indices.filter(({ metric }) => metric === first)
    return of.reduce((best, index) => (index.total[0] > best.total[0] ? index : best), of[0])?.variable ?? 0
  }

  /** True if points are designs that the page can show. */
  #isOfDesigns(): boolean {
    return this.setDesign !== undefined && this.sweep.axes.some(({ nominal }) => nominal !== null)
  }

  #shown(): { x: SweepAxis; y: SweepAxis } {
    return { x: this.sweep.axes[Number(this.#x.value)], y: this.sweep.axes[Number(this.#y.value)] }
  }

  #render(): void {
    this.#renderBars()
    const [width, height] = this.#size
    if (width === 0) return
    const { x: over, y: of } = this.#shown()
    const [right, bottom] = [width - MARGIN.right, height - MARGIN.bottom]
    const x = linearAxis(ends(over), MARGIN.left + 6, right - 6, Math.max(2, (right - MARGIN.left) / TICK))
    const y = linearAxis(ends(of), bottom - 6, MARGIN.top + 6, Math.max(2, (bottom - MARGIN.top) / TICK))
    this.#axes = { x, y }
    this.#points = along(over.values, of.values)
    if (this.#chosen !== undefined && !this.#points.includes(this.#chosen)) this.#chosen = undefined
    const dots = this.#points
      .map((k) => `M${x.at(over.values[k]).toFixed(1)},${y.at(of.values[k]).toFixed(1)}h0`)
      .join('')
    const targets = [
      ...(over.target === null ? [] : [line(x.at(over.target), MARGIN.top, x.at(over.target), bottom)]),
      ...(of.target === null ? [] : [line(MARGIN.left, y.at(of.target), right, y.at(of.target))]),
    ]
    const box = { x: MARGIN.left, y: MARGIN.top, width: right - MARGIN.left, height: bottom - MARGIN.top }
    this.#picture.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.#picture.setAttribute('width', String(width))
    this.#picture.setAttribute('height', String(height))
    this.#picture.setAttribute('aria-label', `${titled(of.name, of.unit)} over ${titled(over.name, over.unit)}`)
    this.#picture.replaceChildren(
      svg('rect', { ...box, class: 'frame' }),
      ...targets,
      svg('path', { class: this.#points.length < FEW ? 'points few' : 'points', d: dots }),
      ...x.ticks.map(({ value, text }) => label(text, x.at(value), bottom + 16, 'middle')),
      ...y.ticks.map(({ value, text }) => label(text, MARGIN.left - 6, y.at(value) + 4, 'end')),
      label(titled(over.name, over.unit), (MARGIN.left + right) / 2, height - 8, 'middle'),
      turned(titled(of.name, of.unit), 14, (MARGIN.top + bottom) / 2),
    )
    this.#mark()
  }

  #mark(): void {
    this.#picture.querySelector('.pointed')?.remove()
    const { x: over, y: of } = this.#shown()
    if (this.#chosen === undefined || !this.#axes) {
      const [known, all] = [this.#points.length, over.values.length]
      this.#reading.textContent =
        known < all ? `${number(all - known)} of the ${this.sweep.what}s shown have no ${of.name}.` : ''
      return
    }
    const k = this.#chosen
    this.#picture.append(
      svg('circle', { class: 'pointed', cx: this.#axes.x.at(over.values[k]), cy: this.#axes.y.at(of.values[k]), r: 6 }),
    )
    const all = this.sweep.axes.map(({ name, unit, target, values }) => {
      const value = Number.isFinite(values[k]) ? figure(Number(values[k].toPrecision(5)), unit) : 'no value'
      return `${name} ${value}${target === null ? '' : ` (target ${figure(target, unit)})`}`
    })
    this.#reading.textContent = `${this.sweep.what} ${k * this.sweep.step}: ${all.join(', ')}`
  }

  #point(event: PointerEvent, isPressed: boolean): void {
    if (!this.#axes) return
    const before = this.#chosen
    const corner = this.#picture.getBoundingClientRect()
    const { x: over, y: of } = this.#shown()
    const { x, y } = this.#axes
    this.#chosen = nearest(
      this.#points,
      (k) => [x.at(over.values[k]), y.at(of.values[k])],
      [event.clientX - corner.left, event.clientY - corner.top],
      REACH,
    )
    this.#mark()
    if (isPressed && (event.type === 'pointerdown' || this.#chosen !== before)) this.#show()
  }

  /** Shows the design of the chosen point. */
  #show(): void {
    if (this.#chosen !== undefined && this.#isOfDesigns()) this.setDesign?.(this.#chosen)
  }

  #key(event: KeyboardEvent): void {
    const last = this.#points.length - 1
    const now = this.#chosen === undefined ? -1 : this.#points.indexOf(this.#chosen)
    const next = (
      { ArrowRight: now + 1, ArrowLeft: now < 0 ? last : now - 1, Home: 0, End: last } as Record<string, number>
    )[event.key]
    if (next === undefined || last < 0) return
    event.preventDefault()
    event.stopPropagation()
    this.#chosen = this.#points[Math.min(Math.max(next, 0), last)]
    this.#mark()
    this.#show()
  }

  /** Part of the variance by every variable: alone as a bar, with others as an outline. */
  #renderBars(): void {
    const of = Number(this.#y.value)
    const indices = this.sweep.indices.filter(({ metric }) => metric === of).sort((a, b) => b.total[0] - a.total[0])
    const maximum = Math.max(1, ...indices.map(({ total }) => total[0] + total[1]))
    const part = (share: number) => `${(100 * Math.min(Math.max(share / maximum, 0), 1)).toFixed(2)}%`
    const rows = indices.flatMap(({ variable, first, total }) => [
      el('span', {}, this.sweep.axes[variable].name),
      el(
        'div',
        { class: 'bar' },
        el('span', { class: 'first', style: `width: ${part(first[0])}` }),
        el('span', { class: 'total', style: `width: ${part(total[0])}` }),
        el('span', { class: 'error', style: `left: ${part(total[0] - total[1])}; width: ${part(2 * total[1])}` }),
      ),
      el('span', {}, `${first[0].toFixed(3)} alone, ${total[0].toFixed(3)} ± ${total[1].toFixed(3)} total`),
    ])
    const title = el(
      'h3',
      { style: 'grid-column: 1 / -1' },
      `Sobol indices of ${this.sweep.axes[of]?.name}: shares of its variance`,
    )
    this.#bars.replaceChildren(...(indices.length > 0 ? [title, ...rows] : []))
  }
}

/** From the least to the greatest value, with the target. */
function ends({ values, target }: SweepAxis): [number, number] {
  return extent(target === null ? [values] : [values, Float32Array.of(target)]) ?? [0, 1]
}

/** Line at a target. */
function line(x1: number, y1: number, x2: number, y2: number): SVGElement {
  return svg('line', { class: 'target', 'data-testid': 'sweep-target', x1, y1, x2, y2 })
}

function label(text: string, x: number, y: number, anchor: string): SVGElement {
  return svg('text', { x, y, 'text-anchor': anchor }, document.createTextNode(text))
}

function turned(text: string, x: number, y: number): SVGElement {
  const element = label(text, x, y, 'middle')
  element.setAttribute('transform', `rotate(-90 ${x} ${y})`)
  return element
}
