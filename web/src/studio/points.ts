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

/**
 * Reads rows of a spreadsheet: names with three coordinates, or coordinates alone, which are those of the hardpoints
 * from `first` on, beginning with the axis `axis`. A cell may have a unit; an empty one leaves its coordinate.
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
  let next = first
  for (const row of rows) {
    const [head, ...rest] = row
    const named = grips.find(({ name }) => name === head)
    const isText = typeof amount(head, unit) === 'string' && head !== ''
    // A line of titles, such as `name x y z`.
    if (isText && !named && rest.slice(0, 3).every((cell) => typeof amount(cell, unit) === 'string')) continue
    const grip = isText ? named : grips[next++]
    if (!grip) {
      found.problems.push(isText ? `There is no hardpoint \`${head}\`.` : 'There are more rows than hardpoints.')
      if (!isText) break
      continue
    }
    const target = place(grip)
    const numbers = isText ? rest : row
    const failed = numbers.slice(0, 3).flatMap((cell, k) => {
      const at = (isText ? 0 : axis) + k
      if (cell === '' || at > 2) return []
      const typed = amount(cell, unit)
      if (typeof typed === 'string') return [`\`${grip.name}\`, ${AXES[at]}: ${typed}`]
      target.setComponent(at, typed.value)
      return []
    })
    if (failed.length > 0) found.problems.push(...failed)
    else found.places.set(grip, target)
  }
  return found
}

/** Cells of a row: between tabs, or semicolons, or commas with spaces, or spaces. */
function cells(row: string): string[] {
  const mark = row.includes('\t') ? '\t' : row.includes(';') ? ';' : /,\s/.test(row) ? /,\s*/ : /\s+/
  const all = mark instanceof RegExp ? row.trim().split(mark) : row.split(mark)
  return all.map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'))
}

/** Table of all hardpoints, which can be edited and takes rows of a spreadsheet. */
export class PointsPane {
  readonly element = el('section', { class: 'points', 'aria-label': 'Hardpoints', 'data-testid': 'points' })
  #mover?: Mover
  #rows: { grip: MovableHardpoint; fields: NumberField[]; change: HTMLElement }[] = []
  #news = el('p', { class: 'news', role: 'status', 'data-testid': 'points-news' })

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
    this.#news.replaceChildren(...prose([set, ...problems].join(' ')))
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
      this.#news.textContent = 'Copied.'
    } catch {
      this.#news.textContent = 'The browser does not allow copying here.'
    }
  }
}
