import { clearanceOf, contacts } from '../clearance'
import {
  atFixedAbscissa,
  changeFrom,
  peak,
  quiet,
  slope,
  slopeAlone,
  stepAt,
  valueAt,
  withGaps,
  type Curve,
} from '../curve'
import { css, hue } from '../dom'
import { effects } from '../effect'
import { figure, number } from '../format'
import type { Content, Line } from '../content'
import { aboutQuantity } from '../glossary'
import {
  curveOf,
  derivativeName,
  derivativeUnit,
  type Design,
  type Driver,
  isGiven,
  type Order,
  orderedName,
  type Quantity,
  type Report,
  type Variable,
} from '../report'
import { noise } from '../rounding'
import { hasOneFreedom, onSideOf, rangeOf } from '../sheet'
import type { State } from '../state'
import type { Measured } from './measured'

/** Subject of a figure. */
export interface Subject {
  quantity: number
  order: Order
  /** Quantity on the abscissa; time by default. */
  over?: number
  /** Further quantities of the same unit. */
  also?: readonly number[]
  /** True for changes to the reference design instead of values. */
  difference?: boolean
  /** True for a path, with equal scales. */
  path?: boolean
  /** Curves that were read from files. */
  measured?: readonly Measured[]
}

/** Name that the engine gives a design without one. */
const CHANGED = 'changed'
/** Message in place of sensitivities of a model without variables. */
const NO_VARIABLES = 'The model has no design variables: `[design]` of its text adds them.'
/** Number of sensitivities that are drawn with that of the selected variable. */
const FEW = 5
/** Names of quantities that fit into a title. */
const NAMED = 3
/** Standard deviations between the middle of a tolerance band and its edges. */
const SIGMAS = 3
const DASHED = [7, 5]
const DOTTED = [2, 4]
const DASH_DOTTED = [9, 4, 2, 4]
/** Patterns by which lines differ without their colours; the first is solid. */
const PATTERNS = [undefined, [10, 4], [3, 3], [10, 3, 2, 3], [6, 2], [2, 2, 6, 2], [14, 4], [4, 6]]

/** A design with the role of its lines. */
interface Drawn {
  /** Empty for the only design, whose lines are named after their quantities. */
  name: string
  curve: (quantity: number, order: Order) => Curve
  dash?: number[]
  width: number
  color?: string
}

/** Lines of the present design, of those that it is compared with, of predictions, targets, and measured data. */
export function valueContent(state: State, subject: Subject): Content {
  const { quantity: index, order, over, also = [], difference = false, measured = [] } = subject
  const { report, present } = state
  const quantity = report.quantities[index]
  const name = orderedName(quantity, order)
  const quantities = [index, ...also.filter((k) => k !== index)].map((k) => report.quantities[k])
  const sign = difference ? 'Δ ' : ''
  const content: Content = {
    title: sign + listed(quantities.map((one) => orderedName(one, order))),
    unit: quantity.units[order],
    lines: [],
    equal: subject.path,
  }
  if (quantity.curves[order].length === 0) return { ...content, message: unknown(name) }
  const several = quantities.length > 1
  const [compared, ...others] = comparedDesigns(state)
  const rigid = rigidDesign(state)
  // Where nothing else is compared, a change is that to the rigid mechanism.
  const reference = compared ?? (difference ? rigid : undefined)
  const drawn = [presentDesign(state), ...(difference ? [] : [reference, rigid]), ...others].filter(
    (design) => design !== undefined,
  )
  const base = reference ?? drawn[0]
  const scale = largest(state, index, order)
  for (const [k, one] of quantities.entries()) {
    const side = over === undefined ? undefined : report.quantities[onSideOf(report, over, one.index)]
    const abscissa = (design: Drawn) => {
      if (!side) return undefined
      const own = design.curve(side.index, 0)
      return own.length === 0 && isGiven(side) ? side.curves[0] : own
    }
    const course = (design: Drawn) => () => {
      const of = (index: number, from: Order) => ([0, 1, 2] as const).slice(from).map((k) => design.curve(index, k))
      const x = abscissa(design)
      return { y: of(one.index, order), x: x && side && [x, ...of(side.index, 1)] }
    }
    for (const design of drawn) {
      const all = quiet(design.curve(one.index, order), scale)
      const x = abscissa(design)
      const curve = difference
        ? changeFrom([all, x], [quiet(base.curve(one.index, order), scale), abscissa(base)])
        : all
      const plain = design === drawn[0]
      const own = several ? orderedName(one, order) : ''
      const alone = design.name || orderedName(one, order)
      const label = !several ? alone : plain ? own : `${own}, ${design.name}`
      const column = sign + orderedName(one, order)
      const heading = design.name ? `${column}: ${design.name}` : column
      const color = several ? hue(k) : (design.color ?? css('--former'))
      const dash = several && plain ? PATTERNS[k % PATTERNS.length] : design.dash
      content.lines.push({
        ...{ label, heading, color, curve, dash, over: x, width: design.width, about: aboutQuantity(one) },
        course: difference ? undefined : course(design),
      })
    }
  }
  if (difference) content.caption = differenceCaption(reference)
  else addPredictions(state, subject, content, scale)
  if (!difference) addBands(state, subject, content, scale)
  if (order === 0 && !difference) {
    addTargets(state, quantity, content, present, over)
    addContacts(state, quantity, content, over)
  }
  if (difference) {
    if (measured.length > 0) content.caption += ' Measured data are values, and not shown among changes.'
  } else
    for (const [k, { label, x, y }] of measured.entries())
      content.lines.push({ label, color: hue(k + 5), curve: y, over: x, free: true, marks: withGaps(y) })
  content.lines = content.lines.filter(({ curve }) => curve.length > 0)
  // Predictions, bands and targets are of the first quantity.
  for (const line of content.lines) line.heading ??= `${sign}${name}: ${line.label}`
  return overOther(state, over, content)
}

/** Names of a title; of many, the first and the number of the others. */
function listed(names: string[]): string {
  return names.length <= NAMED ? names.join(', ') : `${names[0]} and ${names.length - 1} others`
}

function presentDesign(state: State): Drawn {
  const { present, isPredicted, isCompared } = state
  const own = present && present.name !== CHANGED ? present.name : 'current'
  const name = isPredicted ? 'predicted to first order' : present || isCompared ? own : ''
  return { name, curve: (quantity, order) => state.curve(quantity, order), width: 2.4, color: css('--trace') }
}

/** The reference design, if the present one differs from it, then the other designs in the plots. */
function comparedDesigns(state: State): (Drawn | undefined)[] {
  const { former, report, designs } = state
  const of = (design: Design) => (quantity: number, order: Order) => curveOf(design, quantity, order)
  const original = (quantity: number, order: Order) => report.quantities[quantity].curves[order]
  const reference: Drawn | undefined = state.isCompared
    ? { name: former?.name ?? 'original', curve: former ? of(former) : original, dash: DASHED, width: 1.8 }
    : undefined
  return [
    reference,
    ...state.overlays.map((index, k): Drawn => {
      const design = designs[index]
      return { name: design.name, curve: of(design), dash: DASH_DOTTED, width: 1.6, color: hue(k + 1) }
    }),
  ]
}

/** The mechanism with rigid joints, a thin line. */
function rigidDesign({ rigid }: State): Drawn | undefined {
  if (!rigid) return undefined
  return { name: rigid.name, curve: (quantity, order) => curveOf(rigid, quantity, order), width: 1.1 }
}

function differenceCaption(reference: Drawn | undefined): string {
  if (!reference) return 'Nothing is changed yet.'
  return `Change to: ${reference.name}.`
}

/** Designs of the report that were predicted, next to the solved one. */
function addPredictions(state: State, { quantity, order, over }: Subject, content: Content, scale: number): void {
  const { present, former, report } = state
  if (!present) return
  const predictions = report.designs.filter(({ kind }) => kind.endsWith('_order')).filter((design) => design !== former)
  predictions.forEach((design, k) => {
    const curve = design.quantities[quantity]?.[order]
    if (!curve?.length) return
    const x = over === undefined ? undefined : design.quantities[over]?.[0]
    content.lines.push({
      label: design.name,
      color: hue(k + 1),
      curve: quiet(curve, scale),
      over: x?.length ? x : undefined,
      width: 1.8,
      dash: DOTTED,
    })
  })
}

/**
 * Edges of the tolerance band of a quantity, where the study has one: over time of the study itself, by standard
 * deviations (dotted) and of the worst case (dash-dotted), with the curve of pins with play under load (solid). Over
 * another quantity, which scatters as well, the band is that of the values at a fixed abscissa, to first order.
 */
function addBands(state: State, subject: Subject, content: Content, scale: number): void {
  const { report } = state
  const { quantity, order, over } = subject
  const bands = report.designs.filter(({ kind, quantities }) => kind === 'band' && quantities[quantity]?.[order].length)
  if (bands.length === 0) return
  const edges =
    over === undefined ? bands.map(({ quantities }) => quantities[quantity]![order]) : edgesOver(report, subject)
  if (typeof edges === 'string') {
    content.caption = `No tolerance band: ${edges}`
    return
  }
  const x = over === undefined ? undefined : report.quantities[over].curves[0]
  edges.forEach((edge, k) =>
    content.lines.push({
      label: bands[k].name,
      color: css('--former'),
      curve: quiet(edge, scale),
      over: x,
      width: 1.3,
      dash: k < 2 ? DOTTED : k < 4 ? DASH_DOTTED : undefined,
    }),
  )
  if (over !== undefined)
    content.caption = `Tolerance band at constant ${report.quantities[over].name}, to first order.`
}

/** Nominal value less and plus three standard deviations, at a fixed abscissa; a message where these are not known. */
function edgesOver(report: Report, subject: Subject): Curve[] | string {
  const at = atAbscissa({ sensitivityReport: report }, subject)
  if (typeof at === 'string') return at
  const nominal = report.quantities[subject.quantity].curves[0]
  const sums = new Float64Array(nominal.length)
  const [first] = report.covariance_root ?? []
  for (let column = 0; column < (first?.length ?? 0); column++) {
    const share = new Float64Array(nominal.length)
    for (const [variable, row] of report.covariance_root!.entries()) {
      if (row[column] === 0) continue
      const sensitivity = report.variables[variable].sensitivities.get(subject.quantity)
      if (!sensitivity) return `the effect of ${report.variables[variable].name} is not known over this abscissa.`
      at.seen(sensitivity.curves[0], variable, false).forEach((d, k) => (share[k] += row[column] * d))
    }
    share.forEach((d, k) => (sums[k] += d * d))
  }
  return [-SIGMAS, SIGMAS].map((by) => nominal.map((value, k) => value + by * Math.sqrt(sums[k])))
}

/** Target curve and limits of the metrics of a quantity. */
function addTargets(
  { report }: State,
  { index, wanted }: Quantity,
  content: Content,
  present: Design | undefined,
  over?: number,
): void {
  content.lines.push({ label: 'target', color: css('--good'), curve: wanted, width: 2.4, dash: DOTTED })
  const limited = report.values.filter(({ quantity, gate }) => quantity === index && gate)
  if (limited.length > 0)
    content.caption ??= `Shaded: range that the limits of ${limited.map(({ name }) => name).join(', ')} allow.`
  const at = (time: number) => {
    if (over === undefined) return time
    const x = present?.quantities[over]?.[0] ?? report.quantities[over].curves[0]
    return valueAt(x, stepAt(report.times, time))
  }
  content.wanted = limited.map(({ gate }) => ({ ...gate!, at: gate!.at === null ? undefined : at(gate!.at) }))
}

/** Distance that a clearance requires, and the intervals of time in which its shapes touch. */
function addContacts(state: State, { index }: Quantity, content: Content, over?: number): void {
  const { report } = state
  const clearance = clearanceOf(report, index)
  if (clearance === undefined) return
  const notes = [content.caption]
  const { name, min } = report.clearance!.clearances[clearance]
  // A limit of the model shows the range already.
  if (min !== null && !content.wanted?.length) {
    content.wanted = [{ low: min, high: null }]
    notes.push(`Shaded: at least the ${figure(min, report.units.length)} that \`${name}\` requires.`)
  }
  if (over === undefined) {
    content.contacts = contacts(state, clearance)
    if (content.contacts.length > 0) notes.push('Red: shapes touch.')
  }
  content.caption = notes.filter(Boolean).join(' ') || undefined
}

/**
 * The sensitivities of the quantity: the largest of the selected variable's unit, its own, and finite differences of
 * it.
 */
export function sensitivityContent(state: State, subject: Subject): Content {
  const { sensitivityReport: report, choice } = state
  const { order } = subject
  const quantity = report.quantities[subject.quantity]
  const selected = report.variables[choice.variable]
  const name = orderedName(quantity, order)
  // Of a text that has lost its variables, the figures of the former page stay.
  if (!selected) return { title: `Sensitivities of ${name}`, unit: '', lines: [], message: NO_VARIABLES }
  const all = effects(report, subject.quantity, order)
  const own = all.find(({ variable }) => variable === selected)
  const of = state.outdated ? ` (${state.outdated.toLowerCase()})` : ''
  const peers = all.filter(({ variable }) => variable.unit === selected.unit)
  const shown = peers.filter(({ variable, share }, rank) => variable === selected || (rank < FEW && share > 0))
  const heading = (variable: Variable) => derivativeName(quantity, order, variable) + of
  // Of several variables, the legend names each.
  const title =
    own && shown.length === 1 ? `Sensitivity of ${name} to ${selected.name}${of}` : `Sensitivities of ${name}${of}`
  const content: Content = { title, unit: derivativeUnit(quantity, order, selected), lines: [] }
  if (quantity.curves[order].length === 0) return { ...content, unit: '', message: unknown(name) }
  if (!own) {
    // The note of a variable says why the mechanism cannot follow it; curves of loads have no sensitivities at all.
    const note = ['deflection', 'force'].includes(quantity.group) ? '' : selected.note
    const message = note || `The sensitivity of ${name} to ${selected.name} is not known.`
    return { ...content, unit: '', message }
  }
  const at = atAbscissa(state, subject)
  if (typeof at === 'string') return { ...content, message: at }
  const { seen } = at
  const scale = Math.max(...peers.map(({ sensitivity }) => sensitivity.peaks[order]))
  let k = 0
  content.lines = shown.map(({ variable, sensitivity }): Line => {
    const chosen = variable === selected
    const rank = chosen ? 0 : ++k
    return {
      label: variable.name,
      heading: heading(variable),
      color: chosen ? css('--chosen') : hue(rank - 1),
      dash: PATTERNS[rank % PATTERNS.length],
      curve: quiet(seen(sensitivity.curves[order], variable.index, false), scale),
      width: chosen ? 2.6 : 1.5,
      pick: () => state.choose({ variable: variable.index }),
    }
  })
  // Drawn last, the selected one lies above the others.
  const first = content.lines.findIndex(({ width }) => width === 2.6)
  content.lines.push(...content.lines.splice(first, 1))
  const { differences } = own.sensitivity
  const left = peers.length - shown.length
  const rest = [at.note, left > 0 ? `Most influential: ${shown.length} of ${peers.length}.` : '']
    .filter((words) => words !== '')
    .join(' ')
  if (!differences) return overOther(state, subject.over, { ...content, caption: rest })
  const curve = seen(differences.curves[order], selected.index, true)
  const label = 'finite differences'
  content.lines.push({
    ...{ label, heading: `${heading(selected)}: ${label}`, color: css('--ink') },
    ...{ curve, marks: withGaps(curve) },
  })
  const caption =
    `${rest} ○ checked by re-solving at ±${figure(Number(differences.step.toPrecision(2)), differences.unit)} ` +
    `(max. difference ${number(differences.worst[order], 2)}).`
  return overOther(state, subject.over, { ...content, caption: caption.trimStart() })
}

/** Largest magnitudes among quantities of the same unit, by report, unit and order. */
const scales = new WeakMap<Report, Map<string, number>>()

/** Maximum among quantities of the same unit, the scale for rounding. */
function largest({ report }: State, index: number, order: Order): number {
  const known = scales.get(report) ?? new Map<string, number>()
  scales.set(report, known)
  const unit = report.quantities[index].units[order]
  const key = `${order} ${unit}`
  const found = known.get(key)
  if (found !== undefined) return found
  const same = report.quantities.filter(({ units }) => units[order] === unit)
  const maximum = Math.max(...same.map(({ curves }) => peak(curves[order])))
  known.set(key, maximum)
  return maximum
}

function unknown(title: string): string {
  return `No ${title}: motions are solved up to accelerations, measures of a single driver up to their values.`
}

function overOther(state: State, over: number | undefined, content: Content): Content {
  if (over === undefined || content.message) return content
  const { name, units } = state.report.quantities[over]
  const once = !content.equal && hasOneFreedom(state.report)
  return { ...content, over: { label: name, unit: units[0], curve: state.curve(over, 0) }, once }
}

/** Sensitivities as they are shown, and a sentence on that. */
interface AtAbscissa {
  seen: (curve: Curve, variable: number, differences: boolean) => Curve
  note: string
}

/**
 * Conversion of the quantity's sensitivities to a fixed abscissa, if there is one; a message where it is not possible.
 * Where several drivers move, the one that moves the abscissa most holds it, and the others are fixed.
 */
function atAbscissa(
  { sensitivityReport: report }: Pick<State, 'sensitivityReport'>,
  { quantity, order, over }: Subject,
): AtAbscissa | string {
  if (over === undefined) return { seen: (curve) => curve, note: '' }
  const [y, x] = [report.quantities[quantity], report.quantities[over]]
  if (order > 0) return 'Over another quantity, only sensitivities of values are available: choose the value, or time.'
  if (isGiven(x)) return { seen: (curve) => curve, note: `At a constant law of ${x.name}.` }
  if (isPrescribed(report, x)) return { seen: (curve) => curve, note: '' }
  const keeper = moverOf(report, x.index)
  const alone = keeper?.alone[y.index]?.length ? slopeAlone(keeper.alone[y.index], keeper.alone[x.index]) : undefined
  if (!alone && [y, x].some(({ curves }) => curves[1].length === 0 || curves[2].length === 0)) {
    return `The slope of ${y.name} over ${x.name} is not known, because one of them has no rate: choose time.`
  }
  const along = alone ?? slope(y.curves, x.curves)
  const seen = (curve: Curve, variable: number, differences: boolean) => {
    const of = report.variables[variable].sensitivities.get(x.index)
    const dx = differences ? of?.differences?.curves[0] : of?.curves[0]
    return dx ? atFixedAbscissa(curve, dx, along) : curve
  }
  return {
    seen,
    note: alone && keeper ? `At constant ${x.name}, held by ${keeper.name}; other drivers are fixed.` : '',
  }
}

/** True if no variable changes the quantity, as of a coordinate that a driver prescribes. */
function isPrescribed({ variables }: Report, { index, curves }: Quantity): boolean {
  const largest = noise(peak(curves[0]))
  return variables.every(({ sensitivities }) => (sensitivities.get(index)?.peaks[0] ?? 0) <= largest)
}

/** Among several moving drivers, the one that moves the quantity most. */
export function moverOf({ drivers }: Report, quantity: number): Driver | undefined {
  const reach = ({ alone, travel }: Driver) => (alone[quantity]?.length ? peak(alone[quantity]) * rangeOf(travel) : 0)
  const [first] = [...drivers].sort((a, b) => reach(b) - reach(a))
  return first && reach(first) > 0 ? first : undefined
}
