import './grips.css'
import { Quaternion, Vector3 } from 'three'
import { entry } from '../amount'
import { contactSentences } from '../clearance'
import { el, setAttribute, setProse, setText, svg } from '../dom'
import type { MovableHardpoint, OpenReply } from '../engine/protocol'
import { pretty } from '../format'
import { NumberField } from '../page/number_field'
import { prefer, preference } from '../preferences'
import type { View } from '../scene/view'
import type { State } from '../state'
import { AxisArrows } from './axis_arrows'
import type { Mover } from './mover'
import { AXES, directionsOffered, type DragDirection, facingPlane, followed, turnOf } from './moves'

/** Snaps that are offered, in the model's unit. */
const SNAPS = [0, 0.1, 0.5, 1, 5, 10]
/** An arrow key moves by the power of ten below this part of the size, where there is no snap. */
const NUDGE = 2e-3
/** With Shift the hand and the keys move by this part. */
const FINE = 0.1
/** Half length of an axis drawn through a hardpoint, relative to the size. */
const GUIDE = 0.25
/** Part of a step by which a whole number of steps may be missed. */
const ROUNDING = 1e-6
/** Key of the direction in the browser's store, by the kind of mechanism. */
const REMEMBERED = { planar: 'direction.planar', spatial: 'direction' }

interface Grip {
  grip: MovableHardpoint
  body: number
  point: number
  button: HTMLButtonElement
}

/** A drag under way. */
interface ActiveDrag {
  shown: Grip
  direction: DragDirection
  /** Position in the world and in the design configuration, at the start. */
  from: Vector3
  nominal: Vector3
  turn: Quaternion
  /** From the hardpoint to where it was taken hold of. */
  offset: Vector3
  /** Last place of the hand, and the place that the hardpoint follows. */
  last: { clientX: number; clientY: number }
  hand: { clientX: number; clientY: number }
  /** Resolution of its coordinates. */
  snap: number
}

/** Hardpoints that can be taken hold of in the view, and the pane of the one that is chosen, docked below the view. */
export class Grips {
  readonly element = el('div', { class: 'grips', hidden: true })
  readonly pane = el('section', {
    class: 'grip-pane',
    hidden: true,
    'aria-label': 'Hardpoint',
    'data-testid': 'grip-pane',
    onkeydown: (event: KeyboardEvent) => event.key === 'Escape' && !event.defaultPrevented && this.leave(),
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
  #label = el('output', { class: 'drag-label', hidden: true, 'data-testid': 'drag-label' })
  #arrows: AxisArrows
  #shown: Grip[]
  #chosen?: Grip
  #activeDrag?: ActiveDrag
  #offered: readonly DragDirection[]
  #direction: DragDirection
  #snap = 0
  #fields: NumberField[] = []
  #size: number
  #pending = false
  /** Move of a drag that the label shows with the next picture, and the position that its change counts from. */
  #untold?: { shown: Grip; from: Vector3 }
  /** The last move and where it began, until it is known whether the mechanism followed. */
  #last?: { shown: Grip; from: Vector3; snap: number; edition: string }

  constructor(
    private readonly view: View,
    private readonly state: State,
    private readonly opened: OpenReply,
    private readonly mover: Mover,
    /** Called when a hand lets go. */
    private readonly onRelease: () => void,
  ) {
    this.#size = view.original.size
    this.#offered = directionsOffered(view.original.plane)
    const remembered = preference(this.#memory) as DragDirection | undefined
    this.#direction = remembered && this.#offered.includes(remembered) ? remembered : this.#offered[0]
    this.#shown = opened.grips.flatMap((grip) => this.#place(grip))
    this.#arrows = new AxisArrows(
      view,
      AXES.filter((axis) => this.#offered.some((one) => one === axis)),
      (event, axis, held) => this.#chosen && this.#grab(event, this.#chosen, axis, held),
      this.#dragging,
    )
    this.element.append(this.#guide, ...this.#shown.map(({ button }) => button), this.#arrows.element, this.#label)
    this.#makePane()
    view.onDrawn(() => this.#follow())
    state.onChoice(() => {
      this.#settle()
      this.#show()
    })
    this.#show()
  }

  /** True if a hand holds one. */
  get isDragging(): boolean {
    return this.#activeDrag !== undefined
  }

  get on(): boolean {
    return !this.element.hidden
  }

  get #memory(): string {
    return this.view.original.plane ? REMEMBERED.planar : REMEMBERED.spatial
  }

  toggle(): void {
    this.element.hidden = this.on
    this.button.setAttribute('aria-pressed', String(this.on))
    if (!this.on) this.choose(undefined)
    this.#follow()
    this.#show()
    // After the key M the arrow keys are of a hardpoint, without a way there by tabs.
    if (this.on && [null, document.body, this.button].includes(document.activeElement as HTMLElement | null))
      this.#shown.find(({ button }) => !button.hidden)?.button.focus({ preventScroll: true })
  }

  /** Ends the mode in which hardpoints are moved; false if it was not on. */
  leave(): boolean {
    if (!this.on) return false
    this.#cancel()
    this.toggle()
    this.button.focus()
    return true
  }

  /** Chooses a hardpoint by its name. */
  choose(name: string | undefined): void {
    this.#hideLabel()
    this.#chosen = this.#shown.find(({ grip }) => grip.name === name)
    for (const { grip, button } of this.#shown) button.setAttribute('aria-pressed', String(grip.name === name))
    this.#show(true)
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
        onclick: () => this.#chosen !== shown && this.choose(grip.name),
        onkeydown: (event: KeyboardEvent) => this.#key(event, shown),
        onpointerdown: (event: PointerEvent) => this.#grab(event, shown, this.#direction, button),
        ...this.#dragging,
      })
      const shown: Grip = { grip, body, point, button }
      return [shown]
    }
    return []
  }

  /** Listeners of what can be dragged. */
  get #dragging() {
    return {
      onpointermove: (event: PointerEvent) => this.#drag(event),
      onpointerup: () => this.#release(),
      onpointercancel: () => this.#release(),
    }
  }

  #world({ body, point }: Grip): Vector3 {
    return this.view.mechanism.skeletonAt(body, point, this.state.step)
  }

  #turn({ body }: Grip): Quaternion {
    const pose = this.view.mechanism.poseAt(body, this.state.step)
    return pose ? turnOf(this.opened.frames[body] ?? [1, 0, 0, 0], pose.turn) : new Quaternion()
  }

  /** Puts the buttons where their hardpoints are in the picture. */
  #follow(): void {
    if (!this.on) return
    if (this.#untold) this.#tell(this.#untold.shown, this.#untold.from)
    this.#untold = undefined
    for (const shown of this.#shown) this.view.put(shown.button, this.#world(shown))
    this.#guide.replaceChildren()
    const chosen = this.#chosen && !this.#chosen.button.hidden ? this.#chosen : undefined
    this.#arrows.element.style.display = chosen ? '' : 'none'
    if (!chosen) return
    const [at, turn] = [this.#world(chosen), this.#turn(chosen)]
    const active = this.#activeDrag?.direction ?? this.#direction
    for (const axis of AXES.filter((axis) => [...active].includes(axis))) {
      const along = new Vector3().setComponent(AXES.indexOf(axis), GUIDE * this.#size).applyQuaternion(turn)
      const [a, b] = [1, -1].map((side) => this.view.project(at.clone().addScaledVector(along, side)))
      this.#guide.append(svg('line', { x1: a.x, y1: a.y, x2: b.x, y2: b.y, class: `axis-${axis}` }))
    }
    this.#arrows.draw(at, turn)
    const { x, y } = this.view.project(at)
    this.#label.style.transform = `translate(${(x + 18).toFixed(1)}px, ${(y + 14).toFixed(1)}px)`
  }

  #grab(event: PointerEvent, shown: Grip, direction: DragDirection, held: Element): void {
    if (event.button !== 0) return
    if (this.#chosen !== shown) this.choose(shown.grip.name)
    held.setPointerCapture(event.pointerId)
    this.state.pause()
    const from = this.#world(shown)
    const turn = this.#turn(shown)
    // A plane of two axes stays the one that faced the reader when the hand took hold.
    const way = direction === 'auto' ? facingPlane(turn, this.#facing()) : direction
    const { clientX, clientY } = event
    const at = { clientX, clientY }
    const offset = followed(this.#sight(at), from, way, turn, this.#facing()) ?? new Vector3()
    const nominal = this.mover.place(shown.grip)
    this.#activeDrag = { shown, direction: way, from, turn, nominal, offset, last: at, hand: { ...at }, snap: 0 }
    // A grip that is left lying keeps the keys.
    shown.button.focus({ preventScroll: true })
    event.preventDefault()
    event.stopPropagation()
  }

  #drag(event: PointerEvent): void {
    const hold = this.#activeDrag
    if (!hold) return
    const { clientX, clientY, shiftKey, ctrlKey, metaKey } = event
    const scale = shiftKey ? FINE : 1
    hold.hand.clientX += scale * (clientX - hold.last.clientX)
    hold.hand.clientY += scale * (clientY - hold.last.clientY)
    hold.last = { clientX, clientY }
    hold.snap = this.#snap || (ctrlKey || metaKey ? this.#coarse : scale * this.#resolution)
    // A pointer reports more often than a frame can be drawn.
    if (!this.#pending) requestAnimationFrame(() => this.#dragged())
    this.#pending = true
  }

  #dragged(): void {
    const [hold, moved] = [this.#activeDrag, this.#pending]
    this.#pending = false
    if (!hold || !moved) return
    const sight = this.#sight(hold.hand)
    sight.origin.sub(hold.offset)
    const direction = followed(sight, hold.from, hold.direction, hold.turn, this.#facing())
    if (!direction) return
    const place = hold.nominal.clone().add(direction.applyQuaternion(hold.turn.clone().invert()))
    this.#moveTo(hold.shown, place, hold.snap, hold.nominal)
  }

  #release(): void {
    if (!this.#activeDrag) return
    this.#dragged()
    this.#activeDrag = undefined
    this.#hideLabel()
    this.#settle()
    this.#follow()
    this.onRelease()
  }

  /** Takes a drag back to where it began. */
  #cancel(): void {
    const hold = this.#activeDrag
    if (!hold) return
    this.#activeDrag = undefined
    this.#pending = false
    this.#moveTo(hold.shown, hold.nominal.clone(), 0, this.mover.place(hold.shown.grip))
    this.#last = undefined
    this.#hideLabel()
    this.onRelease()
  }

  /** Resolution of a drag, so that it leaves no meaningless digits. */
  get #resolution(): number {
    return 10 ** Math.floor(Math.log10(this.#size * 1e-4))
  }

  /** A round step that is seen. */
  get #coarse(): number {
    return 10 ** Math.round(Math.log10(this.#size * 0.005))
  }

  /** Step of the arrow keys: 1, 0.1, ... of the model's unit. */
  get #step(): number {
    return this.#snap || 10 ** Math.floor(Math.log10(this.#size * NUDGE))
  }

  #sight({ clientX, clientY }: { clientX: number; clientY: number }) {
    const { left, top } = this.view.element.getBoundingClientRect()
    return this.view.sight(clientX - left, clientY - top)
  }

  /** Towards the eye; of a planar mechanism its normal, so that it stays in its plane. */
  #facing(): Vector3 {
    return this.view.original.plane?.clone() ?? new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, 2)
  }

  #moveTo(shown: Grip, place: Vector3, snap: number, from: Vector3): void {
    this.#last = { shown, from, snap: snap || this.#resolution, edition: this.state.edition }
    this.mover.move(shown.grip, place, { snap, before: from })
    // While a hand drags, the label changes with the picture of the solved design: on its own it costs a frame.
    if (this.#activeDrag && this.state.solver) this.#untold = { shown, from }
    else this.#tell(shown, from)
  }

  /**
   * Puts a hardpoint back to a round position after the mechanism locked on the way, and keeps the reason.
   */
  #settle(): void {
    const { refusal } = this.state
    // Until it is solved, the reason is that of an earlier move.
    if (this.#activeDrag || !this.#last || this.#last.edition === this.state.edition || refusal === '') return
    const { shown, from, snap } = this.#last
    this.#last = undefined
    const reached = this.mover.place(shown.grip)
    const round = reached.clone()
    AXES.forEach((_, k) => {
      const [a, b] = [from.getComponent(k), reached.getComponent(k)]
      const steps = Math.trunc((b - a) / snap + ROUNDING * Math.sign(b - a))
      if (this.mover.differ(a, b)) round.setComponent(k, Number((a + steps * snap).toPrecision(12)))
    })
    if (round.distanceTo(reached) === 0) return
    // After the change, which clears it.
    queueMicrotask(() => {
      this.mover.move(shown.grip, round, { before: reached })
      this.state.bound ||= refusal
      this.onRelease()
    })
  }

  #hideLabel(): void {
    this.#untold = undefined
    this.#label.hidden = true
  }

  /** Shows the change since a position next to the hardpoint. */
  #tell(shown: Grip, from: Vector3): void {
    const by = this.mover.place(shown.grip).sub(from)
    const parts = AXES.flatMap((axis, k) => {
      const part = Number(by.getComponent(k).toPrecision(6))
      return this.mover.differ(part, 0) ? [`${axis} ${signed(part)}`] : []
    })
    setText(this.#label, parts.length > 0 ? `${parts.join('  ')} ${pretty(this.state.report.units.length)}` : '0')
    this.#label.hidden = false
  }

  #key(event: KeyboardEvent, shown: Grip): void {
    const key = event.key.toLowerCase()
    if (key === 'escape') {
      if (this.#activeDrag) this.#cancel()
      else this.leave()
    } else if (AXES.some((axis) => axis === key && this.#offered.includes(axis))) {
      const axis = key as DragDirection
      this.#setDirection(this.#direction === axis ? this.#offered[0] : axis)
    } else {
      const by = { arrowleft: [-1, 0], arrowright: [1, 0], arrowup: [0, 1], arrowdown: [0, -1] }[key]
      if (!by) return
      if (this.#chosen !== shown) this.choose(shown.grip.name)
      const step = this.#step * (event.shiftKey ? FINE : 1)
      const before = this.mover.place(shown.grip)
      const direction = new Vector3()
      if (this.#direction.length === 1)
        direction.setComponent(AXES.indexOf(this.#direction as 'x'), step * (by[0] + by[1]))
      else {
        // The axis that is seen most in the direction of the key.
        const turn = this.#turn(shown)
        const screen = new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, by[0] ? 0 : 1)
        const parts = AXES.map((_, k) => new Vector3().setComponent(k, 1).applyQuaternion(turn).dot(screen))
        const isPlane = this.#direction.length === 2
        const allowed = (k: number) =>
          this.#arrows.axes.includes(AXES[k]) && (!isPlane || this.#direction.includes(AXES[k]))
        const axis = [0, 1, 2].filter(allowed).sort((a, b) => Math.abs(parts[b]) - Math.abs(parts[a]))[0]
        direction.setComponent(axis, step * Math.sign(parts[axis]) * (by[0] + by[1]))
      }
      const place = before.clone().add(direction)
      AXES.forEach((_, k) => place.setComponent(k, Number(place.getComponent(k).toPrecision(12))))
      this.#moveTo(shown, place, 0, before)
      this.#show()
      this.onRelease()
    }
    event.preventDefault()
    event.stopPropagation()
  }

  #setDirection(direction: DragDirection): void {
    this.#direction = direction
    prefer(this.#memory, direction)
    this.#follow()
    this.#show()
  }

  #directionButtons: HTMLButtonElement[] = []
  #deltas: HTMLOutputElement[] = []
  #name = el('h2')
  #refusal = el('p', { class: 'refusal', role: 'status', 'data-testid': 'refusal' })
  #mirrorField?: HTMLInputElement
  #reset = el(
    'button',
    {
      type: 'button',
      'data-testid': 'grip-reset',
      title: 'Back to the original position',
      onclick: () => this.#back(),
    },
    'Reset',
  )

  #directionButton(direction: DragDirection): HTMLButtonElement {
    const title = {
      auto: 'In the plane of two axes that faces you; the third coordinate stays',
      free: this.view.original.plane ? 'In the plane of the mechanism' : 'In the plane of the screen',
    }[direction as string]
    return el(
      'button',
      {
        type: 'button',
        'data-testid': `way-${direction}`,
        title: title ?? `Along ${[...direction].join(' and ')}`,
        onclick: () => this.#setDirection(direction),
      },
      direction,
    )
  }

  #makePane(): void {
    const { mover } = this
    const { length } = this.state.report.units
    this.#fields = AXES.map(
      (axis, k) =>
        new NumberField({
          label: `${axis} in ${length}`,
          testId: `grip-${axis}`,
          unit: length,
          step: this.#step,
          plus: 'adds',
          apply: (value) => this.#typed(k, value),
        }),
    )
    this.#deltas = AXES.map(() => el('output', { class: 'delta' }))
    this.#directionButtons = this.#offered.map((direction) => this.#directionButton(direction))
    const snap = el(
      'select',
      { 'aria-label': 'Snap', 'data-testid': 'snap', onchange: () => (this.#snap = Number(snap.value)) },
      ...SNAPS.map((by) => el('option', { value: by }, by === 0 ? 'no snap' : `snap ${by} ${length}`)),
    )
    this.#mirrorField =
      mover.mirror &&
      el('input', {
        type: 'checkbox',
        checked: mover.mirror.on,
        'data-testid': 'mirror',
        onchange: () => (mover.mirror!.on = this.#mirrorField!.checked),
      })
    const done = el(
      'button',
      { type: 'button', title: 'Leave (Escape)', 'data-testid': 'grip-done', onclick: () => this.leave() },
      'Done',
    )
    this.pane.append(
      this.#name,
      el(
        'div',
        { class: 'coordinates' },
        ...AXES.map((axis, k) =>
          el(
            'label',
            // Out of its plane a planar mechanism does not move.
            { hidden: !this.#arrows.axes.includes(axis) },
            el('span', { class: `axis-${axis}` }, axis),
            this.#fields[k].input,
            this.#deltas[k],
          ),
        ),
        el('span', { class: 'unit' }, length),
      ),
      el(
        'div',
        { class: 'ways' },
        el('div', { class: 'ways', role: 'toolbar', 'aria-label': 'Direction' }, ...this.#directionButtons),
        snap,
        this.#mirrorField && el('label', { class: 'mirror' }, this.#mirrorField, 'mirror'),
        this.#reset,
        done,
      ),
      this.#refusal,
    )
  }

  #typed(k: number, value: number): string | undefined {
    const chosen = this.#chosen
    if (!chosen) return undefined
    const before = this.mover.place(chosen.grip)
    this.#moveTo(chosen, before.clone().setComponent(k, value), 0, before)
    this.#label.hidden = true
    this.#show(true)
    this.onRelease()
    return this.state.bound || undefined
  }

  #back(): void {
    if (!this.#chosen) return
    this.mover.move(this.#chosen.grip, new Vector3(...this.#chosen.grip.place))
    this.onRelease()
  }

  #show(all = false): void {
    this.pane.hidden = !this.on
    this.element.classList.toggle('refused', this.state.refusal !== '')
    const chosen = this.#chosen
    const hint = chosen
      ? 'Drag the point or an arrow; Shift: 10 times finer. Arrow keys step, X Y Z choose an axis, Escape leaves.'
      : 'Click a point to move it.'
    const touching = this.on && this.state.changed ? contactSentences(this.state) : []
    const words = [this.state.refusal || this.state.bound, ...touching].filter(Boolean).join(' ')
    this.#refusal.classList.toggle('hint', !words)
    setProse(this.#refusal, words || hint)
    this.#refusal.title = words
    setText(this.#name, chosen?.grip.name ?? 'No point chosen')
    setAttribute(this.#name, 'title', this.#name.textContent)
    this.#directionButtons.forEach((button, k) =>
      setAttribute(button, 'aria-pressed', this.#offered[k] === this.#direction),
    )
    for (const { input } of this.#fields) input.disabled = !chosen
    this.#reset.disabled = !chosen
    if (this.#mirrorField) this.#mirrorField.disabled = !chosen || !this.mover.mirror!.partner.has(chosen.grip.name)
    if (!chosen) return
    const place = this.mover.place(chosen.grip)
    let moved = false
    this.#fields.forEach((field, k) => {
      const [now, original] = [place.getComponent(k), chosen.grip.place[k]]
      const changed = this.mover.differ(now, original)
      moved ||= changed
      field.show(now, all)
      field.input.classList.toggle('changed', changed)
      setText(this.#deltas[k], changed ? signed(Number((now - original).toPrecision(6))) : '')
    })
    this.#reset.disabled = !moved
  }
}

/** A change of a coordinate with its sign. */
function signed(by: number): string {
  return `${by < 0 ? '−' : '+'}${entry(Math.abs(by), 6)}`
}
