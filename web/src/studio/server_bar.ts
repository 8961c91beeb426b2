import './server.css'
import { el, prose } from '../dom'
import { messageOf } from '../format'
import { menu, type Item } from '../page/menu'
import {
  NoAnswerError,
  type Entry,
  type SaveOutcome,
  type Server,
  type Study,
  type StudyKind,
  type StudyRequest,
} from './server'

/** The present text of the model. */
export interface Text {
  /** Text of the design that is shown. */
  text(): Promise<string>
  /** Text to be saved: that of the editor, valid or not, which may not be shown yet. */
  visible(): Promise<string>
  replace(text: string): void
  onChange(listener: () => void): void
}

/** Studies of the server, by their button labels. */
const STUDIES: Record<StudyKind, string> = {
  optimize: 'Optimise',
  tolerance: 'Run tolerance analysis',
  sweep: 'Sweep',
  synthesize: 'Synthesise',
}

/** The part of the page's bar that belongs to a server. */
export interface ServerBar {
  element: HTMLElement
  /** Saves a text in place, which may differ from the present one. */
  save(text: string): Promise<void>
  /** Looks for linkages for the text of a task file, and lists the answers. */
  synthesize(task: string): Promise<void>
}

/** Controls that a server adds to the page's bar: save, other models, studies; and notices. */
export function serverBar(server: Server, text: Text): ServerBar {
  const notices = el('div', { class: 'notices', 'data-testid': 'notices' })
  const save = el(
    'button',
    {
      type: 'button',
      'data-testid': 'save',
      title: 'Save the model in place (Ctrl+S)',
      disabled: true,
      onclick: () => desk.save(),
    },
    'Save',
  )
  const element = el(
    'div',
    { class: 'server', 'data-testid': 'server' },
    save,
    menu('Server', 'server-menu', () => desk.items()),
    notices,
  )
  const desk = new Desk(server, text, save, notices)
  return { element, save: (text) => desk.put(text), synthesize: (task) => desk.study('synthesize', { task }) }
}

/** Actions on the model's file. */
class Desk {
  /** Text on disk, as far as the page knows. */
  private saved?: string
  private readonly notes: Notes
  private readonly running = new Map<number, (news: Partial<Study> & { line?: string }) => void>()

  constructor(
    private readonly server: Server,
    private readonly text: Text,
    private readonly button: HTMLButtonElement,
    notices: HTMLElement,
  ) {
    this.notes = new Notes(notices)
    void text.visible().then((present) => {
      this.saved ??= present
      void this.compare()
    })
    text.onChange(() => void this.compare())
    server.on('changed', ({ revision }) => this.changed(revision))
    server.on('state', () => this.answers())
    server.on('study', (news) => this.running.get(news.id)?.(news))
    server.on('missed', () => void this.catchUp())
    addEventListener('keydown', (event) => {
      if ((event.ctrlKey || event.metaKey) && !event.altKey && event.key.toLowerCase() === 's') {
        event.preventDefault()
        void this.save()
      }
    })
    addEventListener('beforeunload', (event) => {
      if (this.isUnsaved()) event.preventDefault()
    })
  }

  items(): Item[] {
    const study = (what: StudyKind): Item => ({
      name: `${STUDIES[what]} on this machine`,
      testId: `study-${what}`,
      run: () => this.study(what),
    })
    return [
      { name: 'Open another model…', testId: 'models', run: () => this.choose() },
      { name: 'Save as…', testId: 'save-as', run: () => this.saveAs() },
      study('optimize'),
      study('tolerance'),
      study('sweep'),
    ]
  }

  private isUnsaved(): boolean {
    return !this.button.disabled
  }

  private async compare(): Promise<void> {
    // A design without a text differs from that on disk; saving it gives the reason.
    const present = await this.text.visible().catch(() => undefined)
    if (present !== undefined) this.notes.drop('unwritten')
    this.button.disabled = this.saved === undefined || present === this.saved
    this.button.classList.toggle('unsaved', this.isUnsaved())
  }

  /** Saves the present text; with `anyway` also what is no valid model. */
  async save(anyway = false): Promise<void> {
    let present: string
    try {
      present = await this.text.visible()
    } catch (error) {
      return this.notes.show('unwritten', `Not saved: ${messageOf(error)}.`, { stop: true })
    }
    await this.put(present, anyway)
  }

  /** Saves a text. */
  async put(text: string, anyway = false): Promise<void> {
    await this.asking(async () => this.after(await this.server.save(text, anyway), text))
  }

  private after(saved: SaveOutcome, text: string): void {
    this.notes.drop('saving')
    if (saved.outcome === 'saved') {
      this.saved = text
      this.notes.drop('changed')
      void this.compare()
      this.notes.show('saving', `Saved \`${this.server.file}\`.`, { passing: true })
    } else if (saved.outcome === 'changed') this.changed(saved.revision)
    else if (saved.outcome === 'invalid') {
      this.notes.show('saving', 'Not saved: the text is not a valid model.', {
        stop: true,
        detail: saved.text,
        actions: { 'Save anyway': () => void this.save(true) },
      })
    } else if (saved.outcome === 'exists')
      this.notes.show('saving', 'Not saved: a model of that name exists already.', { stop: true })
    else this.notes.show('saving', `Not saved: ${saved.why}.`, { stop: true })
  }

  /** Another text is on disk than the one that this was made from. */
  private changed(revision: string | null): void {
    const { file } = this.server
    if (revision === null) {
      this.notes.show('changed', `\`${file}\` is no longer on disk. Your text is kept in the page.`, {
        stop: true,
        actions: { 'Save as…': () => this.saveAs() },
      })
      return
    }
    this.notes.show('changed', `\`${file}\` was changed on disk.`, {
      actions: {
        Reload: () => void this.asking(() => this.reload()),
        'Keep mine': () => void this.asking(() => this.keep()),
      },
    })
  }

  private async reload(): Promise<void> {
    const read = await this.server.read(this.server.file!)
    if (!read) return this.changed(null)
    this.server.setBase(read)
    this.saved = read.text
    this.notes.drop('changed')
    this.text.replace(read.text)
    await this.compare()
  }

  /** The present text may overwrite the file on disk. */
  private async keep(): Promise<void> {
    const read = await this.server.read(this.server.file!)
    if (!read) return this.changed(null)
    this.server.setBase(read)
    this.saved = read.text
    this.notes.drop('changed')
    await this.compare()
  }

  private async choose(): Promise<void> {
    const { folder, models } = await this.server.models()
    const entry = ({ file, title, description, problems }: Entry) =>
      el(
        'li',
        {},
        el(
          'a',
          { href: this.server.link(file), 'aria-current': file === this.server.file ? 'page' : undefined },
          el('b', {}, title),
          ' ',
          el('code', {}, file),
        ),
        el(
          'p',
          { class: 'muted' },
          problems > 0 ? `${problems} ${problems === 1 ? 'problem' : 'problems'}` : (description ?? ''),
        ),
      )
    dialog(
      'Models',
      el('p', { class: 'muted' }, folder),
      el('ul', { class: 'models', 'data-testid': 'model-list' }, ...models.map(entry)),
    )
  }

  private saveAs(): void {
    const name = el('input', {
      type: 'text',
      value: this.server.file ?? '',
      'aria-label': 'file name',
      'data-testid': 'new-name',
      spellcheck: 'false',
    })
    const failure = el('p', { class: 'wrong', role: 'alert' })
    const submit = async (event: Event) => {
      event.preventDefault()
      const file = name.value.endsWith('.toml') ? name.value : `${name.value}.toml`
      try {
        const present = await this.text.visible()
        const saved = await this.server.saveAs(file, present)
        if (saved.outcome === 'saved') {
          this.button.disabled = true
          location.assign(this.server.link(file))
        } else
          failure.textContent =
            saved.outcome === 'exists'
              ? 'A model of that name exists already.'
              : saved.outcome === 'refused'
                ? saved.why
                : 'The text is not a valid model.'
      } catch (error) {
        failure.textContent = messageOf(error)
      }
    }
    const form = el(
      'form',
      { class: 'ask', onsubmit: submit },
      name,
      el('button', { type: 'submit', 'data-testid': 'save-new' }, 'Save'),
      failure,
    )
    dialog('Save as', form)
    name.select()
  }

  async study(what: StudyKind, options?: StudyRequest['options']): Promise<void> {
    const { server, notes } = this
    const shown = server.cases.length > 0 && what === 'tolerance' ? (server.case ?? undefined) : undefined
    let study = await server.begin({ what, text: await this.text.text(), case: shown, options })
    const key = `study-${study.id}`
    const show = () => {
      const { state, progress, lines, message } = study
      if (state === 'running') {
        const { of = 0, done = 0, unit = '' } = progress ?? {}
        const line = of > 0 ? `${progress!.what} ${done} of ${of} ${unit}` : (lines.at(-1)?.trim() ?? 'started')
        notes.show(key, `${STUDIES[what]}: ${line}`, {
          part: of > 0 ? done / of : undefined,
          actions: { Cancel: () => void this.asking(() => server.cancel(study.id)) },
        })
        return
      }
      this.running.delete(study.id)
      const found = study.text
      const actions: Record<string, () => void> = found
        ? { 'Apply design': () => (this.text.replace(found), notes.drop(key)) }
        : {}
      const links = (study.reports ?? []).map(({ case: name, link }): [string, string] => [
        name === null ? 'Report' : `Report: ${name}`,
        link,
      ])
      const how = { done: message, cancelled: `cancelled${message ? `; ${message}` : ''}`, failed: 'no result' }[state]
      notes.show(key, `${STUDIES[what]}: ${how}`, {
        stop: state === 'failed',
        detail: state === 'failed' ? message : undefined,
        actions,
        links,
        closing: true,
      })
    }
    const follow = async (news: Partial<Study> & { line?: string }) => {
      if (news.line !== undefined) study.lines.push(news.line)
      study = { ...study, ...news }
      // The end is reported without long data.
      if (study.state !== 'running') study = (await server.study(study.id).catch(() => undefined)) ?? study
      show()
    }
    this.running.set(study.id, (news) => void follow(news))
    show()
    await this.catchUp()
  }

  /** Requests the state of all studies. */
  private async catchUp(): Promise<void> {
    for (const [id, follow] of this.running) {
      const study = await this.server.study(id).catch(() => null)
      if (study) follow(study)
      else if (study === undefined)
        follow({ id, state: 'failed', message: 'The server was restarted; the study is lost.' })
    }
  }

  private answers(): void {
    const { server, notes } = this
    if (server.state === 'there') notes.drop('server')
    else if (server.state === 'gone') {
      notes.show('server', 'The server does not answer. Your changes are kept in the page. Restart it with', {
        stop: true,
        detail: server.command,
      })
    } else {
      notes.show(
        'server',
        'Another server answers at this address. Your changes are kept in the page. ' +
          'Open the address that it printed, or stop it and run',
        { stop: true, detail: server.command },
      )
    }
  }

  /** Sends a request to the server; a lost connection is reported elsewhere. */
  private async asking(what: () => Promise<void>): Promise<void> {
    try {
      await what()
    } catch (error) {
      if (!(error instanceof NoAnswerError)) throw error
      this.answers()
    }
  }
}

interface Note {
  stop?: boolean
  /** In the words of the command line. */
  detail?: string
  /** Fraction that is done. */
  part?: number
  actions?: Record<string, () => void>
  links?: [name: string, to: string][]
  /** It can be put away. */
  closing?: boolean
  /** It depends on itself. */
  passing?: boolean
}

/** Duration of a notice that disappears by itself. */
const PASSING = 4000

/** Notices of the server, one for each matter. */
class Notes {
  private readonly notes = new Map<string, HTMLElement>()

  constructor(private readonly element: HTMLElement) {}

  show(key: string, what: string, { stop, detail, part, actions = {}, links = [], closing, passing }: Note = {}): void {
    const focused = this.notes.get(key)?.querySelector<HTMLButtonElement>('button:focus')?.textContent
    const buttons = Object.entries(actions).map(([name, run]) => el('button', { type: 'button', onclick: run }, name))
    const anchors = links.map(([name, to]) => el('a', { href: to, target: '_blank' }, name))
    const note = el(
      'div',
      { class: stop ? 'notice stop' : 'notice', role: stop ? 'alert' : 'status', 'data-testid': `note-${key}` },
      el('p', {}, ...prose(what)),
      detail !== undefined && el('pre', {}, detail),
      part !== undefined && el('progress', { value: part, max: 1 }),
      (buttons.length > 0 || anchors.length > 0 || closing) &&
        el(
          'p',
          { class: 'actions' },
          ...anchors,
          ...buttons,
          closing && el('button', { type: 'button', onclick: () => this.drop(key) }, 'Close'),
        ),
    )
    const before = this.notes.get(key)
    if (before) before.replaceWith(note)
    else this.element.append(note)
    this.notes.set(key, note)
    buttons.find((button) => button.textContent === focused)?.focus()
    if (passing) setTimeout(() => this.notes.get(key) === note && this.drop(key), PASSING)
  }

  drop(key: string): void {
    this.notes.get(key)?.remove()
    this.notes.delete(key)
  }
}

function dialog(title: string, ...content: HTMLElement[]): void {
  const close = () => element.close()
  const element = el(
    'dialog',
    { class: 'help', 'aria-label': title, onclose: () => element.remove() },
    el('h2', {}, title),
    ...content,
    el('button', { type: 'button', onclick: close }, 'Close'),
  )
  document.body.append(element)
  element.showModal()
}
