/** Lengths in metres and angles in radians of the units that the command's `--set` knows. */
export const LENGTHS: Readonly<Record<string, number>> = { mm: 1e-3, cm: 1e-2, m: 1, in: 0.0254 }
export const ANGLES: Readonly<Record<string, number>> = { deg: Math.PI / 180, '°': Math.PI / 180, rad: 1 }
const KNOWN = 'mm, cm, m, in, deg or rad'

/** `12`, `2,5`, `.5e-3`, `1/2`, `1 1/2`; then a unit. */
const FRACTION = /(?:(?<whole>\d+)\s+)?(?<top>\d+)\s*\/\s*(?<bottom>\d+)/.source
const DECIMAL = /(?<decimal>(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[+-]?\d+)?)/.source
const UNIT = /(?<unit>\p{L}*|°|\p{L}.*)/u.source
const AMOUNT = new RegExp(`^(?<step>[+-]=)?\\s*(?<sign>[+-]?)\\s*(?:${FRACTION}|${DECIMAL})\\s*${UNIT}$`, 'iu')

/** Number that a reader typed, in the unit of its field. */
export interface Amount {
  value: number
  /** `plus`: a leading `+`; `step`: `+=` or `-=`, which change the present value; `plain`: neither. */
  form: 'plain' | 'plus' | 'step'
}

/**
 * Reads a number as the command's `--set` does: `2`, `2mm`, `0.5 deg`; also with a decimal comma, as a fraction such
 * as `1/2 in`, and with units in capitals; a number without a unit is in the unit `usual`. Returns a sentence where it
 * is none.
 */
export function amount(text: string, unit: string, usual = unit): Amount | string {
  const written = text.trim().replaceAll('−', '-')
  if (written === '') return 'Enter a number, such as `12`, `1/2 in` or `+=2`.'
  const found = AMOUNT.exec(written)?.groups
  if (!found) return `\`${text.trim()}\` is not a number with a unit.`
  const { step, sign, whole, top, bottom, decimal } = found
  const size =
    decimal === undefined ? Number(whole ?? 0) + Number(top) / Number(bottom) : Number(decimal.replace(',', '.'))
  const value = size * (sign === '-' ? -1 : 1) * (step === '-=' ? -1 : 1)
  if (!Number.isFinite(value)) return `\`${text.trim()}\` is not finite.`
  const factor = conversion(found.unit || usual, unit)
  if (typeof factor === 'string') return factor
  const converted = Number((value * factor).toPrecision(15))
  if (!Number.isFinite(converted)) return `\`${text.trim()}\` is not finite.`
  return { value: converted, form: step ? 'step' : sign === '+' ? 'plus' : 'plain' }
}

/** Factor from one unit to another; a sentence where there is none. */
function conversion(written: string, unit: string): number | string {
  if (written === '' || written === unit) return 1
  const symbol = written.toLowerCase()
  if (symbol === unit.toLowerCase()) return 1
  for (const [kind, units] of [
    ['a length', LENGTHS],
    ['an angle', ANGLES],
  ] as const) {
    if (!(unit in units)) continue
    if (symbol in units) return units[symbol] / units[unit]
    if (symbol in LENGTHS || symbol in ANGLES)
      return `This is ${kind}, but ${written} is not a unit of ${kind.split(' ')[1]}.`
    return `There is no unit \`${written}\`; use ${KNOWN}.`
  }
  return unit === '' || unit === '1'
    ? `This is dimensionless, but the unit \`${written}\` was given.`
    : `The unit here is ${unit}; leave out \`${written}\`.`
}

/** An angle in a unit of the report. */
export function fromRadians(radians: number, unit: string): number {
  return unit === 'deg' ? (radians * 180) / Math.PI : radians
}

/** A number for a field: at most this many digits, and no exponent while it is readable without. */
export function entry(value: number, digits = 7): string {
  return String(Number(value.toPrecision(digits)))
}
