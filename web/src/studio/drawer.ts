import './drawer.css'
import { el } from '../dom'

/** The drawer is not made narrower than this, px. */
const NARROWEST = 320

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
  /** Handle by which the drawer is made wider. */
  #edge = el('div', {
    class: 'drawer-edge',
    title: 'Drag to resize',
    'data-testid': 'drawer-edge',
    onpointerdown: (event: PointerEvent) => this.#edge.setPointerCapture(event.pointerId),
    onpointermove: (event: PointerEvent) => this.#resize(event),
  })

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

  /** Marks the button of a pane in which a study runs, whether the pane is shown or not. */
  mark(name: string, running: boolean): void {
    const index = this.panes.findIndex((pane) => pane.name === name)
    this.buttons[index].classList.toggle('running', running)
    this.buttons[index].title = running ? `${this.panes[index].title}: running` : this.panes[index].title
  }

  /** Follows the pointer with the left edge of the drawer. */
  #resize(event: PointerEvent): void {
    if (event.buttons !== 1) return
    const width = Math.max(NARROWEST, document.documentElement.clientWidth - event.clientX)
    document.body.style.setProperty('--drawer', `${width}px`)
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
    const head = el('div', { class: 'drawer-head' }, el('h2', {}, name), close)
    this.element.replaceChildren(this.#edge, head, content)
  }
}
