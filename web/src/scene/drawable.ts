import type { Object3D, Vector3 } from 'three'
import type { Choice } from '../state'
import type { Kit } from './kit'
import type { Mechanism } from './mechanism'

/** Part under the pointer. */
export interface Part {
  kind: 'body' | 'joint' | 'coupler' | 'driver' | 'wheel' | 'distance' | 'load' | 'shape' | 'mark'
  /** Index into the report's list of its kind. */
  index: number
  name: string
  /** Description in a few words: the second line of the tip. */
  about: string
}

/**
 * One thing drawn: an object in a body's frame (0 is ground), or in the world and put in its place for every frame.
 * Its meshes of one colour are outlined as one.
 */
export interface Drawable {
  /** The body whose frame it is in; in the world where there is none. */
  body?: number
  object: Object3D
  part: Part
  /** Called before each picture of another moment. */
  follow?: (frame: Frame) => void
  /** Drawn after everything else and without outlines: arrows, traces, ghosts. */
  overlay?: boolean
  /** Size, where it is a detail that is left out when it is seen smaller than a few pixels. */
  detail?: number
}

/** The mechanism at one moment. */
export interface Frame {
  step: number
  /** A point of a body in the world. */
  at(body: number, point: Vector3): Vector3
  /** A direction of a body in the world. */
  along(body: number, direction: Vector3): Vector3
  /** True if the motion was solved at this moment. */
  visible(body: number): boolean
}

/** Drawing of a kind of thing; the choice matters to marks only. */
export type Draw = (mechanism: Mechanism, kit: Kit, choice: Choice) => Drawable[]

/** True if two are the same thing, drawn of several objects. */
export function samePart(a: Part | undefined, b: Part | undefined): boolean {
  return a !== undefined && b !== undefined && a.kind === b.kind && a.index === b.index
}
