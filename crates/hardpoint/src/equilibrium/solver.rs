//! Equilibria of a mechanism at its output times, by Newton's method on the openings.

use crate::design::{BodyFixed, DesignMap, DesignVelocity};
use crate::linalg::semidefinite::is_definite;
use crate::linalg::{Elimination, Factored};
use crate::load::{ElementTurns, GivenLoads, OpeningLoads};
use crate::measure::{DriverPoses, Instant, StepValues};
use crate::model::{DriverId, MeasureKind, Model, UnitForce};
use crate::motion::mechanism::{Mechanism, StepRejection};
use crate::motion::stepper::Stepper;
use crate::motion::{GivingDirection, Stop, StopKind, advance};
use crate::number::Dual;
use crate::sensitivity::PlanVelocity;
use crate::space::{Pose, Twist};
use crate::topology::Topology;

use super::second::{Along, Curvatures, SolvedEquilibrium};

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
/// Each correction is below this fraction of the one before, from the second on.
const CONTRACTION: f64 = 0.5;
/// Largest first correction of an attempt, rad or sizes: a longer one may lead to another equilibrium.
const LONGEST: f64 = 0.5;
/// Shortest part of the way from one equilibrium to the next: if it is rejected, there is none near by.
const SHORTEST: f64 = 1e-9;
/// Number of equilibria that a prediction uses.
const PREDICTED_FROM: usize = 3;
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
    /// The equilibrium is not stable.
    Unstable,
    /// No force resists a motion of this opening.
    NothingHolds(usize),
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

/// Accepted equilibrium.
struct Accepted {
    /// Time; `None` before the first.
    time: Option<f64>,
    /// Values of all drivers.
    drivers: Vec<f64>,
    loads: GivenLoads,
}

/// Equilibrium at an output time.
struct Passed {
    time: f64,
    openings: Vec<f64>,
    stiffness: Vec<f64>,
}

/// Solver of the equilibria of one design.
pub(crate) struct EquilibriumSolver<'a> {
    model: &'a Model,
    openings: &'a [DriverId],
    loads: OpeningLoads<'a, f64>,
    turns: ElementTurns,
    variables: usize,
    /// Number of the user's drivers, which come first, and those of them that are held.
    own_drivers: usize,
    held: Vec<DriverId>,
    /// Body-fixed data of measures.
    fixed: BodyFixed<Dual>,
    last: Accepted,
    /// The last equilibria at output times, for predictions.
    path: Vec<Passed>,
    /// Per opening: the force that it needs as a driver.
    forces: Vec<f64>,
    /// Derivatives of the forces by the openings, and its factors.
    stiffness: Vec<f64>,
    tangent: Elimination<f64>,
    /// Per opening: its unit, in which the stiffness is near one.
    units: Vec<f64>,
    /// True if the stiffness that was factored last is regular.
    is_regular: bool,
    /// True if the derivatives are those at the equilibrium that was found last.
    is_prepared: bool,
    /// Iterations so far.
    pub iterations: usize,
}

impl<'a> EquilibriumSolver<'a> {
    /// Solver of the design with these values; `fields` are the design velocities of the variables, if sensitivities
    /// are requested. The first drivers are the user's.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        (openings, kinds): (&'a [DriverId], &'a [MeasureKind]),
        fields: &[DesignVelocity],
        own_drivers: usize,
    ) -> Self {
        let model = design_map.model();
        let n = openings.len();
        let held: Vec<DriverId> = (0..own_drivers).map(DriverId).filter(|d| !openings.contains(d)).collect();
        let constant: Vec<Dual> = values.iter().map(|x| Dual::constant(*x)).collect();
        Self {
            model,
            openings,
            loads: OpeningLoads::new(design_map, topology, values, (openings, kinds), fields, &held),
            turns: ElementTurns::new(model, topology),
            variables: fields.len(),
            own_drivers,
            held,
            fixed: design_map.fixed(&constant),
            last: Accepted {
                time: None,
                drivers: vec![0.0; model.drivers.len()],
                loads: GivenLoads::none(model),
            },
            path: Vec::new(),
            forces: vec![0.0; n],
            stiffness: vec![0.0; n * n],
            tangent: Elimination::new(n),
            units: vec![1.0; n],
            is_regular: false,
            is_prepared: false,
            iterations: 0,
        }
    }

    /// Moves the mechanism to its equilibrium at time t, at rest. Before the first it is in the design configuration,
    /// without loads.
    pub fn step(&mut self, one: &mut Stepper<'_>, t: f64) -> Result<(), Box<Stop>> {
        let drivers = self.last.drivers.len();
        let mut to: Vec<Option<f64>> = (0..drivers).map(|d| Some(one.mechanism.parts.law(d, t)[0])).collect();
        let predicted = self.predicted(t, |passed| &passed.openings);
        for (k, d) in self.openings.iter().enumerate() {
            // Without a prediction the openings stay.
            to[d.0] = predicted.as_ref().map(|p| p[k]);
        }
        let mut stiffness = self.predicted(t, |passed| &passed.stiffness);
        let (start, end) = (self.last.loads.clone(), GivenLoads::at(self.model, t));
        let (mut done, mut part, mut certain) = (0.0, 1.0, true);
        while done < 1.0 {
            let next = f64::min(done + part, 1.0);
            // The part of the rest that this attempt goes.
            let way = (next - done) / (1.0 - done);
            let between = |(now, to): (&f64, &Option<f64>)| match to {
                Some(to) if next == 1.0 => *to,
                Some(to) => now + (to - now) * way,
                None => *now,
            };
            let target: Vec<f64> = self.last.drivers.iter().zip(&to).map(between).collect();
            let loads = start.towards(&end, next);
            match self.attempt(one, target, &loads, stiffness.take()) {
                Ok((drivers, is_stable)) => {
                    advance::accept_at_rest(one, t);
                    certain = is_stable;
                    self.last.drivers = drivers;
                    self.last.loads = loads;
                    (done, part) = (next, 2.0 * part);
                }
                Err(rejection) => {
                    part *= 0.5;
                    // A shorter part of the way begins from the openings that were found, not from the prediction.
                    self.openings.iter().for_each(|d| to[d.0] = None);
                    if part < SHORTEST || matches!(rejection, Rejection::NothingHolds(_)) {
                        return Err(self.stop(one, t, done, rejection));
                    }
                }
            }
        }
        self.last.time = Some(t);
        if self.path.len() == PREDICTED_FROM {
            self.path.remove(0);
        }
        one.effort.equilibrium_iterations = self.iterations;
        if !certain && one.effort.uncertain_stability.is_none() {
            one.effort.uncertain_stability = Some(t);
        }
        advance::count(one);
        self.path.push(Passed {
            time: t,
            openings: self.openings.iter().map(|d| self.last.drivers[d.0]).collect(),
            stiffness: self.stiffness.clone(),
        });
        Ok(())
    }

    /// Openings or stiffness at time t by the polynomial through the last equilibria.
    fn predicted(&self, t: f64, of: impl Fn(&Passed) -> &Vec<f64>) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; of(self.path.last()?).len()];
        for (i, passed) in self.path.iter().enumerate() {
            let others = self.path.iter().enumerate().filter(|(j, _)| *j != i);
            let weight: f64 =
                others.map(|(_, other)| (t - other.time) / (passed.time - other.time)).product();
            sum.iter_mut().zip(of(passed)).for_each(|(sum, p)| *sum += weight * p);
        }
        Some(sum)
    }

    /// Solves the equilibrium with the held drivers at these values, under these loads; the openings are predicted, and
    /// maybe the stiffness. Returns the values of the drivers, and true if it is certainly stable.
    fn attempt(
        &mut self,
        one: &mut Stepper<'_>,
        mut drivers: Vec<f64>,
        given: &GivenLoads,
        stiffness: Option<Vec<f64>>,
    ) -> Result<(Vec<f64>, bool), Rejection> {
        self.is_prepared = false;
        advance::move_at_rest(one, &drivers).map_err(Rejection::of)?;
        let is_predicted = stiffness.is_some_and(|stiffness| {
            self.stiffness = stiffness;
            self.factor().is_ok()
        });
        // A predicted stiffness is good for the first correction if it is not too long.
        let mut before = LONGEST / SAME_STIFFNESS;
        for pass in 0..MOST_ITERATIONS {
            self.iterations += 1;
            self.set_forces(one, given);
            // A stiffness serves as long as the corrections shrink fast.
            let mut correction = Vec::new();
            let mut size = f64::NAN;
            if pass > 0 || is_predicted {
                (correction, size) = self.correction(one);
            }
            let is_new = !(size <= SAME_STIFFNESS * before);
            if is_new {
                self.set_tangent(one);
                self.factor()?;
                (correction, size) = self.correction(one);
            }
            let limit = match pass {
                0 => LONGEST,
                // The first correction by the stiffness of a position.
                1 if is_predicted && is_new => LONGEST,
                1 => before,
                _ => CONTRACTION * before,
            };
            if !(size <= limit) {
                return Err(Rejection::NoConvergence);
            }
            for (dp, d) in correction.iter().zip(self.openings) {
                drivers[d.0] += dp;
            }
            advance::shift_at_rest(one, &drivers).map_err(Rejection::of)?;
            // The error that remains is the square of the correction, or what an unchanged stiffness leaves of it.
            let shrinks = if pass == 0 { SAME_STIFFNESS } else { size / before };
            let is_solved = if is_new { size <= QUADRATIC } else { size * shrinks <= ROUND_OFF };
            if is_solved {
                let positive = self.prepare_with(one, given)?;
                let is_stable = self.is_certainly_stable(positive)?;
                self.is_prepared = true;
                return Ok((drivers, is_stable));
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
        let Self { openings, loads, stiffness, .. } = self;
        loads.prepare(&one.mechanism.topology, &mut one.mechanism.state);
        loads.stiffness(|a, b, slope| stiffness[a * openings.len() + b] = slope);
    }

    /// Factors the stiffness in units of the openings. Returns the sign of its determinant.
    fn factor(&mut self) -> Result<bool, Rejection> {
        let n = self.openings.len();
        for a in 0..n {
            let diagonal = self.stiffness[a * n + a].abs();
            self.units[a] = if diagonal > 0.0 { 1.0 / diagonal.sqrt() } else { 1.0 };
        }
        let factored = self.factor_shifted(0.0);
        self.is_regular = n == 0 || factored.pivot_ratio > HOLDS_NOTHING;
        if self.is_regular { Ok(factored.positive) } else { Err(Rejection::NothingHolds(self.least_held())) }
    }

    /// Factors the scaled stiffness, with this added to its diagonal.
    fn factor_shifted(&mut self, shift: f64) -> Factored<f64> {
        let n = self.openings.len();
        for a in 0..n {
            for (b, to) in self.tangent.row_mut(a).iter_mut().enumerate() {
                let diagonal = if a == b { shift } else { 0.0 };
                *to = self.stiffness[a * n + b] * self.units[a] * self.units[b] + diagonal;
            }
        }
        self.tangent.factor()
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

    /// The opening that the least force resists: the largest component of the direction without stiffness.
    fn least_held(&mut self) -> usize {
        let n = self.openings.len();
        // Inverse iteration from a vector that is not symmetric.
        let mut direction: Vec<f64> = (0..n).map(|k| 1.0 + 0.1 * k as f64).collect();
        self.factor_shifted(HOLDS_NOTHING);
        for _ in 0..3 {
            self.tangent.solve(&mut direction);
            let size = direction.iter().map(|x| x.abs()).fold(0.0, f64::max);
            direction.iter_mut().for_each(|x| *x /= size);
        }
        (0..n).fold(0, |best, k| if direction[k].abs() > direction[best].abs() { k } else { best })
    }

    /// Sets the derivatives at the equilibrium that was found last, unless they are set.
    fn prepare(&mut self, one: &mut Stepper<'_>) {
        if !std::mem::replace(&mut self.is_prepared, true) {
            let given = self.last.loads.clone();
            // A singular stiffness gives derivatives that are not known.
            let _ = self.prepare_with(one, &given);
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
        for (m, of, force) in asked() {
            self.prepare(one);
            let response = self.openings_by_force(force);
            let poses: Vec<Pose<Dual>> = (0..model.bodies.len())
                .map(|b| {
                    let openings = self.loads.unit_twists().zip(&response);
                    let w = openings.fold(Twist::ZERO, |sum, (w, v)| w[b].times_plus(*v, sum));
                    let pose = if b == 0 { Pose::IDENTITY } else { one.mechanism.state.pose[b] };
                    pose.along(w)
                })
                .collect();
            out.set(m, Instant::new(model, &self.fixed, &poses).output(of).d);
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

    /// Reason why the way to the equilibrium at time t ends after a part of it.
    fn stop(&mut self, one: &mut Stepper<'_>, t: f64, done: f64, rejection: Rejection) -> Box<Stop> {
        let kind = match (rejection, self.last.time) {
            (Rejection::Locked(rejection), _) => advance::stop_at_rest(one, t, rejection).kind,
            (Rejection::NothingHolds(k), _) => {
                StopKind::NothingHolds { direction: self.direction(self.openings[k]) }
            }
            (Rejection::NoConvergence, None) => StopKind::LimitLoad { part: done },
            (Rejection::NoConvergence, Some(_)) => StopKind::NoEquilibrium,
            (Rejection::Unstable, _) => {
                // The direction in which the stiffness vanishes.
                if advance::move_at_rest(one, &self.last.drivers).is_ok() {
                    self.prepare(one);
                }
                let k = self.least_held();
                StopKind::Unstable { direction: self.direction(self.openings[k]) }
            }
        };
        let failed_time = self.last.time.map_or(t, |from| from + (t - from) * done);
        Box::new(Stop {
            kind,
            last_time: self.last.time,
            failed_time,
            drivers: self.last.drivers.clone(),
            block: None,
            pivot_ratio: 1.0,
            joints: Vec::new(),
            remains: Vec::new(),
            closed: None,
        })
    }

    /// Returns the direction of an opening, as the user knows it.
    fn direction(&self, opening: DriverId) -> GivingDirection {
        let driver = &self.model.drivers[opening.0];
        let joint = &self.model.joints[driver.joint.0];
        let along = joint.kind.coordinates[driver.coordinate].name;
        // Released drivers come first, then openings of joints, some of which only place a body.
        if opening.0 < self.own_drivers {
            GivingDirection::Driver(opening)
        } else if joint.unnamed {
            GivingDirection::Body(joint.bodies[1], along)
        } else {
            GivingDirection::Joint(driver.joint, along)
        }
    }
}
