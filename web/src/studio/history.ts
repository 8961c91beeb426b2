import type { VariableSetting } from '../engine/protocol'

/** A design, as it can be come back to. */
export interface Step {
  /** The model's text that the changes count from. */
  text: string
  /** Values of design variables and coordinates of hardpoints, by name. */
  settings: readonly VariableSetting[]
  /** Source of the change: `tie_rod_outer_z`, `typed`, `optimised`. */
  label: string
}

/** A design that was given a name. */
export interface Snapshot {
  readonly id: number
  name: string
  readonly step: Step
  /** True for a design of the model's text, which keeps its name and stays in the list. */
  readonly isOfFile: boolean
  /** True if a text of the model has or had it: while the present one has its name, the text's design is listed. */
  isWritten: boolean
}

/** Steps that are kept; earlier ones are forgotten, but for the first. */
const MAX_STEPS = 200

/** The designs that a reader has been through, to go back and forth, and those that were given a name. */
export class History {
  readonly #steps: Step[]
  readonly #own: Snapshot[] = []
  #ofFile: readonly Snapshot[] = []
  #compared: readonly Snapshot[] = []
  readonly #listeners: (() => void)[] = []
  #at = 0
  /** Source of the last step, as long as it may be continued. */
  #gesture?: string
  #named = 0

  constructor(
    readonly first: Step,
    private readonly limit = MAX_STEPS,
  ) {
    this.#steps = [first]
  }

  /** The design that is shown. */
  get present(): Step {
    return this.#steps[this.#at]
  }

  /** Steps that undo and redo would take; undefined without one. */
  get undoable(): string | undefined {
    return this.#at > 0 ? this.present.label : undefined
  }

  get redoable(): string | undefined {
    return this.#steps[this.#at + 1]?.label
  }

  /** True if the present design is another than the first. */
  get changed(): boolean {
    return !same(this.present, this.first)
  }

  get snapshots(): readonly Snapshot[] {
    const isListed = ({ isWritten, name }: Snapshot) => !isWritten || this.#ofFile.every((one) => one.name !== name)
    return [...this.#ofFile, ...this.#own.filter(isListed)]
  }

  /** Named designs that are compared with the present one; the last is the reference. */
  get compared(): readonly Snapshot[] {
    return this.#compared
  }

  /** Compares with these designs and no others. */
  compareWith(compared: readonly Snapshot[]): void {
    this.#compared = compared
    this.#notify()
  }

  /** Called whenever anything of it is another. */
  onChange(listener: () => void): void {
    this.#listeners.push(listener)
  }

  /**
   * Goes on to a design. What the same `hand` does without a pause, such as all of a drag, is one step; `rest` ends it.
   * A step that comes back to where it began is none.
   */
  go(step: Step, gesture?: string): void {
    const isContinued = gesture !== undefined && gesture === this.#gesture
    if (same(step, this.present)) {
      if (!isContinued) this.#gesture = undefined
      return
    }
    this.#gesture = gesture
    this.#steps.length = this.#at + 1
    if (isContinued) this.#steps.length = this.#at
    this.#steps.push(step)
    this.#at = this.#steps.length - 1
    if (isContinued && same(step, this.#steps[this.#at - 1])) {
      this.#steps.length = this.#at
      this.#at--
      this.#gesture = undefined
    }
    // Of the first there is no step to be undone: it is what all comes back to.
    if (this.#steps.length > this.limit) {
      this.#steps.splice(1, this.#steps.length - this.limit)
      this.#at = this.#steps.length - 1
    }
    this.#notify()
  }

  /** Ends what a hand does: it has let go. */
  endGesture(): void {
    this.#gesture = undefined
  }

  /** Goes one step back; undefined at the first. */
  undo(): Step | undefined {
    return this.#move(-1)
  }

  redo(): Step | undefined {
    return this.#move(1)
  }

  /** Goes to the first design, as a step that can be undone. */
  reset(): Step {
    this.go({ ...this.first, label: 'reset' })
    return this.present
  }

  /** Gives the present design a name; `design 1` and so on where none is given. */
  save(name = '', step = this.present): Snapshot {
    this.#named++
    const snapshot = { id: this.#named, name: this.#free(name.trim()), step, isOfFile: false, isWritten: false }
    this.#own.push(snapshot)
    this.#notify()
    return snapshot
  }

  /** Lists the named designs of a text in place of those of the text before; compared ones stay so by their names. */
  setFileDesigns(designs: readonly { name: string; changes: readonly VariableSetting[] }[], text: string): void {
    const written = this.#own.filter(({ isWritten }) => isWritten).map(({ name }) => name)
    this.#ofFile = []
    this.#ofFile = designs.map(({ name, changes }) => {
      const step = { text, settings: changes, label: name }
      const shown = written.includes(name) ? name : this.#free(name)
      return { id: ++this.#named, name: shown, step, isOfFile: true, isWritten: true }
    })
    const listed = this.snapshots
    this.#compared = this.#compared.flatMap((one) =>
      one.isWritten ? (listed.find(({ name }) => name === one.name) ?? []) : one,
    )
    this.#notify()
  }

  /** Goes to a design that was given a name, as a step that can be undone. */
  restore(snapshot: Snapshot): Step {
    this.go({ ...snapshot.step, label: snapshot.name })
    return this.present
  }

  /** Without a name it keeps the one that it has; a name that another design has gets a number. */
  rename(snapshot: Snapshot, name: string): void {
    if (name.trim() !== snapshot.name) snapshot.name = name.trim() ? this.#free(name.trim()) : snapshot.name
    this.#notify()
  }

  /** Notes that the next text has this design. */
  markWritten(snapshot: Snapshot): void {
    snapshot.isWritten = true
  }

  remove(snapshot: Snapshot): void {
    const at = this.#own.indexOf(snapshot)
    if (at >= 0) this.#own.splice(at, 1)
    this.#compared = this.#compared.filter((one) => one !== snapshot)
    this.#notify()
  }

  /** The name, with a number if it is taken; `design 1` and so on without one. */
  #free(name: string): string {
    const taken = new Set(this.snapshots.map(({ name }) => name))
    if (name !== '' && !taken.has(name)) return name
    const stem = name || 'design'
    for (let k = name === '' ? 1 : 2; ; k++) if (!taken.has(`${stem} ${k}`)) return `${stem} ${k}`
  }

  #move(by: number): Step | undefined {
    this.#gesture = undefined
    if (!this.#steps[this.#at + by]) return undefined
    this.#at += by
    this.#notify()
    return this.present
  }

  #notify(): void {
    for (const listener of this.#listeners) listener()
  }
}

function same(a: Step, b: Step): boolean {
  const changes = ({ settings }: Step) =>
    JSON.stringify(
      settings
        .filter(({ by }) => by !== 0)
        .map(({ name, by }) => [name, by])
        .sort(),
    )
  return a.text === b.text && changes(a) === changes(b)
}
