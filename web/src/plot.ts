import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { css, el, keepFocus, prose } from './dom'
import { number, pretty, titled } from './format'
import { decades, nearestStep, padded, positive, valueAt, type Curve, withGaps } from './curve'
import type { State } from './state'

const HEIGHT = 190
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
  /** Shown in place of the plot. */
  message?: string
}

/** Curves over time or over another quantity, with a legend that reads the values at the moment shown; dragging moves the time. */
export class Plot {
  readonly element: HTMLElement
  #title = el('h3')
  #area = el('div', { class: 'area' })
  #legend = el('ul', { class: 'legend' })
  #caption = el('p', { class: 'caption' })
  #marker = el('div', { class: 'now' })
  #uplot?: uPlot
  #readings: { curve: Curve; output: HTMLElement }[] = []
  #over?: Curve

  constructor(
    private readonly state: State,
    testId: string,
    ...extras: HTMLElement[]
  ) {
    const head = el('figcaption', {}, this.#title, ...extras)
    this.element = el('figure', { class: 'plot', 'data-testid': testId }, head, this.#area, this.#legend, this.#caption)
    new ResizeObserver(() => this.#uplot?.setSize({ width: this.#area.clientWidth, height: HEIGHT })).observe(this.#area)
    state.onTime(() => this.#showTime())
  }

  show(content: Content): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    this.#title.textContent = titled(content.title, content.message ? '' : content.unit)
    this.#caption.replaceChildren(...prose(content.caption ?? ''))
    this.#area.replaceChildren()
    this.#area.setAttribute('role', 'img')
    this.#area.setAttribute('aria-label', content.message ?? `${titled(content.title, content.unit)} over ${content.over?.label ?? 'time'}`)
    this.#readings = []
    this.#over = content.over?.curve
    if (content.message) {
      this.#legend.replaceChildren()
      this.#area.append(el('p', { class: 'message' }, ...prose(content.message)))
      return
    }
    keepFocus(this.#legend, () => this.#legend.replaceChildren(...content.lines.map((line) => this.#entry(line))))
    const all = content.over ? faceted(content.over.curve, content) : data(this.state, content)
    this.#uplot = new uPlot(this.#options(content), all, this.#area)
    this.#uplot.over.append(this.#marker)
    this.#scrub(this.#uplot)
    this.#showTime()
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
      hooks: { draw: [() => this.#showTime()] },
      width: this.#area.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: {
        drag: { x: false, y: false, setScale: false },
        ...(over ? { show: false } : { sync: { key: 'time' } }),
        points: { size: 6 },
      },
      scales: { x: { time: false, ...(over && { range: (_: uPlot, low: number, high: number) => padded(low, high) }) }, y: content.logarithmic ? DECADES : { range: (_, low, high) => padded(low, high) } },
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
    const swatch = el('span', { class: line.marks ? 'swatch ring' : 'swatch', style: `--swatch: ${line.color}` })
    const parts = [swatch, el('span', { class: 'label' }, line.label), output]
    const selected = line.pick && (line.width ?? 0) > 2
    return el('li', {}, line.pick
      ? el('button', { type: 'button', name: line.label, onclick: line.pick, 'aria-pressed': String(!!selected) }, ...parts)
      : el('span', {}, ...parts))
  }

  #scrub(uplot: uPlot): void {
    const move = (event: PointerEvent) => {
      if (event.buttons !== 1) return
      this.state.pause()
      const x = uplot.posToVal(event.clientX - uplot.over.getBoundingClientRect().left, 'x')
      if (this.#over) this.state.goToStep(nearestStep(this.#over, x, this.state.step))
      else this.state.goToTime(x)
    }
    uplot.over.addEventListener('pointerdown', (event) => {
      uplot.over.setPointerCapture(event.pointerId)
      move(event)
    })
    uplot.over.addEventListener('pointermove', move)
  }

  #showTime(): void {
    if (!this.#uplot) return
    const now = this.#over ? valueAt(this.#over, this.state.step) : this.state.time
    this.#marker.style.left = `${this.#uplot.valToPos(now, 'x')}px`
    for (const { curve, output } of this.#readings) {
      output.textContent = number(valueAt(curve, this.state.step), 4)
    }
  }
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
