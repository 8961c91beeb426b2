import { amount } from '../amount'
import { el, prose } from '../dom'
import type { SearchGoal } from '../engine/engine'
import { pretty } from '../format'
import { type Aim, type Chosen, isPlaced, type Judged, type Take, TAKES } from './goal'

/** Quantities and cases of a model, and the way to add a goal to it. */
export interface GoalHost {
  quantities: () => readonly { name: string; unit: string }[]
  cases: () => readonly string[]
  /** Quantity of the leading plot, and the one that it is shown over. */
  selected: () => Proposal
  add: (judged: Judged, aim: Aim, chosen: Chosen) => void
}

/** Present choices of the form that a goal is added to. */
export interface Surroundings {
  chosen: () => Chosen
  /** Reason why no limit can be added; empty if it can. */
  limitBlocked: () => string
}

/** Quantity or metric that a goal is proposed for. */
export interface Proposal {
  of: string
  over?: string
  case?: string
}

const AIMS = { minimise: 'minimise', bring: 'bring to', keep: 'keep within' } as const

/** Form of a new goal or limit: a value, and what is wanted of it. */
export class GoalForm {
  readonly element: HTMLDetailsElement
  #of: HTMLSelectElement
  #take = select('Reduction', 'goal-take', Object.entries(TAKES))
  #over: HTMLSelectElement
  #at = textField('position', 'goal-at')
  #case: HTMLSelectElement
  #aim = select('Aim', 'goal-aim', Object.entries(AIMS))
  #target = textField('target of the new goal', 'goal-target')
  #min = textField('lower limit', 'goal-min')
  #max = textField('upper limit', 'goal-max')
  #add = el('button', { type: 'button', 'data-testid': 'goal-add', onclick: () => this.#submit() }, 'Add')
  #why = el('p', { class: 'muted', 'data-testid': 'goal-why', role: 'status' })
  #reduction: HTMLElement
  #unit = el('span', { class: 'unit' })
  /** True if it has entries of the reader that are not submitted. */
  #isEntered = false

  constructor(
    private readonly host: GoalHost,
    private readonly metrics: readonly SearchGoal[],
    private readonly around: Surroundings,
    private readonly onAdd: (judged: Judged, aim: Aim) => void,
  ) {
    const quantities = host.quantities()
    const cases = host.cases()
    this.#of = el(
      'select',
      { 'aria-label': 'Value', 'data-testid': 'goal-of' },
      metrics.length > 0 &&
        el('optgroup', { label: 'metrics' }, ...metrics.map(({ metric }) => option(`metric ${metric}`, metric))),
      el('optgroup', { label: 'quantities' }, ...quantities.map(({ name }) => option(`of ${name}`, name))),
    )
    this.#over = select('Over', 'goal-over', [
      ['', 'over time'],
      ...quantities.map(({ name }): [string, string] => [name, `over ${name}`]),
    ])
    this.#case = select('Case', 'goal-case', [
      ['', 'in every case'],
      ...cases.map((name): [string, string] => [name, `in ${name}`]),
    ])
    this.#case.hidden = cases.length < 2
    this.#reduction = el('div', { class: 'goal-row' }, this.#take, this.#at, this.#over, this.#case)
    const isOpen = metrics.length === 0
    this.element = el(
      'details',
      {
        class: 'goal-form',
        'data-testid': 'goal-form',
        open: isOpen,
        // Within the form of the study, but not part of its request.
        oninput: (event: Event) => (event.stopPropagation(), (this.#isEntered = true), this.sync()),
        onkeydown: (event: KeyboardEvent) => {
          if (event.key !== 'Enter' || !(event.target instanceof HTMLInputElement)) return
          event.preventDefault()
          this.#submit()
        },
      },
      el('summary', {}, 'Add a goal or a limit'),
      el('div', { class: 'goal-row' }, this.#of),
      this.#reduction,
      el('div', { class: 'goal-row' }, this.#aim, this.#target, this.#min, this.#max, this.#unit, this.#add),
      this.#why,
    )
    this.#choose(host.selected(), isOpen)
  }

  /** Takes over what was entered in the form of another text, as far as it is still offered. */
  adopt(former: GoalForm): void {
    if (!former.#isEntered) return
    this.#isEntered = true
    this.element.open = former.element.open
    const fields = (form: GoalForm) => [form.#of, form.#take, form.#over, form.#case, form.#aim]
    fields(this).forEach((field, k) => {
      const { value } = fields(former)[k]
      if ([...field.options].some((option) => option.value === value)) field.value = value
    })
    const typed = (form: GoalForm) => [form.#at, form.#target, form.#min, form.#max]
    typed(this).forEach((field, k) => (field.value = typed(former)[k].value))
    this.sync()
  }

  /** Chooses what a goal is for. */
  propose(proposal: Proposal): void {
    this.#isEntered = true
    this.#choose(proposal, true)
  }

  #choose({ of, over, case: shown }: Proposal, isOpen: boolean): void {
    const isMetric = this.metrics.some(({ metric }) => metric === of)
    this.#of.value = isMetric ? `metric ${of}` : `of ${of}`
    if (!this.#of.value) this.#of.selectedIndex = 0
    this.#over.value = over ?? ''
    this.#case.value = shown ?? ''
    this.element.open = isOpen
    this.sync()
  }

  get #metric(): string | undefined {
    return /^metric (.*)/.exec(this.#of.value)?.[1]
  }

  get #quantity(): string {
    return this.#of.value.replace(/^of /, '')
  }

  /** Unit of the value that is judged, before it is reduced. */
  get #unitOfValue(): string {
    const metric = this.#metric
    const found =
      metric === undefined
        ? this.host.quantities().find(({ name }) => name === this.#quantity)
        : this.metrics.find((one) => one.metric === metric)
    return found?.unit ?? '1'
  }

  /** Shows the fields that are of use and what is missing, also when the choices around it are others. */
  sync(): void {
    const take = this.#take.value as Take
    const isMetric = this.#metric !== undefined
    this.#reduction.hidden = isMetric
    this.#at.hidden = !isPlaced(take)
    this.#target.hidden = this.#aim.value !== 'bring'
    this.#min.hidden = this.#max.hidden = this.#aim.value !== 'keep'
    const isNumber = this.#aim.value === 'minimise' || (!isMetric && take === 'slope')
    this.#unit.textContent = isNumber ? '' : pretty(this.#unitOfValue)
    const found = this.#wanted()
    this.#add.disabled = typeof found === 'string'
    this.#why.replaceChildren(...prose(typeof found === 'string' ? found : ''))
  }

  /** The goal or limit that is to be added; a sentence where something is missing. */
  #wanted(): { judged: Judged; aim: Aim } | string {
    const unit = this.#unitOfValue
    const take = this.#take.value as Take
    const isMetric = this.#metric !== undefined
    const isSlope = !isMetric && take === 'slope'
    const read = (field: HTMLInputElement) => {
      const typed = amount(field.value, isSlope ? '1' : unit)
      return typeof typed === 'string' ? typed : typed.value
    }
    const at = isPlaced(take) && !isMetric ? amount(this.#at.value, '1') : undefined
    if (typeof at === 'string') return this.#at.value === '' ? 'Enter the position.' : at
    const judged: Judged = isMetric
      ? { metric: this.#metric! }
      : {
          of: this.#quantity,
          take,
          over: this.#over.value || undefined,
          at: at?.value,
          case: this.#case.value || undefined,
        }
    switch (this.#aim.value as keyof typeof AIMS) {
      case 'minimise':
        return { judged, aim: { kind: 'minimise' } }
      case 'bring': {
        if (!isMetric && take === 'rms') return 'An RMS is minimised: it has no target of its own.'
        const target = read(this.#target)
        if (typeof target === 'string') return this.#target.value === '' ? 'Enter the target.' : target
        return { judged, aim: { kind: 'bring', target } }
      }
      case 'keep': {
        const ends = [this.#min, this.#max].map((field) => (field.value.trim() === '' ? undefined : read(field)))
        const wrong = ends.find((end) => typeof end === 'string')
        if (typeof wrong === 'string') return wrong
        const [min, max] = ends as (number | undefined)[]
        const blocked = this.around.limitBlocked()
        if (blocked) return blocked
        if (min === undefined && max === undefined) return 'Enter a lower limit, an upper limit, or both.'
        if (min !== undefined && max !== undefined && min > max) return 'The lower limit is above the upper limit.'
        return { judged, aim: { kind: 'keep', min, max } }
      }
    }
  }

  #submit(): void {
    const found = this.#wanted()
    if (typeof found === 'string') return
    this.#add.disabled = true
    this.#why.textContent = 'Adding…'
    this.#isEntered = false
    this.onAdd(found.judged, found.aim)
    this.host.add(found.judged, found.aim, this.around.chosen())
  }
}

function option(value: string, text: string): HTMLOptionElement {
  return el('option', { value }, text)
}

function select(label: string, testId: string, options: [value: string, text: string][]): HTMLSelectElement {
  return el(
    'select',
    { 'aria-label': label, 'data-testid': testId },
    ...options.map(([value, text]) => option(value, text)),
  )
}

function textField(label: string, testId: string): HTMLInputElement {
  return el('input', { class: 'number-field', 'aria-label': label, placeholder: label, 'data-testid': testId })
}
