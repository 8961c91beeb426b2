import { ANGLES, LENGTHS } from './amount'

/** Exponents of length, angle, time and mass. */
type Dimension = readonly [length: number, angle: number, time: number, mass: number]

/** A unit: its size in metres, radians, seconds and kilograms. */
interface Unit {
  size: number
  dimension: Dimension
}

const POUND = 0.45359237
const GRAVITY = 9.80665
/** Units of lengths and angles are those of fields; a letter's case counts here: `mN` is no `MN`. */
const UNITS = new Map<string, Unit>(
  [
    ...listed(LENGTHS, 1, 0, 0, 0),
    ...listed({ um: 1e-6, µm: 1e-6, km: 1e3, ft: 0.3048 }, 1, 0, 0, 0),
    ...listed(ANGLES, 0, 1, 0, 0),
    ...listed({ mrad: 1e-3, rev: 2 * Math.PI }, 0, 1, 0, 0),
    ...listed({ s: 1, ms: 1e-3, min: 60, h: 3600 }, 0, 0, 1, 0),
    ...listed({ rpm: Math.PI / 30 }, 0, 1, -1, 0),
    ...listed({ kg: 1, g: 1e-3, t: 1e3, lb: POUND }, 0, 0, 0, 1),
    ...listed({ N: 1, mN: 1e-3, kN: 1e3, MN: 1e6, lbf: POUND * GRAVITY, kgf: GRAVITY }, 1, 0, -2, 1),
    ...listed({ Nm: 1, Nmm: 1e-3, kNm: 1e3, J: 1, kJ: 1e3 }, 2, 0, -2, 1),
    ...listed({ W: 1, kW: 1e3 }, 2, 0, -3, 1),
    ...listed({ Pa: 1, kPa: 1e3, MPa: 1e6, bar: 1e5, psi: (POUND * GRAVITY) / 0.0254 ** 2 }, -1, 0, -2, 1),
    ...listed({ '1': 1, '%': 0.01 }, 0, 0, 0, 0),
  ].map(([name, size, dimension]) => [name, { size, dimension }]),
)

function listed(sizes: Readonly<Record<string, number>>, ...dimension: Dimension): [string, number, Dimension][] {
  return Object.entries(sizes).map(([name, size]) => [name, size, dimension])
}

/** One factor of a unit, with the sign before it and the brackets around it. */
const FACTOR = /([*/]?)(\(?)([^*/()^\d]+|1)\^?(-?\d*)(\)?)/y

/** A unit such as `N*mm`, `deg/(s·mm)` or `mm/s²`; undefined where a part of it is not known. */
function unitOf(text: string): Unit | undefined {
  const plain = (text || '1')
    .trim()
    .replaceAll('²', '^2')
    .replaceAll('³', '^3')
    .replace(/[\s·*]+/g, '*')
  let size = 1
  let within = 1
  let end = 0
  const dimension = [0, 0, 0, 0]
  FACTOR.lastIndex = 0
  for (let found = FACTOR.exec(plain); found; found = end < plain.length ? FACTOR.exec(plain) : null) {
    const [, sign, open, name, power, close] = found
    const unit = UNITS.get(name)
    if (!unit) return undefined
    const side = sign === '/' ? -1 : 1
    const exponent = within * side * (power === '' ? 1 : Number(power))
    size *= unit.size ** exponent
    unit.dimension.forEach((d, k) => (dimension[k] += d * exponent))
    if (open) within *= side
    if (close) within = 1
    end = FACTOR.lastIndex
  }
  return end === plain.length ? { size, dimension: dimension as unknown as Dimension } : undefined
}

/** Factor from one unit to another: `undefined` for a unit that is not known, NaN where they measure something else. */
export function conversion(from: string, to: string): number | undefined {
  if (from === to) return 1
  const [a, b] = [unitOf(from), unitOf(to)]
  if (!a) return undefined
  // A unit of the report that is not known here converts to nothing else.
  return b?.dimension.every((d, k) => d === a.dimension[k]) ? a.size / b.size : NaN
}
