//! Virtual motion of a load: every load is `y = sum F . Y`, with Y the twists of the bodies when its joint opens, or
//! its driver moves alone (`docs/theory.md`, section 14); for any number type.

use crate::constraint::MarkerPairRates;
use crate::model::{BodyId, DriverId, GROUND, JointId, MeasureKind, of_bodies};
use crate::motion::kinematics::State;
use crate::motion::level::Flow;
use crate::number::{Dual, Real, array};
use crate::sensitivity::{Transmission, Turning};
use crate::space::{Twist, Wrench};
use crate::topology::{ClosureId, LinkId, Topology};

use super::equilibrium::{DriverSite, LoadSites};
use super::transmitted::TransmittedLoads;

/// Derivatives of a load by the transmitted loads.
#[derive(Debug)]
pub(super) struct Weights<T> {
    /// By the reaction wrench of a joint on body j.
    joint: Option<(JointId, Twist<T>)>,
    /// By the load of a driver.
    driver: Option<(DriverId, T)>,
    /// By the wrench on ground.
    ground: Option<Twist<T>>,
}

impl<T: Real> Weights<T> {
    /// Weights of a measure; all zero.
    pub fn of_measure(kind: &MeasureKind) -> Self {
        let none = Self { joint: None, driver: None, ground: None };
        match *kind {
            MeasureKind::Reaction { joint, .. } => Self::of_joint(joint),
            MeasureKind::DriverForce { driver } | MeasureKind::DriverPower { driver } => {
                Self { driver: Some((driver, T::zero())), ..none }
            }
            MeasureKind::ShakingForce { .. } | MeasureKind::ShakingMoment { .. } => {
                Self { ground: Some(Twist::zero()), ..none }
            }
            MeasureKind::SpringForce { .. }
            | MeasureKind::KineticEnergy { .. }
            | MeasureKind::Slope { .. }
            | MeasureKind::Dexterity { .. }
            | MeasureKind::Compliance { .. }
            | MeasureKind::Wheel { .. }
            | MeasureKind::Axle { .. }
            | of_bodies!() => none,
        }
    }

    /// Weights of a function of the reaction wrench of one joint; all zero.
    pub fn of_joint(joint: JointId) -> Self {
        Self { joint: Some((joint, Twist::zero())), driver: None, ground: None }
    }

    /// Sets the weights from derivatives of `objective`, a function of the transmitted loads, which have none.
    pub fn set(
        &mut self,
        loads: &mut TransmittedLoads<Dual<T>>,
        objective: impl Fn(&TransmittedLoads<Dual<T>>) -> T,
    ) {
        if let Some((driver, weight)) = &mut self.driver {
            loads.drivers[driver.0].d = T::one();
            *weight = objective(loads);
            loads.drivers[driver.0].d = T::zero();
        }
        if let Some(weight) = &mut self.ground {
            *weight = by_wrench(loads, |loads| &mut loads.shaking, &objective);
        }
        if let Some((joint, weight)) = &mut self.joint {
            *weight = by_wrench(loads, |loads| &mut loads.joints[joint.0], &objective);
        }
    }

    /// Derivative by the wrench on ground.
    pub fn of_ground(&self) -> Twist<T> {
        self.ground.unwrap_or(Twist::zero())
    }
}

/// Derivatives of `objective` by the components of one wrench.
fn by_wrench<T: Real>(
    loads: &mut TransmittedLoads<Dual<T>>,
    wrench: impl Fn(&mut TransmittedLoads<Dual<T>>) -> &mut Wrench<Dual<T>>,
    objective: impl Fn(&TransmittedLoads<Dual<T>>) -> T,
) -> Twist<T> {
    let constant = *wrench(loads);
    let by = std::array::from_fn(|unit| {
        let mut components = constant.work();
        components[unit].d = T::one();
        *wrench(loads) = Wrench::from_work(components);
        objective(loads)
    });
    *wrench(loads) = constant;
    Twist::from_components(by)
}

/// Derivatives of the wrenches that closures transmit, at constant multipliers, by the unit twists of their markers.
pub(super) struct TurningClosures<T> {
    /// Per closure: by those of marker i, then of marker j.
    by_ends: Vec<[Wrench<T>; 12]>,
}

impl<T: Real> TurningClosures<T> {
    pub fn new(topology: &Topology) -> Self {
        Self { by_ends: vec![[Wrench::zero(); 12]; topology.closures.len()] }
    }

    /// Sets the derivatives at a state with these transmitted wrenches: `T_c' = -sum mu_r l'_r`.
    pub fn set(&mut self, topology: &Topology, state: &State<T>, transmission: &Transmission<T>) {
        let none = Twist::zero();
        for (c, closure) in ClosureId::each(&topology.closures) {
            for unit in 0..12 {
                let mut ends = [none; 2];
                ends[unit / 6] = Twist::UNITS[unit % 6].spread();
                let mut rates = MarkerPairRates { v_i: ends[0], v_j: ends[1], a_i: none, a_j: none };
                if let Some(k) = closure.contact {
                    rates = state.walk(c, k, &rates);
                }
                let mut sum = Wrench::zero();
                for (r, row) in closure.numbered_rows().filter(|(r, _)| topology[*r].has_wrench()) {
                    let [l, _] = row.wrench_rates(&state.ends[c.0], &rates);
                    sum = l.times_plus(-transmission.rows[0][r.0], sum);
                }
                self.by_ends[c.0][unit] = sum;
            }
        }
    }
}

/// Solves for virtual motions.
pub(super) struct VirtualMotion<T> {
    flow: Flow<T>,
}

impl<T: Real> VirtualMotion<T> {
    pub fn new(topology: &Topology, bodies: usize) -> Self {
        Self { flow: Flow::new(topology, bodies, true).with_moves() }
    }

    /// Virtual twist Y per body.
    pub fn twists(&self) -> &[Twist<T>] {
        &self.flow.twists[0]
    }

    /// Speed of every coordinate in that motion.
    pub fn speeds(&self) -> &[T] {
        &self.flow.speeds[0]
    }

    /// Solves for Y by (11): the weights prescribe the motion of markers i of the joints, and the speeds of drivers.
    pub fn solve(
        &mut self,
        sites: &LoadSites,
        topology: &Topology,
        state: &mut State<T>,
        weights: &Weights<T>,
    ) {
        let Self { flow, .. } = self;
        flow.moves[0].fill(Twist::zero());
        flow.demand.fill(T::zero());
        flow.speeds[0].fill(T::zero());
        if let Some((joint, c)) = &weights.joint {
            let site = &sites.joints[joint.0];
            if let Some((k, forward)) = site.link {
                flow.move_link(0, (k, usize::from(!forward)), *c);
            }
            site.closures.iter().for_each(|&closure| flow.move_end(topology, (closure, 0), *c, &state.l[0]));
        }
        if let Some((driver, weight)) = weights.driver {
            match sites.drivers[driver.0] {
                Some(DriverSite::Coordinate(c)) => flow.speeds[0][c.0] = weight,
                Some(DriverSite::Row(r)) => flow.demand[r.0] += weight,
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
        &self,
        (sites, transmission): (&LoadSites, &Transmission<T>),
        (topology, state, turned): (&Topology, &State<T>, &TurningClosures<T>),
        weights: &Weights<T>,
        turning: &mut Turning<T>,
        mut on: impl FnMut(BodyId, Wrench<T>),
    ) {
        let Self { flow } = self;
        let links = &transmission.links[0];
        for (k, link) in LinkId::each(&topology.links) {
            let mut later = Wrench::zero();
            for step in link.steps.iter().rev() {
                for c in step.coordinates() {
                    // D behind a freedom is D before it + x S.
                    turning.pulls[c.0] = later.on(state.x[0][c.0]);
                }
                for c in step.coordinates() {
                    // A load does not depend on all bodies.
                    if flow.speeds[0][c.0].vanishes() {
                        continue;
                    }
                    // T . ad(D) x S_Y = -ad(x S_Y)^T T . D
                    later = state.x[0][c.0].ad_transposed(links[k.0]).times_plus(-flow.speeds[0][c.0], later);
                }
            }
            turning.starts[k.0] = later;
        }
        for (c, closure) in ClosureId::each(&topology.closures) {
            let [i, j] = closure.bodies;
            let (i, j) = (flow.twists[0][i.0], flow.twists[0][j.0]);
            let opened = weights.joint.filter(|(joint, _)| sites.joints[joint.0].closures.contains(&c));
            let apart = j - i - opened.map_or(Twist::zero(), |(_, twist)| twist);
            if apart.components().into_iter().all(T::vanishes) {
                turning.ends[c.0] = [Wrench::zero(); 2];
                continue;
            }
            let by_ends = &turned.by_ends[c.0];
            let end = |first: usize| Wrench::from_work(array(|k| by_ends[first + k].on(apart)));
            turning.ends[c.0] = [end(0), end(6)];
        }
        // D = W + z: the frames turn with W of their body; ground has none.
        let mut on = |body: BodyId, load: Wrench<T>| {
            if body != GROUND {
                on(body, load);
            }
        };
        for (k, link) in LinkId::each(&topology.links) {
            on(link.parent, turning.starts[k.0]);
        }
        for (c, closure) in ClosureId::each(&topology.closures) {
            let ([i, j], [at_i, at_j]) = (closure.bodies, turning.ends[c.0]);
            on(i, at_i);
            on(j, at_j);
        }
    }
}
