//! Shapes of a solved design: which pairs touch, and whether a pair may pass through each other on the path to another
//! design.

use hardpoint::Analysis;
use hardpoint::model::{BodyId, Model, Shape, ShapeId, ShapeKind};
use hardpoint::motion::Motion;
use hardpoint::run::{ShapeDistance, ShapeOnBodies};
use hardpoint::space::Vec3;

/// Shapes of a solved design over its motion.
#[derive(Debug)]
pub(crate) struct ShapesOfDesign {
    /// Values of the variables, SI.
    pub design: Vec<f64>,
    pairs: Vec<[ShapeId; 2]>,
    /// Distances per pair, at the output times.
    distances: Vec<Vec<ShapeDistance>>,
    /// Points per output time and shape that bound its displacement, global, m.
    points: Vec<Vec<Vec<Vec3>>>,
    /// Least width per shape, m: a shape that crosses it moves farther. 0 where it is not known.
    widths: Vec<f64>,
}

impl ShapesOfDesign {
    /// Shapes of a design with its motion.
    pub fn new(analysis: &Analysis<'_>, pairs: &[[ShapeId; 2]], design: &[f64], motion: &Motion) -> Self {
        let model = analysis.model();
        let shapes = analysis.shapes_on_bodies(design);
        let both = || model.shapes.iter().zip(&shapes);
        let on_bodies: Vec<Vec<(BodyId, Vec3)>> = both().map(|(s, on)| guides(model, s, on)).collect();
        let at = |k: usize| {
            let states = motion.at(k);
            let point = |(body, p): &(BodyId, Vec3)| states.body(body.0).pose().point(*p);
            on_bodies.iter().map(|points| points.iter().map(point).collect()).collect()
        };
        Self {
            design: design.to_vec(),
            pairs: pairs.to_vec(),
            distances: analysis.distances(design, motion, pairs, 0..motion.len()),
            points: (0..motion.len()).map(at).collect(),
            widths: both().map(|(s, on)| width(s, on)).collect(),
        }
    }

    /// Pairs that are apart at all output times, by number.
    pub fn pairs_apart(&self) -> Vec<usize> {
        (0..self.pairs.len()).filter(|pair| self.first_contact(*pair).is_none()).collect()
    }

    /// First output time at which a pair touches, s.
    pub fn first_contact(&self, pair: usize) -> Option<f64> {
        self.distances[pair].iter().find(|at| at.distance[0] < 0.0).map(|at| at.time)
    }

    /// True if a pair that is apart in both designs may have passed through each other between them. A step by less
    /// than the distances at both ends cannot touch, and one by less than the shapes are wide can only graze.
    pub fn may_pass(&self, next: &Self, pair: usize) -> bool {
        let shapes = self.pairs[pair];
        let known = shapes.map(|s| self.widths[s.0]).into_iter().filter(|width| *width > 0.0);
        let width = known.reduce(f64::min).unwrap_or(0.0);
        let ends = self.distances[pair].iter().zip(&next.distances[pair]);
        let mut times = ends.zip(self.points.iter().zip(&next.points));
        times.any(|((a, b), (from, to))| {
            let moved =
                shapes.map(|s| from[s.0].iter().zip(&to[s.0]).map(|(p, q)| *q - *p).collect::<Vec<Vec3>>());
            relative_step(&moved) > width.max(a.distance[0] + b.distance[0])
        })
    }
}

/// Bound of the step of one shape relative to the other, from the displacements of their points, m.
fn relative_step([a, b]: &[Vec<Vec3>; 2]) -> f64 {
    let mean = a.iter().fold(Vec3::ZERO, |sum, d| sum + *d) * (1.0 / a.len().max(1) as f64);
    let largest = |all: &[Vec3]| all.iter().map(|d| (*d - mean).norm()).fold(0.0, f64::max);
    largest(a) + largest(b)
}

/// Points on the bodies of a shape that bound its displacement: centres, ends and corners, ends of an axis that is as
/// long as the shape is wide, or the corners of a box around a mesh.
fn guides(model: &Model, shape: &Shape, on: &ShapeOnBodies) -> Vec<(BodyId, Vec3)> {
    if let ShapeKind::Mesh { body, surface } = &shape.kind {
        let bound = |of: fn(f64, f64) -> f64| {
            let both = |a: Vec3, b: Vec3| Vec3::new(of(a.x, b.x), of(a.y, b.y), of(a.z, b.z));
            surface.vertices().iter().copied().reduce(both)
        };
        let (Some(low), Some(high)) = (bound(f64::min), bound(f64::max)) else { return Vec::new() };
        let ends = [low, high];
        let corners = ends.map(|a| ends.map(|b| ends.map(|c| (*body, Vec3::new(a.x, b.y, c.z)))));
        return corners.into_iter().flatten().flatten().collect();
    }
    let Some((body, first)) = on.points.first().copied() else { return Vec::new() };
    let along = on.axis.or_else(|| {
        let (other, last) = on.points.last().copied()?;
        if other == body { (last - first).unit() } else { None }
    });
    // A plane has no ends.
    let is_plane = matches!(shape.kind, ShapeKind::Plane { .. });
    let reach = if is_plane { model.size() } else { on.radius.max(on.half_width) };
    let tips = along.into_iter().flat_map(|axis| [-reach, reach].map(|by| (body, first + axis * by)));
    on.points.iter().copied().chain(tips).collect()
}

/// Least width of a shape, m; 0 for a mesh, which may be hollow.
fn width(shape: &Shape, on: &ShapeOnBodies) -> f64 {
    let length = || match on.points[..] {
        // Ends on two bodies are never nearer than the bodies.
        [(a, p), (b, q)] if a == b => (q - p).norm(),
        _ => f64::INFINITY,
    };
    match &shape.kind {
        ShapeKind::Sphere { .. } | ShapeKind::Capsule { .. } | ShapeKind::Ring { .. } => 2.0 * on.round,
        ShapeKind::Cylinder { .. } => length().min(2.0 * on.radius),
        ShapeKind::Tyre { .. } => 2.0 * on.radius.min(on.half_width),
        ShapeKind::Plane { .. } => f64::INFINITY,
        ShapeKind::Hull { facets, .. } => {
            let place = |k: u32| on.points[k as usize].1;
            let across = |[a, b, c]: &[u32; 3]| {
                let normal = (place(*b) - place(*a)).cross(place(*c) - place(*a)).unit()?;
                let depth = |(_, p): &(BodyId, Vec3)| normal.dot(place(*a) - *p);
                Some(on.points.iter().map(depth).fold(0.0, f64::max))
            };
            facets.iter().filter_map(across).reduce(f64::min).unwrap_or(0.0) + 2.0 * on.round
        }
        ShapeKind::Mesh { .. } => 0.0,
    }
}
