import { EdgesGeometry, type Object3D, ShapeGeometry, Shape, Vector2, Vector3 } from 'three'
import { ConvexGeometry } from 'three/addons/geometries/ConvexGeometry.js'
import { Basis, farthest, hull, square } from '../flat'
import { FOLD, foldAxis, shaftAxis } from '../hinge'
import type { Kit } from '../kit'
import type { Mechanism } from '../mechanism'

/** Points nearer to a line, and to a plane, than these parts of a body's length are in it. */
const STRAIGHT = 0.02
const FLAT = 0.03
/** Radius of a single point's disc. */
const POINT = 2.4
/** Radii of a rod at its ends, and the greatest as a part of its length. */
const ROD = { thick: 1.15, thin: 0.98, slender: 0.12 }
/**
 * A flat bar: half width, that of one whose hinges are across one another, half thickness, how much narrower in the
 * middle, its eyes.
 */
const BAR = { width: 1.45, twisted: 2.3, thickness: 0.62, waist: 0.28, eye: 1.75, height: 1.9, end: 1.3, sections: 16 }
/** Cosine of the least angle between hinges that are across one another. */
const TWISTED = 0.98
/** A folded plate: thickness, radius of its eyes, and distance of its edge from the pins. */
const FOLDED = { thickness: 0.9, eye: 1.5, clear: 2 }
/**
 * Tubes of a plate: at free corners, at the hinge, along the hinge; how opaque its web is with three corners and with
 * more.
 */
const PLATE = { corner: 0.85, hinge: 1.15, along: 0.75, web: 0.38, platform: 0.6 }
/** Edges and corners of a hull, and its opacity. */
const HULL = { edge: 0.55, corner: 0.95, opacity: 0.45 }

/** A body of a spatial mechanism by its points: disc, rod or bar, plate, hull. */
export function spatialBody(mechanism: Mechanism, kit: Kit, body: number): Object3D[] {
  const points = mechanism.shapePoints(body)
  if (points.length === 0) return []
  if (points.length === 1) return single(mechanism, kit, body, points[0])
  const [a, b] = farthest(points, (p, q) => p.distanceTo(q))
  const shaft = shaftAxis(mechanism, body)
  if (shaft) return onShaft(mechanism, kit, body, points, shaft)
  const fold = foldAxis(mechanism, body)
  if (fold) return folding(mechanism, kit, body, a, b, fold)
  const along = b.clone().sub(a)
  const length = along.length()
  along.divideScalar(length)
  const aside = (p: Vector3) => p.clone().sub(a).cross(along)
  const widest = points.reduce((maximum, p) => (aside(p).length() > aside(maximum).length() ? p : maximum))
  if (aside(widest).length() < STRAIGHT * length) return straight(mechanism, kit, body, a, b)
  const normal = aside(widest).normalize()
  if (points.every((p) => Math.abs(p.clone().sub(a).dot(normal)) < FLAT * length))
    return plate(mechanism, kit, body, points, normal)
  return solid(kit, body, points)
}

/** A shaft as far as the body's points reach along it, and an arm to each of them that is off it. */
function onShaft(mechanism: Mechanism, kit: Kit, body: number, points: Vector3[], axis: Vector3): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const [at] = mechanism.placesOf(body)
  const on = (point: Vector3) => at.clone().addScaledVector(axis, point.clone().sub(at).dot(axis))
  const away = points.filter((point) => !mechanism.same(point, at))
  return away.flatMap((point) => {
    const foot = on(point)
    const arm =
      foot.distanceTo(point) > s
        ? [kit.cylinder(foot, point, ROD.thin * s, ROD.thin * s, colour), kit.ball(point, ROD.thick * s, colour)]
        : []
    return [
      kit.cylinder(at, foot, ROD.thick * s, ROD.thick * s, colour),
      kit.ball(foot, 1.5 * ROD.thick * s, colour),
      ...arm,
    ]
  })
}

/**
 * A plate between two parallel hinges; where both bodies of a hinge are plates or one is ground, their eyes take turns
 * along the pin.
 */
function folding(mechanism: Mechanism, kit: Kit, body: number, a: Vector3, b: Vector3, axis: Vector3): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const unit = b.clone().sub(a).normalize()
  const middle = a.clone().lerp(b, 0.5)
  const plate = kit.brick(
    middle,
    unit,
    axis,
    [Math.max(s, a.distanceTo(b) - 2 * FOLDED.clear * s), 2 * FOLD.half * s, FOLDED.thickness * s],
    colour,
  )
  const eyes = mechanism.jointsOf(body).flatMap(({ joint, at }) => {
    const inner = joint.body_i === 0 || joint.body_j === 0 || joint.body_i === body
    const outer = (FOLD.half + FOLD.inner) / 2
    const spans = inner
      ? [[0, 2 * FOLD.inner]]
      : [
          [-outer, FOLD.half - FOLD.inner],
          [outer, FOLD.half - FOLD.inner],
        ]
    const inwards = middle.clone().sub(at).normalize()
    return spans.flatMap(([aside, width]) => {
      const eye = at.clone().addScaledVector(axis, aside * s)
      const tab = eye.clone().addScaledVector(inwards, (FOLDED.clear / 2) * s)
      return [
        kit.disc(eye, axis, FOLDED.eye * s, 0.94 * width * s, colour),
        kit.brick(tab, inwards, axis, [FOLDED.clear * s, 0.94 * width * s, FOLDED.thickness * s], colour, {}),
      ]
    })
  })
  return [plate, ...eyes]
}

function single(mechanism: Mechanism, kit: Kit, body: number, point: Vector3): Object3D[] {
  const { report } = mechanism
  const slides = report.joints.flatMap((_, k) => (mechanism.slideOf(k)?.block === body ? [k] : []))
  const coupled = report.couplers.some(({ terms }) =>
    terms.some(({ joint }) => [report.joints[joint].body_i, report.joints[joint].body_j].includes(body)),
  )
  if (slides.length > 0 || coupled) return []
  const axis = axisAt(mechanism, body, point) ?? mechanism.into(body, mechanism.up)
  return [kit.disc(point, axis, POINT * kit.unit, 0.8 * POINT * kit.unit, kit.body(body))]
}

/** Axis of the hinge at a place of a body. */
function axisAt(mechanism: Mechanism, body: number, at: Vector3): Vector3 | undefined {
  const hinges = mechanism
    .jointsOf(body)
    .filter(({ joint }) => joint.kind === 'revolute' || joint.kind === 'cylindrical')
  return hinges.find((hinge) => hinge.axis && mechanism.same(hinge.at, at))?.axis
}

/**
 * A tapered rod; with a hinge perpendicular to it at an end a flat bar, twisted from one hinge's axis to the other's.
 */
function straight(mechanism: Mechanism, kit: Kit, body: number, a: Vector3, b: Vector3): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const length = a.distanceTo(b)
  const unit = b.clone().sub(a).divideScalar(length)
  const hinge = (at: Vector3) => {
    const axis = axisAt(mechanism, body, at)
    return axis && Math.abs(axis.dot(unit)) < 0.5 * axis.length() ? square(axis, unit) : undefined
  }
  const [first, last] = [hinge(a), hinge(b)]
  if (!first && !last) {
    const thick = Math.min(ROD.thick * s, ROD.slender * length)
    const thin = (ROD.thin / ROD.thick) * thick
    return [kit.cylinder(a, b, thick, thin, colour), kit.ball(a, thick, colour), kit.ball(b, thin, colour)]
  }
  const from = first ?? last!
  const to = (last ?? first!).clone()
  // A bar turns by less than a quarter either way: an axis has no sense.
  if (from.dot(to) < 0) to.negate()
  // Between two links the eyes are next to each other on the pin, like the bars.
  const [low, high] = [a, b].map((at) => (first && last ? eyeOf(mechanism, body, at, s) : at))
  const width = first && last && from.dot(to) < TWISTED ? BAR.twisted : BAR.width
  const section = (t: number) => {
    const thick = from.clone().lerp(to, t).normalize()
    const wide = thick.clone().cross(unit)
    const waist = width * s * (1 - BAR.waist * Math.sin(Math.PI * t))
    return [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([x, y]) =>
      low
        .clone()
        .lerp(high, t)
        .addScaledVector(wide, x * waist)
        .addScaledVector(thick, y * BAR.thickness * s),
    )
  }
  const sections = Array.from({ length: BAR.sections + 1 }, (_, k) => section(k / BAR.sections))
  const faces = sections.slice(1).flatMap((end, k) =>
    [0, 1, 2, 3].flatMap((i) => {
      const [start, j] = [sections[k], (i + 1) % 4]
      return [start[i], end[j], start[j], start[i], end[i], end[j]]
    }),
  )
  const eye = (at: Vector3, axis: Vector3 | undefined) =>
    axis ? kit.disc(at, axis, BAR.eye * s, BAR.height * s, colour) : kit.ball(at, BAR.end * s, colour)
  const edges = [0, 1, 2, 3].map((i) =>
    kit.line(
      sections.map((corners) => corners[i]),
      kit.palette.outline,
      0.9,
      { opacity: 0.45 },
    ),
  )
  return [
    kit.triangles(faces, colour, { open: true, facets: true }),
    ...edges,
    eye(low, axisAt(mechanism, body, a)),
    eye(high, axisAt(mechanism, body, b)),
  ]
}

/** Middle of a link's eye on the hinge at a place: beside the other link's; between cheeks that are ground's. */
function eyeOf(mechanism: Mechanism, body: number, at: Vector3, s: number): Vector3 {
  const hinge = mechanism
    .jointsOf(body)
    .find(({ joint, at: own }) => joint.kind === 'revolute' && mechanism.same(own, at))
  if (!hinge?.axis || hinge.joint.body_i === 0 || hinge.joint.body_j === 0 || hinge.joint.hinge) return at
  const side = hinge.joint.body_i === body ? -1 : 1
  return at.clone().addScaledVector(hinge.axis.clone().normalize(), (side * BAR.height * s) / 2)
}

/** Tubes round a web; the edge on a hinge is straight, the others taper away from it. */
function plate(mechanism: Mechanism, kit: Kit, body: number, points: Vector3[], normal: Vector3): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const basis = new Basis(points[0], normal)
  const flat = points.map((point) => basis.to(point))
  const outline = hull(flat)
  const corners = outline.map((corner) => points[flat.indexOf(corner)])
  const onHinge = hinged(mechanism, body, points)
  const pieces = corners.flatMap((a, k): Object3D[] => {
    const b = corners[(k + 1) % corners.length]
    const both = onHinge.includes(a) && onHinge.includes(b)
    const radius = (p: Vector3) => (both ? PLATE.along : onHinge.includes(p) ? PLATE.hinge : PLATE.corner) * s
    return [kit.cylinder(a, b, radius(a), radius(b), colour), kit.ball(a, PLATE.hinge * s, colour)]
  })
  const inner = points.filter((point) => !corners.includes(point))
  const middle = corners.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(corners.length)
  const held = inner.flatMap((point) => {
    const nearest = [...corners].sort((p, q) => p.distanceTo(point) - q.distanceTo(point)).slice(0, 2)
    const lean = point.distanceTo(middle) < 2 * s ? [] : nearest
    return [
      ...lean.map((corner) => kit.cylinder(point, corner, 0.75 * s, 0.75 * s, colour)),
      kit.ball(point, PLATE.hinge * s, colour),
    ]
  })
  const pose = basis.matrix()
  const web = () => new ShapeGeometry(new Shape(outline.map(([x, y]) => new Vector2(x, y)))).applyMatrix4(pose)
  const opacity = outline.length > 3 ? PLATE.platform : PLATE.web
  return [...pieces, ...held, kit.keyed(`web ${outline} ${pose.elements}`, web, colour, { opacity })]
}

/** The points of a body that lie on one of its hinges, where that is two or more. */
function hinged(mechanism: Mechanism, body: number, points: Vector3[]): Vector3[] {
  const near = 2e-3 * mechanism.size
  const lists = mechanism
    .jointsOf(body)
    .filter(({ joint, axis }) => joint.kind === 'revolute' && axis)
    .map(({ at, axis }) => points.filter((point) => point.clone().sub(at).cross(axis!).length() < near))
  return lists.find((list) => list.length > 1) ?? []
}

/** A convex hull with edges and corners. */
function solid(kit: Kit, body: number, points: Vector3[]): Object3D[] {
  const s = kit.unit
  const colour = kit.body(body)
  const geometry = new ConvexGeometry(points)
  const ends = new EdgesGeometry(geometry, 1)
  const { position } = ends.attributes
  const corner = (k: number) => new Vector3().fromBufferAttribute(position, k)
  const edges = Array.from({ length: position.count / 2 }, (_, k) =>
    kit.cylinder(corner(2 * k), corner(2 * k + 1), HULL.edge * s, HULL.edge * s, colour),
  )
  ends.dispose()
  return [
    kit.mesh(geometry, colour, { opacity: HULL.opacity, facets: true }),
    ...edges,
    ...points.map((point) => kit.ball(point, HULL.corner * s, colour)),
  ]
}
