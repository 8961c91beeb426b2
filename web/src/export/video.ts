import type { State } from '../state'

/** Frames and bits per second of a video. */
const FRAMES = 30
const BITS = 8_000_000
/** A pass of the motion takes at most this time, s; a slower one is recorded faster. */
const LONGEST = 20
/** Containers in the order of preference, with the ending of the file's name. */
const KINDS = [
  ['video/webm;codecs=vp9', 'webm'],
  ['video/webm', 'webm'],
  ['video/mp4', 'mp4'],
] as const

/** True if the browser records what it draws. */
export function hasVideo(): boolean {
  return typeof MediaRecorder !== 'undefined' && 'captureStream' in HTMLCanvasElement.prototype
}

/** One pass of the motion at the chosen speed, as the canvas shows it while it is recorded. */
export async function motionVideo(canvas: HTMLCanvasElement, state: State): Promise<{ blob: Blob; ending: string }> {
  const [type, ending] = KINDS.find(([type]) => MediaRecorder.isTypeSupported(type)) ?? ['', 'webm']
  const before = state.step
  state.pause()
  state.goToStep(0)
  await frame()
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES), { mimeType: type, videoBitsPerSecond: BITS })
  const parts: Blob[] = []
  recorder.addEventListener('dataavailable', ({ data }) => parts.push(data))
  const stopped = new Promise((done) => recorder.addEventListener('stop', done, { once: true }))
  const { times } = state.report
  const [first, last] = [times[0], times[state.lastStep]]
  const speed = Math.max(state.speed, (last - first) / LONGEST)
  recorder.start()
  const begun = await frame()
  for (let now = begun; ; now = await frame()) {
    const time = first + ((now - begun) / 1000) * speed
    state.goToTime(Math.min(time, last))
    if (time >= last || state.ended.aborted) break
  }
  // The last position is drawn before the end.
  await frame()
  await frame()
  recorder.stop()
  await stopped
  state.goToStep(before)
  return { blob: new Blob(parts, { type: type.split(';')[0] }), ending }
}

function frame(): Promise<number> {
  return new Promise(requestAnimationFrame)
}
