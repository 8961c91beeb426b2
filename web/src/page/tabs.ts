import { el } from '../dom'

export interface Tab {
  name: string
  title: string
  content: HTMLElement
}

/** Panels of which one is shown; arrow keys go from tab to tab. */
export function tabs(label: string, list: Tab[]): HTMLElement {
  const buttons = list.map(({ name, title }, index) =>
    el(
      'button',
      {
        type: 'button',
        role: 'tab',
        id: `tab-${name}`,
        'aria-controls': `panel-${name}`,
        'data-testid': `tab-${name}`,
        onclick: () => show(index),
        onkeydown: (event: KeyboardEvent) => {
          const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key]
          if (!by) return
          const next = (index + by + list.length) % list.length
          show(next)
          buttons[next].focus()
        },
      },
      title,
    ),
  )
  const panels = list.map(({ name, content }) =>
    el(
      'div',
      { role: 'tabpanel', id: `panel-${name}`, 'aria-labelledby': `tab-${name}`, class: 'panel', tabindex: 0 },
      content,
    ),
  )
  const show = (chosen: number) => {
    buttons.forEach((button, index) => {
      button.setAttribute('aria-selected', String(index === chosen))
      button.tabIndex = index === chosen ? 0 : -1
    })
    panels.forEach((panel, index) => panel.classList.toggle('away', index !== chosen))
  }
  show(0)
  return el(
    'section',
    { class: 'tabs', 'aria-label': label },
    el('div', { role: 'tablist', 'aria-label': label }, ...buttons),
    ...panels,
  )
}
