import type { Draw } from '../drawn'

/** Every kind of thing that a mechanism is made of, one file each. */
export const matter: Draw[] = []

/** What is drawn to say something about it; made anew with every choice. `mechanism.former` is the design drawn dashed. */
export const marks: Draw[] = []
