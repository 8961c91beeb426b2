import type { State } from '../state'

/** Targets of keys other than the state; missing parts are left out. */
interface Targets {
  fit?: () => void
  /** Takes the standard view of this number, from 0. */
  look?: (index: number) => void
  /** Begins or ends measuring. */
  measure?: () => void
  find?: () => void
  help: () => void
  /** Takes hold of hardpoints, or lets go. */
  grips?: () => void
  /** Ends the mode in which hardpoints are moved; false if it is not on. */
  leave?: () => boolean
}

/** Keys that work wherever the focus is, but for controls to which they mean something else. */
export function listenToKeys(state: State, targets: Targets): void {
  document.addEventListener(
    'keydown',
    (event) => {
      const target = event.target as HTMLElement
      if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return
      if (target.closest('select, textarea, input:not([type=range]), [contenteditable=true], dialog, [role=menu]'))
        return
      const action = actionOf(event, target, state, targets)
      if (!action) return
      event.preventDefault()
      action()
    },
    { signal: state.ended },
  )
}

function actionOf(
  { key }: KeyboardEvent,
  target: HTMLElement,
  state: State,
  targets: Targets,
): (() => void) | undefined {
  const digit = Number(key)
  if (key !== ' ' && Number.isInteger(digit) && digit >= 1) return targets.look && (() => targets.look!(digit - 1))
  switch (key) {
    case ' ':
      return target.closest('button, summary') ? undefined : () => state.toggle()
    case 'f':
    case 'F':
      return targets.fit
    case 'l':
    case 'L':
      return () => state.choose({ labels: !state.choice.labels })
    case 'n':
    case 'N':
      return state.report.loads.length > 0 ? () => state.choose({ forces: !state.choice.forces }) : undefined
    case 'h':
    case 'H':
      return state.report.clearance ? () => state.choose({ shapes: !state.choice.shapes }) : undefined
    case 'm':
    case 'M':
      return targets.grips
    case 'd':
    case 'D':
      return targets.measure
    case '/':
      return targets.find
    case '?':
      return targets.help
    case 'Escape':
      return () => targets.leave?.() || (state.choice.selected && state.choose({ selected: undefined }))
  }
  // A slider and a list of tabs step by themselves.
  if (target.closest('input, [role=tablist]')) return undefined
  switch (key) {
    case 'ArrowLeft':
      return () => state.nudge(-1)
    case 'ArrowRight':
      return () => state.nudge(1)
    case 'Home':
      return () => state.nudge(-state.lastStep)
    case 'End':
      return () => state.nudge(state.lastStep)
  }
  return undefined
}
