import { el } from '../dom'
import type { State } from '../state'

/** The cards of the values in one row, and a button that shows all of them where they do not fit. */
export function valueStrip(cards: HTMLElement, state: State): HTMLElement {
  const count = cards.childElementCount
  const button = el(
    'button',
    {
      type: 'button',
      class: 'all-values',
      hidden: true,
      'aria-expanded': 'false',
      'data-testid': 'all-values',
      onclick: () => {
        const isAll = strip.classList.toggle('all')
        button.setAttribute('aria-expanded', String(isAll))
        button.textContent = isAll ? 'one row ▴' : `all ${count} ▾`
      },
    },
    `all ${count} ▾`,
  )
  const strip = el('div', { class: 'value-strip' }, cards, button)
  const watch = new ResizeObserver(() => {
    button.hidden = !strip.classList.contains('all') && cards.scrollWidth <= cards.clientWidth + 1
  })
  watch.observe(strip)
  state.ended.addEventListener('abort', () => watch.disconnect())
  return strip
}
