import { readFileSync } from 'node:fs'
import type { Payload } from '../src/payload'
import { read, type Report } from '../src/report'

/** What a page is about, as the page itself reads it. */
export function reportOf(address: string): Report {
  const html = readFileSync(new URL(address), 'utf8')
  const [, text] = html.match(/<script[^>]*id="payload"[^>]*>([^]*?)<\/script>/) ?? []
  if (text === undefined) throw new Error(`${address} holds no payload`)
  return read(JSON.parse(text) as Payload)
}
