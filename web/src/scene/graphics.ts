import { WebGLRenderer } from 'three'

/** Object with memory on the graphics card. */
export interface Disposable {
  dispose(): void
}

/**
 * Graphics context of views. Those of pages that follow one another share it, so that programs for the graphics card
 * are compiled once: in software they take as long as the rest of a page.
 */
export class Graphics {
  readonly renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true })
  #unused: Disposable[] = []

  /** Frees objects after the next picture, which then finds programs that it has in common with them. */
  free(...unused: Disposable[]): void {
    this.#unused.push(...unused)
  }

  /** Frees what the picture that was just drawn does not show. */
  drawn(): void {
    for (const one of this.#unused.splice(0)) one.dispose()
  }
}
