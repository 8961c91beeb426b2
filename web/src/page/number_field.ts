import './number_field.css'
import { amount, entry } from '../amount'
import { el, prose } from '../dom'

/** Distance of a message from its field, px. */
const GAP = 4

interface NumberFieldOptions {
  label: string
  testId?: string
  unit: string
  /** Step of the arrow keys, with Shift a tenth of it. */
  step: number
  /** Meaning of a leading `+`: it adds to the present value, or is only a sign, where the field is of a change. */
  plus: 'adds' | 'sign'
  /** Significant digits. */
  digits?: number
  /** Applies a value; returns a sentence where it is limited. */
  apply: (value: number) => string | undefined | void
}

/**
 * A field for a number with a unit. What cannot be read stays in the field, with a message that says why; Escape takes
 * it back.
 */
export class NumberField {
  readonly input: HTMLInputElement
  /** Undefined where the field is empty. */
  #value?: number
  #dirty = false

  constructor(private readonly options: NumberFieldOptions) {
    const { label, testId, plus } = options
    this.input = el('input', {
      type: 'text',
      class: 'number-field',
      inputmode: 'text',
      autocomplete: 'off',
      spellcheck: 'false',
      'aria-label': label,
      'data-testid': testId,
      title: `12, 2.5, 1/2 in; ${plus === 'adds' ? '+2 adds' : '+=2 adds'}, -=2 subtracts; ↑ ↓ step, with Shift finer`,
      oninput: () => {
        this.#dirty = true
        this.#complain('')
      },
      onchange: () => this.#commit(),
      onkeydown: (event: KeyboardEvent) => this.#key(event),
    })
  }

  /** Shows a value, unless another one is being typed. */
  show(value: number, force = false): void {
    const same = Object.is(value, this.#value)
    this.#value = value
    if (this.#dirty && !force && (same || document.activeElement === this.input)) return
    this.#reset()
  }

  #reset(): void {
    this.#dirty = false
    this.#complain('')
    const text = this.#value === undefined ? '' : entry(this.#value, this.options.digits)
    if (this.input.value !== text) this.input.value = text
  }

  #commit(): void {
    const typed = amount(this.input.value, this.options.unit)
    if (typeof typed === 'string') return this.#complain(typed)
    const adds = typed.form === 'step' || (typed.form === 'plus' && this.options.plus === 'adds')
    this.#apply(adds ? (this.#value ?? 0) + typed.value : typed.value)
  }

  #apply(value: number): void {
    this.#dirty = false
    // A sum such as 0.1 + 0.2 is a number with as few digits as its parts.
    this.#value = Number(value.toPrecision(12))
    const limited = this.options.apply(this.#value)
    this.#reset()
    if (limited) announce(this.input, limited)
  }

  #key(event: KeyboardEvent): void {
    if (event.key === 'Escape' && this.#dirty) {
      this.#reset()
      event.stopPropagation()
      event.preventDefault()
    }
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key]
    if (!way || event.altKey || event.ctrlKey || event.metaKey) return
    event.preventDefault()
    event.stopPropagation()
    if (this.#dirty) this.#commit()
    if (!this.#dirty) this.#apply((this.#value ?? 0) + way * this.options.step * (event.shiftKey ? 0.1 : 1))
  }

  #complain(message: string): void {
    this.input.toggleAttribute('aria-invalid', message !== '')
    if (message) this.input.setAttribute('aria-invalid', 'true')
    if (message) announce(this.input, message)
    else if (bubble?.dataset.of === id(this.input)) hide()
  }
}

let bubble: HTMLElement | undefined
let fields = 0

function id(input: HTMLInputElement): string {
  input.id ||= `number-${++fields}`
  return input.id
}

/** Shows a message at a field, until a key or the pointer is pressed. */
export function announce(input: HTMLInputElement, message: string): void {
  bubble ??= el('p', { class: 'field-error', role: 'alert', id: 'field-error', 'data-testid': 'field-error' })
  const { left, bottom, top } = input.getBoundingClientRect()
  bubble.dataset.of = id(input)
  bubble.replaceChildren(...prose(message))
  bubble.hidden = false
  // Within an open dialog nothing else is above it.
  const host = input.closest('dialog') ?? document.body
  if (bubble.parentElement !== host) host.append(bubble)
  input.setAttribute('aria-describedby', bubble.id)
  const { width, height } = bubble.getBoundingClientRect()
  bubble.style.left = `${Math.max(GAP, Math.min(left, innerWidth - width - GAP))}px`
  bubble.style.top = `${bottom + GAP + height > innerHeight ? top - GAP - height : bottom + GAP}px`
  addEventListener('pointerdown', hide, { capture: true, once: true })
}

function hide(): void {
  if (bubble) bubble.hidden = true
}
