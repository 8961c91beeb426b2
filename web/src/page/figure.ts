import { el, onSchemeChange, prose } from '../dom'
import { messageOf } from '../format'
import { Plot } from '../plot'
import { groups, orderedName, ORDERS, type Order, type Report } from '../report'
import type { State } from '../state'
import type { Part, Zoom } from '../zoom'
import { sensitivityContent, valueContent, type Subject } from './contents'
import { type Measured, type MeasuredSubject, measuredOf } from './measured'
import { pointing } from './pointing'
import { ValueTable } from './value_table'

export type FigureKind = 'value' | 'sensitivity'

/** Choices of a figure, by names, so that they hold for another text of the model. */
export interface FigureMemory {
  kind: FigureKind
  /** Fixed quantity; the selected one where there is none. */
  quantity?: string
  order: Order
  over?: string
  also: string[]
  hidden: string[]
  difference: boolean
  path: boolean
  table: boolean
  abscissas?: number[]
  across?: Part
  upright?: Part
}

/** Options of a figure. */
interface FigureOptions {
  /** Fixed quantity; the selected one where there is none. */
  quantity?: number
  over?: number
  also?: readonly number[]
  path?: boolean
  shown: FigureKind
  testId: string
  /** The first figure controls the selection; others may follow it, and can be removed. */
  leads: boolean
}

/** Actions of the curves on a figure. */
interface FigureActions {
  onRemove: (figure: Figure) => void
  onAdd: () => void
  tool?: (figure: Figure) => HTMLElement | undefined
}

/** A file of measured data, which is read for what the figure shows. */
interface MeasuredFile {
  name: string
  text: string
  /** What the figure showed when the file was opened: columns without names of quantities belong to that. */
  of: string
}

/** A plot with selectors of its quantities, its abscissa, and values, changes or sensitivities. */
export class Figure {
  readonly plot: Plot
  #quantity?: number
  #order: Order = 0
  #over?: number
  #also: number[]
  /** The quantity that further curves and the path belong to, if the figure follows the selection. */
  #alsoOf?: number
  #hidden = new Set<string>()
  #difference = false
  #path: boolean
  #shown: FigureKind
  #files: MeasuredFile[] = []
  /** Reason why the last file could not be opened. */
  #unread = ''
  #failing = ''
  #table = new ValueTable()
  #delta = toggle('difference', 'Show changes to the reference design', 'Δ', () => {
    this.#difference = !this.#difference
    this.show()
  })
  #values = toggle('values-at', 'Table of values', '▦', () => {
    this.#table.element.hidden = !this.#table.element.hidden
    this.show()
  })
  #file = el('input', {
    type: 'file',
    accept: '.csv,.txt,text/csv',
    hidden: true,
    'data-testid': 'measured-file',
    'aria-label': 'measured data',
    onchange: () => void this.#load(this.#file.files?.[0]),
  })
  #failure = el('p', { class: 'caption missed', role: 'status' })

  constructor(
    private readonly state: State,
    private readonly options: FigureOptions,
    time: Zoom,
    { onRemove, onAdd, tool }: FigureActions,
  ) {
    this.#quantity = options.quantity
    this.#over = options.over
    this.#also = [...(options.also ?? [])]
    this.#path = options.path ?? false
    this.#shown = options.shown
    const { report } = state
    const first = options.leads ? [] : [el('option', { value: '' }, 'selected quantity')]
    const quantity = select('quantity', 'Quantity', () => this.#pick(quantity.value), ...first, ...offered(report))
    const over = select(
      'over',
      'Over',
      () => this.#choose({ over: over.value === '' ? undefined : Number(over.value) }),
      el('option', { value: '' }, 'over time'),
      ...offered(report, 'over '),
    )
    const order = select(
      'order',
      'Order',
      () => this.#choose({ order: Number(order.value) as Order }),
      ...ORDERS.map((name, k) => el('option', { value: k }, name)),
    )
    const also = select('also', 'Add a curve', () => this.#add(also.value))
    // Of a large model these are hundreds of elements for each plot: they are made when the list is about to open.
    const offer = () => also.childElementCount > 1 || also.replaceChildren(...this.#offeredCurves())
    for (const event of ['pointerenter', 'focus']) also.addEventListener(event, offer)
    const able = report.variables.some(({ sensitivities }) => sensitivities.size > 0)
    const shown = el(
      'button',
      {
        type: 'button',
        class: 'switch',
        'data-testid': 'shown',
        title: 'Show the sensitivities to the design variables',
        onclick: () => {
          this.#shown = this.#shown === 'value' ? 'sensitivity' : 'value'
          this.show()
        },
      },
      'Sensitivity',
    )
    const last = options.leads
      ? icon('add-curve', 'Add a plot', '+', onAdd)
      : icon('remove', 'Remove plot', '×', () => onRemove(this))
    const controls = el('div', { class: 'controls' }, quantity, over, order, able ? shown : undefined, last)
    this.plot = new Plot(state, options.testId, [controls], time, [also, this.#delta, this.#values])
    this.plot.element.append(this.#failure, this.#table.element, this.#file)
    this.plot.element.classList.toggle('leads', options.leads)
    this.#takeFiles()
    pointing(state, this.plot.element, () => this.subject.quantity)
    let extra: HTMLElement | undefined
    let listed = ''
    this.show = () => {
      const subject = { ...this.subject, measured: this.#measured() }
      const values = this.#shown === 'value'
      // The studio adds its parts when it has loaded.
      if (!extra && (extra = tool?.(this))) controls.lastElementChild!.before(extra)
      quantity.value = this.#follows && !options.leads ? '' : String(subject.quantity)
      over.value = subject.over === undefined ? '' : String(subject.over)
      order.value = String(subject.order)
      const key = `${subject.quantity} ${this.#also}`
      if (listed !== key) also.replaceChildren(el('option', { value: '' }, '+ curve'))
      listed = key
      also.hidden = this.#delta.hidden = !values
      // The field beside it names the quantity already.
      this.plot.element.classList.toggle('untitled', values && (!this.#follows || options.leads))
      shown.setAttribute('aria-pressed', String(!values))
      this.#delta.setAttribute('aria-pressed', String(this.#difference))
      this.#values.setAttribute('aria-pressed', String(!this.#table.element.hidden))
      this.plot.show(() => {
        const content = values ? valueContent(state, subject) : sensitivityContent(state, subject)
        if (values)
          for (const line of content.lines) {
            line.hidden = this.#hidden.has(line.label)
            line.pick = () => this.#toggle(line.label)
          }
        this.#table.show(content, report.times, report.units.time)
        return content
      })
    }
    onSchemeChange(() => this.show(), state.ended)
  }

  readonly show: () => void

  /** Subject of the figure. */
  get subject(): Subject {
    const { quantity, order, over } = this.state.choice
    if (this.#follows) this.#accompany(quantity)
    const own = { also: this.#also, difference: this.#difference, path: this.#path }
    return this.#follows
      ? { ...own, quantity, order, over }
      : { ...own, quantity: this.#quantity!, order: this.#order, over: this.#over }
  }

  /** With another selected quantity come the curves that the sheet shows with it. */
  #accompany(quantity: number): void {
    if (this.#alsoOf === quantity) return
    if (this.#alsoOf !== undefined || !this.options.also) {
      const plot = this.state.sheet.plots.find(({ y }) => y[0] === quantity)
      this.#also = this.options.leads ? (plot?.y.slice(1) ?? []) : []
      this.#path = false
    }
    this.#alsoOf = quantity
  }

  /** Choices of the figure, to be made again on another page. */
  get memory(): FigureMemory {
    const { quantities } = this.state.report
    const { order, over, also = [], difference = false, path = false } = this.subject
    return {
      kind: this.#shown,
      quantity: this.#follows ? undefined : quantities[this.#quantity!].name,
      order,
      over: over === undefined ? undefined : quantities[over].name,
      also: also.map((index) => quantities[index].name),
      hidden: [...this.#hidden],
      difference,
      path,
      table: !this.#table.element.hidden,
      abscissas: this.#table.abscissas,
      ...this.plot.parts,
    }
  }

  /** Makes the choices again that do not depend on the selection. */
  recall({ order, hidden, difference, table, abscissas, across, upright }: FigureMemory): void {
    this.#order = order
    this.#hidden = new Set(hidden)
    this.#difference = difference
    this.#table.element.hidden = !table
    this.#table.abscissas = abscissas
    this.plot.parts = { across, upright }
  }

  get #follows(): boolean {
    return this.#quantity === undefined
  }

  #pick(value: string): void {
    this.#path = false
    if (this.options.leads) return this.state.choose({ quantity: Number(value) })
    const { order, over } = this.subject
    this.#quantity = value === '' ? undefined : Number(value)
    this.#order = order
    this.#over = over
    this.show()
  }

  #choose(part: { order?: Order; over?: number }): void {
    if ('over' in part) this.#path = false
    if (this.#follows) return this.state.choose(part)
    if ('order' in part) this.#order = part.order!
    else this.#over = part.over
    this.show()
  }

  /** Quantities of the same unit as the first, and measured data. */
  #offeredCurves(): HTMLElement[] {
    const { quantities } = this.state.report
    const { quantity } = this.subject
    const { units } = quantities[quantity]
    const same = quantities.filter((one) => one.index !== quantity && one.units[0] === units[0])
    const name = (index: number) => `${this.#also.includes(index) ? '✓ ' : ''}${quantities[index].name}`
    return [
      el('option', { value: '' }, '+ curve'),
      el('option', { value: 'file' }, 'measured data (CSV)…'),
      ...(this.#files.length > 0 ? [el('option', { value: 'none' }, 'remove measured data')] : []),
      ...same.map(({ index }) => el('option', { value: index }, name(index))),
    ]
  }

  #add(value: string): void {
    if (value === 'file') this.#file.click()
    else if (value === 'none') [this.#files, this.#unread] = [[], '']
    else if (value !== '') {
      const index = Number(value)
      const at = this.#also.indexOf(index)
      if (at < 0) this.#also.push(index)
      else this.#also.splice(at, 1)
    }
    this.plot.element.querySelector<HTMLSelectElement>('[data-testid=also]')!.value = ''
    this.show()
  }

  /** Shows or hides a line. */
  #toggle(label: string): void {
    if (!this.#hidden.delete(label)) this.#hidden.add(label)
    this.show()
  }

  /** A file that is dropped onto the plot is read. */
  #takeFiles(): void {
    const { element } = this.plot
    element.addEventListener('dragover', (event) => {
      if (event.dataTransfer?.types.includes('Files')) event.preventDefault()
    })
    element.addEventListener('drop', (event) => {
      const file = event.dataTransfer?.files[0]
      if (!file) return
      event.preventDefault()
      void this.#load(file)
    })
  }

  async #load(file: File | undefined): Promise<void> {
    this.#file.value = ''
    if (!file) return
    try {
      const read = { name: file.name, text: await file.text(), of: this.#shownNames }
      measuredOf(read.text, read.name, this.#measuredSubject(read))
      this.#files.push(read)
      this.#unread = ''
    } catch (error) {
      this.#unread = messageOf(error)
    }
    this.show()
  }

  /** Names of what is plotted. */
  get #shownNames(): string {
    const { quantity, order, over } = this.subject
    return `${quantity} ${order} ${over}`
  }

  /** The columns of a file that can be drawn. */
  #measuredSubject({ of }: MeasuredFile): MeasuredSubject {
    const { quantities, units } = this.state.report
    const { quantity, order, also = [], over } = this.subject
    const wanted = (index: number, order: Order) => {
      const one = quantities[index]
      return { name: orderedName(one, order), unit: one.units[order], rateOf: order > 0 ? one.name : undefined }
    }
    return {
      quantities: [quantity, ...also].map((index) => wanted(index, order)),
      over: over === undefined ? { name: 'time', unit: units.time } : wanted(over, 0),
      known: quantities.map(({ name }) => name),
      isForUnnamed: of === this.#shownNames,
    }
  }

  /** Curves of the files for what is plotted; where a file has none, the reason is shown. */
  #measured(): Measured[] {
    const failures = this.#unread ? [this.#unread] : []
    const found = this.#files.flatMap((file) => {
      try {
        const { curves, unread } = measuredOf(file.text, file.name, this.#measuredSubject(file))
        if (unread) failures.push(unread)
        return curves
      } catch (error) {
        failures.push(messageOf(error))
        return []
      }
    })
    const failing = failures.join('. ')
    if (failing !== this.#failing) this.#failure.replaceChildren(...prose(failing))
    this.#failing = failing
    return found
  }
}

function select(testId: string, label: string, onchange: () => void, ...options: HTMLElement[]): HTMLSelectElement {
  return el('select', { 'data-testid': testId, 'aria-label': label, title: label, onchange }, ...options)
}

/** All quantities in their groups, each name after a word. */
function offered(report: Report, word = ''): HTMLElement[] {
  const plural = (group: string) => (group === 'body' ? 'bodies' : `${group}s`)
  return groups(report).map(([name, members]) =>
    el(
      'optgroup',
      { label: plural(name) },
      ...members.map(({ index, name }) => el('option', { value: index }, word + name)),
    ),
  )
}

function icon(testId: string, title: string, sign: string, onclick: () => void): HTMLButtonElement {
  return el(
    'button',
    { type: 'button', class: 'icon', 'data-testid': testId, title, 'aria-label': title, onclick },
    sign,
  )
}

function toggle(testId: string, title: string, sign: string, onclick: () => void): HTMLButtonElement {
  const button = icon(testId, title, sign, onclick)
  button.setAttribute('aria-pressed', 'false')
  return button
}
