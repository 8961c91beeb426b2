import { amount } from '../amount'
import { el, prose, setText } from '../dom'
import { number, titled } from '../format'
import { abscissaOf, type Content, drawnLines, drawnSteps, type Line } from '../content'
import { type Course, crossings, type Curve, peak } from '../curve'
import { extent, linearAxis } from '../export/axis'
import { rounded } from '../rounding'

/** Approximate number of rows at first. */
const ROWS = 6
/** Number of values of one curve at one abscissa that are listed. */
const MOST = 4

/** Values of all curves of a plot at chosen abscissas. */
export class ValueTable {
  readonly element: HTMLElement
  #field = el('input', {
    type: 'text',
    'data-testid': 'abscissas',
    'aria-label': 'abscissas of the table, separated by spaces or semicolons',
    title: 'Separated by spaces or semicolons, such as 1/8; 2 in',
    onchange: () => this.#change(),
  })
  #name = el('span')
  #head = el('thead')
  #body = el('tbody')
  #note = el('p', { class: 'caption', 'data-testid': 'values-note' })
  #failure = el('p', { class: 'caption missed', role: 'alert', 'data-testid': 'abscissas-wrong', hidden: true })
  #chosen?: number[]
  #shown?: { content: Content; times: Curve; time: string }

  constructor() {
    const label = el('label', { class: 'field' }, this.#name, this.#field)
    const table = el('table', { class: 'numbers' }, this.#head, this.#body)
    const parts = [label, this.#failure, table, this.#note]
    this.element = el('div', { class: 'value-table', hidden: true, 'data-testid': 'value-table' }, ...parts)
  }

  /** The abscissas that the reader chose; undefined for round ones. */
  get abscissas(): number[] | undefined {
    return this.#chosen
  }

  set abscissas(chosen: number[] | undefined) {
    this.#chosen = chosen
    if (this.#shown) this.show(this.#shown.content, this.#shown.times, this.#shown.time)
  }

  show(content: Content, times: Curve, time: string): void {
    // Numbers of another abscissa are of no use here.
    if (this.#shown && this.#shown.content.over?.label !== content.over?.label) this.#chosen = undefined
    this.#shown = { content, times, time }
    if (this.element.hidden) return
    const lines = drawnLines(content)
    const name = content.over ? titled(content.over.label, content.over.unit) : titled('time', time)
    const at = this.#chosen ?? this.#round(content.over?.curve ?? times)
    setText(this.#name, `Values at ${name}`)
    if (document.activeElement !== this.#field && this.#failure.hidden)
      this.#field.value = at.map((value) => number(value)).join('  ')
    const cell = (text: string) => el('td', { class: 'figure' }, text)
    const header = [name, ...lines.map(({ label }) => label)]
    this.#head.replaceChildren(el('tr', {}, ...header.map((text) => el('th', { scope: 'col' }, text))))
    const courses = lines.map((line) => courseOf(line, content, times))
    let isSeveral = false
    this.#body.replaceChildren(
      ...at.map((x) => {
        const cells = lines.map((line, k) => {
          const found = valuesAt(line, content, times, x, courses[k])
          isSeveral ||= found.length > 1
          return cell(found.length > MOST ? `${found.slice(0, MOST).join('; ')}; …` : found.join('; ') || number(NaN))
        })
        return el('tr', {}, el('th', { scope: 'row' }, number(x)), ...cells)
      }),
    )
    const linear = lines.filter((line) => !line.course).map(({ label }) => label)
    const notes = [
      isSeveral && 'Several values: in the order of the motion.',
      linear.length > 0 && `Linear between output times: ${linear.join(', ')}.`,
    ]
    setText(this.#note, notes.filter(Boolean).join(' '))
  }

  #round(curve: Curve): number[] {
    const [low, high] = extent([curve]) ?? [0, 0]
    return low < high ? linearAxis([low, high], 0, 1, ROWS).ticks.map(({ value }) => value) : [low]
  }

  #change(): void {
    const { content, time } = this.#shown ?? {}
    const read = entries(this.#field.value).map((word) => abscissa(word, content?.over?.unit ?? time ?? ''))
    const wrong = read.find((one) => typeof one === 'string')
    this.#failure.hidden = wrong === undefined
    this.#failure.replaceChildren(...prose(String(wrong ?? '')))
    if (wrong !== undefined) return
    this.#field.blur()
    this.abscissas = read.length > 0 ? (read as number[]) : undefined
  }
}

/** Entries of a list: between semicolons, or else words, each with its unit. */
function entries(text: string): string[] {
  if (text.includes(';')) return text.split(';').filter((entry) => entry.trim() !== '')
  return text
    .trim()
    .replace(/\s+(?=[\p{L}°])/gu, '')
    .split(/\s+/)
    .filter(Boolean)
}

/** A number of a list; a sentence where it is none. */
function abscissa(word: string, unit: string): number | string {
  const read = amount(word, unit)
  if (typeof read === 'string') return read
  return read.form === 'step' ? `\`${word.trim()}\` is a step, and the table needs a value.` : read.value
}

function courseOf(line: Line, content: Content, times: Curve): { y: Course; x: Course } {
  const { y, x } = line.course?.() ?? { y: [line.curve] }
  return { y, x: x ?? [abscissaOf(line, content, times)] }
}

/** Different values of a line at an abscissa, as they are shown. */
function valuesAt(
  line: Line,
  content: Content,
  times: Curve,
  x: number,
  { y, x: xs }: ReturnType<typeof courseOf>,
): string[] {
  const found = crossings(xs, y, line.free ? xs[0] : times, x, drawnSteps(line, content, times))
  const scale = Math.max(1, peak(line.curve))
  return [...new Set(found.map((value) => number(rounded(value, scale), 4)))]
}
