import './style.css'
import { binary } from './engine/solver'
import { page } from './page'
import { read } from './report'
import { State } from './state'
import { Studio } from './studio/studio'
import { unpack } from './unpack'

const root = document.getElementById('page')!
const { payload, decode } = await unpack(document.getElementById('payload')!.textContent!)
const state = new State(read(payload, decode))
const tools: Parameters<typeof page>[2] = {
  exports: () => studio?.exports() ?? [],
  grips: () => studio?.grips(),
  leave: () => studio?.leave() ?? false,
  limits: {
    setBounds: (name, bounds) => studio?.limits.setBounds(name, bounds),
    setTolerance: (name, tolerance) => studio?.limits.setTolerance(name, tolerance),
  },
  figure: (figure) => studio?.target(figure),
}
const made = page(root, state, tools)
let studio: Studio | undefined

// The frame after the next one shows what the views have drawn in the next; then there is time for the engine.
requestAnimationFrame(() =>
  requestAnimationFrame(async () => {
    performance.mark('ready')
    const module = payload.model ? await binary() : undefined
    if (module && payload.model) studio = new Studio(module, root, payload.model, state, made)
    else root.dataset.engine = 'none'
  }),
)
