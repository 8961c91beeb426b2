//! The motion of one design, from one output time to the next.
//!
//! An output time is a step of its own where the motion is smooth between output times ([`StepGuard`]); elsewhere the
//! solver walks along the path in steps of its own length, independent of the spacing of the output times.
//!
//! [`StepGuard`]: super::guard::StepGuard

use crate::space::Real;

use super::Stop;
use super::assembly::assemble;
use super::change_point::stand_within_crossing;
use super::guard::Steps;
use super::mechanism::{Mechanism, StepRejection};
use super::path::Path;
use super::path_step::{MOST_BEND, trust};
use super::step::{RoughStep, Step, take};
use super::stepper::Stepper;
use super::turns::TURN_TRUST;
use super::walk::walk;

/// Largest move of a coordinate per travel of the drivers that is taken at once, rad or sizes: arms are shorter than
/// their loops. The branch is checked besides.
const MOVE_PER_TRAVEL: f64 = 8.0;
/// Largest number of parts of a move at rest: a part is as short as those into which an equilibrium would be divided
/// otherwise, and takes a position instead of a stiffness.
const MOST_PARTS: usize = 16;
/// Largest number of parts in which angles are counted: a motion may not have more radians between two output times.
const MOST_COUNTED_PARTS: usize = 100_000;

/// Solves the design configuration, in which all drivers are zero.
///
/// A changed design starts from the nominal design configuration and closes there first.
fn start_at_design(one: &mut Stepper<'_>) -> Result<(), Box<Stop>> {
    (one.crossing, one.at_change_point) = (None, false);
    assemble(one)?;
    if let Some(turns) = &mut one.turns {
        turns.begin(&one.mechanism.state);
    }
    Ok(())
}

/// Solves the design configuration, at rest.
pub(crate) fn start_at_rest(one: &mut Stepper<'_>, t: f64) -> Result<(), Box<Stop>> {
    start_at_design(one)?;
    one.mechanism.line.fill([0.0; 2]);
    one.start_on(Path::Line { at: t }, 0.0, false)
}

/// Solves the design configuration, then moves on to the first output time.
pub(crate) fn start(one: &mut Stepper<'_>, t: f64) -> Result<(), Box<Stop>> {
    let ramp = start_on_ramp(one, t)?;
    start_from_ramp(one, ramp, t)?;
    count(one);
    Ok(())
}

/// Solves the design configuration, where all drivers are zero, and starts on the path from there to their values at
/// the first output time; `None` if these are zero, too.
pub(super) fn start_on_ramp(one: &mut Stepper<'_>, t: f64) -> Result<Option<Path>, Box<Stop>> {
    start_at_design(one)?;
    let Mechanism { line, parts, .. } = &mut one.mechanism;
    for (d, line) in line.iter_mut().enumerate() {
        *line = [0.0, parts.law(d, t)[0]];
    }
    if line.iter().all(|[_, to]| to.abs() == 0.0) {
        return Ok(None);
    }
    // q(f = 0), which is drawn, to q(f(t_0)): all drivers straight there together
    let ramp = Path::Line { at: t };
    one.start_on(ramp, 0.0, false)?;
    Ok(Some(ramp))
}

/// Moves on along that path to the first output time, and starts on the laws.
pub(super) fn start_from_ramp(one: &mut Stepper<'_>, ramp: Option<Path>, t: f64) -> Result<(), Box<Stop>> {
    if let Some(ramp) = ramp {
        walk(one, ramp, 1.0)?;
    }
    one.start_on_laws(t, false)
}

/// Moves on to the output time t.
pub(crate) fn advance(one: &mut Stepper<'_>, t: f64) -> Result<(), Box<Stop>> {
    one.at_change_point = false;
    match stand_within_crossing(one, t) {
        Some(stood) => stood?,
        None if OutputStep::to(one, t).is_some_and(|step| take(step).is_ok()) => {}
        None => walk(one, Path::Laws, t)?,
    }
    count(one);
    Ok(())
}

/// Moves all drivers straight to these values from the accepted position, to a position at rest that is not accepted
/// yet: at once, or else in parts. Fails if they are too far for the largest number of parts.
pub(crate) fn move_at_rest(one: &mut Stepper<'_>, values: &[f64]) -> Result<(), StepRejection> {
    let way = WayAtRest::new(one, one.mechanism.saved.drivers.iter(), values);
    let mut parts = way.least_parts;
    loop {
        one.mechanism.restore();
        // Without a prediction the first correction is the move itself.
        let trusted = trust(MOVE_PER_TRAVEL * way.travel / parts as f64);
        match way.follow(one, parts, trusted, true) {
            Err(_) if parts < MOST_PARTS => parts *= 2,
            result => return result,
        }
    }
}

/// Moves all drivers to these values, which are near the position of the state, to a position at rest.
pub(crate) fn shift_at_rest(one: &mut Stepper<'_>, values: &[f64]) -> Result<(), StepRejection> {
    let way = WayAtRest::new(one, one.mechanism.drivers.iter(), values);
    way.follow(one, way.least_parts, f64::INFINITY, false)
}

/// Straight way of all drivers between two positions at rest.
struct WayAtRest<'v> {
    from: Vec<f64>,
    to: &'v [f64],
    /// Largest travel of a driver, rad or sizes.
    travel: f64,
    /// Number of parts in each of which angles can be counted.
    least_parts: usize,
}

impl<'v> WayAtRest<'v> {
    fn new<'d>(one: &Stepper<'_>, from: impl Iterator<Item = &'d [f64; 3]>, to: &'v [f64]) -> Self {
        let from: Vec<f64> = from.map(|[value, ..]| *value).collect();
        let travel = |((from, to), unit): ((&f64, &f64), &f64)| (to - from).abs() / unit;
        let travel = from.iter().zip(to).zip(&one.mechanism.driver_units).map(travel).fold(0.0, f64::max);
        let counted = ((travel / TURN_TRUST).ceil() as usize).clamp(1, MOST_COUNTED_PARTS);
        let least_parts = if one.turns.is_some() { counted } else { 1 };
        Self { from, to, travel, least_parts }
    }

    /// Solves the end of each part of the way.
    fn follow(
        &self,
        one: &mut Stepper<'_>,
        parts: usize,
        trust: f64,
        from_accepted: bool,
    ) -> Result<(), StepRejection> {
        for part in 1..=parts {
            let way = part as f64 / parts as f64;
            let between =
                |(from, to): (&f64, &f64)| if part == parts { *to } else { from + (to - from) * way };
            let values: Vec<f64> = self.from.iter().zip(self.to).map(between).collect();
            hold(one, &values, trust)?;
            if let Some(turns) = &mut one.turns {
                turns.follow_at_rest(&one.mechanism.state, from_accepted && part == 1);
            }
        }
        Ok(())
    }
}

/// Accepts a position at rest.
pub(crate) fn accept_at_rest(one: &mut Stepper<'_>, t: f64) {
    one.save(t);
    if let Some(turns) = &mut one.turns {
        turns.accept_at_rest(&one.mechanism.state);
    }
}

/// Reason why a mechanism at rest does not reach a position at time t.
pub(crate) fn stop_at_rest(one: &mut Stepper<'_>, t: f64, rejection: StepRejection) -> Box<Stop> {
    one.stop(Path::Line { at: t }, 1.0, rejection, true)
}

/// Solves the position from that of the state with all drivers at rest at these values.
fn hold(one: &mut Stepper<'_>, values: &[f64], trust: f64) -> Result<(), StepRejection> {
    let mechanism = &mut one.mechanism;
    for (driver, value) in mechanism.drivers.iter_mut().zip(values) {
        *driver = [*value, 0.0, 0.0];
    }
    mechanism.state.gap_left = [0.0; 2];
    mechanism.solve_within(trust)?;
    mechanism.examine_position()
}

/// Counts an output step.
pub(crate) fn count(Stepper { mechanism, effort, .. }: &mut Stepper<'_>) {
    effort.steps += 1;
    effort.iterations = mechanism.state.iterations;
    effort.worst_residual = effort.worst_residual.max(mechanism.residuals.largest);
    effort.note_pivots(mechanism.state.pivots.iter().map(|p| p.0), mechanism.saved.time);
}

/// The step to the next output time, t.
struct OutputStep<'s, 'm> {
    one: &'s mut Stepper<'m>,
    t: f64,
    h: f64,
    /// True if the next step, too, may be one of these.
    is_even: bool,
}

impl<'s, 'm> OutputStep<'s, 'm> {
    /// The step to t, if the path ahead is known.
    #[inline(always)]
    fn to(one: &'s mut Stepper<'m>, t: f64) -> Option<Self> {
        let h = t - one.mechanism.saved.time;
        one.knows_the_path().then_some(Self { one, t, h, is_even: false })
    }
}

impl Step for OutputStep<'_, '_> {
    type Rejection = RoughStep;

    #[inline(always)]
    fn drive(&mut self) -> Result<(), RoughStep> {
        self.one.mechanism.drive(Path::Laws, self.t).map_err(|_| RoughStep)?;
        RoughStep::unless(laws_are_resolved(self.one, self.t))
    }

    #[inline(always)]
    fn predict(&mut self) -> f64 {
        let Stepper { mechanism, predictor, .. } = &mut *self.one;
        mechanism.state.contacts.copy_from_slice(&mechanism.saved.contacts);
        predictor.set(&mut mechanism.state, mechanism.saved.time + self.h, self.h);
        mechanism.expect_turns(self.h);
        trust(expected_move(mechanism, self.h))
    }

    #[inline(always)]
    fn correct(&mut self, trust: f64) -> Result<(), RoughStep> {
        self.one.mechanism.solve_within(trust).map_err(|_| RoughStep)
    }

    #[inline(always)]
    fn check(&mut self) -> Result<(), RoughStep> {
        let Self { h, .. } = *self;
        let Stepper { mechanism, guard, turns, .. } = &mut *self.one;
        let [difference, fastest] = speeds(mechanism, h);
        RoughStep::unless(guard.speeds_are_smooth(difference, fastest) && contacts_are_near(mechanism))?;
        let selections = mechanism.selections;
        mechanism.examine_position().map_err(|_| RoughStep)?;
        let steps = Steps { from: mechanism.saved.time, ends: &[self.t] };
        let state = &mechanism.state;
        let is_even = guard.determinants_are_even(&state.factors, steps, |b, _| [state.determinants[b]]);
        // Determinants of different rows cannot be compared.
        self.is_even = is_even && mechanism.selections == selections;
        RoughStep::unless(self.is_even || !guard.knows_a_step())?;
        RoughStep::unless(turns.as_mut().is_none_or(|turns| turns.is_even(state, h, guard.moved())))
    }

    #[inline(always)]
    fn accept(&mut self) {
        if let Some(turns) = &mut self.one.turns {
            turns.accept();
        }
        self.one.save(self.t);
        if self.is_even {
            self.one.guard.accept();
        }
    }
}

/// True if the output times resolve the laws up to t, where the drivers are already, and no singular position is known
/// to be near.
#[inline(always)]
pub(super) fn laws_are_resolved(one: &mut Stepper<'_>, t: f64) -> bool {
    let Stepper { mechanism, guard, lookahead, .. } = one;
    let steps = Steps { from: mechanism.saved.time, ends: &[t] };
    let drivers = &mechanism.drivers;
    guard.laws_are_resolved((mechanism, lookahead), steps, |d| &drivers[d][..1], |d| drivers[d][1].abs())
}

/// Largest move (rad, or sizes) over a step h, by speed and acceleration.
#[inline(always)]
pub(super) fn expected_move(mechanism: &Mechanism<'_>, h: f64) -> f64 {
    let Mechanism { topology, saved, .. } = mechanism;
    let half = 0.5 * h;
    let mut most = 0.0;
    for c in topology.unknown_coordinates() {
        // q. h + q.. h^2 / 2
        let step = (saved.qd[c.0] + saved.qdd[c.0] * half) * h;
        most = most.larger((step * topology[c].per_unit).abs());
    }
    most
}

/// Largest difference between the speeds after a step h and their prediction, and the largest of both (rad, or sizes,
/// per s).
#[inline(always)]
fn speeds(mechanism: &Mechanism<'_>, h: f64) -> [f64; 2] {
    let Mechanism { topology, state, saved, .. } = mechanism;
    let (mut fastest, mut difference) = (0.0_f64, 0.0_f64);
    for c in topology.unknown_coordinates() {
        let (now, per_unit) = (state.motion.speeds[0][c.0], topology[c].per_unit);
        // abs(q. - (q._0 + q.._0 h)) against the larger of the two speeds
        let predicted = saved.qd[c.0] + saved.qdd[c.0] * h;
        fastest = fastest.larger(now.abs().larger(saved.qd[c.0].abs()) * per_unit);
        difference = difference.larger((now - predicted).abs() * per_unit);
    }
    [difference, fastest]
}

/// Returns true if all curves are nearly straight from the former contact to the present one.
fn contacts_are_near(Mechanism { state, saved, parts, .. }: &Mechanism<'_>) -> bool {
    (0..state.contacts.len())
        .all(|k| parts.curves[k].bend(saved.contacts[k].u, state.contacts[k].u) <= MOST_BEND)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Law;
    use crate::motion::kinematics::{State, factors_of};
    use crate::motion::parts::PlanGeometry;
    use crate::space::Vec3;
    use crate::topology::{Formulation, Topology};
    use crate::{draft::*, model::*};

    /// Nodes on two slides each, connected by rods to the two nodes before; a leg drives the last.
    fn truss(n: usize) -> Model {
        let place = |k: usize| [0.5 * k as f64, 0.8 * (k % 2) as f64, 0.0];
        let node = |k: usize| if k == 0 { "ground".to_owned() } else { format!("node{k}") };
        let [x, y, _] = Vec3::AXES;
        let mut draft = Draft::new("truss").times([0.0, 0.1, 0.2]);
        for k in 1..n {
            let slider = format!("slider{k}");
            draft = draft
                .bodies([slider.as_str(), &node(k)])
                .translational(format!("x{k}"), ["ground", &slider], place(k), x)
                .translational(format!("y{k}"), [&slider, &node(k)], place(k), y);
            for other in k.saturating_sub(2)..k {
                let ends = [node(other), node(k)];
                draft = draft.distance(format!("rod{other}_{k}"), ends, [place(other), place(k)]);
            }
        }
        let leg = JointDraft::new("push", "leg", ["ground", &node(n - 1)]);
        let draft = draft.joint(leg.at([0.5 * n as f64, -1.0, 0.3]).at(place(n - 1))).driver(
            "motor",
            "push",
            Law::parse("0.1*sin(2*pi*t)").unwrap(),
        );
        Model::from_draft(&draft).unwrap()
    }

    /// The states of all bodies at the last output time, with blocks up to this size factored densely.
    fn last(model: &Model, topology: &Topology, largest_dense: usize) -> (State<f64>, Vec<bool>) {
        let (design, laws) = (model.geometry(&[]), model.laws(&[]));
        let mut one = Stepper::new(model, topology, PlanGeometry::same(model, topology, &design, &laws));
        let blocks = topology.blocks.iter();
        one.mechanism.state.factors = blocks.map(|b| factors_of(topology, b, largest_dense)).collect();
        start(&mut one, model.times[0]).unwrap();
        model.times[1..].iter().for_each(|t| advance(&mut one, *t).unwrap());
        let signs = one.mechanism.state.pivots.iter().map(|p| p.1).collect();
        (one.mechanism.state, signs)
    }

    #[test]
    fn sparse_and_dense_factors_give_the_same_motion() {
        for n in [5, 30] {
            let model = truss(n);
            let topology = Topology::of(&model, Formulation::Relative).unwrap();
            let size = model.size();
            let (dense, dense_signs) = last(&model, &topology, usize::MAX);
            let (sparse, sparse_signs) = last(&model, &topology, 0);
            assert_eq!(dense_signs, sparse_signs);
            let apart = |a: Vec3, b: Vec3| (a - b).norm();
            for b in 0..model.bodies.len() {
                assert!(apart(dense.pose[b].r, sparse.pose[b].r) < 1e-12 * size, "body {b} of {n}");
                assert!(
                    apart(dense.motion.twists[0][b].v, sparse.motion.twists[0][b].v) < 1e-11 * size,
                    "body {b} of {n}"
                );
            }
        }
    }
}
