import type { State } from '../state'

/** While the pointer or the keyboard is at an element, what it shows is pointed at. */
export function pointing(state: State, element: HTMLElement, quantity: () => number | undefined): void {
  for (const event of ['pointerenter', 'focusin']) element.addEventListener(event, () => state.point(quantity()))
  for (const event of ['pointerleave', 'focusout']) element.addEventListener(event, () => state.point())
}
