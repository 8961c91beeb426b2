import { el } from '../dom'

/**
 * On a narrow screen one section at a time, chosen by a bar at the bottom, which has the help that the bar at the top
 * has no room for.
 */
export function navigation(sections: { name: string; element: HTMLElement }[], help: () => void): HTMLElement {
  const buttons = sections.map(({ name }, index) =>
    el('button', { type: 'button', 'data-testid': `nav-${name}`, onclick: () => show(index) }, name),
  )
  const show = (chosen: number) => {
    sections.forEach(({ element }, index) => element.classList.toggle('behind', index !== chosen))
    buttons.forEach((button, index) => button.setAttribute('aria-pressed', String(index === chosen)))
  }
  show(0)
  const asked = el(
    'button',
    { type: 'button', class: 'help-button', 'aria-label': 'keys and lines', 'data-testid': 'nav-help', onclick: help },
    '?',
  )
  return el('nav', { class: 'navigation', 'aria-label': 'Sections' }, ...buttons, asked)
}
