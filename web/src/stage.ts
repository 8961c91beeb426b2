import { el, HUES } from './dom'
import { figure } from './format'
import { visibleChange } from './scene/poses'
import { hasWebGL, View } from './scene/view'
import type { State } from './state'
import { transport } from './transport'

/** The 3D view with its playback, buttons and key to the colours, or a plain message where there is no WebGL. */
export function stage(state: State): HTMLElement[] {
  if (!hasWebGL()) {
    const message = 'This browser offers no WebGL, so the 3D view is left out. Curves and tables are complete.'
    return [el('div', { class: 'view', 'data-testid': 'no-webgl' }, el('p', { class: 'message' }, message)), transport(state)]
  }
  const view = new View(state)
  const looks = view.looks.map(({ name, title }) => el('button', { type: 'button', title, onclick: () => view.look(name) }, name))
  view.element.append(el('div', { class: 'looks' }, ...looks))
  return [view.element, transport(state), el('div', { class: 'under' }, key(state), tracer(state), changer(state, view.today.size))]
}

const STEPS = 50

/** Changes the selected variable in the view. */
function changer(state: State, size: number): HTMLElement {
  const output = el('output')
  const slider = el('input', {
    type: 'range',
    min: -STEPS,
    max: STEPS,
    value: 0,
    'data-testid': 'change',
    oninput: () => state.choose({ change: (Number(slider.value) / STEPS) * reach() }),
  })
  const chosen = () => state.report.variables[state.choice.variable]
  const reach = () => (chosen() ? visibleChange(chosen(), size) : 0)
  const field = el('label', { class: 'field' }, el('span', {}, 'Change'), slider, output)
  const sync = () => {
    const variable = chosen()
    field.hidden = !variable || reach() === 0
    if (!variable) return
    slider.value = String(Math.round((state.choice.change / (reach() || 1)) * STEPS))
    const amount = figure(Number(state.choice.change.toPrecision(3)), variable.unit)
    output.textContent = state.choice.change === 0 ? variable.name : `${variable.name} by ${amount}, foreseen to first order`
  }
  state.onChoice(sync)
  sync()
  return field
}

function key({ report }: State): HTMLElement {
  const entry = (color: string, label: string, shape = '') =>
    el('li', {}, el('span', { class: `swatch ${shape}`, style: `--swatch: var(${color})` }), label)
  const bodies = report.bodies.slice(1).map(({ name }, index) => entry(`--hue-${index % HUES}`, name))
  return el(
    'ul',
    { class: 'key' },
    ...bodies,
    entry('--ground', report.bodies[0]?.name ?? 'ground', 'square'),
    entry('--tree-joint', 'joint', 'square'),
    report.joints.some(({ cut }) => cut) && entry('--cut-joint', 'cut joint', 'square'),
    report.variables.length > 0 && entry('--accent', 'design velocity', 'arrow'),
  )
}

function tracer(state: State): HTMLElement {
  const select = el(
    'select',
    {
      'data-testid': 'trace',
      onchange: () => {
        const [body, point] = select.value.split(' ').map(Number)
        state.choose({ trace: select.value ? [body, point] : undefined })
      },
    },
    el('option', { value: '' }, 'none'),
    ...state.report.bodies.slice(1).map((body, index) =>
      el(
        'optgroup',
        { label: body.name },
        ...body.labels.map((label, point) => el('option', { value: `${index + 1} ${point}` }, label)),
      ),
    ),
  )
  return el('label', { class: 'field' }, el('span', {}, 'Path of'), select)
}
