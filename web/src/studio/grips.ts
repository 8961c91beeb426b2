import './grips.css'
import { Quaternion, Vector3 } from 'three'
import { el, prose, svg } from '../dom'
import type { MovableHardpoint, OpenReply } from '../engine/protocol'
import { poseAt } from '../scene/poses'
import type { View } from '../scene/view'
import type { State } from '../state'
import {
  AXES,
  followed,
  lengthOf,
  mirrors,
  placeOf,
  settingsFor,
  snapped,
  turnOf,
  type DragDirection,
  DRAG_DIRECTIONS,
} from './moves'

/** Snaps that are offered, in the model's unit. */
const SNAPS = [0, 0.1, 0.5, 1, 5, 10]
/** An arrow key moves by this part of the size, where there is no snap; with Shift by ten times that. */
const NUDGE = 1e-3
/** Half length of an axis drawn through a hardpoint, relative to the size. */
const GUIDE = 0.25

interface Grip {
  grip: MovableHardpoint
  body: number
  point: number
  button: HTMLButtonElement
}

/** A drag under way. */
interface ActiveDrag {
  shown: Grip
  /** Position in the world and in the design configuration, at the start. */
  from: Vector3
  nominal: Vector3
  turn: Quaternion
  /** From the hardpoint to where it was taken hold of. */
  offset: Vector3
}

/** Hardpoints that can be taken hold of in the view, and the pane of the one that is chosen. */
export class Grips {
  readonly element = el('div', { class: 'grips', hidden: true })
  readonly pane = el('section', {
    class: 'grip-pane',
    hidden: true,
    'aria-label': 'Hardpoint',
    'data-testid': 'grip-pane',
  })
  readonly button = el(
    'button',
    {
      type: 'button',
      title: 'Drag hardpoints (M)',
      'data-testid': 'grips',
      'aria-pressed': 'false',
      onclick: () => this.toggle(),
    },
    'Drag points',
  )
  #guide = svg('svg', { class: 'guide', 'aria-hidden': 'true' })
  #shown: Grip[]
  #chosen?: Grip
  #activeDrag?: ActiveDrag
  #direction: DragDirection = 'free'
  #snap = 0
  #mirror?: { axis: number; partner: Map<string, MovableHardpoint>; on: boolean }
  #fields: HTMLInputElement[] = []
  /** True if a field is being written in. */
  #typing = false
  #size: number
  #pending?: PointerEvent

  constructor(
    private readonly view: View,
    private readonly state: State,
    private readonly opened: OpenReply,
    /** Called when a hand lets go. */
    private readonly onRelease: () => void,
  ) {
    this.#size = view.original.size
    this.#shown = opened.grips.flatMap((grip) => this.#place(grip))
    const found = mirrors(opened.grips)
    this.#mirror = found && { ...found, on: true }
    this.element.append(this.#guide, ...this.#shown.map(({ button }) => button))
    this.#makePane()
    view.onDrawn(() => this.#follow())
    state.onChoice(() => this.#show())
    this.#show()
  }

  /** True if a hand holds one. */
  get isDragging(): boolean {
    return this.#activeDrag !== undefined
  }

  get on(): boolean {
    return !this.element.hidden
  }

  toggle(): void {
    this.element.hidden = this.on
    this.button.setAttribute('aria-pressed', String(this.on))
    if (!this.on) this.choose(undefined)
    this.#follow()
    this.#show()
  }

  /** Chooses a hardpoint by its name. */
  choose(name: string | undefined): void {
    this.#chosen = this.#shown.find(({ grip }) => grip.name === name)
    for (const { grip, button } of this.#shown) button.setAttribute('aria-pressed', String(grip.name === name))
    this.#show()
    this.#follow()
  }

  /** Positions of a drawn hardpoint: for the bodies that it is fixed in, ground first. */
  #place(grip: MovableHardpoint): Grip[] {
    const { bodies } = this.state.report
    for (const [body, { labels }] of bodies.entries()) {
      const point = labels.findIndex((label) => label.split(', ').includes(grip.name))
      if (point < 0) continue
      const button = el('button', {
        type: 'button',
        class: 'grip',
        title: grip.name,
        'aria-label': `hardpoint ${grip.name}`,
        'data-testid': `grip-${grip.name}`,
        onclick: () => this.choose(grip.name),
        onkeydown: (event: KeyboardEvent) => this.#key(event, shown),
        onpointerdown: (event: PointerEvent) => this.#grab(event, shown),
        onpointermove: (event: PointerEvent) => this.#drag(event),
        onpointerup: () => this.#release(),
        onpointercancel: () => this.#release(),
      })
      const shown: Grip = { grip, body, point, button }
      return [shown]
    }
    return []
  }

  #world({ body, point }: Grip): Vector3 {
    const { mechanism } = this.view
    return mechanism.frame(this.state.step).at(body, new Vector3(...mechanism.report.bodies[body].skeleton[point]))
  }

  #turn({ body }: Grip): Quaternion {
    const pose = poseAt(this.view.mechanism.report.bodies[body].poses, this.state.step)
    return pose ? turnOf(this.opened.frames[body] ?? [1, 0, 0, 0], pose.turn) : new Quaternion()
  }

  /** Puts the buttons where their hardpoints are in the picture. */
  #follow(): void {
    if (!this.on) return
    for (const shown of this.#shown) {
      const { x, y, seen } = this.view.project(this.#world(shown))
      shown.button.hidden = !seen || !Number.isFinite(x + y)
      shown.button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
    }
    this.#guide.replaceChildren()
    if (!this.#chosen || this.#direction === 'free') return
    const at = this.#world(this.#chosen)
    const turn = this.#turn(this.#chosen)
    for (const axis of this.#direction) {
      const along = new Vector3().setComponent(AXES.indexOf(axis as 'x'), GUIDE * this.#size).applyQuaternion(turn)
      const [a, b] = [1, -1].map((side) => this.view.project(at.clone().addScaledVector(along, side)))
      this.#guide.append(svg('line', { x1: a.x, y1: a.y, x2: b.x, y2: b.y, class: `axis-${axis}` }))
    }
  }

  #grab(event: PointerEvent, shown: Grip): void {
    if (event.button !== 0) return
    this.choose(shown.grip.name)
    shown.button.setPointerCapture(event.pointerId)
    this.state.pause()
    const from = this.#world(shown)
    const turn = this.#turn(shown)
    const sight = this.#sight(event)
    const offset = followed(sight, from, 'free', turn, this.#facing()) ?? new Vector3()
    this.#activeDrag = { shown, from, turn, nominal: placeOf(shown.grip, this.state.settings), offset }
    // A grip that is left lying keeps the keys.
    shown.button.focus({ preventScroll: true })
    event.preventDefault()
  }

  #drag(event: PointerEvent): void {
    if (!this.#activeDrag) return
    const first = this.#pending === undefined
    this.#pending = event
    // A pointer reports more often than a frame can be drawn.
    if (first) requestAnimationFrame(() => this.#dragged())
  }

  #dragged(): void {
    const [event, hold] = [this.#pending, this.#activeDrag]
    this.#pending = undefined
    if (!event || !hold) return
    const sight = this.#sight(event)
    sight.origin.sub(hold.offset)
    const direction = followed(sight, hold.from, this.#direction, hold.turn, this.#facing())
    if (!direction) return
    const place = hold.nominal.clone().add(direction.applyQuaternion(hold.turn.clone().invert()))
    this.#moveTo(
      hold.shown,
      place,
      event.ctrlKey || event.metaKey ? this.#snap || this.#coarse : this.#snap || this.#fine,
      hold.nominal,
    )
  }

  #release(): void {
    if (!this.#activeDrag) return
    this.#dragged()
    this.#activeDrag = undefined
    this.onRelease()
  }

  /** Resolution of a drag, so that it leaves no meaningless digits. */
  get #fine(): number {
    return 10 ** Math.floor(Math.log10(this.#size * 1e-4))
  }

  /** A round step that is seen. */
  get #coarse(): number {
    return 10 ** Math.round(Math.log10(this.#size * 0.005))
  }

  #sight({ clientX, clientY }: PointerEvent) {
    const { left, top } = this.view.element.getBoundingClientRect()
    return this.view.sight(clientX - left, clientY - top)
  }

  /** Towards the eye; of a planar mechanism its normal, so that it stays in its plane. */
  #facing(): Vector3 {
    return this.view.original.plane?.clone() ?? new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, 2)
  }

  /** Puts a hardpoint, and its mirror image, at a place of the drawing; coordinates that stay keep their numbers. */
  #moveTo({ grip }: Grip, place: Vector3, snap: number, before: Vector3): void {
    const still = 1e-9 * this.#size
    AXES.forEach((_, k) => {
      const moved = Math.abs(place.getComponent(k) - before.getComponent(k)) > still
      place.setComponent(k, moved ? snapped(place.getComponent(k), snap) : before.getComponent(k))
    })
    const own = settingsFor(grip, place)
    const partner = this.#mirror?.on ? this.#mirror.partner.get(grip.name) : undefined
    let other: ReturnType<typeof settingsFor> | undefined
    if (partner) {
      const mirrored = place.clone()
      mirrored.setComponent(this.#mirror!.axis, -mirrored.getComponent(this.#mirror!.axis))
      other = settingsFor(partner, mirrored)
    }
    const bound = own.bound ?? other?.bound
    this.state.bound = bound ? `\`${bound}\` is at its bound` : ''
    this.state.adjust([...own.settings, ...(other?.settings ?? [])])
  }

  #key(event: KeyboardEvent, shown: Grip): void {
    const key = event.key.toLowerCase()
    if (key === 'x' || key === 'y' || key === 'z') {
      this.#setDirection(this.#direction === key ? 'free' : key)
    } else {
      const by = { arrowleft: [-1, 0], arrowright: [1, 0], arrowup: [0, 1], arrowdown: [0, -1] }[key]
      if (!by) return
      const step = (this.#snap || NUDGE * this.#size) * (event.shiftKey ? 10 : 1)
      const before = placeOf(shown.grip, this.state.settings)
      const direction = new Vector3()
      if (this.#direction.length === 1)
        direction.setComponent(AXES.indexOf(this.#direction as 'x'), step * (by[0] + by[1]))
      else {
        // The axis that is seen most in the direction of the key.
        const turn = this.#turn(shown)
        const screen = new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, by[0] ? 0 : 1)
        const parts = AXES.map((_, k) => new Vector3().setComponent(k, 1).applyQuaternion(turn).dot(screen))
        const allowed = (k: number) => this.#direction === 'free' || this.#direction.includes(AXES[k])
        const axis = [0, 1, 2].filter(allowed).sort((a, b) => Math.abs(parts[b]) - Math.abs(parts[a]))[0]
        direction.setComponent(axis, step * Math.sign(parts[axis]) * (by[0] + by[1]))
      }
      this.#moveTo(shown, before.clone().add(direction), 0, before)
      this.onRelease()
    }
    event.preventDefault()
    event.stopPropagation()
  }

  #setDirection(direction: DragDirection): void {
    this.#direction = direction
    this.#follow()
    this.#show()
  }

  #directionButtons: HTMLButtonElement[] = []
  #name = el('h3')
  #refusal = el('p', { class: 'refusal', role: 'status', 'data-testid': 'refusal' })
  #mirrorField?: HTMLInputElement

  #directionButton(direction: DragDirection): HTMLButtonElement {
    const title = direction === 'free' ? 'In the plane of the screen' : `Along ${[...direction].join(' and ')}`
    const onclick = () => this.#setDirection(direction)
    return el('button', { type: 'button', 'data-testid': `way-${direction}`, title, onclick }, direction)
  }

  #makePane(): void {
    const { length } = this.state.report.units
    this.#fields = AXES.map((axis, k) =>
      el('input', {
        type: 'text',
        inputmode: 'decimal',
        'aria-label': `${axis} in ${length}`,
        'data-testid': `grip-${axis}`,
        oninput: () => (this.#typing = true),
        onchange: () => this.#applyInput(k),
      }),
    )
    const label = (text: string, field: HTMLElement, after = '') =>
      el('label', {}, el('span', {}, text), field, el('span', { class: 'unit' }, after))
    this.#directionButtons = DRAG_DIRECTIONS.map((direction) => this.#directionButton(direction))
    const snap = el(
      'select',
      { 'aria-label': 'Snap', 'data-testid': 'snap', onchange: () => (this.#snap = Number(snap.value)) },
      ...SNAPS.map((by) => el('option', { value: by }, by === 0 ? 'no snap' : `snap ${by} ${length}`)),
    )
    this.#mirrorField =
      this.#mirror &&
      el('input', {
        type: 'checkbox',
        checked: true,
        'data-testid': 'mirror',
        onchange: () => (this.#mirror!.on = this.#mirrorField!.checked),
      })
    const reset = el(
      'button',
      { type: 'button', class: 'plain', 'data-testid': 'grip-reset', onclick: () => this.#reset() },
      'reset',
    )
    this.pane.append(
      el(
        'div',
        { class: 'head' },
        this.#name,
        reset,
        el(
          'button',
          { type: 'button', class: 'icon', 'aria-label': 'Close', onclick: () => this.choose(undefined) },
          '×',
        ),
      ),
      el('div', { class: 'coordinates' }, ...AXES.map((axis, k) => label(axis, this.#fields[k], length))),
      el('div', { class: 'ways', role: 'toolbar', 'aria-label': 'Direction' }, ...this.#directionButtons),
      el(
        'div',
        { class: 'ways' },
        snap,
        this.#mirrorField && el('label', { class: 'mirror' }, this.#mirrorField, 'mirror to the other side'),
      ),
      this.#refusal,
    )
  }

  #applyInput(k: number): void {
    this.#typing = false
    const chosen = this.#chosen
    const value = chosen && lengthOf(this.#fields[k].value, this.state.report.units.length)
    if (chosen && value !== undefined) {
      const before = placeOf(chosen.grip, this.state.settings)
      this.#moveTo(chosen, before.clone().setComponent(k, value), 0, before)
      this.onRelease()
    }
    this.#show(true)
  }

  #reset(): void {
    if (!this.#chosen) return
    const before = placeOf(this.#chosen.grip, this.state.settings)
    this.#moveTo(this.#chosen, new Vector3(...this.#chosen.grip.place), 0, before)
    this.onRelease()
  }

  #show(all = false): void {
    this.pane.hidden = !this.on
    this.element.classList.toggle('refused', this.state.refusal !== '')
    this.#refusal.replaceChildren(...prose(this.state.refusal || this.state.bound))
    const chosen = this.#chosen
    this.pane.classList.toggle('idle', !chosen)
    this.#name.textContent = chosen?.grip.name ?? 'Click a point to move it'
    this.#directionButtons.forEach((button, k) =>
      button.setAttribute('aria-pressed', String(DRAG_DIRECTIONS[k] === this.#direction)),
    )
    for (const field of this.#fields) field.disabled = !chosen
    if (!chosen) return
    const place = placeOf(chosen.grip, this.state.settings)
    this.#fields.forEach((field, k) => {
      if (all || !this.#typing || document.activeElement !== field)
        field.value = String(Number(place.getComponent(k).toPrecision(7)))
      field.classList.toggle('changed', Math.abs(place.getComponent(k) - chosen.grip.place[k]) > 1e-9 * this.#size)
    })
    if (this.#mirrorField) this.#mirrorField.disabled = !this.#mirror!.partner.has(chosen.grip.name)
  }
}
