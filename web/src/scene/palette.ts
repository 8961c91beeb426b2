import './palette.css'
import { css } from '../dom'

/** How many colours there are for bodies. */
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
  /** What is fixed. */
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
    /** Strength of the light that casts shadows, and how dark they are. */
    sun: number
    shadow: number
  }
  /** How opaque a tyre is. */
  glass: number
}

/** Reads the style sheet. */
export function palette(): Palette {
  return {
    view: css('--view'),
    outline: css('--outline'),
    label: css('--label'),
    bodies: Array.from({ length: TINTS }, (_, k) => css(`--body-${k}`)),
    steel: css('--steel'),
    rod: css('--rod'),
    ground: css('--ground'),
    hatch: css('--hatch'),
    rubber: css('--rubber'),
    tyre: css('--tyre'),
    driver: css('--driver'),
    chosen: css('--chosen'),
    trace: css('--trace'),
    former: css('--former'),
    grid: css('--grid'),
    gridMain: css('--grid-main'),
    axes: { x: css('--axis-x'), y: css('--axis-y'), z: css('--axis-z') },
    light: { sky: Number(css('--sky')), earth: css('--earth'), sun: Number(css('--sun')), shadow: Number(css('--shadow')) },
    glass: Number(css('--glass')),
  }
}
