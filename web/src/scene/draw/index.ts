import type { Draw } from '../drawn'
import { bodies } from './body'
import { designVelocity } from './design_velocity'
import { dimension } from './dimension'
import { drivers } from './driver'
import { formerDesign } from './former'
import { ground } from './ground'
import { fixedLink } from './ground_link'
import { meshes } from './mesh'
import { trace } from './trace'

/** Every kind of thing that a mechanism is made of, one file each. */
export const matter: Draw[] = [bodies, meshes, ground, fixedLink]

/** What is drawn to say something about it; made anew with every choice. `mechanism.former` is the design drawn dashed. */
export const marks: Draw[] = [formerDesign, trace, drivers, dimension, designVelocity]
