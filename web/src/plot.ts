import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { css, el, keepFocus, prose, setProse, setText, svg } from './dom'
import { number, pretty, titled } from './format'
import { abscissaOf, type Content, drawnLines, drawnRange, drawnSteps, type Line } from './content'
import { decades, nearestStep, padded, positive, stepAt, valueAt, type Curve, withGaps } from './curve'
import { extent, FEWEST_TICKS, ticks, widened } from './export/axis'
import type { State } from './state'
import { atLeast, between, moved, type Part, scaled, within, Zoom } from './zoom'

/** Default width of a plot, minimum height, and size on paper, px. */
const USUAL = 400
const LEAST = 180
const PAPER = { width: 330, height: 190 }
/** Wide enough for `−1.234e-5`, and the same for all plots, so that their time axes line up. */
const AXIS = 66
/** Room below the curves for the numbers and the label of the abscissa, px. */
const ABSCISSA = 48
/** With more powers of ten than this along an axis, every other one has a number. */
const MOST_POWERS = 6
/** Distance of the numbers along an ordinate, px. */
const TICK = 34

/** A magnifying glass with a plus; arrows to the corners. */
const GLASS = 'M6.5 2a4.5 4.5 0 1 0 0 9a4.5 4.5 0 1 0 0 -9M10 10l4 4M4.5 6.5h4M6.5 4.5v4'
const CORNERS = 'M9.5 2.5h4v4M13.5 2.5l-4.5 4.5M6.5 13.5h-4v-4M2.5 13.5l4.5 -4.5'
/** A press that moves by less than this is a click, px. */
const CLICK = 4
/** Factor of a zoom step, and step of a shift as a fraction of the visible range. */
const CLOSER = 0.5
const ASIDE = 0.25
/** Length of a line's sample in the legend, px. */
const SAMPLE = 24

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
 * moment shown; dragging moves the time. Dragging along an axis, or with Shift, shows that part of it: of time in all
 * plots that share a `Zoom`, of another quantity or of the ordinate in this one. A double click maximises the plot.
 */
export class Plot {
  readonly element: HTMLElement
  readonly area = el('div', { class: 'area' })
  /** Overlay on the curves, if there is one. */
  overlay?: Overlay
  #content: Content = { title: '', unit: '', lines: [] }
  /** Contents that are not made yet, because nobody sees them. */
  #next?: () => Content
  #title = el('h3')
  #legend = el('ul', { class: 'legend' })
  #caption = el('p', { class: 'caption' })
  #moment = el('p', { class: 'moment' })
  #marker = el('div', { class: 'now' })
  #pointer = el('div', { class: 'pointer', hidden: true })
  #uplot?: uPlot
  /** Keys of the drawn axes and series, and of the legend: what is the same stays. */
  #drawn = ''
  #listed = ''
  /** Styles of the lines, and all but their numbers that a picture of them depends on. */
  #look = ''
  #readings: { line: Line; output: HTMLElement }[] = []
  #band = el('div', { class: 'band', hidden: true })
  /** Start of a drag that selects the visible part: the axis, and the position along it, px. */
  #from?: { upright: boolean; at: number }
  /** Corner of the curves on the screen, px; requested once where the pointer comes in. */
  #corner?: { left: number; top: number }
  /** Visible part if the curves are over another quantity, and of the ordinate. */
  #own = new Zoom()
  #upright = new Zoom()
  /** False while the plot is scrolled out of sight: it is drawn when it comes back. */
  #seen = true
  #stale = false
  #closer = button('closer', 'Zoom in (+); drag along an axis, or with Shift, to select a range', GLASS, () =>
    this.#scale(CLOSER),
  )
  #whole = el(
    'button',
    {
      type: 'button',
      class: 'icon',
      'data-testid': 'whole',
      title: 'Reset zoom (0)',
      'aria-label': 'reset zoom',
      onclick: () => this.#reset(),
    },
    'whole',
  )
  #large = button('maximise', 'Maximise (double click, Enter); Escape restores', CORNERS, () => this.maximise())
  #range?: { x: Part; y: Part }
  /** Size of the area, px, from its observer. */
  #extent?: { width: number; height: number }

  /** `head` goes next to the title, `tools` next to the zoom. */
  constructor(
    private readonly state: State,
    testId: string,
    head: HTMLElement[] = [],
    private readonly time = new Zoom(),
    tools: HTMLElement[] = [],
  ) {
    const caption = el('figcaption', {}, this.#title, ...head)
    this.#large.setAttribute('aria-pressed', 'false')
    this.element = el(
      'figure',
      { class: 'plot', 'data-testid': testId },
      caption,
      el(
        'div',
        { class: 'above' },
        this.#moment,
        el('span', { class: 'zoom' }, this.#whole, ...tools, this.#closer, this.#large),
      ),
      this.#legend,
      this.area,
      this.#caption,
    )
    new ResizeObserver(([{ contentRect }]) => {
      this.#extent = { width: Math.round(contentRect.width), height: Math.round(contentRect.height) }
      this.#range = undefined
      this.#uplot?.setSize(this.#size())
    }).observe(this.area)
    new IntersectionObserver((all) => {
      this.#seen = all.at(-1)!.isIntersecting
      if (this.#seen && this.#stale) this.#render()
    }).observe(this.element)
    this.element.addEventListener('keydown', (event) => this.#key(event))
    state.onTime(() => this.#showTime())
    state.onHover(() => this.#showTime())
    for (const zoom of [this.time, this.#own, this.#upright]) zoom.onChange(() => this.#zoomed())
  }

  /** The canvas of the curves, where there are any. */
  get canvas(): HTMLCanvasElement | undefined {
    if (this.#stale) this.#render()
    return this.#uplot?.ctx.canvas
  }

  /** Visible parts of abscissa and ordinate, to be shown again later. */
  get parts(): { across?: Part; upright?: Part } {
    return { across: this.#own.part, upright: this.#upright.part }
  }

  set parts({ across, upright }: { across?: Part; upright?: Part }) {
    this.#own.show(across)
    this.#upright.show(upright)
  }

  /** Contents of the plot. */
  get content(): Content {
    const make = this.#next
    this.#next = undefined
    if (make) this.#take(make())
    return this.#content
  }

  /** Shows contents, which are made and drawn as soon as the plot is seen. */
  show(make: () => Content): void {
    this.#next = make
    this.#stale = true
    if (this.#seen || document.documentElement.classList.contains('printing')) this.#render()
  }

  #take(content: Content): void {
    const { title, over, unit } = this.#content
    if (title !== '') {
      if (content.over?.label !== over?.label) this.#own.show(undefined)
      if (content.unit !== unit) this.#upright.show(undefined)
    }
    const { part } = content.over ? this.#own : this.time
    this.#content = { ...content, part, upright: this.#upright.part }
  }

  #render(): void {
    const { content } = this
    this.#stale = false
    this.#range = undefined
    setText(this.#title, titled(content.title, content.message ? '' : content.unit))
    setProse(this.#caption, content.caption ?? '')
    const [first, last] = this.#all()
    this.#closer.hidden = this.#large.hidden = content.message !== undefined || first === last
    this.#whole.hidden = (content.part ?? content.upright) === undefined || this.#closer.hidden
    if (content.message) return this.#showMessage(content.message)
    this.area.setAttribute('role', 'application')
    this.area.tabIndex = 0
    const axes = `${titled(content.title, content.unit)} over ${content.over?.label ?? 'time'}`
    this.area.setAttribute('aria-label', `${axes}: plus and minus zoom, 0 resets the zoom, Enter maximises`)
    this.#list(content.lines)
    const lines = drawnLines(content)
    const { unit, over, logarithmic } = content
    const shapes = lines.map(({ marks }) => marks !== undefined)
    const key = JSON.stringify([unit, over?.label, over?.unit, logarithmic, shapes, css('--muted'), css('--rule')])
    const values = this.#data(lines)
    const { wanted, contacts, equal, part, upright } = content
    const styles = lines.map(({ color, width, dash, marks }) => ({
      color,
      width: marks ? MARK : (width ?? USUAL_LINE),
      dash,
    }))
    const look = JSON.stringify([styles, wanted, contacts, equal, part, upright])
    if (this.#uplot && key === this.#drawn) {
      const isSame = look === this.#look && !this.overlay && isSameData(this.#uplot.data, values)
      this.#look = look
      // Sensitivities, for one, are those of the last design until the hand lets go.
      if (isSame) return this.#showTime()
      styles.forEach(({ width, dash }, k) => Object.assign(this.#uplot!.series[k + 1], { width, dash }))
      this.#uplot.setData(values)
      return
    }
    this.#drawn = key
    this.#look = look
    this.#uplot?.destroy()
    this.#corner = this.#from = undefined
    this.area.replaceChildren()
    this.#uplot = new uPlot(this.#options(lines), values, this.area)
    this.#uplot.over.append(this.#band, this.#marker, this.#pointer)
    this.#follow(this.#uplot)
    this.overlay?.onto(this.#uplot)
    this.#showTime()
  }

  #showMessage(message: string): void {
    this.#uplot?.destroy()
    this.#uplot = undefined
    this.#drawn = this.#listed = ''
    for (const name of ['role', 'tabindex', 'aria-label']) this.area.removeAttribute(name)
    this.#legend.replaceChildren()
    setText(this.#moment, '')
    this.#readings = []
    this.area.replaceChildren(el('p', { class: 'message' }, ...prose(message)))
  }

  /** Entries of the legend, made anew if they differ in more than their readings. */
  #list(lines: Line[]): void {
    const key = JSON.stringify(
      lines.map(({ label, color, width, dash, hidden, marks, about, pick }) => {
        return [label, color, width, dash, hidden, marks !== undefined, about, pick !== undefined]
      }),
    )
    if (key !== this.#listed) {
      this.#listed = key
      this.#readings = []
      const entries = lines.map((line, k) => this.#entry(line, k))
      keepFocus(this.#legend, () => this.#legend.replaceChildren(...entries))
    } else this.#readings.forEach((reading, k) => (reading.line = lines[k]))
  }

  #data(lines: Line[]): uPlot.AlignedData {
    const { content } = this
    const values = ({ marks, curve }: Line) => marks ?? (content.logarithmic ? positive(curve) : withGaps(curve))
    const { times } = this.state.report
    const pairs = lines.map((line) => {
      const [first, last] = drawnSteps(line, content, times)
      return [abscissaOf(line, content, times), values(line)].map((all) => all.slice(first, last + 1))
    })
    return [null, ...pairs] as unknown as uPlot.AlignedData
  }

  /** Puts something over the curves, or takes it away. */
  lay(overlay: Overlay | undefined): void {
    this.overlay = overlay
    if (!this.#uplot) return
    overlay?.onto(this.#uplot)
    this.rescale()
  }

  /** Draws with new ranges of the axes. */
  rescale(): void {
    this.#range = undefined
    this.#uplot?.setData(this.#uplot.data)
  }

  /** Fills the page with the plot, or returns it to its place. */
  maximise(wanted = !this.element.classList.contains('maximised')): void {
    if (wanted === this.element.classList.contains('maximised')) return
    this.element.classList.toggle('maximised', wanted)
    this.#large.setAttribute('aria-pressed', String(wanted))
    this.area.focus({ preventScroll: true })
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

  #options(lines: Line[]): uPlot.Options {
    const { units } = this.state.report
    const { over, logarithmic, unit } = this.content
    const grid = { stroke: css('--rule'), width: 1 }
    const axis = {
      stroke: css('--muted'),
      grid,
      ticks: { ...grid, size: 4 },
      font: css('--plot-font'),
      labelFont: css('--plot-font'),
    }
    const values = (_: uPlot, splits: number[]) => splits.map((value) => number(value, 6))
    const splits = (u: uPlot, _: number, low: number, high: number) => {
      const count = Math.max(FEWEST_TICKS, Math.floor(u.bbox.height / devicePixelRatio / TICK))
      return ticks([low, high], count)
    }
    const abscissa = over ? titled(over.label, over.unit) : titled('time', units.time)
    return {
      mode: 2,
      pxAlign: 0,
      hooks: {
        drawClear: [(u: uPlot) => (drawWanted(u, this.content), drawContacts(u, this.content))],
        draw: [() => (this.#showTime(), this.overlay?.drawn())],
      },
      ...this.#size(),
      legend: { show: false },
      cursor: { show: false, drag: { x: false, y: false, setScale: false } },
      scales: {
        x: { time: false, range: () => [...this.#ranges().x] },
        y: { ...(logarithmic && LOGARITHMIC), range: () => [...this.#ranges().y] },
      },
      axes: [
        { ...axis, values, size: 30, label: abscissa, labelSize: 18, labelGap: 0, gap: 3 },
        {
          ...axis,
          ...(logarithmic ? { values: powers } : { values, splits }),
          size: AXIS,
          label: pretty(unit) || '–',
          labelSize: 18,
          gap: 4,
        },
      ],
      series: [
        {},
        ...lines.map((line, k) => facets(line, () => this.#lineAt(k)?.color ?? line.color)),
      ] as uPlot.Series[],
    }
  }

  /** Line number `k` of those drawn. */
  #lineAt(k: number): Line | undefined {
    return drawnLines(this.content)[k]
  }

  /** Ranges of both axes, found once for what is drawn. */
  #ranges(): { x: Part; y: Part } {
    return (this.#range ??= this.#findRanges())
  }

  #findRanges(): { x: Part; y: Part } {
    const { part, upright, logarithmic, equal } = this.content
    const x = part ?? widened(this.#all())
    const [low, high] = drawnRange(this.content, this.state.report.times) ?? [null, null]
    if (logarithmic) return { x, y: upright ?? decades(low, high) }
    const usual = padded(...reaching(low, high, this.content))
    const y = upright ?? this.overlay?.reach(...usual) ?? usual
    if (!equal || part || upright || this.overlay) return { x, y }
    const { width, height } = this.#size()
    const [across, up] = [width - AXIS, height - ABSCISSA]
    const perPixel = Math.max((x[1] - x[0]) / across, (y[1] - y[0]) / up)
    const about = ([low, high]: Part, size: number): Part => {
      const middle = (low + high) / 2
      return [middle - (perPixel * size) / 2, middle + (perPixel * size) / 2]
    }
    return { x: about(x, across), y: about(y, up) }
  }

  #entry(line: Line, index: number): HTMLElement {
    const output = el('output')
    this.#readings.push({ line, output })
    const parts = [sample(line), el('span', { class: 'label' }, line.label), output]
    const selected = (line.width ?? 0) > 2
    const title = [line.label, line.about].filter(Boolean).join(': ')
    return el(
      'li',
      { class: line.hidden ? 'off' : undefined, title },
      line.pick
        ? el(
            'button',
            {
              type: 'button',
              name: line.label,
              onclick: () => this.content.lines[index]?.pick?.(),
              'aria-pressed': String(line.hidden === undefined ? selected : !line.hidden),
            },
            ...parts,
          )
        : el('span', {}, ...parts),
    )
  }

  /** The pointer reads the curves; pressed, it moves the time, or selects the visible range. */
  #follow({ over, root }: uPlot): void {
    const [abscissa, ordinate] = root.querySelectorAll<HTMLElement>('.u-axis')
    abscissa.classList.add('abscissa')
    ordinate.classList.add('ordinate')
    for (const part of [over, abscissa, ordinate]) {
      part.addEventListener('pointerenter', () => (this.#corner = undefined))
      part.addEventListener('pointerdown', (event) => {
        part.setPointerCapture(event.pointerId)
        if (event.button !== 0) return
        const upright = part === ordinate
        if (part !== over || event.shiftKey) this.#from = { upright, at: this.#at(event)[upright ? 'top' : 'left'] }
        else this.#move(event)
      })
      part.addEventListener('pointermove', (event) => {
        if (this.#from !== undefined) this.#stretch(this.#at(event))
        else if (part === over) this.#move(event)
      })
      part.addEventListener('pointerup', (event) => this.#let(this.#at(event)))
      part.addEventListener('pointercancel', () => this.#let())
    }
    over.addEventListener('dblclick', () => this.maximise())
    abscissa.addEventListener('dblclick', () => this.#see(undefined))
    ordinate.addEventListener('dblclick', () => this.#upright.show(undefined))
    ordinate.addEventListener('wheel', (event) => {
      event.preventDefault()
      this.#scaleUpright(
        event.deltaY < 0 ? CLOSER ** 0.5 : CLOSER ** -0.5,
        this.#uplot!.posToVal(this.#at(event).top, 'y'),
      )
    })
    over.addEventListener('pointerleave', () => this.state.hover(undefined))
  }

  /** Position of the pointer, px from the corner of the curves. */
  #at({ clientX, clientY }: MouseEvent): { left: number; top: number } {
    const { left, top } = (this.#corner ??= this.#uplot?.over.getBoundingClientRect() ?? { left: 0, top: 0 })
    return { left: clientX - left, top: clientY - top }
  }

  #move(event: PointerEvent): void {
    if (!this.#uplot) return
    const { left, top } = this.#at(event)
    const { over, equal, lines } = this.content
    const { times } = this.state.report
    const x = this.#uplot.posToVal(left, 'x')
    const along = equal && lines[0]
    const step = along
      ? nearestOf(this.#uplot, abscissaOf(along, this.content, times), along.curve, left, top)
      : over
        ? nearestStep(over.curve, x, this.state.step)
        : stepAt(times, x)
    if (event.buttons === 1) {
      this.state.pause()
      this.state.goToStep(step)
    } else this.state.hover(step)
  }

  /** Shows the range that releasing the pointer selects. */
  #stretch(at: { left: number; top: number }): void {
    const { upright, at: from } = this.#from!
    const [low, high] = between(from, upright ? at.top : at.left)
    this.#band.hidden = high - low < CLICK
    const [side, size] = [`${low}px`, `${high - low}px`]
    Object.assign(
      this.#band.style,
      upright
        ? { left: '0', width: '100%', top: side, height: size }
        : { left: side, width: size, top: '0', height: '100%' },
    )
  }

  #let(to?: { left: number; top: number }): void {
    const from = this.#from
    this.#from = undefined
    this.#band.hidden = true
    if (from === undefined || to === undefined) return
    const end = from.upright ? to.top : to.left
    if (Math.abs(end - from.at) < CLICK) return
    const value = (at: number) => this.#uplot!.posToVal(at, from.upright ? 'y' : 'x')
    const part = between(value(from.at), value(end))
    if (from.upright) this.#upright.show(part)
    else this.#see(part)
  }

  #key(event: KeyboardEvent): void {
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : this.#action(event)
    if (!action || !this.#uplot || event.defaultPrevented) return
    event.preventDefault()
    event.stopPropagation()
    action()
  }

  #action({ key, shiftKey, target }: KeyboardEvent): (() => void) | undefined {
    if (key === 'Escape' && this.element.classList.contains('maximised')) return () => this.maximise(false)
    if (target !== this.area) return undefined
    if (key === 'Enter') return () => this.maximise()
    if (key === '+' || key === '=') return () => this.#scale(CLOSER)
    if (key === '-' || key === '_') return () => this.#scale(1 / CLOSER)
    if (key === '0') return () => this.#reset()
    if (!shiftKey) return undefined
    if (key === 'ArrowUp') return () => this.#scaleUpright(CLOSER)
    if (key === 'ArrowDown') return () => this.#scaleUpright(1 / CLOSER)
    const share = { ArrowLeft: -ASIDE, ArrowRight: ASIDE }[key]
    return share ? () => this.content.part && this.#see(moved(this.content.part, share)) : undefined
  }

  #reset(): void {
    this.#upright.show(undefined)
    this.#see(undefined)
  }

  /** Scales the visible range of the abscissa, about the moment shown where it is visible. */
  #scale(factor: number): void {
    const part = this.content.part ?? this.#all()
    const [low, high] = part
    const now = valueAt(this.content.over?.curve ?? this.state.report.times, this.state.step)
    this.#see(scaled(part, factor, low <= now && now <= high ? now : (low + high) / 2))
  }

  /** Scales the visible range of the ordinate about a value, by default its middle; never beyond all of it. */
  #scaleUpright(factor: number, about?: number): void {
    const { min, max } = this.#uplot!.scales.y
    if (this.content.logarithmic || min == null || max == null) return
    const part = scaled([min, max], factor, about ?? (min + max) / 2)
    const [low, high] = drawnRange(this.content, this.state.report.times) ?? [min, max]
    const whole = padded(low, high)
    this.#upright.show(part[1] - part[0] < whole[1] - whole[0] ? part : undefined)
  }

  /** The whole abscissa. */
  #all(): Part {
    const { content } = this
    const { times } = this.state.report
    if (!content.over) return extent([times]) ?? [0, 0]
    const drawn = drawnLines(content).map((line) => abscissaOf(line, content, times))
    return padded(...(extent([content.over.curve, ...drawn]) ?? [0, 0]))
  }

  #see(part: Part | undefined): void {
    const whole = this.#all()
    const zoom = this.content.over ? this.#own : this.time
    zoom.show(part && within(atLeast(part, whole), whole))
  }

  #zoomed(): void {
    this.#content.part = (this.#content.over ? this.#own : this.time).part
    this.#content.upright = this.#upright.part
    if (!this.#uplot || this.#stale) return
    // A button that goes takes the focus with it.
    if (document.activeElement === this.#whole) this.#closer.focus()
    this.#whole.hidden = (this.content.part ?? this.content.upright) === undefined
    this.rescale()
  }

  #showTime(): void {
    if (!this.#uplot || !this.#seen) return
    const { over, unit } = this.content
    const { times, units } = this.state.report
    const at = (step: number) => valueAt(over?.curve ?? times, step)
    const [low, high] = this.content.part ?? [-Infinity, Infinity]
    const { hovered } = this.state
    const place = (element: HTMLElement, step: number | undefined) => {
      const x = step === undefined ? NaN : at(step)
      element.hidden = !(low <= x && x <= high)
      if (!element.hidden) element.style.left = `${this.#uplot!.valToPos(x, 'x')}px`
    }
    place(this.#marker, this.state.step)
    place(this.#pointer, hovered)
    const step = hovered ?? this.state.step
    setText(this.#moment, over ? `${over.label} ${figure4(at(step), over.unit)}` : figure4(at(step), units.time))
    this.#moment.classList.toggle('pointed', hovered !== undefined)
    for (const { line, output } of this.#readings) {
      const value = line.free ? interpolated(line, at(step)) : valueAt(line.curve, step)
      setText(output, figure4(value, unit))
    }
  }
}

/** True if curves are equal, number by number. */
function isSameData(a: uPlot.AlignedData, b: uPlot.AlignedData): boolean {
  const [before, now] = [a, b] as unknown as (ArrayLike<number | null>[] | null)[][]
  const isSame = (x: ArrayLike<number | null>, y: ArrayLike<number | null>) => {
    if (x.length !== y.length) return false
    for (let k = 0; k < x.length; k++) if (!Object.is(x[k], y[k])) return false
    return true
  }
  return (
    before.length === now.length &&
    before.every((pair, k) => pair === now[k] || pair!.every((list, side) => isSame(list, now[k]![side])))
  )
}

function button(testId: string, title: string, path: string, onclick: () => void): HTMLButtonElement {
  const [label] = title.toLowerCase().split(/[;(]/)
  return el(
    'button',
    { type: 'button', class: 'icon', 'data-testid': testId, title, 'aria-label': label.trim(), onclick },
    svg('svg', { viewBox: '0 0 16 16', 'aria-hidden': 'true' }, svg('path', { d: path })),
  )
}

/** A piece of the line, as it is drawn. */
function sample({ color, dash, width, marks }: Line): SVGElement {
  const style = {
    stroke: color,
    'stroke-width': Math.min(width ?? USUAL_LINE, 3),
    'stroke-dasharray': dash?.join(' ') ?? '',
  }
  const shape = marks
    ? svg('circle', { cx: SAMPLE / 2, cy: 5, r: RADIUS, ...style })
    : svg('path', { d: `M0 5H${SAMPLE}`, ...style })
  return svg('svg', { class: 'sample', width: SAMPLE, height: 10, 'aria-hidden': 'true' }, shape)
}

/** The step of a path that is nearest to a position, px. */
function nearestOf(u: uPlot, xs: Curve, ys: Curve, left: number, top: number): number {
  const away = (k: number) => Math.hypot(u.valToPos(xs[k], 'x') - left, u.valToPos(ys[k], 'y') - top)
  let [best, least] = [0, Infinity]
  for (let k = 0; k < xs.length; k++) {
    const distance = away(k)
    if (distance < least) [best, least] = [k, distance]
  }
  return best
}

/** The value of a line with its own points at an abscissa; NaN beyond its ends. */
function interpolated({ over, curve }: Line, x: number): number {
  const xs = over ?? new Float32Array()
  for (let k = 1; k < xs.length; k++)
    if ((xs[k - 1] - x) * (xs[k] - x) <= 0)
      return curve[k - 1] + ((curve[k] - curve[k - 1]) * (x - xs[k - 1])) / (xs[k] - xs[k - 1] || 1)
  return NaN
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

/** Intervals of contact, behind the curves; only over time. */
function drawContacts(u: uPlot, { contacts = [], over }: Content): void {
  if (over || contacts.length === 0) return
  const { ctx, bbox } = u
  ctx.save()
  ctx.beginPath()
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height)
  ctx.clip()
  ctx.fillStyle = css('--load')
  ctx.globalAlpha = 0.14
  for (const [from, to] of contacts) {
    const [left, right] = [from, to].map((time) => u.valToPos(time, 'x', true))
    ctx.fillRect(left, bbox.top, Math.max(right - left, devicePixelRatio), bbox.height)
  }
  ctx.restore()
}

/** Widths of lines and of the circles of marks, px. */
const USUAL_LINE = 1.8
const MARK = 1.5
/** Radius of the circles, px. */
const RADIUS = 3.5

/** A line over an abscissa that may go back and forth. */
function facets(line: Line, color: () => string): uPlot.Series {
  const auto = ['x', 'y'].map((scale) => ({ scale, auto: true }))
  const marks = line.marks !== undefined
  const paths: uPlot.Series.PathBuilder = (u, index) => {
    const [xs, ys] = u.data[index] as unknown as [Curve, (number | null)[]]
    const path = new Path2D()
    const across = placer(u, 'x')
    const up = placer(u, 'y')
    const radius = RADIUS * devicePixelRatio
    let drawing = false
    for (let k = 0; k < xs.length; k++) {
      const y = ys[k]
      if (y === null || Number.isNaN(xs[k])) {
        drawing = false
        continue
      }
      const [left, top] = [across(xs[k]), up(y)]
      if (marks) path.moveTo(left + radius, top), path.arc(left, top, radius, 0, 2 * Math.PI)
      else if (drawing) path.lineTo(left, top)
      else path.moveTo(left, top)
      drawing = true
    }
    return { stroke: path }
  }
  return {
    stroke: color,
    width: marks ? MARK : (line.width ?? USUAL_LINE),
    dash: line.dash,
    paths,
    facets: auto,
    points: { show: false },
  }
}

/** From values to positions on the canvas, px: a linear axis needs two positions only. */
function placer(u: uPlot, name: 'x' | 'y'): (value: number) => number {
  const { min, max, distr } = u.scales[name]
  if (distr === LOGARITHMIC.distr || min == null || max == null) return (value) => u.valToPos(value, name, true)
  const from = u.valToPos(min, name, true)
  const factor = (u.valToPos(max, name, true) - from) / (max - min)
  return (value) => from + factor * (value - min)
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
