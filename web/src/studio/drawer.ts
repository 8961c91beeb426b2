import './drawer.css'
import { el } from '../dom'

/** A pane of the drawer. */
interface Pane {
  name: string
  title: string
  /** Content, made on first use. */
  open: () => Promise<HTMLElement>
}

/** A drawer at the side of the page that shows one pane at a time, and the buttons that open them. */
export class Drawer {
  readonly element = el('aside', { class: 'drawer', hidden: true, 'data-testid': 'drawer' })
  readonly buttons: HTMLButtonElement[]
  #open?: number

  constructor(private readonly panes: Pane[]) {
    this.buttons = panes.map(({ name, title }, index) =>
      el(
        'button',
        {
          type: 'button',
          title,
          'aria-expanded': 'false',
          'data-testid': `open-${name.toLowerCase()}`,
          onclick: () => void this.show(this.#open === index ? undefined : index),
        },
        name,
      ),
    )
    this.element.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || event.defaultPrevented || this.#open === undefined) return
      const button = this.buttons[this.#open]
      void this.show(undefined)
      button.focus()
    })
  }

  /** Shows a pane by its name. */
  open(name: string): Promise<void> {
    return this.show(this.panes.findIndex((pane) => pane.name === name))
  }

  /** Shows a pane, or none. */
  async show(index: number | undefined): Promise<void> {
    this.#open = index
    this.buttons.forEach((button, k) => button.setAttribute('aria-expanded', String(k === index)))
    document.body.classList.toggle('with-drawer', index !== undefined)
    this.element.hidden = index === undefined
    if (index === undefined) return
    const { name, open } = this.panes[index]
    const content = await open()
    if (this.#open !== index) return
    this.element.setAttribute('aria-label', name)
    const close = el(
      'button',
      {
        type: 'button',
        class: 'icon',
        'aria-label': `Close ${name}`,
        'data-testid': 'drawer-close',
        onclick: () => void this.show(undefined),
      },
      '×',
    )
    this.element.replaceChildren(el('div', { class: 'drawer-head' }, el('h2', {}, name), close), content)
  }
}
