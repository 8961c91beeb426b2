import type { Draw } from '../drawn'
import { bodies } from './body'
import { ground } from './ground'
import { fixedLink } from './ground_link'

/** Every kind of thing that a mechanism is made of, one file each. */
export const matter: Draw[] = [bodies, ground, fixedLink]

/** What is drawn to say something about it; made anew with every choice. `mechanism.former` is the design drawn dashed. */
export const marks: Draw[] = []
