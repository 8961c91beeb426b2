import { deflateSync } from 'fflate'
import { dirname, resolve } from 'node:path'
import { build, type Plugin, type Rollup } from 'vite'

/** Suffix of the name of a module that is to be packed. */
const MARK = '?packed'
/** Prefix of resolved modules. */
const RESOLVED = '\0packed:'

/**
 * `import code from './part?packed'` returns a part of the page with its imports as text: a script that sets the global
 * `PART`, deflated, in base64. It costs the page nothing until it runs. Its style sheets are left out; the importing
 * module must import them.
 *
 * A library deflates it instead of Node, whose result differs between machines.
 */
export function packed(): Plugin {
  return {
    name: 'packed',
    // Before plugins that take a name with a question mark as a file name.
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
