import type { VariableSetting } from '../engine/protocol'

/** Design that is stored in a page. */
export interface StoredDesign {
  /** Text of the model that the changes count from. */
  text: string
  case: string | null
  settings: VariableSetting[]
}

/** Identifier of the element with the stored design. */
const ID = 'design'
/** Parts of the body that a page is made of; all others are made by its code. */
const PARTS = ['page', 'server', 'payload', 'engine', 'code']

/** The present page as a file that opens with a design. */
export function pageFile(document: Document, design: StoredDesign): Blob {
  const root = document.documentElement.cloneNode(true) as HTMLElement
  const body = root.querySelector('body')!
  const code = body.querySelector('script[type=module]')
  for (const part of [...body.children])
    if (part !== code && part.tagName !== 'NOSCRIPT' && !PARTS.includes(part.id)) part.remove()
  for (const part of [root, body]) part.removeAttribute('class')
  const page = document.createElement('main')
  page.id = 'page'
  root.querySelector('#page')!.replaceWith(page)
  // The copy belongs to no server and no site.
  root.querySelector('#server')?.replaceChildren()
  root.querySelector('link[rel=up]')?.remove()
  // Its code adds the style again.
  root.querySelector('head style')?.remove()
  const stored = document.createElement('script')
  stored.type = 'application/json'
  stored.id = ID
  // Within a script nothing may look like its end.
  stored.textContent = JSON.stringify(design).replaceAll('<', '\\u003c')
  code?.before(stored)
  return new Blob([`<!doctype html>\n${root.outerHTML}`], { type: 'text/html' })
}

/** The design that a page was saved with; undefined without one. */
export function storedDesign(document: Document): StoredDesign | undefined {
  const text = document.getElementById(ID)?.textContent
  return text ? JSON.parse(text) : undefined
}
