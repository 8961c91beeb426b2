import { abscissaOf, headingOf } from '../content'
import type { Curve } from '../curve'
import { css } from '../dom'
import { csvOf, type Column } from '../export/csv'
import { pngOf } from '../export/png'
import { plotSvg } from '../export/plot_svg'
import { save } from '../export/save'
import { hasVideo, motionVideo } from '../export/video'
import type { View } from '../scene/view'
import type { State } from '../state'
import { type Part, stepsWithin } from '../zoom'
import { composePrint } from './composer'
import type { Figure } from './figure'
import type { Item, ItemRow } from './menu'

/** Pixels of an exported picture per pixel of the page. */
const SHARP = 2

/** Items that can be exported from the present view. */
export function exports(state: State, figures: Figure[], view: View | undefined): (Item | ItemRow)[] {
  const { report } = state
  const name = report.file.replace(/\.[^.]*$/, '') || 'report'
  const drawn = figures.filter(({ plot }) => plot.canvas)
  return [
    { name: 'Print or PDF…', testId: 'export-print', run: () => composePrint(document.getElementById('page')!) },
    ...(view ? viewRows(state, view, name) : []),
    ...(drawn.length > 0
      ? [
          {
            name: 'Curves shown as CSV',
            testId: 'export-csv',
            run: () => save(csvOf(columns(state, drawn)), `${name} curves.csv`),
          },
        ]
      : []),
    ...drawn.map(({ plot }) => {
      const { title } = plot.content
      const vectors = () => plotSvg(plot.content, report.times, report.units.time, paper())
      const items = [
        {
          name: 'PNG',
          testId: 'export-plot-png',
          run: async () => save(await pngOf(vectors(), SHARP), `${name} ${title}.png`),
        },
        { name: 'SVG', testId: 'export-plot-svg', run: () => save(vectors(), `${name} ${title}.svg`) },
      ]
      return { name: title, items }
    }),
  ]
}

/** Picture and motion of the view. */
function viewRows(state: State, view: View, name: string): ItemRow[] {
  const pictures = [
    {
      name: 'PNG',
      testId: 'export-view-png',
      run: async () => save(await view.picture(SHARP), `${name} view.png`),
    },
    { name: 'SVG', testId: 'export-view-svg', run: () => save(view.vectors(), `${name} view.svg`) },
  ]
  const video = {
    name: 'video',
    testId: 'export-video',
    run: async () => {
      const { blob, ending } = await motionVideo(view.canvas, state)
      save(blob, `${name}.${ending}`)
    },
  }
  const scene = { name: 'glTF', testId: 'export-gltf', run: async () => save(await view.motion(), `${name}.glb`) }
  return [
    { name: 'View', items: pictures },
    { name: 'Motion', items: hasVideo() && state.lastStep > 0 ? [video, scene] : [scene] },
  ]
}

function paper() {
  return { page: css('--page'), text: css('--ink'), muted: css('--muted'), rule: css('--rule') }
}

/** Time, then every curve once, after its abscissa if that is not time, at the steps that some plot shows. */
function columns({ report }: State, figures: Figure[]): Column[] {
  const time = { label: 'time', unit: report.units.time, curve: report.times }
  const columns: Column[] = [time]
  const parts: { xs: Curve; part?: Part }[] = []
  for (const { plot } of figures) {
    const { content } = plot
    const { unit, over, part } = content
    for (const line of content.lines.filter(({ free, hidden }) => !free && !hidden)) {
      const xs = abscissaOf(line, content, report.times)
      parts.push({ xs, part })
      const label = headingOf(line, content)
      if (over && !columns.some(({ curve }) => isSame(curve, xs))) {
        const isTaken = columns.some((column) => column.label === over.label)
        columns.push({ label: isTaken ? `${over.label} of ${label}` : over.label, unit: over.unit, curve: xs })
      }
      columns.push({ label, unit, curve: line.curve })
    }
  }
  if (parts.some(({ part }) => !part)) return columns
  const seen = parts.map(({ xs, part }) => stepsWithin(xs, part!))
  return columns.map((column) => ({
    ...column,
    curve: column.curve.filter((_, k) => seen.some((steps) => steps.has(k))),
  }))
}

function isSame(a: Curve, b: Curve): boolean {
  return a === b || (a.length === b.length && a.every((value, k) => Object.is(value, b[k])))
}
