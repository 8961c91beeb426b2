//! Map of two drivers over a grid: value and sensitivities of every measure at each pair of driver positions.
//!
//! Input: the grid of a model, driver positions in m or rad. Output: a [`GridMap`] in SI.

mod clearance;

use std::ops::ControlFlow;

use hardpoint::law::Law;
use hardpoint::measure::Output;
use hardpoint::model::{Case, CaseId, DriverId, Formula, Grid, LoadMode, Model, Target, VariableId};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Analysis, Run, Solution};
use hardpoint::topology::{Formulation, TopologyError};

pub use clearance::{GridClearances, GridMinimum, GridPair, GridPlace};

use super::evaluation::StudyCost;

/// Solved grid. Positions are counted row by row: along a row the first driver moves and the second is fixed.
#[derive(Clone, Debug)]
pub struct GridMap {
    /// The grid.
    pub grid: Grid,
    /// Measured outputs.
    pub outputs: Vec<Output>,
    /// Outputs that have values at rest.
    still: Vec<bool>,
    /// Result at each position.
    positions: Vec<Position>,
    /// Number of design variables.
    variables: usize,
    /// Stops of the motions that did not reach their end.
    pub stops: Vec<GridStop>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Stop that made positions of a row unreachable.
#[derive(Clone, Debug)]
pub struct GridStop {
    /// Index of the row.
    pub row: usize,
    /// Stop of the motion.
    pub stop: Stop,
    /// Positions of the two drivers at that time, m or rad.
    pub drivers: [f64; 2],
}

#[derive(Clone, Debug)]
enum Position {
    /// Values of all outputs, then their derivatives by each variable in turn.
    Solved(Vec<f64>),
    /// Not reached; index into the stops.
    NotReached(usize),
    /// Not tried because the caller ended the study.
    NotTried,
}

/// End times of the two phases of every motion, s: the second driver moves to its position first, then the first driver
/// sweeps.
pub(super) const PHASE_ENDS: [f64; 2] = [0.0, 1.0];

impl GridMap {
    /// Solves a grid at the design with variable k at `design[k]`. `more` is called at every position; if it returns
    /// false, the study ends.
    ///
    /// Each half of a row is a motion of its own ([`each_half_row`]), so that a stop on one side of the design
    /// configuration does not affect the other side.
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
        let [first, second] = &relative_values(model, grid);
        let outputs = hardpoint::measure::outputs(model);
        let mut map = Self {
            grid: grid.clone(),
            still: outputs.iter().map(|o| model.is_known_at_rest(o.source)).collect(),
            outputs,
            positions: vec![Position::NotTried; first.len() * second.len()],
            variables: model.variables.len(),
            stops: Vec::new(),
            cost: StudyCost { designs: 1, ..StudyCost::default() },
        };
        each_half_row(model, grid, formulation, design, more, |half| {
            map.cost.motions += 1;
            map.cost.steps += half.solution.motion.len();
            map.take(second, half);
        })?;
        Ok(map)
    }

    /// Stores the positions of one motion.
    fn take(&mut self, second: &[f64], half: &HalfRow<'_>) {
        let &HalfRow { row, first, farthest, solution, .. } = half;
        let interrupted = solution.stop.as_ref().is_some_and(|s| matches!(s.kind, StopKind::Interrupted));
        let stopped = solution.stop.as_ref().filter(|_| !interrupted).map(|stop| {
            let t = stop.failed_time;
            let travelled = [sweep(farthest, t), second[row] * t.clamp(PHASE_ENDS[0], PHASE_ENDS[1])];
            let as_drawn = [self.grid.values[0][0] - first[0], self.grid.values[1][0] - second[0]];
            let drivers = [0, 1].map(|k| as_drawn[k] + travelled[k]);
            self.stops.push(GridStop { row, stop: stop.clone(), drivers });
            self.stops.len() - 1
        });
        for (place, k) in half.steps() {
            let found = if k < solution.motion.len() {
                Position::Solved(self.row_of(solution, k))
            } else {
                stopped.map_or(Position::NotTried, Position::NotReached)
            };
            self.positions[row * first.len() + place] = found;
        }
    }

    fn row_of(&self, solution: &Solution, k: usize) -> Vec<f64> {
        let (measured, outputs) = (&solution.measured, 0..self.outputs.len());
        let known = |m: usize, x: f64| if self.still[m] { x } else { f64::NAN };
        let mut numbers: Vec<f64> = outputs.clone().map(|m| known(m, measured.value(k, m)[0])).collect();
        for b in 0..self.variables {
            let followed = solution.sensitivities.at(k, b).is_some();
            let d = |m: usize| if followed { known(m, measured.d(k, VariableId(b), m)[0]) } else { f64::NAN };
            numbers.extend(outputs.clone().map(d));
        }
        numbers
    }

    /// True if output m has values in a map: it depends on positions only, or on the motion of one driver alone.
    /// Velocities, accelerations and outputs that depend on them need a motion, which a map does not have.
    pub fn has(&self, m: usize) -> bool {
        self.still[m]
    }

    /// Output m with the first driver at its value i and the second at its value j, SI; `None` if that position was not
    /// reached or the output has no value there.
    pub fn value(&self, [i, j]: [usize; 2], m: usize) -> Option<f64> {
        self.number([i, j], m)
    }

    /// Derivative by a design variable, SI; `None` also if the mechanism cannot follow the variable.
    pub fn d(&self, [i, j]: [usize; 2], variable: VariableId, m: usize) -> Option<f64> {
        self.number([i, j], (1 + variable.0) * self.outputs.len() + m)
    }

    fn number(&self, [i, j]: [usize; 2], place: usize) -> Option<f64> {
        match &self.positions[j * self.grid.values[0].len() + i] {
            Position::Solved(numbers) => Some(numbers[place]).filter(|x| x.is_finite()),
            _ => None,
        }
    }

    /// True if a position was reached.
    pub fn is_solved(&self, [i, j]: [usize; 2]) -> bool {
        matches!(self.positions[j * self.grid.values[0].len() + i], Position::Solved(_))
    }

    /// Index in [`stops`](Self::stops) of the reason why a position was not reached.
    pub fn stop_index(&self, [i, j]: [usize; 2]) -> Option<usize> {
        match self.positions[j * self.grid.values[0].len() + i] {
            Position::NotReached(stop) => Some(stop),
            _ => None,
        }
    }

    /// Number of positions that were reached.
    pub fn solved(&self) -> usize {
        self.positions.iter().filter(|p| matches!(p, Position::Solved(_))).count()
    }

    /// True if the caller ended the study before all positions were tried.
    pub fn interrupted(&self) -> bool {
        self.positions.iter().any(|p| matches!(p, Position::NotTried))
    }

    /// All positions `[i, j]`, row by row.
    pub fn places(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [first, second] = [0, 1].map(|k| self.grid.values[k].len());
        (0..second).flat_map(move |j| (0..first).map(move |i| [i, j]))
    }
}

/// Solved motion of one half of a row of a grid.
pub(super) struct HalfRow<'a> {
    /// Index of the row.
    row: usize,
    /// All positions of the first driver, relative to the design configuration.
    first: &'a [f64],
    /// The farthest position of the first driver, relative to the design configuration.
    farthest: f64,
    /// Indices of the first driver's positions, in the order of the motion.
    places: &'a [usize],
    /// The motion.
    pub analysis: &'a Analysis<'a>,
    pub solution: &'a Solution,
}

impl HalfRow<'_> {
    /// Each place with the index of its time in the motion, which is beyond the motion's end if it was not reached.
    pub fn steps(&self) -> impl Iterator<Item = (usize, usize)> {
        let times = &self.analysis.model().times;
        self.places.iter().map(move |place| {
            // Bitwise equal to the output time, which is computed by the same expression.
            let time = time_of(self.first[*place], self.farthest);
            (*place, times.iter().position(|t| *t == time).expect("every place has its time"))
        })
    }
}

/// Solves a grid row by row, and passes each motion to `visit`. Each row is reached from the design configuration: the
/// second driver moves to its position in the row first, then the first driver moves up, and in a separate motion down.
pub(super) fn each_half_row(
    model: &Model,
    grid: &Grid,
    formulation: Formulation,
    design: &[f64],
    more: &(dyn Fn() -> bool + Sync),
    mut visit: impl FnMut(&HalfRow<'_>),
) -> Result<(), TopologyError> {
    let [first, second] = &relative_values(model, grid);
    for row in 0..second.len() {
        for sign in [1.0, -1.0] {
            // Each side runs from the middle outwards. The design position of the first driver belongs to the upper
            // side.
            let mut places: Vec<usize> =
                (0..first.len()).filter(|k| (first[*k] >= 0.0) == (sign > 0.0)).collect();
            if sign < 0.0 {
                places.reverse();
            }
            let Some(farthest) = places.last().map(|k| first[*k]) else { continue };
            if !more() {
                return Ok(());
            }
            let moved = row_model(model, grid, [farthest, second[row]], places.iter().map(|k| first[*k]));
            let analysis = Analysis::with(&moved, formulation)?;
            let go_on = |_| if more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
            let solution = analysis.solve(Run::new().at(design).progress(go_on));
            visit(&HalfRow {
                row,
                first,
                farthest,
                places: &places,
                analysis: &analysis,
                solution: &solution,
            });
        }
    }
    Ok(())
}

/// Position of the first driver at a time, relative to the design configuration.
fn sweep(farthest: f64, time: f64) -> f64 {
    farthest * (time - PHASE_ENDS[1]).max(0.0)
}

/// Time at which the first driver passes a position on its way to the farthest position of its side, s.
fn time_of(place: f64, farthest: f64) -> f64 {
    PHASE_ENDS[1] + if place == 0.0 { 0.0 } else { place / farthest }
}

/// Positions of the two drivers relative to the design configuration.
fn relative_values(model: &Model, grid: &Grid) -> [Vec<f64>; 2] {
    [0, 1].map(|k| {
        let as_drawn = model.as_drawn(grid.drivers[k]);
        grid.values[k].iter().map(|value| value - as_drawn).collect()
    })
}

/// Model of one half of a row: the drivers move by `travels[0]` and `travels[1]`, m or rad.
fn row_model(model: &Model, grid: &Grid, travels: [f64; 2], places: impl Iterator<Item = f64>) -> Model {
    let [begin, first_end] = PHASE_ENDS;
    let texts = [
        format!("({:?})*max(t - {first_end:?}, 0)", travels[0]),
        format!("({:?})*min(t, {first_end:?})", travels[1]),
    ];
    // The motion starts in the design configuration and continues from there.
    let mut times = vec![begin];
    times.extend(places.map(|place| time_of(place, travels[0])));
    driven(model, grid, texts, times)
}

/// Model in which the two drivers of a grid follow these laws and the others are fixed in the design configuration.
fn driven(model: &Model, grid: &Grid, texts: [String; 2], times: Vec<f64>) -> Model {
    let mut laws = vec![Some(Law::constant(0.0)); model.drivers.len()];
    let mut formulas = Vec::new();
    for (driver, text) in grid.drivers.into_iter().zip(texts) {
        let (law, formula) = law_of(model, driver, text, &[]);
        laws[driver.0] = Some(law);
        formulas.extend(formula);
    }
    // A grid position is static, so loads are those of the mechanism at rest.
    let load_mode = Some(LoadMode::Static);
    let force_laws = Vec::new();
    let case = Case { name: grid.name.clone(), laws, force_laws, formulas, times, load_mode };
    // A map has no metrics.
    Model { cases: vec![case], metrics: Vec::new(), ..model.clone() }.in_case(CaseId(0))
}

/// Law from a text that is valid by construction. If the driver's laws count from zero and its design position depends
/// on the design variables, the law also compensates the shift of the design position during the first phase. The
/// driver is then at the grid's value in every design.
///
/// `own` are the parameters of the text. They follow that shift.
pub(super) fn law_of(
    model: &Model,
    driver: DriverId,
    text: String,
    own: &[(&str, f64)],
) -> (Law, Option<Formula>) {
    let [_, first_end] = PHASE_ENDS;
    let law =
        |text: &str, with: &[(&str, f64)]| Law::parse_with(text, with).expect("a law that is written here");
    let zero = model.drivers[driver.0].law.as_drawn();
    let follows = zero.and_then(|(parameter, value)| {
        let formula = model.formulas.iter().find(|f| f.of == Target::Law(driver, parameter))?;
        let mut shift = formula.clone();
        shift.of = Target::Law(driver, 0);
        Some((value, shift))
    });
    match follows {
        None => (law(&text, own), None),
        Some((value, formula)) => {
            let text = format!("{text} + ({value:?} - as_drawn)*min(t, {first_end:?})");
            let parameters: Vec<(&str, f64)> =
                std::iter::once(("as_drawn", value)).chain(own.iter().copied()).collect();
            (law(&text, &parameters), Some(formula))
        }
    }
}
