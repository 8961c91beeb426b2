import type { Draw } from '../drawable'
import { bodies } from './body'
import { nearestLines, shapes } from './clearance'
import { couplers } from './coupler'
import { designVelocity } from './design_velocity'
import { dimension } from './dimension'
import { distances } from './distance'
import { drivers } from './driver'
import { formerDesign } from './former'
import { ground } from './ground'
import { fixedLink } from './ground_link'
import { joints } from './joint'
import { loads } from './load'
import { meshes } from './mesh'
import { motors } from './motor'
import { paths } from './paths'
import { traces } from './trace'
import { wheels } from './wheel'

/** Every kind of thing that a mechanism is made of, one file each. */
export const matter: Draw[] = [bodies, meshes, ground, fixedLink, joints, couplers, wheels, distances, motors, paths]

/** Marks on the mechanism; made anew with every choice. `mechanism.former` is the design drawn dashed. */
export const marks: Draw[] = [formerDesign, traces, drivers, dimension, loads, designVelocity, shapes, nearestLines]
