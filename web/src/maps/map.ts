import './map.css'
import { el, onSchemeChange, svg } from '../dom'
import { extent, linearAxis, type Axis } from '../export/axis'
import { figure, number, pretty, titled } from '../format'
import { Scale } from '../influence/colours'
import type { GridMap } from '../report'
import { areas, type Grid, levels, type Line, valueAt } from './contours'

/** Room round the map: for the numbers of the axes, and for the legend, px. */
const MARGIN = { left: 62, right: 96, top: 10, bottom: 46 }
/** The map is so high for its width, and no higher, px. */
const SHAPE = 0.62
const HIGHEST = 440
/** About one number of an axis on that many pixels. */
const TICK = 70
/** More positions than this are not marked one by one. */
const MOST_MARKED = 600

/**
 * A case over two drivers: a measure, or its derivative by a design variable, as areas between round values; at first
 * the measure of that name.
 */
export function driverMap(map: GridMap, first: string): HTMLElement {
  return new DriverMap(map, first).element
}

class DriverMap {
  readonly element: HTMLElement
  readonly #quantity: HTMLSelectElement
  readonly #by: HTMLSelectElement
  readonly #picture = svg('svg', { role: 'img' })
  readonly #reading = el('output', { class: 'reading', 'aria-live': 'polite', 'data-testid': 'map-reading' })
  readonly #frame: HTMLElement
  #axes?: { x: Axis; y: Axis }
  #width = 0
  /** Position that the arrow keys went to: column and row. */
  #place?: [number, number]

  constructor(
    private readonly map: GridMap,
    first: string,
  ) {
    const render = () => this.#render()
    const options = (names: string[]) => names.map((name, k) => el('option', { value: k }, name))
    this.#quantity = el(
      'select',
      { 'aria-label': 'measure of the map', 'data-testid': 'map-quantity', onchange: () => this.#choose() },
      ...options(map.quantities.map(({ name }) => name)),
    )
    this.#quantity.value = String(
      Math.max(
        0,
        map.quantities.findIndex(({ name }) => name === first),
      ),
    )
    this.#by = el('select', {
      'aria-label': 'value or sensitivity',
      'data-testid': 'map-by',
      onchange: render,
    })
    this.#frame = el(
      'div',
      {
        class: 'picture',
        tabindex: 0,
        role: 'application',
        'aria-label': `map ${map.name}: arrow keys move between positions`,
        onpointermove: (event: PointerEvent) => this.#point(event),
        onpointerleave: () => this.#showReading(),
        onkeydown: (event: KeyboardEvent) => this.#key(event),
      },
      this.#picture,
    )
    const choice = el(
      'p',
      { class: 'choice' },
      el('label', {}, 'Measure ', this.#quantity),
      el('label', {}, 'shown ', this.#by),
    )
    this.element = el(
      'section',
      { class: 'driver-map', 'data-testid': 'map' },
      el('h3', {}, `${map.name}: over ${map.drivers[0].name} and ${map.drivers[1].name}`),
      choice,
      this.#frame,
      this.#reading,
      el('p', { class: 'note' }, map.note),
    )
    this.#choose()
    onSchemeChange(render)
    new ResizeObserver(([entry]) => {
      const width = Math.round(entry.contentRect.width)
      if (width === this.#width || width === 0) return
      this.#width = width
      render()
    }).observe(this.#frame)
  }

  #choose(): void {
    const { sensitivities } = this.map.quantities[Number(this.#quantity.value)]
    const names = ['value', ...sensitivities.map(({ variable }) => `per ${variable}`)]
    const before = this.#by.value
    this.#by.replaceChildren(...names.map((name, k) => el('option', { value: k }, name)))
    this.#by.value = Number(before) < names.length && before ? before : '0'
    this.#render()
  }

  /** Shown table: name, unit, and numbers. */
  #shown(): { name: string; unit: string; grid: Grid } {
    const quantity = this.map.quantities[Number(this.#quantity.value)]
    const [columns, rows] = this.map.drivers.map(({ places }) => places)
    const by = quantity.sensitivities[Number(this.#by.value) - 1]
    if (!by) return { name: quantity.name, unit: quantity.unit, grid: { columns, rows, values: quantity.values } }
    return { name: `${quantity.name} per ${by.variable}`, unit: by.unit, grid: { columns, rows, values: by.values } }
  }

  #render(): void {
    if (this.#width === 0) return
    const { name, unit, grid } = this.#shown()
    const [width, height] = [this.#width, Math.min(HIGHEST, Math.round(this.#width * SHAPE))]
    const [first, second] = this.map.drivers
    const ends = (places: readonly number[]): [number, number] => [places[0], places[places.length - 1]]
    const [right, bottom] = [width - MARGIN.right, height - MARGIN.bottom]
    const x = linearAxis(ends(first.places), MARGIN.left, right, Math.max(2, (right - MARGIN.left) / TICK))
    const y = linearAxis(ends(second.places), bottom, MARGIN.top, Math.max(2, (bottom - MARGIN.top) / TICK))
    this.#axes = { x, y }
    const at = levels(grid.values)
    const colour = shades(grid.values, at)
    const box = { x: MARGIN.left, y: MARGIN.top, width: right - MARGIN.left, height: bottom - MARGIN.top }
    const path = (lines: Line[]) =>
      lines.map((line) => `M${line.map(([a, b]) => `${x.at(a).toFixed(1)},${y.at(b).toFixed(1)}`).join('L')}Z`).join('')
    this.#picture.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.#picture.setAttribute('width', String(width))
    this.#picture.setAttribute('height', String(height))
    this.#picture.setAttribute('aria-label', `${titled(name, unit)} over ${first.name} and ${second.name}`)
    this.#picture.replaceChildren(
      svg('rect', { ...box, class: 'area', fill: colour(0) }),
      ...areas(grid, at).map(({ outlines }, k) =>
        svg('path', { class: 'area', d: path(outlines), fill: colour(k + 1), 'fill-rule': 'evenodd' }),
      ),
      ...this.#gaps(grid, x, y),
      ...this.#marks(grid, x, y),
      svg('rect', { ...box, class: 'frame' }),
      ...x.ticks.map(({ value, text }) => label(text, x.at(value), bottom + 16, 'middle')),
      ...y.ticks.map(({ value, text }) => label(text, MARGIN.left - 6, y.at(value) + 4, 'end')),
      label(titled(first.name, first.unit), (MARGIN.left + right) / 2, height - 8, 'middle'),
      turned(titled(second.name, second.unit), 14, (MARGIN.top + bottom) / 2),
      ...legend(at, colour, pretty(unit), right + 12, box),
      ...(this.#place ? [cross(x.at(first.places[this.#place[0]]), y.at(second.places[this.#place[1]]))] : []),
    )
    this.#showReading()
  }

  /** Positions that the mechanism did not reach: no colour. */
  #gaps({ columns, rows, values }: Grid, x: Axis, y: Axis): SVGElement[] {
    const cells: SVGElement[] = []
    const known = (i: number, j: number) => Number.isFinite(values[j * columns.length + i])
    for (let j = 0; j + 1 < rows.length; j++) {
      for (let i = 0; i + 1 < columns.length; i++) {
        if (known(i, j) && known(i + 1, j) && known(i, j + 1) && known(i + 1, j + 1)) continue
        const [left, right, low, high] = [x.at(columns[i]), x.at(columns[i + 1]), y.at(rows[j]), y.at(rows[j + 1])]
        cells.push(svg('rect', { class: 'gap', x: left, y: high, width: right - left, height: low - high }))
      }
    }
    return cells
  }

  #marks({ columns, rows, values }: Grid, x: Axis, y: Axis): SVGElement[] {
    if (columns.length * rows.length > MOST_MARKED) return []
    const places = rows.flatMap((row, j) =>
      columns.map((column, i) => ({ row, column, known: Number.isFinite(values[j * columns.length + i]) })),
    )
    return places.map(({ row, column, known }) =>
      svg('circle', { class: known ? 'place' : 'place missed', cx: x.at(column), cy: y.at(row), r: 1.5 }),
    )
  }

  #point(event: PointerEvent): void {
    if (!this.#axes) return
    const corner = this.#picture.getBoundingClientRect()
    const [first, second] = this.map.drivers
    const value = (axis: Axis, pixel: number, places: readonly number[]) => {
      const [a, b] = [places[0], places[places.length - 1]]
      return a + ((pixel - axis.at(a)) / (axis.at(b) - axis.at(a))) * (b - a)
    }
    this.#showReading([
      value(this.#axes.x, event.clientX - corner.left, first.places),
      value(this.#axes.y, event.clientY - corner.top, second.places),
    ])
  }

  #key(event: KeyboardEvent): void {
    const by = (
      { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] } as Record<
        string,
        [number, number]
      >
    )[event.key]
    if (!by) return
    event.preventDefault()
    event.stopPropagation()
    const [first, second] = this.map.drivers
    const [i, j] = this.#place ?? [
      Math.floor(first.places.length / 2) - by[0],
      Math.floor(second.places.length / 2) - by[1],
    ]
    const inside = (k: number, count: number) => Math.min(Math.max(k, 0), count - 1)
    this.#place = [inside(i + by[0], first.places.length), inside(j + by[1], second.places.length)]
    this.#render()
    this.#showReading([first.places[this.#place[0]], second.places[this.#place[1]]])
  }

  /** The value at a position; the least and greatest where none is pointed at. */
  #showReading(at?: [number, number]): void {
    const { name, unit, grid } = this.#shown()
    const [first, second] = this.map.drivers
    const value = at ? valueAt(grid, ...at) : NaN
    const inside =
      at &&
      at[0] >= first.places[0] &&
      at[0] <= first.places.at(-1)! &&
      at[1] >= second.places[0] &&
      at[1] <= second.places.at(-1)!
    const place = ([x, y]: [number, number]) =>
      `${first.name} ${figure(x, first.unit)}, ${second.name} ${figure(y, second.unit)}`
    const ends = extent([grid.values])
    this.#reading.textContent = inside
      ? `${name}: ${Number.isFinite(value) ? figure(value, unit) : 'not reached'} at ${place(at)}`
      : ends
        ? `${name}: ${number(ends[0])} to ${figure(ends[1], unit)}`
        : `${name}: no values`
  }
}

/**
 * The colour of each band: from blue over nothing to orange where values have both signs, from nothing on where they
 * have one.
 */
function shades(values: ArrayLike<number>, at: number[]): (band: number) => string {
  const scale = new Scale()
  const [low, high] = extent([values]) ?? [0, 0]
  const maximum = Math.max(Math.abs(low), Math.abs(high)) || 1
  const edges = [low, ...at, high]
  return (band) => {
    const middle = (edges[band] + edges[band + 1]) / 2
    return scale.of(low < 0 && high > 0 ? middle / maximum : high > low ? (middle - low) / (high - low) : 0)
  }
}

function legend(
  at: number[],
  colour: (band: number) => string,
  unit: string,
  x: number,
  box: { y: number; height: number },
): SVGElement[] {
  const band = box.height / (at.length + 1)
  const top = (k: number) => box.y + box.height - (k + 1) * band
  return [
    ...Array.from({ length: at.length + 1 }, (_, k) =>
      svg('rect', { class: 'band', x, y: top(k), width: 14, height: band, fill: colour(k) }),
    ),
    ...at.map((level, k) =>
      label(`${number(level)}${k === at.length - 1 && unit ? ` ${unit}` : ''}`, x + 20, top(k) + 4, 'start'),
    ),
  ]
}

function label(text: string, x: number, y: number, anchor: string): SVGElement {
  return svg('text', { x, y, 'text-anchor': anchor }, document.createTextNode(text))
}

function turned(text: string, x: number, y: number): SVGElement {
  const element = label(text, x, y, 'middle')
  element.setAttribute('transform', `rotate(-90 ${x} ${y})`)
  return element
}

function cross(x: number, y: number): SVGElement {
  return svg('circle', { class: 'pointed', cx: x, cy: y, r: 5 })
}
