import { el } from './dom'
import type { Admissibility } from './payload'
import type { Variable } from './report'

const BADGES: Record<Admissibility, string> = {
  admissible: '',
  reassembled: 're-assembled',
  cannot_follow: 'cannot follow',
}

/** How the mechanism follows a variable, where that is not simply so. */
export function badge(variable: Variable): HTMLElement | undefined {
  const text = BADGES[variable.admissibility]
  return text ? el('span', { class: `badge ${variable.admissibility}`, title: variable.note }, text) : undefined
}
