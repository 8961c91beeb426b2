import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { css, el, keepFocus, prose, svg } from './dom'
import { number, pretty, titled } from './format'
import { decades, nearestStep, padded, positive, stepAt, valueAt, type Curve, withGaps } from './curve'
import { extent } from './export/axis'
import type { State } from './state'
import { atLeast, between, moved, ordinates, type Part, scaled, within, Zoom } from './zoom'

/** Default width of a plot, minimum height, and size on paper, px. */
const USUAL = 400
const LEAST = 120
const PAPER = { width: 330, height: 190 }
/** Wide enough for `−1.234e-5`, and the same for all plots, so that their time axes line up. */
const AXIS = 66
/** With more powers of ten than this along an axis, every other one has a number. */
const MOST_POWERS = 6

/** A magnifying glass with a plus. */
const GLASS = 'M6.5 2a4.5 4.5 0 1 0 0 9a4.5 4.5 0 1 0 0 -9M10 10l4 4M4.5 6.5h4M6.5 4.5v4'
/** A press that moves by less than this is a click, px. */
const CLICK = 4
/** Factor of a zoom step, and step of a shift as a fraction of the visible range. */
const CLOSER = 0.5
const ASIDE = 0.25

export interface Line {
  label: string
  color: string
  curve: Curve
  /** Thinned values drawn as circles instead of a line. */
  marks?: (number | null)[]
  width?: number
  dash?: number[]
  pick?: () => void
}

export interface Content {
  title: string
  /** Unit of the vertical axis, empty for a pure number. */
  unit: string
  lines: Line[]
  /** From a power of ten to another; values that are not positive are left out. */
  logarithmic?: boolean
  /** Abscissa of the curves instead of time. */
  over?: { label: string; unit: string; curve: Curve }
  /** Visible part of the abscissa; all of it if undefined. */
  part?: Part
  caption?: string
  /** Targets of the values: at one abscissa, or everywhere. */
  wanted?: { low: number | null; high: number | null; at?: number }[]
  /** Shown in place of the plot. */
  message?: string
}

/** Overlay on the curves of a plot that moves with them. */
export interface Overlay {
  /** The plot is drawn anew, and has a place for it. */
  onto(plot: uPlot): void
  /** The curves were drawn, and may have moved. */
  drawn(): void
  /** Range of the vertical axis, given its default range. */
  reach(low: number, high: number): [low: number, high: number]
}

/**
 * Curves over time or over another quantity, with a legend above that reads the values under the pointer, or at the
 * moment shown; dragging moves the time. Dragging along the horizontal axis, or with Shift, shows that part of the
 * abscissa: of time in all plots that share a `Zoom`, of another quantity in this one.
 */
export class Plot {
  readonly element: HTMLElement
  readonly area = el('div', { class: 'area' })
  /** Overlay on the curves, if there is one. */
  overlay?: Overlay
  /** Contents of the plot. */
  content: Content = { title: '', unit: '', lines: [] }
  #title = el('h3')
  #legend = el('ul', { class: 'legend' })
  #caption = el('p', { class: 'caption' })
  #moment = el('li', { class: 'moment' })
  #marker = el('div', { class: 'now' })
  #pointer = el('div', { class: 'pointer', hidden: true })
  #uplot?: uPlot
  #readings: { curve: Curve; output: HTMLElement }[] = []
  #pointed?: number
  #band = el('div', { class: 'band', hidden: true })
  /** Start of a drag that selects the visible part, px. */
  #from?: number
  /** The left end of the curves on the screen, px; requested once where the pointer comes in. */
  #left?: number
  /** Visible part if the curves are over another quantity. */
  #own = new Zoom()
  #closer = el(
    'button',
    {
      type: 'button',
      class: 'icon',
      'data-testid': 'closer',
      title: 'Zoom in (+); drag along the axis, or with Shift, to select a range',
      'aria-label': 'zoom in',
      onclick: () => this.#scale(CLOSER),
    },
    svg('svg', { viewBox: '0 0 16 16', 'aria-hidden': 'true' }, svg('path', { d: GLASS })),
  )
  #whole = el(
    'button',
    {
      type: 'button',
      class: 'icon',
      'data-testid': 'whole',
      title: 'Reset zoom (0)',
      'aria-label': 'reset zoom',
      onclick: () => this.#see(undefined),
    },
    'whole',
  )
  /** Size of the area, px, from its observer. */
  #extent?: { width: number; height: number }

  constructor(
    private readonly state: State,
    testId: string,
    head: HTMLElement[] = [],
    private readonly time = new Zoom(),
  ) {
    const caption = el('figcaption', {}, this.#title, ...head)
    this.element = el(
      'figure',
      { class: 'plot', 'data-testid': testId },
      caption,
      el('div', { class: 'above' }, this.#legend, el('span', { class: 'zoom' }, this.#closer, this.#whole)),
      this.area,
      this.#caption,
    )
    new ResizeObserver(([{ contentRect }]) => {
      this.#extent = { width: Math.round(contentRect.width), height: Math.round(contentRect.height) }
      this.#uplot?.setSize(this.#size())
    }).observe(this.area)
    this.area.addEventListener('keydown', (event) => this.#key(event))
    state.onTime(() => this.#showTime())
    for (const zoom of [this.time, this.#own]) zoom.onChange(() => this.#zoomed())
  }

  /** The canvas of the curves, where there are any. */
  get canvas(): HTMLCanvasElement | undefined {
    return this.#uplot?.ctx.canvas
  }

  show(content: Content): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    if (content.over?.label !== this.content.over?.label) this.#own.show(undefined)
    this.content = { ...content, part: (content.over ? this.#own : this.time).part }
    this.#pointed = this.#left = this.#from = undefined
    this.#title.textContent = titled(content.title, content.message ? '' : content.unit)
    this.#caption.replaceChildren(...prose(content.caption ?? ''))
    this.area.replaceChildren()
    this.#readings = []
    const [first, last] = this.#all()
    this.#closer.hidden = content.message !== undefined || first === last
    this.#whole.hidden = this.content.part === undefined || this.#closer.hidden
    if (content.message) {
      for (const name of ['role', 'tabindex', 'aria-label']) this.area.removeAttribute(name)
      this.#legend.replaceChildren()
      this.area.append(el('p', { class: 'message' }, ...prose(content.message)))
      return
    }
    this.area.setAttribute('role', 'application')
    this.area.tabIndex = 0
    const axes = `${titled(content.title, content.unit)} over ${content.over?.label ?? 'time'}`
    this.area.setAttribute('aria-label', `${axes}: plus and minus zoom, 0 resets the zoom`)
    const entries = content.lines.map((line) => this.#entry(line))
    keepFocus(this.#legend, () => this.#legend.replaceChildren(this.#moment, ...entries))
    const all = content.over ? faceted(content.over.curve, content) : data(this.state, content)
    this.#uplot = new uPlot(this.#options(this.content), all, this.area)
    this.#uplot.over.append(this.#band, this.#marker, this.#pointer)
    this.#follow(this.#uplot)
    this.overlay?.onto(this.#uplot)
    this.#showTime()
  }

  /** Puts something over the curves, or takes it away. */
  lay(overlay: Overlay | undefined): void {
    this.overlay = overlay
    if (!this.#uplot) return
    overlay?.onto(this.#uplot)
    this.#uplot.setData(this.#uplot.data)
  }

  /** Takes no further part in the page. */
  remove(): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    this.element.remove()
  }

  #size(): { width: number; height: number } {
    if (document.documentElement.classList.contains('printing')) return PAPER
    const { width, height } = (this.#extent ??= { width: this.area.clientWidth, height: this.area.clientHeight })
    return { width: width || USUAL, height: Math.max(height, LEAST) }
  }

  #options(content: Content): uPlot.Options {
    const { units } = this.state.report
    const ink = css('--muted')
    const grid = { stroke: css('--rule'), width: 1 }
    const axis = {
      stroke: ink,
      grid,
      ticks: { ...grid, size: 4 },
      font: css('--plot-font'),
      labelFont: css('--plot-font'),
    }
    const values = (_: uPlot, splits: number[]) => splits.map((value) => number(value, 6))
    const { over, logarithmic } = content
    const across = (low: number | null, high: number | null) =>
      this.content.part ?? (over ? padded(low, high) : [low, high])
    // uPlot finds whole steps only, and over another quantity among all of them.
    const upright = (low: number | null, high: number | null) => {
      const [minimum, maximum] = (this.content.part && this.#ordinates()) ?? [low, high]
      if (logarithmic) return decades(minimum, maximum)
      const range = padded(...reaching(minimum, maximum, content))
      return this.overlay?.reach(...range) ?? range
    }
    const abscissa = over ? titled(over.label, over.unit) : titled('time', units.time)
    return {
      mode: over ? 2 : 1,
      hooks: {
        drawClear: [(u: uPlot) => drawWanted(u, content)],
        draw: [() => (this.#showTime(), this.overlay?.drawn())],
      },
      ...this.#size(),
      legend: { show: false },
      cursor: { show: false, drag: { x: false, y: false, setScale: false } },
      scales: {
        x: { time: false, range: (_, low, high) => [...across(low, high)] },
        y: { ...(logarithmic && LOGARITHMIC), range: (_, low, high) => upright(low, high) },
      },
      axes: [
        { ...axis, values, size: 30, label: abscissa, labelSize: 18, labelGap: 0, gap: 3 },
        {
          ...axis,
          values: logarithmic ? powers : values,
          size: AXIS,
          label: pretty(content.unit) || '1',
          labelSize: 18,
          gap: 4,
        },
      ],
      series: [{}, ...content.lines.map(over ? facets : series)],
    }
  }

  #entry(line: Line): HTMLElement {
    const output = el('output')
    this.#readings.push({ curve: line.curve, output })
    const kind = line.marks ? 'ring' : !line.dash ? '' : line.dash[0] < 3 ? 'dotted' : 'dashed'
    const swatch = el('span', { class: `swatch ${kind}`, style: `--swatch: ${line.color}` })
    const parts = [swatch, el('span', { class: 'label' }, line.label), output]
    const selected = line.pick && (line.width ?? 0) > 2
    return el(
      'li',
      {},
      line.pick
        ? el(
            'button',
            { type: 'button', name: line.label, onclick: line.pick, 'aria-pressed': String(!!selected) },
            ...parts,
          )
        : el('span', {}, ...parts),
    )
  }

  /** The pointer reads the curves; pressed, it moves the time, or selects the visible range. */
  #follow({ over, root }: uPlot): void {
    const axis = root.querySelector<HTMLElement>('.u-axis')!
    axis.classList.add('abscissa')
    for (const part of [over, axis]) {
      part.addEventListener('pointerenter', () => (this.#left = undefined))
      part.addEventListener('pointerdown', (event) => {
        part.setPointerCapture(event.pointerId)
        if (event.button !== 0) return
        if (part === axis || event.shiftKey) this.#from = this.#across(event)
        else this.#move(event)
      })
      part.addEventListener('pointermove', (event) => {
        if (this.#from !== undefined) this.#stretch(this.#across(event))
        else if (part === over) this.#move(event)
      })
      part.addEventListener('pointerup', (event) => this.#let(this.#across(event)))
      part.addEventListener('pointercancel', () => this.#let())
      part.addEventListener('dblclick', () => this.#see(undefined))
    }
    over.addEventListener('pointerleave', () => {
      this.#pointed = undefined
      this.#showTime()
    })
  }

  /** Horizontal position of the pointer, px from the left end of the curves. */
  #across({ clientX }: PointerEvent): number {
    return clientX - (this.#left ??= this.#uplot?.over.getBoundingClientRect().left ?? 0)
  }

  #move(event: PointerEvent): void {
    if (!this.#uplot) return
    const x = this.#uplot.posToVal(this.#across(event), 'x')
    const { over } = this.content
    const { times } = this.state.report
    const step = over ? nearestStep(over.curve, x, this.state.step) : stepAt(times, x)
    this.#pointed = event.buttons === 1 ? undefined : step
    if (event.buttons === 1) {
      this.state.pause()
      this.state.goToStep(step)
    } else this.#showTime()
  }

  /** Shows the range that releasing the pointer selects. */
  #stretch(to: number): void {
    const [left, right] = between(this.#from!, to)
    this.#band.hidden = right - left < CLICK
    Object.assign(this.#band.style, { left: `${left}px`, width: `${right - left}px` })
  }

  #let(to?: number): void {
    const from = this.#from
    this.#from = undefined
    this.#band.hidden = true
    if (from === undefined || to === undefined || Math.abs(to - from) < CLICK) return
    const value = (at: number) => this.#uplot!.posToVal(at, 'x')
    this.#see(between(value(from), value(to)))
  }

  #key(event: KeyboardEvent): void {
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : this.#action(event)
    if (!action || !this.#uplot) return
    event.preventDefault()
    action()
  }

  #action({ key, shiftKey }: KeyboardEvent): (() => void) | undefined {
    if (key === '+' || key === '=') return () => this.#scale(CLOSER)
    if (key === '-' || key === '_') return () => this.#scale(1 / CLOSER)
    if (key === '0') return () => this.#see(undefined)
    const share = { ArrowLeft: -ASIDE, ArrowRight: ASIDE }[key]
    return shiftKey && share ? () => this.content.part && this.#see(moved(this.content.part, share)) : undefined
  }

  /** Scales the visible range of the abscissa, about the moment shown where it is visible. */
  #scale(factor: number): void {
    const part = this.content.part ?? this.#all()
    const [low, high] = part
    const now = valueAt(this.content.over?.curve ?? this.state.report.times, this.state.step)
    this.#see(scaled(part, factor, low <= now && now <= high ? now : (low + high) / 2))
  }

  /** The whole abscissa. */
  #all(): Part {
    const { over } = this.content
    const [low, high] = extent([over?.curve ?? this.state.report.times]) ?? [0, 0]
    return over ? padded(low, high) : [low, high]
  }

  #see(part: Part | undefined): void {
    const whole = this.#all()
    const zoom = this.content.over ? this.#own : this.time
    zoom.show(part && within(atLeast(part, whole), whole))
  }

  #zoomed(): void {
    if (!this.#uplot) return
    this.content.part = (this.content.over ? this.#own : this.time).part
    // A button that goes takes the focus with it.
    if (document.activeElement === this.#whole) this.#closer.focus()
    this.#whole.hidden = this.content.part === undefined
    this.#uplot.setData(this.#uplot.data)
  }

  #ordinates(): [number, number] | undefined {
    const { lines, over, part, logarithmic } = this.content
    return ordinates(
      lines.map(({ curve, marks }) => marks ?? curve),
      over?.curve ?? this.state.report.times,
      part,
      logarithmic,
    )
  }

  #showTime(): void {
    if (!this.#uplot) return
    const { over, unit } = this.content
    const at = (step: number) => (over ? valueAt(over.curve, step) : valueAt(this.state.report.times, step))
    const [low, high] = this.content.part ?? [-Infinity, Infinity]
    const place = (element: HTMLElement, step: number | undefined) => {
      const x = step === undefined ? NaN : at(step)
      element.hidden = !(low <= x && x <= high)
      if (!element.hidden) element.style.left = `${this.#uplot!.valToPos(x, 'x')}px`
    }
    place(this.#marker, this.state.step)
    place(this.#pointer, this.#pointed)
    const step = this.#pointed ?? this.state.step
    this.#moment.textContent = over
      ? `${over.label} ${figure4(at(step), over.unit)}`
      : figure4(at(step), this.state.report.units.time)
    this.#moment.classList.toggle('pointed', this.#pointed !== undefined)
    for (const { curve, output } of this.#readings) output.textContent = figure4(valueAt(curve, step), unit)
  }
}

/** Four digits with the unit. */
function figure4(value: number, unit: string): string {
  return `${number(value, 4)} ${pretty(unit)}`.trimEnd()
}

/** The range of an axis, extended to the targets. */
function reaching(low: number | null, high: number | null, { wanted = [] }: Content): [number | null, number | null] {
  if (low === null || high === null) return [low, high]
  const ends = wanted.flatMap((band) => [band.low, band.high]).filter((end) => end !== null)
  // A target far away must not flatten the curve.
  const room = 2 * (high - low)
  const near = ends.filter((end) => end > low - room && end < high + room)
  return [Math.min(low, ...near), Math.max(high, ...near)]
}

/** Width of a target at one abscissa, px. */
const GATE = 10

/** Bands of targets, behind the curves. */
function drawWanted(u: uPlot, { wanted = [] }: Content): void {
  const { ctx, bbox } = u
  ctx.save()
  ctx.beginPath()
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height)
  ctx.clip()
  ctx.fillStyle = css('--good')
  for (const { low, high, at } of wanted) {
    const top = high === null ? bbox.top : u.valToPos(high, 'y', true)
    const bottom = low === null ? bbox.top + bbox.height : u.valToPos(low, 'y', true)
    const half = (GATE / 2) * devicePixelRatio
    const [left, width] = at === undefined ? [bbox.left, bbox.width] : [u.valToPos(at, 'x', true) - half, 2 * half]
    ctx.globalAlpha = at === undefined ? 0.12 : 0.35
    ctx.fillRect(left, top, width, Math.max(bottom - top, 2))
  }
  ctx.restore()
}

function series(line: Line): uPlot.Series {
  const width = line.width ?? 1.8
  if (!line.marks) return { stroke: line.color, width, dash: line.dash, points: { show: false } }
  return {
    stroke: line.color,
    paths: () => null,
    points: { show: true, size: 7, width: 1.5, stroke: line.color, fill: css('--page') },
  }
}

function data(state: State, { lines, logarithmic }: Content): uPlot.AlignedData {
  const values = ({ marks, curve }: Line) => marks ?? (logarithmic ? positive(curve) : withGaps(curve))
  return [Array.from(state.report.times), ...lines.map(values)]
}

/** A line over an abscissa that may go back and forth. */
function facets(line: Line): uPlot.Series {
  const auto = ['x', 'y'].map((scale) => ({ scale, auto: true }))
  const marks = line.marks !== undefined
  const paths: uPlot.Series.PathBuilder = (u, index) => {
    const [xs, ys] = u.data[index] as unknown as [Curve, (number | null)[]]
    const path = new Path2D()
    let drawing = false
    for (let k = 0; k < xs.length; k++) {
      const y = ys[k]
      if (y === null || Number.isNaN(xs[k])) {
        drawing = false
        continue
      }
      const [left, top] = [u.valToPos(xs[k], 'x', true), u.valToPos(y, 'y', true)]
      if (marks) path.moveTo(left + RADIUS, top), path.arc(left, top, RADIUS, 0, 2 * Math.PI)
      else if (drawing) path.lineTo(left, top)
      else path.moveTo(left, top)
      drawing = true
    }
    return { stroke: path }
  }
  return {
    stroke: line.color,
    width: marks ? 1.5 : (line.width ?? 1.8),
    dash: line.dash,
    paths,
    facets: auto,
    points: { show: false },
  }
}

/** Radius of the circles over another quantity than time, px. */
const RADIUS = 3.5

function faceted(over: Curve, { lines }: Content): uPlot.AlignedData {
  const pair = ({ marks, curve }: Line) => [over, marks ?? withGaps(curve)]
  return [null, ...lines.map(pair)] as unknown as uPlot.AlignedData
}

const LOGARITHMIC: uPlot.Scale = { distr: 3, log: 10 }

function powers(_: uPlot, splits: number[]): string[] {
  const many = splits.filter(isPower).length > MOST_POWERS
  return splits.map((value) => (isPower(value) && !(many && Math.round(Math.log10(value)) % 2) ? number(value) : ''))
}

function isPower(value: number): boolean {
  const power = Math.log10(value)
  return Math.abs(power - Math.round(power)) < 1e-9
}
