import { el } from '../dom'
import type { Plot } from '../plot'
import { Sketch } from './sketch'
import type { TargetCurve } from './target'

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
 * A button by which the curve that is wanted is drawn over a plot, and added to the model; `drawing` is evaluated when
 * it is pressed.
 */
export function targetButton(plot: Plot, drawing: () => Drawing, add: (curve: TargetCurve) => void): HTMLButtonElement {
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
        add({ name: `${of.replaceAll('.', '_')}_target`, of, ...where, points })
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
