import { el } from '../dom'
import { prefer, preference } from '../preferences'

/** A part of the page that may be printed. */
interface Part {
  name: string
  title: string
  elements: HTMLElement[]
}

/** Parts that the page and `hardpoint run --pdf-parts` have; each is where one of the selectors finds it. */
const PARTS: [name: string, title: string, selectors: string][] = [
  ['picture', 'picture of the mechanism', '.scene'],
  ['metrics', 'metrics, by design', '.value-strip, [data-testid=comparison], #panel-metrics'],
  ['hardpoints', 'hardpoints: old, new, change', '[data-testid=hardpoints]'],
  ['variables', 'design variables', '#panel-variables'],
  ['curves', 'curves', '.area-curves'],
  ['influence', 'most influential variables', '#panel-table'],
]
/** Class of what is not printed. */
const UNPRINTED = 'unprinted'
/** Preference with the names of the parts that are left out. */
const LEFT_OUT = 'unprinted'

/** Opens the choice of the parts to print; further tabs of the page are parts as well. */
export function composePrint(root: HTMLElement): void {
  const parts = partsOf(root)
  const omitted = new Set(preference(LEFT_OUT)?.split(' '))
  const fields = parts.map(({ name, title }) => {
    const box = el('input', { type: 'checkbox', name, checked: !omitted.has(name), 'data-testid': `print-${name}` })
    return { name, box, label: el('label', {}, box, ' ', title) }
  })
  const submit = (event: Event) => {
    event.preventDefault()
    const chosen = new Set(fields.filter(({ box }) => box.checked).map(({ name }) => name))
    const others = [...omitted].filter((name) => name !== '' && fields.every((field) => field.name !== name))
    prefer(LEFT_OUT, [...others, ...fields.filter(({ box }) => !box.checked).map(({ name }) => name)].join(' '))
    dialog.close()
    for (const { name, elements } of parts)
      for (const element of elements) element.classList.toggle(UNPRINTED, !chosen.has(name))
    // A page that is printed by the browser's own command has all its parts.
    const whole = () =>
      parts.forEach(({ elements }) => elements.forEach(({ classList }) => classList.remove(UNPRINTED)))
    addEventListener('afterprint', whole, { once: true })
    print()
  }
  const dialog = el(
    'dialog',
    { class: 'help composer', 'aria-label': 'Print or PDF', 'data-testid': 'composer', onclose: () => dialog.remove() },
    el('h2', {}, 'Print or PDF'),
    el(
      'form',
      { onsubmit: submit },
      ...fields.map(({ label }) => label),
      el(
        'p',
        { class: 'actions' },
        el('button', { type: 'submit', class: 'primary', 'data-testid': 'print-run' }, 'Print…'),
        el('button', { type: 'button', onclick: () => dialog.close() }, 'Cancel'),
      ),
    ),
  )
  document.body.append(dialog)
  dialog.showModal()
}

function partsOf(root: HTMLElement): Part[] {
  const found = PARTS.map(([name, title, selectors]) => ({
    name,
    title,
    elements: [...root.querySelectorAll<HTMLElement>(selectors)].filter(({ hidden }) => !hidden),
  }))
  const tabs = [...root.querySelectorAll<HTMLElement>('[role=tab]')].flatMap((tab) => {
    const panel = root.querySelector<HTMLElement>(`#${tab.getAttribute('aria-controls')}`)
    const isPart = !panel || panel.querySelector('[data-testid=comparison]') || panel.matches('#panel-metrics')
    if (!panel || isPart || found.some(({ elements }) => elements.includes(panel))) return []
    return [{ name: tab.id.replace('tab-', ''), title: tab.textContent.toLowerCase(), elements: [panel] }]
  })
  return [...found, ...tabs].filter(({ elements }) => elements.length > 0)
}
