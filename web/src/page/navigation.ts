import { el } from '../dom'
import { FRONT } from './tabs'

/** A section of a narrow screen. */
export interface Section {
  name: string
  element: HTMLElement
  /** Brings a part of the element to the front. */
  open?: () => void
}

/**
 * On a narrow screen one section at a time, chosen by a bar at the bottom, which has the help that the bar at the top
 * has no room for. Two sections may be parts of one element.
 */
export function navigation(sections: Section[], help: () => void): HTMLElement {
  const buttons = sections.map(({ name }, index) =>
    el('button', { type: 'button', 'data-testid': `nav-${name}`, onclick: () => show(index) }, name),
  )
  const show = (chosen: number) => {
    const { element: front, open } = sections[chosen]
    for (const { element } of sections) element.classList.toggle('behind', element !== front)
    buttons.forEach((button, index) => button.setAttribute('aria-pressed', String(index === chosen)))
    open?.()
    dispatchEvent(new Event(FRONT))
  }
  const [first] = sections
  for (const { element } of sections) element.classList.toggle('behind', element !== first?.element)
  buttons[0]?.setAttribute('aria-pressed', 'true')
  const asked = el(
    'button',
    { type: 'button', class: 'help-button', 'aria-label': 'keys and lines', 'data-testid': 'nav-help', onclick: help },
    '?',
  )
  return el('nav', { class: 'navigation', 'aria-label': 'Sections' }, ...buttons, asked)
}
