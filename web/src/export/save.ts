/** Offers a file to the reader under a name that any system takes. */
export function save(blob: Blob, name: string): void {
  const link = document.createElement('a')
  const url = URL.createObjectURL(blob)
  link.href = url
  link.download = fileName(name)
  link.click()
  // The browser has begun to read by then.
  setTimeout(() => URL.revokeObjectURL(url), 60_000)
}

/** Letters, digits and points stay; the rest becomes a dash. */
export function fileName(name: string): string {
  return (
    name
      .replace(/[^\p{L}\p{N}._]+/gu, '-')
      .replace(/^[-.]+|-+(?=\.|$)/g, '')
      .slice(-120) || 'hardpoint'
  )
}
