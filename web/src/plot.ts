import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { css, el, keepFocus, prose } from './dom'
import { number, pretty, titled } from './format'
import { decades, nearestStep, padded, positive, stepAt, valueAt, type Curve, withGaps } from './curve'
import type { State } from './state'

/** What a plot is at least high, and on paper wide and high, px. */
const LEAST = 120
const PAPER = { width: 330, height: 190 }
/** Wide enough for `−1.234e-5`, and the same for all plots, so that their time axes line up. */
const AXIS = 66
/** With more powers of ten than this along an axis, every other one has a number. */
const MOST_POWERS = 6

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
  /** From a power of ten to another; what is not positive is left out. */
  logarithmic?: boolean
  /** What the curves are drawn over instead of time. */
  over?: { label: string; unit: string; curve: Curve }
  caption?: string
  /** What is wanted of the values: at one abscissa, or everywhere. */
  wanted?: { low: number | null; high: number | null; at?: number }[]
  /** Shown in place of the plot. */
  message?: string
}

/**
 * Curves over time or over another quantity, with a legend above that reads the values under the pointer, or at the moment shown;
 * dragging moves the time.
 */
export class Plot {
  readonly element: HTMLElement
  readonly area = el('div', { class: 'area' })
  /** What is shown. */
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

  constructor(
    private readonly state: State,
    testId: string,
    head: HTMLElement[] = [],
  ) {
    const caption = el('figcaption', {}, this.#title, ...head)
    this.element = el('figure', { class: 'plot', 'data-testid': testId }, caption, this.#legend, this.area, this.#caption)
    new ResizeObserver(() => this.#uplot?.setSize(this.#size())).observe(this.area)
    state.onTime(() => this.#showTime())
  }

  /** The canvas of the curves, where there are any. */
  get canvas(): HTMLCanvasElement | undefined {
    return this.#uplot?.ctx.canvas
  }

  show(content: Content): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    this.content = content
    this.#pointed = undefined
    this.#title.textContent = titled(content.title, content.message ? '' : content.unit)
    this.#caption.replaceChildren(...prose(content.caption ?? ''))
    this.area.replaceChildren()
    this.area.setAttribute('role', 'img')
    this.area.setAttribute('aria-label', content.message ?? `${titled(content.title, content.unit)} over ${content.over?.label ?? 'time'}`)
    this.#readings = []
    if (content.message) {
      this.#legend.replaceChildren()
      this.area.append(el('p', { class: 'message' }, ...prose(content.message)))
      return
    }
    const entries = content.lines.map((line) => this.#entry(line))
    keepFocus(this.#legend, () => this.#legend.replaceChildren(this.#moment, ...entries))
    const all = content.over ? faceted(content.over.curve, content) : data(this.state, content)
    this.#uplot = new uPlot(this.#options(content), all, this.area)
    this.#uplot.over.append(this.#marker, this.#pointer)
    this.#follow(this.#uplot)
    this.#showTime()
  }

  /** Takes no further part in the page. */
  remove(): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    this.element.remove()
  }

  #size(): { width: number; height: number } {
    if (document.documentElement.classList.contains('printing')) return PAPER
    const { clientWidth, clientHeight } = this.area
    return { width: clientWidth || 400, height: Math.max(clientHeight, LEAST) }
  }

  #options(content: Content): uPlot.Options {
    const { units } = this.state.report
    const ink = css('--muted')
    const grid = { stroke: css('--rule'), width: 1 }
    const axis = { stroke: ink, grid, ticks: { ...grid, size: 4 }, font: css('--plot-font'), labelFont: css('--plot-font') }
    const values = (_: uPlot, splits: number[]) => splits.map((value) => number(value, 6))
    const { over } = content
    const abscissa = over ? titled(over.label, over.unit) : titled('time', units.time)
    return {
      mode: over ? 2 : 1,
      hooks: { drawClear: [(u: uPlot) => drawWanted(u, content)], draw: [() => this.#showTime()] },
      ...this.#size(),
      legend: { show: false },
      cursor: { show: false, drag: { x: false, y: false, setScale: false } },
      scales: { x: { time: false, ...(over && { range: (_: uPlot, low: number, high: number) => padded(low, high) }) }, y: content.logarithmic ? DECADES : { range: (_, low, high) => padded(...reaching(low, high, content)) } },
      axes: [
        { ...axis, values, size: 30, label: abscissa, labelSize: 18, labelGap: 0, gap: 3 },
        {
          ...axis,
          values: content.logarithmic ? powers : values,
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
    return el('li', {}, line.pick
      ? el('button', { type: 'button', name: line.label, onclick: line.pick, 'aria-pressed': String(!!selected) }, ...parts)
      : el('span', {}, ...parts))
  }

  /** The pointer reads the curves; pressed, it moves the time. */
  #follow({ over }: uPlot): void {
    over.addEventListener('pointerdown', (event) => {
      over.setPointerCapture(event.pointerId)
      this.#move(event)
    })
    over.addEventListener('pointermove', (event) => this.#move(event))
    over.addEventListener('pointerleave', () => {
      this.#pointed = undefined
      this.#showTime()
    })
  }

  #move(event: PointerEvent): void {
    if (!this.#uplot) return
    const x = this.#uplot.posToVal(event.clientX - this.#uplot.over.getBoundingClientRect().left, 'x')
    const { over } = this.content
    const { times } = this.state.report
    const step = over ? nearestStep(over.curve, x, this.state.step) : stepAt(times, x)
    this.#pointed = event.buttons === 1 ? undefined : step
    if (event.buttons === 1) {
      this.state.pause()
      this.state.goToStep(step)
    } else this.#showTime()
  }

  #showTime(): void {
    if (!this.#uplot) return
    const { over, unit } = this.content
    const at = (step: number) => (over ? valueAt(over.curve, step) : valueAt(this.state.report.times, step))
    const place = (element: HTMLElement, step: number) => (element.style.left = `${this.#uplot!.valToPos(at(step), 'x')}px`)
    place(this.#marker, this.state.step)
    this.#pointer.hidden = this.#pointed === undefined
    if (this.#pointed !== undefined) place(this.#pointer, this.#pointed)
    const step = this.#pointed ?? this.state.step
    this.#moment.textContent = over ? `${over.label} ${figure4(at(step), over.unit)}` : figure4(at(step), this.state.report.units.time)
    this.#moment.classList.toggle('pointed', this.#pointed !== undefined)
    for (const { curve, output } of this.#readings) output.textContent = figure4(valueAt(curve, step), unit)
  }
}

/** Four digits with the unit. */
function figure4(value: number, unit: string): string {
  return `${number(value, 4)} ${pretty(unit)}`.trimEnd()
}

/** The part of an axis' range that what is wanted makes larger. */
function reaching(low: number | null, high: number | null, { wanted = [] }: Content): [number | null, number | null] {
  if (low === null || high === null) return [low, high]
  const ends = wanted.flatMap((band) => [band.low, band.high]).filter((end) => end !== null)
  // A target far away must not flatten the curve.
  const room = 2 * (high - low)
  const near = ends.filter((end) => end > low - room && end < high + room)
  return [Math.min(low, ...near), Math.max(high, ...near)]
}

/** Width of what is wanted at one abscissa, px. */
const GATE = 10

/** Bands of what is wanted, behind the curves. */
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
  return { stroke: line.color, width: marks ? 1.5 : (line.width ?? 1.8), dash: line.dash, paths, facets: auto, points: { show: false } }
}

/** Of the circles over another quantity than time, px. */
const RADIUS = 3.5

function faceted(over: Curve, { lines }: Content): uPlot.AlignedData {
  const pair = ({ marks, curve }: Line) => [over, marks ?? withGaps(curve)]
  return [null, ...lines.map(pair)] as unknown as uPlot.AlignedData
}

/** Whole powers of ten around the values. */
const DECADES: uPlot.Scale = { distr: 3, log: 10, range: (_, low, high) => decades(low, high) }

function powers(_: uPlot, splits: number[]): string[] {
  const many = splits.filter(isPower).length > MOST_POWERS
  return splits.map((value) => (isPower(value) && !(many && Math.round(Math.log10(value)) % 2) ? number(value) : ''))
}

function isPower(value: number): boolean {
  const power = Math.log10(value)
  return Math.abs(power - Math.round(power)) < 1e-9
}
