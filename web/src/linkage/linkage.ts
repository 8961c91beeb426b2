/** A place on the sheet, in the unit of length. */
export type Place = [x: number, y: number]

/** A joint of a drawn linkage. */
export interface Pin {
  name: string
  at: Place
  /** On a block that slides on the ground, on the ground itself, or between bars alone. */
  support: 'free' | 'ground' | 'slider'
  /** Direction of a slider, deg from the x axis. */
  direction: number
  /** Motion of the motor at a support: whole turns, or to and fro. */
  motor?: 'turn' | 'swing'
  /** Amplitude of a motor that moves to and fro, in deg at the ground and in the unit of length at a slider. */
  amplitude: number
}

/** A bar between two pins, or a plate through more. */
export interface Bar {
  name: string
  pins: readonly string[]
}

/** A drawn planar linkage; every change makes another one. */
export interface Linkage {
  pins: readonly Pin[]
  bars: readonly Bar[]
}

export const EMPTY: Linkage = { pins: [], bars: [] }

/** Names that need no quotes in the text, and can be parts of others. */
const NAME = /^[A-Za-z_][A-Za-z0-9_]*$/
const LETTERS = 26
/** Amplitude of a new motor that moves to and fro. */
const AMPLITUDE = 30
/** Digits of a slider's direction. */
const DIGITS = 12
const STEPS = 180

/** A, B, ..., Z, A1, B1, ...: the first that is free. */
function freePin({ pins }: Linkage): string {
  for (let k = 0; ; k++) {
    const round = Math.floor(k / LETTERS)
    const name = String.fromCharCode(65 + (k % LETTERS)) + (round || '')
    if (!pins.some((pin) => pin.name === name)) return name
  }
}

function freeBar({ bars }: Linkage): string {
  for (let k = bars.length + 1; ; k++) if (!bars.some(({ name }) => name === `bar_${k}`)) return `bar_${k}`
}

/** Adds a pin; the new one is the last. */
export function withPin(linkage: Linkage, at: Place): Linkage {
  const pin: Pin = { name: freePin(linkage), at, support: 'free', direction: 0, amplitude: AMPLITUDE }
  return { ...linkage, pins: [...linkage.pins, pin] }
}

/** Adds a bar between two pins; none where one has both already. */
export function withBar(linkage: Linkage, a: string, b: string): Linkage {
  if (a === b || linkage.bars.some(({ pins }) => pins.includes(a) && pins.includes(b))) return linkage
  return { ...linkage, bars: [...linkage.bars, { name: freeBar(linkage), pins: [a, b] }] }
}

/** Makes a bar a plate through a further pin. */
export function withCorner(linkage: Linkage, bar: string, pin: string): Linkage {
  const add = (one: Bar) => (one.name !== bar || one.pins.includes(pin) ? one : { ...one, pins: [...one.pins, pin] })
  return { ...linkage, bars: linkage.bars.map(add) }
}

/** Changes a pin other than its name; only a support has a motor, and only on the ground one turns. */
export function changed(linkage: Linkage, name: string, by: Partial<Omit<Pin, 'name'>>): Linkage {
  const apply = (pin: Pin): Pin => {
    const made = { ...pin, ...by }
    if (made.support === 'free') made.motor = undefined
    if (made.support === 'slider' && made.motor) made.motor = 'swing'
    return made
  }
  return { ...linkage, pins: linkage.pins.map((pin) => (pin.name === name ? apply(pin) : pin)) }
}

/** Leaves out a pin, and the bars that would have a single one. */
export function withoutPin({ pins, bars }: Linkage, name: string): Linkage {
  const rest = bars.map((bar) => ({ ...bar, pins: bar.pins.filter((pin) => pin !== name) }))
  return { pins: pins.filter((pin) => pin.name !== name), bars: rest.filter((bar) => bar.pins.length > 1) }
}

export function withoutBar({ pins, bars }: Linkage, name: string): Linkage {
  return { pins, bars: bars.filter((bar) => bar.name !== name) }
}

/** Gives a pin or bar another name; a sentence where that is impossible. */
export function renamed(linkage: Linkage, kind: 'pin' | 'bar', from: string, to: string): Linkage | string {
  if (to === from) return linkage
  if (!NAME.test(to)) return 'A name has letters, digits and `_`, and begins with a letter.'
  const all: readonly { name: string }[] = kind === 'pin' ? linkage.pins : linkage.bars
  if (to === 'ground' || all.some(({ name }) => name === to)) return `\`${to}\` is there already.`
  const name = (one: string) => (one === from ? to : one)
  if (kind === 'bar') return { ...linkage, bars: linkage.bars.map((bar) => ({ ...bar, name: name(bar.name) })) }
  return {
    pins: linkage.pins.map((pin) => ({ ...pin, name: name(pin.name) })),
    bars: linkage.bars.map((bar) => ({ ...bar, pins: bar.pins.map(name) })),
  }
}

/** The next thing that a linkage lacks before it can move at all; undefined where the engine is to judge. */
export function lacking({ pins, bars }: Linkage): string | undefined {
  if (pins.length === 0) return 'Click a place for the first joint.'
  if (bars.length === 0) return 'Click the other end of the bar: a place, or a joint.'
  if (!pins.some(({ support }) => support === 'ground'))
    return 'Choose Fixed pivot, and click each joint on the ground.'
  if (!pins.some(({ motor }) => motor)) return 'Choose Motor, and click the fixed pivot or slider that is driven.'
  return undefined
}

/** Length of a bar between two places. */
export function length([a, b]: Place, [c, d]: Place): number {
  return Math.hypot(c - a, d - b)
}

function direction(degrees: number): string {
  const at = (degrees * Math.PI) / 180
  return `[${[Math.cos(at), Math.sin(at)].map((x) => Number(x.toFixed(DIGITS)) + 0).join(', ')}]`
}

/** Text of the model of a linkage; the names need no quotes. */
export function linkageToml({ pins, bars }: Linkage, unit: string): string {
  const list = (names: readonly string[]) => `[${names.map((name) => `"${name}"`).join(', ')}]`
  const grounded = pins.filter(({ support }) => support === 'ground')
  const sliders = pins.filter(({ support }) => support === 'slider')
  const driven = pins.filter(({ motor }) => motor)
  const joint = ({ name, support }: Pin) => (support === 'slider' ? `${name}_slide` : name)
  const law = ({ motor, amplitude }: Pin) => (motor === 'turn' ? '360*t' : `${amplitude}*sin(2*pi*t)`)
  const measure = ({ name, support }: Pin) => `${name}_${support === 'slider' ? 'travel' : 'angle'}`
  // A pivot without a bar is no joint, and moving it changes nothing.
  const joined = pins.filter(({ name }) => bars.some(({ pins }) => pins.includes(name)))
  const measured = [...grounded, ...sliders].filter((pin) => joined.includes(pin))
  const outputs = measured.filter(({ motor }) => !motor).map(measure)
  const section = (head: string, lines: string[]) => (lines.length > 0 ? ['', ...head.split('\n'), ...lines] : [])
  return [
    '# A planar linkage, drawn on the page.',
    '',
    'name = "linkage"',
    `units = { length = "${unit}", angle = "deg" }`,
    'planar = "xy"',
    ...section(
      '[hardpoints]',
      pins.map(({ name, at }) => `${name} = [${at.join(', ')}]`),
    ),
    ...section('# Bodies by their hardpoints: where two have the same one, there is a pin of that name.\n[bodies]', [
      ...(grounded.length > 0 ? [`ground = ${list(grounded.map(({ name }) => name))}`] : []),
      ...bars.map(({ name, pins }) => `${name} = ${list(pins)}`),
      ...sliders.map(({ name }) => `${name}_slider = ${list([name])}`),
    ]),
    ...section(
      '[joints]',
      sliders.map(
        (pin) =>
          `${joint(pin)} = { type = "translational", bodies = ["ground", "${pin.name}_slider"], ` +
          `at = "${pin.name}", axis = ${direction(pin.direction)} }`,
      ),
    ),
    ...section(
      '[drivers]',
      driven.map((pin) => `${pin.name}_motor = { joint = "${joint(pin)}", law = "${law(pin)}" }`),
    ),
    ...section(
      '[design]',
      joined.map(({ name }) => `${name} = { move = "${name}", along = "xy" }`),
    ),
    ...section(
      '[measures]',
      measured.map((pin) => `${measure(pin)} = { type = "coordinate", joint = "${joint(pin)}" }`),
    ),
    ...(driven.length === 1 && outputs.length > 0
      ? section('[page]', [
          `plots = [${outputs.map((of) => `{ y = ["${of}"], over = "${measure(driven[0])}" }`).join(', ')}]`,
        ])
      : []),
    '',
    '[time]',
    'end = 1',
    `steps = ${STEPS}`,
    '',
  ].join('\n')
}
