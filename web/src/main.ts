import './style.css'
import { checks, header } from './document'
import { el } from './dom'
import { heatMap, rankingTable } from './influence'
import type { Payload } from './payload'
import { plots } from './plots'
import { read } from './report'
import { stage } from './stage'
import { State } from './state'
import { variables } from './variables'

const payload: Payload = JSON.parse(document.getElementById('payload')!.textContent!)
const state = new State(read(payload))
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
