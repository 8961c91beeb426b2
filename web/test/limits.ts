/**
 * Time limits, in milliseconds. No result may depend on how fast or how busy the machine is: a limit is there only so
 * that what hangs ends, and names itself, while the rest is still reported. Each is many times what the slowest takes
 * on a quiet machine.
 */

/**
 * One wait: for an element, for a state of the page, for the browser. What hangs is named by this before its test ends.
 */
export const WAIT = 120_000
/** One test, or what is done before and after it. */
export const TEST = 300_000
