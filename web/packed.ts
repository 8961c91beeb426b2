import { deflateSync } from 'fflate'
import { dirname, resolve } from 'node:path'
import { build, type Plugin, type Rollup } from 'vite'

/** Suffix of a module's name that has it packed. */
const MARK = '?packed'
/** Prefix of resolved names. */
const RESOLVED = '\0packed:'

/**
 * `import code from './part?packed'` imports a part of the page, with all its imports, as text: a script that sets the
 * global `PART`, deflated, in base64. It costs the page nothing until it is run. Style sheets are left out: the
 * importer imports them.
 *
 * A library deflates it because Node's deflate writes different bytes on different machines.
 */
export function packed(): Plugin {
  return {
    name: 'packed',
    // Before plugins that read a name with a question mark as a file name.
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
