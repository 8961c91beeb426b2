//! Equilibria of a mechanism at its output times, by Newton's method on the openings.

use crate::design::{BodyFixed, DesignMap, DesignVelocity};
use crate::law::Law;
use crate::linalg::semidefinite::is_definite;
use crate::linalg::{Elimination, diagonalise};
use crate::load::{ElementTurns, GivenLoads, OpeningLoads};
use crate::measure::{DriverPoses, Instant, StepValues};
use crate::model::{DriverId, ElementId, MeasureKind, Model, UnitForce};
use crate::motion::mechanism::{Mechanism, StepRejection};
use crate::motion::stepper::Stepper;
use crate::motion::{GivingDirection, Stop, StopKind, advance};
use crate::number::{self, Dual};
use crate::sensitivity::PlanVelocity;
use crate::space::{Pose, Twist};
use crate::topology::Topology;

use super::direction::{NamedOpenings, first_largest};
use super::second::{Along, Curvatures, SolvedEquilibrium};
use super::waypoints::{first_undefined, waypoints};

/// Correction of the openings, rad or sizes, whose square is round-off: after it they are solved.
const QUADRATIC: f64 = 1e-9;
/// Part of a correction to which the next one shrinks, at most, if the same stiffness serves for both; a new one is
/// computed otherwise.
const SAME_STIFFNESS: f64 = 1e-2;
/// Error of the openings that an unchanged stiffness leaves, rad or sizes: round-off.
const ROUND_OFF: f64 = 1e-15;
/// Maximum number of iterations of an attempt; from a good prediction two to four are enough, and eight from the rigid
/// position under full load. What takes longer may have found another equilibrium.
const MOST_ITERATIONS: usize = 12;
/// Each correction is below this fraction of the one before, from the third on.
const CONTRACTION: f64 = 0.5;
/// Largest of the first two corrections of an attempt, rad or sizes: a longer one may lead to another equilibrium.
const LONGEST: f64 = 0.5;
/// Distance to where the determinant of the stiffness vanishes by its trend, as a part of the way to an output time,
/// within which it is the reason why there is no equilibrium near by. The end is known to 1e-9.
const ENDS_AT_SINGULAR: f64 = 1e-3;
/// Shortest part of the way from one output time, or turn of a law, to the next: if it is rejected, there is no
/// equilibrium near by.
const SHORTEST: f64 = 1e-9;
/// The same before it is known whether other openings describe the way better.
const SHORTEST_AT_FIRST: f64 = 0.01;
/// Factor of the shortest part each time that no other openings are found to be better.
const SHORTER: f64 = 0.1;
/// Maximum number of equilibria that a prediction uses.
const PREDICTED_FROM: usize = 3;
/// Maximum sum of the sizes of the weights of a prediction: 7 for uniform output times. A larger sum amplifies what
/// the polynomial does not follow.
const AMPLIFIED: f64 = 8.0;
/// Maximum error of a prediction, as a fraction of the distances between the equilibria that it connects: a larger
/// one means that the output times do not resolve the path.
const CONFIRMED: f64 = 0.1;
/// Part of the stiffness along a step that the loads at its end leave, at least. If it falls further, it may vanish
/// within the step, and the path turn.
const LEFT_BY_LOADS: f64 = 0.5;
/// Part of the stiffness at the ends of a step that is left in its middle, at least: between two equilibria of
/// different branches the stiffness is negative.
const LEFT_IN_MIDDLE: f64 = 0.5;
/// Length of a step, rad or sizes, within which no other branch is expected: a stop that the loads touch or leave
/// changes the stiffness at once, however short the step.
const NEAR: f64 = 1e-6;
/// Part of the terms that a stiffness is the sum of, below which it is round-off.
const ROUND_OFF_OF_TERMS: f64 = 1e-13;
/// Difference of the stiffnesses of directions that are equally stiff, in units of the openings: round-off.
const EQUALLY_STIFF: f64 = 1e-9;
/// Part of the least stiffness, in rad and sizes of the mechanism, above which round-off of the others hides it.
const HIDDEN: f64 = 0.01;
/// Growth of a law beyond its values at the output times before and after with which it nears a pole.
const NEARS_POLE: f64 = 100.0;
/// A pivot of the scaled stiffness below this holds nothing.
const HOLDS_NOTHING: f64 = 1e-12;
/// Difference of symmetric entries of the scaled stiffness above which the forces have no potential; round-off is
/// below.
const UNSYMMETRIC: f64 = 1e-9;

/// Reason why an equilibrium was not found.
enum Rejection {
    /// Redundant constraints contradict each other in the position.
    Locked(StepRejection),
    /// The mechanism does not reach the position, or Newton's method does not converge.
    NoConvergence,
    /// The equilibrium is not stable: a motion from it needs no work.
    Unstable,
    /// No force resists a motion.
    NothingHolds,
}

impl Rejection {
    /// Reason why the mechanism does not reach a position.
    fn of(rejection: StepRejection) -> Self {
        match rejection {
            locked @ StepRejection::Locked { .. } => Self::Locked(locked),
            StepRejection::Position(_)
            | StepRejection::Branch { .. }
            | StepRejection::Law { .. }
            | StepRejection::TooFar { .. }
            | StepRejection::TooNear => Self::NoConvergence,
        }
    }
}

/// Accepted equilibrium, at an output time or between two.
struct Accepted {
    /// `None` on the way to the first output time.
    time: Option<f64>,
    /// Part of the way to the first output time.
    part: f64,
    /// Values of all drivers.
    drivers: Vec<f64>,
    loads: GivenLoads,
    /// Stiffness there; `None` before the first.
    stiffness: Option<Vec<f64>>,
    /// Logarithm of its determinant.
    log_determinant: f64,
}

impl Accepted {
    /// Place on the path: the time, s, or the part of the way to the first output time.
    fn place(&self) -> f64 {
        self.time.unwrap_or(self.part)
    }
}

/// Equilibrium at an output time.
struct Passed {
    time: f64,
    /// Values of all drivers.
    drivers: Vec<f64>,
    stiffness: Vec<f64>,
}

/// Openings and stiffness at an output time by the polynomial through equilibria at output times before.
struct Prediction {
    /// Number of equilibria used.
    from: usize,
    drivers: Vec<f64>,
    stiffness: Vec<f64>,
}

/// Solver of the equilibria of one design.
pub(crate) struct EquilibriumSolver<'a> {
    model: &'a Model,
    user: &'a Model,
    openings: &'a [DriverId],
    loads: OpeningLoads<'a, f64>,
    turns: ElementTurns,
    variables: usize,
    /// The user's drivers that are held.
    held: Vec<DriverId>,
    /// Body-fixed data of measures.
    fixed: BodyFixed<Dual>,
    last: Accepted,
    /// Place on the path of the equilibrium before, with the same openings, and the logarithm of the determinant there.
    before: Option<[f64; 2]>,
    /// The last equilibria at output times, for predictions.
    path: Vec<Passed>,
    /// The last output time, and values of the user's drivers there.
    reported: Option<(f64, Vec<f64>)>,
    /// Per opening: the force that it needs as a driver.
    forces: Vec<f64>,
    /// Derivatives of the forces by the openings, and its factors.
    stiffness: Vec<f64>,
    tangent: Elimination<f64>,
    /// Per opening: its unit, in which the stiffness is near one.
    units: Vec<f64>,
    /// Per opening: its unit in the design configuration without loads.
    first_units: Option<Vec<f64>>,
    /// Per opening: size of the terms of its stiffness.
    terms: Vec<f64>,
    /// Logarithm of the determinant of the stiffness that was factored last.
    log_determinant: f64,
    /// True if the stiffness that was factored last is regular.
    is_regular: bool,
    /// True if the derivatives are those at the equilibrium that was found last.
    is_prepared: bool,
    /// Shortest part of the way to the next output time or turn of a law.
    shortest: f64,
    /// Iterations so far.
    pub iterations: usize,
}

impl<'a> EquilibriumSolver<'a> {
    /// Solver of the design with these values; `fields` are the design velocities of the variables, if sensitivities
    /// are requested. The first drivers are those of the user's model.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        (openings, kinds): (&'a [DriverId], &'a [MeasureKind]),
        fields: &[DesignVelocity],
        user: &'a Model,
    ) -> Self {
        let model = design_map.model();
        let n = openings.len();
        let held: Vec<DriverId> =
            (0..user.drivers.len()).map(DriverId).filter(|d| !openings.contains(d)).collect();
        let constant: Vec<Dual> = values.iter().map(|x| Dual::constant(*x)).collect();
        Self {
            model,
            user,
            openings,
            loads: OpeningLoads::new(design_map, topology, values, (openings, kinds), fields, &held),
            turns: ElementTurns::new(model, topology),
            variables: fields.len(),
            held,
            fixed: design_map.fixed(&constant),
            last: Accepted {
                time: None,
                part: 0.0,
                drivers: vec![0.0; model.drivers.len()],
                loads: GivenLoads::none(model),
                stiffness: None,
                log_determinant: f64::NAN,
            },
            before: None,
            path: Vec::new(),
            reported: None,
            forces: vec![0.0; n],
            stiffness: vec![0.0; n * n],
            tangent: Elimination::new(n),
            units: vec![1.0; n],
            first_units: None,
            terms: vec![0.0; n],
            log_determinant: f64::NAN,
            is_regular: false,
            is_prepared: false,
            shortest: SHORTEST_AT_FIRST,
            iterations: 0,
        }
    }

    /// Moves the mechanism to its equilibrium at time t, at rest. Before the first it is in the design configuration,
    /// without loads. If laws turn on the way from the last output time, it is followed to there first.
    pub fn step(&mut self, one: &mut Stepper<'_>, t: f64) -> Result<(), Box<Stop>> {
        let mut targets = self.last.time.map_or_else(Vec::new, |from| self.waypoints(one, [from, t]));
        targets.push(t);
        let mut certain = true;
        for (k, target) in targets.into_iter().enumerate() {
            // Where a law turns, a polynomial through equilibria before may lead to another one.
            let prediction = if k == 0 { self.predicted(target) } else { None };
            certain = match self.follow(one, (target, t), prediction) {
                Ok(certain) => certain,
                Err(stop) => return Err(self.undefined_law(one, &stop, t).unwrap_or(stop)),
            };
        }
        if self.path.len() == PREDICTED_FROM {
            self.path.remove(0);
        }
        one.effort.equilibrium_iterations = self.iterations;
        if !certain && one.effort.uncertain_stability.is_none() {
            one.effort.uncertain_stability = Some(t);
        }
        advance::count(one);
        let (drivers, stiffness) = (self.last.drivers.clone(), self.stiffness.clone());
        self.path.push(Passed { time: t, drivers, stiffness });
        self.reported = Some((t, self.user_drivers(one)));
        self.shortest = SHORTEST_AT_FIRST;
        Ok(())
    }

    /// Continues from the equilibrium that another solver accepted last, with other openings of the same mechanism.
    /// The position of the stepper is there. Returns false if it is not an equilibrium that can be continued.
    pub fn continue_from(&mut self, before: &Self, one: &mut Stepper<'_>) -> bool {
        self.last = Accepted {
            time: before.last.time,
            part: before.last.part,
            drivers: one.mechanism.drivers.iter().map(|[value, ..]| *value).collect(),
            loads: before.last.loads.clone(),
            stiffness: None,
            log_determinant: f64::NAN,
        };
        self.reported.clone_from(&before.reported);
        self.shortest = before.shortest;
        self.iterations = before.iterations;
        let given = self.last.loads.clone();
        let is_stable = self.examine(one, &given).is_ok();
        self.last.stiffness = Some(self.stiffness.clone());
        self.last.log_determinant = self.log_determinant;
        is_stable
    }

    /// True if a step that fails ends the motion with these openings.
    pub fn takes_shortest_steps(&self) -> bool {
        self.shortest <= SHORTEST
    }

    /// Permits shorter steps, since no other openings describe the way better so far.
    pub fn permit_shorter_steps(&mut self) {
        self.shortest = f64::max(SHORTEST, SHORTER * self.shortest);
    }

    /// Part of the way to the first output time, and the time, of the equilibrium that was accepted last.
    pub fn reached(&self) -> (f64, Option<f64>) {
        (self.last.part, self.last.time)
    }

    /// Times between two output times at which laws of loads and drivers turn.
    fn waypoints(&self, one: &Stepper<'_>, ends: [f64; 2]) -> Vec<f64> {
        let of_drivers = self.held.iter().map(|d| one.mechanism.parts.law_of(d.0));
        let of_loads = self.model.elements.iter().filter_map(|element| element.kind.law(self.model));
        waypoints(of_drivers.chain(of_loads), ends)
    }

    /// Follows the equilibrium from the one that was accepted last (or the design configuration without loads) to that
    /// at time t, on the way to an output time. Returns true if it is certainly stable.
    fn follow(
        &mut self,
        one: &mut Stepper<'_>,
        (t, output): (f64, f64),
        mut prediction: Option<Prediction>,
    ) -> Result<bool, Box<Stop>> {
        let from = self.last.time;
        let mut done = if from.is_none() { self.last.part } else { 0.0 };
        let (mut part, mut certain) = (1.0, true);
        while done < 1.0 {
            let next = f64::min(done + part, 1.0);
            self.is_prepared = false;
            let (time, drivers, loads) = self.on_the_way(one, (from, t), next);
            let prediction = prediction.take();
            let is_predicted = prediction.is_some();
            let found = match prediction {
                Some(prediction) => self.attempt_predicted(one, drivers, &loads, prediction),
                None => self.attempt(one, drivers, &loads),
            };
            match found {
                Ok((drivers, is_stable)) => {
                    advance::accept_at_rest(one, time);
                    certain = is_stable;
                    (done, part) = (next, 2.0 * part);
                    let reached = (from.is_some() || done == 1.0).then_some(time);
                    let (stiffness, log_determinant) = (Some(self.stiffness.clone()), self.log_determinant);
                    // Times and parts of the way to the first output time cannot be compared.
                    self.before = (self.last.time.is_some() == reached.is_some())
                        .then_some([self.last.place(), self.last.log_determinant]);
                    self.last =
                        Accepted { time: reached, part: done, drivers, loads, stiffness, log_determinant };
                    if time < output {
                        // Ever shorter steps would follow the law beyond all bounds.
                        self.unbounded_law(one, time, output).map_or(Ok(()), Err)?;
                    }
                }
                // The same way from the equilibrium that was found last.
                Err(_) if is_predicted => {}
                Err(rejection) => {
                    part *= 0.5;
                    if part < self.shortest {
                        return Err(self.stop(one, (from, t), done, rejection));
                    }
                }
            }
        }
        Ok(certain)
    }

    /// Time, drivers and loads after this part of the way to time t, with the openings where they are. The way to the
    /// first output time leads straight from the design configuration without loads; others follow the laws.
    fn on_the_way(
        &self,
        one: &Stepper<'_>,
        (from, t): (Option<f64>, f64),
        part: f64,
    ) -> (f64, Vec<f64>, GivenLoads) {
        let mut drivers = self.last.drivers.clone();
        let law = |d: &DriverId, time: f64| one.mechanism.parts.law(d.0, time)[0];
        match from {
            None => {
                self.held.iter().for_each(|d| drivers[d.0] = part * law(d, t));
                (t, drivers, GivenLoads::at(self.model, t).times(part))
            }
            Some(from) => {
                let time = if part == 1.0 { t } else { from + (t - from) * part };
                self.held.iter().for_each(|d| drivers[d.0] = law(d, time));
                (time, drivers, GivenLoads::at(self.model, time))
            }
        }
    }

    /// Openings and stiffness at time t by the polynomial through the last equilibria; through fewer of them if it
    /// would amplify what it does not follow.
    fn predicted(&self, t: f64) -> Option<Prediction> {
        let weights = |path: &[Passed]| -> Vec<f64> {
            let weight = |(i, passed): (usize, &Passed)| {
                let others = path.iter().enumerate().filter(|(j, _)| *j != i);
                others.map(|(_, other)| (t - other.time) / (passed.time - other.time)).product()
            };
            path.iter().enumerate().map(weight).collect()
        };
        let mut path = &self.path[..];
        while !path.is_empty() {
            let weights = weights(path);
            if weights.iter().map(|w: &f64| w.abs()).sum::<f64>() <= AMPLIFIED {
                let sum = |of: fn(&Passed) -> &Vec<f64>| {
                    let mut sum = vec![0.0; of(&path[0]).len()];
                    for (weight, passed) in weights.iter().zip(path) {
                        sum.iter_mut().zip(of(passed)).for_each(|(sum, p)| *sum += weight * p);
                    }
                    sum
                };
                let (drivers, stiffness) = (sum(|passed| &passed.drivers), sum(|passed| &passed.stiffness));
                return Some(Prediction { from: path.len(), drivers, stiffness });
            }
            path = &path[1..];
        }
        None
    }

    /// Solves the equilibrium from a prediction. It continues the path if it confirms the prediction: the output
    /// times resolve the path.
    fn attempt_predicted(
        &mut self,
        one: &mut Stepper<'_>,
        mut drivers: Vec<f64>,
        given: &GivenLoads,
        prediction: Prediction,
    ) -> Result<(Vec<f64>, bool), Rejection> {
        for d in self.openings {
            drivers[d.0] = prediction.drivers[d.0];
        }
        advance::move_at_rest(one, &drivers).map_err(Rejection::of)?;
        self.stiffness.clone_from(&prediction.stiffness);
        self.factor()?;
        let first = self.correct(one, &mut drivers, given, true)?;
        let is_stable = self.examine(one, given)?;
        let before = &self.path[self.path.len() - prediction.from..];
        let distances = before.iter().map(|passed| self.distance(one, &drivers, &passed.drivers));
        let way = distances.fold(0.0, f64::max);
        // From one equilibrium alone the first correction, by the stiffness there, is the prediction.
        let position = if prediction.from == 1 { &first } else { &prediction.drivers };
        match self.confirms(one, &drivers, (position, &prediction.stiffness), way) {
            true => Ok((drivers, is_stable)),
            false => Err(Rejection::NoConvergence),
        }
    }

    /// True if the equilibrium with these drivers, whose stiffness was set last, confirms a predicted position and
    /// stiffness; `way` is the largest distance to the equilibria that the prediction connects.
    fn confirms(
        &self,
        one: &Stepper<'_>,
        drivers: &[f64],
        (position, stiffness): (&[f64], &[f64]),
        way: f64,
    ) -> bool {
        // abs(p - predicted) <= 0.1 max abs(p - p_k),  abs(dp . (K - predicted) dp) <= 0.1 abs(dp . K dp)
        let step = self.between(&self.last.drivers, drivers);
        let [predicted, found] = number::both([stiffness, &self.stiffness], |k| along(k, &step));
        self.distance(one, drivers, position) <= f64::max(CONFIRMED * way, QUADRATIC)
            && (way <= NEAR || (found - predicted).abs() <= CONFIRMED * found.abs())
    }

    /// Solves the equilibrium from the one that was accepted last. It continues the path if the equilibrium stays
    /// stable from there to here: the stiffness is positive under the new loads before the openings change, at the
    /// end of their change and, unless the first correction by it was nearly right, in the middle, and nowhere much
    /// smaller than before and after. In a region where it is positive under all loads of the step there is one
    /// equilibrium for each of them.
    fn attempt(
        &mut self,
        one: &mut Stepper<'_>,
        mut drivers: Vec<f64>,
        given: &GivenLoads,
    ) -> Result<(Vec<f64>, bool), Rejection> {
        advance::move_at_rest(one, &drivers).map_err(Rejection::of)?;
        let positive = self.prepare_with(one, given)?;
        self.is_certainly_stable(positive)?;
        let under_loads = self.stiffness.clone();
        let first = self.correct(one, &mut drivers, given, false)?;
        let way = self.distance(one, &drivers, &self.last.drivers);
        let step = self.between(&self.last.drivers, &drivers);
        let begin = along(&under_loads, &step);
        // dp . K(p_0, c) dp >= 1/2 dp . K(p_0, c_0) dp
        let without = self.last.stiffness.as_ref().map(|stiffness| along(stiffness, &step));
        if way > NEAR && without.is_some_and(|without| !(begin >= LEFT_BY_LOADS * without)) {
            return Err(Rejection::NoConvergence);
        }
        let is_stable = self.examine(one, given)?;
        if way <= NEAR || self.confirms(one, &drivers, (&first, &under_loads), way) {
            return Ok((drivers, is_stable));
        }
        // dp . K(p_0 + dp/2, c) dp >= 1/2 min(dp . K(p_0, c) dp, dp . K(p_0 + dp, c) dp)
        let least = f64::min(begin, along(&self.stiffness, &step));
        let mut middle = drivers.clone();
        for (d, step) in self.openings.iter().zip(&step) {
            middle[d.0] -= 0.5 * step;
        }
        advance::shift_at_rest(one, &middle).map_err(Rejection::of)?;
        let positive = self.prepare_with(one, given)?;
        self.is_certainly_stable(positive).map_err(|_| Rejection::NoConvergence)?;
        if !(along(&self.stiffness, &step) >= least - (1.0 - LEFT_IN_MIDDLE) * least.abs()) {
            return Err(Rejection::NoConvergence);
        }
        advance::shift_at_rest(one, &drivers).map_err(Rejection::of)?;
        self.examine(one, given)?;
        Ok((drivers, is_stable))
    }

    /// Sets the derivatives at the equilibrium that was found. Returns true if it is certainly stable.
    fn examine(&mut self, one: &mut Stepper<'_>, given: &GivenLoads) -> Result<bool, Rejection> {
        let positive = self.prepare_with(one, given)?;
        let is_stable = self.is_certainly_stable(positive)?;
        self.is_prepared = true;
        Ok(is_stable)
    }

    /// Change of the openings between two positions.
    fn between(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        self.openings.iter().map(|d| to[d.0] - from[d.0]).collect()
    }

    /// Largest change of an opening between two positions, rad or sizes.
    fn distance(&self, one: &Stepper<'_>, from: &[f64], to: &[f64]) -> f64 {
        let change = |d: &DriverId| (to[d.0] - from[d.0]).abs() / one.mechanism.driver_units[d.0];
        self.openings.iter().map(change).fold(0.0, f64::max)
    }

    /// Corrects the openings of these drivers, from their position that was solved last, until they are in
    /// equilibrium under these loads. The stiffness that was factored last serves for the first correction; it is
    /// predicted, or that of the position. Returns the drivers after the first correction.
    fn correct(
        &mut self,
        one: &mut Stepper<'_>,
        drivers: &mut [f64],
        given: &GivenLoads,
        is_predicted: bool,
    ) -> Result<Vec<f64>, Rejection> {
        let mut first = Vec::new();
        // A predicted stiffness is good for the first correction if it is not too long.
        let mut before = LONGEST / SAME_STIFFNESS;
        for pass in 0..MOST_ITERATIONS {
            self.iterations += 1;
            self.set_forces(one, given);
            // A stiffness serves as long as the corrections shrink fast.
            let (mut correction, mut size) = self.correction(one);
            let is_of_position = pass == 0 && !is_predicted;
            let serves = is_of_position || size <= SAME_STIFFNESS * before;
            if !serves {
                self.set_tangent(one);
                let positive = self.factor()?;
                // Beyond a position that is not stable there may be another equilibrium.
                if !is_predicted {
                    self.is_certainly_stable(positive).map_err(|_| Rejection::NoConvergence)?;
                }
                (correction, size) = self.correction(one);
            }
            let is_new = is_of_position || !serves;
            let limit = if pass < 2 { LONGEST } else { CONTRACTION * before };
            if !(size <= limit) {
                return Err(Rejection::NoConvergence);
            }
            for (dp, d) in correction.iter().zip(self.openings) {
                drivers[d.0] += dp;
            }
            advance::shift_at_rest(one, drivers).map_err(Rejection::of)?;
            // The error that remains is the square of the correction, or what an unchanged stiffness leaves of it.
            let shrinks = if pass == 0 { SAME_STIFFNESS } else { size / before };
            let is_solved = if is_new { size <= QUADRATIC } else { size * shrinks <= ROUND_OFF };
            if pass == 0 {
                first = drivers.to_vec();
            }
            if is_solved {
                return Ok(first);
            }
            before = size;
        }
        Err(Rejection::NoConvergence)
    }

    /// Correction of the openings by the stiffness that was factored last, `K dp = -r` (52), and its size.
    fn correction(&mut self, one: &Stepper<'_>) -> (Vec<f64>, f64) {
        let mut correction: Vec<f64> = self.forces.iter().map(|r| -r).collect();
        self.respond(&mut correction);
        let mut size = 0.0_f64;
        for (dp, d) in correction.iter().zip(self.openings) {
            let scaled = (dp / one.mechanism.driver_units[d.0]).abs();
            // NaN is larger than anything.
            size = if scaled <= size { size } else { scaled };
        }
        (correction, size)
    }

    /// Sets the derivatives at the position of the stepper under these loads. Returns the sign of the determinant of
    /// the stiffness.
    fn prepare_with(&mut self, one: &mut Stepper<'_>, given: &GivenLoads) -> Result<bool, Rejection> {
        self.is_prepared = false;
        self.set_forces(one, given);
        self.set_tangent(one);
        self.factor()
    }

    /// Sets the forces of the openings at the position of the stepper, under these loads.
    fn set_forces(&mut self, one: &mut Stepper<'_>, given: &GivenLoads) {
        let near = self.turns.at(one);
        let Mechanism { topology, state, .. } = &mut one.mechanism;
        self.loads.forces((topology, state), &near, given, |k, force| self.forces[k] = force);
    }

    /// Sets the stiffness at the position of the stepper.
    fn set_tangent(&mut self, one: &mut Stepper<'_>) {
        let Self { openings, loads, stiffness, terms, .. } = self;
        loads.prepare(&one.mechanism.topology, &mut one.mechanism.state);
        loads.stiffness(|a, b, slope| stiffness[a * openings.len() + b] = slope);
        terms.copy_from_slice(loads.terms_of_own_stiffness());
    }

    /// Factors the stiffness in units of the openings. Returns the sign of its determinant.
    fn factor(&mut self) -> Result<bool, Rejection> {
        let n = self.openings.len();
        for a in 0..n {
            // A stiffness that is round-off stays so in its unit.
            let (own, terms) = (self.stiffness[a * n + a].abs(), self.terms[a]);
            let size = if own > ROUND_OFF_OF_TERMS * terms { own } else { terms };
            self.units[a] = if size > 0.0 { 1.0 / size.sqrt() } else { 1.0 };
        }
        if self.first_units.is_none() {
            self.first_units = Some(self.units.clone());
        }
        for a in 0..n {
            for (b, to) in self.tangent.row_mut(a).iter_mut().enumerate() {
                *to = self.stiffness[a * n + b] * self.units[a] * self.units[b];
            }
        }
        let factored = self.tangent.factor();
        self.log_determinant =
            factored.determinant.ln() - 2.0 * self.units.iter().map(|unit| unit.ln()).sum::<f64>();
        self.is_regular = n == 0 || factored.pivot_ratio > HOLDS_NOTHING;
        if self.is_regular { Ok(factored.positive) } else { Err(Rejection::NothingHolds) }
    }

    /// True if every virtual motion from the equilibrium whose stiffness was set last needs work; false if one does
    /// not, but the forces have no potential. `positive` is the sign of the determinant: the design configuration
    /// without loads is stable, and without a change of the sign an even number of directions may have become unstable.
    fn is_certainly_stable(&self, positive: bool) -> Result<bool, Rejection> {
        let n = self.openings.len();
        let scaled = |a: usize, b: usize| self.stiffness[a * n + b] * self.units[a] * self.units[b];
        let symmetric = |a: usize| (0..n).map(|b| 0.5 * (scaled(a, b) + scaled(b, a))).collect();
        let all_need_work = || is_definite(&(0..n).map(symmetric).collect::<Vec<_>>());
        let has_potential =
            || (0..n).all(|a| (0..a).all(|b| (scaled(a, b) - scaled(b, a)).abs() <= UNSYMMETRIC));
        match positive && all_need_work() {
            true => Ok(true),
            false if !positive || has_potential() => Err(Rejection::Unstable),
            false => Ok(false),
        }
    }

    /// Names the direction of least stiffness at the position whose stiffness was set last, in the units of the design
    /// configuration without loads. If no force resists it (`is_free`) it is exact.
    fn least_stiff(&self, one: &Stepper<'_>, is_free: bool) -> Option<GivingDirection> {
        let n = self.openings.len();
        let units = self.first_units.as_ref().unwrap_or(&self.units);
        let scaled = |a: usize, b: usize| self.stiffness[a * n + b] * units[a] * units[b];
        let rows = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            (0..n).map(|a| (0..n).map(|b| entry(a, b)).collect()).collect()
        };
        let mut symmetric = rows(&|a, b| 0.5 * (scaled(a, b) + scaled(b, a)));
        let mut vectors = rows(&|a, b| f64::from(u8::from(a == b)));
        diagonalise(&mut symmetric, &mut vectors, n);
        let least = (0..n).map(|k| symmetric[k][k]).fold(f64::INFINITY, f64::min);
        vectors = (0..n)
            .filter(|k| symmetric[*k][*k] <= least + EQUALLY_STIFF)
            .map(|k| vectors[k].clone())
            .collect();
        // Of several directions that with the most of a single opening: the projection of that opening on them.
        let share = |k: usize| vectors.iter().map(|v| v[k] * v[k]).sum();
        let mainly = first_largest((0..n).map(share))?;
        let speed = |k: usize| units[k] * vectors.iter().map(|v| v[mainly] * v[k]).sum::<f64>();
        self.name(one, &(0..n).map(speed).collect::<Vec<_>>(), is_free)
    }

    /// Names a motion in which the openings have these speeds, at the position whose stiffness was set last.
    fn name(&self, one: &Stepper<'_>, speeds: &[f64], is_free: bool) -> Option<GivingDirection> {
        let Mechanism { state, driver_units, .. } = &one.mechanism;
        let twist = |b: usize| {
            let openings = self.loads.unit_twists().zip(speeds);
            openings.fold(Twist::ZERO, |sum, (w, v)| w[b].times_plus(*v, sum))
        };
        let twists: Vec<Twist> = (0..self.model.bodies.len()).map(twist).collect();
        let points = self.model.points.iter().zip(&self.fixed.points);
        let global = points.map(|(point, at)| match point.body.0 {
            0 => at.value(),
            body => state.pose[body].point(at.value()),
        });
        let named = NamedOpenings {
            model: self.model,
            openings: self.openings,
            own_drivers: self.user.drivers.len(),
            units: driver_units,
            points: global.collect(),
            size: self.fixed.size,
        };
        named.name(speeds, &twists, is_free)
    }

    /// The stiffest direction, if round-off of its force hides how the least stiff one is held.
    fn too_stiff(&self, one: &Stepper<'_>) -> Option<GivingDirection> {
        let n = self.openings.len();
        let first = self.first_units.as_ref()?;
        // In rad and sizes, a stiffness is an energy.
        let unit = |a: usize| one.mechanism.driver_units[self.openings[a].0];
        let least = (0..n).map(|a| (unit(a) / first[a]).powi(2)).fold(f64::INFINITY, f64::min);
        let own = |a: usize| self.stiffness[a * n + a].abs() * unit(a).powi(2);
        let terms = |a: usize| self.terms[a] * unit(a).powi(2);
        let is_known = |a: usize| own(a) > ROUND_OFF_OF_TERMS * terms(a);
        let stiffest = first_largest((0..n).map(|a| if is_known(a) { own(a) } else { 0.0 }))?;
        // Of positions, as a force; and of the terms of a stiffness that is nothing beside them.
        let of_positions = f64::EPSILON * own(stiffest);
        let of_terms = (0..n).filter(|a| !is_known(*a)).map(|a| ROUND_OFF_OF_TERMS * terms(a));
        let hides = of_terms.fold(of_positions, f64::max) >= HIDDEN * least;
        let alone = (0..n).map(|a| if a == stiffest { 1.0 } else { 0.0 });
        if hides { self.name(one, &alone.collect::<Vec<_>>(), true) } else { None }
    }

    /// The end of the way to the output time t by a law that has no value right after it, or that grows there without
    /// bound; `stop` is the end as the loads show it.
    fn undefined_law(&self, one: &Stepper<'_>, stop: &Stop, t: f64) -> Option<Box<Stop>> {
        let from = self.reported.as_ref()?.0;
        if matches!(stop.kind, StopKind::Locked { .. }) {
            return None;
        }
        let begin = stop.failed_time;
        // Beyond the shortest step that failed.
        let end = f64::min(begin + 2.0 * SHORTEST * (t - from), t);
        let has_no_value = |(kind, law): (StopKind, &Law)| {
            (!law.at(end).value().is_finite()).then(|| self.stop_as(one, kind, begin))
        };
        self.laws(one).find_map(has_no_value).or_else(|| self.unbounded_law(one, begin, t))
    }

    /// The end of the way to the output time t by a law that has grown without bound up to this time.
    fn unbounded_law(&self, one: &Stepper<'_>, reached: f64, t: f64) -> Option<Box<Stop>> {
        let from = self.reported.as_ref()?.0;
        self.laws(one).find_map(|(kind, law)| {
            let value = |t: f64| law.at(t).value().abs();
            let nears_pole = value(reached) >= NEARS_POLE * f64::max(value(from), value(t));
            let pole = if nears_pole { first_undefined(law, [reached, t])? } else { return None };
            Some(self.stop_as(one, kind, pole))
        })
    }

    /// Laws of the drivers that are held and of the loads, each with the end of a motion where it has no value.
    fn laws<'s>(&'s self, one: &'s Stepper<'_>) -> impl Iterator<Item = (StopKind, &'s Law)> {
        let of_driver =
            |d: &DriverId| (StopKind::LawNotFinite { driver: *d }, one.mechanism.parts.law_of(d.0));
        let of_loads = self.model.elements.iter().enumerate().filter_map(|(e, element)| {
            Some((StopKind::LoadNotFinite { force: ElementId(e) }, element.kind.law(self.model)?))
        });
        self.held.iter().map(of_driver).chain(of_loads)
    }

    /// Sets the derivatives at the equilibrium that was found last, unless they are set.
    fn prepare(&mut self, one: &mut Stepper<'_>) {
        if !self.is_prepared {
            let given = self.last.loads.clone();
            // A singular stiffness gives derivatives that are not known.
            let _ = self.prepare_with(one, &given);
            self.is_prepared = true;
        }
    }

    /// Derivatives of the openings by the variables, `p_b = -K^-1 r_b` with r_b those of their forces while all
    /// openings are fixed (53); `each` receives the variable and the derivatives.
    pub fn differentiate(&mut self, one: &mut Stepper<'_>, t: f64, mut each: impl FnMut(usize, &[f64])) {
        self.prepare(one);
        for v in 0..self.variables {
            let rates = self.openings_along(one, v, t);
            each(v, &rates);
        }
    }

    /// Derivatives of the openings by each driver that is held.
    pub fn driver_rates(&mut self, one: &mut Stepper<'_>, t: f64) -> Vec<(DriverId, Vec<f64>)> {
        self.prepare(one);
        let first = self.variables;
        let held = self.held.clone();
        held.into_iter().enumerate().map(|(k, d)| (d, self.openings_along(one, first + k, t))).collect()
    }

    /// Derivatives of the openings along a direction of the loads: variables, then held drivers.
    fn openings_along(&mut self, one: &mut Stepper<'_>, direction: usize, t: f64) -> Vec<f64> {
        let mut rates = vec![0.0; self.openings.len()];
        let Mechanism { topology, state, parts, .. } = &mut one.mechanism;
        let set_time = |field: &mut PlanVelocity<f64>| field.set_time(|d| parts.law_of(d.0), t);
        self.loads.derivatives((topology, state), direction, set_time, &mut rates, |_| ());
        rates.iter_mut().for_each(|r| *r = -*r);
        self.respond(&mut rates);
        rates
    }

    /// Solves `K p = f` in place: the openings that these forces on them cause; NaN if the stiffness is singular.
    fn respond(&mut self, forces: &mut [f64]) {
        forces.iter_mut().zip(&self.units).for_each(|(f, unit)| *f *= unit);
        self.tangent.solve(forces);
        let known = if self.is_regular { 1.0 } else { f64::NAN };
        forces.iter_mut().zip(&self.units).for_each(|(p, unit)| *p *= unit * known);
    }

    /// Derivatives of the openings by a unit force: `K v = W_a . f`.                                            (54)
    fn openings_by_force(&mut self, force: UnitForce) -> Vec<f64> {
        let force = self.loads.unit_force(force);
        let work = |w: &[Twist]| force.iter().map(|(body, f)| f.on(w[*body])).sum();
        let mut response: Vec<f64> = self.loads.unit_twists().map(work).collect();
        self.respond(&mut response);
        response
    }

    /// Poses of all bodies with their derivatives by a unit force.
    fn poses_by_force(&mut self, one: &Stepper<'_>, force: UnitForce) -> Vec<Pose<Dual>> {
        let response = self.openings_by_force(force);
        let pose = |b: usize| if b == 0 { Pose::IDENTITY } else { one.mechanism.state.pose[b] };
        let along = |b: usize| {
            let openings = self.loads.unit_twists().zip(&response);
            pose(b).along(openings.fold(Twist::ZERO, |sum, (w, v)| w[b].times_plus(*v, sum)))
        };
        (0..self.model.bodies.len()).map(along).collect()
    }

    /// Derivatives of the openings along a direction; `None` along a driver that is released.
    fn rates(&mut self, one: &mut Stepper<'_>, t: f64, direction: &Along) -> Option<Vec<f64>> {
        self.prepare(one);
        let n = self.openings.len();
        match direction {
            Along::Force(force) => Some(self.openings_by_force(*force)),
            Along::Driver(driver) => {
                let held = self.held.iter().position(|d| d == driver)?;
                Some(self.openings_along(one, self.variables + held, t))
            }
            Along::Design(speeds) => {
                let mut sum = vec![0.0; n];
                for (v, speed) in speeds.iter().enumerate().filter(|(_, speed)| **speed != 0.0) {
                    let rates = self.openings_along(one, v, t);
                    sum.iter_mut().zip(rates).for_each(|(sum, rate)| *sum += speed * rate);
                }
                Some(sum)
            }
        }
    }

    /// Solves second derivatives along direction k at the equilibrium that was found last. Returns false along a driver
    /// that is released.
    pub fn curve(
        &mut self,
        one: &mut Stepper<'_>,
        t: f64,
        curvatures: &mut Curvatures<'_>,
        k: usize,
    ) -> bool {
        let direction = curvatures.direction(k).clone();
        let Some(rates) = self.rates(one, t, &direction) else { return false };
        let near = self.turns.at(one);
        let at = SolvedEquilibrium { time: t, near: &near, loads: &self.last.loads, units: &self.units };
        curvatures.solve(&mut one.mechanism, &at, k, &rates);
        true
    }

    /// Writes the compliances at the equilibrium: derivatives of outputs by forces, with all loads there; and their
    /// derivatives by the variables, with the curvatures along the forces.
    pub fn add_compliances(
        &mut self,
        one: &mut Stepper<'_>,
        t: f64,
        curvatures: Option<&mut Curvatures<'_>>,
        out: &mut StepValues,
    ) {
        let model = self.model;
        let asked = || {
            let kinds = model.measures.iter().enumerate();
            kinds.filter_map(|(m, measure)| measure.kind.compliance().map(|(of, force)| (m, of, force)))
        };
        let mut moved: Vec<(UnitForce, Vec<Pose<Dual>>)> = Vec::new();
        for (m, of, force) in asked() {
            if !moved.iter().any(|(by, _)| *by == force) {
                self.prepare(one);
                moved.push((force, self.poses_by_force(one, force)));
            }
            for (_, poses) in moved.iter().filter(|(by, _)| *by == force) {
                out.set(m, Instant::new(model, &self.fixed, poses).output(of).d);
            }
        }
        let Some(curvatures) = curvatures else { return };
        for k in 0..curvatures.len() {
            let Along::Force(grows) = *curvatures.direction(k) else { continue };
            self.curve(one, t, curvatures, k);
            for v in 0..self.variables {
                let poses = curvatures.poses(v);
                let instant = Instant::new(model, &curvatures.fixed[v], &poses);
                for (m, of, _) in asked().filter(|(.., force)| *force == grows) {
                    out.set_d(v, m, instant.output(of).d.d);
                }
            }
        }
    }

    /// Poses while each driver moves alone; those of released drivers are not known.
    pub fn poses_along_drivers(
        &mut self,
        one: &mut Stepper<'_>,
        t: f64,
        curvatures: &mut Curvatures<'_>,
    ) -> Vec<DriverPoses> {
        let mut found = Vec::new();
        for k in 0..curvatures.len() {
            let Along::Driver(driver) = *curvatures.direction(k) else { continue };
            if self.curve(one, t, curvatures, k) {
                let of = |v: usize| curvatures.poses(v).into_iter().map(Pose::exchanged).collect();
                found.push(DriverPoses { driver, by_variable: (0..self.variables).map(of).collect() });
            }
        }
        found
    }

    /// Sets the stiffness in the design configuration without loads. True if nothing holds a direction there.
    fn is_unheld(&mut self, one: &mut Stepper<'_>) -> bool {
        advance::move_at_rest(one, &self.last.drivers).is_ok()
            && match self.prepare_with(one, &GivenLoads::none(self.model)) {
                Err(Rejection::NothingHolds) => true,
                Err(Rejection::Locked(_) | Rejection::NoConvergence | Rejection::Unstable) | Ok(_) => false,
            }
    }

    /// Reason why the way to the equilibrium at time t, from that at time `from`, ends after a part of it.
    fn stop(
        &mut self,
        one: &mut Stepper<'_>,
        (from, t): (Option<f64>, f64),
        done: f64,
        rejection: Rejection,
    ) -> Box<Stop> {
        let failed_time = from.map_or(t, |from| from + (t - from) * done);
        let begins = self.reported.is_none() && done == 0.0;
        if let Rejection::Locked(rejection) = rejection {
            let kind = advance::stop_at_rest(one, t, rejection).kind;
            return self.stop_as(one, kind, failed_time);
        }
        // Named before the position changes.
        let least_stiff = self.least_stiff(one, begins);
        let too_stiff = self.too_stiff(one);
        let is_unheld = begins && self.is_unheld(one);
        let named = if is_unheld {
            let too_stiff = self.too_stiff(one).map(|direction| StopKind::TooStiff { direction });
            too_stiff
                .or_else(|| self.least_stiff(one, true).map(|direction| StopKind::NothingHolds { direction }))
        } else if let Some(direction) = too_stiff {
            Some(StopKind::TooStiff { direction })
        } else {
            match (rejection, least_stiff) {
                (Rejection::NothingHolds, Some(direction)) if begins => {
                    Some(StopKind::NothingHolds { direction })
                }
                // A stiffness that vanishes on the way has held all directions before.
                (Rejection::NothingHolds | Rejection::Unstable, Some(direction)) => {
                    Some(StopKind::Unstable { direction })
                }
                (Rejection::NoConvergence | Rejection::Locked(_), _) | (_, None) => None,
            }
        };
        let kind = named.unwrap_or(match self.reported {
            None => StopKind::LimitLoad { part: done },
            Some(_) => StopKind::NoEquilibrium,
        });
        let snaps_through = self.ends_at_singular_stiffness(t);
        Box::new(Stop { snaps_through, ..*self.stop_as(one, kind, failed_time) })
    }

    /// True if the determinant of the stiffness vanishes where the path ends, on the way to an output time. Towards a
    /// limit load it goes with the root of the distance, so that its square is extrapolated.
    fn ends_at_singular_stiffness(&self, t: f64) -> bool {
        let Some([place, log_determinant]) = self.before else { return false };
        let way = self.last.time.map_or(1.0, |_| t - self.reported.as_ref().map_or(t, |(time, _)| *time));
        // s* - s_2 = (s_2 - s_1) r^2 / (1 - r^2),  r = det K_2 / det K_1
        let square = (2.0 * (self.last.log_determinant - log_determinant)).exp();
        let distance = (self.last.place() - place) * square / (1.0 - square);
        (0.0..=ENDS_AT_SINGULAR * way).contains(&distance)
    }

    /// Values of the user's drivers at the equilibrium that was accepted last.
    fn user_drivers(&self, one: &Stepper<'_>) -> Vec<f64> {
        let own = self.user.drivers.iter().zip(&self.last.drivers);
        let mut values: Vec<f64> = own.map(|(driver, by)| driver.with_sense(*by)).collect();
        one.write_released(self.user, &mut values);
        values
    }

    /// End of the run for this reason; the results up to the last output time are kept.
    fn stop_as(&self, one: &Stepper<'_>, kind: StopKind, failed_time: f64) -> Box<Stop> {
        let at_output = self.reported.as_ref();
        Box::new(Stop {
            kind,
            last_time: at_output.map(|(time, _)| *time),
            failed_time,
            drivers: at_output.map_or_else(|| self.user_drivers(one), |(_, drivers)| drivers.clone()),
            block: None,
            pivot_ratio: 1.0,
            joints: Vec::new(),
            remains: Vec::new(),
            closed: None,
            snaps_through: false,
        })
    }
}

/// Stiffness along a change of the openings, `dp . K dp`.
fn along(stiffness: &[f64], step: &[f64]) -> f64 {
    let rows = stiffness.chunks_exact(step.len().max(1));
    rows.zip(step).map(|(row, a)| a * row.iter().zip(step).map(|(k, b)| k * b).sum::<f64>()).sum()
}
