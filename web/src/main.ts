import './style.css'
import { page } from './page'
import { read } from './report'
import { State } from './state'
import { unpack } from './unpack'

const { payload, decode } = await unpack(document.getElementById('payload')!.textContent!)
page(document.getElementById('page')!, new State(read(payload, decode)))

// The frame after the next one shows what the views have drawn in the next.
requestAnimationFrame(() => requestAnimationFrame(() => performance.mark('ready')))
