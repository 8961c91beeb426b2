import { el, prose } from './dom'
import { pretty } from './format'
import type { Admissibility } from './payload'
import type { Variable } from './report'
import type { State } from './state'

const BADGES: Record<Admissibility, string> = {
  admissible: '',
  reassembled: 're-assembled',
  cannot_follow: 'cannot follow',
}

/** The design variables to choose from, and what is to be said about the chosen one. */
export function variables(state: State): HTMLElement {
  const { report } = state
  const buttons = report.variables.map((variable) =>
    el(
      'button',
      {
        type: 'button',
        class: variable.admissibility,
        'data-testid': `variable-${variable.name}`,
        onclick: () => state.choose({ variable: variable.index }),
      },
      el('span', { class: 'name' }, variable.name),
      unitOf(variable),
      el('span', { class: 'about' }, variable.description),
      badge(variable),
    ),
  )
  const note = el('p', { class: 'note', 'data-testid': 'variable-note', 'aria-live': 'polite' })
  const sync = () => {
    buttons.forEach((button, index) => button.setAttribute('aria-pressed', String(index === state.choice.variable)))
    const variable = report.variables[state.choice.variable]
    note.replaceChildren(...prose(variable?.note || variable?.description || ''))
  }
  state.onChoice(sync)
  sync()
  return el(
    'section',
    { class: 'variables' },
    el('h3', {}, `Design variables (${report.variables.length})`),
    el('ul', {}, ...buttons.map((button) => el('li', {}, button))),
    note,
  )
}

export function unitOf(variable: Variable): HTMLElement {
  return el('span', { class: 'unit' }, pretty(variable.unit) || 'pure number')
}

export function badge(variable: Variable): HTMLElement | undefined {
  const text = BADGES[variable.admissibility]
  return text ? el('span', { class: `badge ${variable.admissibility}`, title: variable.note }, text) : undefined
}
