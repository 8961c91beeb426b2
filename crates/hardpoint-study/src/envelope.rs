//! Envelope of a shape: the space that it sweeps over motions and grids, seen from a body, as a closed surface.
//!
//! The envelope is the union of the shape at many poses: where the least of its signed distances is not positive. The
//! first poses are so close that no driver moves far between two of them, and that the shape travels by a part of its
//! size only. Then further ones are added between all of them, until what these reach beyond the surface leaves no more
//! than half of the error that is permitted. The cells of the surface are halved until its triangles deviate by no more
//! than the other half: measured from the triangles to the envelope and from points of the envelope to the triangles,
//! since parts that are thinner than a cell have no triangles.

mod request;

use std::cell::Cell;
use std::ops::ControlFlow;

use hardpoint::joint::Quantity;
use hardpoint::model::{Grid, Model};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Analysis, Run, SweptShape};
use hardpoint::space::Vec3;
use hardpoint::topology::{Formulation, TopologyError};

pub use hardpoint_search::Triangles;
use hardpoint_search::{LeastOf, surface};
pub use request::{Overrides, Request, Sweep};

use super::evaluation::StudyCost;
use super::grid::each_half_row;
use super::request::RequestError;

/// Maximum number of cells that the surface passes: a file of about 300 MB.
const MOST_CELLS: usize = 1_000_000;
/// Maximum number of distances from cores or triangles that are evaluated for all surfaces: about a minute.
const MOST_DISTANCES: usize = 600_000_000;
/// Poses between those of an envelope reach beyond it by at most this part of the amount by which the last ones that
/// were added reached beyond the others, where the shape is round: scallops are of second order in the spacing.
const OF_ROUND: f64 = 0.375;
/// The same where the shape has edges: what a corner leaves out between two poses is of first order.
const OF_SHARP: f64 = 1.25;
/// Growth, as a part of the radius around the core, above which edges that are rounded by it are sharp.
const SHARP: f64 = 0.1;
/// Maximum travel of the shape's points between the first poses, as a fraction of its radius.
const TRAVEL: f64 = 0.3;
/// Maximum travel of a driver of a grid between the first poses, rad or sizes of the mechanism.
const DRIVER_TRAVEL: f64 = 0.15;
/// Maximum number of passes in which poses are added between the first ones.
const MOST_PASSES: usize = 8;
/// Maximum number of pieces of an interval in one of these passes.
const MOST_PIECES: f64 = 64.0;
/// Poses are added at the middle of an interval, give or take at most this part of it: a motion that repeats itself
/// within the intervals, or a shape that looks the same after a part of a turn, is seen at other places.
const IRREGULAR: f64 = 0.05;
/// Fraction of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Maximum number of corners at which growth is measured.
const MOST_CORNERS: usize = 100_000;
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
    /// The caller ended the study before there was a surface.
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
    /// Estimate of the distance by which poses between those of the envelope reach beyond it, m.
    pub between_poses: f64,
    /// False if the permitted error was not reached with the maximum numbers of poses and cells.
    pub is_within_error: bool,
    /// True if the caller ended the study: the surface is the last one that was finished.
    pub interrupted: bool,
    /// Stops of motions that ended early: the envelope is that of the positions that were reached.
    pub stops: Vec<EnvelopeStop>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Reason why a motion of an envelope ended early.
#[derive(Clone, Debug)]
pub struct EnvelopeStop {
    /// The reason.
    pub stop: Stop,
    /// Time of the last position of the envelope, s; `None` in a grid.
    pub end: Option<f64>,
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
    /// The greatest of the least distances of these points from all parts. Most points are near the part that was the
    /// nearest to the one before, or one beside it: others are not evaluated.
    fn greatest(&self, points: impl Iterator<Item = Vec3>) -> f64 {
        let count = self.swept.len();
        let (mut most, mut last) = (0.0_f64, 0_usize);
        for p in points {
            let mut least = (f64::INFINITY, last);
            for step in 0..count.max(1) * 2 {
                let way = step.div_ceil(2);
                let k = if step % 2 == 0 { last.checked_sub(way) } else { last.checked_add(way) };
                let Some(k) = k.filter(|k| *k < count) else { continue };
                let distance = self.part(k, p);
                if distance < least.0 {
                    least = (distance, k);
                }
                if distance <= most {
                    break;
                }
            }
            (most, last) = (most.max(least.0), least.1);
        }
        most
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
/// returns false, the study ends with the last surface.
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
    let study = Study { model, formulation, design, request, more };
    let mut search = Search::new(study)?;
    let is_resolved = search.bring_poses_closer()?;
    let extent = 2.0 * (search.radius + request.margin);
    let error = request.error.unwrap_or(extent * ERROR);
    let (half, first_cell) = (0.5 * error, extent / FIRST_CELLS);
    let coarse = search.add_poses_between(half, first_cell)?;
    let surface = refined(coarse.surface, first_cell, half, |cell| {
        search.surface(&search.poses.swept, cell).ok().flatten()
    });
    if surface.triangles.is_empty() {
        let name = &model.shapes[request.shape.0].name;
        return Err(EnvelopeError::TooThin(RequestError::model(
            format!("`{name}` is thinner than the smallest cells of its envelope"),
            "add a distance around it (margin)",
        )));
    }
    let is_within_error = coarse.is_enough && is_resolved && surface.deviation <= half;
    Ok(Envelope {
        is_within_error,
        interrupted: !(more() || is_within_error),
        surface,
        poses: search.poses.swept.len(),
        error,
        between_poses: coarse.between_poses,
        stops: search.motions.iter().flat_map(Positions::stops).cloned().collect(),
        cost: search.cost,
    })
}

/// The shape, its motions and the design of an envelope.
#[derive(Clone, Copy)]
struct Study<'a> {
    model: &'a Model,
    formulation: Formulation,
    design: &'a [f64],
    request: &'a Request,
    more: &'a (dyn Fn() -> bool + Sync),
}

/// Search for poses that are close enough to each other.
struct Search<'a> {
    study: Study<'a>,
    motions: Vec<Positions<'a>>,
    poses: Gathered,
    /// Radius of the shape at its first pose, m.
    radius: f64,
    /// Number of distances that may be evaluated for all surfaces, and of those that are left.
    most_distances: usize,
    left: Cell<usize>,
    cost: StudyCost,
}

/// Surface of poses that are close enough to each other, with cells of the first size.
struct CoarseSurface {
    /// `None` if it takes too long.
    surface: Option<Triangles>,
    /// Estimate of the distance by which poses between those of the envelope reach beyond it, m.
    between_poses: f64,
    /// True if that is no more than half of the permitted error.
    is_enough: bool,
}

impl<'a> Search<'a> {
    /// The positions of the sweeps, and others between them, so that no driver moves far between two of them.
    fn new(study: Study<'a>) -> Result<Self, EnvelopeError> {
        let mut cost = StudyCost { designs: 1, ..StudyCost::default() };
        let first = |sweep| Positions::first(study.model, study.formulation, sweep);
        let mut motions = study.request.sweeps.iter().map(first).collect::<Result<Vec<_>, _>>()?;
        let poses = Gathered::of(&study, &mut motions, &mut cost)?;
        let most_distances = MOST_DISTANCES / poses.swept.triangles_per_distance();
        let (radius, left) = (poses.swept.ball(0).1, Cell::new(most_distances));
        Ok(Self { study, motions, poses, radius, most_distances, left, cost })
    }

    /// Surface of some poses; `None` if it takes too long.
    fn surface(&self, swept: &SweptShape, cell: f64) -> Result<Option<Triangles>, EnvelopeError> {
        let Study { request, more, .. } = self.study;
        let union = Union { swept, margin: request.margin };
        let made = surface(&union, swept.len(), union.cube(), cell, MOST_CELLS, &self.left, more);
        if more() { Ok(made) } else { Err(EnvelopeError::Interrupted) }
    }

    /// Adds poses until the shape travels by a part of its size only between two of them. Returns false if it still
    /// travels farther.
    fn bring_poses_closer(&mut self) -> Result<bool, EnvelopeError> {
        let longest = TRAVEL * self.radius;
        for _ in 0..MOST_PASSES {
            let paths = self.motions.iter().zip(&self.poses.paths);
            let mut closer: Vec<Positions<'_>> =
                paths.map(|(motion, path)| motion.closer(path, longest)).collect();
            if closer.iter().zip(&self.motions).all(|(new, old)| new.count() == old.count()) {
                return Ok(true);
            }
            if closer.iter().map(Positions::count).sum::<usize>() > MOST_POSES {
                break;
            }
            self.poses = Gathered::of(&self.study, &mut closer, &mut self.cost)?;
            self.motions = closer;
        }
        Ok(false)
    }

    /// Adds poses between all of them, until what these reach beyond the surface leaves half of the permitted error.
    fn add_poses_between(&mut self, half: f64, cell: f64) -> Result<CoarseSurface, EnvelopeError> {
        let mut coarse =
            CoarseSurface { surface: None, between_poses: TRAVEL * self.radius, is_enough: false };
        for level in 0.. {
            let mut motions: Vec<Positions<'_>> =
                self.motions.iter().map(|motion| motion.finer(level)).collect();
            let finer = Gathered::of(&self.study, &mut motions, &mut self.cost);
            let made = finer.and_then(|finer| Ok((self.surface(&finer.swept, cell)?, finer)));
            if coarse.surface.is_some() && matches!(made, Err(EnvelopeError::Interrupted)) {
                break;
            }
            let (surface, finer) = made?;
            self.motions = motions;
            let Some(surface) = surface else {
                // More poses take too long.
                if coarse.surface.is_none() {
                    self.left.set(self.most_distances);
                    coarse.surface = self.surface(&self.poses.swept, cell)?;
                }
                break;
            };
            coarse.between_poses = self.reach_between(&finer.swept, &surface);
            coarse.is_enough = coarse.between_poses <= half;
            coarse.surface = Some(surface);
            let grew = finer.swept.len() > self.poses.swept.len();
            self.poses = finer;
            if coarse.is_enough || !grew || self.poses.swept.len() > MOST_POSES {
                break;
            }
        }
        Ok(coarse)
    }

    /// Estimate of the distance by which poses between finer ones reach beyond these, from that by which they reach
    /// beyond those so far.
    fn reach_between(&self, finer: &SweptShape, surface: &Triangles) -> f64 {
        let margin = self.study.request.margin;
        let [of_surface, of_corners] = beyond(&self.poses.swept, finer, surface, margin);
        let is_sharp = of_surface.max(of_corners) > SHARP * (margin + self.poses.swept.round());
        if is_sharp { of_surface.max(of_corners) * OF_SHARP } else { of_surface * OF_ROUND }
    }
}

/// Surface with cells so small that it deviates by at most `half`, or the last one before the time limit. The coarse
/// surface is the first candidate.
fn refined(
    coarse: Option<Triangles>,
    mut cell: f64,
    half: f64,
    of: impl Fn(f64) -> Option<Triangles>,
) -> Triangles {
    let (mut made, mut surface) = (coarse, Triangles::default());
    while let Some(finer) = made {
        surface = finer;
        if surface.deviation <= half {
            break;
        }
        cell *= 0.5;
        made = of(cell);
    }
    surface
}

/// Largest distances by which the surface and the corners of finer poses are outside of the coarser ones.
fn beyond(coarse: &SweptShape, finer: &SweptShape, surface: &Triangles, margin: f64) -> [f64; 2] {
    let union = Union { swept: coarse, margin };
    let every = finer.corner_count() / MOST_CORNERS + 1;
    let corners = (0..finer.len()).flat_map(|k| finer.corners(k)).step_by(every);
    let points = surface.vertices.iter().chain(&surface.samples).copied();
    let cores = Union { swept: coarse, margin: -coarse.round() };
    [union.greatest(points), cores.greatest(corners)]
}

/// Positions of a sweep at which the shape is taken.
enum Positions<'a> {
    /// Times of a motion of the model, up to its end.
    Times { model: Box<Model>, times: Vec<f64>, stops: Vec<EnvelopeStop> },
    /// Values of the drivers of a grid.
    Grid { grid: &'a Grid, values: [Vec<f64>; 2], stops: Vec<EnvelopeStop> },
}

impl<'a> Positions<'a> {
    /// Those of the file, and others between them, so that no driver moves far between two of them.
    fn first(model: &Model, formulation: Formulation, sweep: &'a Sweep) -> Result<Self, TopologyError> {
        Ok(match sweep {
            Sweep::Motion(case) => {
                let own = case.map_or_else(|| model.clone(), |case| model.in_case(case));
                let model = Model { metrics: Vec::new(), ..own };
                let within = Analysis::with(&model, formulation)?.swept_times();
                let times = if within.len() > MOST_POSES { model.times.clone() } else { within };
                Self::Times { model: Box::new(model), times, stops: Vec::new() }
            }
            Sweep::Grid(grid) => {
                let fine = |k: usize| {
                    let is_length =
                        model.driven(&model.drivers[grid.drivers[k].0]).quantity == Quantity::Length;
                    let longest = DRIVER_TRAVEL * if is_length { model.size() } else { 1.0 };
                    divided(&grid.values[k], |_, h| h.abs() / longest)
                };
                Self::Grid { grid, values: [fine(0), fine(1)], stops: Vec::new() }
            }
        })
    }

    /// Reasons why motions ended early.
    fn stops(&self) -> &[EnvelopeStop] {
        match self {
            Self::Times { stops, .. } | Self::Grid { stops, .. } => stops,
        }
    }

    /// With times between those among which the shape travels farther than this.
    fn closer(&self, path: &[[f64; 2]], longest: f64) -> Self {
        match self {
            Self::Times { model, times, stops } => {
                let reach = |k: usize, h: f64| match path.get(k..k + 2) {
                    Some([[_, from], [_, to]]) => h * from.max(*to) / longest,
                    Some(_) | None => 1.0,
                };
                Self::Times { model: model.clone(), times: divided(times, reach), stops: stops.clone() }
            }
            // Positions of a grid have no speeds.
            Self::Grid { grid, values, stops } => {
                Self::Grid { grid, values: values.clone(), stops: stops.clone() }
            }
        }
    }

    /// With a further position in each interval.
    fn finer(&self, level: u32) -> Self {
        match self {
            Self::Times { model, times, stops } => {
                Self::Times { model: model.clone(), times: halved(times, level), stops: stops.clone() }
            }
            Self::Grid { grid, values, stops } => {
                let values = values.each_ref().map(|values| halved(values, level));
                Self::Grid { grid, values, stops: stops.clone() }
            }
        }
    }

    fn count(&self) -> usize {
        match self {
            Self::Times { times, .. } => times.len(),
            Self::Grid { values: [a, b], .. } => a.len() * b.len(),
        }
    }
}

/// Poses of a shape.
struct Gathered {
    swept: SweptShape,
    /// Per sweep: times that were solved, and bounds of the speeds of the shape's points; none of a grid.
    paths: Vec<Vec<[f64; 2]>>,
}

impl Gathered {
    /// The poses at the positions of all motions.
    fn of(
        study: &Study<'_>,
        motions: &mut [Positions<'_>],
        cost: &mut StudyCost,
    ) -> Result<Self, EnvelopeError> {
        let request = study.request;
        let mut gathered =
            Self { swept: SweptShape::new(request.shape, request.relative_to), paths: Vec::new() };
        for motion in motions.iter_mut() {
            gathered.add(study, motion, cost)?;
        }
        if !(study.more)() {
            return Err(EnvelopeError::Interrupted);
        }
        if gathered.swept.is_empty() {
            let first = motions.iter().find_map(|motion| motion.stops().first());
            return Err(EnvelopeError::NotReached(first.map(|found| Box::new(found.stop.clone()))));
        }
        Ok(gathered)
    }

    /// Adds the poses at some positions; those of a motion that ends early are changed to end there.
    fn add(
        &mut self,
        study: &Study<'_>,
        positions: &mut Positions<'_>,
        cost: &mut StudyCost,
    ) -> Result<(), TopologyError> {
        let Study { model, formulation, design, more, .. } = *study;
        let mut path = Vec::new();
        match positions {
            Positions::Times { model, times, stops } => {
                let moved = Model { times: times.clone(), ..(**model).clone() };
                let analysis = Analysis::with(&moved, formulation)?;
                let go_on = |_| if more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
                let run = Run::new().at(design).without_measures().without_sensitivities().progress(go_on);
                let solution = analysis.solve(run);
                cost.motions += 1;
                cost.steps += solution.motion.len();
                let to_end = analysis.motion_to_end(design, &solution);
                let motion = to_end.as_ref().unwrap_or(&solution.motion);
                let speeds = self.swept.add(&analysis, design, motion, 0..motion.len());
                path.extend(motion.times.iter().zip(speeds).map(|(time, speed)| [*time, speed]));
                if let Some(stop) = noted(solution.stop.as_ref()) {
                    if motion.len() > 1 {
                        times.clone_from(&motion.times);
                    }
                    // Of a motion up to there nothing stops before its last time: the reason is known already.
                    *stops = vec![EnvelopeStop { stop, end: motion.times.last().copied() }];
                }
            }
            Positions::Grid { grid, values, stops } => {
                let finer = Grid { values: values.clone(), ..(*grid).clone() };
                stops.clear();
                each_half_row(model, &finer, formulation, design, more, |half| {
                    cost.motions += 1;
                    cost.steps += half.solution.motion.len();
                    let reached = half.steps().map(|(_, k)| k);
                    let steps: Vec<usize> = reached.filter(|k| *k < half.solution.motion.len()).collect();
                    // A row that ends beyond one of its positions has those up to its end.
                    let to_end = half.analysis.motion_to_end(design, half.solution);
                    let to_end = to_end.filter(|_| !steps.is_empty());
                    self.swept.add(half.analysis, design, &half.solution.motion, steps.into_iter());
                    if let Some(motion) = &to_end {
                        self.swept.add(half.analysis, design, motion, motion.len() - 1..motion.len());
                    }
                    let stop = noted(half.solution.stop.as_ref());
                    stops.extend(stop.map(|stop| EnvelopeStop { stop, end: None }));
                })?;
            }
        }
        self.paths.push(path);
        Ok(())
    }
}

/// A stop that is no interruption.
fn noted(stop: Option<&Stop>) -> Option<Stop> {
    stop.filter(|s| !matches!(s.kind, StopKind::Interrupted)).cloned()
}

/// Values with others between them: interval k of length h is divided into `parts(k, h)` equal pieces, rounded up.
fn divided(values: &[f64], parts: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    let between = |(k, pair): (usize, &[f64])| {
        let [a, b] = [pair[0], pair[1]];
        let pieces = parts(k, b - a).ceil().clamp(1.0, MOST_PIECES);
        (0..pieces as usize).map(move |n| a + (b - a) * n as f64 / pieces).collect::<Vec<f64>>()
    };
    let mut all: Vec<f64> = values.windows(2).enumerate().flat_map(between).collect();
    all.extend(values.last());
    all
}

/// Values with another one in each interval, near its middle.
fn halved(values: &[f64], level: u32) -> Vec<f64> {
    let mut all = Vec::with_capacity(2 * values.len());
    for (k, pair) in values.windows(2).enumerate() {
        let [a, b] = [pair[0], pair[1]];
        // Multiples of the golden ratio are spread evenly, and repeat nowhere.
        let spread = ((k + 1) as f64 * GOLDEN + f64::from(level) * 0.5).fract();
        all.extend([a, a + (b - a) * (0.5 + IRREGULAR * (2.0 * spread - 1.0))]);
    }
    all.extend(values.last());
    all
}
