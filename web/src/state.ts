import { valueAt, stepAt, type Course, type Curve } from './curve'
import { effects } from './effect'
import type { VariableSetting } from './engine/protocol'
import { curveOf, type Design, isGiven, type Order, ORDERS, type Report } from './report'
import type { Part } from './scene/drawable'
import { abscissaNamed, type Sheet, sheetOf } from './sheet'

/** A hardpoint of a body whose path is drawn. */
export type PathPoint = readonly [body: number, point: number]

export interface Choice {
  quantity: number
  variable: number
  order: Order
  /** The quantity that curves are drawn over; time where there is none. */
  over?: number
  /** Selection in the view: a body, a joint, a wheel, ... */
  selected?: Part
  /** Hardpoints whose paths are drawn. */
  traces: readonly PathPoint[]
  /** The measured distance that is pointed at, else the selected one: an index into the report's distances. */
  distance?: number
  /** True if hardpoints are named in the view. */
  labels: boolean
  /** True if forces are drawn in the view. */
  forces: boolean
  /** True if shapes and their nearest points are drawn in the view. */
  shapes: boolean
  /** True if the rigid mechanism is shown alongside the elastic one. */
  rigid: boolean
  /** The design that the present one is compared with; the one as loaded where there is none. */
  compared?: number
  /** Further designs in the plots: indices into the state's designs. */
  overlays?: readonly number[]
}

/** Heading over what is of the design as loaded. */
export const ORIGINAL = 'Original design'

/** Choices by names, which hold for another text of the model. */
export interface ChoiceMemory {
  quantity?: string
  over?: string
  variable?: string
  order: Order
  labels: boolean
  forces: boolean
  rigid: boolean
  /** Missing in what was stored before there were shapes. */
  shapes?: boolean
  /** Names of bodies and hardpoints; missing in what was stored when there was one path. */
  traces?: [body: string, point: string][]
  time: number
}

/** Positions of a hardpoint in the design configuration, of the original and the present design. */
export interface HardpointPlaces {
  name: string
  before: readonly number[]
  now: readonly number[]
}

/**
 * State of the page: the reader's choices and the moment shown; the views listen, and change it only through its
 * methods.
 */
export class State {
  choice: Choice
  /** Change of each variable from the model as loaded, in its unit. */
  readonly changes: number[]
  /** The same of coordinates of hardpoints that no variable is, by name. */
  readonly moves = new Map<string, number>()
  /**
   * Solves the design that the changes make, and indicates it by `solved`. Without it changes are predicted to first
   * order.
   */
  solver?: () => void
  /** Hardpoints of the original and the present design, where designs are solved. */
  hardpoints?: () => HardpointPlaces[]
  /** The bound that keeps the design from going as far as was requested. */
  bound = ''
  /** Reason why the design is not the requested one. */
  refusal = ''
  /** Case that is shown, if the model has several and they are known. */
  case?: string
  /** Reason why the sensitivities of the present design are not computed; empty if there is none. */
  unsolved = ''
  /** Designs that were kept to be compared with. */
  readonly comparisons: Design[] = []
  /** Fractional index into the times. */
  step = 0
  playing = false
  /** Seconds of motion per second of playback. */
  speed = 1
  #onChoice: (() => void)[] = []
  #onTime: (() => void)[] = []
  #onPoint: (() => void)[] = []
  #onHover: (() => void)[] = []
  #hovered?: number
  #onChange: (() => void)[] = []
  #pointed?: number
  #solved?: Design
  #isShort = false
  #sensitivities?: { report: Report; settings: string }
  #edition = 0
  #ending = new AbortController()

  /** Removes listeners beyond the page's own elements when the page is rebuilt. */
  get ended(): AbortSignal {
    return this.#ending.signal
  }

  /** Nothing of it is shown any more. */
  end(): void {
    this.pause()
    this.#ending.abort()
  }

  /** Plots that the page opens with. */
  readonly sheet: Sheet
  /** Changes of the design that the page was made of; its records, such as the front of a study, are of this design. */
  recorded: readonly VariableSetting[]

  constructor(readonly report: Report) {
    const sheet = sheetOf(report)
    const quantity = sheet.plots[0]?.y[0] ?? 0
    const variable =
      effects(report, quantity, 0)[0]?.variable.index ??
      report.variables.find(({ sensitivities }) => sensitivities.size > 0)?.index ??
      0
    const exact = report.designs.find(({ kind }) => kind === 'exact')
    this.changes = report.variables.map((_, index) => exact?.change[index] ?? 0)
    this.recorded = this.settings
    this.sheet = sheet
    this.choice = {
      quantity,
      variable,
      order: 0,
      over: sheet.plots[0]?.over,
      labels: false,
      forces: true,
      shapes: true,
      rigid: true,
      traces: [],
    }
  }

  /** Choices, to be made again on another page. */
  get memory(): ChoiceMemory {
    const { quantities, variables, bodies } = this.report
    const { quantity, variable, order, over, labels, forces, rigid, shapes, traces } = this.choice
    return {
      quantity: quantities[quantity]?.name,
      over: over === undefined ? undefined : quantities[over]?.name,
      variable: variables[variable]?.name,
      ...{ order, labels, forces, rigid, shapes },
      traces: traces.map(([body, point]) => [bodies[body].name, bodies[body].labels[point]]),
      time: this.time,
    }
  }

  /** Makes the choices of another page that are possible here, before anything of this one is shown. */
  recall({
    quantity,
    over,
    variable,
    order,
    labels,
    forces,
    rigid,
    shapes = true,
    traces = [],
    time,
  }: ChoiceMemory): void {
    const { quantities, variables, bodies } = this.report
    const named = (list: readonly { name: string }[], name: string | undefined, otherwise: number) => {
      const found = list.findIndex((one) => one.name === name)
      return found < 0 ? otherwise : found
    }
    const place = ([of, label]: [string, string]): PathPoint[] => {
      const body = bodies.findIndex(({ name }) => name === of)
      const point = bodies[body]?.labels.indexOf(label) ?? -1
      return point >= 0 ? [[body, point]] : []
    }
    Object.assign(this.choice, {
      quantity: named(quantities, quantity, this.choice.quantity),
      variable: named(variables, variable, this.choice.variable),
      over: abscissaNamed(this.report, over),
      ...{ order, labels, forces, rigid, shapes },
      traces: traces.flatMap(place),
    })
    this.step = stepAt(this.report.times, time)
  }

  get lastStep(): number {
    return Math.max(0, this.report.times.length - 1)
  }

  get time(): number {
    return valueAt(this.report.times, this.step)
  }

  /** Designs that the present one can be compared with: those of the report, then those that were kept. */
  get designs(): readonly Design[] {
    return [...this.report.designs, ...this.comparisons]
  }

  /** Changed variables, by name. */
  get settings(): VariableSetting[] {
    const changed = this.report.variables.flatMap(({ name }, index) =>
      this.changes[index] === 0 ? [] : [{ name, by: this.changes[index] }],
    )
    return [...changed, ...[...this.moves].map(([name, by]) => ({ name, by }))]
  }

  /**
   * Name of the design that the numbers of `sensitivityReport` belong to, if it is not the present one: they stand
   * under this heading.
   */
  get outdated(): string | undefined {
    if (this.hasCurrentSensitivities) return undefined
    return this.#sensitivities ? 'Design before the last change' : ORIGINAL
  }

  /** Step under the pointer in some plot; all plots read it. */
  get hovered(): number | undefined {
    return this.#hovered
  }

  /** The pointer is at a step of some plot, or leaves it. */
  hover(step: number | undefined): void {
    if (step === this.#hovered) return
    this.#hovered = step
    for (const listener of this.#onHover) listener()
  }

  onHover(listener: () => void): void {
    this.#onHover.push(listener)
  }

  /** Indicates one drawn design from another. */
  get edition(): string {
    return `${this.#edition} ${this.choice.compared} ${this.choice.rigid}`
  }

  /** The report whose sensitivities are shown: that of the present design, as soon as it is there. */
  get sensitivityReport(): Report {
    return this.#sensitivities?.report ?? this.report
  }

  /** True if the sensitivities shown are those of the present design. */
  get hasCurrentSensitivities(): boolean {
    return (this.#sensitivities?.settings ?? '[]') === JSON.stringify(this.settings)
  }

  /** True if the motion of the present design goes on where that of the original ends, at whose times curves are. */
  get isCutOff(): boolean {
    const [own, original] = [this.sensitivityReport.times, this.report.times]
    return this.hasCurrentSensitivities && own.length > 0 && own[own.length - 1] > original[original.length - 1]
  }

  /** Makes the present design the model's text, so that its whole motion is shown; undefined without an engine. */
  showWholeMotion?: () => void

  /** The solved changed design; undefined if it is predicted, or if there are no changes. */
  get present(): Design | undefined {
    if (this.#solved) return this.#solved
    if (this.moves.size > 0) return undefined
    return this.report.designs.find(
      ({ kind, change }) => kind === 'exact' && this.changes.every((by, index) => by === (change[index] ?? 0)),
    )
  }

  /** The design that the present one is compared with; the one as loaded where there is none. */
  get former(): Design | undefined {
    return this.choice.compared === undefined ? undefined : this.designs[this.choice.compared]
  }

  /** The present design with rigid joints, if it is known and shown; it is not the one that is compared with. */
  get rigid(): Design | undefined {
    const { report, sensitivityReport, hasCurrentSensitivities, changed, choice, former } = this
    if (!choice.rigid || (changed && !hasCurrentSensitivities) || former?.kind === 'rigid') return undefined
    return (changed ? sensitivityReport : report).designs.find(({ kind }) => kind === 'rigid')
  }

  /** Further designs in the plots: indices into the designs, without the reference. */
  get overlays(): number[] {
    const { designs, choice } = this
    return (choice.overlays ?? []).filter((k) => designs[k] && k !== choice.compared)
  }

  /** True if the present design differs from the one that it is compared with. */
  get isCompared(): boolean {
    return this.former ? this.former !== this.present : this.present !== undefined || this.changed
  }

  /** True if any variable is changed from the model as loaded. */
  get changed(): boolean {
    return this.moves.size > 0 || this.changes.some((by) => by !== 0)
  }

  /** True if the present design is the one that the page was made of. */
  get isRecorded(): boolean {
    return JSON.stringify(this.settings) === JSON.stringify(this.recorded)
  }

  /** True if the present design is predicted to first order instead of solved. */
  get isPredicted(): boolean {
    return this.changed && !this.present
  }

  /** A quantity of the present design, solved or predicted to first order. */
  curve(quantity: number, order: Order): Curve {
    const loaded = this.report.quantities[quantity].curves[order]
    const { present } = this
    if (present) {
      const own = curveOf(present, quantity, order)
      return own.length === 0 && isGiven(this.report.quantities[quantity]) ? loaded : own
    }
    if (!this.changed) return loaded
    const curve = loaded.slice()
    for (const { index, sensitivities } of this.report.variables) {
      const by = this.changes[index]
      const slope = sensitivities.get(quantity)?.curves[order]
      if (by !== 0 && slope) for (let k = 0; k < curve.length; k++) curve[k] += by * (slope[k] ?? NaN)
    }
    return curve
  }

  /** Values, rates and accelerations of a quantity of the present design. */
  course(quantity: number): Course {
    return ORDERS.map((_, order) => this.curve(quantity, order as Order))
  }

  /** A value of the present design, where it is known. */
  value(index: number): number | null {
    const { value, sensitivities } = this.report.values[index]
    const { present } = this
    if (present) return present.values[index] ?? null
    if (value === null) return null
    return this.changes.reduce(
      (sum: number | null, by, k) =>
        by === 0 ? sum : sum === null || sensitivities[k] == null ? null : sum + by * sensitivities[k],
      value,
    )
  }

  onChoice(listener: () => void): void {
    this.#onChoice.push(listener)
  }

  onTime(listener: () => void): void {
    this.#onTime.push(listener)
  }

  /** Called when another measured distance is pointed at, or none any more. */
  onPoint(listener: () => void): void {
    this.#onPoint.push(listener)
  }

  /** The quantity that the pointer or the keyboard is at, outside the view; nothing when it leaves. */
  point(quantity?: number): void {
    const before = this.choice.distance
    this.#pointed = quantity
    this.choice.distance = this.#distance()
    if (this.choice.distance === before) return
    for (const listener of this.#onPoint) listener()
  }

  choose(choice: Partial<Choice>): void {
    Object.assign(this.choice, choice)
    this.choice.distance = this.#distance()
    for (const listener of this.#onChoice) listener()
  }

  /** The measured distance that is pointed at; where there is none, the one that the selected quantity is. */
  #distance(): number | undefined {
    const { quantities, distances } = this.report
    const found = [this.#pointed, this.choice.quantity]
      .map((quantity) =>
        quantity === undefined ? -1 : distances.findIndex(({ name }) => name === quantities[quantity]?.name),
      )
      .find((index) => index >= 0)
    return found
  }

  /** Called when the reader changed the design. */
  onChange(listener: () => void): void {
    this.#onChange.push(listener)
  }

  /** Changes one variable, which thereby is the selected one. */
  change(variable: number, change: number): void {
    this.changes[variable] = change
    this.#changed(variable)
  }

  /** Changes coordinates and variables by name; others stay. */
  adjust(settings: VariableSetting[]): void {
    this.#apply(settings)
    this.#changed()
  }

  /** Makes the design that has these changes and no others. */
  setDesign(settings: VariableSetting[]): void {
    this.#clear()
    this.adjust(settings)
  }

  /** Takes every change back. */
  reset(): void {
    this.#clear()
    this.#changed()
  }

  /** Sentence on why the present design is not the requested one; empty if it is. */
  get shortfall(): string {
    return this.#isShort ? `${this.refusal}.` : ''
  }

  /**
   * The design with these changes was solved: it is the present one, and `isShort` if the requested one was not
   * reached. Later changes may be on their way already.
   */
  solved(
    design: Design | undefined,
    settings: VariableSetting[],
    { refusal = '', isShort = false, last }: { refusal?: string; isShort?: boolean; last: boolean },
  ): void {
    if (last) {
      this.#clear()
      this.#apply(settings)
    }
    this.#solved = settings.length > 0 ? design : undefined
    this.refusal = refusal
    this.#isShort = isShort
    this.#edition++
    this.choose({})
  }

  /** The report of the present design, with its own sensitivities. */
  setSensitivities(report: Report | undefined, settings: VariableSetting[]): void {
    this.#sensitivities = report && { report, settings: JSON.stringify(settings) }
    this.choose({})
  }

  /** Keeps a design to be compared with. */
  addComparison(design: Design): void {
    this.comparisons.push(design)
    this.choose({})
  }

  #clear(): void {
    this.changes.fill(0)
    this.moves.clear()
  }

  #apply(settings: VariableSetting[]): void {
    for (const { name, by } of settings) {
      const variable = this.report.variables.find((variable) => variable.name === name)
      if (variable) this.changes[variable.index] = by
      else if (by === 0) this.moves.delete(name)
      else this.moves.set(name, by)
    }
  }

  #changed(variable = this.choice.variable): void {
    const other = variable !== this.choice.variable
    this.choice.variable = variable
    // Solved results are shown when they arrive; predictions at once.
    if (!this.solver) this.#edition++
    if (!this.solver || other) this.choose({})
    this.solver?.()
    for (const listener of this.#onChange) listener()
  }

  goToStep(step: number): void {
    this.step = Math.min(Math.max(step, 0), this.lastStep)
    for (const listener of this.#onTime) listener()
  }

  goToTime(time: number): void {
    this.goToStep(stepAt(this.report.times, time))
  }

  /** Stops the playback and moves by whole steps. */
  nudge(steps: number): void {
    this.pause()
    this.goToStep(Math.round(this.step) + steps)
  }

  pause(): void {
    if (this.playing) this.toggle()
  }

  toggle(): void {
    if (this.lastStep === 0) return
    this.playing = !this.playing
    if (this.playing) {
      if (this.step >= this.lastStep) this.step = 0
      this.#play()
    }
    this.goToStep(this.playing ? this.step : Math.round(this.step))
  }

  #play(): void {
    let before = performance.now()
    const frame = (now: number) => {
      if (!this.playing) return
      const { times } = this.report
      const ahead = this.time + (Math.max(0, now - before) / 1000) * this.speed
      before = now
      if (ahead > times[this.lastStep]) this.goToStep(0)
      else this.goToTime(ahead)
      requestAnimationFrame(frame)
    }
    requestAnimationFrame(frame)
  }
}
