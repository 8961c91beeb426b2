import { el } from '../dom'
import { messageOf } from '../format'

/** An entry of a menu. */
export interface Item {
  name: string
  testId: string
  run: () => void | Promise<void>
}

/** Entries in one row after the name of what they share. */
export interface ItemRow {
  name: string
  items: Item[]
}

/** A button that opens a list of actions; errors are shown in place of the list until the reader goes on. */
export function menu(title: string, testId: string, entries: () => (Item | ItemRow)[]): HTMLElement {
  const list = el('div', {
    class: 'menu',
    role: 'menu',
    'aria-label': title,
    'data-testid': `${testId}-menu`,
    hidden: true,
  })
  const failure = el('p', { class: 'failure', role: 'alert', hidden: true })
  const button = el(
    'button',
    {
      type: 'button',
      'aria-haspopup': 'menu',
      'aria-expanded': 'false',
      'data-testid': testId,
      onclick: () => (list.hidden ? open() : close()),
    },
    `${title} ▾`,
  )
  const element = el('div', { class: 'dropdown' }, button, list, failure)
  const open = () => {
    failure.hidden = true
    list.replaceChildren(...entries().map((entry) => ('items' in entry ? row(entry) : itemButton(entry, entry.name))))
    list.hidden = false
    button.setAttribute('aria-expanded', 'true')
    list.querySelector('button')?.focus()
  }
  const itemButton = ({ name, testId, run }: Item, label: string) =>
    el(
      'button',
      {
        type: 'button',
        role: 'menuitem',
        tabindex: -1,
        'data-testid': testId,
        'aria-label': label === name ? undefined : label,
        onclick: () => start(label, run),
      },
      name,
    )
  const row = ({ name, items }: ItemRow) =>
    el(
      'div',
      { class: 'menu-row', role: 'group', 'aria-label': name },
      el('span', { title: name, 'aria-hidden': 'true' }, name),
      ...items.map((item) => itemButton(item, `${name} as ${item.name}`)),
    )
  const close = () => {
    list.hidden = true
    button.setAttribute('aria-expanded', 'false')
  }
  const start = async (name: string, run: Item['run']) => {
    close()
    button.focus()
    try {
      await run()
    } catch (error) {
      failure.textContent = `${name}: ${messageOf(error)}`
      failure.hidden = false
      const shown = new AbortController()
      const hide = ({ target }: Event) => {
        if (element.contains(target as Node)) return
        failure.hidden = true
        shown.abort()
      }
      for (const event of ['pointerdown', 'keydown']) addEventListener(event, hide, { signal: shown.signal })
    }
  }
  element.addEventListener('keydown', (event) => {
    const buttons = [...list.querySelectorAll('button')]
    const at = buttons.indexOf(document.activeElement as HTMLButtonElement)
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key]
    if (list.hidden) return
    if (event.key === 'Escape') close(), button.focus()
    else if (to !== undefined) buttons.at(to % buttons.length)?.focus()
    else return
    event.preventDefault()
  })
  element.addEventListener('focusout', (event) => {
    if (!element.contains(event.relatedTarget as Node | null)) close()
  })
  return element
}
