import { el } from '../dom'
import type { Plot } from '../plot'
import { Sketch } from './sketch'
import { targetToml } from './target'

/** Actions of the page on a target. */
export interface TargetHost {
  /** The text of the present design. */
  text: () => string
  /** Shows another text, as a step of the history. */
  replace: (text: string, label: string) => void
}

/** Contents of a plot, by the names of the text. */
export interface Drawing {
  /** A measure, or a coordinate of a point. */
  of: string
  /** Another one, over which it is drawn; time where there is none. */
  over?: string
  /** The case whose motion it is, where there are several. */
  case?: string
}

/**
 * A button by which the curve that is wanted is drawn over a plot, and becomes a metric of the text; `drawing` is asked
 * when it is pressed.
 */
export function targetButton(plot: Plot, drawing: () => Drawing, { text, replace }: TargetHost): HTMLButtonElement {
  let sketch: Sketch | undefined
  const end = () => {
    sketch = undefined
    button.setAttribute('aria-pressed', 'false')
    button.focus()
  }
  const begin = () => {
    const { of, ...where } = drawing()
    sketch = new Sketch(plot, {
      done: (points) => {
        end()
        const made = targetToml(text(), { name: `${of.replaceAll('.', '_')}_target`, of, ...where, points })
        replace(made.text, `target of ${of}`)
      },
      cancel: end,
    })
    button.setAttribute('aria-pressed', 'true')
  }
  const button = el(
    'button',
    {
      type: 'button',
      'aria-pressed': 'false',
      'data-testid': 'draw-target',
      title: 'Draw the desired curve; it becomes a metric of the model',
      onclick: () => {
        if (!sketch) return begin()
        sketch.close()
        end()
      },
    },
    'Draw target…',
  )
  return button
}
