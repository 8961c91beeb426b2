import { readFileSync } from 'node:fs'
import { join } from 'node:path'
import { build, type Rollup } from 'vite'
import { expect, test } from 'vitest'

const root = join(import.meta.dirname, '..')

test('the committed bundle is what these sources build to', async () => {
  const made = (await build({
    root,
    mode: 'production',
    logLevel: 'silent',
    build: { write: false },
  })) as Rollup.RollupOutput
  expect(made.output.map(({ fileName }) => fileName).sort()).toEqual(['app.css', 'app.js'])
  for (const file of made.output) {
    const committed = readFileSync(join(root, '../crates/hardpoint-report/page', file.fileName), 'utf8')
    const built = file.type === 'chunk' ? file.code : String(file.source)
    // Not toBe: a failure would print half a megabyte.
    expect(built === committed, `${file.fileName} is out of date: run \`npm run build\``).toBe(true)
  }
})
