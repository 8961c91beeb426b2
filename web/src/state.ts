import { valueAt, stepAt } from './curve'
import type { Part } from './scene/drawn'
import { groups, type Order, type Quantity, type Report } from './report'

export interface Choice {
  quantity: number
  variable: number
  /** By how much the selected variable is changed in the view, in its unit. */
  change: number
  order: Order
  /** The quantity that curves are drawn over; time where there is none. */
  over?: number
  /** Plot the sensitivities to all variables of the unit, not just the largest. */
  all: boolean
  /** What is selected in the view: a body, a joint, a wheel, ... */
  selected?: Part
  /** Body and hardpoint whose path is drawn. */
  trace?: [body: number, point: number]
  /** The measured distance whose value is pointed at, an index into the report's distances. */
  distance?: number
}

/** What the reader chose and the moment shown; the views listen, and change it only through its methods. */
export class State {
  choice: Choice
  /** Fractional index into the times. */
  step = 0
  playing = false
  /** Seconds of motion per second of playback. */
  speed = 1
  #onChoice: (() => void)[] = []
  #onTime: (() => void)[] = []

  constructor(readonly report: Report) {
    const offered = groups(report).flatMap(([, members]) => members)
    const moved = ({ index }: Quantity) => report.variables.some(({ sensitivities }) => (sensitivities.get(index)?.peaks[0] ?? 0) > 0)
    const first = offered.find(moved) ?? offered[0]
    const able = report.variables.find((variable) => variable.sensitivities.size > 0)
    this.choice = { quantity: first?.index ?? 0, variable: able?.index ?? 0, change: 0, order: 0, all: false }
  }

  get lastStep(): number {
    return Math.max(0, this.report.times.length - 1)
  }

  get time(): number {
    return valueAt(this.report.times, this.step)
  }

  onChoice(listener: () => void): void {
    this.#onChoice.push(listener)
  }

  onTime(listener: () => void): void {
    this.#onTime.push(listener)
  }

  choose(change: Partial<Choice>): void {
    // Another variable has not been changed yet.
    Object.assign(this.choice, change.variable === undefined ? {} : { change: 0 }, change)
    for (const listener of this.#onChoice) listener()
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
