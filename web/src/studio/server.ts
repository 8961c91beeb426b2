import type { DiagnosticMessage } from '../engine/protocol'
/** Data about the server that the page comes from; undefined in a file. */
interface PageInfo {
  token: string
  /** The model file that the page shows. */
  file: string | null
  /** The revision of its text. */
  revision: string | null
  case: string | null
  cases: string[]
}

/** A model file of the folder. */
export interface Entry {
  file: string
  title: string
  description: string | null
  cases: string[]
  problems: number
  /** Seconds since 1970. */
  changed: number | null
}

/** A text on disk. */
export interface OnDisk {
  text: string
  revision: string
}

/** JSON form of a diagnostic, that of `hardpoint check --json`. */
export type Diagnostic = DiagnosticMessage

/** Outcome of saving. */
export type SaveOutcome =
  | { outcome: 'saved'; revision: string }
  | ({ outcome: 'changed' } & OnDisk)
  | { outcome: 'exists' }
  | { outcome: 'invalid'; diagnostics: Diagnostic[]; text: string }
  | { outcome: 'refused'; why: string }

export type StudyKind = 'optimize' | 'tolerance' | 'sweep' | 'synthesize'

export interface StudyRequest {
  what: StudyKind
  text: string
  case?: string
  options?: {
    starts?: number
    iterations?: number
    samples?: number
    seed?: number
    allocate?: 'rss' | 'worst_case'
    task?: string
  }
}

/** State of a study. */
export interface Study {
  id: number
  what: StudyKind
  state: 'running' | 'done' | 'cancelled' | 'failed'
  progress?: { what: string; unit: string; done: number; of: number } | null
  lines: string[]
  message?: string
  diagnostics?: Diagnostic[]
  /** The model with the design found, where the study seeks one. */
  text?: string | null
  reports?: { case: string | null; link: string }[]
}

/** `gone`: no answer. `stranger`: another server answers, with another token. */
export type State = 'there' | 'gone' | 'stranger'

/** Events from the server. */
interface Events {
  /** True if the server answers. */
  state: State
  /** The file has another text, or (without a revision) is there no more. */
  changed: { revision: string | null }
  /** Progress of a study; only new lines. */
  study: Partial<Study> & { id: number; line?: string }
  /** Events were missed: the state of studies must be requested. */
  missed: undefined
}

/** That nobody has answered, or a stranger. */
export class NoAnswerError extends Error {}

/** Seconds between attempts to reach a server that is gone. */
const FIRST_PAUSE = 0.5
const LONGEST_PAUSE = 5
/** The server sends a heartbeat every two seconds. */
const SILENCE = 20

/** The server that the page comes from; `undefined` of a page from a file. */
export function connect(document: Document): Server | undefined {
  const info = document.getElementById('server')?.textContent
  return info ? new Server(JSON.parse(info) as PageInfo) : undefined
}

/** The studio's server, as `hardpoint studio` runs it. */
export class Server {
  readonly file: string | null
  readonly case: string | null
  readonly cases: string[]
  state: State = 'there'
  /** Revision of the text on disk that the present one was made from. */
  private revision: string | null
  private readonly token: string
  /** Identity of this page, which ignores its own changes. */
  private readonly client = crypto.randomUUID()
  private readonly listeners: { [K in keyof Events]: Set<(event: Events[K]) => void> } = {
    state: new Set(),
    changed: new Set(),
    study: new Set(),
    missed: new Set(),
  }
  /** Identity of the server's run. */
  private run?: string
  private leaving = false

  constructor({ token, file, revision, case: shown, cases }: PageInfo) {
    this.token = token
    this.file = file
    this.case = shown
    this.cases = cases
    this.revision = revision
    addEventListener('pagehide', () => (this.leaving = true))
    addEventListener('pageshow', () => (this.leaving = false))
    void this.listen()
  }

  /** Hears of something from now on. */
  on<K extends keyof Events>(name: K, listener: (event: Events[K]) => void): void {
    this.listeners[name].add(listener)
  }

  /** The command by which this page finds a server again. */
  get command(): string {
    return `hardpoint studio ${this.file ?? ''} --port ${location.port} --token ${this.token}`
  }

  /** All models of the folder. */
  async models(): Promise<{ folder: string; models: Entry[] }> {
    return (await this.request('GET', '/api/models')).json()
  }

  /** Address of a page for a new linkage. */
  readonly newLink = '/new'

  /** Address of the page of a model. */
  link(file: string, shown?: string): string {
    return `/?${new URLSearchParams({ file, ...(shown === undefined ? {} : { case: shown }) })}`
  }

  /** The text on disk now, `undefined` where there is none. */
  async read(file: string): Promise<OnDisk | undefined> {
    const response = await this.request('GET', `/api/model?${new URLSearchParams({ file })}`)
    return response.ok ? response.json() : undefined
  }

  /** The present text was made from that one: it may be saved over it. */
  setBase({ revision }: OnDisk): void {
    this.revision = revision
  }

  /** True if a text on disk is the one that the present text was made from. */
  isBase({ revision }: { revision: string | null }): boolean {
    return revision === this.revision
  }

  /** True if the model has no file yet. */
  get isNew(): boolean {
    return this.revision === null
  }

  /**
   * Saves in place, over the text that this one was made from, or as a new file; with `anyway` also what is no valid
   * model.
   */
  async save(text: string, anyway = false): Promise<SaveOutcome> {
    if (this.isNew) {
      const saved = await this.saveAs(this.file!, text, anyway)
      if (saved.outcome === 'saved') {
        this.revision = saved.revision
        history.replaceState(null, '', this.link(this.file!))
      }
      return saved
    }
    const response = await this.request('PUT', this.target(this.file!, anyway), {
      body: text,
      headers: { 'if-match': `"${this.revision}"` },
    })
    const saved = await outcome(response)
    if (saved.outcome === 'saved') this.revision = saved.revision
    return saved
  }

  /** Saves under a name that no file has. */
  async saveAs(file: string, text: string, anyway = false): Promise<SaveOutcome> {
    return outcome(await this.request('POST', this.target(file, anyway), { body: text }))
  }

  private target(file: string, anyway: boolean): string {
    return `/api/model?${new URLSearchParams({ file, client: this.client, ...(anyway ? { anyway: '1' } : {}) })}`
  }

  /** Begins a study of a text; what comes of it is heard as `study`. */
  async begin(asked: StudyRequest): Promise<Study> {
    const body = JSON.stringify({ file: this.file, ...asked })
    const response = await this.request('POST', '/api/study', { body, headers: { 'content-type': 'application/json' } })
    if (!response.ok) throw new Error(await why(response))
    return response.json()
  }

  /** State of a study; `undefined` if the server does not know it. */
  async study(id: number): Promise<Study | undefined> {
    const response = await this.request('GET', `/api/study/${id}`)
    return response.ok ? response.json() : undefined
  }

  /** Ends a study with its results so far. */
  async cancel(id: number): Promise<void> {
    await this.request('DELETE', `/api/study/${id}`)
  }

  private async request(method: string, path: string, { headers, ...options }: RequestInit = {}): Promise<Response> {
    const response = await fetch(path, {
      method,
      cache: 'no-store',
      headers: { 'x-hardpoint-token': this.token, ...headers },
      ...options,
    }).catch(() => undefined)
    this.setState(response ? (response.status === 403 ? 'stranger' : 'there') : 'gone')
    if (!response) throw new NoAnswerError('The server does not answer.')
    if (response.status === 403) throw new NoAnswerError('Another server answers at this address.')
    return response
  }

  private setState(state: State): void {
    if (state === this.state || this.leaving) return
    this.state = state
    this.emit('state', state)
  }

  private emit<K extends keyof Events>(name: K, event: Events[K]): void {
    for (const listener of this.listeners[name]) listener(event)
  }

  /** Listens to events of the server, and reconnects when it is gone. */
  private async listen(): Promise<never> {
    const query = new URLSearchParams({ client: this.client, ...(this.file === null ? {} : { file: this.file }) })
    for (let pause = FIRST_PAUSE; ; pause = Math.min(2 * pause, LONGEST_PAUSE)) {
      const silence = new AbortController()
      let timer = setTimeout(() => silence.abort(), 1000 * SILENCE)
      try {
        const response = await this.request('GET', `/api/events?${query}`, { signal: silence.signal })
        for await (const { name, data } of events(response.body!)) {
          clearTimeout(timer)
          timer = setTimeout(() => silence.abort(), 1000 * SILENCE)
          pause = FIRST_PAUSE
          this.dispatch(name, data)
        }
      } catch {
        // The next attempt shows the state of the server.
      }
      clearTimeout(timer)
      if (this.state === 'there') this.setState('gone')
      await new Promise((resolve) => setTimeout(resolve, 1000 * pause))
    }
  }

  private dispatch(name: string, data: string): void {
    if (name === 'alive') return
    const event = JSON.parse(data)
    if (name === 'study') this.emit('study', event)
    else if (name === 'missed') this.emit('missed', undefined)
    else if (name === 'hello') {
      if (this.run !== undefined) this.emit('missed', undefined)
      this.run = event.server
    }
    if ((name === 'changed' || name === 'hello') && this.file !== null && event.revision !== this.revision)
      this.emit('changed', { revision: event.revision })
  }
}

async function outcome(response: Response): Promise<SaveOutcome> {
  const { status } = response
  if (response.ok) return { outcome: 'saved', revision: (await response.json()).revision }
  if (status === 422) return { outcome: 'invalid', ...(await response.json()) }
  if (status === 409) {
    const found = await response.json()
    return 'revision' in found
      ? { outcome: 'changed', text: found.text, revision: found.revision }
      : { outcome: 'exists' }
  }
  return { outcome: 'refused', why: await why(response) }
}

/** Reason of a rejected request, in the server's words. */
async function why(response: Response): Promise<string> {
  const { error, text } = await response.json().catch(() => ({}))
  return text ?? error ?? `the server answers ${response.status}`
}

/** The events of a stream, as they come. */
export async function* events(stream: ReadableStream<Uint8Array>): AsyncGenerator<{ name: string; data: string }> {
  let rest = ''
  for await (const part of stream.pipeThrough(new TextDecoderStream() as ReadableWritablePair<string, Uint8Array>)) {
    const blocks = (rest + part).split('\n\n')
    rest = blocks.pop()!
    for (const block of blocks) {
      const fields = new Map(block.split('\n').map((line) => line.split(/: ?(.*)/s, 2) as [string, string]))
      yield { name: fields.get('event') ?? 'message', data: fields.get('data') ?? '' }
    }
  }
}
