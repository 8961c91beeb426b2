import './studio.css'
import { el, prose } from '../dom'
import type { Editor } from '../editor/editor'
import { openEditor } from '../editor/open'
import type { StudyResult } from '../engine/engine'
import type { CheckReply, OpenReply, VariableSetting, DesignReply, Text } from '../engine/protocol'
import { type Answer, RequestError } from '../engine/answer'
import { Solver } from '../engine/solver'
import { pageFile, storedDesign } from '../export/page_file'
import { save } from '../export/save'
import { messageOf } from '../format'
import { prefer, preference } from '../preferences'
import type { Picture } from '../linkage/backdrop'
import { Drawing } from '../linkage/drawing'
import { page, type PageMemory, type PageParts, slot } from '../page'
import { hasCases } from '../page/metrics'
import type { Item } from '../page/menu'
import type { VariableLimits } from '../page/variables'
import type { Design as WireDesign, ModelText, Payload } from '../payload'
import { design, read, type Design, type Report } from '../report'
import { type ChoiceMemory, State } from '../state'
import type { Figure } from '../page/figure'
import { targetButton } from './draw_target'
import { designToml, isSameDesign } from './designs'
import { goalsOfCards } from './card_goal'
import { Drawer } from './drawer'
import { type Aim, boundsToml, type Chosen, goalToml, type Judged, toleranceToml } from './goal'
import type { Proposal } from './goal_form'
import { Grips } from './grips'
import { History, type Snapshot, type Step } from './history'
import { historyBar } from './history_bar'
import { Mover } from './mover'
import { changesOf, settingsOf } from './moves'
import { PathPoints } from './path_points'
import type { PathTask } from './path_task'
import { PointsPane } from './points'
import { connect } from './server'
import { caseNames, independentDrivers, type SeparateMotions, separateMotions } from './motions'
import { type ServerBar, serverBar } from './server_bar'
import { linkedSession, linkOf, type SavedDesign, type Session, Storage } from './session'
import { stopReason } from './stops'
import { type OptimizePane, optimizePane, type StudyDesign, type StudyPane, tolerancePane } from './studies'
import { targetToml } from './target'
import { Workers } from './workers'

/** Milliseconds without a change after which text and sensitivities follow the design. */
const REST = 200
/** Milliseconds between a change and its being kept by the browser. */
const SAVE = 400
/** File of a drawn linkage, and its unit of length. */
const DRAWN = { file: 'linkage.toml', unit: 'mm' }
/** Preference for the motion of the model, where the page would open with one that it derives. */
const OWN_MOTION = 'own-motion'
/** Screens on which the pane of the text would hide the view. */
const NARROW = '(max-width: 1000px)'

/** Choices of a page. */
interface Choices {
  choices: ChoiceMemory
  page: PageMemory
}

/**
 * The page as a studio: designs are solved by the engine as the reader makes them. What is shown is the model's text
 * that was opened or typed and the changes made since; both go into the text that is shown, exported and saved.
 */
export class Studio {
  readonly history: History
  /** One worker solves drags while the other computes sensitivities. */
  readonly #drags: Solver
  readonly #sensing: Solver
  readonly #checks: Solver
  readonly #tools = el('div', { class: 'studio-tools' })
  readonly #status = el('span', { class: 'studio-status', role: 'status', 'data-testid': 'studio-status' })
  readonly #cases = el('span')
  readonly #drawer: Drawer
  /** In a page of a server, its part of the bar. */
  readonly #server?: ServerBar
  readonly #points = new PointsPane(() => this.#scheduleUpdate())
  /** Path for which linkages are sought, in every text and case of the model. */
  readonly #path: PathTask = { points: [], isClosed: false, isFullTurn: false }
  /** Pictures behind planes, by the unit of length. */
  readonly #pictures = new Map<string, Picture>()
  #drawing?: Drawing
  /** Text of the last drawing that was shown. */
  #drawn?: string
  readonly #listeners: (() => void)[] = []
  /** Called at every change of the editor's text. */
  readonly #editListeners: (() => void)[] = []
  #editor?: Editor
  #grips?: Grips
  #mover?: Mover
  /** Metrics of the curves that were drawn. */
  readonly #targets = new Set<string>()
  /** A design of a study that is to be drawn next; undefined if none is waiting or being solved. */
  #previewed?: { design: StudyDesign | undefined }
  /** The design of a study that is drawn next to the present one. */
  #preview?: Design
  /** The design that was compared with before. */
  #compared?: number
  #opened?: OpenReply
  #accepted: VariableSetting[] = []
  #wanted?: VariableSetting[]
  #busy = false
  /** Number of models that are being opened. */
  #opening = 0
  #resting?: ReturnType<typeof setTimeout>
  #hand = 0
  /** The text of the present design, or of the last one that had a text. */
  #text: string
  /** Reason why the present design has no text; empty if it has one. */
  #unwritten = ''
  /** A text that is being solved, and why the last one could not be shown. */
  #next?: string
  #failure?: unknown
  /** Counts the requests, so that an outdated answer is ignored. */
  #version = 0
  /** The page's design of each snapshot that was compared with. */
  readonly #solved = new Map<Snapshot, Design>()
  /** Choices by case, for when it is shown again; and those that the next page is to make. */
  readonly #choices = new Map<string | null, Choices>()
  #recalled?: Choices
  /** Drivers that move independently in the motion of the model; undefined if curves over travel are no loops. */
  #drivers?: readonly string[]
  /** The text that was parsed last for the cases of these drivers. */
  #parsed?: { text: string; drivers: readonly string[]; motions: SeparateMotions | undefined }
  /** Report and model that the page was made of. */
  readonly #first: { report: Report; model: ModelText }
  readonly #recorded: readonly VariableSetting[]
  /** True if the next page is to open with the sheet of its motion. */
  #fresh = false
  readonly #storage: Storage
  #saving?: ReturnType<typeof setTimeout>
  /** Stored work that the reader has not decided about, and the offer to restore it. */
  #stored?: Session
  #offer?: HTMLElement

  constructor(
    module: WebAssembly.Module,
    private readonly root: HTMLElement,
    private model: ModelText,
    private state: State,
    private made: PageParts,
  ) {
    this.#drags = new Solver(module)
    this.#sensing = new Solver(module)
    this.#checks = new Solver(module)
    this.#text = model.text
    this.#first = { report: state.report, model }
    this.#drivers = independentDrivers(state.report)
    this.#recorded = state.recorded
    this.history = new History({ text: model.text, settings: [], label: 'original' })
    this.history.setFileDesigns(state.report.named_designs, model.text)
    // A page made of a changed design, such as that of a fit: undoing a change comes back to this design.
    this.#recordStep()
    this.history.endGesture()
    const bar = historyBar(this.history, {
      show: (step) => void this.#showStep(step),
      compare: () => void this.#compare(),
      write: (snapshot) => this.#writeDesign(snapshot),
    })
    this.#storage = new Storage(model.file, model.text)
    this.#stored = this.#storage.load()
    this.history.onChange(() => this.#saveSoon())
    addEventListener('pagehide', () => this.#save())
    addEventListener('beforeunload', (event) => {
      this.#save()
      // The browser keeps designs only. The server's part of the bar knows what is saved on disk.
      const isLost = !this.#server && this.#editor?.unshown !== undefined
      if (isLost || (this.#storage.failed && this.history.changed)) event.preventDefault()
    })
    const host = {
      // The motion of a study is that of the text.
      studies: new Workers(module, (text) => ({ ...this.model, text, case: this.#isDerived ? null : this.model.case })),
      text: () => this.#text,
      present: () => this.#currentText(),
      unwritten: () => this.#unwritten,
      apply: ({ change, text }: StudyResult, studied: string) => void this.#applyResult(change, text, studied),
      preview: (design: StudyDesign | undefined, studied: string) => this.#previewDesign(design, studied),
      targets: this.#targets,
      goals: {
        quantities: () => this.state.report.quantities.map(({ name, units: [unit] }) => ({ name, unit })),
        cases: () => this.#opened?.cases ?? [],
        selected: () => this.#proposal(),
        add: (judged: Judged, aim: Aim, chosen: Chosen) =>
          void this.edit((text) => goalToml(this.#textFor(text, judged), judged, aim, chosen).text, 'goal'),
      },
    }
    const mark = (name: string) => (running: boolean) => this.#drawer.mark(name, running)
    let optimize: OptimizePane | undefined
    const openOptimize = studyPane(() => (optimize = optimizePane(host)), this, mark('Optimise'))
    this.propose = (proposal) => {
      void this.#drawer.open('Optimise').then(() => optimize?.propose(proposal))
    }
    this.#drawer = new Drawer([
      { name: 'Model', title: 'Edit the text of the model', open: () => this.#openEditor() },
      {
        name: 'Points',
        title: 'Table of the hardpoints',
        open: async () => (this.#points.show(this.#mover), this.#points.element),
      },
      {
        name: 'Optimise',
        title: 'Optimise the design for the goals of the model',
        open: openOptimize,
      },
      {
        name: 'Tolerance',
        title: 'Tolerance analysis',
        open: studyPane(() => tolerancePane(host), this, mark('Tolerance')),
      },
    ])
    goalsOfCards(
      root,
      () => this.#opened !== undefined,
      (of) => this.propose({ ...this.#proposal(), of }),
    )
    const server = connect(document)
    const own = {
      text: () => this.#currentText(),
      visible: async () => this.#editor?.unshown ?? this.#currentText(),
      replace: (text: string) => void this.replace(text, 'from disk'),
      onChange: (listener: () => void) => {
        this.onText(listener)
        this.#editListeners.push(listener)
      },
    }
    this.#server = server?.file ? serverBar(server, own) : undefined
    // A drawing would replace the model that the server's file is of.
    const address = server && !server.isNew ? server.newLink : undefined
    const draw = el(
      'button',
      {
        type: 'button',
        'data-testid': 'draw-linkage',
        title: 'Draw a new planar linkage',
        onclick: () => (address ? location.assign(address) : this.#draw()),
      },
      'Draw',
    )
    this.#tools.append(
      bar,
      this.#cases,
      ...this.#drawer.buttons,
      draw,
      ...(this.#server ? [this.#server.element] : []),
      this.#status,
    )
    document.body.append(this.#drawer.element)
    slot(made.bar, this.#tools)
    this.#attach()
    void this.#begin().then(() => {
      if (server?.isNew) this.#draw()
    })
  }

  /** Opens or closes the sheet on which a linkage is drawn. */
  #draw(): void {
    if (!this.#drawing) {
      this.#drawing = new Drawing({
        unit: DRAWN.unit,
        picture: this.#picture(DRAWN.unit),
        check: async (text) =>
          (await this.#checks.ask<CheckReply>({ ask: 'check', model: { ...this.model, text, case: null } })).json
            .messages,
        show: (text) => this.#showDrawn(text),
      })
      this.#placeDrawing()
    }
    this.#drawing.toggle()
  }

  /** Puts the sheet over the view, and its pane below. */
  #placeDrawing(): void {
    const view = this.root.querySelector('.view')
    if (!this.#drawing || !view) return
    view.append(this.#drawing.element)
    view.after(this.#drawing.pane)
  }

  /** Solves and shows the text of a drawing, next to which the text is opened; throws where that fails. */
  async #showDrawn(text: string): Promise<void> {
    if (text !== this.#text) {
      // Another mechanism has nothing to recall.
      if (this.model.text !== this.#drawn) {
        this.#fresh = true
        this.#recalled = { choices: this.state.memory, page: { figures: [], tab: '' } }
      }
      this.#drawn = text
      this.history.go({ text, settings: [], label: 'linkage' })
      const solved = this.#openModel({ ...this.model, text, case: null }, [])
      this.#setText(text)
      await solved
    }
    if (this.#failure) throw this.#failure
    if (!matchMedia(NARROW).matches) await this.#drawer.open('Model')
  }

  #picture(unit: string): Picture {
    const picture = this.#pictures.get(unit) ?? {}
    this.#pictures.set(unit, picture)
    return picture
  }

  /** Name of the file of the present text. */
  get #file(): string {
    return this.model.text === this.#drawn && !this.#server ? DRAWN.file : this.model.file
  }

  /** Opens the model, then the design of the address, or the offer to restore stored work. */
  async #begin(): Promise<void> {
    const linked = await linkedSession()
    const first = linked || this.#stored || storedDesign(document) ? undefined : this.#openingCase()
    if (first === undefined || !(await this.#openCase(first))) await this.#open()
    if (await this.#restoreSaved()) return
    if (linked) await this.#resume(linked, 'link')
    else if (this.#stored) this.#offerStored(this.#stored)
  }

  /** The text of the present design. */
  get text(): string {
    return this.#text
  }

  /** Called when the text is another, or unknown. */
  onText(listener: () => void): void {
    this.#listeners.push(listener)
  }

  /** Shows another text. */
  async replace(text: string, label: string): Promise<void> {
    if (text === this.#text && !this.#unwritten) return this.#editor?.setText(text)
    await this.#take(text, label)
  }

  /** Makes a text that of the original design, as another step of the history. */
  async #take(text: string, label: string): Promise<void> {
    this.history.go({ text, settings: [], label })
    const solved = this.#openModel({ ...this.model, text }, [])
    this.#setText(text)
    await solved
  }

  /** Changes the text of the original design; the changes made since stay. */
  async edit(change: (text: string) => string, label: string): Promise<void> {
    const { settings } = this.state
    const text = change(this.model.text)
    if (text === this.model.text) return
    this.history.go({ text, settings, label })
    await this.#openModel({ ...this.model, text }, settings)
  }

  /** Opens the pane of the optimisation with a goal for a quantity or a metric. */
  readonly propose: (proposal: Proposal) => void

  #proposal(): Proposal {
    const { quantities } = this.state.report
    const { quantity, over } = this.state.choice
    return {
      of: quantities[quantity]?.name ?? '',
      over: over === undefined ? undefined : quantities[over].name,
      case: this.#isDerived ? (this.model.case ?? undefined) : undefined,
    }
  }

  /** Bounds and tolerances of variables, which are kept in the text. */
  readonly limits: VariableLimits = {
    setBounds: (name, bounds) => {
      if (boundsToml(this.model.text, name, bounds) === undefined)
        return `\`${name}\` is not a variable of the model's text, so that it has no bounds there.`
      void this.edit((text) => boundsToml(text, name, bounds) ?? text, `bounds of ${name}`)
      return undefined
    },
    setTolerance: (name, tolerance) =>
      void this.edit((text) => toleranceToml(text, name, tolerance), `tolerance of ${name}`),
  }

  /** Items for export in addition to those of the report. */
  readonly exports = (): Item[] => [
    { name: 'Link to this design', testId: 'export-link', run: () => this.#link() },
    {
      name: 'Model as TOML',
      testId: 'export-toml',
      run: async () => {
        save(new Blob([await this.#currentText()], { type: 'application/toml' }), this.#file)
        if (this.#editor?.unshown !== undefined)
          this.#showStatus('Exported the last valid text, without the edits since then in the pane of the model.')
      },
    },
    {
      name: 'Page with this design',
      testId: 'export-html',
      run: () => {
        const { text } = this.model
        const design = { text, case: this.model.case, settings: this.state.settings }
        save(pageFile(document, design), `${this.#file.replace(/\.[^.]*$/, '')}.html`)
      },
    },
  ]

  /** Draws the curve that the quantity of a figure is to have. */
  target(figure: Figure): HTMLElement | undefined {
    if (!this.#opened) return undefined
    const { quantities } = this.state.report
    const drawn = () => {
      const { quantity, over } = figure.subject
      const several = (this.#opened?.cases.length ?? 0) > 1
      return {
        of: quantities[quantity].name,
        over: over === undefined ? undefined : quantities[over].name,
        case: several ? (this.model.case ?? this.#opened?.cases[0]) : undefined,
      }
    }
    const target = targetButton(figure.plot, drawn, (curve) => {
      this.#targets.add(targetToml(this.model.text, curve).name)
      void this.edit((text) => targetToml(this.#textFor(text, curve), curve).text, `target of ${curve.of}`)
    })
    const goal = el(
      'button',
      {
        type: 'button',
        'data-testid': 'goal',
        title: 'Minimise it, bring it to a value, or keep it within limits',
        onclick: () => this.propose(drawn()),
      },
      'Goal…',
    )
    return el('span', { class: 'tools' }, goal, target)
  }

  /** Takes hold of hardpoints, or lets go. */
  grips(): void {
    this.#grips?.toggle()
  }

  /** Lets go of hardpoints; false if none could be moved. */
  leave(): boolean {
    return this.#grips?.leave() ?? false
  }

  #showStatus(words: string): void {
    this.#status.textContent = this.#status.title = words
  }

  /** Listens to changes of the shown design. */
  #attach(): void {
    const { state } = this
    state.onChange(() => {
      this.#recordStep()
      this.#scheduleUpdate()
    })
    state.showWholeMotion = () => void this.#currentText().then((text) => this.#take(text, 'whole motion'))
    state.onChoice(() => {
      this.#saveSoon()
      this.#showPoints()
    })
  }

  /** The work so far. */
  get #session(): Session {
    const { first, present, snapshots, compared } = this.history
    const saved = ({ text, settings }: Step) => ({ text: text === first.text ? undefined : text, settings })
    return {
      design: saved(present),
      named: snapshots.filter(({ isOfFile }) => !isOfFile).map(({ name, step }) => ({ name, ...saved(step) })),
      compared: compared.map(({ name }) => name),
      choices: this.state.memory,
      page: this.made.memory,
      case: this.model.case,
      saved: Date.now(),
    }
  }

  #saveSoon(): void {
    this.#saving ??= setTimeout(() => this.#save(), SAVE)
  }

  /** Keeps the work in the browser; what is not changed needs no keeping, unless older work is still on offer. */
  #save(): void {
    clearTimeout(this.#saving)
    this.#saving = undefined
    const { changed, snapshots, compared } = this.history
    if (changed || compared.length > 0 || snapshots.some(({ isOfFile }) => !isOfFile)) this.#storage.save(this.#session)
    else if (!this.#stored) this.#storage.clear()
  }

  #offerStored(session: Session): void {
    const end = () => {
      this.#offer?.remove()
      this.#offer = this.#stored = undefined
    }
    const button = (name: string, run: () => void) =>
      el('button', { type: 'button', 'data-testid': name.toLowerCase(), onclick: () => (end(), run()) }, name)
    const { settings, text } = session.design
    const count = `${settings.length} change${settings.length === 1 ? '' : 's'}`
    const what = [text !== undefined && 'an edited model', settings.length > 0 && count].filter(Boolean).join(', ')
    const when = new Date(session.saved).toLocaleString([], { dateStyle: 'medium', timeStyle: 'short' })
    this.#offer = el(
      'div',
      { class: 'restore', role: 'status', 'data-testid': 'restore-bar' },
      el('span', {}, `Unsaved work of ${when}${what ? `: ${what}` : ''}.`),
      button('Restore', () => void this.#resume(session, 'restored')),
      button('Discard', () => this.#save()),
    )
    this.made.notices.append(this.#offer)
  }

  /** Goes on with stored or linked work. */
  async #resume(session: Session, label: string): Promise<void> {
    const { design, named, compared, choices, page, case: shown = this.model.case } = session
    const { history } = this
    const step = ({ text, settings }: SavedDesign, label: string): Step => ({
      text: text ?? history.first.text,
      settings,
      label,
    })
    const saved = named.map((one) => history.save(one.name, step(one, one.name)))
    const snapshots = [...saved, ...history.snapshots.filter(({ isOfFile }) => isOfFile)]
    history.compareWith(compared.flatMap((name) => snapshots.find((one) => one.name === name) ?? []))
    this.#recalled = { choices, page }
    const { text, settings } = step(design, label)
    history.go({ text, settings, label })
    await this.#openModel({ ...this.model, text, case: shown }, [...settings])
  }

  /** Puts a link with the present design into the address and the clipboard. */
  async #link(): Promise<void> {
    const link = await linkOf(this.#session)
    history.replaceState(null, '', link)
    await navigator.clipboard?.writeText(link).catch(() => undefined)
    this.#showStatus('The address of this page now carries the design.')
  }

  /** Shows the design that the page was saved with; false if it was saved without one. */
  async #restoreSaved(): Promise<boolean> {
    const stored = storedDesign(document)
    if (!stored || !this.#opened) return false
    const { text, settings } = stored
    if (text === this.model.text && stored.case === this.model.case) {
      this.state.setDesign(settings)
      return true
    }
    this.history.go({ text, settings, label: 'saved' })
    await this.#openModel({ ...this.model, text, case: stored.case }, settings)
    return true
  }

  /** Opens the model in the engine; from then on changes are solved. */
  async #open(): Promise<void> {
    const version = ++this.#version
    const { state } = this
    try {
      const { json } = await this.#drags.ask<OpenReply>({ ask: 'open', model: this.#solvable(this.model) })
      if (version !== this.#version) return
      this.#opened = json
      this.#accepted = []
      state.solver = () => this.#solve()
      this.#offerGrips()
      this.#offerCases(json.cases)
      this.#showStatus('')
      this.root.dataset.engine = 'ready'
      state.choose({})
      if (state.changed) this.#solve()
    } catch (error) {
      this.#showStatus(`Showing linear predictions, because the solver is not available: ${messageOf(error)}`)
      this.root.dataset.engine = 'failed'
    }
  }

  #showPoints(): void {
    if (this.#points.element.isConnected) this.#points.show(this.#mover)
  }

  #offerGrips(): void {
    const { view } = this.made
    if (!this.#opened) return
    const mover = new Mover(this.state, this.#opened)
    this.#mover = mover
    this.state.hardpoints = () =>
      mover.grips.map((grip) => ({ name: grip.name, before: grip.place, now: mover.place(grip).toArray() }))
    this.#showPoints()
    if (!view) return
    const grips = new Grips(view, this.state, this.#opened, mover, () => this.#scheduleUpdate())
    this.#grips = grips
    view.element.append(grips.element)
    view.element.after(grips.pane)
    const looks = view.element.querySelector('.looks')
    looks?.append(grips.button)
    const { plane } = view.original
    if (!plane) return
    const path = new PathPoints(
      view,
      this.state,
      this.#path,
      plane,
      this.#picture(this.state.report.units.length),
      this.#server?.synthesize,
    )
    view.element.append(path.element)
    view.element.after(path.pane)
    looks?.append(path.button)
  }

  #offerCases(cases: string[]): void {
    if (cases.length > 0) this.state.case = this.model.case ?? cases[0]
    const motions = this.#motions
    const shown = this.model.case ?? (motions ? '' : cases[0])
    const offered = motions
      ? [...motions.names.map((name) => [name, `${name} alone`]), ['', 'all drivers']]
      : cases.map((name) => [name, name])
    if (offered.length < 2) return this.#cases.replaceChildren()
    const select = el(
      'select',
      {
        'aria-label': 'Case',
        title: motions ? 'Driver that moves' : `Case ${shown}`,
        'data-testid': 'case',
        onchange: () => (motions ? this.#chooseMotion(select.value || null) : void this.#openCase(select.value)),
      },
      ...offered.map(([value, name]) => el('option', { value, selected: value === shown }, name)),
    )
    this.#cases.replaceChildren(select)
  }

  /** Names the motion that the page derived, with buttons for the model's own and for cases in its text. */
  #derivedNotice(): HTMLElement {
    const button = (name: string, testId: string, title: string, onclick: () => void) =>
      el('button', { type: 'button', 'data-testid': testId, title, onclick }, name)
    return el(
      'p',
      { class: 'derived-motion', role: 'status', 'data-testid': 'derived-motion' },
      el(
        'span',
        {},
        ...prose(`Motion derived from the model: \`${this.model.case}\` moves alone`),
        el('span', { class: 'detail' }, ', all other drivers are fixed in the design configuration'),
        '.',
      ),
      button('All drivers', 'own-motion', 'Show the motion of the model', () => this.#chooseMotion(null)),
      button('Write cases', 'write-cases', 'Write a case for each driver into the text of the model', () =>
        this.#writeCases(),
      ),
    )
  }

  /** Writes the derived cases into the text. */
  #writeCases(): void {
    const motions = this.#motions
    if (motions) void this.edit(() => motions.text, 'cases')
  }

  /** Shows a derived case or the motion of the model, which the browser remembers. */
  #chooseMotion(name: string | null): void {
    prefer(OWN_MOTION, name === null ? 'yes' : 'no')
    void this.#openCase(name)
  }

  /** Cases with one moving driver each, which the page derives from the text of the model; undefined if it has none. */
  get #motions(): SeparateMotions | undefined {
    return this.#motionsOf(this.model.text)
  }

  /** The same of another text; a text is parsed once. */
  #motionsOf(text: string): SeparateMotions | undefined {
    const drivers = this.#drivers
    if (!drivers) return undefined
    if (this.#parsed?.text !== text || this.#parsed.drivers !== drivers)
      this.#parsed = { text, drivers, motions: separateMotions(text, drivers) }
    return this.#parsed.motions
  }

  /** True if the case that is shown is not in the text of the model. */
  get #isDerived(): boolean {
    return this.model.case !== null && this.#motions !== undefined
  }

  /** The derived case that the page opens with, if its curves over time would otherwise be loops over travel. */
  #openingCase(): string | undefined {
    const { report, sheet, changed } = this.state
    const isOfRun = report.plots.length === 0 && report.over === null && !report.study && !report.sweep && !changed
    const isWanted = isOfRun && sheet.plots[0]?.over === undefined && preference(OWN_MOTION) !== 'yes'
    return isWanted && this.model.case === null ? this.#motions?.names[0] : undefined
  }

  /** Shows another case; false if it could not be solved. */
  async #openCase(name: string | null): Promise<boolean> {
    // Curves of a derived motion are over another abscissa than those of all drivers.
    this.#fresh = this.#motions !== undefined && !this.#choices.has(name)
    await this.#openModel({ ...this.model, case: name }, this.state.settings)
    return this.model.case === name
  }

  /** A model as the engine solves it: with the derived cases in its text, if one of them is shown. */
  #solvable(model: ModelText): ModelText {
    if (model.case === null || caseNames(model.text).includes(model.case)) return model
    const motions = this.#motionsOf(model.text)
    if (motions?.names.includes(model.case)) return { ...model, text: motions.text }
    // The text that is opened has no such driver any more.
    return this.#isDerived ? { ...model, case: null } : model
  }

  /** A text, with the derived cases if a metric is of one of them. */
  #textFor(text: string, metric: { case?: string } | { metric: string }): string {
    const isOfCase = 'case' in metric && metric.case !== undefined && this.#isDerived
    return (isOfCase && this.#motionsOf(text)?.text) || text
  }

  /** Notes the design as a step of the history, or as part of what the hand does. */
  #recordStep(): void {
    const { settings } = this.state
    this.history.go({ text: this.model.text, settings, label: settings.at(-1)?.name ?? 'reset' }, `${this.#hand}`)
  }

  /** Solves the changed design; while the engine is busy, only the last change waits. */
  #solve(): void {
    this.root.dataset.settled = 'no'
    this.#wanted = this.state.settings
    if (!this.#busy) void this.#solvePending()
  }

  async #solvePending(): Promise<void> {
    this.#busy = true
    const version = this.#version
    while (this.#wanted && version === this.#version) {
      const wanted = this.#wanted
      this.#wanted = undefined
      await this.#solveDesign(wanted, version)
    }
    this.#busy = false
    this.#scheduleUpdate()
  }

  async #solveDesign(wanted: VariableSetting[], version: number): Promise<void> {
    const { state } = this
    if (wanted.length === 0) {
      this.#accepted = []
      return state.solved(undefined, [], { last: !this.#wanted })
    }
    try {
      const from = this.#accepted
      // What is shown stops a change; with the shapes hidden it goes through.
      const solid = state.choice.shapes
      const answer = await this.#drags.ask<DesignReply>({ ask: 'design', change: wanted, from, solid })
      if (version !== this.#version) return
      const { part, why } = answer.json
      const reached = part === 1 ? wanted : between(this.#accepted, wanted, part)
      this.#accepted = reached
      state.solved(this.#read(answer.json.design, answer, reached), reached, {
        refusal: why ? stopReason(why.message, part < 1) : '',
        isShort: part < 1,
        last: !this.#wanted,
      })
    } catch (error) {
      if (version !== this.#version) return
      this.#showStatus(messageOf(error))
      // After a failure the engine has nothing open.
      if (!(error instanceof RequestError)) void this.#open()
    }
  }

  #read(found: WireDesign | null, { decode }: Answer<unknown>, settings: VariableSetting[]): Design | undefined {
    if (!found) return undefined
    const by = changesOf(settings)
    return { ...design(found, decode), change: this.state.report.variables.map(({ name }) => by.get(name) ?? 0) }
  }

  #scheduleUpdate(): void {
    clearTimeout(this.#resting)
    this.root.dataset.settled = 'no'
    this.#resting = setTimeout(() => void this.#update(), REST)
  }

  /** Text and sensitivities follow the design. */
  async #update(): Promise<void> {
    // A model that is opened ends with an update of its own; this one would end its request.
    if (this.#busy || this.#opening > 0 || this.#grips?.isDragging) return
    const { state } = this
    // The hand has let go: what comes next is another step. Where the design stopped, it is noted as it is.
    this.#recordStep()
    this.#hand++
    this.history.endGesture()
    const [settings, version] = [state.settings, this.#version]
    const same = () => version === this.#version && JSON.stringify(settings) === JSON.stringify(state.settings)
    const refuse = (error: unknown) => {
      if (!same()) return
      state.unsolved = messageOf(error)
      this.#showStatus(state.unsolved)
      state.choose({})
      this.root.dataset.settled = 'yes'
    }
    let text: string
    try {
      text = await this.#currentText()
      if (!same()) return
      this.#setUnwritten('')
      this.#setText(text)
    } catch (error) {
      if (same()) this.#setUnwritten(messageOf(error))
      return refuse(error)
    }
    try {
      if (settings.length === 0) state.setSensitivities(undefined, [])
      else if (!state.hasCurrentSensitivities) {
        this.#sensing.stop()
        const found = await this.#sensing.ask<Payload>({ ask: 'page', model: this.#solvable({ ...this.model, text }) })
        const report = read(found.json, found.decode)
        if (!same()) return
        if (hasSameNames(report, state.report)) state.setSensitivities(report, settings)
      }
      state.unsolved = ''
      this.#showStatus('')
      this.root.dataset.settled = 'yes'
    } catch (error) {
      refuse(error)
    }
  }

  /** Notes why the present design has no text. */
  #setUnwritten(why: string): void {
    if (why === this.#unwritten) return
    this.#unwritten = why
    for (const listener of this.#listeners) listener()
  }

  /** The text with the changes. */
  async #currentText(): Promise<string> {
    const { settings } = this.state
    if (settings.length === 0) return this.#next ?? this.model.text
    const derived = this.#isDerived ? this.#motions?.added : undefined
    const { text } = (await this.#drags.ask<Text>({ ask: 'text', change: settings })).json
    return derived === undefined ? text : text.replace(derived, () => '')
  }

  #setText(text: string): void {
    if (text === this.#text) return
    this.#text = text
    this.#editor?.setText(text)
    for (const listener of this.#listeners) listener()
  }

  /** Shows a step of the history. */
  async #showStep({ text, settings }: Step): Promise<void> {
    this.#hand++
    if (text === this.model.text) this.state.setDesign([...settings])
    else await this.#openModel({ ...this.model, text }, [...settings])
  }

  /** Shows another model, solved anew. */
  async #openModel(model: ModelText, settings: VariableSetting[]): Promise<void> {
    this.#showStatus('solving')
    this.root.dataset.settled = 'no'
    this.#failure = undefined
    this.#next = model.text
    this.#version++
    this.#sensing.stop()
    this.#opening++
    try {
      const { model: solved, report } = await this.#page(model)
      const former = this.model.case
      this.model = solved
      if (solved.case === null) this.#drivers = independentDrivers(report)
      this.#next = undefined
      this.history.setFileDesigns(report.named_designs, this.model.text)
      this.#show(report, former)
      this.#setUnwritten('')
      this.#setText(this.model.text)
      await this.#open()
      if (this.history.compared.length > 0) await this.#compare()
      if (settings.length > 0 || this.state.changed) this.state.setDesign(settings)
      else this.root.dataset.settled = 'yes'
    } catch (error) {
      this.#failure = error
      this.#showStatus(messageOf(error))
      this.root.dataset.settled = 'yes'
      if (error instanceof RequestError) this.#editor?.showMessages(error.messages)
    } finally {
      this.#opening--
    }
  }

  /** A model with its report, whose records are those of the page if they are of the same text. */
  async #page(model: ModelText): Promise<{ model: ModelText; report: Report }> {
    const { report, model: first } = this.#first
    if (model.text === first.text && model.case === first.case) return { model: first, report }
    const solvable = { ...this.#solvable(model), shown: null }
    const { json, decode } = await this.#sensing.ask<Payload>({ ask: 'page', model: solvable })
    const found = { model: { ...(json.model ?? solvable), text: model.text }, report: read(json, decode) }
    if (model.text === first.text) {
      const { maps, sweep, study } = report
      const metrics = report.metrics && hasCases(report.metrics) ? report.metrics : found.report.metrics
      Object.assign(found.report, { maps, sweep, study, metrics })
    }
    return found
  }

  /** Rebuilds the page with the former choices; another case has its own, if it was shown before. */
  #show(report: Report, former: string | null): void {
    const before = this.state
    const { view } = this.made
    const on = this.#grips?.on ?? false
    const choices = { choices: before.memory, page: this.made.memory }
    this.#choices.set(former, choices)
    const own = former === this.model.case ? undefined : this.#choices.get(this.model.case)
    const recalled = this.#recalled ?? own ?? choices
    const fresh = this.#fresh
    this.#recalled = undefined
    this.#fresh = false
    before.end()
    const graphics = view?.end()
    keepMeshes(before.report, report)
    const state = new State(report)
    state.recorded = this.#recorded
    if (!fresh) state.recall({ ...recalled.choices, time: before.time })
    this.root.replaceChildren()
    this.state = state
    this.#solved.clear()
    this.made = page(this.root, state, {
      bar: this.#tools,
      memory: fresh ? { ...recalled.page, figures: [] } : recalled.page,
      graphics,
      exports: this.exports,
      grips: () => this.grips(),
      leave: () => this.leave(),
      limits: this.limits,
      figure: (figure) => this.target(figure),
    })
    if (this.#offer) this.made.notices.append(this.#offer)
    if (this.#isDerived) this.made.notices.append(this.#derivedNotice())
    this.#placeDrawing()
    state.goToStep(state.step)
    this.#grips = undefined
    this.#attach()
    if (on) queueMicrotask(() => (this.#grips as Grips | undefined)?.toggle())
  }

  /** Draws the compared designs together with the present one. */
  async #compare(): Promise<void> {
    const { state } = this
    try {
      for (const snapshot of this.history.compared) {
        if (this.#solved.has(snapshot)) continue
        const found = await this.#solveSnapshot(snapshot)
        if (state !== this.state) return
        if (!found) continue
        const compared = { ...found, name: snapshot.name }
        state.addComparison(compared)
        this.#solved.set(snapshot, compared)
      }
    } catch (error) {
      this.#showStatus(messageOf(error))
    }
    const solved = this.history.compared.flatMap((snapshot) => this.#solved.get(snapshot) ?? [])
    const shown = solved.map((design) => state.designs.indexOf(design))
    state.choose({ compared: shown.at(-1), overlays: shown.slice(0, -1) })
  }

  async #solveSnapshot({ step: { text, settings } }: Snapshot): Promise<Design | undefined> {
    if (text === this.model.text) return this.#solveAlone([...settings])
    await this.#sensing.ask<OpenReply>({ ask: 'open', model: this.#solvable({ ...this.model, text }) })
    const { json } = await this.#sensing.ask<Text>({ ask: 'text', change: [...settings] })
    const answer = await this.#drags.ask<DesignReply>({
      ask: 'beside',
      model: this.#solvable({ ...this.model, text: json.text }),
    })
    return this.#read(answer.json.design, answer, [...settings])
  }

  /**
   * Writes a design to the text of the original as an entry of `[designs]`, and saves that on a server; returns what
   * was done. Changes of the present design are not written.
   */
  async #writeDesign(snapshot: Snapshot): Promise<string> {
    const { name, step } = snapshot
    const { text } = this.model
    const variables = this.state.report.variables.map(({ name }) => name)
    const written = designToml(text, name, step.settings, variables)
    const refusal = (why: string) => `\`${name}\` is not written: ${why}`
    if (written.settings.length === 0) return refusal('it is the original design.')
    try {
      const check = await this.#checks.ask<CheckReply>({
        ask: 'check',
        model: this.#solvable({ ...this.model, text: written.text }),
      })
      const wrong = check.json.messages.find(({ severity }) => severity === 'error')
      if (wrong) return refusal(`${wrong.message}.`)
      // Of another text, or through new variables, the same numbers may be another design.
      if (step.text !== text || written.added.length > 0) {
        const kept = await this.#solveIn(step.text, step.settings)
        const found = await this.#solveIn(written.text, written.settings)
        if (!kept || !found || !isSameDesign(kept, found))
          return refusal(
            step.text === text
              ? 'a point with a mirror image moves alone. Move both alike, or give it a design variable in the text.'
              : 'its changes count from another text of the model. Open it, then write it.',
          )
      }
    } catch (error) {
      return refusal(`${messageOf(error)}.`)
    }
    if (text !== this.model.text) return refusal('the model was changed meanwhile. Write it again.')
    this.history.markWritten(snapshot)
    await this.edit(() => written.text, `[designs] ${name}`)
    if (this.model.text !== written.text) return refusal('the model could not be solved.')
    await this.#server?.save(written.text)
    const added = written.added.map((name) => `\`${name}\``).join(', ')
    return [
      `\`${name}\` is in the text of the model`,
      added && `, with new design variables ${added}`,
      this.#server ? '.' : '. Export, Model as TOML, downloads it.',
    ].join('')
  }

  /** A design of a text, solved without a path to it. */
  async #solveIn(text: string, settings: readonly VariableSetting[]): Promise<Design | undefined> {
    await this.#checks.ask<OpenReply>({ ask: 'open', model: this.#solvable({ ...this.model, text }) })
    const change = [...settings]
    const answer = await this.#checks.ask<DesignReply>({ ask: 'design', change, from: null, solid: false })
    return answer.json.design ? design(answer.json.design, answer.decode) : undefined
  }

  /** Draws a design of a study under way next to the present one; of several at once the last. */
  #previewDesign(design: StudyDesign | undefined, studied: string): void {
    if (design && (studied !== this.#text || this.#unwritten)) return
    const isIdle = this.#previewed === undefined
    this.#previewed = { design }
    if (isIdle) void this.#drawPreviews()
  }

  async #drawPreviews(): Promise<void> {
    while (this.#previewed) {
      const { design } = this.#previewed
      const { state } = this
      // A design of a search may not move at all: there is nothing to draw then.
      const settings = design && added(state.settings, design.change)
      const found = settings && (await this.#solveAlone(settings).catch(() => undefined))
      if (this.state === state) this.#showPreview(found && { ...found, name: design.name })
      if (this.#previewed.design === design) this.#previewed = undefined
    }
  }

  /** A design of the model's own text, solved without a path to it. */
  async #solveAlone(settings: VariableSetting[]): Promise<Design | undefined> {
    const answer = await this.#drags.ask<DesignReply>({ ask: 'design', change: settings, from: null, solid: false })
    return this.#read(answer.json.design, answer, settings)
  }

  /** Draws a design dashed, as the one that the present one is compared with; undefined ends that. */
  #showPreview(design: Design | undefined): void {
    const { state } = this
    const { comparisons, choice } = state
    const at = this.#preview ? comparisons.indexOf(this.#preview) : -1
    if (at >= 0) comparisons.splice(at, 1)
    this.#preview = design
    if (design) {
      if (at < 0) this.#compared = choice.compared
      comparisons.push(design)
      state.choose({ compared: state.designs.length - 1 })
    } else if (at >= 0) {
      if (this.history.compared.length > 0) void this.#compare()
      else state.choose({ compared: this.#compared })
    }
  }

  /**
   * Makes the design that a study found the present one. Changes of the model itself keep it as the dashed original;
   * before another text, the present design is given a name and compared with.
   */
  async #applyResult(change: VariableSetting[] | null, text: string | null, studied: string): Promise<void> {
    const { history } = this
    if (change && studied === history.present.text && studied === this.model.text) {
      history.go({ text: studied, settings: change, label: 'optimised' })
      return this.state.setDesign(change)
    }
    const former = history.save('before optimisation')
    history.compareWith([former])
    if (text !== null) return this.replace(text, 'found')
    // A design without a text of its own is a change of the text that was studied.
    const settings = change ?? []
    history.go({ text: studied, settings, label: 'found' })
    await this.#openModel({ ...this.model, text: studied }, settings)
  }

  async #openEditor(): Promise<HTMLElement> {
    this.#editor ??= await openEditor({
      text: this.#text,
      check: {
        check: async (text) =>
          (await this.#checks.ask<CheckReply>({ ask: 'check', model: this.#solvable({ ...this.model, text }) })).json
            .messages,
      },
      onValid: (text) => void this.replace(text, 'typed'),
      onEdit: () => this.#editListeners.forEach((listener) => listener()),
    })
    return this.#editor.element
  }
}

/** A pane of a study, which reads the text again whenever that changes. */
function studyPane(
  make: () => StudyPane,
  studio: Studio,
  onRunning: (running: boolean) => void,
): () => Promise<HTMLElement> {
  let pane: StudyPane | undefined
  return async () => {
    if (!pane) {
      pane = make()
      pane.onRunning = onRunning
      studio.onText(() => pane!.refresh())
    }
    pane.refresh()
    return pane.element
  }
}

/** Changes made after others. */
function added(first: readonly VariableSetting[], then: readonly VariableSetting[]): VariableSetting[] {
  const sum = changesOf(first)
  for (const { name, by } of then) sum.set(name, (sum.get(name) ?? 0) + by)
  return settingsOf(sum)
}

/** A part of the way from some changes to others. */
export function between(
  from: readonly VariableSetting[],
  to: readonly VariableSetting[],
  part: number,
): VariableSetting[] {
  const before = changesOf(from)
  const after = changesOf(to)
  const names = [...new Set([...before.keys(), ...after.keys()])]
  return names
    .map((name) => ({ name, by: (before.get(name) ?? 0) + part * ((after.get(name) ?? 0) - (before.get(name) ?? 0)) }))
    .filter(({ by }) => by !== 0)
}

/** The engine solves and draws nothing: bodies keep the shapes that the page has of them. */
function keepMeshes(before: Report, after: Report): void {
  for (const body of after.bodies) body.mesh ??= before.bodies.find(({ name }) => name === body.name)?.mesh ?? null
}

/**
 * True if two reports have the same quantities and variables: the page of a what-if has variables that its text has
 * not.
 */
function hasSameNames(a: Report, b: Report): boolean {
  const same = (a: readonly { name: string }[], b: readonly { name: string }[]) =>
    a.length === b.length && a.every(({ name }, k) => name === b[k].name)
  return same(a.quantities, b.quantities) && same(a.variables, b.variables)
}
