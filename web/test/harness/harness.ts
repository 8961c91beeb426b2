import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { pathToFileURL } from 'node:url'
import { build, type Rollup } from 'vite'
import { packed } from '../../packed'

/** Builds a page of one part of the page, `NAME.ts` next to this file, and returns its address. */
export async function harness(name: string): Promise<string> {
  const made = (await build({
    configFile: false,
    logLevel: 'silent',
    plugins: [packed()],
    build: {
      write: false,
      target: 'es2022',
      modulePreload: false,
      rolldownOptions: { input: join(import.meta.dirname, `${name}.ts`), output: { codeSplitting: false } },
    },
  })) as Rollup.RollupOutput
  const parts = made.output.map((part) =>
    part.type === 'chunk'
      ? `<script type="module">${part.code.replaceAll('</script', '<\\/script')}</script>`
      : `<style>${part.source}</style>`,
  )
  const folder = mkdtempSync(join(tmpdir(), 'hardpoint-harness-'))
  const viewport = '<meta name="viewport" content="width=device-width, initial-scale=1">'
  const head = `<!doctype html><html lang="en"><meta charset="utf-8">${viewport}`
  const path = join(folder, `${name}.html`)
  writeFileSync(path, `${head}<title>${name}</title><body>${parts.reverse().join('\n')}</body></html>`)
  return pathToFileURL(path).href
}

/** Deletes a page that was built. */
export function cleared(url: string): void {
  rmSync(new URL('.', url), { recursive: true })
}
