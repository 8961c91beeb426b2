//! How one load changes with all variables: loads of their own on the bodies, carried to ground once.
//!
//! Every load is `y = sum F . Y`, with Y what opening its joint, or moving its driver alone, makes of the bodies. So
//! `y' = sum F' . Y + sum F . Y'` is linear in the design twists W, W., W.. and in what the frames of joints do, and its coefficients are
//! loads like those of any output (`docs/theory.md` (48)).
//!
//! | here | theory | what |
//! |---|---|---|
//! | [`Weights`] | C, w | how the load goes with the wrenches of joints, forces of drivers, and what ground takes |
//! | `virtual_motion` | Y, S_Y | what these weights move |
//! | `loads` | P | `sum F' . Y` by W, W., W.. of each body |
//! | `turning` | | `sum F . Y'` by the twists of the frames that unit twists and wrenches turn with |

use crate::constraint::{MarkerPairRates, Row};
use crate::design::Geometry;
use crate::model::{BodyId, DriverId, ElementId, GROUND, JointId, MeasureKind, Model};
use crate::motion::kinematics::State;
use crate::motion::level::Flow;
use crate::number::{Dual, Real};
use crate::sensitivity::{Adjoint, Load, Support, Turning};
use crate::space::{Pose, Twist, Vec3, Wrench};
use crate::topology::{ClosureId, LinkId, RowId, Topology};

use super::acting::{Acting, Moving};
use super::carry::{Carried, DriverAt, LoadSolver, changed};
use super::measures::Instant;

/// How a load goes with what is carried.
#[derive(Debug, Default)]
struct Weights {
    /// By the wrenches that joints put on their bodies j.
    joints: Vec<(JointId, Twist)>,
    /// By the forces of drivers.
    drivers: Vec<(DriverId, f64)>,
    /// By the wrench on ground.
    ground: Option<Twist>,
}

/// Gradients of loads where a stepper stands; nothing but a few weights is allocated per step.
pub(crate) struct LoadGradients {
    /// Y and S_Y.
    flow: Flow<f64>,
    /// What acts, with derivatives.
    bodies: Vec<Moving<Dual>>,
    friction: Vec<Dual>,
    carried: Carried<Dual>,
    needed: Vec<Wrench<Dual>>,
    /// Per body: the elements that know of it.
    felt: Vec<Vec<ElementId>>,
    /// Per variable: whether it changes a load with all bodies where they are.
    touches: Vec<bool>,
    /// By how much the equations of friction count, in the order of its hinges.
    rubs: Vec<f64>,
    turning: Turning,
    loads: Vec<(usize, Load)>,
    support: Support,
    work: Vec<[f64; 3]>,
}

impl LoadGradients {
    /// By the variables of an adjoint.
    pub fn new(solver: &LoadSolver<'_>, topology: &Topology, adjoint: &Adjoint) -> Self {
        let model = solver.model;
        let bodies = model.bodies.len();
        let mut felt = vec![Vec::new(); bodies];
        for (e, element) in model.elements.iter().enumerate() {
            let mut on: Vec<BodyId> = element.kind.bodies(model);
            on.sort_unstable();
            on.dedup();
            on.iter().for_each(|b| felt[b.0].push(ElementId(e)));
        }
        let moving: Vec<usize> = (1..bodies).collect();
        Self {
            flow: Flow::new(topology, bodies, true).with_moves(),
            bodies: vec![Moving::still(); bodies],
            friction: vec![Dual::zero(); model.elements.len()],
            carried: Carried::new(model),
            needed: vec![Wrench::zero(); bodies],
            felt,
            touches: solver.changed.iter().map(|g| touches(model, g)).collect(),
            rubs: Vec::new(),
            turning: Turning::new(topology),
            loads: moving.iter().map(|b| (*b, [Wrench::zero(); 3])).collect(),
            support: adjoint.support(topology, &moving),
            work: vec![[0.0; 3]; model.variables.len()],
        }
    }

    /// Derivatives by all variables of measure m, which `solver` has found where a state stands with its rates.
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
        self.rubs.clear();
        let mut weights = self.weights(solver, kind);
        self.virtual_motion(solver, topology, state, &weights);
        if !solver.friction.is_empty() {
            // y_M, and with it what the equations of friction count for: then the load is one that friction stands for.
            let by_moments = solver.friction.elements().map(|e| self.by_friction(solver, kind, &weights, e));
            let by_moments: Vec<f64> = by_moments.collect();
            self.rubs = solver.friction.multipliers(by_moments);
            weights = self.weights(solver, kind);
            self.virtual_motion(solver, topology, state, &weights);
        }
        let ground = weights.ground.unwrap_or(Twist::ZERO);
        for n in 0..self.loads.len() {
            let body = self.loads[n].0;
            let still = self.bodies[body];
            for (order, unit) in (0..18).map(|k| (k / 6, k % 6)) {
                let mut twists = [Twist::ZERO; 3];
                twists[order] = unit_twist(unit);
                self.bodies[body] = changed(&solver.now.bodies[body], twists);
                let by = self.goes(solver, &solver.constant, kind, ground, Some(body));
                // (F . W).. = F . W.. + 2 F. . W. + F.. . W: with these in the place of F and its rates that is what W makes of y.
                let factor = [1.0, 0.5, 1.0][order];
                set(&mut self.loads[n].1[2 - order], unit, by * factor);
            }
            self.bodies[body] = still;
        }
        self.turn(solver, topology, state, &weights);
        self.work.fill([0.0; 3]);
        adjoint.add_turning_work(
            topology,
            state,
            (&self.support, &self.loads),
            &self.turning,
            &mut self.work,
        );
        for (v, out) in out.iter_mut().enumerate() {
            for d in 0..self.carried.speeds.len() {
                self.carried.speeds[d].d = adjoint.law_rate(v, DriverId(d), 1);
            }
            let alters = self.touches[v] || self.carried.speeds.iter().any(|speed| speed.d != 0.0);
            let directly =
                if alters { self.goes(solver, &solver.changed[v], kind, ground, None) } else { 0.0 };
            out[0] = self.work[v][2] + directly;
        }
    }

    /// Takes over where everything is.
    fn stand(&mut self, solver: &LoadSolver<'_>) {
        for b in 1..self.bodies.len() {
            self.bodies[b] = changed(&solver.now.bodies[b], [Twist::ZERO; 3]);
        }
        for (to, from) in self.friction.iter_mut().zip(&solver.now.friction) {
            *to = Dual::constant(*from);
        }
        let found = &solver.now.found;
        let constant = |x: &Vec<f64>| x.iter().map(|x| Dual::constant(*x)).collect();
        (self.carried.drivers, self.carried.speeds) = (constant(&found.drivers), constant(&found.speeds));
        self.carried.joints.clear();
        self.carried.joints.extend(found.joints.iter().map(|l| l.spread()));
        self.carried.shaking = found.shaking.spread();
    }

    /// The load itself and the equations of friction that it counts with, from what is carried; its derivative along what has been set.
    fn objective(&self, solver: &LoadSolver<'_>, geometry: &Geometry<Dual>, kind: &MeasureKind) -> f64 {
        let acting = self.acting(solver, geometry);
        let load = Instant { acting: &acting, carried: &self.carried }.measure(kind);
        load.d + solver.friction.misses(&acting, &self.carried, &self.rubs).d
    }

    fn acting<'s>(&'s self, solver: &'s LoadSolver<'_>, geometry: &'s Geometry<Dual>) -> Acting<'s, Dual> {
        let LoadSolver { model, laws, near, .. } = solver;
        Acting { model, geometry, bodies: &self.bodies, laws, near, friction: &self.friction }
    }

    /// How the load goes with what has been set, by itself and by what the bodies need, on Y: of elements that feel a body, or of all.
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
        let mut sum = self.objective(solver, geometry, kind);
        for (wrench, y) in needed.iter().zip(&self.flow.twists[0]) {
            let change = Wrench { m: wrench.m.map(|x| x.d), f: wrench.f.map(|x| x.d) };
            // The wrench on ground is -sum F.
            sum += change.on(*y) - change.on(ground);
        }
        self.needed = needed;
        sum
    }

    /// The derivative by the moment of a hinge that rubs, all else standing.
    fn by_friction(
        &mut self,
        solver: &LoadSolver<'_>,
        kind: &MeasureKind,
        weights: &Weights,
        e: ElementId,
    ) -> f64 {
        self.friction[e.0].d = 1.0;
        let by = self.goes(solver, &solver.constant, kind, weights.ground.unwrap_or(Twist::ZERO), None);
        self.friction[e.0].d = 0.0;
        by
    }

    /// By what is carried, one number after the other.
    fn weights(&mut self, solver: &LoadSolver<'_>, kind: &MeasureKind) -> Weights {
        let mut weights = Weights::default();
        let mut joints: Vec<JointId> = solver.friction.joints().collect();
        match kind {
            MeasureKind::Reaction { joint, .. } => joints.push(*joint),
            MeasureKind::DriverForce { driver } | MeasureKind::DriverPower { driver } => {
                self.carried.drivers[driver.0].d = 1.0;
                weights.drivers.push((*driver, self.objective(solver, &solver.constant, kind)));
                self.carried.drivers[driver.0].d = 0.0;
            }
            MeasureKind::ShakingForce { .. } | MeasureKind::ShakingMoment { .. } => {
                let by = |k: usize| {
                    seed(&mut self.carried.shaking, k);
                    self.objective(solver, &solver.constant, kind)
                };
                weights.ground = Some(twist_of([0, 1, 2, 3, 4, 5].map(by)));
                self.carried.shaking = solver.now.found.shaking.spread();
            }
            _ => {}
        }
        joints.sort_unstable();
        joints.dedup();
        for joint in joints {
            let by = |k: usize| {
                seed(&mut self.carried.joints[joint.0], k);
                self.objective(solver, &solver.constant, kind)
            };
            weights.joints.push((joint, twist_of([0, 1, 2, 3, 4, 5].map(by))));
            self.carried.joints[joint.0] = solver.now.found.joints[joint.0].spread();
        }
        weights
    }

    /// Y: markers i of the joints go by their weights, drivers by theirs, and all else follows: (11).
    fn virtual_motion(
        &mut self,
        solver: &LoadSolver<'_>,
        topology: &Topology,
        state: &mut State<f64>,
        weights: &Weights,
    ) {
        let Self { flow, .. } = self;
        flow.moves[0].fill(Twist::ZERO);
        flow.demand.fill(0.0);
        flow.speeds[0].fill(0.0);
        for (joint, c) in &weights.joints {
            let at = &solver.places.joints[joint.0];
            if let Some((k, forward)) = at.link {
                flow.move_link(0, (k, usize::from(!forward)), *c);
            }
            at.closures.iter().for_each(|&closure| flow.move_end(topology, (closure, 0), *c, &state.l[0]));
        }
        for (driver, weight) in &weights.drivers {
            match solver.places.drivers[driver.0] {
                Some(DriverAt::Coordinate(c)) => flow.speeds[0][c.0] = *weight,
                Some(DriverAt::Row(r)) => flow.demand[r.0] += *weight,
                None => {}
            }
        }
        flow.follow::<0>(topology, topology.driven_links(), &state.x);
        for b in topology.block_ids() {
            flow.solve::<0>(topology, b, state.linear());
        }
    }

    /// `sum F . Y' = sum_k T_k . x'_a S_Y,a - sum_r mu_r l'_r . (Y_j - Y_i - C)`, as loads on the twists of the frames that x and l turn
    /// with, and on the coordinates before them.
    fn turn(&mut self, solver: &LoadSolver<'_>, topology: &Topology, state: &State<f64>, weights: &Weights) {
        let Self { flow, turning, loads, .. } = self;
        let (links, rows) = (&solver.transmission.links[0], &solver.transmission.rows[0]);
        turning.pulls.fill(0.0);
        for (k, link) in LinkId::each(&topology.links) {
            let mut later = Wrench::zero();
            for step in link.steps.iter().rev() {
                for c in step.coordinates() {
                    // D behind a freedom is D before it + x S.
                    turning.pulls[c.0] = later.on(state.x[0][c.0]);
                }
                for c in step.coordinates() {
                    // T . ad(D) x S_Y = -ad(x S_Y)^T T . D
                    later = state.x[0][c.0].ad_transposed(links[k.0]).times_plus(-flow.speeds[0][c.0], later);
                }
            }
            turning.starts[k.0] = later;
        }
        for (c, closure) in ClosureId::each(&topology.closures) {
            let [i, j] = closure.bodies.map(|b| flow.twists[0][b.0]);
            let opened =
                weights.joints.iter().find(|(joint, _)| solver.places.joints[joint.0].closures.contains(&c));
            let apart = j - i - opened.map_or(Twist::ZERO, |(_, twist)| *twist);
            for (end, unit) in (0..12).map(|k| (k / 6, k % 6)) {
                let mut ends = [Twist::ZERO; 2];
                ends[end] = unit_twist(unit);
                let none = Twist::ZERO;
                let mut rates = MarkerPairRates { v_i: ends[0], v_j: ends[1], a_i: none, a_j: none };
                if let Some(k) = closure.contact {
                    rates = state.walk(c, k, &rates);
                }
                let driving = closure.numbered_rows().filter(|(r, _)| topology[*r].drives());
                let works = |(r, row): (RowId, Row)| {
                    let [l, _] = row.wrench_rates(&state.ends[c.0], &rates);
                    -rows[r.0] * l.on(apart)
                };
                set(&mut turning.ends[c.0][end], unit, driving.map(works).sum());
            }
        }
        // D = W + z: what turns with a body's W as well; ground has none.
        let mut on = |body: BodyId, load: Wrench| {
            if body != GROUND {
                loads[body.0 - 1].1[2] += load;
            }
        };
        for ((_, link), start) in LinkId::each(&topology.links).zip(&turning.starts) {
            on(link.parent, *start);
        }
        for ((_, closure), ends) in ClosureId::each(&topology.closures).zip(&turning.ends) {
            closure.bodies.into_iter().zip(*ends).for_each(|(body, end)| on(body, end));
        }
    }
}

/// Whether a variable changes numbers, points, or markers that loads go by.
fn touches(model: &Model, changed: &Geometry<Dual>) -> bool {
    let goes = |v: Vec3<Dual>| [v.x, v.y, v.z].iter().any(|x| x.d != 0.0);
    let of_elements = model.elements.iter().filter_map(|e| e.kind.coordinate(model)).map(|(joint, _)| joint);
    let of_measures = model.measures.iter().filter_map(|m| match m.kind {
        MeasureKind::Reaction { joint, .. } => Some(joint),
        _ => None,
    });
    let marker = |m: &Pose<Dual>| goes(m.r) || m.rot.cols.iter().any(|c| goes(*c));
    changed.numbers.iter().any(|n| n.d != 0.0)
        || changed.points.iter().chain(&changed.spin_axes).any(|p| goes(*p))
        || of_elements.chain(of_measures).any(|joint| {
            changed.markers[joint.0].iter().any(marker)
                || changed.kept[joint.0].numbers().iter().any(|x| x.d != 0.0)
        })
}

/// A turn about x, y or z through the world origin, then a slide.
fn unit_twist(unit: usize) -> Twist {
    let axis = Vec3::AXES[unit % 3];
    if unit < 3 { Twist::turn(axis, Vec3::ZERO) } else { Twist::slide(axis) }
}

/// The twist with these weights of a wrench's numbers.
fn twist_of([a, b, c, x, y, z]: [f64; 6]) -> Twist {
    Twist { w: Vec3::new(a, b, c), v: Vec3::new(x, y, z) }
}

/// Sets the number of a wrench that a unit twist meets.
fn set(wrench: &mut Wrench, unit: usize, to: f64) {
    let half = if unit < 3 { &mut wrench.m } else { &mut wrench.f };
    *[&mut half.x, &mut half.y, &mut half.z][unit % 3] = to;
}

/// Lets one number of a wrench go, and no other.
fn seed(wrench: &mut Wrench<Dual>, unit: usize) {
    for (k, x) in
        [&mut wrench.m, &mut wrench.f].into_iter().flat_map(|v| [&mut v.x, &mut v.y, &mut v.z]).enumerate()
    {
        x.d = f64::from(u8::from(k == unit));
    }
}
