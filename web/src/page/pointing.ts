import type { State } from '../state'

/** Highlights the item of an element while the pointer or the focus is on it. */
export function pointing(state: State, element: HTMLElement, quantity: () => number | undefined): void {
  for (const event of ['pointerenter', 'focusin']) element.addEventListener(event, () => state.point(quantity()))
  for (const event of ['pointerleave', 'focusout']) element.addEventListener(event, () => state.point())
}
