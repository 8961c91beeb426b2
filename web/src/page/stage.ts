import { el, setText } from '../dom'
import type { Look } from '../scene/camera'
import { openingStep } from '../scene/opening'
import type { Graphics } from '../scene/graphics'
import { hasWebGL, type Pose, View } from '../scene/view'
import type { State } from '../state'
import { Inspector } from './inspector'
import { Measuring } from './measuring'
import { tracer } from './tracer'

/** The view with its buttons; without WebGL a message, and no view. */
interface Stage {
  element: HTMLElement
  /** Panes below the view. */
  docked: HTMLElement[]
  view?: View
  /** Takes the standard view of this number, from 0. */
  look?: (index: number) => void
  /** Begins or ends measuring. */
  measure?: () => void
}

/** The mechanism in 3D with its standard views, or a plain message where there is no WebGL. */
export function stage(state: State, pose?: Pose, graphics?: Graphics): Stage {
  if (!graphics && !hasWebGL()) {
    const message = 'The 3D view needs WebGL, which this browser does not provide. Curves and tables are complete.'
    const element = el('div', { class: 'view', 'data-testid': 'no-webgl' }, el('p', { class: 'message' }, message))
    return { element, docked: [] }
  }
  const view = new View(state, graphics)
  if (state.step === 0) state.goToStep(openingStep(view.original))
  const buttons = view.looks.map(({ name, title }, index) =>
    el('button', { type: 'button', title, 'data-testid': `look-${name}`, onclick: () => look(index) }, name),
  )
  const look = (index: number) => {
    const chosen = view.looks[index]
    if (chosen) view.look(chosen.name)
  }
  if (pose) view.restore(pose)
  // In place of the buttons on a narrow screen.
  const chooser = el(
    'select',
    {
      class: 'look-chooser',
      'aria-label': 'Standard view',
      'data-testid': 'looks',
      onchange: () => look(view.looks.findIndex(({ name }) => name === chooser.value)),
    },
    el('option', { value: '', hidden: true }, 'turned'),
    ...view.looks.map(({ name }) => el('option', { value: name }, name)),
  )
  const press = (seen: Look | undefined) => {
    buttons.forEach((button, k) => button.setAttribute('aria-pressed', String(view.looks[k] === seen)))
    chooser.value = seen && view.looks.includes(seen) ? seen.name : ''
  }
  press(view.looks.find(({ name }) => name === view.pose.look))
  view.onLook(press)
  const labels = el(
    'button',
    {
      type: 'button',
      title: 'Names of hardpoints (L)',
      'data-testid': 'labels',
      onclick: () => state.choose({ labels: !state.choice.labels }),
    },
    'labels',
  )
  const forces = el(
    'button',
    {
      type: 'button',
      title: 'Forces as arrows (N)',
      'data-testid': 'forces',
      hidden: state.report.loads.length === 0,
      onclick: () => state.choose({ forces: !state.choice.forces }),
    },
    'forces',
  )
  const shapes = el(
    'button',
    {
      type: 'button',
      title: 'Shapes of bodies, and the nearest points between them (H)',
      'data-testid': 'shapes',
      hidden: state.report.clearance === undefined,
      onclick: () => state.choose({ shapes: !state.choice.shapes }),
    },
    'shapes',
  )
  const rigid = el(
    'button',
    {
      type: 'button',
      title: 'Rigid mechanism alongside the elastic one, in the view and in the plots',
      'data-testid': 'rigid',
      hidden: state.report.designs.every(({ kind }) => kind !== 'rigid'),
      onclick: () => state.choose({ rigid: !state.choice.rigid }),
    },
    'rigid',
  )
  const sync = () => {
    labels.setAttribute('aria-pressed', String(state.choice.labels))
    forces.setAttribute('aria-pressed', String(state.choice.forces))
    shapes.setAttribute('aria-pressed', String(state.choice.shapes))
    rigid.setAttribute('aria-pressed', String(state.choice.rigid))
  }
  state.onChoice(sync)
  sync()
  const measuring = new Measuring(view, state)
  const fit = el('button', { type: 'button', title: 'Fit (F)', 'data-testid': 'fit', onclick: () => view.fit() }, 'fit')
  const looks = el(
    'div',
    { class: 'looks', role: 'toolbar', 'aria-label': 'Standard views' },
    chooser,
    ...buttons,
    fit,
    labels,
    forces,
    shapes,
    rigid,
    measuring.button,
    ...tracer(state),
  )
  view.buttons = looks
  view.element.append(
    el('div', { class: 'view-head' }, ghostKey(state), looks),
    measuring.overlay,
    new Inspector(view, state).element,
  )
  return { element: view.element, docked: [measuring.pane], view, look, measure: () => measuring.toggle() }
}

/** Names the design that is drawn dashed. */
function ghostKey(state: State): HTMLElement {
  const name = el('span')
  const element = el(
    'p',
    { class: 'ghost-key' },
    el('span', { class: 'swatch dashed', style: '--swatch: var(--former)' }),
    name,
  )
  const sync = () => {
    const { isCompared, former, rigid } = state
    element.hidden = !isCompared && !rigid
    const solid = state.isPredicted ? '; solid: predicted to first order' : ''
    setText(name, isCompared ? `${former?.name ?? 'original'}${solid}` : (rigid?.name ?? ''))
  }
  state.onChoice(sync)
  sync()
  return element
}
