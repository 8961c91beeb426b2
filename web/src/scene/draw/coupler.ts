import type { CouplerMark } from '../../payload'
import type { Drawable, Part } from '../drawable'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'
import { Train } from '../train'
import { belt } from './coupler_belt'
import { bevels } from './coupler_bevel'
import { gears } from './coupler_gear'
import { rack } from './coupler_rack'
import { shafts } from './coupler_shaft'

/** Drawing of a coupler. */
export interface CouplerContext {
  mechanism: Mechanism
  kit: Kit
  train: Train
  coupler: CouplerMark
  index: number
}
export type DrawCoupler = (coupled: CouplerContext) => Omit<Drawable, 'part'>[]

const KINDS: Record<string, DrawCoupler> = { gear: gears, bevel: bevels, rack, belt }

/** Gears, belts and racks, then the shafts through them; other relations have nothing to see. */
export function couplers(mechanism: Mechanism, kit: Kit): Drawable[] {
  const train = new Train(mechanism)
  const drawn = mechanism.report.couplers.flatMap((coupler, index) => {
    const draw = Object.hasOwn(KINDS, coupler.kind) ? KINDS[coupler.kind] : undefined
    const part = couplerPart(mechanism, coupler, index)
    return (draw?.({ mechanism, kit, train, coupler, index }) ?? []).map((one) => ({ ...one, part }))
  })
  return [...drawn, ...shafts(mechanism, kit, train)]
}

function couplerPart({ report }: Mechanism, { name, kind, sizes, terms }: CouplerMark, index: number): Part {
  const joined = terms.map(({ joint }) => report.joints[joint]?.name ?? '').join(' and ')
  const unit = report.units.length
  const figures =
    kind === 'gear' || kind === 'bevel'
      ? `, ${sizes.join(' and ')} teeth`
      : sizes.length > 0
        ? `, ${sizes.length > 1 ? 'radii' : 'radius'} ${sizes.join(' and ')} ${unit}`
        : ''
  return { kind: 'coupler', index, name, about: `${kind}${figures}, of ${joined}` }
}
