import { el, prose } from './dom'
import type { Payload, Table } from './payload'

/** Tables up to this long are open from the start. */
const SHORT = 12

type Head = Pick<Payload, 'title' | 'description' | 'file' | 'generator' | 'status' | 'summary' | 'notes'>

export function header({ title, description, file, generator, status, summary, notes }: Head): HTMLElement {
  return el(
    'header',
    {},
    el('div', { class: 'line' }, el('h1', {}, title), el('p', { class: 'origin' }, el('code', {}, file), ` · ${generator}`)),
    description !== '' && el('p', { class: 'lead' }, description),
    status.complete
      ? el('p', { class: 'status', 'data-testid': 'status' }, ...prose(status.message))
      : el(
          'p',
          { class: 'status partial', role: 'status', 'data-testid': 'status' },
          el('strong', {}, 'This motion is incomplete. '),
          ...prose(status.message),
        ),
    el(
      'dl',
      { class: 'summary', 'data-testid': 'summary' },
      ...summary.map(({ label, value }) => el('div', {}, el('dt', {}, label), el('dd', {}, value))),
    ),
    notes.length > 0 &&
      el('ul', { class: 'notes', 'data-testid': 'notes' }, ...notes.map((note) => el('li', {}, ...prose(note)))),
  )
}

export function checks(tables: Table[]): HTMLElement {
  return el(
    'section',
    { class: 'checks', 'data-testid': 'checks' },
    el('h2', {}, 'About the model'),
    ...tables.map((table) =>
      el(
        'details',
        { open: table.rows.length <= SHORT },
        el('summary', {}, table.title, el('span', { class: 'count' }, String(table.rows.length))),
        table.note !== '' && el('p', { class: 'lead' }, ...prose(table.note)),
        el('div', { class: 'scroll', tabindex: 0 }, el(
          'table',
          {},
          el('thead', {}, el('tr', {}, ...table.header.map((cell) => el('th', { scope: 'col' }, cell)))),
          el('tbody', {}, ...table.rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, ...prose(cell)))))),
        )),
      ),
    ),
  )
}
