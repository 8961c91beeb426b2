import './style.css'
import { page } from './page'
import type { Payload } from './payload'
import { read } from './report'
import { State } from './state'

const payload: Payload = JSON.parse(document.getElementById('payload')!.textContent!)
page(document.getElementById('page')!, new State(read(payload)))
