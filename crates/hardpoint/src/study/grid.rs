//! Two drivers over a grid: what every measure is wherever both stand, with its sensitivities.

use std::ops::ControlFlow;

use crate::law::Law;
use crate::measure::Output;
use crate::model::{Case, CaseId, DriverId, Formula, Grid, LoadMode, Model, Target, VariableId};
use crate::motion::{Stop, StopKind};
use crate::run::{Analysis, Run, Solution};
use crate::topology::{Formulation, TopologyError};

use super::evaluation::StudyCost;

/// A solved grid. Positions are counted row by row: in a row the first driver goes from position to position while the
/// second is.
#[derive(Clone, Debug)]
pub struct GridMap {
    /// The grid.
    pub grid: Grid,
    /// Measured outputs.
    pub outputs: Vec<Output>,
    /// Outputs that have values at rest.
    still: Vec<bool>,
    /// Per position, what was found there.
    positions: Vec<Position>,
    /// Number of design variables.
    variables: usize,
    /// Stops of the motions that did not reach their end.
    pub stops: Vec<GridStop>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Reason why positions could not be reached.
#[derive(Clone, Debug)]
pub struct GridStop {
    /// The row.
    pub row: usize,
    /// Stop of the motion.
    pub stop: Stop,
    /// Positions of the two drivers at that time.
    pub stood: [f64; 2],
}

#[derive(Clone, Debug)]
enum Position {
    /// Values of all outputs, then by each variable theirs.
    Solved(Vec<f64>),
    /// The place in the stops of what ended the motion before.
    NotReached(usize),
    /// The caller wanted no more.
    NotTried,
}

/// The times of the two parts of every motion: the second driver goes to where it is, then the first one sweeps.
pub(super) const STANDS: [f64; 2] = [0.0, 1.0];

impl GridMap {
    /// Solves a grid at the design with variable k at `design[k]`; `more` is asked at every position, and may end it.
    ///
    /// Each row is reached from the drawn position: first the second driver goes to where it is in that row, then the
    /// first one goes up, and in a motion of its own down. So a position beyond a limit on one side says nothing of the
    /// other side.
    ///
    /// # Errors
    /// A [`TopologyError`] where the mechanism cannot be driven.
    pub fn solve(
        model: &Model,
        grid: &Grid,
        formulation: Formulation,
        design: &[f64],
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, TopologyError> {
        let [first, second] = &from_drawing(model, grid);
        let outputs = crate::measure::outputs(model);
        let mut map = Self {
            grid: grid.clone(),
            still: outputs.iter().map(|o| model.is_known_at_rest(o.source)).collect(),
            outputs,
            positions: vec![Position::NotTried; first.len() * second.len()],
            variables: model.variables.len(),
            stops: Vec::new(),
            cost: StudyCost { designs: 1, ..StudyCost::default() },
        };
        for row in 0..second.len() {
            for sign in [1.0, -1.0] {
                // Each side from the middle outwards; where the first driver is in the design configuration counts as
                // the upper side.
                let mut places: Vec<usize> =
                    (0..first.len()).filter(|k| (first[*k] >= 0.0) == (sign > 0.0)).collect();
                if sign < 0.0 {
                    places.reverse();
                }
                let Some(farthest) = places.last().map(|k| first[*k]) else { continue };
                if !more() {
                    return Ok(map);
                }
                let moved = row_model(model, grid, [farthest, second[row]], places.iter().map(|k| first[*k]));
                let analysis = Analysis::with(&moved, formulation)?;
                let go_on = |_| if more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
                let solution = analysis.solve(Run::new().at(design).progress(go_on));
                map.cost.motions += 1;
                map.cost.steps += solution.motion.len();
                map.take(row, [first, second], farthest, &places, &moved.times, &solution);
            }
        }
        Ok(map)
    }

    /// Takes one motion's positions.
    fn take(
        &mut self,
        row: usize,
        [first, second]: [&[f64]; 2],
        farthest: f64,
        places: &[usize],
        times: &[f64],
        solution: &Solution,
    ) {
        let interrupted = solution.stop.as_ref().is_some_and(|s| matches!(s.kind, StopKind::Interrupted));
        let stopped = solution.stop.as_ref().filter(|_| !interrupted).map(|stop| {
            let t = stop.failed_time;
            let gone = [sweep(farthest, t), second[row] * t.clamp(STANDS[0], STANDS[1])];
            let as_drawn = [self.grid.values[0][0] - first[0], self.grid.values[1][0] - second[0]];
            let stood = [0, 1].map(|k| as_drawn[k] + gone[k]);
            self.stops.push(GridStop { row, stop: stop.clone(), stood });
            self.stops.len() - 1
        });
        for place in places {
            // The same number as when the times were made.
            let time = time_of(first[*place], farthest);
            let k = times.iter().position(|t| *t == time).expect("every place has its time");
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

    /// True if output m has numbers in a map: what follows from positions, or from what happens while one driver alone
    /// moves. Velocities, accelerations and what follows from them are those of a motion, and there is none.
    pub fn has(&self, m: usize) -> bool {
        self.still[m]
    }

    /// Output m where the first driver is at its value i, the second at its value j; `None` where that was not reached,
    /// or where there is no such number.
    pub fn value(&self, [i, j]: [usize; 2], m: usize) -> Option<f64> {
        self.number([i, j], m)
    }

    /// Derivative by a design variable; `None` also where the mechanism cannot follow that.
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
    pub fn why_not(&self, [i, j]: [usize; 2]) -> Option<usize> {
        match self.positions[j * self.grid.values[0].len() + i] {
            Position::NotReached(stop) => Some(stop),
            _ => None,
        }
    }

    /// Number of positions that were reached.
    pub fn solved(&self) -> usize {
        self.positions.iter().filter(|p| matches!(p, Position::Solved(_))).count()
    }

    /// True if the caller ended it before all positions were tried.
    pub fn interrupted(&self) -> bool {
        self.positions.iter().any(|p| matches!(p, Position::NotTried))
    }

    /// All positions, row by row.
    pub fn places(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [first, second] = [0, 1].map(|k| self.grid.values[k].len());
        (0..second).flat_map(move |j| (0..first).map(move |i| [i, j]))
    }
}

/// Position of the first driver at a time.
fn sweep(farthest: f64, time: f64) -> f64 {
    farthest * (time - STANDS[1]).max(0.0)
}

/// When it is there, on its way to the farthest place of its side.
fn time_of(place: f64, farthest: f64) -> f64 {
    STANDS[1] + if place == 0.0 { 0.0 } else { place / farthest }
}

/// Positions of the two drivers, relative to the design configuration.
fn from_drawing(model: &Model, grid: &Grid) -> [Vec<f64>; 2] {
    [0, 1].map(|k| {
        let as_drawn = model.as_drawn(grid.drivers[k]);
        grid.values[k].iter().map(|value| value - as_drawn).collect()
    })
}

/// The mechanism in one half of a row: the first driver goes as far as the first number, the second as far as the
/// second.
fn row_model(model: &Model, grid: &Grid, ways: [f64; 2], places: impl Iterator<Item = f64>) -> Model {
    let mut laws = vec![Some(Law::constant(0.0)); model.drivers.len()];
    let mut formulas = Vec::new();
    let [begin, stands] = STANDS;
    let texts =
        [format!("({:?})*max(t - {stands:?}, 0)", ways[0]), format!("({:?})*min(t, {stands:?})", ways[1])];
    for (driver, text) in grid.drivers.into_iter().zip(texts) {
        let (law, formula) = law_of(model, driver, text);
        laws[driver.0] = Some(law);
        formulas.extend(formula);
    }
    // The drawn position comes first: the rest is followed from there.
    let mut times = vec![begin];
    times.extend(places.map(|place| time_of(place, ways[0])));
    // A position of a grid is no moment of a motion: loads are those of the mechanism at rest there.
    let load_mode = Some(LoadMode::Static);
    let case = Case { name: grid.name.clone(), laws, formulas, times, load_mode };
    // A map has no metrics.
    Model { cases: vec![case], metrics: Vec::new(), ..model.clone() }.in_case(CaseId(0))
}

/// A law written here. Where the driver's laws count from zero and the drawing follows the design, the driver has gone
/// back by what the drawing has moved before the first place is passed, so that it is where the grid says in every
/// design.
pub(super) fn law_of(model: &Model, driver: DriverId, text: String) -> (Law, Option<Formula>) {
    let [_, stands] = STANDS;
    let law =
        |text: &str, with: &[(&str, f64)]| Law::parse_with(text, with).expect("a law that is written here");
    let zero = model.drivers[driver.0].law.as_drawn();
    let follows = zero.and_then(|(parameter, value)| {
        let formula = model.formulas.iter().find(|f| f.of == Target::Law(driver, parameter))?;
        Some((value, Formula { of: Target::Law(driver, 0), ..formula.clone() }))
    });
    match follows {
        None => (law(&text, &[]), None),
        Some((value, formula)) => {
            let text = format!("{text} + ({value:?} - as_drawn)*min(t, {stands:?})");
            (law(&text, &[("as_drawn", value)]), Some(formula))
        }
    }
}
