import { el, prose } from '../dom'
import { heatMap } from '../influence/heatmap'
import { rankingTable } from '../influence/table'
import type { View } from '../scene/view'
import { forcePaths } from '../loads/polar'
import { driverMap } from '../maps/map'
import type { Report } from '../report'
import type { State } from '../state'
import { sweepPlot } from '../sweep/scatter'
import { bar } from './bar'
import { cards } from './cards'
import { checks } from './checks'
import { Curves } from './curves'
import { exports } from './exports'
import type { Figure } from './figure'
import { find } from './find'
import { help } from './help'
import type { Item } from './menu'
import { listenToKeys } from './keys'
import { navigation } from './navigation'
import { stage } from './stage'
import { tabs, type Tab } from './tabs'
import { transport } from './transport'
import { valueStrip } from './value_strip'
import { type VariableLimits, variables } from './variables'

/** Parts of the page in addition to the report. */
export interface Tools {
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
}

/** Builds the page: bar, values, view and time, curves, variables, and tables behind tabs. */
export function page(root: HTMLElement, state: State, tools: Tools = {}): PageParts {
  const { report } = state
  const hasQuantities = report.quantities.length > 0
  const hasVariables = report.variables.length > 0
  const search = hasQuantities ? find(state) : undefined
  const keys = help()
  const scene = stage(state)
  const curves = hasQuantities ? new Curves(state, tools.figure) : undefined
  const sections: [name: string, element: HTMLElement | undefined][] = [
    ['variables', hasVariables ? variables(state, tools.limits) : undefined],
    ['curves', curves?.element],
    ['tables', tabs('Tables and checks', tableTabs(state))],
  ]
  const shown = sections.flatMap(([name, element]) => (element ? [{ name, element }] : []))
  for (const { name, element } of shown) element.classList.add(`area-${name}`)
  root.classList.toggle('no-variables', !hasVariables)
  root.classList.toggle('no-curves', !hasQuantities)
  const head = bar(state, {
    find: search?.element,
    exports: () => [...(tools.exports?.() ?? []), ...exports(state, curves?.figures ?? [], scene.view)],
    help: () => keys.showModal(),
  })
  if (tools.bar) slot(head, tools.bar)
  root.append(
    head,
    ...(report.status.complete ? [] : [banner(report)]),
    ...(report.values.length > 0 ? [valueStrip(cards(state), state)] : []),
    el('div', { class: 'scene' }, scene.element, ...scene.docked, transport(state)),
    ...shown.map(({ element }) => element),
    navigation(
      shown.map(({ name, element }) => ({ name, element })),
      () => keys.showModal(),
    ),
    keys,
  )
  listenToKeys(state, {
    fit: scene.view && (() => scene.view?.fit()),
    look: scene.look,
    measure: scene.measure,
    find: search?.focus,
    help: () => keys.showModal(),
    grips: () => tools.grips?.(),
    leave: () => tools.leave?.() ?? false,
  })
  return { view: scene.view, bar: head }
}

/** Tabs for which the report has data; the checks are always shown. */
function tableTabs(state: State): Tab[] {
  const { sweep, maps, quantities, variables, loads } = state.report
  const all: Tab[] = []
  if (sweep) {
    const title = sweep.what === 'design' ? 'Designs' : 'Residuals'
    all.push({ name: 'designs', title, content: sweepPlot(sweep) })
  }
  if (maps.length > 0) {
    const selected = quantities[state.choice.quantity]?.name ?? ''
    all.push({ name: 'maps', title: 'Maps', content: el('div', {}, ...maps.map((map) => driverMap(map, selected))) })
  }
  if (quantities.length > 0 && variables.length > 0) {
    const content = el('div', { class: 'influence' }, rankingTable(state), heatMap(state))
    all.push({ name: 'table', title: 'Table', content })
  }
  if (loads.length > 0) all.push({ name: 'loads', title: 'Forces', content: forcePaths(state) })
  return [...all, { name: 'checks', title: 'Checks', content: checks(state) }]
}

/** Puts tools into the bar, before what is there for the report alone. */
export function slot(head: HTMLElement, tools: HTMLElement): void {
  head.querySelector('.space')!.after(tools)
}

function banner({ status }: Report): HTMLElement {
  return el(
    'p',
    { class: 'banner', role: 'status', 'data-testid': 'banner' },
    el('strong', {}, 'This motion is incomplete. '),
    ...prose(status.message),
  )
}
