//! Sensitivities of all design variables, step after step.

use hardpoint_tape::{Lanes, Number};

use crate::model::{BodyId, DriverId, Field, Model, VariableId};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::motion::tape::Recorded;
use crate::motion::turn_over;
use crate::sink::Sink;
use crate::space::{LANES, Real, Twist, Vec3, of_lanes};
use crate::topology::Topology;

use super::direct::{Defect, Direct, FieldParts};
use super::{Admissibility, BodySensitivity, JointDefect, Sensitivities};

/// Collects the sensitivities of a run.
///
/// Lanes are filled either with times, where the motion is solved so, each variable in turn; or with variables, at one time.
pub(crate) struct Sensing<'f, T> {
    model: &'f Model,
    fields: &'f [Field],
    /// Each variable in all lanes; empty until times fill them.
    each: Vec<FieldParts<T>>,
    /// The variables, as many at a time as there are lanes.
    together: Vec<FieldParts<T>>,
    /// One time's state in all lanes.
    state: State<T>,
    direct: Direct<T>,
    /// Per body: whether its sensitivities are wanted.
    wanted: Vec<bool>,
    resisting: Vec<Resisting>,
}

/// The joints that resist a variable, and the time of the largest defect.
pub(crate) type Resisting = (Vec<JointDefect>, f64);

impl<'f, T: Real> Sensing<'f, T> {
    /// Prepares the sensitivities of the wanted bodies by the variables with these fields.
    pub fn new(
        model: &'f Model,
        topology: &Topology,
        fields: &'f [Field],
        wanted: Vec<bool>,
        witness: T,
    ) -> Self {
        let parts = |fields: &[Field]| FieldParts::new(topology, &Field::gather(fields, witness), witness);
        Self {
            model,
            fields,
            each: Vec::new(),
            together: fields.chunks(T::LANES).map(parts).collect(),
            state: State::new(model, topology, witness),
            direct: Direct::new(model, topology, witness),
            wanted,
            resisting: vec![(Vec::new(), 0.0); fields.len()],
        }
    }

    /// Room for all sensitivities over so many steps, that of `before` used again.
    pub fn room(&self, steps: usize, before: Sensitivities) -> Sensitivities {
        let (variables, bodies) = (self.fields.len(), self.model.bodies.len());
        // What no variable of a group moves is never written: it must be zero.
        let mut moved = vec![false; variables * bodies];
        for (v, group) in (0..variables).map(|v| (v, &self.together[v / T::LANES])) {
            group.reach.bodies.iter().for_each(|b| moved[v * bodies + b] = true);
        }
        let mut states = before.states;
        if before.moved != moved {
            states.clear();
        }
        states.resize(steps * variables * bodies, BodySensitivity::ZERO);
        Sensitivities { states, variables, bodies, admissibility: Vec::new(), moved }
    }

    /// Output time k, at t, where a stepper stands with velocity and acceleration.
    pub fn step(&mut self, one: &mut Stepper<'_, f64>, k: usize, t: f64, sink: &mut impl Sink) {
        let (topology, state, law) =
            (&one.topology, &mut one.state, |d: DriverId, _| one.parts.law_of(d.0, 0));
        state.finish_rates(topology);
        self.state.spread(state);
        let variables = self.fields.len();
        for (g, group) in self.together.iter_mut().enumerate() {
            let first = g * T::LANES;
            group.set_times(law, &[t; LANES]);
            self.direct.solve(topology, &mut self.state, group);
            let bodies = group.reach.bodies.iter().copied().filter(|&b| self.wanted[b]);
            each_derivative(&self.direct.w, &self.state, bodies, |lane, body, d| {
                if first + lane < variables {
                    sink.sensitivity(k, VariableId(first + lane), BodyId(body), &d);
                }
            });
            let mut defects = [None; LANES];
            self.direct.worst_defects(topology, &self.state, group, &mut defects);
            for (lane, defect) in defects.into_iter().enumerate().take(variables - first) {
                if let Some(defect) = defect {
                    note(&mut self.resisting[first + lane], topology, defect, t);
                }
            }
        }
    }

    /// Output times k and on, one in every lane, as many as `count`.
    pub fn steps(
        &mut self,
        all: &mut Stepper<'_, T>,
        k: usize,
        times: &[f64],
        count: usize,
        sink: &mut impl Sink,
    ) {
        if self.each.is_empty() {
            let witness = all.state.witness;
            let parts = |f: &Field| FieldParts::new(&all.topology, &f.spread(witness), witness);
            self.each = self.fields.iter().map(parts).collect();
        }
        if let Some(results) = all.besides() {
            return self.steps_by_tape(results, k, count, sink);
        }
        let of_lanes = of_lanes(times);
        let resisting = &mut self.resisting;
        solve_each(
            (&mut self.each, &mut self.direct),
            (all, &of_lanes),
            &self.wanted,
            #[inline(always)]
            |lane, v, body, d| {
                if lane < count {
                    sink.sensitivity(k + lane, v, body, d);
                }
            },
            |lane, v, topology, defect| {
                if lane < count {
                    note(&mut resisting[v.0], topology, defect, of_lanes[lane]);
                }
            },
        );
    }

    /// The same where a tape has solved them; then no joint resists.
    fn steps_by_tape(&self, results: &[Lanes], k: usize, count: usize, sink: &mut impl Sink) {
        let witness = self.state.witness;
        witness.within(
            #[inline(always)]
            || {
                let mut table = [[0.0; 24]; LANES];
                let (mut of_body, _) = results.as_chunks::<COMPONENTS>();
                for (v, field) in self.each.iter().enumerate() {
                    for &body in &field.reach.bodies {
                        let Some((lanes, rest)) = of_body.split_first() else { return };
                        of_body = rest;
                        if !self.wanted[body] {
                            continue;
                        }
                        let x = std::array::from_fn(
                            #[inline(always)]
                            |n| witness.gather(lanes[n]),
                        );
                        hand_over(x, body, &mut table, &mut |lane, body, d| {
                            if lane < count {
                                sink.sensitivity(k + lane, VariableId(v), BodyId(body), &d);
                            }
                        });
                    }
                }
            },
        );
    }

    /// What so many steps say of every variable's admissibility, given the joints that each opens in the design.
    pub fn admissibility(&self, opens: &[Vec<JointDefect>], steps: usize) -> Vec<Admissibility> {
        admissibility(opens, self.resisting.clone(), steps)
    }
}

/// Collects the sensitivities of several designs side by side, one in every lane.
pub(crate) struct SensingDesigns<T> {
    each: Vec<FieldParts<T>>,
    direct: Direct<T>,
    wanted: Vec<bool>,
    /// Per lane and variable.
    resisting: Vec<Vec<Resisting>>,
}

impl<T: Real> SensingDesigns<T> {
    /// Prepares the sensitivities of the wanted bodies; `fields` are those of all variables, variable by variable, each in
    /// every lane's design.
    pub fn new(
        model: &Model,
        topology: &Topology,
        fields: &[Vec<Field>],
        wanted: Vec<bool>,
        witness: T,
    ) -> Self {
        let parts = |f: &Vec<Field>| FieldParts::new(topology, &Field::gather(f, witness), witness);
        Self {
            each: fields.iter().map(parts).collect(),
            direct: Direct::new(model, topology, witness),
            wanted,
            resisting: vec![vec![(Vec::new(), 0.0); fields.len()]; T::LANES],
        }
    }

    /// The output time t of all designs; `out(lane, ...)` gets what is found.
    pub fn step(
        &mut self,
        all: &mut Stepper<'_, T>,
        t: f64,
        out: impl FnMut(usize, VariableId, BodyId, &BodySensitivity),
    ) {
        let resisting = &mut self.resisting;
        solve_each(
            (&mut self.each, &mut self.direct),
            (all, &[t; LANES]),
            &self.wanted,
            out,
            |lane, v, topology, defect| note(&mut resisting[lane][v.0], topology, defect, t),
        );
    }

    /// What so many steps say of every variable's admissibility, lane by lane, given the joints that each opens in the
    /// nominal design.
    pub fn admissibility(
        self,
        opens: &[Vec<JointDefect>],
        steps: usize,
    ) -> impl Iterator<Item = Vec<Admissibility>> {
        self.resisting.into_iter().map(move |of_lane| admissibility(opens, of_lane, steps))
    }
}

/// All variables one after the other, each in all lanes, at one time per lane.
#[inline(always)]
fn solve_each<T: Real>(
    (each, direct): (&mut [FieldParts<T>], &mut Direct<T>),
    (all, times): (&mut Stepper<'_, T>, &[f64; LANES]),
    wanted: &[bool],
    mut out: impl FnMut(usize, VariableId, BodyId, &BodySensitivity),
    mut resists: impl FnMut(usize, VariableId, &Topology, Defect),
) {
    let (topology, state, parts) = (&all.topology, &mut all.state, &all.parts);
    state.finish_rates(topology);
    for (v, field) in each.iter_mut().enumerate() {
        field.set_times(|d: DriverId, lane| parts.law_of(d.0, lane), times);
        direct.solve(topology, state, field);
        let bodies = field.reach.bodies.iter().copied().filter(|&b| wanted[b]);
        each_derivative(
            &direct.w,
            state,
            bodies,
            #[inline(always)]
            |lane, body, d| out(lane, VariableId(v), BodyId(body), &d),
        );
        let mut defects = [None; LANES];
        direct.worst_defects(topology, state, field, &mut defects);
        for (lane, defect) in defects.into_iter().enumerate() {
            if let Some(defect) = defect {
                resists(lane, VariableId(v), topology, defect);
            }
        }
    }
}

/// What so many steps say of every variable, given the joints that each opens in the nominal design.
pub(crate) fn admissibility(
    opens: &[Vec<JointDefect>],
    resisting: Vec<Resisting>,
    steps: usize,
) -> Vec<Admissibility> {
    let answer = |(open, (joints, time)): (&Vec<JointDefect>, Resisting)| {
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

/// Keeps in mind which joint resists a variable most, and when.
pub(super) fn note(resisting: &mut Resisting, topology: &Topology, defect: Defect, t: f64) {
    let place = &topology.rows[defect.row];
    let closure = &topology.closures[place.closure];
    let row = closure.rows[place.index];
    let (joints, time) = resisting;
    // A periodic motion comes back to its largest defect: the first time counts, not round-off.
    if joints.iter().all(|j| defect.value > j.value * (1.0 + 1e-9)) {
        *time = t;
    }
    match joints.iter_mut().find(|j| j.joint == closure.joint) {
        Some(j) if defect.value > j.value => (j.row, j.value) = (row, defect.value),
        Some(_) => {}
        None => joints.push(JointDefect { joint: closure.joint, row, value: defect.value }),
    }
}

/// Derivatives of r, pi, v, omega, a and alpha from the design twists W of the bodies and their time derivatives:
/// `V' = W. + ad(W) V`, `A' = W.. + ad(W.) V + ad(W) A` (`docs/theory.md` (14)). Gives those of the bodies that move to
/// `out(lane, body, ...)`.
fn each_derivative<T: Real>(
    w: &[Vec<Twist<T>>; 3],
    state: &State<T>,
    bodies: impl Iterator<Item = usize>,
    mut out: impl FnMut(usize, usize, BodySensitivity),
) {
    let mut table = [[0.0; 24]; LANES];
    state.witness.within(
        #[inline(always)]
        || {
            for body in bodies {
                hand_over(components(w, state, body), body, &mut table, &mut out);
            }
        },
    );
}

/// Of one body: derivatives of r, pi, v, omega, a and alpha, one after the other.
#[inline(always)]
fn components<T: Real>(w: &[Vec<Twist<T>>; 3], state: &State<T>, body: usize) -> [T; COMPONENTS] {
    let (w0, w1, w2) = (w[0][body], w[1][body], w[2][body]);
    let (r, v, a) = (state.pose[body].r, state.v[body], state.a[body]);
    let dv = w1 + w0.ad(v);
    let da = w2 + w1.ad(v) + w0.ad(a);
    let p = w0.at(r);
    let velocity = v.at(r);
    let u = v.w.cross_plus(p, dv.at(r));
    let n = a.w.cross_plus(p, dv.w.cross_plus(velocity, v.w.cross_plus(u, da.at(r))));
    let (q, o, e) = (w0.w, dv.w, da.w);
    [p.x, p.y, p.z, q.x, q.y, q.z, u.x, u.y, u.z, o.x, o.y, o.z, n.x, n.y, n.z, e.x, e.y, e.z]
}

/// So many numbers are the derivatives of a body.
const COMPONENTS: usize = 18;

/// Gives these derivatives to `out(lane, body, ...)`, lane by lane.
#[inline(always)]
fn hand_over<T: Real>(
    x: [T; COMPONENTS],
    body: usize,
    table: &mut [[f64; 24]; LANES],
    out: &mut impl FnMut(usize, usize, BodySensitivity),
) {
    let components: [[T; 8]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(
            #[inline(always)]
            |j| x[usize::min(8 * i + j, COMPONENTS - 1)],
        )
    });
    turn_over(&components, table);
    for (lane, x) in table[..T::LANES].iter().enumerate() {
        out(lane, body, BodySensitivity::from_components(x));
    }
}

/// Records the derivatives of all bodies by all variables with these fields, where the state stands; none where a law changes, which no
/// program knows.
pub(crate) fn record_derivatives(
    model: &Model,
    fields: &[Field],
    topology: &Topology,
    state: &mut State<Number>,
) -> Option<Recorded> {
    let (witness, mut recorded) = (state.witness, Recorded::default());
    if fields.is_empty() {
        return Some(recorded);
    }
    state.finish_rates(topology);
    let mut direct = Direct::new(model, topology, witness);
    for field in fields {
        let mut field = FieldParts::new(topology, &field.spread(witness), witness);
        if !field.is_constant() {
            return None;
        }
        field.set_shifts();
        direct.solve(topology, state, &field);
        recorded.limits.push(direct.excess(topology, state, &field));
        for &body in &field.reach.bodies {
            recorded.results.extend(components(&direct.w, state, body));
        }
    }
    Some(recorded)
}

impl BodySensitivity {
    /// From its fields, one after the other.
    #[inline(always)]
    fn from_components(x: &[f64; 24]) -> Self {
        let vector = |k: usize| Vec3::new(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
        Self {
            dr: vector(0),
            dpi: vector(1),
            dv: vector(2),
            domega: vector(3),
            da: vector(4),
            dalpha: vector(5),
        }
    }
}
