import { type Curve, decades, padded } from '../curve'
import { pretty, titled } from '../format'
import { abscissaOf, type Content, drawnLines, drawnRange, drawnSteps, type Line } from '../content'
import { type Axis, extent, linearAxis, logarithmicAxis } from './axis'
import { escaped, round, svgFile, tag } from './markup'

/** Colours of everything but the curves. */
export interface Paper {
  page: string
  text: string
  muted: string
  rule: string
}

/** Size of the picture, and of the room that titles and numbers need round the curves, px. */
const [WIDTH, HEIGHT] = [640, 360]
const [LEFT, RIGHT, TOP, BOTTOM] = [78, 16, 34, 46]
const LEGEND_LINE = 18
/** A letter of the legend is about so wide, px. */
const LETTER = 6.4
const SWATCH = 22
/** The range of curves without any value. */
const NOTHING: [null, null] = [null, null]
const FONT = 'system-ui, sans-serif'
/** Radius of circles in place of a line, px. */
const RADIUS = 3

/** A plot as vectors with text: the same content as on the page, at a size that suits a document. */
export function plotSvg(shown: Content, times: Curve, timeUnit: string, paper: Paper): Blob {
  const content = { ...shown, lines: drawnLines(shown) }
  const { lines } = content
  const all = lines.length > 0 ? lines.map((line) => abscissaOf(line, content, times)) : [content.over?.curve ?? times]
  const label = content.over ? titled(content.over.label, content.over.unit) : titled('time', timeUnit)
  const keys = legend(lines)
  const bottom = HEIGHT - BOTTOM
  const height = HEIGHT + keys.height
  const [first, last] = extent(content.over ? all : [times]) ?? NOTHING
  const whole =
    first === null || last === null || content.over ? padded(first, last) : ([first, last] as [number, number])
  const x = linearAxis(content.part ? [...content.part] : whole, LEFT, WIDTH - RIGHT, 8)
  const y = vertical(content, times, bottom)

  const text = (at: [number, number], words: string, more: Record<string, string | number> = {}) =>
    tag('text', { x: at[0], y: at[1], fill: paper.muted, ...more }, escaped(words))
  const rule = (x1: number, y1: number, x2: number, y2: number) =>
    tag('line', { x1, y1, x2, y2, stroke: paper.rule, 'stroke-width': 1 })
  const middle = (TOP + bottom) / 2
  return svgFile(
    WIDTH,
    height,
    content.title,
    tag('rect', { width: WIDTH, height, fill: paper.page }),
    tag(
      'g',
      { 'font-family': FONT, 'font-size': 12 },
      text([LEFT, 20], titled(content.title, content.unit), { fill: paper.text, 'font-size': 14, 'font-weight': 600 }),
      ...x.ticks.flatMap(({ value, text: words }) => [
        rule(x.at(value), TOP, x.at(value), bottom),
        text([x.at(value), bottom + 16], words, { 'text-anchor': 'middle' }),
      ]),
      ...y.ticks.flatMap(({ value, text: words }) => [
        rule(LEFT, y.at(value), WIDTH - RIGHT, y.at(value)),
        text([LEFT - 6, y.at(value) + 4], words, { 'text-anchor': 'end' }),
      ]),
      text([(LEFT + WIDTH - RIGHT) / 2, bottom + 36], label, { 'text-anchor': 'middle' }),
      text([16, middle], pretty(content.unit) || '–', {
        'text-anchor': 'middle',
        transform: `rotate(-90 16 ${round(middle)})`,
      }),
      tag(
        'svg',
        {
          x: LEFT,
          y: TOP,
          width: WIDTH - LEFT - RIGHT,
          height: bottom - TOP,
          viewBox: `${LEFT} ${TOP} ${WIDTH - LEFT - RIGHT} ${bottom - TOP}`,
        },
        ...lines.map((line) => drawn(line, abscissaOf(line, content, times), drawnSteps(line, content, times), x, y)),
      ),
      tag('rect', {
        x: LEFT,
        y: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: bottom - TOP,
        fill: 'none',
        stroke: paper.rule,
      }),
      ...lines.map((line, k) => {
        const [left, top] = [keys.places[k][0], HEIGHT + keys.places[k][1]]
        return drawnKey(line, left, top) + text([left + SWATCH + 6, top + 4], line.label, { fill: paper.text })
      }),
    ),
  )
}

function vertical(content: Content, times: Curve, bottom: number): Axis {
  const { logarithmic, upright } = content
  const [low, high] = upright ?? drawnRange(content, times) ?? NOTHING
  if (logarithmic) return logarithmicAxis(decades(low, high), bottom, TOP)
  return linearAxis(upright ? [...upright] : padded(low, high), bottom, TOP, 6)
}

/** A curve with gaps where it has no value. */
function drawn(
  { color, curve, marks, width, dash }: Line,
  abscissa: Curve,
  [first, last]: [number, number],
  x: Axis,
  y: Axis,
): string {
  let path = ''
  let drawing = false
  const circles: string[] = []
  for (let k = first; k <= last; k++) {
    const value = marks ? marks[k] : curve[k]
    const [left, top] = [x.at(abscissa[k]), y.at(value ?? NaN)]
    if (!Number.isFinite(left + top)) {
      drawing = false
    } else if (marks) {
      circles.push(tag('circle', { cx: left, cy: top, r: RADIUS }))
    } else {
      path += `${drawing ? 'L' : 'M'}${round(left)} ${round(top)}`
      drawing = true
    }
  }
  if (marks) return tag('g', { fill: 'none', stroke: color, 'stroke-width': 1.5 }, ...circles)
  return tag('path', { d: path, ...stroked(color, width, dash) })
}

function drawnKey({ color, marks, width, dash }: Line, left: number, top: number): string {
  if (marks)
    return tag('circle', {
      cx: left + SWATCH / 2,
      cy: top,
      r: RADIUS,
      fill: 'none',
      stroke: color,
      'stroke-width': 1.5,
    })
  return tag('path', { d: `M${round(left)} ${round(top)}h${SWATCH}`, ...stroked(color, width, dash) })
}

function stroked(color: string, width = 1.8, dash?: number[]): Record<string, string | number | undefined> {
  return {
    fill: 'none',
    stroke: color,
    'stroke-width': width,
    'stroke-linejoin': 'round',
    'stroke-dasharray': dash?.join(' '),
  }
}

/** Positions of the lines' names below the plot, in rows. */
function legend(lines: Line[]): { places: [number, number][]; height: number } {
  let [left, top] = [LEFT, 4]
  const places = lines.map(({ label }): [number, number] => {
    const width = SWATCH + 6 + LETTER * label.length + 18
    if (left > LEFT && left + width > WIDTH) [left, top] = [LEFT, top + LEGEND_LINE]
    const place: [number, number] = [left, top]
    left += width
    return place
  })
  return { places, height: lines.length > 0 ? top + LEGEND_LINE : 0 }
}
