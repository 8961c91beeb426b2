import { el } from '../dom'

/** Card of a value that holds an element, with the name of the value. */
function cardOf(element: EventTarget | null): { card: HTMLElement; name: string } | undefined {
  // Figures of a card have identifiers of their own.
  const card = (element as Element | null)?.closest<HTMLElement>('.card[data-testid^=card-]')
  return card ? { card, name: card.dataset.testid!.slice('card-'.length) } : undefined
}

/** Calls back for a goal of a value: by a right click on its card, or by the button of the card that is in use. */
export function goalsOfCards(root: HTMLElement, isReady: () => boolean, propose: (name: string) => void): void {
  let shown = ''
  const button = el(
    'button',
    {
      type: 'button',
      class: 'card-goal',
      'data-testid': 'card-goal',
      title: 'Minimise it, bring it to a value, or keep it within limits',
      onclick: () => propose(shown),
    },
    'Goal…',
  )
  const follow = ({ type, target }: Event) => {
    const { activeElement } = document
    if (target === button || (type === 'pointerover' && activeElement === button)) return
    const found = isReady() ? (cardOf(target) ?? cardOf(activeElement)) : undefined
    if (!found) return button.remove()
    const { card, name } = found
    shown = name
    button.setAttribute('aria-label', `Goal of ${name}`)
    if (card.nextElementSibling !== button) card.after(button)
    Object.assign(button.style, { left: `${card.offsetLeft + card.offsetWidth}px`, top: `${card.offsetTop}px` })
  }
  for (const event of ['pointerover', 'focusin']) root.addEventListener(event, follow)
  root.addEventListener('contextmenu', (event) => {
    const found = isReady() ? cardOf(event.target) : undefined
    if (!found) return
    event.preventDefault()
    propose(found.name)
  })
}
