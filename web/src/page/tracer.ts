import { el } from '../dom'
import type { PathPoint, State } from '../state'

/** Chooses the hardpoints whose paths are drawn: a button with a list of check boxes. */
export function tracer(state: State): HTMLElement[] {
  const seen = new Set<string>()
  const boxes: { box: HTMLInputElement; at: PathPoint }[] = []
  const is = ([body, point]: PathPoint, [other, place]: PathPoint) => body === other && point === place
  const has = (at: PathPoint) => state.choice.traces.some((one) => is(one, at))
  const flip = (at: PathPoint) =>
    state.choose({
      traces: has(at) ? state.choice.traces.filter((one) => !is(one, at)) : [...state.choice.traces, at],
    })
  const sections = state.report.bodies.slice(1).map(({ name, labels }, index) => {
    // A point that joins two bodies has one path.
    const own = labels.flatMap((label, point) => (seen.has(label) ? [] : [{ label, point }]))
    for (const { label } of own) seen.add(label)
    const rows = own.map(({ label, point }) => {
      const at: PathPoint = [index + 1, point]
      const box = el('input', { type: 'checkbox', 'data-testid': `trace-${label}`, onchange: () => flip(at) })
      boxes.push({ box, at })
      return el('label', {}, box, label)
    })
    return rows.length > 0 && el('fieldset', {}, el('legend', {}, name), ...rows)
  })
  const none = el(
    'button',
    { type: 'button', 'data-testid': 'trace-none', onclick: () => state.choose({ traces: [] }) },
    'none',
  )
  const list = el(
    'div',
    { class: 'paths', popover: 'auto', role: 'group', 'aria-label': 'Paths of hardpoints', 'data-testid': 'traces' },
    none,
    ...sections,
  )
  const button = el('button', {
    type: 'button',
    title: 'Paths of hardpoints',
    'aria-haspopup': 'true',
    'aria-expanded': 'false',
    'data-testid': 'trace',
  })
  button.popoverTargetElement = list
  // In the top layer nothing cuts the list off, and it has no place of its own.
  list.addEventListener('beforetoggle', (event) => {
    const { right, bottom } = button.getBoundingClientRect()
    list.style.right = `${Math.max(innerWidth - right, 4)}px`
    list.style.top = `${bottom + 4}px`
    button.setAttribute('aria-expanded', String((event as ToggleEvent).newState === 'open'))
  })
  list.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return
    // To the page it means something else.
    event.stopPropagation()
    list.hidePopover()
    button.focus()
  })
  const sync = () => {
    const { traces } = state.choice
    const [first] = traces
    const what = first ? state.report.bodies[first[0]].labels[first[1]] : ''
    const text = traces.length > 1 ? `${traces.length} paths` : first ? `path of ${what}` : 'no path'
    button.replaceChildren(el('span', {}, text), ' ▾')
    for (const { box, at } of boxes) box.checked = has(at)
  }
  state.onChoice(sync)
  sync()
  return [button, list]
}
