import { deflateSync } from 'fflate'
import { dirname, resolve } from 'node:path'
import { build, type Plugin, type Rollup } from 'vite'

/** What is written behind the name of a module to have it packed. */
const MARK = '?packed'
/** A module of this name is one that was resolved. */
const RESOLVED = '\0packed:'

/**
 * `import code from './part?packed'` gives a part of the page, with all that it imports, as text: a script that sets the global `PART`,
 * deflated, in base64. It costs the page nothing until it is run. Its style sheets are left out: who imports it imports them.
 *
 * Deflated by a library in place of Node, whose own deflate gives other bytes on other machines.
 */
export function packed(): Plugin {
  return {
    name: 'packed',
    // Before what takes a name with a question mark for that of a file.
    enforce: 'pre',
    resolveId: (source, importer) =>
      source.endsWith(MARK) && importer
        ? RESOLVED + resolve(dirname(importer), `${source.slice(0, -MARK.length)}.ts`)
        : undefined,
    load: async (id) => {
      if (!id.startsWith(RESOLVED)) return undefined
      const made = (await build({
        configFile: false,
        logLevel: 'silent',
        build: {
          write: false,
          target: 'es2022',
          rolldownOptions: {
            input: id.slice(RESOLVED.length),
            preserveEntrySignatures: 'strict',
            output: { format: 'iife', name: 'PART' },
          },
        },
      })) as Rollup.RollupOutput
      const code = made.output.find((part) => part.type === 'chunk')!.code
      const bytes = deflateSync(new TextEncoder().encode(code), { level: 9 })
      return `export default ${JSON.stringify(Buffer.from(bytes).toString('base64'))}`
    },
  }
}
