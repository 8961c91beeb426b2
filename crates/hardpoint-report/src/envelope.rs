//! Envelopes of shapes: facts and sentences.

use hardpoint::model::{Dimension, Model};
use hardpoint_file::Units;
use hardpoint_study::envelope::{Envelope, EnvelopeStop, Request, Sweep};

use crate::figures::{count, rounded, unit};
use crate::record::record;

/// Digits of lengths and volumes in sentences.
const DIGITS: usize = 5;

record! {
    /// The space that a shape sweeps.
    pub EnvelopeFact::of(model: &Model, units: Units, request: &Request, found: &Envelope) {
        let in_units = |power: i32, x: f64| {
            let per_unit = units.from_si(Dimension::LENGTH, 1.0);
            x * per_unit.powi(power)
        };
        let name_of = |sweep: &Sweep| match sweep {
            Sweep::Motion(case) => case.map_or("motion".into(), |case| model.cases[case.0].name.clone()),
            Sweep::Grid(grid) => grid.name.clone(),
        };
    }
    /// Name of the shape.
    shape: String = model.shapes[request.shape.0].name.clone();
    /// Name of the body from which it is seen.
    relative_to: String = model.bodies[request.relative_to.0].name.clone();
    /// Names of the cases and grids over which it moves.
    sweeps: Vec<String> = request.sweeps.iter().map(name_of).collect();
    /// Unit of lengths.
    unit: String = unit(units, Dimension::LENGTH);
    /// Enclosed volume, unit^3.
    volume: f64 = in_units(3, found.surface.volume());
    /// Area of the surface, unit^2.
    area: f64 = in_units(2, found.surface.area());
    /// Distance that was added around the shape.
    margin: f64 = in_units(1, request.margin);
    /// Permitted error.
    permitted: f64 = in_units(1, found.error);
    /// Largest distance between the triangles and the envelope, at their centres, the middles of their edges, and
    /// points of the envelope.
    deviation: f64 = in_units(1, found.surface.deviation);
    /// Estimate of the distance by which positions between these reach beyond the envelope.
    between_poses: f64 = in_units(1, found.between_poses);
    /// True if both are within the permitted error.
    within_error: bool = found.is_within_error;
    /// True if the user ended the study before the permitted error was reached.
    interrupted: bool = found.interrupted;
    /// Number of positions of the shape.
    poses: usize = found.poses;
    /// Number of triangles.
    triangles: usize = found.surface.triangles.len();
    /// Reasons why motions ended early: the envelope is that of the positions reached.
    stops: Vec<String> = found.stops.iter().map(|found| ended(model, found)).collect();
}

fn ended(model: &Model, EnvelopeStop { stop, end }: &EnvelopeStop) -> String {
    let happened = stop.happened(model);
    end.map_or_else(
        || happened.clone(),
        |end| format!("{happened}; the envelope has the motion up to t = {} s", rounded(end, DIGITS)),
    )
}

impl EnvelopeFact {
    /// The result in sentences.
    pub fn sentences(&self) -> Vec<String> {
        let Self { shape, relative_to, unit, .. } = self;
        let length = |x: f64| format!("{} {unit}", rounded(x, DIGITS));
        let mut lines = vec![
            format!(
                "{shape} over {}, seen from {relative_to}: {} {unit}^3, surface {} {unit}^2",
                self.sweeps.join(", "),
                rounded(self.volume, DIGITS),
                rounded(self.area, DIGITS)
            ),
            format!(
                "  {} of the shape, {}",
                count(self.poses, "position"),
                count(self.triangles, "triangle")
            ),
            format!(
                "  error: triangles within {} of the envelope; positions between these reach beyond it by about {}",
                length(self.deviation),
                length(self.between_poses)
            ),
        ];
        if self.margin > 0.0 {
            lines.push(format!("  with {} added around the shape", length(self.margin)));
        }
        if !self.within_error {
            let why = if self.interrupted {
                ": interrupted"
            } else {
                " with the largest numbers of triangles and positions"
            };
            lines.push(format!("  the permitted error of {} is NOT reached{why}", length(self.permitted)));
        }
        lines.extend(self.stops.iter().map(|stop| format!("  ended early: {stop}")));
        lines
    }
}
