import { contacts, stepsOf } from '../clearance'
import { el, svg } from '../dom'
import { number, pretty, roundBelow } from '../format'
import type { State } from '../state'

/** Seconds that one pass takes at the speed first offered. */
const PASS = 6

const TRIANGLE = 'M2 1v10l9-5z'
const BARS = 'M2 1h3v10h-3zM7 1h3v10h-3z'

/** Play, scrub and speed, with the moment shown. */
export function transport(state: State): HTMLElement {
  const { report } = state
  const time = pretty(report.units.time)
  const still = state.lastStep === 0
  const play = el('button', {
    type: 'button',
    class: 'play',
    'data-testid': 'play',
    disabled: still,
    onclick: () => state.toggle(),
  })
  const slider = el('input', {
    type: 'range',
    min: 0,
    max: state.lastStep,
    step: 1,
    disabled: still,
    'aria-label': 'time',
    'data-testid': 'scrub',
    oninput: () => {
      state.pause()
      state.goToStep(Number(slider.value))
    },
  })
  const readout = el('output', { class: 'readout', 'data-testid': 'time' })

  const duration = report.times[state.lastStep] - report.times[0]
  const usual = duration > 0 ? Math.min(1, roundBelow(duration / PASS)) : 1
  state.speed = usual
  const speeds = [0.1, 0.2, 0.5, 1, 2, 5].map((factor) => Number((usual * factor).toPrecision(3)))
  const speed = el(
    'select',
    { 'aria-label': 'playback speed', 'data-testid': 'speed', onchange: () => (state.speed = Number(speed.value)) },
    ...speeds.map((value) => el('option', { value, selected: value === usual }, `${number(value)}×`)),
  )

  const show = () => {
    play.replaceChildren(
      svg('svg', { viewBox: '0 0 12 12', 'aria-hidden': 'true' }, svg('path', { d: state.playing ? BARS : TRIANGLE })),
    )
    play.setAttribute('aria-label', state.playing ? 'pause' : 'play')
    slider.value = String(Math.round(state.step))
    const moment = `${number(state.time, 4)} ${time}`
    slider.setAttribute('aria-valuetext', moment)
    readout.textContent = moment
  }
  state.onTime(show)
  show()
  const touching = el('div', { class: 'contacts', 'data-testid': 'contacts', 'aria-hidden': 'true' })
  let marked = ''
  // Marks are in the places of the thumb at the moments of contact.
  const mark = () => {
    if (!report.clearance || still) return
    const spans = contacts(state).map((interval) => stepsOf(report, interval).map((step) => step / state.lastStep))
    if (marked === JSON.stringify(spans)) return
    marked = JSON.stringify(spans)
    touching.replaceChildren(
      ...spans.map(([from, to]) => {
        return el('span', { title: 'shapes touch', style: `--from: ${from.toFixed(5)}; --to: ${to.toFixed(5)}` })
      }),
    )
  }
  state.onChoice(mark)
  mark()
  return el(
    'div',
    { class: 'transport', role: 'group', 'aria-label': 'Time' },
    play,
    el('div', { class: 'scrub' }, touching, slider),
    readout,
    speed,
  )
}
