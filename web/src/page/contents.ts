import { atFixedAbscissa, peak, quiet, slope, slopeAlone, withGaps, type Curve } from '../curve'
import { css, hue } from '../dom'
import { effects } from '../effect'
import { extent } from '../export/axis'
import { figure, number } from '../format'
import type { Content, Line } from '../plot'
import { derivativeName, derivativeUnit, orderedName, type Driver, type Order, type Report } from '../report'
import type { State } from '../state'

/** Subject of a figure. */
export interface Subject {
  quantity: number
  order: Order
  /** Quantity on the abscissa; time by default. */
  over?: number
}

/** Number of sensitivities that are drawn with that of the selected variable. */
const FEW = 5
const DASHED = [7, 5]
const DOTTED = [2, 4]

/** Lines of the present design, of the one that it is compared with, of predictions, and of targets. */
export function valueContent(state: State, { quantity: index, order, over }: Subject): Content {
  const { report, former, present } = state
  const quantity = report.quantities[index]
  const title = orderedName(quantity, order)
  const content: Content = { title, unit: quantity.units[order], lines: [] }
  const scale = largest(state, index, order)
  const own = quantity.curves[order]
  if (own.length === 0) return { ...content, message: unknown(title) }
  const label = state.isPredicted
    ? 'predicted to first order'
    : (present?.name ?? (state.isCompared ? 'current design' : title))
  content.lines.push({ label, color: css('--trace'), curve: quiet(state.curve(index, order), scale), width: 2.4 })
  if (state.isCompared) {
    const curve = former ? (former.quantities[index]?.[order] ?? new Float32Array()) : own
    content.lines.push({
      label: former?.name ?? 'original',
      color: css('--former'),
      curve: quiet(curve, scale),
      width: 1.8,
      dash: DASHED,
    })
  }
  const bands = report.designs.filter(({ kind, quantities }) => kind === 'band' && quantities[index]?.[order].length)
  // Over another quantity, which has a tolerance itself, bands would have another meaning.
  if (over !== undefined && bands.length > 0)
    content.caption = 'The tolerance band is known over time only: choose time to show it.'
  for (const band of over === undefined ? bands : []) {
    const curve = quiet(band.quantities[index]![order], scale)
    content.lines.push({ label: band.name, color: css('--former'), curve, width: 1.3, dash: DOTTED })
  }
  const predictions = present
    ? report.designs.filter(({ kind }) => kind.endsWith('_order')).filter((design) => design !== former)
    : []
  predictions.forEach((design, k) => {
    const curve = design.quantities[index]?.[order]
    if (curve?.length)
      content.lines.push({
        label: design.name,
        color: hue(k + 1),
        curve: quiet(curve, scale),
        width: 1.8,
        dash: DOTTED,
      })
  })
  if (order === 0)
    content.lines.push({ label: 'target', color: css('--good'), curve: quantity.wanted, width: 2.4, dash: DOTTED })
  content.lines = content.lines.filter(({ curve }) => curve.length > 0)
  if (order === 0 && over === undefined) {
    content.wanted = report.values
      .filter(({ quantity, target, time }) => quantity === index && target && time !== null)
      .map(({ target, time }) => ({ low: target![0], high: target![1], at: time! }))
  }
  return overOther(state, over, content)
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
  const all = effects(report, subject.quantity, order)
  const own = all.find(({ variable }) => variable === selected)
  const title = own ? derivativeName(quantity, order, selected) : `d ${name}`
  const content: Content = { title, unit: derivativeUnit(quantity, order, selected), lines: [] }
  if (quantity.curves[order].length === 0) return { ...content, unit: '', message: unknown(name) }
  if (!own)
    return {
      ...content,
      unit: '',
      message: selected.note || `The sensitivity of ${name} to ${selected.name} is not known.`,
    }
  const at = atAbscissa(state, subject)
  if (typeof at === 'string') return { ...content, message: at }
  const { seen } = at
  const peers = all.filter(({ variable }) => variable.unit === selected.unit)
  const scale = Math.max(...peers.map(({ sensitivity }) => sensitivity.peaks[order]))
  const shown = peers.filter(({ variable, share }, rank) => variable === selected || (rank < FEW && share > 0))
  let k = 0
  content.lines = shown.map(({ variable, sensitivity }): Line => {
    const chosen = variable === selected
    return {
      label: variable.name,
      color: chosen ? css('--chosen') : hue(k++),
      curve: quiet(seen(sensitivity.curves[order], variable.index, false), scale),
      width: chosen ? 2.6 : 1.3,
      pick: () => state.choose({ variable: variable.index }),
    }
  })
  // Drawn last, the selected one lies above the others.
  const first = content.lines.findIndex(({ width }) => width === 2.6)
  content.lines.push(...content.lines.splice(first, 1))
  const { differences } = own.sensitivity
  const left = peers.length - shown.length
  const rest = [at.note, left > 0 ? `strongest ${shown.length} of ${peers.length}.` : '']
    .filter((words) => words !== '')
    .join(' ')
  if (!differences) return overOther(state, subject.over, { ...content, caption: rest })
  const curve = seen(differences.curves[order], selected.index, true)
  content.lines.push({ label: 'finite differences', color: css('--ink'), curve, marks: withGaps(curve) })
  const caption =
    `${rest} Rings: checked by re-solving at ±${figure(Number(differences.step.toPrecision(2)), differences.unit)}, ` +
    `maximum difference ${number(differences.worst[order], 2)}.`
  return overOther(state, subject.over, { ...content, caption: caption.trimStart() })
}

/** Maximum among quantities of the same unit, the scale for rounding. */
function largest({ report }: State, index: number, order: Order): number {
  const unit = report.quantities[index].units[order]
  return Math.max(
    ...report.quantities.filter(({ units }) => units[order] === unit).map(({ curves }) => peak(curves[order])),
  )
}

function unknown(title: string): string {
  return `No ${title}: motions are solved up to accelerations, measures of a single driver up to their values.`
}

function overOther({ report }: State, over: number | undefined, content: Content): Content {
  if (over === undefined || content.message) return content
  const { name, units, curves } = report.quantities[over]
  return { ...content, over: { label: name, unit: units[0], curve: curves[0] } }
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
function atAbscissa({ sensitivityReport: report }: State, { quantity, order, over }: Subject): AtAbscissa | string {
  if (over === undefined) return { seen: (curve) => curve, note: '' }
  const [y, x] = [report.quantities[quantity], report.quantities[over]]
  if (order > 0) return 'Over another quantity, only sensitivities of values are available: choose the value, or time.'
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

/** Among several moving drivers, the one that moves the quantity most. */
function moverOf({ drivers }: Report, quantity: number): Driver | undefined {
  const reach = ({ alone, travel }: Driver) => {
    const [minimum, maximum] = extent([travel]) ?? [0, 0]
    return alone[quantity]?.length ? peak(alone[quantity]) * (maximum - minimum) : 0
  }
  const [first] = [...drivers].sort((a, b) => reach(b) - reach(a))
  return first && reach(first) > 0 ? first : undefined
}
