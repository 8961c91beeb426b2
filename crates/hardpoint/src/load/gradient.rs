//! Gradient of one load by all variables, by the adjoint method: one propagation to ground per load.
//!
//! Every load is `y = sum F . Y`, with Y the twists of the bodies when its joint opens, or its driver moves alone. So
//! `y' = sum F' . Y + sum F . Y'` is linear in the design twists W, W., W.. and in the twists of the joint frames, and
//! its coefficients are adjoint loads like those of any output (`docs/theory.md` (48)).
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | [`Weights`] | C, w | derivatives of the load by joint wrenches, driver forces, and the wrench on ground |
//! | [`VirtualMotion`] | Y, S_Y | virtual motion due to these weights |
//! | `loads` | P | `sum F' . Y` by W, W., W.. of each body |
//! | [`VirtualMotion::turning`] | | `sum F . Y'` by the twists of the frames that unit twists and wrenches turn with |

use crate::design::Geometry;
use crate::model::{DriverId, ElementId, MeasureKind, Model};
use crate::motion::kinematics::State;
use crate::number::Dual;
use crate::sensitivity::{Adjoint, Load, Support};
use crate::space::{Pose, Twist, Vec3, Wrench};
use crate::topology::Topology;

use super::acting::{AppliedLoads, MovingBody};
use super::carry::{Carried, Equilibrium, LoadedPosition, changed};
use super::measures::Instant;
use super::solver::LoadSolver;
use super::virtual_motion::{VirtualMotion, Weights, set, unit_twist};

/// Gradients of loads at the position of a stepper. A step allocates only a few weights.
pub(crate) struct LoadGradients {
    /// Y, and the loads on the frames of joints.
    virtual_motion: VirtualMotion<f64>,
    /// Motion of the bodies with derivatives.
    bodies: Vec<MovingBody<Dual>>,
    laws: Vec<Dual>,
    near: Vec<Dual>,
    friction: Vec<Dual>,
    carried: Carried<Dual>,
    needed: Vec<Wrench<Dual>>,
    /// Per body: the force elements that depend on its motion.
    felt: Vec<Vec<ElementId>>,
    /// Per variable: true if it changes a load while all bodies stay in place.
    touches: Vec<bool>,
    /// Multipliers of the friction equations, in the order of the friction elements.
    multipliers: Vec<f64>,
    loads: Vec<(usize, Load)>,
    support: Support,
    work: Vec<[f64; 3]>,
}

impl LoadGradients {
    /// Gradients by the variables of an adjoint.
    pub fn new(solver: &LoadSolver<'_>, topology: &Topology, adjoint: &Adjoint) -> Self {
        let model = solver.model;
        let bodies = model.bodies.len();
        let mut felt = vec![Vec::new(); bodies];
        for (e, element) in model.elements.iter().enumerate() {
            let Some(force) = element.kind.force(model) else { continue };
            let [i, j] = force.acts_on.bodies(model);
            felt[i.0].push(ElementId(e));
            if i != j {
                felt[j.0].push(ElementId(e));
            }
        }
        let moving: Vec<usize> = (1..bodies).collect();
        Self {
            virtual_motion: VirtualMotion::new(topology, bodies),
            bodies: vec![MovingBody::still(); bodies],
            laws: Vec::new(),
            near: Vec::new(),
            friction: Vec::new(),
            carried: Carried::new(model),
            needed: vec![Wrench::zero(); bodies],
            felt,
            touches: solver.changed.iter().map(|c| touches(model, &c.geometry)).collect(),
            multipliers: Vec::new(),
            loads: moving.iter().map(|b| (*b, [Wrench::zero(); 3])).collect(),
            support: adjoint.support(topology, &moving),
            work: vec![[0.0; 3]; model.variables.len()],
        }
    }

    /// Derivatives of measure m by all variables. `solver` has evaluated the measure at this state.
    pub fn trace(
        &mut self,
        solver: &LoadSolver<'_>,
        adjoint: &mut Adjoint,
        (topology, state): (&Topology, &mut State<f64>),
        m: usize,
        out: &mut [[f64; 3]],
    ) {
        out.fill([f64::NAN; 3]);
        if solver.values[m].is_nan() {
            return;
        }
        let kind = &solver.model.measures[m].kind;
        self.stand(solver);
        self.multipliers.clear();
        let mut weights = self.weights(solver, kind);
        self.virtual_motion.go(&solver.bodies.places, topology, state, &weights);
        if !solver.friction.is_empty() {
            // y_M gives the multipliers of the friction equations; with them the moments need no derivative.
            let by_moments = solver.friction.elements().map(|e| self.by_friction(solver, kind, &weights, e));
            let by_moments: Vec<f64> = by_moments.collect();
            self.multipliers = solver.friction.multipliers(by_moments);
            weights = self.weights(solver, kind);
            self.virtual_motion.go(&solver.bodies.places, topology, state, &weights);
        }
        let ground = weights.ground;
        for n in 0..self.loads.len() {
            let body = self.loads[n].0;
            let still = self.bodies[body];
            for (order, unit) in (0..18).map(|k| (k / 6, k % 6)) {
                let mut twists = [Twist::ZERO; 3];
                twists[order] = unit_twist(unit);
                self.bodies[body] = changed(&solver.bodies.now.bodies[body], twists);
                let by = self.goes(solver, &solver.constant, kind, ground, Some(body));
                // (F . W).. = F . W.. + 2 F. . W. + F.. . W: the coefficients take the place of F and its rates.
                let factor = [1.0, 0.5, 1.0][order];
                set(&mut self.loads[n].1[2 - order], unit, by * factor);
            }
            self.bodies[body] = still;
            // Masses are felt by a matrix of each body.
            let Equilibrium { inertia, now, .. } = &solver.bodies;
            let y = self.virtual_motion.twists()[body] - ground;
            let [p0, p1, p2] = inertia[body].weights(solver.model, &now.bodies[body], y);
            let loads = &mut self.loads[n].1;
            loads[0] += p2;
            loads[1] = p1.times_plus(0.5, loads[1]);
            loads[2] += p0;
        }
        let Self { virtual_motion, loads, .. } = self;
        let of = (&solver.bodies.places, &solver.bodies.transmission);
        virtual_motion.turn(of, topology, state, &weights, |body, load| loads[body.0 - 1].1[2] += load);
        self.work.fill([0.0; 3]);
        adjoint.add_turning_work(
            topology,
            state,
            (&self.support, &self.loads),
            &self.virtual_motion.turning,
            &mut self.work,
        );
        for (v, out) in out.iter_mut().enumerate() {
            for d in 0..self.carried.speeds.len() {
                self.carried.speeds[d].d = adjoint.law_rate(v, DriverId(d), 1);
            }
            let alters = self.touches[v] || self.carried.speeds.iter().any(|speed| speed.d != 0.0);
            let directly =
                if alters { self.goes(solver, &solver.changed[v].geometry, kind, ground, None) } else { 0.0 };
            out[0] = self.work[v][2] + directly;
        }
    }

    /// Copies the position and the loads of the solver, without derivatives.
    fn stand(&mut self, solver: &LoadSolver<'_>) {
        for b in 1..self.bodies.len() {
            self.bodies[b] = changed(&solver.bodies.now.bodies[b], [Twist::ZERO; 3]);
        }
        let LoadedPosition { laws, near, friction, found, .. } = &solver.bodies.now;
        let constant = |x: &Vec<f64>| x.iter().map(|x| Dual::constant(*x)).collect();
        (self.laws, self.near, self.friction) = (constant(laws), constant(near), constant(friction));
        (self.carried.drivers, self.carried.speeds) = (constant(&found.drivers), constant(&found.speeds));
        self.carried.joints.clear();
        self.carried.joints.extend(found.joints.iter().map(|l| l.spread()));
        self.carried.shaking = found.shaking.spread();
    }

    /// Derivative of the load, with the weighted friction equations, along the direction that was set.
    fn objective(
        &self,
        solver: &LoadSolver<'_>,
        geometry: &Geometry<Dual>,
        kind: &MeasureKind,
        carried: &Carried<Dual>,
    ) -> f64 {
        let acting = self.acting(solver, geometry);
        let load = Instant { acting: &acting, carried }.measure(kind);
        load.d + solver.friction.weighted_residual(&acting, carried, &self.multipliers).d
    }

    fn acting<'s>(
        &'s self,
        solver: &'s LoadSolver<'_>,
        geometry: &'s Geometry<Dual>,
    ) -> AppliedLoads<'s, Dual> {
        let Self { bodies, laws, near, friction, .. } = self;
        AppliedLoads { model: solver.model, geometry, bodies, laws, near, friction }
    }

    /// Derivative of the load along the direction that was set: explicit, and through the required wrenches on Y. The
    /// elements are those that act on `body`, or all.
    fn goes(
        &mut self,
        solver: &LoadSolver<'_>,
        geometry: &Geometry<Dual>,
        kind: &MeasureKind,
        ground: Twist,
        body: Option<usize>,
    ) -> f64 {
        let mut needed = std::mem::take(&mut self.needed);
        needed.fill(Wrench::zero());
        let acting = self.acting(solver, geometry);
        match body {
            Some(b) => self.felt[b].iter().for_each(|e| acting.add(*e, &mut needed)),
            None => acting.needed(&mut needed),
        }
        let mut sum = self.objective(solver, geometry, kind, &self.carried);
        for (wrench, y) in needed.iter().zip(self.virtual_motion.twists()) {
            let change = Wrench { m: wrench.m.map(|x| x.d), f: wrench.f.map(|x| x.d) };
            // The wrench on ground is -sum F.
            sum += change.on(*y) - change.on(ground);
        }
        self.needed = needed;
        sum
    }

    /// Partial derivative by the moment of a friction element.
    fn by_friction(
        &mut self,
        solver: &LoadSolver<'_>,
        kind: &MeasureKind,
        weights: &Weights<f64>,
        e: ElementId,
    ) -> f64 {
        self.friction[e.0].d = 1.0;
        let by = self.goes(solver, &solver.constant, kind, weights.ground, None);
        self.friction[e.0].d = 0.0;
        by
    }

    /// Derivatives of the load by the transmitted wrenches.
    fn weights(&mut self, solver: &LoadSolver<'_>, kind: &MeasureKind) -> Weights<f64> {
        let mut carried = std::mem::replace(&mut self.carried, Carried::new(solver.model));
        let objective = |carried: &Carried<Dual>| self.objective(solver, &solver.constant, kind, carried);
        let weights = Weights::of(kind, solver.friction.joints(), &mut carried, objective);
        self.carried = carried;
        weights
    }
}

/// True if a variable changes numbers, points, or markers that loads depend on.
fn touches(model: &Model, changed: &Geometry<Dual>) -> bool {
    let goes = |v: Vec3<Dual>| [v.x, v.y, v.z].iter().any(|x| x.d != 0.0);
    let of_elements = model.elements.iter().filter_map(|e| e.kind.coordinate(model)).map(|(joint, _)| joint);
    let of_measures = model
        .measures
        .iter()
        .filter_map(|m| if let MeasureKind::Reaction { joint, .. } = m.kind { Some(joint) } else { None });
    let marker = |m: &Pose<Dual>| goes(m.r) || m.rot.cols.iter().any(|c| goes(*c));
    changed.numbers.iter().any(|n| n.d != 0.0)
        || changed.points.iter().chain(&changed.spin_axes).any(|p| goes(*p))
        || of_elements.chain(of_measures).any(|joint| {
            changed.markers[joint.0].iter().any(marker)
                || changed.kept[joint.0].numbers().iter().any(|x| x.d != 0.0)
        })
}
