import type { Draw } from '../drawn'

/** Every kind of thing that is drawn, one file each. */
export const draws: Draw[] = []
