import './palette.css'
import { css } from '../dom'

/** Number of colours for bodies. */
export const TINTS = 6

/** Colours of the drawing in the scheme of the moment, as the style sheet has them. */
export interface Palette {
  /** The background, and the strokes of a hatch. */
  view: string
  /** Outlines of parts. */
  outline: string
  /** Text in the view. */
  label: string
  bodies: string[]
  /** Pins and balls. */
  steel: string
  /** Massless rods and cylinders. */
  rod: string
  /** Colour of fixed parts. */
  ground: string
  /** Lines of a hatch. */
  hatch: string
  /** Belts and boots. */
  rubber: string
  tyre: string
  /** Driven joints and points. */
  driver: string
  /** Selection, handle, design velocity. */
  chosen: string
  /** Forces. */
  load: string
  /** Paths of points. */
  trace: string
  /** The former design, dashed. */
  former: string
  grid: string
  gridMain: string
  axes: { x: string; y: string; z: string }
  light: {
    /** Strength of the light from above, and its colour from below. */
    sky: number
    earth: string
    /** Intensity of the light that casts shadows, and darkness of the shadows. */
    sun: number
    shadow: number
  }
  /** Opacity of a tyre. */
  glass: number
}

/** The palette of a scheme, from custom properties of the style sheet; on the page, from its present ones. */
export function paletteOf(read = (name: string) => css(`--${name}`)): Palette {
  return {
    view: read('view'),
    outline: read('outline'),
    label: read('label'),
    bodies: Array.from({ length: TINTS }, (_, k) => read(`body-${k}`)),
    steel: read('steel'),
    rod: read('rod'),
    ground: read('ground'),
    hatch: read('hatch'),
    rubber: read('rubber'),
    tyre: read('tyre'),
    driver: read('driver'),
    chosen: read('chosen'),
    load: read('load'),
    trace: read('trace'),
    former: read('former'),
    grid: read('grid'),
    gridMain: read('grid-main'),
    axes: { x: read('axis-x'), y: read('axis-y'), z: read('axis-z') },
    light: { sky: Number(read('sky')), earth: read('earth'), sun: Number(read('sun')), shadow: Number(read('shadow')) },
    glass: Number(read('glass')),
  }
}
