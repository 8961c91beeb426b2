import './points.css'
import { Vector3 } from 'three'
import { amount, entry } from '../amount'
import { el, prose } from '../dom'
import type { MovableHardpoint } from '../engine/protocol'
import { number, pretty } from '../format'
import { NumberField } from '../page/number_field'
import type { Mover } from './mover'
import { AXES } from './moves'

/** Hardpoints and positions that a pasted table sets; `problems` are sentences on rows that are left out. */
export interface PastedTable {
  places: Map<MovableHardpoint, Vector3>
  problems: string[]
}

/** Titles of the column with the names of hardpoints. */
const NAMES = ['name', 'hardpoint', 'point']

/** Columns of a pasted table, by its lines of titles and units. */
interface Heading {
  /** Column with the names of the hardpoints. */
  name?: number
  /** Axes by their columns; empty where no title names an axis. */
  axes: ReadonlyMap<number, number>
  unit?: string
}

/**
 * Reads rows of a spreadsheet: names with three coordinates, or coordinates alone, which are those of the hardpoints
 * from `first` on, beginning with the axis `axis`. Titles name the columns in any order; titles or a line below them
 * may have a unit. A cell may have its own unit; an empty one leaves its coordinate.
 */
export function pasted(
  text: string,
  grips: readonly MovableHardpoint[],
  place: (grip: MovableHardpoint) => Vector3,
  unit: string,
  { first, axis }: { first: number; axis: number },
): PastedTable {
  const found: PastedTable = { places: new Map(), problems: [] }
  const rows = text
    .split(/\r?\n/)
    .map((row) => cells(row))
    .filter((row) => row.some((cell) => cell !== ''))
  const isText = (cell: string) => cell !== '' && typeof amount(cell, unit) === 'string'
  let heading: Heading = { axes: new Map() }
  let next = first
  for (const row of rows) {
    const at = heading.axes.size > 0 ? heading.name : isText(row[0]) ? 0 : undefined
    const head = at === undefined ? '' : (row[at] ?? '')
    const named = grips.find(({ name }) => name === head)
    if (!named && row.slice(0, 4).every((cell) => cell === '' || isText(cell))) {
      const read = headingOf(row, heading, unit)
      if (typeof read === 'string') {
        found.problems.push(read)
        break
      }
      heading = read ?? heading
      // Other words, such as the title of a group of rows, have no effect.
      if (read || head !== '') continue
    }
    const grip = at === undefined ? grips[next++] : named
    if (!grip) {
      found.problems.push(
        at === undefined
          ? 'There are more rows than hardpoints.'
          : head === ''
            ? 'A row has no name.'
            : `There is no hardpoint \`${head}\`.`,
      )
      if (at === undefined) break
      continue
    }
    const target = place(grip)
    const start = at === undefined ? [0, axis] : [1, 0]
    const columns = heading.axes.size > 0 ? [...heading.axes] : [0, 1, 2].map((k) => [start[0] + k, start[1] + k])
    const failed = columns.flatMap(([column, axis]) => {
      const cell = row[column] ?? ''
      if (cell === '' || axis > 2) return []
      const typed = amount(cell, unit, heading.unit)
      if (typeof typed === 'string') return [`\`${grip.name}\`, ${AXES[axis]}: ${typed}`]
      target.setComponent(axis, typed.value)
      return []
    })
    if (failed.length > 0) found.problems.push(...failed)
    else found.places.set(grip, target)
  }
  return found
}

/**
 * Columns by a row of titles, or with the unit of a row of units; undefined for a row that has neither, and a sentence
 * where its units cannot be used.
 */
function headingOf(row: readonly string[], former: Heading, unit: string): Heading | string | undefined {
  const titles = row.map((cell) => titleOf(cell))
  const axes = new Map(
    titles.flatMap(({ name }, k) => AXES.flatMap((axis, index) => (axis === name ? [[k, index] as const] : []))),
  )
  const columns = axes.size > 0 ? axes : former.axes
  const coordinates = (columns.size > 0 ? [...columns.keys()] : [1, 2, 3]).flatMap((k) => titles[k] ?? [])
  const units = coordinates.map(
    ({ name, unit }) => unit ?? (axes.size === 0 && /^\p{L}+$/u.test(name) ? name : undefined),
  )
  const [written] = units
  const isSame = units.every((one) => one === written)
  if (axes.size === 0) {
    // Without titles of axes, different words are titles of other kinds.
    const isOfUnits = units.length >= (columns.size || 2) && !units.includes(undefined) && (isSame || columns.size > 0)
    if (!isOfUnits) return undefined
  }
  if (!isSame) return `The coordinates have different units: ${units.map((one) => one ?? 'none').join(', ')}.`
  const wrong = written === undefined ? undefined : amount('1', unit, written)
  if (typeof wrong === 'string') return wrong
  if (axes.size === 0) {
    if (former.unit !== undefined && former.unit !== written)
      return `The unit \`${written}\` below the titles contradicts \`${former.unit}\` in them.`
    return { ...former, unit: written }
  }
  const titled = titles.findIndex(({ name }) => NAMES.includes(name))
  const others = titles.findIndex((_, k) => !axes.has(k))
  const name = titled >= 0 ? titled : others
  return { name: name >= 0 ? name : undefined, axes, unit: written }
}

/** `x` and `mm` of the title `# X [mm]`; the unit has no capitals either. */
function titleOf(cell: string): { name: string; unit?: string } {
  const [name, unit = ''] = cell.toLowerCase().replace(/^#/, '').split(/[[(]/, 2)
  return { name: name.trim(), unit: unit.replace(/[\])]\s*$/, '').trim() || undefined }
}

/** Cells of a row: between tabs, or semicolons, or commas with spaces, or spaces other than those before a unit. */
function cells(row: string): string[] {
  const mark = row.includes('\t') ? '\t' : row.includes(';') ? ';' : /,\s/.test(row) ? /,\s*/ : /\s+(?![[(])/
  const all = mark instanceof RegExp ? row.trim().split(mark) : row.split(mark)
  return all.map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'))
}

/** Table of all hardpoints, which can be edited and takes rows of a spreadsheet. */
export class PointsPane {
  readonly element = el('section', { class: 'points', 'aria-label': 'Hardpoints', 'data-testid': 'points' })
  #mover?: Mover
  #rows: { grip: MovableHardpoint; fields: NumberField[]; change: HTMLElement }[] = []
  #said = el('span')
  #shortfall = el('span', { class: 'shortfall' })
  #news = el('p', { class: 'news', role: 'status', 'data-testid': 'points-news' }, this.#said, this.#shortfall)

  constructor(
    /** Called when a change is complete. */
    private readonly onRelease: () => void,
  ) {}

  /** Shows the present design. */
  show(mover: Mover | undefined): void {
    if (!mover) return this.element.replaceChildren(el('p', { class: 'muted' }, 'The solver is not available.'))
    if (mover !== this.#mover) this.#make(mover)
    for (const { grip, fields, change } of this.#rows) {
      const place = mover.place(grip)
      const by = place.clone().sub(new Vector3(...grip.place))
      fields.forEach((field, k) => {
        field.show(place.getComponent(k))
        field.input.classList.toggle('changed', mover.differ(by.getComponent(k), 0))
      })
      change.textContent = mover.differ(by.length(), 0) ? number(by.length(), 4) : ''
    }
    this.#shortfall.replaceChildren(...prose(mover.state.shortfall))
  }

  #make(mover: Mover): void {
    this.#mover = mover
    const unit = mover.state.report.units.length
    this.#rows = mover.grips.map((grip) => this.#row(mover, grip, unit))
    const mirror = el('input', {
      type: 'checkbox',
      checked: mover.mirror?.on,
      onchange: () => (mover.mirror!.on = mirror.checked),
    })
    const copy = el(
      'button',
      { type: 'button', 'data-testid': 'points-copy', onclick: () => void this.#copy() },
      'Copy',
    )
    const body = el(
      'tbody',
      {},
      ...this.#rows.map(({ grip, fields, change }) =>
        el(
          'tr',
          { 'data-testid': `point-${grip.name}` },
          el('th', { scope: 'row', title: grip.name }, grip.name),
          ...fields.map(({ input }) => el('td', {}, input)),
          change,
        ),
      ),
    )
    this.element.replaceChildren(
      el(
        'div',
        { class: 'acts' },
        el('span', { class: 'muted' }, `Coordinates in ${pretty(unit)}. Paste rows of a spreadsheet into any cell.`),
        copy,
        mover.mirror && el('label', { class: 'mirror' }, mirror, 'mirror edits to the other side'),
      ),
      this.#news,
      el(
        'table',
        { onpaste: (event: ClipboardEvent) => this.#paste(event) },
        el(
          'thead',
          {},
          el('tr', {}, ...['hardpoint', 'x', 'y', 'z', 'moved'].map((name) => el('th', { scope: 'col' }, name))),
        ),
        body,
      ),
    )
  }

  #row(mover: Mover, grip: MovableHardpoint, unit: string) {
    const fields = AXES.map(
      (axis, k) =>
        new NumberField({
          label: `${axis} of ${grip.name} in ${unit}`,
          unit,
          step: 1,
          plus: 'adds',
          apply: (value) => {
            this.#said.replaceChildren()
            mover.move(grip, mover.place(grip).setComponent(k, value))
            this.onRelease()
            return mover.state.bound || undefined
          },
        }),
    )
    return { grip, fields, change: el('td', { class: 'change' }) }
  }

  #paste(event: ClipboardEvent): void {
    const mover = this.#mover
    const text = event.clipboardData?.getData('text/plain') ?? ''
    // A single cell is for the field that it is pasted into.
    if (!mover || !/[\t\n;]/.test(text.trim())) return
    event.preventDefault()
    const cell = event.target as HTMLElement
    const first = Math.max(
      0,
      this.#rows.findIndex(({ fields }) => fields.some(({ input }) => input === cell)),
    )
    const axis = Math.max(
      0,
      this.#rows[first].fields.findIndex(({ input }) => input === cell),
    )
    const unit = mover.state.report.units.length
    const { places, problems } = pasted(text, mover.grips, (grip) => mover.place(grip), unit, { first, axis })
    mover.moveAll(places)
    this.onRelease()
    const set = `${places.size} ${places.size === 1 ? 'hardpoint' : 'hardpoints'} set.`
    const bound = mover.state.bound && `${mover.state.bound}.`
    const sentences = [set, ...(bound ? [bound] : []), ...problems]
    this.#said.replaceChildren(...prose(sentences.map((sentence) => `${sentence} `).join('')))
    this.show(mover)
  }

  async #copy(): Promise<void> {
    const mover = this.#mover
    if (!mover) return
    const rows = mover.grips.map((grip) => [
      grip.name,
      ...mover
        .place(grip)
        .toArray()
        .map((x) => entry(x, 10)),
    ])
    try {
      await navigator.clipboard.writeText(rows.map((row) => row.join('\t')).join('\n'))
      this.#said.textContent = 'Copied. '
    } catch {
      this.#said.textContent = 'The browser does not allow copying here. '
    }
  }
}
