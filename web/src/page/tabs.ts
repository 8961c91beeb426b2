import { el } from '../dom'

export interface Tab {
  name: string
  title: string
  content: HTMLElement
}

/** Panels behind tabs. */
export interface Tabs {
  element: HTMLElement
  /** Name of the shown panel. */
  readonly shown: string
  /** Shows a panel by its name, if there is one. */
  show(name: string): void
}

/** Screens with one section at a time, as in the style sheet. */
const NARROW = '(max-width: 700px), (max-height: 500px)'
/** Event of the page when another panel or section is selected. */
export const FRONT = 'front'

/** Panels of which one is shown; arrow keys go from tab to tab. */
export function tabs(label: string, list: Tab[]): Tabs {
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
    front = chosen
    dispatchEvent(new Event(FRONT))
  }
  let front = 0
  show(0)
  const element = el(
    'section',
    { class: 'tabs', 'aria-label': label },
    el('h2', { class: 'hidden' }, label),
    el('div', { role: 'tablist', 'aria-label': label }, ...buttons),
    ...panels,
  )
  return {
    element,
    get shown() {
      return list[front].name
    },
    show: (name) => {
      const index = list.findIndex((tab) => tab.name === name)
      if (index >= 0) show(index)
    },
  }
}

/**
 * Renders the content of a tab whenever `listen` calls back while it is seen, and else when it is selected or is
 * printed: what is not seen costs nothing while a point is dragged.
 */
export function whileSeen(
  content: HTMLElement,
  listen: (render: () => void) => void,
  render: () => void,
  signal: AbortSignal,
): void {
  let stale = false
  const update = () => {
    const hidden = matchMedia(NARROW).matches ? '.away, .behind' : '.away'
    stale = content.closest(hidden) !== null && !document.documentElement.classList.contains('printing')
    if (!stale) render()
  }
  const catchUp = () => {
    if (stale) update()
  }
  listen(update)
  for (const event of [FRONT, 'beforeprint']) addEventListener(event, catchUp, { signal })
}
