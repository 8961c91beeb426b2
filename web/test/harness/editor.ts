import '../../src/style.css'
import '../../src/scene/palette.css'
import { el } from '../../src/dom'
import type { Editor } from '../../src/editor/editor'
import { openEditor } from '../../src/editor/open'
import type { Diagnostic } from '../../src/engine/engine'
import schema from '../../../models/hardpoint.schema.json'
import strut from '../../../models/macpherson.toml?raw'

declare global {
  interface Window {
    pane: Editor
    /** The valid texts, as the page was informed of them. */
    valid: string[]
    /** Number of checks of a text. */
    asked: number
    /** Number of checks to come fail. */
    failing: number
  }
}

/** Represents the reader of the page: bodies that are not declared, and a key without a value. */
async function check(text: string): Promise<Diagnostic[]> {
  window.asked++
  if (window.failing-- > 0) throw new Error('the engine has ended')
  const found: Diagnostic[] = []
  const bodies = ['ground', ...[...text.matchAll(/^(\w+) = \{ frame/gm)].map(([, name]) => name)]
  text.split(/\r?\n/).forEach((line, k) => {
    const at = { line: k + 1, file: null, element: null, label: null, severity: 'error' as const }
    for (const { 1: names, index } of line.matchAll(/^bodies = \[(.*)\]/g)) {
      for (const { 1: name, index: within } of names.matchAll(/"(\w*)"/g)) {
        if (bodies.includes(name)) continue
        found.push({
          ...at,
          code: 'HP0204',
          message: `there is no body named \`${name}\``,
          column: index + 'bodies = ['.length + within + 1,
          length: name.length + 2,
          notes: [`valid names: ${bodies.map((body) => `\`${body}\``).join(', ')}`],
          help: 'correct the name, or declare what it names',
        })
      }
    }
    if (/^\w+ =\s*$/.test(line))
      found.push({
        ...at,
        code: 'HP0102',
        message: 'the text is not valid TOML',
        column: line.length + 1,
        length: 0,
        label: 'a value is missing',
        notes: [],
        help: null,
      })
    if (line.includes('cut = true'))
      found.push({
        ...at,
        severity: 'note',
        code: 'HP0901',
        message: 'the loop is cut at `top_E`',
        column: 1,
        length: 3,
        notes: [],
        help: null,
      })
  })
  return found
}

window.valid = []
window.asked = window.failing = 0
window.pane = await openEditor({
  text: strut,
  check: { check },
  onValid: (text) => window.valid.push(text),
  schema: schema as never,
})
document.body.append(
  el(
    'main',
    { style: 'display: grid; grid-template: auto minmax(0, 1fr) auto / minmax(0, 1fr); height: 100vh; min-height: 0' },
    el('button', { id: 'before' }, 'before'),
    window.pane.element,
    el('button', { id: 'after' }, 'after'),
  ),
)
requestAnimationFrame(() => requestAnimationFrame(() => performance.mark('ready')))
