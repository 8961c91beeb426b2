import type { Disposable } from './graphics'

/**
 * Geometries, materials and textures by keys that name all that they depend on. A changed design takes what it has in
 * common with the one before, so that only what differs is made anew; what nobody uses any more is freed.
 */
export class Stock {
  readonly #all = new Map<string, { one: Disposable; users: number }>()

  /** Object of a key, for one more user; `make` is called where nobody has it. The key implies the type. */
  take<T extends Disposable>(key: string, make: () => T): T {
    let found = this.#all.get(key)
    if (!found) {
      found = { one: make(), users: 0 }
      this.#all.set(key, found)
    }
    found.users++
    return found.one as T
  }

  /** Removes a user of a key, and frees the object after its last user. */
  release(key: string): void {
    const found = this.#all.get(key)
    if (!found || --found.users > 0) return
    found.one.dispose()
    this.#all.delete(key)
  }
}
