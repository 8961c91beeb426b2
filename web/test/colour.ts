/** Colour as people see it: distances in OKLab, also for the three kinds of colour blindness. */

type Triple = [number, number, number]
type Matrix = [Triple, Triple, Triple]

/** Linear RGB without one kind of cone: Machado, Oliveira and Fernandes 2009, severity 1. */
export const BLINDNESS: Record<'protanopia' | 'deuteranopia' | 'tritanopia', Matrix> = {
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  tritanopia: [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
}

const CONES: Matrix = [
  [0.4122214708, 0.5363325363, 0.0514459929],
  [0.2119034982, 0.6806995451, 0.1073969566],
  [0.0883024619, 0.2817188376, 0.6299787005],
]
const LAB: Matrix = [
  [0.2104542553, 0.793617785, -0.0040720468],
  [1.9779984951, -2.428592205, 0.4505937099],
  [0.0259040371, 0.7827717662, -0.808675766],
]

const times = (matrix: Matrix, [a, b, c]: Triple) => matrix.map((row) => row[0] * a + row[1] * b + row[2] * c) as Triple
const each = (values: Triple, change: (value: number) => number) => values.map(change) as Triple

/** Linear red, green and blue from 0 to 1 of `#rrggbb`. */
function linear(hex: string): Triple {
  const parts = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255) as Triple
  return each(parts, (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4))
}

function lab(hex: string, blindness?: Matrix): Triple {
  const seen = blindness ? each(times(blindness, linear(hex)), (part) => Math.min(1, Math.max(0, part))) : linear(hex)
  return times(LAB, each(times(CONES, seen), Math.cbrt))
}

/** Distance of two colours in OKLab, times 100. */
export function distance(a: string, b: string, blindness?: Matrix): number {
  const [from, to] = [lab(a, blindness), lab(b, blindness)]
  return 100 * Math.hypot(...from.map((part, k) => part - to[k]))
}

/** Contrast of two colours as the accessibility guidelines define it, from 1 to 21. */
export function contrast(a: string, b: string): number {
  const [dark, light] = [a, b]
    .map(
      (hex) =>
        times(
          [
            [0.2126, 0.7152, 0.0722],
            [0, 0, 0],
            [0, 0, 0],
          ],
          linear(hex),
        )[0],
    )
    .sort((x, y) => x - y)
  return (light + 0.05) / (dark + 0.05)
}
