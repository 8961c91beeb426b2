//! Gradients of loads by all variables, by the adjoint method: one propagation to ground per load.
//!
//! The coefficients of a load on the design twists ([`LoadDerivatives`]) are adjoint loads like those of any output
//! (`docs/theory.md` (48)). Here those of the force elements are included.

use crate::design::Geometry;
use crate::model::{DriverId, ElementId, MeasureKind, Model};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::number::Dual;
use crate::sensitivity::{Adjoint, Load, Support};
use crate::space::{Pose, Twist, Vec3, Wrench};
use crate::topology::Topology;

use super::derivatives::forces_on_bodies;
use super::solver::LoadSolver;

/// Gradients of the loads of a solver. Without friction and redundant constraints a step allocates no memory.
pub(crate) struct LoadGradients<'a> {
    solver: LoadSolver<'a>,
    /// Per body: the force elements that depend on its motion.
    forces_on: Vec<Vec<ElementId>>,
    /// Per variable: true if it changes a load while all bodies stay in place.
    is_explicit: Vec<bool>,
    /// Per load: its derivatives by the unit twists W and W. of one body, apart from masses.
    slopes: Vec<[[f64; 6]; 2]>,
    /// Per load: its coefficients on the bodies.
    loads: Vec<Vec<(usize, Load)>>,
    /// Per load and variable: the derivative while all bodies stay in place.
    explicit: Vec<Vec<f64>>,
    support: Support,
    work: Vec<[f64; 3]>,
}

impl<'a> LoadGradients<'a> {
    /// Gradients by the variables of an adjoint. `solver` has derivatives.
    pub fn new(solver: LoadSolver<'a>, topology: &Topology, adjoint: &Adjoint) -> Self {
        let model = solver.equilibrium.model;
        let (variables, loads) = (model.variables.len(), solver.measures.len());
        let moving: Vec<usize> = (1..model.bodies.len()).collect();
        let changed = solver.derivatives.iter().flat_map(|d| &d.changed);
        Self {
            forces_on: forces_on_bodies(model),
            is_explicit: changed.map(|c| is_explicit(model, &c.geometry)).collect(),
            slopes: vec![[[0.0; 6]; 2]; loads],
            loads: vec![moving.iter().map(|b| (*b, [Wrench::zero(); 3])).collect(); loads],
            explicit: vec![vec![0.0; variables]; loads],
            support: adjoint.support(topology, &moving),
            work: vec![[0.0; 3]; variables],
            solver,
        }
    }

    /// Evaluates the loads at the position of a stepper at time t, which was set in the adjoint, and prepares their
    /// gradients.
    pub fn step(&mut self, one: &mut Stepper<'_>, adjoint: &Adjoint, t: f64) {
        self.solver.step(one, t, true);
        let Self { solver, forces_on, is_explicit, slopes, loads, explicit, .. } = self;
        let LoadSolver { derivatives: Some(derivatives), equilibrium, .. } = solver else { return };
        let friction = &equilibrium.friction;
        for (b, forces) in forces_on.iter().enumerate().skip(1) {
            let body = equilibrium.position.bodies[b];
            // By W and W. alone: no applied force and no measure depends on accelerations.
            for (order, unit) in (0..12).map(|k| (k / 6, k % 6)) {
                let mut twists = [Twist::ZERO; 3];
                twists[order] = Twist::UNITS[unit];
                derivatives.position.bodies[b] = body.along(twists);
                derivatives.require(friction, forces.iter().copied());
                for (slopes, load) in slopes.iter_mut().zip(&derivatives.loads) {
                    slopes[order][unit] = derivatives.partial(load, &derivatives.constant, friction);
                }
            }
            derivatives.position.bodies[b] = derivatives.nominal[b];
            for ((slopes, load), loads) in slopes.iter().zip(&derivatives.loads).zip(&mut *loads) {
                let [mut p0, mut p1, p2] = load.by_twists[b];
                p0 += Wrench::from_work(slopes[0]);
                p1 += Wrench::from_work(slopes[1]);
                // (F . W).. = F . W.. + 2 F. . W. + F.. . W: the coefficients take the place of F and its rates.
                loads[b - 1].1 = [p2, p1.times_plus(0.5, Wrench::zero()), p0];
            }
        }
        for (v, is_explicit) in is_explicit.iter().enumerate() {
            let speeds = derivatives.transmitted.speeds.iter_mut().enumerate();
            speeds.for_each(|(d, speed)| speed.d = adjoint.law_rate(v, DriverId(d), 1));
            let changes = *is_explicit || derivatives.transmitted.speeds.iter().any(|speed| speed.d != 0.0);
            if changes {
                derivatives.require_of(friction, v);
            }
            for (explicit, load) in explicit.iter_mut().zip(&derivatives.loads) {
                let partial = || derivatives.partial(load, &derivatives.changed[v].geometry, friction);
                explicit[v] = if changes { partial() } else { 0.0 };
            }
        }
    }

    /// Derivatives of the solver's load n by all variables, at the position of the last step.
    pub fn gradient(
        &mut self,
        adjoint: &mut Adjoint,
        (topology, state): (&Topology, &mut State<f64>),
        n: usize,
        out: &mut [[f64; 3]],
    ) {
        out.fill([f64::NAN; 3]);
        let LoadSolver { derivatives: Some(derivatives), values, .. } = &self.solver else { return };
        if values[n].is_nan() {
            return;
        }
        self.work.fill([0.0; 3]);
        let on = (&self.support, &self.loads[n][..]);
        adjoint.add_turning_work(topology, state, on, &derivatives.loads[n].turning, &mut self.work);
        for ((out, work), explicit) in out.iter_mut().zip(&self.work).zip(&self.explicit[n]) {
            out[0] = work[2] + explicit;
        }
    }
}

/// True if a variable changes numbers, points, or markers that loads depend on.
fn is_explicit(model: &Model, changed: &Geometry<Dual>) -> bool {
    let moves = |v: Vec3<Dual>| [v.x, v.y, v.z].iter().any(|x| x.d != 0.0);
    let of_elements = model.elements.iter().filter_map(|e| e.kind.coordinate(model)).map(|(joint, _)| joint);
    let of_measures = model
        .measures
        .iter()
        .filter_map(|m| if let MeasureKind::Reaction { joint, .. } = m.kind { Some(joint) } else { None });
    let marker = |m: &Pose<Dual>| moves(m.r) || m.rot.cols.iter().any(|c| moves(*c));
    changed.numbers.iter().any(|n| n.d != 0.0)
        || changed.points.iter().chain(&changed.spin_axes).any(|p| moves(*p))
        || changed.axes.iter().flatten().flatten().any(|axes| axes.cols.iter().any(|c| moves(*c)))
        || of_elements.chain(of_measures).any(|joint| {
            changed.markers[joint.0].iter().any(marker)
                || changed.kept[joint.0].numbers().iter().any(|x| x.d != 0.0)
        })
}
