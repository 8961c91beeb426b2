import { Matrix4, Vector3 } from 'three'

/** A point of a plane. */
export type Flat = [x: number, y: number]

/** Axes in a plane of space. */
export class Basis {
  readonly y: Vector3

  /** `x` need not be perpendicular to `normal`; it is made so. */
  constructor(
    readonly origin: Vector3,
    readonly normal: Vector3,
    readonly x: Vector3 = across(normal),
  ) {
    this.normal = normal.clone().normalize()
    this.x = square(x, this.normal)
    this.y = this.normal.clone().cross(this.x)
  }

  to(point: Vector3): Flat {
    const from = point.clone().sub(this.origin)
    return [from.dot(this.x), from.dot(this.y)]
  }

  from([x, y]: Flat, height = 0): Vector3 {
    return this.origin
      .clone()
      .addScaledVector(this.x, x)
      .addScaledVector(this.y, y)
      .addScaledVector(this.normal, height)
  }

  matrix(): Matrix4 {
    return new Matrix4().makeBasis(this.x, this.y, this.normal).setPosition(this.origin)
  }
}

/** A unit vector perpendicular to `axis`. */
export function across(axis: Vector3): Vector3 {
  const unit = axis.clone().normalize()
  return square(Math.abs(unit.z) < 0.9 ? new Vector3(0, 0, 1) : new Vector3(1, 0, 0), unit)
}

/** `direction` without its part along the unit vector `axis`, of length 1; any square one where nothing is left. */
export function square(direction: Vector3, axis: Vector3): Vector3 {
  const rest = direction.clone().addScaledVector(axis, -direction.dot(axis))
  return rest.length() > 1e-6 * direction.length() ? rest.normalize() : across(axis)
}

/** The corners of the convex hull, counter-clockwise. */
export function hull(points: Flat[]): Flat[] {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1])
  const turn = (o: Flat, a: Flat, b: Flat) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
  const half = (list: Flat[]) => {
    const chain: Flat[] = []
    for (const point of list) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], point) <= 0) chain.pop()
      chain.push(point)
    }
    chain.pop()
    return chain
  }
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.slice().reverse())]
}

/** Points on a circle for an outline that looks round. */
const ROUND = 40

/** The outline round circles given as x, y, radius. */
export function round(circles: [x: number, y: number, radius: number][]): Flat[] {
  return hull(
    circles.flatMap(([x, y, radius]) =>
      Array.from({ length: ROUND }, (_, k): Flat => {
        const angle = (2 * Math.PI * k) / ROUND
        return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)]
      }),
    ),
  )
}

/** A convex outline moved inwards; nothing where it is too narrow for that. */
export function inset(outline: Flat[], by: number): Flat[] {
  let rest = outline
  outline.forEach((a, k) => {
    const b = outline[(k + 1) % outline.length]
    const length = Math.hypot(b[0] - a[0], b[1] - a[1])
    if (length === 0) return
    const side = (p: Flat) => ((p[0] - a[0]) * (a[1] - b[1]) + (p[1] - a[1]) * (b[0] - a[0])) / length - by
    rest = rest.flatMap((p, i): Flat[] => {
      const q = rest[(i + 1) % rest.length]
      const [before, after] = [side(p), side(q)]
      const share = before / (before - after)
      return [
        ...(before >= 0 ? [p] : []),
        ...(before * after < 0 ? [[p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])] as Flat] : []),
      ]
    })
  })
  return rest.length < 3 ? [] : rest
}

/** Area of an outline. */
export function area(outline: Flat[]): number {
  const twice = outline.reduce((sum, a, k) => {
    const b = outline[(k + 1) % outline.length]
    return sum + a[0] * b[1] - b[0] * a[1]
  }, 0)
  return Math.abs(twice / 2)
}

/** The two of the points that are farthest from each other. */
export function farthest<T>(points: T[], distance: (a: T, b: T) => number): [T, T] {
  let best: [T, T] = [points[0], points[0]]
  let maximum = -1
  points.forEach((a, k) => {
    for (const b of points.slice(k + 1)) {
      const separation = distance(a, b)
      if (separation > maximum) [maximum, best] = [separation, [a, b]]
    }
  })
  return best
}
