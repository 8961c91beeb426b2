import type { VariableSetting } from '../engine/protocol'
import type { PageMemory } from '../page'
import type { ChoiceMemory } from '../state'
import { deflated, inflated } from '../unpack'

/** A design relative to the original text. */
export interface SavedDesign {
  /** Text of the model; the original one if undefined. */
  text?: string
  settings: readonly VariableSetting[]
}

/** Work on a model, as it is kept by the browser and in links. */
export interface Session {
  design: SavedDesign
  /** Named designs. */
  named: (SavedDesign & { name: string })[]
  /** Names of the compared ones, the reference last. */
  compared: string[]
  choices: ChoiceMemory
  page: PageMemory
  /** Case that is shown; missing in what was stored before it was kept. */
  case?: string | null
  /** Time of the last change, in milliseconds since 1970. */
  saved: number
}

/** Part of the address that carries a session. */
const HASH = '#state='

/** The work on one model in this browser's storage. */
export class Storage {
  readonly #key: string
  /** True if the browser did not keep the last change. */
  failed = false

  constructor(file: string, original: string) {
    this.#key = `hardpoint ${file} ${digest(original)}`
  }

  save(session: Session): void {
    try {
      localStorage.setItem(this.#key, JSON.stringify(session))
      this.failed = false
    } catch {
      this.failed = true
    }
  }

  /** The stored work; undefined without any. */
  load(): Session | undefined {
    try {
      return JSON.parse(localStorage.getItem(this.#key) ?? 'null') ?? undefined
    } catch {
      return undefined
    }
  }

  clear(): void {
    try {
      localStorage.removeItem(this.#key)
    } catch {
      // Without storage there is nothing to remove.
    }
  }
}

/** Address of this page with a session. */
export async function linkOf(session: Session): Promise<string> {
  const [address] = location.href.split('#')
  return address + HASH + encodeURIComponent(await deflated(JSON.stringify(session)))
}

/** The session in the address of the page; undefined without one. */
export async function linkedSession(): Promise<Session | undefined> {
  if (!location.hash.startsWith(HASH)) return undefined
  try {
    const bytes = await inflated(decodeURIComponent(location.hash.slice(HASH.length)))
    return JSON.parse(new TextDecoder().decode(bytes))
  } catch {
    return undefined
  }
}

/** A short number of a text (FNV-1a), by which the work on another version of the model is not taken for this one. */
function digest(text: string): string {
  let hash = 0x811c9dc5
  for (let k = 0; k < text.length; k++) hash = Math.imul(hash ^ text.charCodeAt(k), 0x01000193)
  return (hash >>> 0).toString(36)
}
