import type { Quantity } from './report'

/** Meaning and sign of the measures that have a fixed name; `docs/measures.md` has their formulas. */
const MEASURES: Record<string, string> = {
  toe: 'angle of the wheel to the direction of travel, seen from above; positive is toe-in',
  camber: 'lean of the wheel to the vertical; positive if its top leans outboard',
  camber_front: "camber as the vehicle's front view shows it",
  steer_angle: 'rotation of the wheel about the vertical; positive to the left, on both sides',
  caster: 'lean of the steering axis in side view; positive if its top is rearward',
  kingpin_inclination: 'lean of the steering axis in front view; positive if its top is inboard',
  scrub_radius: 'offset of the steering axis at the ground; positive if the contact point is outboard of it',
  spindle_offset: 'offset of the steering axis at the wheel centre; positive if the centre is outboard of it',
  caster_trail: 'distance at the ground by which the steering axis is in front of the contact point',
  mechanical_trail: "distance of the contact point from the steering axis, in the wheel's side view",
  wheel_travel: 'vertical travel of the wheel centre; positive in bump',
  wheel_recession: 'rearward displacement of the wheel centre',
  half_track: 'lateral distance of the contact point from the middle of the vehicle',
  half_track_change: 'change of the half track; positive outboard',
  track: 'lateral distance between both contact points',
  bump_steer: 'slope of toe over wheel travel; positive is toe-in in bump',
  bump_camber: 'slope of camber over wheel travel',
  bump_recession: 'slope of wheel recession over wheel travel',
  bump_scrub: 'slope of the half track over wheel travel',
  roll_centre_height: 'height above the ground of the point about which the body rolls',
  roll_centre_height_geometric: 'roll centre height by the instant centre of the wheel carrier',
  motion_ratio: 'travel of the spring per wheel travel',
  swing_arm_front: 'distance of the instant centre inboard of the contact point, in front view',
  swing_arm_side: 'distance of the instant centre in front of the contact point, in side view',
  anti_dive: 'share of the load transfer in braking that the front links carry; 1 is all of it',
  anti_rise: 'share of the load transfer in acceleration that the front links carry; 1 is all of it',
  anti_lift: 'share of the load transfer in braking that the rear links carry; 1 is all of it',
  anti_squat: 'share of the load transfer in acceleration that the rear links carry; 1 is all of it',
  ackermann: '1 for Ackermann steering, 0 for parallel wheels',
  ackermann_error: 'steer angle by which the outer wheel exceeds that of Ackermann steering',
  total_toe: 'sum of both toe angles; positive is toe-in',
  turning_radius: "radius of the outer contact point's path",
  transmission_angle: 'angle between coupler and follower; best at 90°, poor near 0° and 180°',
}

/** Terms of the page, for the help. */
export const TERMS: [term: string, meaning: string][] = [
  ['design variable', 'a number of the design that you can change, such as a coordinate of a hardpoint'],
  ['hardpoint', 'a named point of the design, such as the centre of a ball joint'],
  ['sensitivity', 'change of a quantity per unit of a variable: the slope at the current design'],
  ['design position', 'the position that the model describes, with all drivers at zero; for a wheel: ride height'],
  ['re-assembled', 'the change would open a joint; other links turn or move a little so that it closes again'],
  ['metric', 'one number of a curve: its maximum, its range, or its distance from a target'],
  ['margin', 'distance of a position from a singular one, where the mechanism locks: 1 is best, 0 is singular'],
]

/**
 * Kind of a measure: `toe`, `wheel_travel`. A measure of a general type, such as the position of a wheel centre, has no
 * kind but its type; its name then says which: `toe` of `front.left.toe` and of `left_toe`.
 */
export function kindOf({ kind, name }: Pick<Quantity, 'kind' | 'name'>): string {
  if (kind in MEASURES) return kind
  return name.slice(name.lastIndexOf('.') + 1).replace(/^(front_|rear_)?(left|right)_/, '')
}

/** Explanation of a quantity by its kind; undefined for a measure of the model's own. */
export function aboutQuantity(quantity: Quantity): string | undefined {
  return MEASURES[kindOf(quantity)]
}
