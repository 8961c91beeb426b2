//! Sensitivities of all design variables, step after step.

use hardpoint_tape::{Lanes, Number};

use crate::design::DesignVelocity;
use crate::model::{BodyId, DriverId, Model, VariableId};
use crate::motion::kinematics::State;
use crate::motion::level::{Flow, of_body};
use crate::motion::step_program::RecordedExtras;
use crate::motion::stepper::Stepper;
use crate::motion::tape::Tape;
use crate::space::Real;
use crate::topology::Topology;

use super::direct::{Defect, DirectDifferentiation, PlanVelocity};
use super::{Admissibility, BodySensitivity, JointDefect, Sensitivities};

/// Collects the sensitivities of a run.
pub(crate) struct SensitivitySolver {
    /// Design velocity of each variable.
    fields: Vec<PlanVelocity<f64>>,
    direct: DirectDifferentiation<f64>,
    bodies: usize,
    /// Per body: true if its sensitivities are requested.
    wanted: Vec<bool>,
    resisting: Vec<Resistance>,
    /// True if all positions are at rest: the rates W. and W.. are zero.
    at_rest: bool,
}

/// Result of the solution for one variable.
pub(crate) struct Differentiated<'s, T = f64> {
    pub variable: VariableId,
    pub topology: &'s Topology,
    pub state: &'s mut State<T>,
    pub field: &'s PlanVelocity<T>,
    /// W, W., W.. of the bodies, and S of the coordinates.
    pub flow: &'s Flow<T>,
}

/// The joints that resist a variable, and the time of the largest defect.
pub(crate) type Resistance = (Vec<JointDefect>, f64);

impl SensitivitySolver {
    /// Prepares the sensitivities of the requested bodies by the variables with these fields.
    pub fn new(model: &Model, topology: &Topology, fields: &[DesignVelocity], wanted: Vec<bool>) -> Self {
        Self {
            fields: fields.iter().map(|f| PlanVelocity::new(topology, f)).collect(),
            direct: DirectDifferentiation::new(model, topology),
            bodies: model.bodies.len(),
            wanted,
            resisting: vec![(Vec::new(), 0.0); fields.len()],
            at_rest: false,
        }
    }

    /// Solver of positions at rest.
    pub fn at_rest(self) -> Self {
        Self { at_rest: true, ..self }
    }

    /// Takes over which joints resisted on the path before.
    pub fn continue_from(&mut self, before: &Self) {
        self.resisting.clone_from(&before.resisting);
    }

    /// Reserves memory for all sensitivities over this number of steps, within the memory at hand.
    pub fn make_room(&self, sensitivities: &mut Sensitivities, steps: usize) {
        sensitivities.shape(self.bodies, self.fields.len(), self.moved(), steps);
    }

    /// Pairs of a variable and a body that it moves, requested or not, in the order of the programs' derivatives.
    pub fn moved(&self) -> impl Iterator<Item = (VariableId, BodyId)> {
        let fields = self.fields.iter().enumerate();
        fields.flat_map(|(v, field)| field.reach.bodies.iter().map(move |b| (VariableId(v), BodyId(*b))))
    }

    /// Sets the rates of the openings of a mechanism by a variable, whose field shifts the openings last.
    pub fn set_openings(&mut self, variable: usize, rates: &[f64]) {
        self.fields[variable].set_last_shifts(rates);
    }

    /// Solves at the position of a stepper and output time t, with velocity and acceleration. Calls `found` with the
    /// sensitivities of requested bodies, and `each` with the solution of each variable.
    pub fn step(
        &mut self,
        one: &mut Stepper<'_>,
        t: f64,
        mut found: impl FnMut(VariableId, BodyId, &BodySensitivity),
        mut each: impl FnMut(Differentiated<'_>),
    ) {
        let Self { fields, direct, wanted, resisting, at_rest, .. } = self;
        // At a change point sensitivities are NaN, which does not mean that the variable is not admissible.
        let solved = !one.at_change_point;
        // x., x.., l., l.. of all coordinates and rows once; then three right-hand sides for each variable: (11), (12),
        // (13).
        let mechanism = &mut one.mechanism;
        let (topology, state, parts) = (&mechanism.topology, &mut mechanism.state, &mechanism.parts);
        state.finish_rates(topology);
        for (v, field) in fields.iter_mut().enumerate() {
            field.set_time(|d: DriverId| parts.law_of(d.0), t);
            match *at_rest {
                true => direct.solve_position(topology, state, field),
                false => direct.solve(topology, state, field),
            }
            for &body in field.reach.bodies.iter().filter(|b| wanted[**b]) {
                let derivatives = {
                    let numbers = components(&direct.flow, state, body);
                    BodySensitivity::from(|n| numbers[n])
                };
                found(VariableId(v), BodyId(body), &derivatives);
            }
            if let Some(defect) = direct.worst_defect(topology, state, field).filter(|_| solved) {
                note(&mut resisting[v], topology, defect, t);
            }
            each(Differentiated { variable: VariableId(v), topology, state, field, flow: &direct.flow });
        }
    }

    /// Records the joints that resist at these output times, from the results of a program from this lane on.
    pub fn note(&mut self, tape: &Tape, topology: &Topology, times: &[f64], first: usize) {
        note_defects(tape, topology, (times, first), (&mut self.resisting, 0));
    }

    /// Admissibility of every variable after this number of steps, given the joints that each opens in the design.
    pub fn admissibility(&self, opens: &[Vec<JointDefect>], steps: usize) -> Vec<Admissibility> {
        admissibility(opens, self.resisting.clone(), steps)
    }
}

/// Admissibility of every variable after this number of steps, given the joints that each opens in the nominal design.
pub(crate) fn admissibility(
    opens: &[Vec<JointDefect>],
    resisting: Vec<Resistance>,
    steps: usize,
) -> Vec<Admissibility> {
    let answer = |(open, (joints, time)): (&Vec<JointDefect>, Resistance)| {
        if !joints.is_empty() {
            Admissibility::CannotFollow { joints, time }
        } else if steps == 0 {
            Admissibility::Unknown
        } else if open.is_empty() {
            Admissibility::Admissible
        } else {
            Admissibility::Reassembled { joints: open.clone() }
        }
    };
    opens.iter().zip(resisting).map(answer).collect()
}

/// Updates the joints that resist a variable, and the time of the largest defect.
pub(super) fn note(resisting: &mut Resistance, topology: &Topology, defect: Defect, t: f64) {
    let (joint, row) = (topology.closure_of(defect.row).joint, topology.constraint(defect.row));
    let (joints, time) = resisting;
    // A periodic motion returns to its largest defect; the first time is reported, not one that round-off selects.
    if joints.iter().all(|j| defect.value > j.value * (1.0 + 1e-9)) {
        *time = t;
    }
    match joints.iter_mut().find(|j| j.joint == joint) {
        Some(j) if defect.value > j.value => (j.row, j.value) = (row, defect.value),
        Some(_) => {}
        None => joints.push(JointDefect { joint, row, value: defect.value }),
    }
}

/// Derivatives of one body, from the design twists W of the bodies and their time derivatives: of r, pi, v, omega, a
/// and alpha, one after the other. Those of r and pi are W at r and its rotation; all others are plain time derivatives
/// of these (`docs/theory.md` (14)).
#[inline(always)]
fn components<T: Real>(flow: &Flow<T>, state: &State<T>, body: usize) -> [T; BodySensitivity::NUMBERS] {
    let [w0, w1, w2] = of_body(&flow.twists, body);
    let ([v, a, _], r) = (of_body(&state.motion.twists, body), state.pose[body].r);
    // v = V at r,    a = V. at r + omega x v
    let velocity = v.at(r);
    let acceleration = v.w.cross_plus(velocity, a.at(r));
    let two = T::constant(2.0);
    // dr/db  = W_v + W_w x r,    d(pi)/db = W_w
    let (p, q) = (w0.at(r), w0.w);
    // dv/db  = W. at r + W_w x v
    let u = w0.w.cross_plus(velocity, w1.at(r));
    // d(omega)/db = W._w + W_w x omega
    let o = w0.w.cross_plus(v.w, w1.w);
    // da/db  = W.. at r + 2 W._w x v + W_w x a:  d/dt of dv/db, with r. = v
    let n = w0.w.cross_plus(acceleration, (w1.w * two).cross_plus(velocity, w2.at(r)));
    // d(alpha)/db = W.._w + W._w x omega + W_w x alpha:  d/dt of d(omega)/db
    let e = w0.w.cross_plus(a.w, w1.w.cross_plus(v.w, w2.w));
    [p.x, p.y, p.z, q.x, q.y, q.z, u.x, u.y, u.z, o.x, o.y, o.z, n.x, n.y, n.z, e.x, e.y, e.z]
}

/// Records the derivatives of all bodies by all variables with these fields, at the position of the state, and the
/// results of `each` for each variable; returns `None` if a law changes, because programs do not support that.
pub(crate) fn record_derivatives(
    model: &Model,
    fields: &[DesignVelocity<Number>],
    topology: &Topology,
    state: &mut State<Number>,
    mut each: impl FnMut(Differentiated<'_, Number>),
) -> Option<RecordedExtras> {
    let (mut recorded, mut defects) = (RecordedExtras::default(), Vec::new());
    if fields.is_empty() {
        return Some(recorded);
    }
    state.finish_rates(topology);
    let mut direct = DirectDifferentiation::new(model, topology);
    for (v, field) in fields.iter().enumerate() {
        let mut field = PlanVelocity::new(topology, field);
        if !field.is_constant() {
            return None;
        }
        // A recording does not depend on time: it has z, L' and shifts, but no df/dp of a law.
        field.set_shifts();
        direct.solve(topology, state, &field);
        for (row, defect, limit) in direct.judged_defects(topology, state, &field) {
            recorded.defects.push((VariableId(v), row));
            defects.extend([defect, limit]);
        }
        for &body in &field.reach.bodies {
            recorded.results.extend(components(&direct.flow, state, body));
            recorded.moved.push((VariableId(v), BodyId(body)));
        }
        let variable = VariableId(v);
        each(Differentiated { variable, topology, state, field: &field, flow: &direct.flow });
    }
    recorded.judged = defects;
    Some(recorded)
}

/// Records the rows that resist at the positions of a program, at these times in its lanes from `first` on; the records
/// of one lane begin `apart` after those of the lane before: 0 if all lanes are times of one design.
pub(crate) fn note_defects(
    tape: &Tape,
    topology: &Topology,
    (times, first): (&[f64], usize),
    (resisting, apart): (&mut [Resistance], usize),
) {
    // NaN resists.
    let fails = |[defect, limit]: &[Lanes; 2], lane: usize| !(defect[lane] <= limit[lane]);
    if tape.defects().all(|(_, _, found)| (0..times.len()).all(|n| !fails(found, first + n))) {
        return;
    }
    for (n, &t) in times.iter().enumerate() {
        let lane = first + n;
        let failing = tape.defects().filter(|(_, _, found)| fails(found, lane));
        let mut failing = failing
            .map(|(variable, row, found)| (variable, Defect { row, value: found[0][lane] }))
            .peekable();
        while let Some((variable, mut worst)) = failing.next() {
            while let Some((_, other)) = failing.next_if(|(v, _)| *v == variable) {
                if other.value > worst.value {
                    worst = other;
                }
            }
            note(&mut resisting[apart * n + variable.0], topology, worst, t);
        }
    }
}
