import { readFileSync } from 'node:fs'
import { read, type Report } from '../src/report'
import { unpack } from '../src/unpack'

/** What a page is about, as the page itself reads it. */
export async function reportOf(address: string): Promise<Report> {
  const html = readFileSync(new URL(address), 'utf8')
  const [, text] = html.match(/<script[^>]*id="payload"[^>]*>([^]*?)<\/script>/) ?? []
  if (text === undefined) throw new Error(`${address} holds no payload`)
  const { payload, decode } = await unpack(text)
  return read(payload, decode)
}
