import { amount, entry } from '../amount'
import { el, prose } from '../dom'
import type {
  OptimizeOffer,
  OptimizeRequest,
  Running,
  SearchGoal,
  SearchVariable,
  Studies,
  StudyResult,
  ToleranceOffer,
  ToleranceRequest,
} from '../engine/engine'
import type { VariableSetting } from '../engine/protocol'
import { figure, messageOf, pretty } from '../format'
import { factTable } from '../page/checks'
import { hasGoals, metricName } from './goal'
import { GoalForm, type GoalHost, type Proposal } from './goal_form'
import './studio.css'

/** Lines of a study under way that are shown. */
const LINES = 5

/** Names of the designs of a search, while it is under way and of its result. */
const BEST_SO_FAR = 'optimisation, best so far'
const OPTIMISED = 'optimised design'

/** A design of a study, by changes of the text that is studied. */
export interface StudyDesign {
  name: string
  change: VariableSetting[]
}

/** Parts of the page that the panes use. */
export interface StudyHost {
  studies: Studies
  /** The last text that is known of a shown design. */
  text: () => string
  /** The text of the present design; an error says why there is none. */
  present: () => Promise<string>
  /** Reason why the text is not that of the present design; empty if there is none. */
  unwritten: () => string
  /** Shows the design that a study found; its changes count from the text that was studied. */
  apply: (result: StudyResult, studied: string) => void
  /** Shows a design of a study next to the present one, or none any more. */
  preview: (design: StudyDesign | undefined, studied: string) => void
  goals: GoalHost
  /** Metrics of the curves that were drawn: they are goals unless they are deselected. */
  targets: ReadonlySet<string>
}

/** A study with its form, its progress and its result. */
export interface StudyPane {
  readonly element: HTMLElement
  /** Called with true when a study begins, and with false when it ends. */
  onRunning?: (running: boolean) => void
  /**
   * To be called when the pane is opened, and when the text changes while it is: what can be chosen is read again, but
   * for what was changed by hand.
   */
  refresh(): void
}

/** Searches for the best design, for goals that can be added. */
export interface OptimizePane extends StudyPane {
  /** Prepares a goal for a quantity or a metric. */
  propose(proposal: Proposal): void
}

/** Searches for the best design. */
export function optimizePane(host: StudyHost): OptimizePane {
  let proposed: Proposal | undefined
  let shown: GoalForm | undefined
  let isReloaded = false
  const kept: Kept = { variables: new Map(), goals: new Map() }
  const made = pane(host, {
    name: 'Optimise',
    verb: 'Optimise',
    offer: (text) => host.studies.optimizeOffer(text),
    form: (offer) => {
      const form = optimizeForm(
        {
          ...offer,
          goals: offer.goals.map((goal) => ({ ...goal, chosen: goal.chosen || host.targets.has(goal.metric) })),
        },
        kept,
        () => shown!,
      )
      const former = shown
      shown = new GoalForm(
        host.goals,
        offer.goals,
        { chosen: form.chosen, limitBlocked: () => (hasGoals(host.text()) ? '' : form.missing()) },
        (judged, aim) => {
          made.release()
          const target = aim.kind === 'bring' ? String(aim.target) : ''
          const name = 'metric' in judged ? judged.metric : metricName(host.text(), judged)
          if (aim.kind !== 'keep') kept.goals.set(name, { chosen: true, weight: '1', target })
        },
      )
      if (former?.element.open) shown.element.open = true
      if (former && !isReloaded) shown.adopt(former)
      isReloaded = false
      if (proposed) shown.propose(proposed)
      proposed = undefined
      return { ...form, elements: form.elements(shown.element) }
    },
    start: (text, request) => host.studies.optimize(text, request),
    steps: ({ starts, iterations }) => (starts > 1 ? starts : iterations),
    isSeveral: ({ starts }) => starts > 1,
    forget: () => (kept.variables.clear(), kept.goals.clear(), (isReloaded = true)),
  })
  const propose = (proposal: Proposal) => {
    if (shown?.element.isConnected) shown.propose(proposal)
    else proposed = proposal
  }
  return Object.assign(made, { propose })
}

/** Entries of the form that outlive its text, by the names of variables and metrics. */
interface Kept {
  variables: Map<string, { chosen: boolean; low: string; high: string }>
  goals: Map<string, { chosen: boolean; weight: string; target: string }>
}

/** Tolerance study. */
export function tolerancePane(host: StudyHost): StudyPane {
  return pane(host, {
    name: 'Tolerance',
    verb: 'Run tolerance analysis',
    offer: (text) => host.studies.toleranceOffer(text),
    form: toleranceForm,
    start: (text, request) => host.studies.tolerance(text, request),
    steps: ({ samples }) => samples,
    isSeveral: () => false,
    forget: () => {},
  })
}

interface Form<Request> {
  elements: HTMLElement[]
  /** The request; in words, why that cannot be. */
  request: () => Request | string
}

/** Particulars of a study. */
interface Kind<Offer, Request> {
  name: string
  /** On the button that begins it. */
  verb: string
  offer: (text: string) => Promise<Offer>
  form: (offer: Offer) => Form<Request>
  start: (text: string, request: Request) => Running<StudyResult>
  /** Number of steps, as far as it is known before the start. */
  steps: (request: Request) => number
  /** True if it searches from several designs, each of which has a result. */
  isSeveral: (request: Request) => boolean
  /** Forgets what was entered, before the model is read again. */
  forget: () => void
}

function pane<Offer, Request>(
  host: StudyHost,
  { name, verb, offer, form, start, steps, isSeveral, forget }: Kind<Offer, Request>,
): StudyPane & { release: () => void } {
  const testId = name.toLowerCase()
  const element = el('section', { class: 'study', 'aria-label': name, 'data-testid': testId })
  const announced = el('p', { class: 'hidden', role: 'status' })
  /** The text that the form is of. */
  let read: string | undefined
  let touched = false
  let shown: 'nothing' | 'form' | 'progress' | 'result' = 'nothing'

  const show = (...parts: HTMLElement[]) => {
    const focused = element.contains(document.activeElement)
    element.replaceChildren(...parts, announced)
    // The focused element was removed with the former content.
    if (focused) element.querySelector<HTMLElement>('.acts button:not(:disabled)')?.focus()
  }
  const refused = (error: unknown) =>
    el('p', { class: 'refused', role: 'alert', 'data-testid': `${testId}-refused` }, ...prose(messageOf(error)))

  const showForm = (made: Form<Request>, refusal?: HTMLElement) => {
    shown = 'form'
    const view = formView(name, verb, made, refusal, {
      isStale: () => read !== host.text(),
      refusal: host.unwritten,
      changed: () => (touched = true),
      reload: () => (forget(), void load()),
      run: (request) => void work(made, request),
    })
    stale = view.sync
    stale()
    show(view.element)
  }
  let stale = () => {}

  const load = async () => {
    const text = host.text()
    ;[read, touched] = [text, false]
    try {
      const offered = await offer(text)
      if (read === text && shown !== 'progress') showForm(form(offered))
    } catch (error) {
      if (read !== text || shown === 'progress') return
      shown = 'nothing'
      show(refused(error))
    }
  }

  const work = async (made: Form<Request>, request: Request) => {
    if (shown === 'progress') return
    shown = 'progress'
    let text: string
    try {
      text = await host.present()
    } catch (error) {
      return showForm(made, refused(error))
    }
    const view = progressView(name, steps(request), isSeveral(request), {
      cancel: () => running.cancel(),
      preview: (design) => host.preview(design, text),
    })
    show(...view.elements)
    let running: Running<StudyResult>
    itself.onRunning?.(true)
    try {
      running = start(text, request)
      running.onProgress(view.update)
      showResult(made, await running.result, text, view.end())
    } catch (error) {
      view.end()
      host.preview(undefined, text)
      showForm(made, refused(error))
      announced.textContent = `${name} failed.`
    } finally {
      itself.onRunning?.(false)
    }
  }

  const showResult = (made: Form<Request>, result: StudyResult, text: string, starts: HTMLElement[]) => {
    shown = 'result'
    const leave = () => {
      host.preview(undefined, text)
      showForm(made)
      if (!touched) refresh()
    }
    // What the search found stays next to the present design until it is applied or discarded.
    host.preview(result.change ? { name: OPTIMISED, change: result.change } : undefined, text)
    const view = resultView(name, result, { apply: () => (leave(), host.apply(result, text)), leave })
    stale = () => (view.since.hidden = host.text() === text && host.unwritten() === '')
    stale()
    show(...view.elements, ...starts)
    announced.textContent = result.message
  }

  const refresh = () => {
    if (read !== host.text() && (shown === 'nothing' || (shown === 'form' && !touched))) void load()
    else stale()
  }
  /** The text is about to change by the pane itself: it is read again. */
  const release = () => (touched = false)
  const itself: StudyPane & { release: () => void } = { element, refresh, release }
  return itself
}

interface FormActions<Request> {
  /** True if the text is another than the one that the form was made from. */
  isStale: () => boolean
  /** Reason why the present design cannot be studied; empty if there is none. */
  refusal: () => string
  changed: () => void
  reload: () => void
  run: (request: Request) => void
}

/** Form of a study with the button that begins it; `sync` shows whether it can begin and whether its text is stale. */
function formView<Request>(
  name: string,
  verb: string,
  made: Form<Request>,
  refusal: HTMLElement | undefined,
  { isStale, refusal: blocked, changed, reload, run }: FormActions<Request>,
) {
  const testId = name.toLowerCase()
  const why = el('span', { class: 'muted', 'data-testid': `${testId}-why` })
  const begin = el('button', { type: 'submit', class: 'first', 'data-testid': `${testId}-run` }, verb)
  const again = el(
    'button',
    { type: 'button', hidden: true, 'data-testid': `${testId}-again`, onclick: reload },
    'Reload from model',
  )
  const sync = () => {
    const request = blocked() || made.request()
    begin.disabled = typeof request === 'string'
    why.replaceChildren(...prose(typeof request === 'string' ? request : ''))
    again.hidden = !isStale()
  }
  const element = el(
    'form',
    { class: 'study', novalidate: true, oninput: () => (changed(), sync()) },
    ...(refusal ? [refusal] : []),
    ...made.elements,
    el('div', { class: 'acts' }, begin, again, why),
  )
  element.addEventListener('submit', (event) => {
    event.preventDefault()
    const request = made.request()
    if (typeof request !== 'string') run(request)
  })
  return { element, sync }
}

/** Outcome of a study with the buttons that apply it or leave it; `since` warns of later changes. */
function resultView(name: string, result: StudyResult, { apply, leave }: { apply: () => void; leave: () => void }) {
  const testId = name.toLowerCase()
  const hasDesign = result.change !== null || result.text !== null
  const take = el(
    'button',
    { type: 'button', class: 'first', 'data-testid': `${testId}-take`, onclick: apply },
    'Apply design',
  )
  const discard = el(
    'button',
    { type: 'button', 'data-testid': `${testId}-discard`, onclick: leave },
    hasDesign ? 'Discard' : 'Back',
  )
  const since = el(
    'p',
    { class: 'outcome stale', 'data-testid': `${testId}-stale` },
    'The design has changed since the study began. Applying the result discards later changes.',
  )
  // One statement on each line.
  const statements = result.message.split(/(?<=[.;]) /).map((statement) => el('span', {}, ...prose(statement)))
  const outcome = el('p', { class: 'outcome', 'data-testid': `${testId}-outcome` }, ...statements)
  const acts = el('div', { class: 'acts' }, ...(hasDesign ? [take] : []), discard)
  const tables = el('div', { class: 'checks' }, ...result.tables.map(factTable))
  return { elements: [outcome, since, acts, tables], since }
}

/** Progress of a running study: a bar, its last lines, the designs of its starts, and a button that cancels it. */
function progressView(
  name: string,
  steps: number,
  isSeveral: boolean,
  host: { cancel: () => void; preview: (design: StudyDesign) => void },
) {
  const testId = name.toLowerCase()
  const bar = el('progress', {
    'aria-label': `Progress of ${testId}`,
    'data-testid': `${testId}-progress`,
    max: steps,
    value: 0,
  })
  const log = el('pre', { class: 'log', 'data-testid': `${testId}-lines` })
  const clock = el('span', { class: 'muted' }, 'Started.')
  const begun = performance.now()
  const timer = setInterval(() => {
    clock.textContent = `Running for ${Math.round((performance.now() - begun) / 1000)} s. Cancel keeps the best so far.`
  }, 1000)
  const starts = el('div', { class: 'starts', role: 'group', 'aria-label': 'Designs of the starts', hidden: true })
  const cancel = el(
    'button',
    {
      type: 'button',
      'data-testid': `${testId}-cancel`,
      onclick: () => {
        cancel.disabled = true
        cancel.textContent = 'Cancelling…'
        host.cancel()
      },
    },
    'Cancel',
  )
  const show = (change: VariableSetting[], button: HTMLButtonElement) => {
    for (const one of starts.querySelectorAll('button')) one.setAttribute('aria-pressed', String(one === button))
    host.preview({ name: `optimisation, ${button.textContent}`, change })
  }
  const lines: string[] = []
  return {
    elements: [bar, log, starts, el('div', { class: 'acts' }, cancel, clock)],
    update: (done: number, total: number | null, line: string, change: VariableSetting[] | null = null) => {
      if (total !== null) Object.assign(bar, { max: Math.max(total, 1), value: done })
      if (change) host.preview({ name: BEST_SO_FAR, change })
      if (line === '' || line === lines.at(-1)) return
      lines.push(line)
      log.textContent = lines.slice(-LINES).join('\n')
      if (!isSeveral || !change) return
      const button: HTMLButtonElement = el(
        'button',
        {
          type: 'button',
          'aria-pressed': 'false',
          title: line.trim(),
          'data-testid': `${testId}-start`,
          onclick: () => show(change, button),
        },
        line.trim().split(/\s{2,}/)[0],
      )
      starts.append(button)
      starts.hidden = false
    },
    /** Ends the clock; the designs of the starts remain. */
    end: (): HTMLElement[] => {
      clearInterval(timer)
      return starts.hidden ? [] : [el('h3', {}, 'Designs of the starts'), starts]
    },
  }
}

function optimizeForm(
  { variables, goals, limits, starts, iterations }: OptimizeOffer,
  kept: Kept,
  addition: () => GoalForm,
) {
  const searched = variables.map((variable) => variableRow(variable, kept.variables, () => addition().sync()))
  const wanted = goals.map((goal) => goalRow(goal, kept.goals, () => addition().sync()))
  const from = whole('Starts', starts, 1, 100_000, 'optimise-starts')
  const maximum = whole('Maximum iterations', iterations, 1, 100_000, 'optimise-iterations')
  /** Values of the chosen rows that are complete. */
  const complete = <T>(rows: Row<T>[]): T[] =>
    rows.flatMap((row) => {
      const value = row.chosen() ? row.value() : ''
      return typeof value === 'string' ? [] : [value as T]
    })
  const chosen = () => ({ variables: complete(searched), goals: complete(wanted) })
  return {
    chosen,
    /** Sentence on the choice that a limit needs; empty if nothing is missing. */
    missing: () => {
      const { variables, goals } = chosen()
      if (goals.length === 0) return 'A limit needs a goal: add one first.'
      return variables.length === 0 ? 'A limit needs a variable with bounds: choose one above.' : ''
    },
    elements: (added: HTMLElement): HTMLElement[] => [
      group(
        'Variables',
        'within their bounds',
        table(
          ['variable', 'lowest', 'highest', 'unit'],
          searched.map(({ row }) => row),
        ),
      ),
      goals.length > 0
        ? group(
            'Goals',
            'minimised, or brought to their targets',
            table(
              ['metric', 'now', 'weight', 'target'],
              wanted.map(({ row }) => row),
            ),
          )
        : group('Goals', '', el('p', { class: 'muted' }, 'None yet: say below what the design is to do better.')),
      added,
      ...(limits.length > 0
        ? [
            group(
              'Limits',
              'from the model',
              el('ul', { class: 'limits' }, ...limits.map((limit) => el('li', {}, ...prose(limit)))),
            ),
          ]
        : []),
      el('div', { class: 'settings' }, from.element, maximum.element),
    ],
    request: (): OptimizeRequest | string => {
      const [chosen, aims] = [searched.filter(({ chosen }) => chosen()), wanted.filter(({ chosen }) => chosen())]
      if (chosen.length === 0) return 'Choose at least one variable.'
      if (aims.length === 0) return goals.length > 0 ? 'Choose at least one goal.' : 'Add a goal first.'
      const asked = {
        variables: chosen.map(({ value }) => value()),
        goals: aims.map(({ value }) => value()),
        starts: from.value(),
        iterations: maximum.value(),
      }
      return (
        [...asked.variables, ...asked.goals, asked.starts, asked.iterations].find((part) => typeof part === 'string') ??
        (asked as OptimizeRequest)
      )
    },
  }
}

/** A row of a form: its selection and its value, or an error message. */
interface Row<T> {
  row: HTMLElement
  chosen: () => boolean
  value: () => T | string
}

function variableRow(
  { name, unit, bounds, chosen }: SearchVariable,
  kept: Kept['variables'],
  onChange: () => void,
): Row<OptimizeRequest['variables'][number]> {
  const [low, high] = [0, 1].map((end) => field(`${end ? 'highest' : 'lowest'} of ${name}`, bounds?.[end], unit))
  const former = kept.get(name)
  if (former) [low.input.value, high.input.value] = [former.low, former.high]
  const choice = choose(name, former?.chosen ?? (chosen && bounds !== null), [low.input, high.input])
  const oninput = () => {
    kept.set(name, { chosen: choice.chosen(), low: low.input.value, high: high.input.value })
    onChange()
  }
  return {
    row: el(
      'tr',
      { 'data-testid': `search-${name}`, oninput },
      el('td', {}, choice.element),
      el('td', {}, low.input),
      el('td', {}, high.input),
      el('td', { class: 'unit' }, pretty(unit)),
    ),
    chosen: choice.chosen,
    value: () => {
      const ends = [low.value(), high.value()]
      if (ends.includes(undefined)) return `\`${name}\` needs a lower and an upper bound.`
      const wrong = ends.find((end) => typeof end === 'string')
      if (wrong !== undefined) return `\`${name}\`: ${wrong}`
      const [least, most] = ends as [number, number]
      return least < most
        ? { name, bounds: [least, most] }
        : `The lower bound of \`${name}\` is not below its upper bound.`
    },
  }
}

function goalRow(
  { metric, unit, value, weight, target, curve, chosen }: SearchGoal,
  kept: Kept['goals'],
  onChange: () => void,
): Row<OptimizeRequest['goals'][number]> {
  const counts = field(`weight of ${metric}`, weight, '1')
  const wanted = field(`target of ${metric}`, target ?? undefined, unit)
  wanted.input.placeholder = 'minimum'
  const former = kept.get(metric)
  if (former) [counts.input.value, wanted.input.value] = [former.weight, former.target]
  const choice = choose(metric, former?.chosen ?? chosen, curve ? [counts.input] : [counts.input, wanted.input])
  const oninput = () => {
    kept.set(metric, { chosen: choice.chosen(), weight: counts.input.value, target: wanted.input.value })
    onChange()
  }
  const aim = curve
    ? el('span', { class: 'muted' }, 'its curve')
    : el('span', {}, wanted.input, ' ', el('span', { class: 'unit' }, pretty(unit)))
  return {
    row: el(
      'tr',
      { 'data-testid': `goal-${metric}`, oninput },
      el('td', {}, choice.element),
      el('td', { class: 'figure' }, value === null ? '–' : figure(value, unit)),
      el('td', {}, counts.input),
      el('td', {}, aim),
    ),
    chosen: choice.chosen,
    value: () => {
      const [weight, target] = [counts.value(), curve ? undefined : wanted.value()]
      if (!(typeof weight === 'number' && weight > 0)) return `The weight of \`${metric}\` must be above zero.`
      if (typeof target === 'string') return `The target of \`${metric}\`: ${target}`
      return { metric, weight, target: target ?? null }
    },
  }
}

function toleranceForm({ tolerances, metrics, samples, seed }: ToleranceOffer): Form<ToleranceRequest> {
  const drawn = whole('Monte Carlo samples', samples, 0, 10_000_000, 'tolerance-samples')
  const from = whole('Seed', seed, 1, 4_294_967_295, 'tolerance-seed')
  const rows = tolerances.map(({ name, tolerance, unit, distribution }) =>
    el(
      'tr',
      {},
      el('td', {}, name),
      el('td', {}, `±${figure(tolerance, unit)}`),
      el('td', { class: 'muted' }, distribution),
    ),
  )
  return {
    elements: [
      group(
        'Tolerances',
        'from the model',
        rows.length > 0
          ? table(['variable', 'tolerance', 'distribution'], rows)
          : el(
              'p',
              { class: 'muted' },
              ...prose('No design variable has a tolerance. Enter one with the button ± in the row of a variable.'),
            ),
      ),
      ...(metrics.length > 0
        ? [
            el(
              'p',
              { class: 'muted' },
              ...prose(`Evaluated: ${metrics.map((metric) => `\`${metric}\``).join(', ')}, and all curves.`),
            ),
          ]
        : []),
      el('div', { class: 'settings' }, drawn.element, from.element),
    ],
    request: () => {
      if (tolerances.length === 0)
        return 'No variable has a tolerance. Enter one with the button ± in the row of a variable.'
      const asked = { samples: drawn.value(), seed: from.value() }
      return Object.values(asked).find((part) => typeof part === 'string') ?? (asked as ToleranceRequest)
    },
  }
}

function group(title: string, about: string, content: HTMLElement): HTMLElement {
  return el('fieldset', {}, el('legend', {}, title, ' ', el('span', { class: 'muted' }, about)), content)
}

function table(header: string[], rows: HTMLElement[]): HTMLElement {
  return el(
    'div',
    { class: 'scroll' },
    el(
      'table',
      {},
      el('thead', {}, el('tr', {}, ...header.map((cell) => el('th', { scope: 'col' }, cell)))),
      el('tbody', {}, ...rows),
    ),
  )
}

/** A field for a number with a unit; its value is a sentence if it cannot be read, and undefined if it is empty. */
function field(label: string, value: number | undefined, unit: string) {
  const text = value === undefined ? undefined : entry(value)
  const input = el('input', { type: 'text', class: 'number-field', 'aria-label': label, value: text })
  return {
    input,
    value: (): number | string | undefined => {
      if (input.value.trim() === '') return undefined
      const typed = amount(input.value, unit)
      return typeof typed === 'string' ? typed : typed.value
    },
  }
}

/** A box to choose something by, whose fields are of use only then. */
function choose(
  name: string,
  chosen: boolean,
  fields: HTMLInputElement[],
): { element: HTMLElement; chosen: () => boolean } {
  const box = el('input', { type: 'checkbox', checked: chosen, onchange: () => sync() })
  const sync = () => {
    for (const one of fields) one.disabled = !box.checked
  }
  sync()
  return { element: el('label', {}, box, name), chosen: () => box.checked }
}

/** A field for a whole number. */
function whole(
  title: string,
  value: number,
  minimum: number,
  maximum: number,
  testId: string,
): { element: HTMLElement; value: () => number | string } {
  const input = el('input', {
    type: 'number',
    min: minimum,
    max: maximum,
    step: 1,
    value,
    required: true,
    'data-testid': testId,
  })
  return {
    element: el('label', {}, title, ' ', input),
    value: () =>
      input.checkValidity() ? input.valueAsNumber : `${title}: a whole number from ${minimum} to ${maximum}.`,
  }
}
