import type { Draw } from '../drawn'
import { designVelocity } from './design_velocity'
import { dimension } from './dimension'
import { drivers } from './driver'
import { formerDesign } from './former'
import { meshes } from './mesh'
import { trace } from './trace'

/** Every kind of thing that a mechanism is made of, one file each. */
export const matter: Draw[] = [meshes]

/** What is drawn to say something about it; made anew with every choice. `mechanism.former` is the design drawn dashed. */
export const marks: Draw[] = [formerDesign, trace, drivers, dimension, designVelocity]
