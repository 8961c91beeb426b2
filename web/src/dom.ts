type Child = Node | string | undefined | false
type Attributes = Record<string, string | number | boolean | undefined | ((event: never) => void)>

/** An element with attributes, `on...` listeners and children. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name.slice(2), value as EventListener)
    else if (value !== undefined && value !== false) element.setAttribute(name, value === true ? '' : String(value))
  }
  element.append(...children.filter((child) => child !== undefined && child !== false))
  return element
}

/** A sentence with its `names` set as code. */
export function prose(text: string): (Node | string)[] {
  return text.split('`').map((part, k) => (k % 2 === 1 ? el('code', {}, part) : part))
}

/** Renders again and returns the focus to the button of the same name. */
export function keepFocus(container: HTMLElement, render: () => void): void {
  const focused = container.querySelector<HTMLButtonElement>('button:focus')
  render()
  for (const button of container.querySelectorAll('button')) if (button.name === focused?.name) button.focus()
}

const SVG = 'http://www.w3.org/2000/svg'

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | number> = {},
  ...children: Node[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, tag)
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value))
  element.append(...children)
  return element
}

const properties = new Map<string, string>()
let scheme = ''

/** A custom property of the style sheet, for drawing on a canvas; read once per colour scheme: it costs a layout. */
export function css(name: string): string {
  const root = document.documentElement
  const now = `${matchMedia(DARK).matches} ${root.classList.contains('printing')}`
  if (now !== scheme) properties.clear()
  scheme = now
  let value = properties.get(name)
  if (value === undefined) properties.set(name, (value = getComputedStyle(root).getPropertyValue(name).trim()))
  return value
}

/** Sets the text of an element if it differs: an unchanged one costs no layout. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text
}

const sentences = new WeakMap<Element, string>()

/** Sets a sentence with its `names` as code, if it differs. */
export function setProse(element: Element, text: string): void {
  if (sentences.get(element) === text) return
  sentences.set(element, text)
  element.replaceChildren(...prose(text))
}

/** Sets an attribute of an element if it differs: an unchanged one costs no style. */
export function setAttribute(element: Element, name: string, value: string | boolean): void {
  if (element.getAttribute(name) !== String(value)) element.setAttribute(name, String(value))
}

const DARK = '(prefers-color-scheme: dark)'

/**
 * Calls back when what is drawn on a canvas needs other colours, until the signal; paper is light, whatever the screen.
 */
export function onSchemeChange(callback: () => void, signal?: AbortSignal): void {
  matchMedia(DARK).addEventListener('change', callback, { signal })
  for (const [event, printing] of [
    ['beforeprint', true],
    ['afterprint', false],
  ] as const) {
    addEventListener(
      event,
      () => {
        document.documentElement.classList.toggle('printing', printing)
        callback()
      },
      { signal },
    )
  }
}

/**
 * Categorical colours that colour-blind readers can distinguish (Okabe and Ito), tuned per scheme in the style sheet.
 */
const HUES = 8

export function hue(index: number): string {
  return css(`--hue-${index % HUES}`)
}
