import { el } from '../dom'
import { inflated } from '../unpack'
import type * as code from './editor'
import './editor.css'
import packed from './editor?packed'

declare global {
  interface Window {
    PART?: typeof code
  }
}

let opened: Promise<typeof code> | undefined

/**
 * Makes the pane of the model's text. Its code is inflated and run with the first one: until then it costs the page
 * nothing.
 */
export async function openEditor(options: code.Options): Promise<code.Editor> {
  const { editor } = await (opened ??= run())
  return editor(options)
}

async function run(): Promise<typeof code> {
  const script = el('script')
  script.textContent = new TextDecoder().decode(await inflated(packed))
  document.head.append(script)
  script.remove()
  const part = window.PART!
  window.PART = undefined
  return part
}
