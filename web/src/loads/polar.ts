import './loads.css'
import { Vector3 } from 'three'
import { valueAt } from '../curve'
import { el, svg } from '../dom'
import { roundStep } from '../export/axis'
import { number } from '../format'
import type { Load } from '../report'
import type { State } from '../state'
import { poseAt } from '../scene/poses'
import { forceAt, largestAt, largestForce, pathOf, planeAcross, seenFrom, type Plane } from './force'

/** The picture is so wide and high, and its largest circle leaves so much room, px. */
const SIZE = 340
const ROOM = 26
/** Approximate number of circles. */
const RINGS = 3
/** A place of the path is pointed at from so far, px. */
const REACH = 30

/** The paths of forces in body components, in a plane of their frame, with the maximum of each. */
export function forcePaths(state: State): HTMLElement {
  return new Polar(state).element
}

/** View of a force: its body and its plane. */
interface View {
  load: Load
  sign: 1 | -1
  body: number
  plane: Plane
}

class Polar {
  readonly element: HTMLElement
  readonly #which: HTMLSelectElement
  readonly #on = el('select', {
    'aria-label': 'reference body',
    'data-testid': 'load-body',
    onchange: () => this.#draw(),
  })
  readonly #along = el('select', {
    'aria-label': 'direction of view',
    'data-testid': 'load-along',
    onchange: () => this.#draw(),
  })
  readonly #picture = svg('svg', { role: 'img', viewBox: `0 0 ${SIZE} ${SIZE}`, 'data-testid': 'load-path' })
  readonly #now = svg('g', {})
  readonly #reading = el('output', { class: 'reading', 'aria-live': 'off', 'data-testid': 'load-reading' })
  readonly #table = el('tbody')
  #view?: View
  #path: [number, number][] = []
  #scale = 1

  constructor(private readonly state: State) {
    const { loads, bodies } = state.report
    const name = (load: Load, k: number) => {
      const isUnique = loads.every((other, j) => j === k || other.name !== load.name)
      return isUnique ? load.name : `${load.name} on ${bodies[load.at.body].name}`
    }
    const group = (label: string, ofJoints: boolean) => {
      const members = loads.flatMap((load, k) =>
        (load.joint !== null) === ofJoints ? [el('option', { value: k }, name(load, k))] : [],
      )
      return members.length > 0 ? [el('optgroup', { label }, ...members)] : []
    }
    this.#which = el(
      'select',
      { 'aria-label': 'force', 'data-testid': 'load-which', onchange: () => this.#choose(Number(this.#which.value)) },
      ...group('joints', true),
      ...group('forces', false),
    )
    this.#picture.addEventListener('pointerdown', (event) => this.#point(event as PointerEvent))
    const header = el(
      'tr',
      {},
      ...['force', 'on', 'largest [N]', 'at [s]'].map((title) => el('th', { scope: 'col' }, title)),
    )
    this.element = el(
      'section',
      { class: 'loads', 'data-testid': 'loads' },
      el(
        'p',
        { class: 'choice' },
        el('label', {}, 'Force of ', this.#which),
        el('label', {}, 'as seen from ', this.#on),
        el('label', {}, 'looking along ', this.#along),
      ),
      el('div', { class: 'seen' }, this.#picture, this.#reading),
      el('table', {}, el('thead', {}, header), this.#table),
    )
    this.#choose(this.#largest())
    state.onTime(() => this.#mark())
    state.onChoice(() => this.#follow())
  }

  /** The joint with the largest force; else the largest force. */
  #largest(): number {
    const { loads } = this.state.report
    const of = (k: number) => (loads[k].joint === null ? 0 : 1e30) + largestForce([loads[k]])
    return loads.reduce((best, _, k) => (of(k) > of(best) ? k : best), 0)
  }

  /** A joint that is selected in the view is shown here. */
  #follow(): void {
    const { selected } = this.state.choice
    const { loads } = this.state.report
    const index = loads.findIndex(
      (load, k) =>
        (selected?.kind === 'joint' && load.joint === selected.index) ||
        (selected?.kind === 'load' && k === selected.index),
    )
    if (index >= 0 && index !== Number(this.#which.value)) this.#choose(index)
    else this.#draw()
  }

  #choose(index: number): void {
    this.#which.value = String(index)
    const { bodies, joints, loads } = this.state.report
    const load = loads[index]
    const joint = load.joint === null ? undefined : joints[load.joint]
    // Bearings in components of their housing, pins in their own.
    this.#on.replaceChildren(
      ...(joint ? [joint.body_j, joint.body_i] : [load.at.body]).map((body) =>
        el('option', { value: body }, bodies[body].name),
      ),
    )
    const options = [...(joint?.axis ? [['axis', 'its axis']] : []), ['0', 'x'], ['1', 'y'], ['2', 'z']]
    this.#along.replaceChildren(...options.map(([value, text]) => el('option', { value }, text)))
    if (!joint?.axis) this.#along.value = '2'
    this.#draw()
  }

  #draw(): void {
    const { report, former, isCompared, present, changed } = this.state
    const index = Number(this.#which.value)
    const load = report.loads[index]
    const joint = load.joint === null ? undefined : report.joints[load.joint]
    const body = Number(this.#on.value)
    const second = body === load.at.body
    const axis = second ? joint?.axis_j : joint?.axis
    const normal =
      this.#along.value === 'axis' && axis
        ? new Vector3(...axis)
        : new Vector3().setComponent(this.#along.value === 'axis' ? 2 : Number(this.#along.value), 1)
    const plane = planeAcross(normal)
    const sign = second ? 1 : -1
    this.#view = { load, sign, body, plane }
    const of = (force: Load['force'] | undefined, poses: Load['force'] | undefined) =>
      force && poses ? pathOf(force, poses, plane, sign) : []
    const loaded = () => of(load.force, report.bodies[body].poses)
    this.#path = present ? of(present.loads[index], present.poses[body]) : changed ? [] : loaded()
    const before = !isCompared ? [] : former ? of(former.loads[index], former.poses[body]) : loaded()
    const sizes = [...this.#path, ...before].map(([x, y]) => Math.hypot(x, y)).filter(Number.isFinite)
    const maximum = sizes.reduce((a, b) => Math.max(a, b), 0)
    const step = maximum > 0 ? roundStep(maximum / RINGS) : 1
    const rings = Math.max(1, Math.ceil(maximum / step - 1e-9))
    const [middle, radius] = [SIZE / 2, SIZE / 2 - ROOM]
    this.#scale = radius / (rings * step)
    const title = `Force of ${load.name} on ${report.bodies[body].name}, N`
    this.#picture.setAttribute('aria-label', title)
    const circles = Array.from({ length: rings }, (_, k) => (k + 1) * step)
    this.#picture.replaceChildren(
      ...circles.map((size) => svg('circle', { class: 'ring', cx: middle, cy: middle, r: size * this.#scale })),
      svg('path', { class: 'ring', d: `M${ROOM},${middle}H${SIZE - ROOM}M${middle},${ROOM}V${SIZE - ROOM}` }),
      ...circles.map((size, k) =>
        text(
          `${number(size, 3)}${k === rings - 1 ? ' N' : ''}`,
          middle + size * this.#scale * Math.SQRT1_2,
          middle + size * this.#scale * Math.SQRT1_2 + 12,
          'start',
        ),
      ),
      text(plane.names[0], SIZE - ROOM + 4, middle + 4, 'start'),
      text(plane.names[1], middle, ROOM - 8, 'middle'),
      svg('path', { class: 'path former', d: this.#line(before) }),
      svg('path', { class: 'path', d: this.#line(this.#path), 'data-testid': 'load-line' }),
      this.#now,
    )
    this.#list(index)
    this.#mark()
  }

  /** The path in pixels, with gaps where nothing is known. */
  #line(path: [number, number][]): string {
    let pen = 'M'
    return path
      .map((at) => {
        const known = Number.isFinite(at[0])
        const piece = known
          ? pen +
            this.#pixels(at)
              .map((x) => x.toFixed(1))
              .join(',')
          : ''
        pen = known ? 'L' : 'M'
        return piece
      })
      .join('')
  }

  #pixels([x, y]: [number, number]): [number, number] {
    return [SIZE / 2 + x * this.#scale, SIZE / 2 - y * this.#scale]
  }

  /** Marks the present force and its largest value. */
  #mark(): void {
    const { report, present, step, changed } = this.state
    if (!this.#view) return
    const { load, sign, body, plane } = this.#view
    const index = Number(this.#which.value)
    const force = present ? present.loads[index] : changed ? undefined : load.force
    const pose = poseAt(present ? present.poses[body] : report.bodies[body].poses, step)
    if (!force?.length || !pose) {
      this.#now.replaceChildren()
      this.#reading.textContent = changed
        ? 'Forces of this design are available once it is solved.'
        : 'The force is not available here.'
      return
    }
    const world = forceAt(force, step).multiplyScalar(sign)
    const at = seenFrom(world, pose.turn, plane)
    if (!at.every(Number.isFinite)) {
      this.#now.replaceChildren()
      this.#reading.textContent = 'Redundant constraints leave this force undetermined.'
      return
    }
    const [x, y] = this.#pixels(at)
    this.#now.replaceChildren(
      svg('path', { class: 'now', d: `M${SIZE / 2},${SIZE / 2}L${x.toFixed(1)},${y.toFixed(1)}` }),
      svg('circle', { class: 'dot', cx: x, cy: y, r: 5 }),
    )
    const angle = (Math.atan2(at[1], at[0]) * 180) / Math.PI
    const size = Math.hypot(...at)
    const when = largestAt(force)
    const parts = [
      `${number(size, 4)} N at ${number(Number(angle.toFixed(1)), 4)}° from ${plane.names[0]} now;`,
      `magnitude ${number(world.length(), 4)} N,`,
      `largest ${number(forceAt(force, when).length(), 4)} N at ${number(valueAt(report.times, when), 4)} s.`,
      load.is_part ? 'Redundant constraints leave a part of it undetermined; only the determined part is shown.' : '',
    ]
    this.#reading.textContent = parts.join(' ').trim()
  }

  /** All forces with their largest size; a click chooses one. */
  #list(chosen: number): void {
    const { report, present, changed } = this.state
    const rows = report.loads.map((load, k) => {
      const force = present ? present.loads[k] : changed ? undefined : load.force
      const maximum = force ? largestForce([{ ...load, force }]) : NaN
      const cells = [
        load.name,
        report.bodies[load.at.body].name,
        maximum > 0 ? number(maximum, 4) : '–',
        maximum > 0 ? number(valueAt(report.times, largestAt(force!)), 4) : '–',
      ]
      return el(
        'tr',
        { 'aria-selected': String(k === chosen), 'data-testid': 'load-row', onclick: () => this.#choose(k) },
        ...cells.map((cell) => el('td', {}, cell)),
      )
    })
    this.#table.replaceChildren(...rows)
  }

  /** Sets the time at which the path is nearest to the pointer. */
  #point(event: PointerEvent): void {
    const box = this.#picture.getBoundingClientRect()
    const [px, py] = [((event.clientX - box.left) / box.width) * SIZE, ((event.clientY - box.top) / box.height) * SIZE]
    let [best, minimum] = [-1, REACH]
    this.#path.forEach((at, k) => {
      const [x, y] = this.#pixels(at)
      const distance = Math.hypot(x - px, y - py)
      if (distance < minimum) [best, minimum] = [k, distance]
    })
    if (best < 0) return
    this.state.pause()
    this.state.goToTime(valueAt(this.state.report.times, best))
  }
}

function text(words: string, x: number, y: number, anchor: string): SVGElement {
  return svg('text', { x, y, 'text-anchor': anchor }, document.createTextNode(words))
}
