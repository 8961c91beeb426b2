/** Prefix of the keys in the browser's store. */
const PREFIX = 'hardpoint.'

/** Choice of the reader that outlives the page; undefined without one, or where the browser stores nothing. */
export function preference(name: string): string | undefined {
  try {
    return localStorage.getItem(PREFIX + name) ?? undefined
  } catch {
    return undefined
  }
}

export function prefer(name: string, value: string): void {
  try {
    localStorage.setItem(PREFIX + name, value)
  } catch {
    // A browser that stores nothing only forgets.
  }
}
