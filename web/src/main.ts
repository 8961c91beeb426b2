import './style.css'
import { checks, header } from './document'
import { el } from './dom'
import { heatMap } from './influence/heatmap'
import { rankingTable } from './influence/table'
import { plots } from './plots'
import { read } from './report'
import { stage } from './stage'
import { State } from './state'
import { unpack } from './unpack'
import { variables } from './variables'

const { payload, decode } = await unpack(document.getElementById('payload')!.textContent!)
const state = new State(read(payload, decode))
const { report } = state
const hasQuantities = report.quantities.length > 0
const hasVariables = report.variables.length > 0

const left = el('div', { class: 'scene' }, ...stage(state), hasVariables && variables(state))
document.getElementById('page')!.append(
  header(report),
  el('div', { class: 'work' }, left, hasQuantities && plots(state)),
  ...(hasQuantities && hasVariables ? [el('div', { class: 'influence' }, rankingTable(state), heatMap(state))] : []),
  checks(report.checks),
)

// The frame after the next one shows what the views have drawn in the next.
requestAnimationFrame(() => requestAnimationFrame(() => performance.mark('ready')))
