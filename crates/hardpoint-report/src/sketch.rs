//! Line drawing of a mechanism, from the data of its page: bars between joints, and the path of the point that
//! matters, as SVG or for other papers.

use std::collections::BTreeSet;
use std::fmt::Write;

use hardpoint::space::{Mat3, Pose, Quat, Vec3};

use crate::page::{CouplerKind, CouplerMark, JointMark, Payload};

/// Width and height of a drawing.
pub const SIZE: [f64; 2] = [300.0, 200.0];
/// Room around the mechanism.
const MARGIN: f64 = 16.0;
/// Share of the motion that has passed at the drawn position: at the start many mechanisms are stretched.
const MOMENT: f64 = 0.125;
/// Part of the mechanism's size below which a distance is no motion, and two points coincide.
const STILL: f64 = 2e-3;
/// Minimum cosine between two parallel axes.
const PARALLEL: f64 = 0.999;
/// Maximum number of points of a path or circle.
const POINTS: usize = 90;
/// Half the length of a sliding block, along its guide and across.
const BLOCK: [f64; 2] = [9.0, 5.5];
/// Direction towards the reader of mechanisms in space, and of vehicles, with y to the side of the wheel.
const READER: [f64; 3] = [0.75, -1.0, 0.55];
const VEHICLE: [f64; 3] = [0.85, 0.8, 0.42];

/// Point of the drawing, from its upper left corner.
pub type Point = [f64; 2];

/// Element of a drawing, in the order in which they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Stroke {
    /// Outline of a body: a bar, or a plate with several corners.
    Body(Vec<Point>),
    /// Straight or curved guide, or the circle of a gear or wheel.
    Guide(Vec<Point>),
    /// Path of a point over the motion.
    Path(Vec<Point>),
    /// Block on a straight guide.
    Block(Vec<Point>),
    /// Joint; true on the ground.
    Pin(Point, bool),
}

/// Drawing of the mechanism; empty if it does not move at any output time.
pub fn sketch(page: &Payload) -> Vec<Stroke> {
    let steps = page.times.values().len();
    if steps == 0 {
        return Vec::new();
    }
    Sketch::new(page, steps).strokes()
}

/// Drawing as SVG, in the colours of the page around it.
pub fn svg(strokes: &[Stroke]) -> String {
    let [width, height] = SIZE;
    let mut svg = format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"the mechanism\">");
    let list =
        |points: &[Point]| points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ");
    for stroke in strokes {
        _ = match stroke {
            Stroke::Body(points) => write!(
                svg,
                "<polygon points=\"{}\" fill=\"var(--rule)\" fill-opacity=\".55\" stroke=\"currentColor\" stroke-width=\"2.4\" stroke-linejoin=\"round\"/>",
                list(points)
            ),
            Stroke::Guide(points) => write!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"var(--muted)\" stroke-width=\"1.2\"/>",
                list(points)
            ),
            Stroke::Path(points) => write!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"var(--accent)\" stroke-width=\"1.8\"/>",
                list(points)
            ),
            Stroke::Block(points) => write!(
                svg,
                "<polygon points=\"{}\" fill=\"var(--panel)\" stroke=\"currentColor\" stroke-width=\"1.6\"/>",
                list(points)
            ),
            Stroke::Pin([x, y], grounded) => write!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.4\" fill=\"{}\" stroke=\"currentColor\" stroke-width=\"1.4\"/>",
                if *grounded { "currentColor" } else { "var(--panel)" }
            ),
        };
    }
    svg + "</svg>\n"
}

/// A mechanism with a direction of view.
struct Sketch<'a> {
    page: &'a Payload,
    steps: usize,
    /// Drawn step.
    moment: usize,
    size: f64,
    /// Directions to the right, upwards and towards the reader.
    axes: [Vec3; 3],
    is_planar: bool,
}

impl<'a> Sketch<'a> {
    fn new(page: &'a Payload, steps: usize) -> Self {
        let mut sketch = Self {
            page,
            steps,
            moment: (MOMENT * (steps - 1) as f64).round() as usize,
            size: 0.0,
            axes: [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)],
            is_planar: false,
        };
        let points = sketch.extent();
        let Some(first) = points.first() else { return sketch };
        sketch.size = points.iter().fold(0.0, |size: f64, p| size.max((*p - *first).norm()));
        let normal = sketch.normal(&points);
        sketch.is_planar = normal.is_some();
        let towards = normal.unwrap_or_else(|| match &page.wheels[..] {
            [] => vector(READER),
            [wheel, others @ ..] => {
                let y = sketch.world(wheel.centre.body, wheel.centre.at, 0).y;
                // One wheel is seen from inboard, so that it is behind its knuckle.
                let side = if others.is_empty() && y > 0.0 { -VEHICLE[1] } else { VEHICLE[1] };
                Vec3::new(VEHICLE[0], side, VEHICLE[2])
            }
        });
        let towards = towards * (1.0 / towards.norm());
        let vertical =
            if towards.z.abs() > PARALLEL { Vec3::new(0.0, 1.0, 0.0) } else { Vec3::new(0.0, 0.0, 1.0) };
        let right = vertical.cross(towards);
        let right = right * (1.0 / right.norm());
        sketch.axes = [right, towards.cross(right), towards];
        sketch
    }

    /// Position of a point of a body in the world; NaN where it is unknown.
    fn world(&self, body: usize, at: [f64; 3], step: usize) -> Vec3 {
        let pose = self.pose(body, step);
        pose.r + pose.rot * vector(at)
    }

    /// Direction of a body in the world.
    fn along(&self, body: usize, direction: [f64; 3], step: usize) -> Vec3 {
        self.pose(body, step).rot * vector(direction)
    }

    fn pose(&self, body: usize, step: usize) -> Pose {
        let poses = self.page.bodies[body].poses.values();
        let number = |k: usize| poses.get(7 * step + k).map_or(f64::NAN, |x| f64::from(*x));
        let unknown = Vec3::new(f64::NAN, f64::NAN, f64::NAN);
        Pose {
            r: vector([0, 1, 2].map(number)),
            rot: Quat::from_array([3, 4, 5, 6].map(number))
                .map_or(Mat3 { cols: [unknown; 3] }, Quat::rotation),
        }
    }

    /// Steps of a path, the last one included.
    fn path_steps(&self) -> impl Iterator<Item = usize> + use<> {
        let (last, parts) = (self.steps - 1, (self.steps - 1).min(POINTS));
        (0..=parts).map(move |k| (k * last).checked_div(parts).unwrap_or(0))
    }

    /// All points of the bodies over the motion.
    fn extent(&self) -> Vec<Vec3> {
        let mut points = Vec::new();
        for (body, track) in self.page.bodies.iter().enumerate() {
            for at in &track.skeleton {
                let places = self.path_steps().map(|step| self.world(body, *at, step));
                points.extend(places.filter(|p| p.norm().is_finite()));
            }
        }
        points
    }

    /// Normal of the plane of a planar mechanism, towards the reader: x and z point to the viewer, y away.
    fn normal(&self, points: &[Vec3]) -> Option<Vec3> {
        if !self.page.wheels.is_empty() {
            return None;
        }
        let hinges = self.page.joints.iter().filter(|joint| joint.kind == "revolute");
        let mut axes = hinges.filter_map(|joint| self.axis(joint));
        let normal = axes.next()?;
        if !axes.all(|axis| axis.dot(normal).abs() > PARALLEL) {
            return None;
        }
        // Each point stays in its own plane.
        let lifted = |body: usize, at: [f64; 3]| {
            let first = self.world(body, at, 0);
            self.path_steps()
                .any(|step| (self.world(body, at, step) - first).dot(normal).abs() > STILL * self.size)
        };
        let bodies = self.page.bodies.iter().enumerate();
        let is_flat = !points.is_empty()
            && bodies
                .map(|(b, track)| (b, &track.skeleton))
                .all(|(b, all)| !all.iter().any(|at| lifted(b, *at)));
        let [x, y, z] = normal.to_array();
        let most = x.abs().max(y.abs()).max(z.abs());
        let sign = if z.abs() == most {
            z.signum()
        } else if y.abs() == most {
            -y.signum()
        } else {
            x.signum()
        };
        is_flat.then(|| normal * sign)
    }

    /// Axis of a joint in the world, at the drawn position.
    fn axis(&self, joint: &JointMark) -> Option<Vec3> {
        let axis = self.along(joint.body_i, joint.axis?, self.moment);
        axis.norm().is_finite().then_some(axis)
    }

    fn strokes(&self) -> Vec<Stroke> {
        let paths = self.paths();
        let guides = self.guides();
        let bodies = self.bodies();
        let pins = self.pins();
        // The motion of bodies may be wider than what is drawn.
        let drawn = paths.iter().chain(&guides).chain(bodies.iter().map(|(_, points)| points));
        let all: Vec<Vec3> = drawn.flatten().copied().chain(pins.iter().map(|(at, _)| *at)).collect();
        let Some(view) = View::of(&all, self.axes) else { return Vec::new() };
        let line = |points: &[Vec3]| points.iter().map(|p| view.place(*p)).collect::<Vec<Point>>();
        let mut strokes: Vec<Stroke> = guides.iter().map(|points| Stroke::Guide(line(points))).collect();
        strokes.extend(bodies.iter().map(|(_, points)| Stroke::Body(hull(line(points)))));
        strokes.extend(paths.iter().map(|points| Stroke::Path(line(points))));
        strokes.extend(self.blocks(&view));
        strokes.extend(pins.into_iter().map(|(at, grounded)| Stroke::Pin(view.place(at), grounded)));
        strokes
    }

    /// Corners of every body, from the farthest to the nearest, with their depth; rods between two places as well.
    fn bodies(&self) -> Vec<(f64, Vec<Vec3>)> {
        let mut bodies = Vec::new();
        let mut add = |points: Vec<Vec3>| {
            let is_known = points.iter().all(|p| p.norm().is_finite());
            if is_known && points.iter().any(|p| (*p - points[0]).norm() > STILL * self.size) {
                let depth = points.iter().map(|p| p.dot(self.axes[2])).sum::<f64>() / points.len() as f64;
                bodies.push((depth, points));
            }
        };
        for (body, track) in self.page.bodies.iter().enumerate().skip(1) {
            add(track.skeleton.iter().map(|at| self.world(body, *at, self.moment)).collect());
        }
        for joint in self.page.joints.iter().filter(|joint| joint.curve.is_none() && joint.slide.is_none()) {
            add(self.ends(joint).to_vec());
        }
        bodies.sort_by(|a, b| a.0.total_cmp(&b.0));
        bodies
    }

    fn ends(&self, joint: &JointMark) -> [Vec3; 2] {
        [(joint.body_i, joint.at_i), (joint.body_j, joint.at_j)]
            .map(|(body, at)| self.world(body, at, self.moment))
    }

    /// Guides of sliding joints, curves, circles of gears and wheels, and measured distances.
    fn guides(&self) -> Vec<Vec<Vec3>> {
        let mut guides = Vec::new();
        for joint in &self.page.joints {
            if let Some(curve) = &joint.curve {
                let closing = curve.points.first().filter(|_| curve.closed);
                let points = curve.points.iter().chain(closing);
                guides.push(points.map(|at| self.world(joint.body_i, *at, self.moment)).collect());
            } else if joint.slide.is_some() {
                guides.push(self.rail(joint));
            }
        }
        for coupler in &self.page.couplers {
            guides.extend(self.pitch_circles(coupler));
        }
        for wheel in &self.page.wheels {
            let axis = self.along(wheel.centre.body, wheel.axis, self.moment);
            guides.push(circle(
                self.world(wheel.centre.body, wheel.centre.at, self.moment),
                axis,
                wheel.radius,
            ));
        }
        for distance in &self.page.distances {
            let ends =
                [&distance.from, &distance.to].map(|place| self.world(place.body, place.at, self.moment));
            guides.push(ends.to_vec());
        }
        guides.retain(|points| points.iter().all(|p| p.norm().is_finite()));
        guides
    }

    /// Path of the sliding body along its guide, where the guide is at the drawn position.
    fn rail(&self, joint: &JointMark) -> Vec<Vec3> {
        let on_guide = self.path_steps().map(|step| {
            let guide = self.pose(joint.body_i, step);
            let at = guide.rot.transpose_mul(self.world(joint.body_j, joint.at_j, step) - guide.r);
            self.world(joint.body_i, at.to_array(), self.moment)
        });
        let start = self.world(joint.body_i, joint.at_i, self.moment);
        let mut points: Vec<Vec3> = on_guide.filter(|p| p.norm().is_finite()).collect();
        if joint.slide.is_some_and(|slide| slide.along.is_some()) {
            points.push(start);
        }
        points
    }

    /// Pitch circles of two gears or pulleys on parallel shafts, and that of a rack's pinion.
    fn pitch_circles(&self, coupler: &CouplerMark) -> Vec<Vec<Vec3>> {
        let shafts = coupler.terms.iter().filter(|term| term.turns).filter_map(|term| {
            let joint = &self.page.joints[term.joint];
            Some((self.ends(joint)[0], self.axis(joint)?, term.coefficient))
        });
        let shafts: Vec<(Vec3, Vec3, f64)> = shafts.collect();
        let radii = match (coupler.kind, &shafts[..]) {
            (CouplerKind::Belt | CouplerKind::Rack, _) if shafts.len() == coupler.sizes.len() => {
                coupler.sizes.clone()
            }
            (CouplerKind::Gear, [(a, axis, p), (b, other, q)]) if axis.dot(*other).abs() > PARALLEL => {
                let apart = *b - *a;
                let apart = (apart - *axis * apart.dot(*axis)).norm();
                // In outer mesh the wheels turn against each other: both factors have one sign.
                let q = q * axis.dot(*other).signum();
                let sum = if p * q > 0.0 { p.abs() + q.abs() } else { (p.abs() - q.abs()).abs() };
                if sum > 0.0 { vec![apart * p.abs() / sum, apart * q.abs() / sum] } else { Vec::new() }
            }
            // Without parallel shafts that are drawn there is no circle.
            (CouplerKind::Belt | CouplerKind::Rack | CouplerKind::Gear, _) => Vec::new(),
            (CouplerKind::Bevel | CouplerKind::Screw | CouplerKind::Linear, _) => Vec::new(),
        };
        shafts.iter().zip(radii).map(|((at, axis, _), radius)| circle(*at, *axis, radius)).collect()
    }

    /// Paths of the measured points that move, the one that is plotted first alone if there is one.
    fn paths(&self) -> Vec<Vec<Vec3>> {
        /// More paths would hide the mechanism.
        const MOST: usize = 3;
        let path = |body: usize, at: [f64; 3]| -> Vec<Vec3> {
            self.path_steps()
                .map(|step| self.world(body, at, step))
                .filter(|p| p.norm().is_finite())
                .collect()
        };
        let moves = |path: &Vec<Vec3>| path.iter().any(|p| (*p - path[0]).norm() > 5.0 * STILL * self.size);
        let first = self.page.plots.first().and_then(|plot| plot.y.first().copied()).or(self.page.first);
        let plotted = first.and_then(|k| self.page.quantities.get(k)).map(|quantity| &quantity.name);
        let plotted = plotted.and_then(|name| name.rsplit_once('.')).map(|(point, _)| point);
        let points = self.page.quantities.iter().filter(|quantity| quantity.group == "point");
        let points: BTreeSet<&str> = points.filter_map(|q| Some(q.name.rsplit_once('.')?.0)).collect();
        let (mut named, mut measured) = (Vec::new(), Vec::new());
        for (body, track) in self.page.bodies.iter().enumerate().skip(1) {
            for (at, label) in track.skeleton.iter().zip(&track.labels) {
                if label.split(", ").any(|name| Some(name) == plotted) {
                    named.push(path(body, *at));
                } else if label.split(", ").any(|name| points.contains(name)) {
                    measured.push(path(body, *at));
                }
            }
        }
        named.retain(moves);
        // A point on several bodies has one path.
        named.truncate(1);
        if named.is_empty() {
            let wheels = self.page.wheels.iter().map(|wheel| path(wheel.centre.body, wheel.centre.at));
            named = measured.into_iter().chain(wheels).filter(moves).take(MOST).collect();
        }
        named
    }

    /// Joints at points, true on the ground.
    fn pins(&self) -> Vec<(Vec3, bool)> {
        let mut pins: Vec<(Vec3, bool)> = Vec::new();
        for joint in self.page.joints.iter().filter(|joint| joint.curve.is_none()) {
            let ends = self.ends(joint);
            let is_block = joint.slide.is_some_and(|slide| slide.along.is_some());
            for (at, body) in ends.into_iter().zip([joint.body_i, joint.body_j]).skip(usize::from(is_block)) {
                let grounded = body == 0
                    || (!is_block && (ends[0] - ends[1]).norm() <= STILL * self.size && joint.body_i == 0);
                match pins.iter_mut().find(|(other, _)| (*other - at).norm() <= STILL * self.size) {
                    Some((_, is_grounded)) => *is_grounded |= grounded,
                    None if at.norm().is_finite() => pins.push((at, grounded)),
                    None => {}
                }
            }
        }
        pins
    }

    /// Blocks of sliding joints, along their guides.
    fn blocks(&self, view: &View) -> Vec<Stroke> {
        let block = |joint: &JointMark| {
            let along = self.along(joint.body_i, joint.slide?.along?, self.moment);
            let at = self.ends(joint)[1];
            let ahead = at + along * (0.1 * self.size);
            let [[x, y], [to_x, to_y]] = [view.place(at), view.place(ahead)];
            let length = (to_x - x).hypot(to_y - y);
            // A guide towards the reader has no direction in the drawing.
            let [u, v] = if length > 1.0 { [(to_x - x) / length, (to_y - y) / length] } else { [1.0, 0.0] };
            let corner = |a: f64, b: f64| {
                [x + a * BLOCK[0] * u - b * BLOCK[1] * v, y + a * BLOCK[0] * v + b * BLOCK[1] * u]
            };
            let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            corners.iter().flatten().all(|x| x.is_finite()).then_some(Stroke::Block(corners))
        };
        self.page.joints.iter().filter_map(block).collect()
    }
}

/// Parallel projection that fits the drawing.
struct View {
    axes: [Vec3; 3],
    middle: Point,
    scale: f64,
}

impl View {
    fn of(points: &[Vec3], axes: [Vec3; 3]) -> Option<Self> {
        let range = |axis: Vec3| {
            let along = points.iter().map(|p| p.dot(axis)).filter(|x| x.is_finite());
            along.fold(None, |all: Option<[f64; 2]>, x| {
                Some(all.map_or([x, x], |[a, b]| [a.min(x), b.max(x)]))
            })
        };
        let (across, upright) = (range(axes[0])?, range(axes[1])?);
        let [width, height] = [across, upright].map(|[low, high]| high - low);
        let rooms = [(width, SIZE[0]), (height, SIZE[1])].map(|(size, room)| (room - 2.0 * MARGIN) / size);
        let scale = rooms[0].min(rooms[1]);
        let middle = [across, upright].map(|[low, high]| 0.5 * (low + high));
        scale.is_finite().then_some(Self { axes, middle, scale })
    }

    fn place(&self, at: Vec3) -> Point {
        let x = 0.5 * SIZE[0] + (at.dot(self.axes[0]) - self.middle[0]) * self.scale;
        let y = 0.5 * SIZE[1] - (at.dot(self.axes[1]) - self.middle[1]) * self.scale;
        [x, y]
    }
}

fn vector([x, y, z]: [f64; 3]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Circle about an axis of any length.
fn circle(centre: Vec3, axis: Vec3, radius: f64) -> Vec<Vec3> {
    let across =
        if axis.x.abs() < axis.y.abs() { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
    let u = axis.cross(across);
    let u = u * (1.0 / u.norm());
    let v = axis.cross(u) * (1.0 / axis.norm());
    let point = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / POINTS as f64).sin_cos();
        centre + (u * cos + v * sin) * radius
    };
    (0..=POINTS).map(point).collect()
}

/// Convex hull of points (Andrew's monotone chain).
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turns_left =
        |a: Point, b: Point, c: Point| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0;
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if turns_left(a, b, p) {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = chain(&mut points.iter().copied());
    lower.append(&mut chain(&mut points.iter().rev().copied()));
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_corners_alone() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let inside = [[1.0, 1.0], [1.0, 0.0], [0.0, 2.0]];
        assert_eq!(hull([&square[..], &inside].concat()), square);
        assert_eq!(hull(vec![[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), [[0.0, 1.0], [1.0, 0.0]]);
    }

    #[test]
    fn a_circle_is_about_its_axis() {
        let (centre, axis) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 3.0, 4.0));
        for point in circle(centre, axis, 2.0) {
            let arm = point - centre;
            assert!((arm.norm() - 2.0).abs() < 1e-12 && arm.dot(axis).abs() < 1e-12, "{point:?}");
        }
    }
}
