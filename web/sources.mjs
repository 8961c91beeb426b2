// Digest of what the engine in the page is built from: the code of its crates without comments, tests and spaces, the
// versions of its dependencies, and the commands. `web/build` stores it beside the engine, and a test compares the two.
import { createHash } from 'node:crypto'
import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'

const root = fileURLToPath(new URL('..', import.meta.url))

// Comments, spaces, literals that may contain what looks like a comment, and everything else.
const TOKEN =
  /\/\/[^\n]*|\/\*[^]*?\*\/|\s+|b?r(#*)"[^]*?"\1|b?"(?:\\[^]|[^"\\])*"|b?'(?:\\(?:u\{[^}]*\}|[^])|[^'\\])'|'?\w+|[^]/g

const read = (file) => readFileSync(join(root, file), 'utf8')

/** Lines of a section of a manifest. */
const section = (manifest, name) => manifest.split(/^(?=\[)/m).find((part) => part.startsWith(`[${name}]`)) ?? ''

/** Tokens of Rust code, without comments and without items that only tests have. */
export function tokens(code) {
  const all = code.match(TOKEN).filter((token) => !/^(\/\/|\/\*|\s)/.test(token))
  const kept = []
  for (let at = 0; at < all.length; at++) {
    if (all.slice(at, at + 7).join('') !== '#[cfg(test)]') {
      kept.push(all[at])
      continue
    }
    // The item after it ends with its braces, or with a semicolon.
    at += 7
    for (let depth = 0; at < all.length; at++) {
      depth += { '{': 1, '(': 1, '[': 1, '}': -1, ')': -1, ']': -1 }[all[at]] ?? 0
      const ends = all[at] === ';' || (all[at] === '}' && all[at + 1] !== ';')
      if (depth === 0 && ends) break
    }
  }
  return kept
}

/** Own crates that a manifest depends on, and those that they depend on. */
function crates(manifest, found = new Set()) {
  for (const [, name] of section(read(manifest), 'dependencies').matchAll(/^(hardpoint[a-z-]*)\b/gm)) {
    if (!found.has(name)) {
      found.add(name)
      crates(`crates/${name}/Cargo.toml`, found)
    }
  }
  return found
}

/** Paths of the sources of a folder. */
function sources(folder) {
  const files = readdirSync(join(root, folder), { recursive: true }).map((file) => file.replaceAll('\\', '/'))
  return files.filter((file) => /\.rs$/.test(file) && !/(^|\/)tests\.rs$/.test(file)).map((file) => `${folder}/${file}`)
}

/** Digest of all sources of the engine. */
export function digest() {
  const hash = createHash('sha256')
  const manifests = ['web/engine/Cargo.toml', 'web/engine/Cargo.lock', 'web/build']
  const folders = ['web/engine/src', 'web/engine/web-time/src']
  for (const name of crates('web/engine/Cargo.toml')) {
    manifests.push(`crates/${name}/Cargo.toml`)
    folders.push(`crates/${name}/src`)
  }
  const add = (name, text) => {
    const lines = text.split(/\r?\n/).filter((line) => !/^\s*(#|$)/.test(line))
    hash.update(`${name}\n${lines.join('\n')}\n`)
  }
  for (const file of manifests.sort()) add(file, read(file))
  // Features of the dependencies.
  add('Cargo.toml', section(read('Cargo.toml'), 'workspace.dependencies'))
  for (const file of folders.flatMap(sources).sort()) {
    hash.update(`${file}\n${tokens(read(file)).join(' ')}\n`)
  }
  return hash.digest('hex')
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  console.log(digest())
}
