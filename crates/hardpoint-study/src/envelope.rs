//! Envelope of a shape: the space that it sweeps over motions and grids, seen from a body, as a closed surface.
//!
//! The envelope is the union of the shape at many poses: where the least of its signed distances is not positive. The
//! poses are doubled until those between them reach no farther beyond the surface than half of the error that is
//! permitted, and the cells of the surface are halved until its triangles deviate by no more than the other half. Both
//! are measured from the triangles to the envelope and from points of the envelope to the triangles: parts that are
//! thinner than a cell have no triangles.

mod request;
mod surface;

use std::ops::ControlFlow;

use hardpoint::model::{Grid, Model};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Analysis, Run, SweptShape};
use hardpoint::space::Vec3;
use hardpoint::topology::{Formulation, TopologyError};

pub use request::{Overrides, Request, Sweep};
pub use surface::Triangles;
use surface::{LeastOf, surface};

use super::evaluation::StudyCost;
use super::grid::each_half_row;
use super::request::RequestError;

/// Maximum number of cells that the surface passes: a file of about 300 MB.
const MOST_CELLS: usize = 1_000_000;
/// Poses between those of an envelope reach beyond it by this fraction of the amount by which these reach beyond the
/// envelope of half of them: it is of second order in their spacing.
const QUARTER: f64 = 0.25;
/// Default of the permitted error, as a fraction of the extent of the shape.
const ERROR: f64 = 1.0 / 200.0;
/// Maximum number of poses.
const MOST_POSES: usize = 20_000;
/// Cells along the diameter of the shape in the first surface.
const FIRST_CELLS: f64 = 24.0;

/// Reason why a shape has no envelope.
#[derive(Clone, Debug)]
pub enum EnvelopeError {
    /// The mechanism cannot be driven.
    Topology(TopologyError),
    /// No position was reached; the first stop.
    NotReached(Option<Box<Stop>>),
    /// No cell of the smallest size is inside the shape.
    TooThin(RequestError),
    /// The caller ended the study.
    Interrupted,
}

impl From<TopologyError> for EnvelopeError {
    fn from(error: TopologyError) -> Self {
        Self::Topology(error)
    }
}

/// Envelope of a shape.
#[derive(Clone, Debug)]
pub struct Envelope {
    /// The surface, in the frame of the body from which it is seen.
    pub surface: Triangles,
    /// Number of poses.
    pub poses: usize,
    /// Permitted error, m.
    pub error: f64,
    /// Distance by which the poses between half of them reach beyond the envelope of that half, m. All poses between
    /// those of the envelope reach beyond it by about a quarter of that.
    pub between_poses: f64,
    /// False if the permitted error was not reached with the maximum numbers of poses and cells.
    pub is_within_error: bool,
    /// Stops of motions that ended early: the envelope is that of the positions that were reached.
    pub stops: Vec<Stop>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Least distance from a shape at all poses, less the margin.
struct Union<'a> {
    swept: &'a SweptShape,
    margin: f64,
}

impl LeastOf for Union<'_> {
    fn part(&self, k: usize, p: Vec3) -> f64 {
        self.swept.distance(k, p) - self.margin
    }

    fn zero(&self, k: usize, p: Vec3) -> Vec3 {
        self.swept.surface_point(k, p, self.margin)
    }

    fn corners(&self, k: usize) -> Vec<Vec3> {
        self.swept.corners(k)
    }
}

impl Union<'_> {
    /// The least of all parts.
    fn least(&self, p: Vec3) -> f64 {
        (0..self.swept.len()).map(|k| self.part(k, p)).fold(f64::INFINITY, f64::min)
    }

    /// A cube around everything, whose corner is no round multiple of a cell from any pose: symmetric shapes do not
    /// touch corners of cells.
    fn cube(&self) -> (Vec3, f64) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for k in 0..self.swept.len() {
            let (centre, radius) = self.swept.ball(k);
            for (axis, x) in centre.to_array().into_iter().enumerate() {
                low[axis] = low[axis].min(x - radius - self.margin);
                high[axis] = high[axis].max(x + radius + self.margin);
            }
        }
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let [x, y, z] = [0, 1, 2].map(|k| low[k] - size * [0.0117, 0.0131, 0.0143][k]);
        (Vec3::new(x, y, z), size * 1.03)
    }
}

/// Computes the envelope of a shape at the design with variable k at `design[k]`. `more` is called regularly; if it
/// returns false, the study ends.
///
/// # Errors
/// An [`EnvelopeError`].
pub fn envelope(
    model: &Model,
    formulation: Formulation,
    design: &[f64],
    request: &Request,
    more: &(dyn Fn() -> bool + Sync),
) -> Result<Envelope, EnvelopeError> {
    let mut cost = StudyCost { designs: 1, ..StudyCost::default() };
    let poses_of = |halvings: u32, cost: &mut StudyCost| {
        let mut gathered =
            Gathered { swept: SweptShape::new(request.shape, request.relative_to), stops: vec![] };
        for sweep in &request.sweeps {
            gathered.add(model, formulation, design, sweep, halvings, cost, more)?;
        }
        if !more() {
            return Err(EnvelopeError::Interrupted);
        }
        if gathered.swept.is_empty() {
            return Err(EnvelopeError::NotReached(gathered.stops.into_iter().next().map(Box::new)));
        }
        Ok(gathered)
    };
    let of = |swept: &SweptShape, cell: f64| {
        let union = Union { swept, margin: request.margin };
        let made = surface(&union, swept.len(), union.cube(), cell, MOST_CELLS, more);
        if more() { Ok(made) } else { Err(EnvelopeError::Interrupted) }
    };
    let mut found = poses_of(0, &mut cost)?;
    let extent = 2.0 * (found.swept.ball(0).1 + request.margin);
    let error = request.error.unwrap_or(extent * ERROR);
    let (half, first_cell) = (0.5 * error, extent / FIRST_CELLS);
    let (mut between, mut enough, mut made) = (f64::INFINITY, false, None);
    for halvings in 1.. {
        let finer = poses_of(halvings, &mut cost)?;
        let union = Union { swept: &found.swept, margin: request.margin };
        let beyond = |surface: &Triangles| {
            surface.vertices.iter().chain(&surface.samples).map(|p| union.least(*p)).fold(0.0, f64::max)
        };
        made = of(&finer.swept, first_cell)?;
        between = made.as_ref().map_or(f64::INFINITY, beyond);
        let grew = finer.swept.len() > found.swept.len();
        found = finer;
        if QUARTER * between <= half || !grew {
            enough = QUARTER * between <= half;
            break;
        }
        if found.swept.len() > MOST_POSES {
            break;
        }
    }
    // The last coarse surface is the first candidate.
    let (mut cell, mut surface) = (first_cell, Triangles::default());
    while let Some(finer) = made {
        surface = finer;
        if surface.deviation <= half {
            break;
        }
        cell *= 0.5;
        made = of(&found.swept, cell)?;
    }
    if surface.triangles.is_empty() {
        let name = &model.shapes[request.shape.0].name;
        return Err(EnvelopeError::TooThin(RequestError::model(
            format!("`{name}` is thinner than the smallest cells of its envelope"),
            "add a distance around it (margin)",
        )));
    }
    Ok(Envelope {
        is_within_error: enough && surface.deviation <= half,
        surface,
        poses: found.swept.len(),
        error,
        between_poses: between,
        stops: found.stops,
        cost,
    })
}

/// Poses of a shape, and the stops of motions that ended early.
struct Gathered {
    swept: SweptShape,
    stops: Vec<Stop>,
}

impl Gathered {
    #[expect(clippy::too_many_arguments, reason = "the parts of one motion")]
    fn add(
        &mut self,
        model: &Model,
        formulation: Formulation,
        design: &[f64],
        sweep: &Sweep,
        halvings: u32,
        cost: &mut StudyCost,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), TopologyError> {
        match sweep {
            Sweep::Motion(case) => {
                let own = case.map_or_else(|| model.clone(), |case| model.in_case(case));
                let times = halved(&own.times, halvings);
                let moved = Model { times, metrics: Vec::new(), ..own };
                let analysis = Analysis::with(&moved, formulation)?;
                let go_on = |_| if more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
                let run = Run::new().at(design).without_measures().without_sensitivities().progress(go_on);
                let solution = analysis.solve(run);
                cost.motions += 1;
                cost.steps += solution.motion.len();
                let steps = 0..solution.motion.len();
                self.swept.add(&analysis, design, &solution.motion, steps);
                self.note(solution.stop.as_ref());
            }
            Sweep::Grid(grid) => {
                let values = grid.values.each_ref().map(|values| halved(values, halvings));
                let finer = Grid { values, ..grid.clone() };
                each_half_row(model, &finer, formulation, design, more, |half| {
                    cost.motions += 1;
                    cost.steps += half.solution.motion.len();
                    let reached = half.steps().map(|(_, k)| k);
                    let steps: Vec<usize> = reached.filter(|k| *k < half.solution.motion.len()).collect();
                    self.swept.add(half.analysis, design, &half.solution.motion, steps.into_iter());
                    self.note(half.solution.stop.as_ref());
                })?;
            }
        }
        Ok(())
    }

    fn note(&mut self, stop: Option<&Stop>) {
        self.stops.extend(stop.filter(|s| !matches!(s.kind, StopKind::Interrupted)).cloned());
    }
}

/// Values with intermediate ones: each interval is halved this often.
fn halved(values: &[f64], halvings: u32) -> Vec<f64> {
    let pieces = 1_usize << halvings;
    let between = |pair: &[f64]| {
        let [a, b] = [pair[0], pair[1]];
        (0..pieces).map(move |k| a + (b - a) * k as f64 / pieces as f64).collect::<Vec<f64>>()
    };
    let mut all: Vec<f64> = values.windows(2).flat_map(between).collect();
    all.extend(values.last());
    all
}
