import { el } from '../dom'
import type { State } from '../state'

/** Something that can be found by its name. */
interface Entry {
  name: string
  about: string
  choose: () => void
}

/** More matches than this are not listed. */
const SHOWN = 12

/** A field that finds quantities and variables by parts of their names, and selects them. */
export function find(state: State): { element: HTMLElement; focus: () => void } {
  const { report } = state
  const entries: Entry[] = [
    ...report.quantities.map(({ name, group, index }) => ({
      name,
      about: group,
      choose: () => state.choose({ quantity: index }),
    })),
    ...report.variables.map(({ name, index }) => ({
      name,
      about: 'variable',
      choose: () => state.choose({ variable: index }),
    })),
  ]
  let matches: Entry[] = []
  let active = 0
  const list = el('ul', { class: 'matches', role: 'listbox', id: 'matches', hidden: true })
  const input = el('input', {
    type: 'search',
    placeholder: 'Find  /',
    role: 'combobox',
    'aria-label': 'Find a quantity or a variable',
    'aria-controls': 'matches',
    'aria-expanded': 'false',
    'aria-autocomplete': 'list',
    autocomplete: 'off',
    'data-testid': 'find',
    oninput: () => ((active = 0), show()),
    onfocus: () => show(),
    onblur: () => close(),
    onkeydown: (event: KeyboardEvent) => {
      const by = { ArrowDown: 1, ArrowUp: -1 }[event.key]
      if (by && matches.length > 0) active = (active + by + matches.length) % matches.length
      else if (event.key === 'Enter') return take(matches[active])
      else if (event.key === 'Escape') return input.blur()
      else return
      event.preventDefault()
      show()
    },
  })
  const close = () => {
    list.hidden = true
    input.setAttribute('aria-expanded', 'false')
    input.removeAttribute('aria-activedescendant')
  }
  const take = (entry: Entry | undefined) => {
    if (!entry) return
    entry.choose()
    input.value = ''
    input.blur()
  }
  const show = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean)
    matches = words.length === 0 ? [] : entries.filter(({ name }) => hasWords(name, words)).slice(0, SHOWN)
    list.replaceChildren(...matches.map((entry, k) => option(entry, k, k === active, () => take(entry))))
    if (words.length > 0 && matches.length === 0) list.replaceChildren(el('li', { class: 'muted' }, 'no matches'))
    list.hidden = words.length === 0
    input.setAttribute('aria-expanded', String(!list.hidden))
    if (matches.length > 0) input.setAttribute('aria-activedescendant', `match-${active}`)
    else input.removeAttribute('aria-activedescendant')
  }
  return { element: el('div', { class: 'find' }, input, list), focus: () => input.focus() }
}

function hasWords(name: string, words: string[]): boolean {
  return words.every((word) => name.toLowerCase().includes(word))
}

/** A match in the list; the field keeps the focus until the click is done. */
function option({ name, about }: Entry, index: number, isActive: boolean, take: () => void): HTMLElement {
  return el(
    'li',
    {
      role: 'option',
      id: `match-${index}`,
      'aria-selected': String(isActive),
      onpointerdown: (event: Event) => event.preventDefault(),
      onclick: take,
    },
    el('span', {}, name),
    el('span', { class: 'muted' }, about),
  )
}
