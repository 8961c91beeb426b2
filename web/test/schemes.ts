import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'

const SOURCES = join(import.meta.dirname, '../src')
const DARK = '@media screen and (prefers-color-scheme: dark)'

const sheet = readdirSync(SOURCES, { recursive: true, encoding: 'utf8' })
  .filter((path) => path.endsWith('.css'))
  .map((path) => readFileSync(join(SOURCES, path), 'utf8'))
  .join('\n')

/** The custom properties of a style sheet's part. */
const properties = (css: string) =>
  Object.fromEntries([...css.matchAll(/--([\w-]+):\s*([^;]+);/g)].map(([, name, value]) => [name, value]))

/** The parts of a style sheet between the braces that follow `head`, those within them included. */
function blocks(css: string, head: string): string[] {
  return css
    .split(head)
    .slice(1)
    .map((rest) => {
      let depth = 0
      for (let at = rest.indexOf('{'); at < rest.length; at++) {
        depth += Number(rest[at] === '{') - Number(rest[at] === '}')
        if (depth === 0) return rest.slice(0, at)
      }
      throw new Error(`a block after ${head} does not end`)
    })
}

const dark = blocks(sheet, DARK)
const light = properties(dark.reduce((css, block) => css.replace(block, ''), sheet))

/** Custom properties of the page's style sheets in both schemes. */
export const schemes: Record<'light' | 'dark', Record<string, string>> = {
  light,
  dark: { ...light, ...properties(dark.join('\n')) },
}
