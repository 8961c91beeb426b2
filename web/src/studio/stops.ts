import { number } from '../format'

/** Name of the design in messages of the engine; on a page it is the one in hand. */
const SUBJECT = /^the changed design: /
const LOCKS = /^the mechanism (?:cannot move beyond|locks at) t = ([\d.]+(?:e-?\d+)?) s/
/** Digits of the time at which a mechanism locks. */
const DIGITS = 3

/** Reason why a design is not the requested one, or why its motion ends early, from the engine's message. */
export function stopReason(message: string, isShort: boolean): string {
  const words = message
    .replace(SUBJECT, '')
    .replace(LOCKS, (_, time) => `Locks at t = ${number(Number(time), DIGITS)} s`)
  const sentence = words.charAt(0).toUpperCase() + words.slice(1)
  return isShort ? `${sentence}; shown is the last position that works` : sentence
}
