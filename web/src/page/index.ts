import { el, prose } from '../dom'
import { heatMap } from '../influence/heatmap'
import { rankingTable } from '../influence/table'
import { driverMap } from '../maps/map'
import type { Report } from '../report'
import type { State } from '../state'
import { connect } from '../studio/server'
import { LoadedText, serverBar } from '../studio/server_bar'
import { sweepPlot } from '../sweep/scatter'
import { bar } from './bar'
import { cards } from './cards'
import { checks } from './checks'
import { Curves } from './curves'
import { exports } from './exports'
import { find } from './find'
import { help } from './help'
import { listenToKeys } from './keys'
import { navigation } from './navigation'
import { stage } from './stage'
import { tabs, type Tab } from './tabs'
import { transport } from './transport'
import { variables } from './variables'

/** Builds the page: bar, values, view and time, curves, variables, and tables behind tabs. */
export function page(root: HTMLElement, state: State): void {
  const { report } = state
  const hasQuantities = report.quantities.length > 0
  const hasVariables = report.variables.length > 0
  const search = hasQuantities ? find(state) : undefined
  const keys = help()
  const scene = stage(state)
  const server = connect(document)
  const curves = hasQuantities ? new Curves(state) : undefined
  const table: Tab[] = hasQuantities && hasVariables
    ? [{ name: 'table', title: 'Table', content: el('div', { class: 'influence' }, rankingTable(state), heatMap(state)) }]
    : []
  const maps: Tab[] = report.maps.length > 0 ? [{ name: 'maps', title: 'Maps', content: el('div', {}, ...report.maps.map((map) => driverMap(map, report.quantities[state.choice.quantity]?.name ?? ''))) }] : []
  const sweep: Tab[] = report.sweep ? [{ name: 'designs', title: report.sweep.what === 'design' ? 'Designs' : 'Residuals', content: sweepPlot(report.sweep) }] : []
  const sections: [name: string, element: HTMLElement | undefined][] = [
    ['variables', hasVariables ? variables(state) : undefined],
    ['curves', curves?.element],
    ['tables', tabs('Tables and checks', [...sweep, ...maps, ...table, { name: 'checks', title: 'Checks', content: checks(state) }])],
  ]
  const shown = sections.flatMap(([name, element]) => (element ? [{ name, element }] : []))
  for (const { name, element } of shown) element.classList.add(`area-${name}`)
  root.classList.toggle('no-variables', !hasVariables)
  root.classList.toggle('no-curves', !hasQuantities)
  root.append(
    bar(state, { find: search?.element, server: server?.file ? serverBar(server, new LoadedText(server)) : undefined, exports: () => exports(state, curves?.figures ?? [], scene.view), help: () => keys.showModal() }),
    ...(report.status.complete ? [] : [banner(report)]),
    ...(report.values.length > 0 ? [cards(state)] : []),
    el('div', { class: 'scene' }, scene.element, transport(state)),
    ...shown.map(({ element }) => element),
    navigation(shown.map(({ name, element }) => ({ name, element })), () => keys.showModal()),
    keys,
  )
  listenToKeys(state, { fit: scene.view && (() => scene.view?.fit()), look: scene.look, find: search?.focus, help: () => keys.showModal() })
}

function banner({ status }: Report): HTMLElement {
  return el('p', { class: 'banner', role: 'status', 'data-testid': 'banner' }, el('strong', {}, 'This motion is incomplete. '), ...prose(status.message))
}
