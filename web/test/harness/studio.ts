import '../../src/style.css'
import '../../src/scene/palette.css'
import { el } from '../../src/dom'
import type {
  OptimizeOffer,
  OptimizeRequest,
  ProgressListener,
  Running,
  StudyResult,
  ToleranceOffer,
  ToleranceRequest,
} from '../../src/engine/engine'
import { Plot } from '../../src/plot'
import { read } from '../../src/report'
import { State } from '../../src/state'
import { History, type Step } from '../../src/studio/history'
import { historyBar } from '../../src/studio/history_bar'
import { type Aim, type Chosen, goalToml, type Judged } from '../../src/studio/goal'
import { targetButton } from '../../src/studio/draw_target'
import { Sketch } from '../../src/studio/sketch'
import type { Point } from '../../src/studio/stroke'
import { optimizePane, type StudyDesign, tolerancePane } from '../../src/studio/studies'
import { targetToml } from '../../src/studio/target'
import { EMPTY } from '../mechanisms'

declare global {
  interface Window {
    designs: History
    shown: Step[]
    compared: (string | undefined)[]
    /** The studies that were begun; the tests end them. */
    studies: Study[]
    previews: (StudyDesign | undefined)[]
    taken: { change: StudyResult['change']; studied: string }[]
    /** The text of the present design. */
    model: string
    /** Reason why the present design has no text. */
    unwritten: string
    refresh: () => void
    propose: (of: string) => void
    drawn?: Point[] | 'cancelled'
    plot: Plot
    show: () => void
  }
}

/** A study that is controlled by a test. */
interface Study {
  text: string
  request: OptimizeRequest | ToleranceRequest
  cancelled: boolean
  tell: (done: number, total: number | null, line: string, change?: StudyResult['change']) => void
  end: (result: StudyResult) => void
  fail: (message: string) => void
}

function begin(text: string, request: Study['request']): Running<StudyResult> {
  const listeners: ProgressListener[] = []
  let end!: Study['end']
  let fail!: (error: Error) => void
  const result = new Promise<StudyResult>((resolve, reject) => ((end = resolve), (fail = reject)))
  const study: Study = {
    text,
    request,
    cancelled: false,
    tell: (done, total, line, change = null) => listeners.forEach((listener) => listener(done, total, line, change)),
    end,
    fail: (message) => fail(new Error(message)),
  }
  window.studies.push(study)
  return { result, cancel: () => (study.cancelled = true), onProgress: (listener) => listeners.push(listener) }
}

const variable = (name: string, chosen: boolean): OptimizeOffer['variables'][number] => ({
  name,
  unit: 'mm',
  bounds: chosen ? [-15, 15] : null,
  chosen,
})
const optimizeOffer: OptimizeOffer = {
  variables: [variable('outer_x', true), variable('outer_z', true), variable('rack_z', true), variable('top_x', false)],
  goals: [
    { metric: 'toe_error', unit: 'deg', value: 0.40243, weight: 1, target: null, curve: true, chosen: true },
    { metric: 'camber_range', unit: 'deg', value: 2.113, weight: 1, target: null, curve: false, chosen: false },
  ],
  limits: ['`ackermann` (steer): 0.1335 deg at least, 0.13356 deg now'],
  starts: 1,
  iterations: 100,
}
const toleranceOffer: ToleranceOffer = {
  tolerances: [
    { name: 'ball_joint', tolerance: 0.3, unit: 'mm', distribution: 'truncated' },
    { name: 'lca_front_z', tolerance: 0.5, unit: 'mm', distribution: 'normal' },
  ],
  metrics: ['toe_range', 'camber_range'],
  samples: 10_000,
  seed: 1,
}

Object.assign(window, {
  shown: [],
  compared: [],
  studies: [],
  taken: [],
  previews: [],
  model: 'name = "strut"',
  unwritten: '',
})
const first: Step = { text: window.model, settings: [], label: 'opened' }
window.designs = new History(first)
const bar = historyBar(window.designs, {
  show: (step) => window.shown.push(step),
  compare: (snapshots) => window.compared.push(snapshots.at(-1)?.name),
  write: async ({ name }) => `\`${name}\` is written`,
})

const host = {
  studies: {
    optimizeOffer: async () => {
      if (window.model === 'broken') throw new Error('the mechanism does not move: `rack_drive` has no law')
      return optimizeOffer
    },
    optimize: begin,
    toleranceOffer: async () => toleranceOffer,
    tolerance: begin,
  },
  text: () => window.model,
  present: async () => {
    if (window.unwritten) throw new Error(window.unwritten)
    return window.model
  },
  unwritten: () => window.unwritten,
  apply: ({ change }: StudyResult, studied: string) => window.taken.push({ change, studied }),
  preview: (design: StudyDesign | undefined) => window.previews.push(design),
  targets: new Set<string>(),
  goals: {
    quantities: () => [
      { name: 'toe', unit: 'deg' },
      { name: 'travel', unit: 'mm' },
    ],
    cases: () => ['bump', 'steer'],
    selected: () => ({ of: 'toe', over: 'travel' }),
    add: (judged: Judged, aim: Aim, chosen: Chosen) => {
      window.model = goalToml(window.model, judged, aim, chosen).text
      window.refresh()
    },
  },
}
const optimize = optimizePane(host)
const panes = [optimize, tolerancePane(host)]
window.propose = (of) => optimize.propose({ of })
window.refresh = () => panes.forEach((pane) => pane.refresh())

const times = Float32Array.from({ length: 101 }, (_, k) => k / 10)
const state = new State(read({ ...EMPTY, times: [0] }, () => times))
const plot = new Plot(state, 'plot')
window.plot = plot
window.show = () =>
  plot.show(() => ({
    title: 'toe',
    unit: 'deg',
    lines: [{ label: 'toe', color: '#0b61bd', curve: times.map((t) => Math.sin(t)) }],
  }))
const sketch = el(
  'button',
  {
    type: 'button',
    id: 'sketch',
    onclick: () =>
      new Sketch(plot, { done: (points) => (window.drawn = points), cancel: () => (window.drawn = 'cancelled') }),
  },
  'Draw a target',
)
const target = targetButton(
  plot,
  () => ({ of: 'wheel.z', over: 'travel' }),
  (curve) => (window.model = targetToml(window.model, curve).text),
)
document.body.append(
  el(
    'header',
    { class: 'topbar', style: 'flex-wrap: wrap' },
    el('h1', {}, 'A strut'),
    el('span', { class: 'space' }),
    bar,
    sketch,
    target,
  ),
  el('div', { id: 'curves', style: 'height: 330px; display: flex; padding: 0 14px' }, plot.element),
  el('div', { class: 'panel' }, panes[0].element),
  el('div', { class: 'panel' }, panes[1].element),
  el('input', { type: 'text', 'aria-label': 'any text', id: 'text' }),
)
window.show()
window.refresh()
requestAnimationFrame(() => requestAnimationFrame(() => performance.mark('ready')))
