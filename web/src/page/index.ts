import { el, prose, setText } from '../dom'
import { figure } from '../format'
import { heatMap } from '../influence/heatmap'
import { rankingTable } from '../influence/table'
import type { Graphics } from '../scene/graphics'
import type { Pose, View } from '../scene/view'
import { forcePaths } from '../loads/polar'
import { driverMap } from '../maps/map'
import { ORIGINAL, type State } from '../state'
import { sweepPlot } from '../sweep/scatter'
import { settingsAt } from '../sweep/settings'
import { bar } from './bar'
import { cards } from './cards'
import { answerOf, checks, studyTables } from './checks'
import { comparison } from './comparison'
import { Curves } from './curves'
import { exports } from './exports'
import type { Figure, FigureMemory } from './figure'
import { find } from './find'
import { firstSteps } from './first_steps'
import { help } from './help'
import type { Item } from './menu'
import { listenToKeys } from './keys'
import { hasCases, metrics } from './metrics'
import { navigation, type Section } from './navigation'
import { stage } from './stage'
import { tabs, type Tab } from './tabs'
import { transport } from './transport'
import { valueStrip } from './value_strip'
import { type VariableLimits, variables as variableList } from './variables'

/** Tabs that the page of a study opens on. */
const OPENS_ON = ['designs', 'maps', 'study']

/** Choices of a page beyond its state, to be made again on another one. */
export interface PageMemory {
  figures: FigureMemory[]
  tab: string
  pose?: Pose
}

/** Parts of the page in addition to the report. */
export interface Tools {
  /** Choices of the page before. */
  memory?: PageMemory
  /** Graphics context of the view of the page before. */
  graphics?: Graphics
  /** Element in the bar. */
  bar?: HTMLElement
  /** More that can be exported. */
  exports?: () => Item[]
  grips?: () => void
  /** Ends the mode in which hardpoints are moved; false if it is not on. */
  leave?: () => boolean
  /** Keeps bounds and tolerances of variables. */
  limits?: VariableLimits
  /** Element next to the controls of a figure. */
  figure?: (figure: Figure) => HTMLElement | undefined
}

/** Parts of the page, for later additions. */
export interface PageParts {
  view?: View
  bar: HTMLElement
  /** Notices above the values. */
  notices: HTMLElement
  readonly memory: PageMemory
}

/** Builds the page: bar, values, view and time, curves, and variables, tables and checks behind tabs. */
export function page(root: HTMLElement, state: State, tools: Tools = {}): PageParts {
  const { report } = state
  const hasQuantities = report.quantities.length > 0
  const hasVariables = report.variables.length > 0
  const search = hasQuantities ? find(state) : undefined
  const keys = help()
  const openKeys = () => {
    keys.showModal()
    // The focus goes to the button at the end.
    keys.scrollTo(0, 0)
  }
  const scene = stage(state, tools.memory?.pose, tools.graphics)
  const curves = hasQuantities ? new Curves(state, tools.figure, tools.memory?.figures) : undefined
  const all = tableTabs(state, tools.limits)
  const tables = tabs('Variables, tables and checks', all)
  const cases = report.metrics && hasCases(report.metrics) ? ['metrics'] : []
  const opened = tools.memory?.tab ?? all.find(({ name }) => [...OPENS_ON, ...cases].includes(name))?.name
  if (opened) tables.show(opened)
  const table = all.find(({ name }) => name !== 'variables')!.name
  const sections: Section[] = [
    ...(curves ? [{ name: 'curves', element: curves.element }] : []),
    ...(hasVariables ? [{ name: 'variables', element: tables.element, open: () => tables.show('variables') }] : []),
    {
      name: 'tables',
      element: tables.element,
      open: () => tables.shown === 'variables' && tables.show(table),
    },
  ]
  curves?.element.classList.add('area-curves')
  tables.element.classList.add('area-tables')
  root.classList.toggle('no-curves', !hasQuantities)
  root.classList.toggle('of-study', (report.study?.answer.length ?? 0) > 0)
  const head = bar(state, {
    find: search?.element,
    exports: () => [...(tools.exports?.() ?? []), ...exports(state, curves?.figures ?? [], scene.view)],
    help: openKeys,
  })
  if (tools.bar) slot(head, tools.bar)
  const steps = report.model ? firstSteps(state, () => tools.grips?.()) : undefined
  const notices = el('div', { class: 'announcements' }, banner(state), steps)
  root.append(
    head,
    notices,
    ...(report.values.length > 0 ? [valueStrip(cards(state), state)] : []),
    el('div', { class: 'scene' }, scene.element, ...scene.docked, transport(state)),
    ...(curves ? [curves.element] : []),
    tables.element,
    navigation(sections, openKeys),
    keys,
  )
  listenToKeys(state, {
    fit: scene.view && (() => scene.view?.fit()),
    look: scene.look,
    measure: scene.measure,
    find: search?.focus,
    help: openKeys,
    grips: () => tools.grips?.(),
    leave: () => tools.leave?.() ?? false,
  })
  return {
    view: scene.view,
    bar: head,
    notices,
    get memory() {
      return { figures: curves?.memory ?? [], tab: tables.shown, pose: scene.view?.pose }
    },
  }
}

/** Tabs for which the report has data; the checks are always shown. */
function tableTabs(state: State, limits?: VariableLimits): Tab[] {
  const { sweep, maps, study, quantities, variables, loads } = state.report
  const all: Tab[] = []
  if (variables.length > 0) all.push({ name: 'variables', title: 'Variables', content: variableList(state, limits) })
  if (sweep) {
    const title = { design: 'Designs', point: 'Front' }[sweep.what] ?? 'Residuals'
    const answer = study && answerOf(study)
    const plot = sweepPlot(sweep, (k) => state.setDesign(settingsAt(state.report, sweep, k)), answer)
    const heading = sweep.what === 'posture' ? [recordHeading(state, 'Fitted design')] : []
    all.push({ name: 'designs', title, content: el('div', { class: 'filling' }, ...heading, plot) })
  }
  if (maps.length > 0) {
    const selected = quantities[state.choice.quantity]?.name ?? ''
    const drawn = maps.map((map) => driverMap(map, selected))
    all.push({ name: 'maps', title: 'Maps', content: el('div', {}, recordHeading(state), ...drawn) })
  }
  if (study) {
    const tab = { name: 'study', title: study.title, content: studyTables(state, study) }
    // Residuals check a result, which comes first; swept designs and fronts are results.
    all.splice(sweep?.what === 'posture' ? all.findIndex(({ name }) => name === 'designs') : all.length, 0, tab)
  }
  if (quantities.length > 0 && variables.length > 0) {
    const content = el('div', { class: 'influence' }, rankingTable(state), heatMap(state))
    all.push({ name: 'table', title: 'Influence', content })
  }
  if (state.report.metrics) all.push({ name: 'metrics', title: 'Metrics', content: metrics(state) })
  if (loads.length > 0) all.push({ name: 'loads', title: 'Forces', content: forcePaths(state) })
  if (state.report.values.length > 0) all.push({ name: 'compare', title: 'Compare', content: comparison(state) })
  return [...all, { name: 'checks', title: 'Checks', content: checks(state) }]
}

/** Puts tools into the bar, before what is there for the report alone. */
export function slot(head: HTMLElement, tools: HTMLElement): void {
  head.querySelector('.space')!.after(tools)
}

/** Heading over what is solved once, for the design that the page was made of. */
function recordHeading(state: State, name = ORIGINAL): HTMLElement {
  const heading = el('p', { class: 'of-design', 'data-testid': 'of-record' }, name)
  const sync = () => (heading.hidden = state.isRecorded)
  state.onChoice(sync)
  sync()
  return heading
}

/** States that the motion is incomplete, and of which design, or that only a part of it is shown. */
function banner(state: State): HTMLElement {
  const [heading, words] = [el('strong'), el('span')]
  const whole = el(
    'button',
    { type: 'button', 'data-testid': 'whole-motion', onclick: () => state.showWholeMotion?.() },
    'Show the whole motion',
  )
  const element = el('p', { class: 'banner', role: 'status', 'data-testid': 'banner' }, heading, words, whole)
  let shown = ''
  const sync = () => {
    const { status } = state.sensitivityReport
    const { isCutOff } = state
    element.hidden = status.complete && !isCutOff
    whole.hidden = !isCutOff || state.showWholeMotion === undefined
    const { times, units } = state.report
    const end = figure(times[times.length - 1], units.time)
    const cutOff =
      `Curves and values of this design are shown up to ${end}, where the motion of the original ends; ` +
      'metrics and checks are of its whole motion. '
    const stops = [state.outdated, status.message].filter(Boolean).join(': ')
    const message = [stops, isCutOff ? cutOff : ''].filter(Boolean).join(' ')
    if (message === shown) return
    setText(heading, status.complete ? 'Only a part of this motion is shown. ' : 'This motion is incomplete. ')
    words.replaceChildren(...prose(message))
    shown = message
  }
  state.onChoice(sync)
  sync()
  return element
}
