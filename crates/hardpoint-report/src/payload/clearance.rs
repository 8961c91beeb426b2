//! Shapes of bodies, and their distances over the motion.

use hardpoint::joint::Quantity as Kind;
use hardpoint::model::{ClearanceId, MeasureKind, OutputSource, Shape, ShapeKind};
use hardpoint::motion::Motion;
use hardpoint::run::{Clearances, PairCurve, ShapeDistance, ShapeOnBodies};
use hardpoint::space::Vec3;

use crate::page::{BodyPlace, ClearanceMark, ClearanceMarks, Curve, PairTrack, ShapeMark};

use crate::summary::RunStatus;

use super::{Compose, Request};

/// Number of output times above which minima and contacts are not located for a page: each pass solves all of them.
const MOST_LOCATED: usize = 5000;

/// Minima and contacts of all clearances, or a sentence on the reason why the page has none; `None` for a model
/// without clearances.
pub(super) fn located(request: &Request<'_>) -> Option<Result<Clearances, String>> {
    let model = request.analysis.model();
    let because = |reason: String| {
        Some(Err(format!(
            "Minima and contacts of the clearances are not located, because {reason}; the page shows the distances \
             at the output times."
        )))
    };
    if model.clearances.is_empty() {
        None
    } else if request.summary.status != RunStatus::Complete {
        because("the motion is incomplete".into())
    } else if model.times.len() > MOST_LOCATED {
        because(format!("the motion has more than {MOST_LOCATED} output times"))
    } else {
        Some(Ok(request.analysis.clearances(&[])))
    }
}

impl Compose<'_> {
    /// Shapes and their distances, if the model has shapes.
    pub(super) fn clearance(&self, located: Option<&Clearances>) -> Option<ClearanceMarks> {
        let model = self.analysis.model();
        (!model.shapes.is_empty()).then(|| ClearanceMarks {
            shapes: self.shapes(&[]),
            clearances: (0..model.clearances.len()).map(|c| self.clearance_mark(ClearanceId(c))).collect(),
            pairs: self.pairs(&[], &self.solution.motion, &self.steps, located),
        })
    }

    fn clearance_mark(&self, ClearanceId(c): ClearanceId) -> ClearanceMark {
        let model = self.analysis.model();
        let clearance = &model.clearances[c];
        let measures = |source: OutputSource| match source {
            OutputSource::Measure(m) => {
                model.measures[m].kind == MeasureKind::Clearance { of: ClearanceId(c) }
            }
            OutputSource::Point(..) => false,
        };
        let outputs = self.solution.measured.outputs.iter().enumerate();
        let length = |x: f64| self.units.from_si(Kind::Length, x);
        let first = clearance.pairs.first().and_then(|pair| pair.min);
        let same = clearance.pairs.iter().all(|pair| pair.min == first);
        ClearanceMark {
            name: clearance.name.clone(),
            quantities: outputs.filter(|(_, o)| measures(o.source)).map(|(m, _)| m).collect(),
            min: first.filter(|_| same).map(length),
            beyond: clearance.beyond.map(length),
        }
    }

    /// All shapes of a design, in the frames of their bodies.
    pub(super) fn shapes(&self, design: &[f64]) -> Vec<ShapeMark> {
        let model = self.analysis.model();
        let length = |x: f64| self.units.from_si(Kind::Length, x);
        let mark = |(shape, on): (&Shape, ShapeOnBodies)| {
            let (vertices, triangles) = match &shape.kind {
                ShapeKind::Mesh { surface, .. } => (surface.vertices(), surface.triangles()),
                ShapeKind::Hull { facets, .. } => (&[][..], &facets[..]),
                ShapeKind::Sphere { .. }
                | ShapeKind::Capsule { .. }
                | ShapeKind::Ring { .. }
                | ShapeKind::Cylinder { .. }
                | ShapeKind::Tyre { .. }
                | ShapeKind::Plane { .. } => (&[][..], &[][..]),
            };
            let place = |&(body, at): &(hardpoint::model::BodyId, Vec3)| BodyPlace {
                body: body.0,
                at: self.length(at),
            };
            ShapeMark {
                name: shape.name.clone(),
                kind: shape.kind_name(),
                body: shape.bodies(model)[0].0,
                places: on.points.iter().map(place).collect(),
                axis: on.axis.map(Vec3::to_array),
                radius: length(on.radius),
                half_width: length(on.half_width),
                round: length(on.round),
                vertices: vertices.iter().flat_map(|v| self.length(*v)).collect(),
                triangles: triangles.iter().flatten().map(|k| f64::from(*k)).collect(),
            }
        };
        model.shapes.iter().zip(self.analysis.shapes_on_bodies(design)).map(mark).collect()
    }

    /// Distances at these times of a motion of a design; `located` has the minima and contacts, if they were located.
    /// The curves have a value for each shown step; the last ones may be missing in `steps`.
    pub(super) fn pairs(
        &self,
        design: &[f64],
        motion: &Motion,
        steps: &[usize],
        located: Option<&Clearances>,
    ) -> Vec<PairTrack> {
        let model = self.analysis.model();
        if model.clearances.is_empty() {
            return Vec::new();
        }
        let rounds: Vec<f64> = self.analysis.shapes_on_bodies(design).iter().map(|s| s.round).collect();
        let length = |x: f64| self.units.from_si(Kind::Length, x);
        let track = |PairCurve { shapes, curve }: PairCurve| {
            let has = |c: &usize| model.clearances[*c].pairs.iter().any(|pair| pair.shapes == shapes);
            let at = |k: usize| curve.get(k);
            let rounds = shapes.map(|s| rounds[s.0]);
            let shown = 0..self.steps.len();
            let points = shown.clone().flat_map(|k| {
                let points = at(k).map(|near| surface_points(near, rounds).map(|p| self.length(p)));
                points.unwrap_or([[f64::NAN; 3]; 2]).concat()
            });
            let found = located.and_then(|all| all.pairs.iter().find(|pair| pair.shapes == shapes));
            let minima = found.iter().flat_map(|pair| &pair.minima);
            PairTrack {
                shapes: shapes.map(|s| s.0),
                clearances: (0..model.clearances.len()).filter(has).collect(),
                distance: shown.map(|k| at(k).map_or(f64::NAN, |near| length(near.distance[0]))).collect(),
                points: points.collect::<Curve>(),
                touching: found.map(|pair| pair.intervals()),
                minima: minima.map(|m| [m.at.time, length(m.at.distance[0])]).collect(),
            }
        };
        self.analysis.nearest_pairs(design, motion, steps).into_iter().map(track).collect()
    }
}

/// Nearest points of two surfaces from those of their cores. Where the cores meet, there is no direction between them,
/// and the points are those of the cores.
fn surface_points(near: &ShapeDistance, rounds: [f64; 2]) -> [Vec3; 2] {
    let [p, q] = near.points;
    let apart = (q - p).norm();
    if near.cores_meet || apart == 0.0 {
        return near.points;
    }
    // The distance of the cores is negative where they overlap: the way out is then opposite.
    let sign = (near.distance[0] + rounds[0] + rounds[1]).signum();
    let n = (q - p) * (sign / apart);
    [p + n * rounds[0], q - n * rounds[1]]
}
