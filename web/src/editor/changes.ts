/** Replaces the text between two positions. */
export interface Change {
  from: number
  to: number
  insert: string
}

/**
 * Edits that turn one text into another, both in lines: the part between their common beginning and end, line by line
 * where both have the same number of lines there. A line break counts one.
 */
export function changes(before: readonly string[], after: readonly string[]): Change[] {
  const minimum = Math.min(before.length, after.length)
  let head = 0
  while (head < minimum && before[head] === after[head]) head++
  let tail = 0
  while (tail < minimum - head && before.at(-1 - tail) === after.at(-1 - tail)) tail++
  const [old, made] = [before.slice(head, before.length - tail), after.slice(head, after.length - tail)]
  let at = before.slice(0, head).reduce((sum, line) => sum + line.length + 1, 0)
  if (old.length === made.length) {
    return old.flatMap((line, k) => {
      const from = at
      at += line.length + 1
      return line === made[k] ? [] : [within(line, made[k], from)]
    })
  }
  // With a line more at either side there is no line break to be made or lost at the ends of the text.
  if (head > 0) (at -= before[head - 1].length + 1), old.unshift(before[head - 1]), made.unshift(before[head - 1])
  else if (tail > 0) old.push(before[before.length - tail]), made.push(before[before.length - tail])
  return [within(old.join('\n'), made.join('\n'), at)]
}

function within(before: string, after: string, at: number): Change {
  const minimum = Math.min(before.length, after.length)
  let head = 0
  while (head < minimum && before[head] === after[head]) head++
  let tail = 0
  while (tail < minimum - head && before.at(-1 - tail) === after.at(-1 - tail)) tail++
  return { from: at + head, to: at + before.length - tail, insert: after.slice(head, after.length - tail) }
}
