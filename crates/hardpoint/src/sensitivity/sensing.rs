//! Sensitivities of all design variables, step after step.

use fearless_simd::{Level, dispatch};

use crate::model::{Field, Model};
use crate::motion::kinematics::State;
use crate::space::{LANES, Real, Twist, Vec3, lanes};
use crate::topology::Topology;

use super::direct::{Defect, Direct, FieldParts};
use super::{Admissibility, BodySensitivity, JointDefect, Sensitivities, admissibility_at_design};

/// Up to this many variables are solved one by one; more go eight at a time in SIMD lanes.
const FEW: usize = 2;

/// Collects the sensitivities of a run, whatever the lanes it works in.
pub(crate) trait Sense {
    /// Adds the sensitivities of the step at time t, where `state` stands with velocity and acceleration.
    fn step(&mut self, topology: &Topology, state: &mut State<f64>, t: f64);

    /// All of them, with what they say of every variable's admissibility.
    fn finish(self: Box<Self>) -> Sensitivities;
}

/// Prepares the sensitivities by the variables with these fields, over so many steps.
pub(crate) fn sensing<'f>(
    model: &'f Model,
    topology: &Topology,
    fields: &'f [Field],
    steps: usize,
) -> Box<dyn Sense + 'f> {
    if fields.len() <= FEW {
        return Box::new(Sensing::new(model, topology, fields, steps, 0.0));
    }
    dispatch!(Level::new(), simd => {
        Box::new(Sensing::new(model, topology, fields, steps, lanes(simd))) as Box<dyn Sense + 'f>
    })
}

/// Components of one body's six derivatives, in the order of [`BodySensitivity`]; per component, all lanes.
type Derivatives = [[f64; LANES]; 18];

/// One design variable per lane; the motion is the same in all of them.
struct Sensing<'f, T> {
    model: &'f Model,
    fields: &'f [Field],
    /// The fields, as many at a time as there are lanes.
    groups: Vec<FieldParts<T>>,
    state: State<T>,
    direct: Direct<T>,
    derivatives: Derivatives,
    out: Sensitivities,
    /// Per variable: the joints that resist, and the time of the largest defect.
    resisting: Vec<(Vec<JointDefect>, f64)>,
}

impl<'f, T: Real> Sensing<'f, T> {
    fn new(model: &'f Model, topology: &Topology, fields: &'f [Field], steps: usize, witness: T) -> Self {
        let bodies = model.bodies.len();
        let mut out = Sensitivities { variables: fields.len(), bodies, ..Sensitivities::default() };
        out.states.reserve_exact(steps * fields.len() * bodies);
        Self {
            model,
            fields,
            groups: fields.chunks(T::LANES).map(|f| FieldParts::new(topology, f, witness)).collect(),
            state: State::new(model, topology, witness),
            direct: Direct::new(model, topology, witness),
            derivatives: [[0.0; LANES]; 18],
            out,
            resisting: vec![(Vec::new(), 0.0); fields.len()],
        }
    }

    /// Keeps in mind which joint resists variable b most, and when.
    fn note(&mut self, topology: &Topology, b: usize, defect: Defect, t: f64) {
        let place = &topology.rows[defect.row];
        let closure = &topology.closures[place.closure];
        let row = closure.rows[place.index];
        let (joints, time) = &mut self.resisting[b];
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
}

impl<T: Real> Sense for Sensing<'_, T> {
    fn step(&mut self, topology: &Topology, state: &mut State<f64>, t: f64) {
        if self.fields.is_empty() {
            return;
        }
        state.finish_rates(topology);
        self.state.spread(state);
        let bodies = self.model.bodies.len();
        let step = self.out.states.len();
        self.out.states.resize(step + self.fields.len() * bodies, BodySensitivity::ZERO);
        for g in 0..self.groups.len() {
            let first = g * T::LANES;
            let variables = first..usize::min(first + T::LANES, self.fields.len());
            self.groups[g].set_time(self.model, t);
            self.direct.solve(topology, &mut self.state, &self.groups[g]);
            for body in 1..bodies {
                body_derivatives(&self.direct.w, &self.state, body, &mut self.derivatives);
                for b in variables.clone() {
                    self.out.states[step + b * bodies + body] =
                        BodySensitivity::of_lane(&self.derivatives, b - first);
                }
            }
            let mut defects = [None; LANES];
            self.direct.worst_defects(
                topology,
                &self.state,
                &self.groups[g],
                &mut defects[..variables.len()],
            );
            for (b, defect) in variables.zip(defects) {
                if let Some(defect) = defect {
                    self.note(topology, b, defect, t);
                }
            }
        }
    }

    fn finish(mut self: Box<Self>) -> Sensitivities {
        let nothing_solved = self.out.states.is_empty();
        let model = self.model;
        self.out.admissibility = self
            .fields
            .iter()
            .zip(self.resisting)
            .map(|(field, (joints, time))| {
                let open = admissibility_at_design(model, field);
                if !joints.is_empty() {
                    Admissibility::CannotFollow { joints, time }
                } else if nothing_solved {
                    Admissibility::Unknown
                } else if open.is_empty() {
                    Admissibility::Admissible
                } else {
                    Admissibility::Reassembled { joints: open }
                }
            })
            .collect();
        self.out
    }
}

/// Derivatives of r, pi, v, omega, a and alpha from the design twist W of a body and its time derivatives:
/// `V' = W. + ad(W) V`, `A' = W.. + ad(W.) V + ad(W) A` (`docs/theory.md` (14)).
fn body_derivatives<T: Real>(w: &[Vec<Twist<T>>; 3], state: &State<T>, body: usize, out: &mut Derivatives) {
    state.witness.within(
        #[inline(always)]
        || {
            let (w0, w1, w2) = (w[0][body], w[1][body], w[2][body]);
            let (r, v, a) = (state.pose[body].r, state.v[body], state.a[body]);
            let dv = w1 + w0.ad(v);
            let da = w2 + w1.ad(v) + w0.ad(a);
            let dr = w0.at(r);
            let velocity = v.at(r);
            let dvelocity = dv.at(r) + v.w.cross(dr);
            let dacceleration = da.at(r) + a.w.cross(dr) + dv.w.cross(velocity) + v.w.cross(dvelocity);
            for (k, d) in [dr, w0.w, dvelocity, dv.w, dacceleration, da.w].iter().enumerate() {
                d.x.store(&mut out[3 * k]);
                d.y.store(&mut out[3 * k + 1]);
                d.z.store(&mut out[3 * k + 2]);
            }
        },
    )
}

impl BodySensitivity {
    fn of_lane(d: &Derivatives, lane: usize) -> Self {
        let vector = |k: usize| Vec3::new(d[3 * k][lane], d[3 * k + 1][lane], d[3 * k + 2][lane]);
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
