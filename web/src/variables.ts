import { el } from './dom'
import type { Admissibility } from './payload'
import type { Variable } from './report'

const BADGES: Record<Admissibility, string> = {
  admissible: '',
  reassembled: 're-assembled',
  cannot_follow: 'cannot follow',
}

/** Badge of a variable that the mechanism does not simply follow. */
export function badge(variable: Variable): HTMLElement | undefined {
  const text = BADGES[variable.admissibility]
  return text ? el('span', { class: `badge ${variable.admissibility}`, title: variable.note }, text) : undefined
}

/** A change within the bounds of its variable. */
export function limited(by: number, bounds: readonly [number | null, number | null] | null | undefined): number {
  return Math.min(Math.max(by, bounds?.[0] ?? -Infinity), bounds?.[1] ?? Infinity)
}
