import { type Curve, firstIndex } from './curve'
import { extent } from './export/axis'
import { kindOf } from './glossary'
import { groups, isGiven, type Quantity, type Report } from './report'
import { noise } from './rounding'

/** A plot that the page opens with: indices of quantities of one unit. */
export interface SheetPlot {
  y: number[]
  /** Quantity on the abscissa; time by default. */
  over?: number
  /** True for the path of a point, with equal scales. */
  path?: boolean
}

/** Plots that the page opens with, the leading one first. */
export interface Sheet {
  plots: SheetPlot[]
  /** Wheel travel, or the driver's own measure, if the motion has one degree of freedom. */
  travel?: number
}

/** Measures of wheels and axles in the order of the sheet; each is a plot. */
const WHEEL_PLOTS: readonly (readonly string[])[] = [
  ['toe'],
  ['camber'],
  ['caster'],
  ['motion_ratio'],
  ['roll_centre', 'roll_centre_height'],
  ['track', 'half_track'],
  ['half_track_change'],
  ['steer', 'steer_angle'],
]
const TRAVEL = ['wheel_travel', 'travel']
/** Measures that judge a linkage whatever else is measured: by their kind, or by their name. */
const TRANSMISSION = /transmission|pressure_angle/
/** Plots of a linkage's measures besides its path. */
const LINKAGE_PLOTS = 3
/** Part of a range below which a quantity counts as constant, and two curves as proportional. */
const STILL = 1e-4
/** A path is drawn if it is so wide, as a part of its length. */
const WIDE = 0.02

/**
 * Plots of a report: the requested one, if the run named it; those of the model file, if it has any; toe, camber and so
 * on over wheel travel for wheels and axles; else the measure that judges the linkage, the path of its point, and
 * further measures that the driver does not prescribe. Motions of several independent drivers are drawn over time,
 * because curves over another quantity would be loops.
 */
export function sheetOf(report: Report): Sheet {
  const measures = groups(report).find(([name]) => name === 'measure')?.[1] ?? []
  const travel = travelOf(report, measures)
  const requested = report.first !== null && report.over !== null ? [{ y: [report.first], over: report.over }] : []
  const kept = filePlots(report)
  if (kept.length > 0) return { plots: [...requested, ...kept], travel }
  const wheels = wheelPlots(report, measures, travel)
  const plots = [...requested, ...(wheels.length > 0 ? wheels : linkagePlots(report, measures, travel))]
  const first = report.first ?? groups(report)[0]?.[1][0]?.index
  if (plots.length === 0 && first !== undefined) plots.push({ y: [first] })
  return { plots: leading(report, plots), travel }
}

/** Plots of the model file without those over a quantity that does not move here. */
function filePlots(report: Report): SheetPlot[] {
  return report.plots.flatMap(({ y, over }): SheetPlot[] => {
    if (over === null) return [{ y }]
    if (!moves(report.quantities[over].curves[0])) return []
    const place = (index: number) => /^(.*)\.[xyz]$/.exec(report.quantities[index].name)?.[1]
    const isPath = y.length === 1 && place(over) !== undefined && place(y[0]) === place(over)
    return [isPath ? { y, over, path: true } : { y, over }]
  })
}

/** The abscissa of another page: the quantity of that name, or the sheet's own if that does not move here. */
export function abscissaNamed(report: Report, name: string | undefined): number | undefined {
  if (name === undefined) return undefined
  const found = report.quantities.find((one) => one.name === name)
  return found && moves(found.curves[0]) ? found.index : sheetOf(report).travel
}

/** `front.left` of `front.left.toe`; `left` of `left_toe`; empty if the measure belongs to no side. */
export function sideOf(name: string): string {
  const dot = name.lastIndexOf('.')
  return dot >= 0 ? name.slice(0, dot) : (/^((front_|rear_)?(left|right))_/.exec(name)?.[1] ?? '')
}

/** True for the travel of a wheel. */
export function isTravel(quantity: Quantity): boolean {
  return TRAVEL.includes(kindOf(quantity))
}

/** The quantity of the same kind on another quantity's side: `right.wheel_travel` for `right.toe`. */
export function onSideOf(report: Report, over: number, quantity: number): number {
  const kind = kindOf(report.quantities[over])
  const side = sideOf(report.quantities[quantity].name)
  return report.quantities.find((one) => kindOf(one) === kind && sideOf(one.name) === side)?.index ?? over
}

const freedoms = new WeakMap<Report, boolean>()

/** True if all moving drivers are functions of one another: the motion runs along one line, back and forth. */
export function hasOneFreedom(report: Report): boolean {
  const known = freedoms.get(report)
  if (known !== undefined) return known
  const moving = report.drivers.map(({ travel }) => travel).filter((travel) => rangeOf(travel) > 0)
  const found = moving.every((travel) => proportional(travel, moving[0]))
  freedoms.set(report, found)
  return found
}

/**
 * The abscissa of a motion with one degree of freedom: moving wheel travel, else the driver's own measure. Where forces
 * alone move, it is the first of them if they grow in proportion.
 */
function travelOf(report: Report, measures: Quantity[]): number | undefined {
  if (!hasOneFreedom(report)) return undefined
  if (report.drivers.every(({ travel }) => rangeOf(travel) === 0)) {
    const forces = report.quantities.filter((one) => isGiven(one) && moves(one.curves[0]))
    const together = forces.every(({ curves }) => proportional(curves[0], forces[0].curves[0]))
    return together ? forces[0]?.index : undefined
  }
  const wheel = measures.find((one) => isTravel(one) && moves(one.curves[0]))
  return (wheel ?? measures.find((quantity) => isDriven(report, quantity)))?.index
}

function wheelPlots(report: Report, measures: Quantity[], over?: number): SheetPlot[] {
  if (report.wheels.length === 0 && !measures.some((one) => ['toe', 'camber'].includes(kindOf(one)))) return []
  const known = measures.filter(({ curves }) => curves[0].some(Number.isFinite))
  const members = WHEEL_PLOTS.map((kinds) => known.filter((one) => one.index !== over && kinds.includes(kindOf(one))))
  const plots = members.flatMap((found) => {
    const same = found.filter(({ units }) => units[0] === found[0].units[0])
    return same.length > 0 ? [{ y: same.map(({ index }) => index), over }] : []
  })
  // What is held, as toe is by a driver that steers the wheel, is no opening.
  const isHeld = ({ y }: SheetPlot) => !moves(report.quantities[y[0]].curves[0])
  return [...plots.filter((plot) => !isHeld(plot)), ...plots.filter(isHeld)]
}

function linkagePlots(report: Report, measures: Quantity[], over?: number): SheetPlot[] {
  const metric = report.values.find(({ quantity, time, target }) => quantity !== null && (time === null || target))
  const weight = ({ kind, name, index, wanted }: Quantity) =>
    [
      wanted.length > 0,
      TRANSMISSION.test(kind) || TRANSMISSION.test(name),
      index === metric?.quantity,
      index === report.first,
    ].indexOf(true)
  const rank = (quantity: Quantity) => (weight(quantity) < 0 ? Infinity : weight(quantity))
  const free = measures.filter((quantity) => moves(quantity.curves[0]) && !isDriven(report, quantity))
  const ranked = free.sort((a, b) => rank(a) - rank(b) || a.index - b.index).slice(0, LINKAGE_PLOTS)
  const plots = ranked.map(({ index }): SheetPlot => ({ y: [index], over }))
  const path = pathOf(report)
  return path ? [...plots.slice(0, 1), path, ...plots.slice(1)] : plots
}

/**
 * A metric with a target curve leads. Without rates its sensitivities are known over time and over a given force only,
 * and so it is drawn.
 */
function leading(report: Report, plots: SheetPlot[]): SheetPlot[] {
  if (report.over !== null || plots.length === 0) return plots
  const wanted = plots.findIndex(({ y }) => report.quantities[y[0]].wanted.length > 0)
  const first = plots[Math.max(wanted, 0)]
  const isOverForce = first.over !== undefined && isGiven(report.quantities[first.over])
  const isKnown = isOverForce || report.quantities[first.y[0]].curves[2].length > 0
  return [isKnown ? first : { ...first, over: undefined }, ...plots.filter((plot) => plot !== first)]
}

/** The path of the first point that moves in a plane of the axes. */
function pathOf(report: Report): SheetPlot | undefined {
  const points = groups(report).find(([name]) => name === 'point')?.[1] ?? []
  for (const { name, index } of points.filter(({ name }) => name.endsWith('.x'))) {
    const place = name.slice(0, -2)
    const axes = ['x', 'y', 'z'].map((axis) => points.find((other) => other.name === `${place}.${axis}`))
    const [x, y, z] = axes.map((axis) => (axis ? rangeOf(axis.curves[0]) : 0))
    const [across, up, rest] = y >= z ? [x, y, z] : [x, z, y]
    const other = axes[y >= z ? 1 : 2]
    if (other && rest <= STILL * across && Math.min(across, up) > WIDE * Math.max(across, up))
      return { y: [other.index], over: index, path: true }
  }
  return undefined
}

/** True if a driver prescribes the quantity: its curve is proportional to the driver's, up to a constant. */
function isDriven({ drivers }: Report, { curves }: Quantity): boolean {
  return drivers.some(({ travel }) => rangeOf(travel) > 0 && moves(curves[0]) && proportional(curves[0], travel))
}

function moves(curve: Curve): boolean {
  const [low, high] = extent([curve]) ?? [0, 0]
  const size = Math.max(Math.abs(low), Math.abs(high))
  return high - low > Math.max(STILL * size, noise(size))
}

/** Largest less smallest value, 0 for a curve without any value. */
export function rangeOf(curve: Curve): number {
  const [low, high] = extent([curve]) ?? [0, 0]
  return high - low
}

/** True if one curve is the other, times a factor and plus a constant. */
function proportional(a: Curve, b: Curve): boolean {
  const [low, high] = [firstIndex(b, (x, y) => x < y), firstIndex(b, (x, y) => x > y)]
  const factor = (a[high] - a[low]) / (b[high] - b[low])
  const tolerance = STILL * Math.max(rangeOf(a), Number.MIN_VALUE)
  return a.every((value, k) => !(Math.abs(value - a[low] - factor * (b[k] - b[low])) > tolerance))
}
