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

/** Unit of a derivative: `deg/s` per `mm` is `deg/(s·mm)`, and `deg` per `N*m` is `deg/(N·m)`. */
export function per(unit: string, by: string): string {
  if (by === '1') return pretty(unit)
  const [top, ...below] = pretty(unit || '1').split('/')
  const divisor = by.includes('/') ? `(${pretty(by)})` : pretty(by)
  const bottom = [...below.map((part) => part.replace(/^\((.*)\)$/, '$1')), divisor]
  const isProduct = bottom.length > 1 || /^[^(]*·/.test(bottom[0])
  return `${top || '1'}/${isProduct ? `(${bottom.join('·')})` : bottom[0]}`
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
