const DIGITS = 5

/** About five significant digits, without trailing zeros; a dash where there is no value. */
export function number(value: number, digits = DIGITS): string {
  if (!Number.isFinite(value)) return '–'
  if (value === 0) return '0'
  const size = Math.abs(value)
  const text =
    size >= 1e6 || size < 1e-4
      ? value
          .toExponential(digits - 1)
          .replace(/\.?0+e/, 'e')
          .replace('e+', 'e')
      : String(Number(value.toPrecision(digits)))
  return text.replaceAll('-', '−')
}

/** A change with its sign. */
export function signed(by: number, digits = DIGITS): string {
  return `${by > 0 ? '+' : ''}${number(by, digits)}`
}

/** A number with its unit; the pure number `1` shows none. */
export function figure(value: number, unit: string): string {
  const shown = pretty(unit)
  return shown ? `${number(value)} ${shown}` : number(value)
}

/** `deg/s^2` as `deg/s²`; nothing for a pure number. */
export function pretty(unit: string): string {
  return unit === '1' ? '' : unit.replaceAll('^2', '²').replaceAll('^3', '³').replaceAll('*', '·')
}

/**
 * Unit of a derivative, as the command writes it (`per` in `hardpoint-table/src/figures.rs`): `deg/s` per `mm` is
 * `deg/(s·mm)`, `deg/mm` per `mm` is `deg/mm²`, and `deg` per `N*m` is `deg/(N·m)`.
 */
export function per(unit: string, by: string): string {
  if (by === '1') return pretty(unit)
  const slash = unit.indexOf('/')
  const top = (slash < 0 ? unit : unit.slice(0, slash)) || '1'
  if (slash < 0) return pretty(`${top}/${/[*/]/.test(by) ? `(${by})` : by}`)
  const factors = unit
    .slice(slash + 1)
    .replace(/^\((.*)\)$/, '$1')
    .split('*')
  const same = factors.findIndex((factor) => factor === by || powerOf(factor, by))
  if (same >= 0) factors[same] = `${by}^${(powerOf(factors[same], by) ?? 1) + 1}`
  else factors.push(by.includes('/') ? `(${by})` : by)
  return pretty(`${top}/${factors.length > 1 ? `(${factors.join('*')})` : factors[0]}`)
}

/** 2 of `mm^2`, as a power of `mm`. */
function powerOf(factor: string, by: string): number | undefined {
  const digits = factor.startsWith(`${by}^`) ? factor.slice(by.length + 1) : ''
  return /^\d+$/.test(digits) ? Number(digits) : undefined
}

/** `name [unit]`, as on an axis. */
export function titled(name: string, unit: string): string {
  const shown = pretty(unit)
  return shown ? `${name} [${shown}]` : name
}

/** Message of an error, whatever was thrown. */
export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error)
}

/** The nearest of 1, 2 and 5 times a power of ten below a positive number. */
export function roundBelow(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value))
  const lead = value / power
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power
}
