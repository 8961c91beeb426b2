/** Text with the special characters of XML escaped. */
export function escaped(text: string): string {
  const entities: Record<string, string> = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' }
  // XML has no way to write control characters.
  return text.replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f]/g, '').replace(/[&<>"]/g, (sign) => entities[sign])
}

/** An element with attributes; its content is markup. */
export function tag(
  name: string,
  attributes: Record<string, string | number | undefined>,
  ...inside: string[]
): string {
  const written = Object.entries(attributes).map(([key, value]) =>
    value === undefined ? '' : ` ${key}="${typeof value === 'number' ? round(value) : escaped(value)}"`,
  )
  const head = `<${name}${written.join('')}`
  return inside.length > 0 ? `${head}>${inside.join('')}</${name}>` : `${head}/>`
}

/** Hundredths of a pixel are finer than any screen or printer. */
export function round(value: number): string {
  return String(Math.round(value * 100) / 100)
}

/** A picture of the given size in pixels, as a file. */
export function svgFile(width: number, height: number, title: string, ...inside: string[]): Blob {
  const size = { width: round(width), height: round(height), viewBox: `0 0 ${round(width)} ${round(height)}` }
  const root = tag('svg', { xmlns: 'http://www.w3.org/2000/svg', ...size }, tag('title', {}, escaped(title)), ...inside)
  return new Blob([`<?xml version="1.0" encoding="UTF-8"?>\n${root}\n`], { type: 'image/svg+xml' })
}
