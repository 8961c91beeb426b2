import './influence.css'
import { css, el, onSchemeChange } from '../dom'
import { number, pretty } from '../format'
import { derivativeUnit, ORDERS, type Quantity, type Variable } from '../report'
import { originHeading } from '../page/checks'
import { whileSeen } from '../page/tabs'
import type { State } from '../state'
import { Cells, grid, knownGroups, type Grid } from './cells'
import { Scale, strong } from './colours'

/** Height of a row and least and most width of a column, px. */
const ROW = 20
const COLUMN = { least: 24, most: 72 }
/** Columns from this width show their numbers, px. */
const ROOMY = 46
/** Sizes of the names of rows and columns, px. */
const NAMES = { width: 176, height: 112 }
/** Maximum height of the window, and room for a scroll bar, px. */
const HIGHEST = 460
const SPARE = 18
/** Columns of a table on paper. */
const PAPER_COLUMNS = 12
const FONT = '12px system-ui, sans-serif'
const SMALL = '11px system-ui, sans-serif'

/** A place in the map: row and column. */
interface Place {
  row: number
  column: number
}

/** Every quantity of a group against every variable: one canvas, which draws the visible part. */
export function heatMap(state: State): HTMLElement {
  return new HeatMap(state).element
}

class HeatMap {
  readonly element: HTMLElement
  readonly #canvas = el('canvas', { 'aria-hidden': 'true' })
  readonly #extent = el('div', { class: 'extent' })
  readonly #reading = el('output', { class: 'reading', 'aria-live': 'polite', 'data-testid': 'heat-reading' })
  readonly #legend = el('span', { class: 'ends' })
  readonly #title = el('span')
  /** The whole map in tables that fit a sheet of paper, filled while it is printed. */
  readonly #paper = el('div', { class: 'heat-paper' })
  readonly #window: HTMLElement
  readonly #group: HTMLSelectElement
  readonly #filter: HTMLInputElement
  readonly #offered: [name: string, members: Quantity[]][]
  #grid: Grid = { rows: [], quantities: [] }
  #cells: Cells
  #scale?: Scale
  #size = { width: 0, height: 0 }
  /** Both as reported by the browser; reading them from the element would force a layout in the middle of a frame. */
  #scroll = { left: 0, top: 0 }
  #column: number = COLUMN.least
  /** Under the pointer, or where the arrow keys went. */
  #pointed?: Place
  #frame = 0
  /** Key of the choices that were drawn. */
  #shown = ''

  constructor(private readonly state: State) {
    const known = knownGroups(state.report)
    this.#offered = known.length > 1 ? [...known, ['all', known.flatMap(([, members]) => members)]] : known
    this.#cells = new Cells(state.sensitivityReport, state.choice.order)
    const layOut = () => this.#layOut()
    const options = this.#offered.map(([name]) => el('option', { value: name }, name))
    this.#group = el('select', { 'aria-label': 'quantities shown', onchange: layOut }, ...options)
    this.#filter = el('input', {
      type: 'search',
      placeholder: 'names',
      'aria-label': 'filter by names',
      oninput: layOut,
    })
    this.#window = el(
      'div',
      {
        class: 'window',
        tabindex: 0,
        role: 'application',
        'aria-label': 'sensitivity map: arrow keys read cells, Enter chooses',
        onscroll: () => {
          this.#scroll = { left: this.#window.scrollLeft, top: this.#window.scrollTop }
          this.#draw()
        },
        onpointermove: (event: PointerEvent) => this.#point(this.#under(event)),
        onpointerleave: () => this.#point(undefined),
        onclick: (event: PointerEvent) => this.#choose(this.#under(event)),
        onkeydown: (event: KeyboardEvent) => this.#key(event),
      },
      this.#canvas,
      this.#extent,
    )
    this.element = el(
      'section',
      { class: 'heat', 'data-testid': 'heat' },
      el('h2', {}, 'Sensitivity map', this.#title),
      originHeading(state),
      el(
        'p',
        { class: 'lead' },
        'Extreme value over time; colours compare variables of the same unit within a column.',
      ),
      el(
        'div',
        { class: 'bar' },
        known.length > 1 && el('label', { class: 'field' }, el('span', {}, 'Quantities'), this.#group),
        el('label', { class: 'field' }, el('span', {}, 'Filter'), this.#filter),
        el('span', { class: 'legend' }, el('span', { class: 'ramp' }), this.#legend),
      ),
      this.#window,
      this.#reading,
      this.#paper,
    )
    addEventListener('beforeprint', () => this.#print(), { signal: state.ended })
    addEventListener('afterprint', () => this.#paper.replaceChildren(), { signal: state.ended })
    new ResizeObserver(([{ contentRect }]) => {
      this.#size = { width: contentRect.width, height: contentRect.height }
      this.#layOut()
    }).observe(this.#window)
    whileSeen(
      this.element,
      (listener) => state.onChoice(listener),
      () => this.#chosen(),
      state.ended,
    )
    onSchemeChange(() => {
      this.#scale = undefined
      this.#draw()
    }, state.ended)
    this.#layOut()
  }

  #chosen(): void {
    const { order, quantity, variable } = this.state.choice
    const key = `${order} ${quantity} ${variable}`
    if (key === this.#shown && this.#cells.report === this.state.sensitivityReport) return
    this.#shown = key
    if (order !== this.#cells.order || this.#cells.report !== this.state.sensitivityReport)
      this.#cells = new Cells(this.state.sensitivityReport, order)
    this.#layOut()
  }

  /** Rows and columns anew; sizes are those that the observer reported. */
  #layOut(): void {
    const { report, choice } = this.state
    const offered = this.#offered.find(([name]) => name === this.#group.value)?.[1] ?? []
    this.#grid = grid(report, offered, this.#filter.value)
    const { rows, quantities } = this.#grid
    const room = (this.#size.width - NAMES.width) / Math.max(1, quantities.length)
    this.#column = Math.floor(Math.min(Math.max(room, COLUMN.least), COLUMN.most))
    const [width, height] = [NAMES.width + quantities.length * this.#column, NAMES.height + rows.length * ROW]
    Object.assign(this.#extent.style, { width: `${width}px`, height: `${height}px` })
    this.#window.style.height = `${Math.min(height + SPARE, HIGHEST)}px`
    this.#title.textContent = choice.order === 0 ? '' : ` (${ORDERS[choice.order]})`
    if (this.#pointed && (this.#pointed.row >= rows.length || this.#pointed.column >= quantities.length))
      this.#pointed = undefined
    this.#read()
    this.#draw()
  }

  #print(): void {
    const { rows, quantities } = this.#grid
    const scale = new Scale()
    const cell = (quantity: Quantity, variable: Variable) => {
      const found = this.#cells.at(quantity, variable)
      if (!found) return el('td', {}, '·')
      const ink = strong(found.share) ? css('--heat-text') : css('--ink')
      const style = `background: ${scale.of(found.share)}; color: ${ink}`
      return el('td', { style }, found.share === 0 ? '' : number(found.extreme, 2))
    }
    const table = (part: Quantity[]) =>
      el(
        'table',
        {},
        el('tr', {}, el('th'), ...part.map(({ name }) => el('th', { class: 'column' }, el('span', {}, name)))),
        ...rows.map(({ unit, variable }) => {
          const name = variable?.name ?? `per ${pretty(unit) || 'unit'}`
          return el('tr', {}, el('th', {}, name), ...(variable ? part.map((one) => cell(one, variable)) : []))
        }),
      )
    const parts = Array.from({ length: Math.ceil(quantities.length / PAPER_COLUMNS) }, (_, k) =>
      quantities.slice(k * PAPER_COLUMNS, (k + 1) * PAPER_COLUMNS),
    )
    this.#paper.replaceChildren(...parts.map(table))
  }

  /** Draws in the next frame, once however often it is requested. */
  #draw(): void {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#paint())
  }

  #paint(): void {
    this.#frame = 0
    const { width, height } = this.#size
    const dense = devicePixelRatio
    const [across, down] = [Math.round(width * dense), Math.round(height * dense)]
    if (this.#canvas.width !== across || this.#canvas.height !== down) {
      Object.assign(this.#canvas, { width: across, height: down })
      Object.assign(this.#canvas.style, { width: `${width}px`, height: `${height}px` })
    }
    if (across === 0 || down === 0) return
    const pen = this.#canvas.getContext('2d')!
    pen.setTransform(dense, 0, 0, dense, 0, 0)
    pen.clearRect(0, 0, width, height)
    pen.textBaseline = 'middle'
    this.#scale ??= new Scale()
    this.#paintCells(pen, this.#scale)
    this.#paintRows(pen)
    this.#paintColumns(pen)
    pen.fillStyle = css('--page')
    pen.fillRect(0, 0, NAMES.width, NAMES.height)
  }

  /** First and last row and column in sight. */
  #sight(): { rows: [number, number]; columns: [number, number] } {
    const { width, height } = this.#size
    const last = (far: number, size: number, count: number) => Math.min(count, Math.ceil(far / size))
    return {
      rows: [
        Math.floor(this.#scroll.top / ROW),
        last(this.#scroll.top + height - NAMES.height, ROW, this.#grid.rows.length),
      ],
      columns: [
        Math.floor(this.#scroll.left / this.#column),
        last(this.#scroll.left + width - NAMES.width, this.#column, this.#grid.quantities.length),
      ],
    }
  }

  #left(column: number): number {
    return NAMES.width + column * this.#column - this.#scroll.left
  }

  #top(row: number): number {
    return NAMES.height + row * ROW - this.#scroll.top
  }

  #paintCells(pen: CanvasRenderingContext2D, scale: Scale): void {
    const { rows, columns } = this.#sight()
    const [ink, light, muted] = [css('--ink'), css('--heat-text'), css('--muted')]
    pen.font = SMALL
    pen.textAlign = 'center'
    for (let column = columns[0]; column < columns[1]; column++) {
      const quantity = this.#grid.quantities[column]
      const left = this.#left(column)
      for (let row = rows[0]; row < rows[1]; row++) {
        const { variable } = this.#grid.rows[row]
        if (!variable) continue
        const cell = this.#cells.at(quantity, variable)
        const top = this.#top(row)
        if (!cell) {
          pen.fillStyle = muted
          pen.fillText('·', left + this.#column / 2, top + ROW / 2)
          continue
        }
        pen.fillStyle = scale.of(cell.share)
        pen.fillRect(left, top, this.#column - 1, ROW - 1)
        if (this.#column < ROOMY || cell.share === 0) continue
        pen.fillStyle = strong(cell.share) ? light : ink
        pen.fillText(number(cell.extreme, 2), left + this.#column / 2, top + ROW / 2)
      }
    }
    this.#outline(pen, this.#chosenPlace(), css('--accent'))
    this.#outline(pen, this.#pointed, ink)
  }

  #outline(pen: CanvasRenderingContext2D, place: Place | undefined, colour: string): void {
    if (!place) return
    pen.strokeStyle = colour
    pen.lineWidth = 2
    pen.strokeRect(this.#left(place.column), this.#top(place.row), this.#column - 1, ROW - 1)
  }

  #paintRows(pen: CanvasRenderingContext2D): void {
    const { rows } = this.#sight()
    pen.fillStyle = css('--page')
    pen.fillRect(0, NAMES.height, NAMES.width, this.#size.height)
    pen.textAlign = 'left'
    for (let row = rows[0]; row < rows[1]; row++) {
      const { unit, variable } = this.#grid.rows[row]
      const middle = this.#top(row) + ROW / 2
      const chosen = variable?.index === this.state.choice.variable
      pen.font = variable ? FONT : `italic ${SMALL}`
      pen.fillStyle = variable ? css(chosen ? '--accent' : '--ink') : css('--muted')
      const text = variable ? variable.name : `per ${pretty(unit) || 'unit'}`
      pen.fillText(fitted(pen, text, NAMES.width - 12), variable ? 8 : 0, middle)
    }
  }

  #paintColumns(pen: CanvasRenderingContext2D): void {
    const { columns } = this.#sight()
    pen.fillStyle = css('--page')
    pen.fillRect(NAMES.width, 0, this.#size.width, NAMES.height)
    pen.textAlign = 'left'
    pen.font = FONT
    for (let column = columns[0]; column < columns[1]; column++) {
      const quantity = this.#grid.quantities[column]
      pen.save()
      pen.translate(this.#left(column) + this.#column / 2, NAMES.height - 6)
      pen.rotate(-Math.PI / 2)
      pen.fillStyle = css(quantity.index === this.state.choice.quantity ? '--accent' : '--ink')
      pen.fillText(fitted(pen, quantity.name, NAMES.height - 12), 0, 0)
      pen.restore()
    }
  }

  #chosenPlace(): Place | undefined {
    const row = this.#grid.rows.findIndex(({ variable }) => variable?.index === this.state.choice.variable)
    const column = this.#grid.quantities.findIndex(({ index }) => index === this.state.choice.quantity)
    return row < 0 || column < 0 ? undefined : { row, column }
  }

  /** The place under the pointer; -1 for the names beside the rows or above the columns. */
  #under(event: PointerEvent): Place | undefined {
    const { left, top } = this.#window.getBoundingClientRect()
    const [x, y] = [event.clientX - left - NAMES.width, event.clientY - top - NAMES.height]
    const column = x < 0 ? -1 : Math.floor((x + this.#scroll.left) / this.#column)
    const row = y < 0 ? -1 : Math.floor((y + this.#scroll.top) / ROW)
    return column < this.#grid.quantities.length && row < this.#grid.rows.length ? { row, column } : undefined
  }

  #point(place: Place | undefined): void {
    const cell = place && place.column >= 0 && this.#grid.rows[place.row]?.variable ? place : undefined
    if (cell?.row === this.#pointed?.row && cell?.column === this.#pointed?.column) return
    this.#pointed = cell
    this.#read()
    this.#draw()
  }

  /** Describes the cell under the pointer, or the chosen one; the legend has the ends of its column. */
  #read(): void {
    const place = this.#pointed ?? this.#chosenPlace()
    const quantity = place && this.#grid.quantities[place.column]
    const variable = place && this.#grid.rows[place.row]?.variable
    if (!quantity || !variable) {
      this.#reading.textContent = ''
      this.#legend.textContent = 'largest of its column, negative to positive'
      return
    }
    this.#reading.textContent = this.#cells.text(quantity, variable)
    const largest = number(this.#cells.largest(quantity, variable.unit), 3)
    const unit = derivativeUnit(quantity, this.#cells.order, variable)
    this.#legend.textContent = `−${largest} to ${largest}${unit ? ` ${unit}` : ''}`
  }

  #choose(place: Place | undefined): void {
    if (!place) return
    const variable = this.#grid.rows[place.row]?.variable
    const quantity = this.#grid.quantities[place.column]
    this.state.choose({ ...(variable && { variable: variable.index }), ...(quantity && { quantity: quantity.index }) })
  }

  #key(event: KeyboardEvent): void {
    const steps: Record<string, [number, number]> = {
      ArrowUp: [-1, 0],
      ArrowDown: [1, 0],
      ArrowLeft: [0, -1],
      ArrowRight: [0, 1],
    }
    const step = steps[event.key]
    if (event.key === 'Enter') this.#choose(this.#pointed)
    else if (event.key === 'Escape') this.#point(undefined)
    else if (!step) return
    else this.#go(step)
    event.preventDefault()
    event.stopPropagation()
  }

  /** To the next cell that is one, and scrolls it into sight. */
  #go([down, across]: [number, number]): void {
    const { rows, quantities } = this.#grid
    const first = rows.findIndex(({ variable }) => variable)
    if (first < 0 || quantities.length === 0) return
    const from = this.#pointed ?? this.#chosenPlace()
    if (!from) return this.#point({ row: first, column: 0 })
    const column = Math.min(Math.max(from.column + across, 0), quantities.length - 1)
    let row = from.row + down
    while (rows[row] && !rows[row].variable) row += down
    this.#point({ row: rows[row] ? row : from.row, column })
    const { width, height } = this.#size
    const inSight = (at: number, size: number, scrolled: number, room: number) =>
      Math.min(at, Math.max(scrolled, at + size - room))
    this.#window.scrollTo(
      inSight(column * this.#column, this.#column, this.#scroll.left, width - NAMES.width),
      inSight(this.#pointed!.row * ROW, ROW, this.#scroll.top, height - NAMES.height),
    )
  }
}

/** Text truncated to the available width. */
function fitted(pen: CanvasRenderingContext2D, text: string, room: number): string {
  if (pen.measureText(text).width <= room) return text
  let [fits, long] = [0, text.length]
  while (long - fits > 1) {
    const middle = (fits + long) >> 1
    if (pen.measureText(`${text.slice(0, middle)}…`).width <= room) fits = middle
    else long = middle
  }
  return `${text.slice(0, fits)}…`
}
