/** A label with its preferred position in the picture, px. */
export interface Spot {
  x: number
  y: number
  text: string
  alert?: boolean
}

/** Place of a text: its middle, and the point that it belongs to. */
export interface LabelBox {
  spot: Spot
  x: number
  y: number
  width: number
  height: number
}

/** The room for texts, px. */
export interface Room {
  width: number
  height: number
  /** The title and the buttons are above. */
  top: number
}

/** Distances of a text from its point, px, nearest first. */
const DISTANCES = [22, 34, 48]
/** Directions that are tried, outwards from the middle first, then turned to either side by steps. */
const DIRECTIONS = 12
const TURN = (2 * Math.PI) / DIRECTIONS
/** A letter of 11 px is about so wide, and its line so high, px. */
const LETTER = 6.2
const PADDING = 10
const LINE = 16
/** Texts keep so far from the edges, px. */
const EDGE = 4

/**
 * Places texts round the middle of the picture so that none covers another or its spot; one that finds no place is left
 * out. The order is the priority. `wide` measures a text.
 */
export function placeLabels(
  spots: Spot[],
  room: Room,
  middle: { x: number; y: number },
  wide = (text: string) => LETTER * text.length,
): LabelBox[] {
  const placed: LabelBox[] = []
  for (const spot of spots) {
    const width = wide(spot.text) + PADDING
    const outwards = Math.atan2(spot.y - middle.y, spot.x - middle.x)
    const free = candidates(spot, width, outwards).find(
      (one) => inside(one, room) && !placed.some((other) => overlap(one, other)),
    )
    if (free) placed.push(free)
  }
  return placed
}

function candidates(spot: Spot, width: number, outwards: number): LabelBox[] {
  return DISTANCES.flatMap((distance) =>
    Array.from({ length: DIRECTIONS }, (_, k) => {
      const angle = outwards + (k % 2 ? 1 : -1) * Math.ceil(k / 2) * TURN
      const [right, down] = [Math.cos(angle), Math.sin(angle)]
      // Sideways the text begins where upwards its middle is.
      const x = spot.x + right * (distance + (width / 2) * Math.abs(right))
      return { spot, x, y: spot.y + down * distance, width, height: LINE }
    }),
  )
}

function inside({ x, y, width, height }: LabelBox, room: Room): boolean {
  return (
    x - width / 2 >= EDGE &&
    x + width / 2 <= room.width - EDGE &&
    y - height / 2 >= room.top &&
    y + height / 2 <= room.height - EDGE
  )
}

function overlap(a: LabelBox, b: LabelBox): boolean {
  return Math.abs(a.x - b.x) < (a.width + b.width) / 2 && Math.abs(a.y - b.y) < (a.height + b.height) / 2
}
