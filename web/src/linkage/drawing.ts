import '../editor/editor.css'
import { el, prose, svg } from '../dom'
import { messageElements } from '../editor/messages'
import { RequestError } from '../engine/answer'
import type { Diagnostic } from '../engine/engine'
import { messageOf, roundBelow } from '../format'
import { NumberField } from '../page/number_field'
import { Backdrop, type Picture } from './backdrop'
import {
  changed,
  EMPTY,
  lacking,
  type Linkage,
  linkageToml,
  length,
  type Pin,
  type Place,
  renamed,
  withBar,
  withCorner,
  withoutBar,
  withoutPin,
  withPin,
} from './linkage'

/** Services of the page for a drawing. */
export interface Host {
  unit: string
  picture: Picture
  check(text: string): Promise<Diagnostic[]>
  /** Solves and shows a text; throws where that fails. */
  show(text: string): Promise<void>
}

/** Meaning of a click on the sheet. */
const TOOLS = {
  bar: ['Bars', 'Click places or joints in turn: bars between them. Click a bar, then a place: a plate'],
  ground: ['Fixed pivot', 'Click a joint: it is fixed to the ground, or no longer'],
  slider: ['Slider', 'Click a joint: it slides along the ground, or no longer'],
  motor: ['Motor', 'Click a fixed pivot or a slider: it is driven, or no longer'],
  select: ['Select', 'Click a joint or a bar to name, place or delete it'],
} as const
type Tool = keyof typeof TOOLS

const SUPPORTS = { free: 'between bars', ground: 'fixed pivot', slider: 'slider' } as const

/** Width of an empty sheet, in the unit of length. */
const WIDTH = 400
/** Resolution of a click, and distance of the lines of the grid, px. */
const FINE = 4
const GRID = 80
/** A hand that moves by less has clicked, px. */
const TREMBLE = 4
/** Room round what is fitted, as a part of it. */
const ROOM = 1.25
/** Least and largest scale, px per unit of length. */
const SCALES = [1e-4, 1e4] as const
const ZOOM = 1.0015
/** Milliseconds without a change after which the text is checked. */
const PAUSE = 200
/** Digits of a coordinate. */
const DIGITS = 12

/** The selected joint or bar. */
type Chosen = { kind: 'pin' | 'bar'; name: string }

/** A sheet over the view on which a planar linkage is drawn, and its pane; its result is the text of a model. */
export class Drawing {
  readonly element: HTMLElement
  readonly pane: HTMLElement
  #linkage: Linkage = EMPTY
  #past: Linkage[] = []
  #future: Linkage[] = []
  /** Changes of one kind in a row are one step. */
  #gesture?: string
  #tool: Tool = 'bar'
  #chosen?: Chosen
  /** The joint that the next bar begins at. */
  #from?: string
  /** Place of the pointer, for the bar that is being drawn. */
  #pointer?: Place
  #middle: Place = [WIDTH / 4, WIDTH / 8]
  #scale = 2
  #messages: Diagnostic[] = []
  /** Reason why the last input changed nothing, shown until the next input even if a check ends meanwhile. */
  #refusal?: string
  #checked = ''
  #waiting?: ReturnType<typeof setTimeout>
  #backdrop: Backdrop
  #lines = svg('svg', { class: 'guide', 'aria-hidden': 'true' })
  #size = el('span', { class: 'linkage-scale' })
  #pins = new Map<string, HTMLButtonElement>()
  #bars = new Map<string, HTMLButtonElement>()
  #tools: [Tool, HTMLButtonElement][]
  #hint = el('output', { class: 'linkage-hint', 'data-testid': 'linkage-hint' })
  #list = el('ul', {
    class: 'model-messages',
    'aria-label': 'Messages about the linkage',
    'data-testid': 'linkage-messages',
  })
  #details = el('div', { class: 'linkage-details', 'data-testid': 'linkage-details' })
  #undo: HTMLButtonElement
  #redo: HTMLButtonElement
  #show: HTMLButtonElement
  /** Key of the fields that are shown. */
  #fields = ''
  #refresh = () => {}

  constructor(private readonly host: Host) {
    const button = (name: string, title: string, testId: string, run: () => void) =>
      el('button', { type: 'button', title, 'data-testid': `linkage-${testId}`, onclick: run }, name)
    this.#undo = button('Undo', 'Undo (Ctrl+Z)', 'undo', () => this.#step(this.#past, this.#future))
    this.#redo = button('Redo', 'Redo (Ctrl+Y)', 'redo', () => this.#step(this.#future, this.#past))
    this.#show = button('Show its motion', 'Write the model, and solve it', 'show', () => void this.#finish())
    this.#show.classList.add('first')
    this.#tools = Object.entries(TOOLS).map(([tool, [name, title]]) => [
      tool as Tool,
      button(name, title, tool, () => this.#use(tool as Tool)),
    ])
    this.element = el(
      'div',
      {
        class: 'linkage-sheet',
        hidden: true,
        role: 'application',
        tabindex: -1,
        'aria-label': 'Sheet for a linkage',
        'data-testid': 'linkage-sheet',
        onpointerdown: (event: PointerEvent) => this.#press(event),
        onpointermove: (event: PointerEvent) => this.#hover(event),
        onwheel: (event: WheelEvent) => this.#zoom(event),
      },
      this.#lines,
      this.#size,
      el(
        'div',
        { class: 'linkage-over' },
        el(
          'div',
          { class: 'linkage-tools', role: 'toolbar', 'aria-label': 'Tools' },
          ...this.#tools.map(([, one]) => one),
        ),
        this.#hint,
        this.#list,
      ),
    )
    const surface = {
      element: this.element,
      unit: host.unit,
      project: (place: Place) => this.#screen(place),
      seen: () => ({ middle: this.#middle, size: this.#extent.map((px) => px / this.#scale) as Place }),
      fit: (corners: Place[]) => this.#fit(corners),
    }
    this.#backdrop = new Backdrop(surface, host.picture)
    this.pane = el(
      'section',
      { class: 'measuring linkage-pane', hidden: true, 'aria-label': 'Linkage', 'data-testid': 'linkage-pane' },
      this.#details,
      el(
        'div',
        { class: 'linkage-tools' },
        button('Add joint', 'A joint in the middle of the sheet', 'add', () => this.#add(this.#rounded(this.#middle))),
        this.#undo,
        this.#redo,
        button('Clear', 'Remove all', 'clear', () => this.#set(EMPTY)),
        button('Fit', 'Show all', 'fit', () => this.#fit([])),
        this.#show,
        button('Close', 'Back to the model; the drawing is kept', 'close', () => this.toggle()),
      ),
      this.#backdrop.tools,
    )
    addEventListener('keydown', (event) => this.#key(event), { capture: true })
    new ResizeObserver(() => this.#draw()).observe(this.element)
    this.#use('bar')
  }

  get on(): boolean {
    return !this.pane.hidden
  }

  toggle(): void {
    this.pane.hidden = this.element.hidden = this.on
    this.#from = this.#chosen = undefined
    this.#render()
    if (this.on) this.element.focus()
  }

  get #text(): string {
    return linkageToml(this.#linkage, this.host.unit)
  }

  get #extent(): Place {
    return [this.element.clientWidth, this.element.clientHeight]
  }

  #screen([x, y]: Place): { x: number; y: number } {
    const [width, height] = this.#extent
    return { x: width / 2 + (x - this.#middle[0]) * this.#scale, y: height / 2 - (y - this.#middle[1]) * this.#scale }
  }

  #place({ clientX, clientY }: { clientX: number; clientY: number }): Place {
    const { left, top } = this.element.getBoundingClientRect()
    const [width, height] = this.#extent
    return [
      this.#middle[0] + (clientX - left - width / 2) / this.#scale,
      this.#middle[1] - (clientY - top - height / 2) / this.#scale,
    ]
  }

  /** A round number below a number of pixels, in the unit of length. */
  #round(px: number): number {
    return roundBelow(px / this.#scale)
  }

  #rounded(place: Place): Place {
    const by = this.#round(FINE)
    return place.map((x) => Number((Math.round(x / by) * by).toPrecision(DIGITS))) as Place
  }

  #pin(name: string | undefined): Pin | undefined {
    return this.#linkage.pins.find((pin) => pin.name === name)
  }

  /** Makes another linkage the present one; steps of the same gesture are one. */
  #set(linkage: Linkage, gesture?: string): void {
    if (linkage === this.#linkage) return this.#render()
    if (gesture === undefined || gesture !== this.#gesture) this.#past.push(this.#linkage)
    this.#gesture = gesture
    this.#future = []
    this.#linkage = linkage
    this.#render()
  }

  #step(from: Linkage[], to: Linkage[]): void {
    const linkage = from.pop()
    if (!linkage) return
    to.push(this.#linkage)
    this.#linkage = linkage
    this.#gesture = this.#from = undefined
    this.#render()
  }

  #use(tool: Tool): void {
    this.#tool = tool
    this.#from = undefined
    this.#render()
  }

  /** A click on a free place. */
  #add(place: Place): void {
    const made = withPin(this.#linkage, place)
    const { name } = made.pins.at(-1)!
    const { kind, name: bar } = this.#chosen ?? {}
    const plate = kind === 'bar' && bar !== undefined
    const from = this.#from
    this.#from = plate ? undefined : name
    this.#chosen = { kind: 'pin', name }
    this.#set(plate ? withCorner(made, bar, name) : from === undefined ? made : withBar(made, from, name))
    this.#pins.get(name)?.focus({ preventScroll: true })
  }

  #clickSheet(place: Place): void {
    if (this.#backdrop.click(place)) return
    if (this.#tool === 'bar') return this.#add(this.#rounded(place))
    this.#chosen = undefined
    this.#render()
  }

  #clickPin(name: string): void {
    const pin = this.#pin(name)
    if (!pin) return
    if (this.#backdrop.click(pin.at)) return
    const { kind, name: bar } = this.#chosen ?? {}
    const from = this.#from
    this.#chosen = { kind: 'pin', name }
    const support = (one: 'ground' | 'slider') =>
      this.#set(changed(this.#linkage, name, { support: pin.support === one ? 'free' : one }))
    switch (this.#tool) {
      case 'bar': {
        if (kind === 'bar' && bar !== undefined) return this.#set(withCorner(this.#linkage, bar, name))
        // At a joint that was there already, the chain of bars ends.
        this.#from = from === undefined ? name : undefined
        return this.#set(from === undefined ? this.#linkage : withBar(this.#linkage, from, name))
      }
      case 'ground':
      case 'slider':
        return support(this.#tool)
      case 'motor': {
        if (pin.support === 'free') {
          this.#render()
          this.#refuse(`\`${name}\` is neither a fixed pivot nor a slider, so that no motor can drive it.`)
          return
        }
        return this.#set(changed(this.#linkage, name, { motor: pin.motor ? undefined : 'turn' }))
      }
      case 'select':
        this.#render()
    }
  }

  #clickBar(name: string): void {
    this.#from = undefined
    this.#chosen = { kind: 'bar', name }
    this.#render()
  }

  /** Follows a pointer until it is lifted: `click` where it did not move. */
  #track(event: PointerEvent, move: (by: Place, event: PointerEvent) => void, click: () => void): void {
    if (event.button !== 0) return
    const target = event.currentTarget as HTMLElement
    target.setPointerCapture(event.pointerId)
    const from: Place = [event.clientX, event.clientY]
    let moved = false
    const end = new AbortController()
    const { signal } = end
    target.addEventListener(
      'pointermove',
      (event) => {
        const by: Place = [event.clientX - from[0], event.clientY - from[1]]
        moved ||= Math.hypot(...by) > TREMBLE
        if (moved) move(by, event)
      },
      { signal },
    )
    target.addEventListener('pointercancel', () => end.abort(), { signal })
    target.addEventListener(
      'pointerup',
      () => {
        end.abort()
        if (!moved) click()
        this.#gesture = undefined
      },
      { signal },
    )
  }

  #press(event: PointerEvent): void {
    if ((event.target as Element).closest('button')) return
    this.element.focus({ preventScroll: true })
    const [x, y] = this.#middle
    const place = this.#place(event)
    this.#track(
      event,
      ([right, down]) => {
        this.#middle = [x - right / this.#scale, y + down / this.#scale]
        this.#draw()
      },
      () => this.#clickSheet(place),
    )
  }

  #hover(event: PointerEvent): void {
    if (this.#from === undefined) return
    this.#pointer = this.#place(event)
    this.#draw()
  }

  #zoom(event: WheelEvent): void {
    event.preventDefault()
    const before = this.#place(event)
    this.#scale = Math.min(Math.max(this.#scale * ZOOM ** -event.deltaY, SCALES[0]), SCALES[1])
    const after = this.#place(event)
    this.#middle = [this.#middle[0] + before[0] - after[0], this.#middle[1] + before[1] - after[1]]
    this.#draw()
  }

  /** Shows all joints, and further places. */
  #fit(places: Place[]): void {
    const all = [...places, ...this.#linkage.pins.map(({ at }) => at)]
    const [width, height] = this.#extent
    if (all.length > 0 && width > 0 && height > 0) {
      const [low, high] = [Math.min, Math.max].map((most) => [0, 1].map((k) => most(...all.map((one) => one[k]))))
      const [across, up] = [high[0] - low[0], high[1] - low[1]].map((size) => ROOM * size)
      this.#middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2]
      const scale = Math.min(width / across, height / up)
      if (Number.isFinite(scale)) this.#scale = Math.min(Math.max(scale, SCALES[0]), SCALES[1])
    }
    this.#draw()
  }

  /** Keys of the drawing wherever the focus is, but for fields; the page's own keys rest meanwhile. */
  #key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement
    if (!this.on || !this.element.isConnected || target.closest('dialog, .drawer, [role=menu]')) return
    const isField = target.closest('input:not([type=checkbox], [type=range]), select, textarea') !== null
    const { key, shiftKey } = event
    const control = event.ctrlKey || event.metaKey
    const name = target.dataset.pin
    const by = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key]
    if (isField) return
    if (control && !shiftKey && key.toLowerCase() === 'z') this.#step(this.#past, this.#future)
    else if (control && ['z', 'y'].includes(key.toLowerCase())) this.#step(this.#future, this.#past)
    else if (control || event.altKey) return
    else if (key === 'Escape') this.#escape()
    else if ((key === 'Delete' || key === 'Backspace') && this.#chosen) this.#remove(this.#chosen)
    else if (by && name !== undefined) {
      const { at } = this.#pin(name)!
      const step = this.#round(shiftKey ? FINE : 4 * FINE)
      // A key that is held is one step.
      if (!event.repeat) this.#gesture = undefined
      this.#move(name, this.#rounded([at[0] + by[0] * step, at[1] + by[1] * step]), `key ${name}`)
    } else return
    event.preventDefault()
    event.stopPropagation()
  }

  /** Ends the bar, the selection, or the drawing. */
  #escape(): void {
    if (this.#from === undefined && !this.#chosen) return this.toggle()
    if (this.#from === undefined) this.#chosen = undefined
    this.#from = undefined
    this.#render()
  }

  #move(name: string, at: Place, gesture: string): void {
    this.#set(changed(this.#linkage, name, { at }), gesture)
  }

  #remove({ kind, name }: Chosen): void {
    this.#from = this.#chosen = undefined
    this.#set(kind === 'pin' ? withoutPin(this.#linkage, name) : withoutBar(this.#linkage, name))
    this.element.focus({ preventScroll: true })
  }

  async #finish(): Promise<void> {
    this.#show.disabled = true
    this.#say('solving')
    const text = this.#text
    try {
      await this.host.show(text)
      if (this.on) this.toggle()
    } catch (error) {
      if (text !== this.#text) return
      this.#messages = messagesOf(error)
      this.#report()
    }
  }

  #say(words: string): void {
    this.#hint.replaceChildren(...prose(words))
  }

  #refuse(why: string): void {
    this.#refusal = why
    this.#report()
  }

  /** Shows the linkage, and checks its text soon. */
  #render(): void {
    this.#refusal = undefined
    const { pins, bars } = this.#linkage
    const exists =
      this.#chosen && (this.#chosen.kind === 'pin' ? pins : bars).some(({ name }) => name === this.#chosen!.name)
    if (!exists) this.#chosen = undefined
    if (!this.#pin(this.#from)) this.#from = undefined
    this.#undo.disabled = this.#past.length === 0
    this.#redo.disabled = this.#future.length === 0
    for (const [tool, button] of this.#tools) button.setAttribute('aria-pressed', String(tool === this.#tool))
    this.#draw()
    this.#detail()
    const text = this.#text
    if (text !== this.#checked) {
      this.#checked = text
      this.#messages = []
      this.pane.dataset.checked = 'no'
      clearTimeout(this.#waiting)
      if (bars.length > 0) this.#waiting = setTimeout(() => void this.#check(text), PAUSE)
    }
    this.#report()
  }

  async #check(text: string): Promise<void> {
    const messages = await this.host.check(text).catch(messagesOf)
    if (text !== this.#checked) return
    this.#messages = messages
    this.pane.dataset.checked = 'yes'
    this.#report()
  }

  /** The next step, or what the engine has against the linkage. */
  #report(): void {
    const missing = lacking(this.#linkage)
    const isWrong = this.#messages.some(({ severity }) => severity === 'error')
    const isChecked = this.pane.dataset.checked === 'yes'
    this.#show.disabled = !isChecked || isWrong
    this.#list.hidden = missing !== undefined || this.#messages.length === 0
    if (!this.#list.hidden)
      this.#list.replaceChildren(
        ...this.#messages.map((one) => el('li', { class: one.severity }, el('div', {}, ...messageElements(one)))),
      )
    const { kind, name } = this.#chosen ?? {}
    if (this.#refusal !== undefined) this.#say(this.#refusal)
    else if (this.#tool === 'bar' && this.#from !== undefined && this.#linkage.pins.length > 0)
      this.#say(`Click the other end of the bar from \`${this.#from}\`: a place, or a joint. Escape ends.`)
    else if (this.#tool === 'bar' && kind === 'bar')
      this.#say(`Click a place or a joint: \`${name}\` becomes a plate through it. Escape ends.`)
    else this.#say(missing ?? (isWrong ? 'It cannot be driven yet:' : isChecked ? 'It can move.' : ''))
  }

  /** Fields of the selected joint or bar. */
  #detail(): void {
    const { kind, name = '' } = this.#chosen ?? {}
    const pin = kind === 'pin' ? this.#pin(name) : undefined
    const key = [
      kind,
      name,
      pin?.support,
      pin?.motor,
      ...(kind === 'bar' ? this.#linkage.bars.flatMap(({ pins }) => pins) : []),
    ].join(' ')
    if (key === this.#fields) return this.#refresh()
    this.#fields = key
    this.#refresh = () => {}
    if (!this.#chosen) return this.#details.replaceChildren()
    const chosen = this.#chosen
    const rename = el('input', {
      type: 'text',
      value: name,
      'aria-label': 'name',
      'data-testid': 'linkage-name',
      spellcheck: 'false',
      onchange: () => this.#rename(chosen, rename.value.trim()),
    })
    const remove = el(
      'button',
      { type: 'button', 'data-testid': 'linkage-delete', title: 'Delete', onclick: () => this.#remove(chosen) },
      'Delete',
    )
    const named = el('label', {}, kind === 'pin' ? 'joint ' : 'bar ', rename)
    this.#details.replaceChildren(named, ...(pin ? this.#ofPin(pin) : [this.#ofBar(name)]), remove)
    this.#refresh()
  }

  #rename(chosen: Chosen, to: string): void {
    const made = renamed(this.#linkage, chosen.kind, chosen.name, to)
    if (typeof made === 'string') return this.#refuse(made)
    this.#chosen = { ...chosen, name: to }
    this.#set(made)
  }

  #ofBar(name: string): HTMLElement {
    const { pins } = this.#linkage.bars.find((bar) => bar.name === name)!
    const words = el('span', { class: 'muted' })
    this.#refresh = () => {
      const [a, b] = pins.map((one) => this.#pin(one)!.at)
      const size = `${Number(length(a, b).toPrecision(5))} ${this.host.unit}`
      words.textContent = pins.length > 2 ? `plate through ${pins.join(', ')}` : `from ${pins.join(' to ')}, ${size}`
    }
    return words
  }

  #ofPin({ name, support, motor }: Pin): HTMLElement[] {
    const { unit } = this.host
    const number = (
      label: string,
      of: string,
      read: (pin: Pin) => number,
      write: (value: number, pin: Pin) => Partial<Pin>,
    ) => {
      const made = new NumberField({
        label,
        testId: `linkage-${label}`,
        unit: of,
        step: 1,
        plus: 'adds',
        apply: (value) => {
          const pin = this.#pin(name)
          if (pin) this.#set(changed(this.#linkage, name, write(value, pin)), `${label} ${name}`)
        },
      })
      return { made, read, element: el('label', {}, `${label} `, made.input, ` ${of}`) }
    }
    const numbers = [
      number(
        'x',
        unit,
        ({ at }) => at[0],
        (x, { at }) => ({ at: [x, at[1]] }),
      ),
      number(
        'y',
        unit,
        ({ at }) => at[1],
        (y, { at }) => ({ at: [at[0], y] }),
      ),
      ...(support === 'slider'
        ? [
            number(
              'direction',
              'deg',
              (pin) => pin.direction,
              (direction) => ({ direction }),
            ),
          ]
        : []),
      ...(motor === 'swing'
        ? [
            number(
              'amplitude',
              support === 'slider' ? unit : 'deg',
              (pin) => pin.amplitude,
              (amplitude) => ({ amplitude }),
            ),
          ]
        : []),
    ]
    this.#refresh = () => {
      const pin = this.#pin(name)
      if (pin) for (const { made, read } of numbers) made.show(read(pin))
    }
    const select = (
      label: string,
      options: Record<string, string>,
      value: string,
      set: (value: string) => Partial<Pin>,
    ) => {
      const chooser = el(
        'select',
        {
          'aria-label': label,
          'data-testid': `linkage-${label}-select`,
          onchange: () => this.#set(changed(this.#linkage, name, set(chooser.value))),
        },
        ...Object.entries(options).map(([key, words]) => el('option', { value: key, selected: key === value }, words)),
      )
      return chooser
    }
    const motors: Record<string, string> = {
      '': 'no motor',
      ...(support === 'ground' && { turn: 'motor turns' }),
      swing: 'motor moves to and fro',
    }
    return [
      select('support', SUPPORTS, support, (value) => ({ support: value as Pin['support'] })),
      ...(support === 'free'
        ? []
        : [select('drive', motors, motor ?? '', (value) => ({ motor: (value || undefined) as Pin['motor'] }))]),
      ...numbers.map(({ element }) => element),
    ]
  }

  /** Draws grid, bars, supports and motors, and puts the buttons where they belong. */
  #draw(): void {
    if (!this.on) return
    const { pins, bars } = this.#linkage
    const at = new Map(pins.map((pin) => [pin.name, this.#screen(pin.at)]))
    const [from, to] = [this.#from && at.get(this.#from), this.#pointer && this.#screen(this.#pointer)]
    const line = (a: { x: number; y: number }, b: { x: number; y: number }, kind: string) =>
      svg('line', { class: kind, x1: a.x, y1: a.y, x2: b.x, y2: b.y })
    this.#lines.replaceChildren(
      ...this.#grid(line),
      ...bars.map(({ name, pins }) => {
        const points = pins.map((pin) => at.get(pin)!)
        const shape = svg('polygon', {
          class: this.#chosen?.kind === 'bar' && this.#chosen.name === name ? 'bar chosen' : 'bar',
          points: points.map(({ x, y }) => `${x},${y}`).join(' '),
        })
        return shape
      }),
      ...pins.flatMap((pin) => symbols(pin, at.get(pin.name)!)),
      ...(from && to ? [line(from, to, 'next')] : []),
    )
    sync(this.#pins, pins, this.element, ({ name }) => this.#pinButton(name))
    sync(this.#bars, bars, this.element, ({ name }) => this.#barButton(name))
    const put = (button: HTMLElement, { x, y }: { x: number; y: number }) =>
      (button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`)
    for (const {
      name,
      at: [x, y],
      support,
      motor,
    } of pins) {
      const button = this.#pins.get(name)!
      put(button, at.get(name)!)
      const words = [`joint ${name}: ${x}, ${y} ${this.host.unit}`, SUPPORTS[support], motor && 'driven']
        .filter(Boolean)
        .join(', ')
      button.title = words
      button.setAttribute('aria-label', words)
      button.setAttribute(
        'aria-pressed',
        String(this.#from === name || (this.#chosen?.kind === 'pin' && this.#chosen.name === name)),
      )
    }
    for (const { name, pins } of bars) {
      const ends = pins.map((pin) => at.get(pin)!)
      const mean = (key: 'x' | 'y') => ends.reduce((sum, end) => sum + end[key], 0) / ends.length
      put(this.#bars.get(name)!, { x: mean('x'), y: mean('y') })
    }
    this.#backdrop.follow()
  }

  #grid(line: (a: { x: number; y: number }, b: { x: number; y: number }, kind: string) => SVGElement): SVGElement[] {
    const [width, height] = this.#extent
    const step = this.#round(GRID)
    const [left, top] = this.#corner
    this.#size.textContent = `grid ${Number(step.toPrecision(3))} ${this.host.unit}`
    const lines: SVGElement[] = []
    for (let k = Math.ceil(left / step); k * step < left + width / this.#scale; k++) {
      const { x } = this.#screen([k * step, 0])
      lines.push(line({ x, y: 0 }, { x, y: height }, k === 0 ? 'axis' : 'grid'))
    }
    for (let k = Math.ceil(top / step - height / this.#scale / step); k * step < top; k++) {
      const { y } = this.#screen([0, k * step])
      lines.push(line({ x: 0, y }, { x: width, y }, k === 0 ? 'axis' : 'grid'))
    }
    return lines
  }

  /** Place of the upper left corner. */
  get #corner(): Place {
    const [width, height] = this.#extent
    return [this.#middle[0] - width / 2 / this.#scale, this.#middle[1] + height / 2 / this.#scale]
  }

  #pinButton(name: string): HTMLButtonElement {
    return el(
      'button',
      {
        type: 'button',
        class: 'grip path-handle',
        'data-testid': `linkage-pin-${name}`,
        'data-pin': name,
        onpointerdown: (event: PointerEvent) =>
          this.#track(
            event,
            (_, event) => this.#move(name, this.#rounded(this.#place(event)), `drag ${name}`),
            () => this.#clickPin(name),
          ),
        // A pointer has done it already.
        onclick: (event: MouseEvent) => event.detail === 0 && this.#clickPin(name),
      },
      name,
    )
  }

  #barButton(name: string): HTMLButtonElement {
    return el(
      'button',
      {
        type: 'button',
        class: 'linkage-bar',
        'data-testid': `linkage-bar-${name}`,
        onclick: () => this.#clickBar(name),
      },
      name,
    )
  }
}

/** Keeps one button for each thing of a list, by its name. */
function sync<T extends { name: string }>(
  buttons: Map<string, HTMLButtonElement>,
  list: readonly T[],
  parent: HTMLElement,
  make: (one: T) => HTMLButtonElement,
): void {
  const names = new Set(list.map(({ name }) => name))
  for (const [name, button] of buttons) {
    if (names.has(name)) continue
    button.remove()
    buttons.delete(name)
  }
  for (const one of list) {
    if (buttons.has(one.name)) continue
    const button = make(one)
    buttons.set(one.name, button)
    parent.append(button)
  }
}

/** Marks of a support and its motor at a joint, px. */
function symbols({ support, direction, motor }: Pin, { x, y }: { x: number; y: number }): SVGElement[] {
  const path = (d: string, turn = 0) =>
    svg('path', { class: 'support', d, transform: `translate(${x} ${y}) rotate(${-turn})` })
  const arrow = 'M-20 -11A23 23 0 0 1 21 -9M21 -9l2 -10M21 -9l-10 -2'
  return [
    ...(support === 'ground' ? [path('M0 0L-14 20H14ZM-18 20H18M-16 26l6 -6M-6 26l6 -6M4 26l6 -6M14 26l4 -4')] : []),
    ...(support === 'slider'
      ? [path('M-15 -11H15V11H-15ZM-60 15H60M-56 20l5 -5M-28 20l5 -5M0 20l5 -5M28 20l5 -5M55 20l5 -5', direction)]
      : []),
    ...(motor && support === 'ground' ? [path(arrow)] : []),
    ...(motor && support === 'slider' ? [path('M22 0H52M52 0l-8 -5M52 0l-8 5M22 0l8 -5M22 0l8 5', direction)] : []),
  ]
}

/** Diagnostics of a request that failed, or one for a failure of the request itself. */
function messagesOf(error: unknown): Diagnostic[] {
  if (error instanceof RequestError) return error.messages
  const message = `the linkage could not be solved: ${messageOf(error)}`
  const nowhere = { file: null, line: null, column: null, length: null, element: null, label: null, help: null }
  return [{ ...nowhere, severity: 'error', code: '', message, notes: [] }]
}
