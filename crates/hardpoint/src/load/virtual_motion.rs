//! Virtual motion of a load: every load is `y = sum F . Y`, with Y the twists of the bodies when its joint opens, or
//! its driver moves alone (`docs/theory.md`, section 14); for any number type.

use crate::constraint::{MarkerPairRates, Row};
use crate::model::{BodyId, DriverId, GROUND, JointId, MeasureKind, of_bodies};
use crate::motion::kinematics::State;
use crate::motion::level::Flow;
use crate::number::{Dual, Real};
use crate::sensitivity::{Transmission, Turning};
use crate::space::{Twist, Vec3, Wrench};
use crate::topology::{ClosureId, LinkId, RowId, Topology};

use super::carry::{Carried, DriverAt, Places};

/// Derivatives of a load by the transmitted wrenches.
#[derive(Debug)]
pub(super) struct Weights<T> {
    /// By the reaction wrenches of joints on body j.
    joints: Vec<(JointId, Twist<T>)>,
    /// By the driver loads.
    drivers: Vec<(DriverId, T)>,
    /// By the wrench on ground; zero for most loads.
    pub ground: Twist<T>,
}

impl<T: Real> Weights<T> {
    /// Weights of a measure, from derivatives of `objective`, a function of the transmitted wrenches. The objective
    /// also depends on the wrenches of the joints `besides`.
    pub fn of(
        kind: &MeasureKind,
        besides: impl Iterator<Item = JointId>,
        carried: &mut Carried<Dual<T>>,
        objective: impl Fn(&Carried<Dual<T>>) -> T,
    ) -> Self {
        let mut weights = Self { joints: Vec::new(), drivers: Vec::new(), ground: Twist::zero() };
        let mut joints: Vec<JointId> = besides.collect();
        match kind {
            MeasureKind::Reaction { joint, .. } => joints.push(*joint),
            MeasureKind::DriverForce { driver } | MeasureKind::DriverPower { driver } => {
                carried.drivers[driver.0].d = T::one();
                weights.drivers.push((*driver, objective(carried)));
                carried.drivers[driver.0].d = T::zero();
            }
            MeasureKind::ShakingForce { .. } | MeasureKind::ShakingMoment { .. } => {
                weights.ground = slopes(carried, |carried| &mut carried.shaking, &objective);
            }
            MeasureKind::SpringForce { .. }
            | MeasureKind::KineticEnergy { .. }
            | MeasureKind::Slope { .. }
            | MeasureKind::Compliance { .. }
            | MeasureKind::Wheel { .. }
            | MeasureKind::Axle { .. }
            | of_bodies!() => {}
        }
        joints.sort_unstable();
        joints.dedup();
        for joint in joints {
            let by = slopes(carried, |carried| &mut carried.joints[joint.0], &objective);
            weights.joints.push((joint, by));
        }
        weights
    }
}

/// Derivatives of `objective` by the components of one wrench.
fn slopes<T: Real>(
    carried: &mut Carried<Dual<T>>,
    wrench: impl Fn(&mut Carried<Dual<T>>) -> &mut Wrench<Dual<T>>,
    objective: impl Fn(&Carried<Dual<T>>) -> T,
) -> Twist<T> {
    let mut by = |unit: usize| {
        seed(wrench(carried), Some(unit));
        objective(carried)
    };
    let [a, b, c, x, y, z] = [0, 1, 2, 3, 4, 5].map(&mut by);
    seed(wrench(carried), None);
    Twist { w: Vec3::new(a, b, c), v: Vec3::new(x, y, z) }
}

/// Sets the derivative of one component of a wrench to one, and of the others to zero.
fn seed<T: Real>(wrench: &mut Wrench<Dual<T>>, unit: Option<usize>) {
    let numbers = [&mut wrench.m, &mut wrench.f].into_iter().flat_map(|v| [&mut v.x, &mut v.y, &mut v.z]);
    for (k, x) in numbers.enumerate() {
        x.d = if Some(k) == unit { T::one() } else { T::zero() };
    }
}

/// Y and S_Y, and the part of the load's derivative that is due to the turning of unit twists and wrenches.
pub(super) struct VirtualMotion<T> {
    flow: Flow<T>,
    pub turning: Turning<T>,
}

impl<T: Real> VirtualMotion<T> {
    pub fn new(topology: &Topology, bodies: usize) -> Self {
        Self { flow: Flow::new(topology, bodies, true).with_moves(), turning: Turning::new(topology) }
    }

    /// Virtual twist Y per body.
    pub fn twists(&self) -> &[Twist<T>] {
        &self.flow.twists[0]
    }

    /// Solves for Y by (11): the weights prescribe the motion of markers i of the joints, and the speeds of drivers.
    pub fn go(&mut self, places: &Places, topology: &Topology, state: &mut State<T>, weights: &Weights<T>) {
        let Self { flow, .. } = self;
        flow.moves[0].fill(Twist::zero());
        flow.demand.fill(T::zero());
        flow.speeds[0].fill(T::zero());
        for (joint, c) in &weights.joints {
            let at = &places.joints[joint.0];
            if let Some((k, forward)) = at.link {
                flow.move_link(0, (k, usize::from(!forward)), *c);
            }
            at.closures.iter().for_each(|&closure| flow.move_end(topology, (closure, 0), *c, &state.l[0]));
        }
        for (driver, weight) in &weights.drivers {
            match places.drivers[driver.0] {
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

    /// Computes `sum F . Y' = sum_k T_k . x'_a S_Y,a - sum_r mu_r l'_r . (Y_j - Y_i - C)` as loads on the twists of the
    /// frames that x and l turn with, and on the coordinates before them. Calls `on` for the loads on bodies.
    pub fn turn(
        &mut self,
        (places, transmission): (&Places, &Transmission<T>),
        topology: &Topology,
        state: &State<T>,
        weights: &Weights<T>,
        mut on: impl FnMut(BodyId, Wrench<T>),
    ) {
        let Self { flow, turning } = self;
        let (links, rows) = (&transmission.links[0], &transmission.rows[0]);
        turning.pulls.fill(T::zero());
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
                weights.joints.iter().find(|(joint, _)| places.joints[joint.0].closures.contains(&c));
            let apart = j - i - opened.map_or(Twist::zero(), |(_, twist)| *twist);
            for (end, unit) in (0..12).map(|k| (k / 6, k % 6)) {
                let mut ends = [Twist::zero(); 2];
                ends[end] = unit_twist(unit).spread();
                let none = Twist::zero();
                let mut rates = MarkerPairRates { v_i: ends[0], v_j: ends[1], a_i: none, a_j: none };
                if let Some(k) = closure.contact {
                    rates = state.walk(c, k, &rates);
                }
                let driving = closure.numbered_rows().filter(|(r, _)| topology[*r].has_wrench());
                let works = |(r, row): (RowId, Row)| {
                    let [l, _] = row.wrench_rates(&state.ends[c.0], &rates);
                    -(rows[r.0] * l.on(apart))
                };
                set(&mut turning.ends[c.0][end], unit, driving.map(works).fold(T::zero(), |sum, x| sum + x));
            }
        }
        // D = W + z: the frames turn with W of their body; ground has none.
        let mut on = |body: BodyId, load: Wrench<T>| {
            if body != GROUND {
                on(body, load);
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

/// Unit rotations about x, y and z through the world origin, followed by unit translations.
pub(super) fn unit_twist(unit: usize) -> Twist {
    let axis = Vec3::AXES[unit % 3];
    if unit < 3 { Twist::turn(axis, Vec3::ZERO) } else { Twist::slide(axis) }
}

/// Sets the component of a wrench that does work on a unit twist.
pub(super) fn set<T>(wrench: &mut Wrench<T>, unit: usize, to: T) {
    let half = if unit < 3 { &mut wrench.m } else { &mut wrench.f };
    *[&mut half.x, &mut half.y, &mut half.z][unit % 3] = to;
}
