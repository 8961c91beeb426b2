import './labels.css'
import { type Camera, Vector3 } from 'three'
import { nearest, pairName } from '../clearance'
import { svg } from '../dom'
import { number, pretty } from '../format'
import { rounded } from '../rounding'
import type { Part, Frame } from './drawable'
import { type LabelBox, placeLabels } from './labels'
import type { Mechanism } from './mechanism'

/** A text at a place of the world. */
export interface Label {
  at: Vector3
  text: string
  /** True if it is a fault that is to be seen. */
  alert?: boolean
}

/** Room for the title and the buttons, px. */
const TOP = 34
/** The letters' font, as the style sheet has it. */
const FONT = '11px system-ui, sans-serif'
/** Digits of a measured distance. */
const DIGITS = 4
/** More labels than this cover the mechanism that they name. */
const MOST = 60

/** Names over the view, with leaders to their places. */
export class LabelLayer {
  readonly element = svg('svg', { class: 'labels', 'aria-hidden': 'true' })
  /** Placed labels, for a picture of the view. */
  placed: LabelBox[] = []
  #brush = document.createElement('canvas').getContext('2d')
  #widths = new Map<string, number>()

  /** Shows these labels, most important first; none of them, and there is nothing. */
  show(labels: Label[], camera: Camera, middle: Vector3, width: number, height: number): void {
    const onScreen = (place: Vector3) => {
      const { x, y, z } = place.clone().project(camera)
      return {
        x: ((x + 1) * width) / 2,
        y: ((1 - y) * height) / 2,
        seen: Math.abs(z) <= 1 && Math.abs(x) <= 1 && Math.abs(y) <= 1,
      }
    }
    const spots = labels.flatMap(({ at, text, alert }) => {
      const { x, y, seen } = onScreen(at)
      return seen ? [{ x, y, text, alert }] : []
    })
    this.placed = placeLabels(spots.slice(0, MOST), { width, height, top: TOP }, onScreen(middle), (text) =>
      this.#wide(text),
    )
    if (this.placed.length === 0 && this.element.childElementCount === 0) return
    this.element.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.element.replaceChildren(
      ...this.placed.map(({ spot, x, y }) => svg('line', { x1: spot.x, y1: spot.y, x2: x, y2: y })),
      ...this.placed.map(({ spot, x, y, width, height }) => {
        const text = svg('text', { x, y })
        text.textContent = spot.text
        const of: Record<string, string> = spot.alert ? { class: 'alert' } : {}
        return svg('g', of, svg('rect', { x: x - width / 2, y: y - height / 2, width, height, rx: 4 }), text)
      }),
    )
  }

  #wide(text: string): number {
    const known = this.#widths.get(text)
    if (known !== undefined || !this.#brush) return known ?? 0
    this.#brush.font = FONT
    const width = this.#brush.measureText(text).width
    this.#widths.set(text, width)
    return width
  }
}

/**
 * Names of the hardpoints, each place once: of one body, or of all; ground's first, since they are what a reader looks
 * for.
 */
export function hardpointLabels(mechanism: Mechanism, frame: Frame, only?: number): Label[] {
  const labels: Label[] = []
  mechanism.report.bodies.forEach(({ skeleton, labels: names }, body) => {
    if ((only !== undefined && only !== body) || !frame.visible(body)) return
    skeleton.forEach((point, k) => {
      const text = names[k]?.split(', ')[0]
      const at = frame.at(body, new Vector3(...point))
      if (text && !labels.some((other) => mechanism.same(other.at, at))) labels.push({ at, text })
    })
  })
  return labels
}

/** Value of the dimension line, at its middle. */
export function distanceLabels(
  { report }: Mechanism,
  frame: Frame,
  index: number | undefined,
  value: (quantity: number) => number,
): Label[] {
  if (index === undefined) return []
  const { name, from, to } = report.distances[index]
  const quantity = report.quantities.findIndex((one) => one.name === name)
  const [a, b] = [from, to].map(({ body, at }) => frame.at(body, new Vector3(...at)))
  if (quantity < 0 || !Number.isFinite(a.distanceTo(b))) return []
  return [
    {
      at: a.lerp(b, 0.5),
      text: `${name} ${number(rounded(value(quantity)), DIGITS)} ${pretty(report.quantities[quantity].units[0])}`,
    },
  ]
}

/** Distance of the nearest pair of each clearance, at the middle of its line. */
export function clearanceLabels({ report }: Mechanism, step: number): Label[] {
  return (report.clearance?.clearances ?? []).flatMap((_, index): Label[] => {
    const found = nearest(report, index, step)
    if (!found) return []
    const [p, q] = found.points.map((point) => new Vector3(...point))
    const value = `${number(rounded(found.distance), DIGITS)} ${pretty(report.units.length)}`
    return [{ at: p.lerp(q, 0.5), text: `${pairName(report, found.pair)} ${value}`, alert: found.distance < 0 }]
  })
}

/** Names for the hovered or selected item: a body with its hardpoints, or a joint at its location. */
export function partLabels(mechanism: Mechanism, frame: Frame, part: Part): Label[] {
  if (part.kind === 'body') return part.index === 0 ? [] : hardpointLabels(mechanism, frame, part.index)
  if (part.kind !== 'joint') return []
  const { name, body_i, at_i } = mechanism.report.joints[part.index]
  return frame.visible(body_i) ? [{ at: frame.at(body_i, new Vector3(...at_i)), text: name }] : []
}
