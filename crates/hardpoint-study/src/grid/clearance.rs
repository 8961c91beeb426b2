//! Least distances of pairs of shapes over a grid of two drivers, located between its positions.
//!
//! The local minima of the grid's positions are where a search in both drivers begins. It solves the mechanism anew at
//! each of its positions: three motions that pass there along the first driver, the second and both at once have the
//! gradient and the matrix of second derivatives in their rates and accelerations. Newton's method within the grid's
//! range, shortened where the distance does not decrease, ends at a minimum or at the edge of the range.

use hardpoint::model::{Grid, Model, ShapeId};
use hardpoint::motion::StopKind;
use hardpoint::run::{Analysis, Run, ShapeDistance};
use hardpoint::topology::{Formulation, TopologyError};

use super::super::evaluation::StudyCost;
use super::{driven, each_half_row, relative_values};

/// A minimum is located if a step of Newton's method is below this fraction of the range: the value is then known to
/// round-off, since it depends on the square of the step.
const LOCATED: f64 = 1e-9;
/// A step below this fraction of the range is not required to decrease the distance: the decrease is round-off.
const NEAR: f64 = 1e-6;
/// Maximum number of steps of the search from one position: two dozen halvings and a few steps of Newton's method.
const MOST_STEPS: usize = 40;
/// Rate of a driver at the position of interest, as a fraction of its range: small, so that the driver hardly leaves
/// the range on its way.
const RATE: f64 = 1e-3;
/// Two minima nearer than this fraction of the range are the same one.
const SAME: f64 = 1e-6;
/// A distance that changes less than this fraction of the mechanism's size is constant: round-off of positions.
const CONSTANT: f64 = 1e-10;

/// Place of a minimum in a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridPlace {
    /// Between the ends of both ranges, where both derivatives are zero.
    Inside,
    /// At an end of one range.
    Edge,
    /// At an end of both ranges.
    Corner,
}

/// A least distance of two shapes over a grid.
#[derive(Clone, Debug)]
pub struct GridMinimum {
    /// Positions of the two drivers, m or rad, measured like the values of their laws.
    pub drivers: [f64; 2],
    /// Distance and nearest points; its rates have no meaning.
    pub at: ShapeDistance,
    /// Place in the grid.
    pub place: GridPlace,
    /// False if only the grid's position is known: there is no derivative in the drivers, or the search did not end.
    pub is_located: bool,
    /// Derivative of the distance by every design variable with both drivers fixed; NaN for those that are not
    /// admissible, and where the cores meet.
    pub d: Vec<f64>,
}

/// Distance of two shapes over a grid.
#[derive(Clone, Debug)]
pub struct GridPair {
    /// The shapes.
    pub shapes: [ShapeId; 2],
    /// Local minima, the least first.
    pub minima: Vec<GridMinimum>,
    /// Number of the grid's positions at which the shapes overlap.
    pub touching: usize,
    /// True if the distance is the same at all positions.
    pub is_constant: bool,
}

/// Clearances over a grid.
#[derive(Clone, Debug)]
pub struct GridClearances {
    /// The grid.
    pub grid: Grid,
    /// All pairs of all clearances, each once.
    pub pairs: Vec<GridPair>,
    /// Number of positions reached.
    pub solved: usize,
    /// True if the caller ended the study before all positions were tried.
    pub interrupted: bool,
    /// Cost of the study.
    pub cost: StudyCost,
}

impl GridClearances {
    /// Locates the least distances of all pairs over a grid at the design with variable k at `design[k]`. `more` is
    /// called at every position; if it returns false, the study ends.
    ///
    /// # Errors
    /// A [`TopologyError`] if the mechanism cannot be driven.
    pub fn solve(
        model: &Model,
        grid: &Grid,
        formulation: Formulation,
        design: &[f64],
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, TopologyError> {
        let pairs = model.shape_pairs();
        let [first, second] = &relative_values(model, grid);
        let (columns, rows) = (first.len(), second.len());
        let mut found: Vec<Vec<Option<f64>>> = vec![vec![None; columns * rows]; pairs.len()];
        let (mut cost, mut ended) = (StudyCost { designs: 1, ..StudyCost::default() }, false);
        each_half_row(model, grid, formulation, design, more, |half| {
            cost.motions += 1;
            cost.steps += half.solution.motion.len();
            let stop = half.solution.stop.as_ref();
            ended |= stop.is_some_and(|s| matches!(s.kind, StopKind::Interrupted));
            let motion = &half.solution.motion;
            let reached: Vec<(usize, usize)> = half.steps().filter(|(_, k)| *k < motion.len()).collect();
            let steps = reached.iter().map(|(_, k)| *k);
            for (p, samples) in half.analysis.distances(design, motion, &pairs, steps).into_iter().enumerate()
            {
                for ((place, _), sample) in reached.iter().zip(samples) {
                    found[p][half.row * columns + place] = Some(sample.distance[0]);
                }
            }
        })?;
        ended |= !more();
        let solved = found.first().map_or(0, |values| values.iter().flatten().count());
        let mut search = Search { model, grid, formulation, design, ranges: [first, second], cost, more };
        let mut all = Vec::new();
        for (shapes, values) in pairs.into_iter().zip(&found) {
            let (low, high) = values
                .iter()
                .flatten()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
            let is_constant = high - low <= CONSTANT * model.size();
            let mut minima: Vec<GridMinimum> = Vec::new();
            for [i, j] in lowest_places(values, [columns, rows], is_constant) {
                if ended || !more() {
                    ended = true;
                    break;
                }
                let minimum = search.from(shapes, [first[i], second[j]], is_constant)?;
                let ranges = search.spans();
                let is_known = |m: &GridMinimum| {
                    (0..2).all(|k| (m.drivers[k] - minimum.drivers[k]).abs() <= SAME * ranges[k])
                };
                if !minima.iter().any(is_known) {
                    minima.push(minimum);
                }
            }
            minima.sort_by(|a, b| a.at.distance[0].total_cmp(&b.at.distance[0]));
            let touching = values.iter().flatten().filter(|x| **x < 0.0).count();
            all.push(GridPair { shapes, minima, touching, is_constant });
        }
        Ok(Self { grid: grid.clone(), pairs: all, solved, interrupted: ended, cost: search.cost })
    }
}

/// Positions that are not above any of their neighbours, of those that were reached; the first one if all are alike.
fn lowest_places(values: &[Option<f64>], [columns, rows]: [usize; 2], is_constant: bool) -> Vec<[usize; 2]> {
    let at = |i: usize, j: usize| values[j * columns + i];
    let mut lowest = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let Some(own) = at(i, j) else { continue };
            if is_constant {
                return vec![[i, j]];
            }
            let around = |n: usize, count: usize| n.saturating_sub(1)..=(n + 1).min(count - 1);
            let is_low = around(j, rows)
                .flat_map(|n| around(i, columns).map(move |m| [m, n]))
                .all(|[m, n]| at(m, n).is_none_or(|other| own <= other));
            if is_low {
                lowest.push([i, j]);
            }
        }
    }
    lowest
}

/// Search for the least distance of a pair in the range of a grid.
struct Search<'a> {
    model: &'a Model,
    grid: &'a Grid,
    formulation: Formulation,
    design: &'a [f64],
    /// Positions of both drivers, relative to the design configuration.
    ranges: [&'a [f64]; 2],
    cost: StudyCost,
    /// False once the caller ends the study.
    more: &'a (dyn Fn() -> bool + Sync),
}

/// Distance at a position, with its first and second derivatives by both drivers as fractions of their ranges.
struct Local {
    at: ShapeDistance,
    gradient: [f64; 2],
    /// Second derivatives: twice by the first driver, by both, twice by the second.
    second: [f64; 3],
}

impl Search<'_> {
    /// Lengths of the ranges of both drivers, m or rad.
    fn spans(&self) -> [f64; 2] {
        self.ranges.map(|values| values[values.len() - 1] - values[0])
    }

    /// Minimum near a position of the grid, relative to the design configuration.
    fn from(
        &mut self,
        shapes: [ShapeId; 2],
        start: [f64; 2],
        is_constant: bool,
    ) -> Result<GridMinimum, TopologyError> {
        let spans = self.spans();
        let lows = self.ranges.map(|values| values[0]);
        // Fractions of the ranges.
        let place = |x: [f64; 2]| [0, 1].map(|k| lows[k] + x[k] * spans[k]);
        let mut x = [0, 1].map(|k| (start[k] - lows[k]) / spans[k]);
        let mut is_located = is_constant;
        let local = if is_constant { None } else { self.local(shapes, start)? };
        if let Some(mut here) = local {
            // One step of the grid.
            let mut reach = self.ranges.iter().map(|v| 1.0 / (v.len() - 1) as f64).fold(0.0, f64::max);
            for _ in 0..MOST_STEPS {
                if !(self.more)() {
                    break;
                }
                let (step, is_short) = step_within(x, &here, reach);
                let length = step[0].hypot(step[1]);
                if length <= LOCATED {
                    is_located = !is_short;
                    break;
                }
                let trial = [0, 1].map(|k| (x[k] + step[k]).clamp(0.0, 1.0));
                let there = self.local(shapes, place(trial))?;
                match there.filter(|l| l.at.distance[0] < here.at.distance[0] || length <= NEAR) {
                    Some(l) => (x, here) = (trial, l),
                    None => reach = 0.5 * length,
                }
            }
        }
        let on_end = x.iter().filter(|x| **x <= 0.0 || **x >= 1.0).count();
        let position = place(x);
        let (at, mut d) = self.result(shapes, position)?;
        if at.cores_meet {
            // The nearest points coincide: no direction leads from one to the other.
            d.fill(f64::NAN);
        }
        let as_drawn = [0, 1].map(|k| self.grid.values[k][0] - lows[k]);
        Ok(GridMinimum {
            drivers: [0, 1].map(|k| as_drawn[k] + position[k]),
            at,
            place: [GridPlace::Inside, GridPlace::Edge, GridPlace::Corner][on_end],
            is_located,
            d,
        })
    }

    /// Distance and derivatives at a position; `None` if it cannot be reached or has no rates.
    fn local(&mut self, shapes: [ShapeId; 2], position: [f64; 2]) -> Result<Option<Local>, TopologyError> {
        let spans = self.spans();
        let mut along = [[f64::NAN; 3]; 3];
        let mut at = None;
        for (k, direction) in [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].into_iter().enumerate() {
            let rates = [0, 1].map(|n| RATE * spans[n] * direction[n]);
            let model = self.passing(position, rates);
            let analysis = Analysis::with(&model, self.formulation)?;
            let run = Run::new().at(self.design).without_measures().without_sensitivities();
            let solution = analysis.solve(run);
            self.cost.motions += 1;
            self.cost.steps += solution.motion.len();
            if solution.motion.len() < model.times.len() {
                return Ok(None);
            }
            let last = solution.motion.len() - 1;
            let found = analysis.distances(self.design, &solution.motion, &[shapes], [last].into_iter());
            let sample = found[0][0];
            along[k] = sample.distance;
            at = Some(sample);
        }
        let gradient = [along[0][1], along[1][1]].map(|rate| rate / RATE);
        let [p, q, both] = along.map(|rates| rates[2] / (RATE * RATE));
        let second = [p, 0.5 * (both - p - q), q];
        let is_known = gradient.iter().chain(&second).all(|x| x.is_finite());
        Ok(at.filter(|_| is_known).map(|at| Local { at, gradient, second }))
    }

    /// Distance at a position, and its derivatives by the design variables with both drivers fixed.
    fn result(
        &mut self,
        shapes: [ShapeId; 2],
        position: [f64; 2],
    ) -> Result<(ShapeDistance, Vec<f64>), TopologyError> {
        let model = self.passing(position, [0.0; 2]);
        let analysis = Analysis::with(&model, self.formulation)?;
        let solution = analysis.solve(Run::new().at(self.design).without_measures());
        self.cost.motions += 1;
        self.cost.steps += solution.motion.len();
        let last = solution.motion.len().saturating_sub(1);
        let found = analysis.distances(self.design, &solution.motion, &[shapes], [last].into_iter());
        Ok((found[0][0], analysis.distance_derivatives(self.design, shapes, &solution, last)))
    }

    /// Motion from the design configuration to a position, which both drivers pass with these rates and without
    /// acceleration at its end.
    fn passing(&self, position: [f64; 2], rates: [f64; 2]) -> Model {
        let texts = [0, 1].map(|k| {
            let [to, bend] = [position[k], rates[k] - position[k]];
            format!("({to:?})*t + ({bend:?})*(t*(t - 1)*(2 - t))")
        });
        driven(self.model, self.grid, texts, vec![0.0, 1.0])
    }
}

/// Step from a position, in fractions of the ranges: that of Newton's method in the drivers that can move, or against
/// the gradient where the distance is not convex, at most `reach` long and within the ranges. True if it is shorter
/// than Newton's.
fn step_within(x: [f64; 2], local: &Local, reach: f64) -> ([f64; 2], bool) {
    let Local { gradient: g, second: [p, q, r], .. } = local;
    let can_move = [0, 1].map(|k| !(x[k] <= 0.0 && g[k] >= 0.0 || x[k] >= 1.0 && g[k] <= 0.0));
    let own = [*p, *r];
    let det = p * r - q * q;
    let alone = |k: usize| {
        let mut step = [0.0; 2];
        step[k] = if own[k] > 0.0 { -g[k] / own[k] } else { -g[k].signum() * reach };
        step
    };
    let step = match can_move {
        [false, false] => [0.0; 2],
        [true, false] => alone(0),
        [false, true] => alone(1),
        [true, true] if *p > 0.0 && det > 0.0 => [-(r * g[0] - q * g[1]) / det, -(p * g[1] - q * g[0]) / det],
        [true, true] => {
            let size = g[0].hypot(g[1]);
            if size > 0.0 { g.map(|g| -g / size * reach) } else { [0.0; 2] }
        }
    };
    let length = step[0].hypot(step[1]);
    let is_short = length >= reach;
    let step = if is_short { step.map(|s| s * (reach / length)) } else { step };
    // An end that the step would cross is reached in that driver; the next step moves the other one alone.
    ([0, 1].map(|k| (x[k] + step[k]).clamp(0.0, 1.0) - x[k]), is_short)
}
