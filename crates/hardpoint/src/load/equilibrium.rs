//! Reactions of joints and driver loads at a position; over plain numbers, or during recording.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `required` | F = f - g | required wrench of each body (43) minus its applied wrench (44) |
//! | `transmission` | T, mu | transmitted wrenches: (18) with F |

use crate::design::Geometry;
use crate::model::{DriverId, JointId, MeasureKind, Model, UnitForce};
use crate::motion::kinematics::State;
use crate::number::{Dual, Real};
use crate::sensitivity::{Transmission, Transposed, Way};
use crate::space::{Twist, Wrench};
use crate::topology::{Closure, ClosureId, CoordinateId, LinkId, RowId, RowTerm, Topology};

use super::acting::{AppliedLoads, MovingBody};
use super::friction::Friction;
use super::measures::LoadMeasures;
use super::transmitted::{SelfStress, TransmittedLoads, set_constants};

/// Unknown of the plan that transmits the load of a driver.
#[derive(Clone, Copy, Debug)]
pub(super) enum DriverSite {
    /// `nu = T_k . x_a` of a coordinate of the tree.
    Coordinate(CoordinateId),
    /// `nu = mu_r` of a row.
    Row(RowId),
}

/// Rows of the plan that transmit the wrench of a joint on its body j.
#[derive(Clone, Debug, Default)]
pub(super) struct JointSite {
    /// The link of a tree joint; true if it runs from body i to body j.
    pub link: Option<(LinkId, bool)>,
    /// Rows of a cut joint, and of drivers across it.
    pub closures: Vec<ClosureId>,
}

/// Locations of the loads of joints and drivers in the plan.
pub(super) struct LoadSites {
    pub drivers: Vec<Option<DriverSite>>,
    pub joints: Vec<JointSite>,
    way: Way,
}

impl LoadSites {
    fn of(model: &Model, topology: &Topology) -> Self {
        Self {
            drivers: (0..model.drivers.len()).map(|d| driver_site(topology, DriverId(d))).collect(),
            joints: (0..model.joints.len()).map(|j| joint_site(model, topology, JointId(j))).collect(),
            way: Way::of_all(topology),
        }
    }
}

/// A position with all that applied loads depend on.
pub(super) struct LoadedPosition<T> {
    pub bodies: Vec<MovingBody<T>>,
    /// Per element: the value of its law.
    pub laws: Vec<T>,
    /// Per element: the coordinate that it acts on, with whole turns counted.
    pub near: Vec<T>,
    /// Per element: the moment of friction.
    pub friction: Vec<T>,
    /// Part of weights and preloads that acts; 1 but on the way to an equilibrium.
    pub share: f64,
    /// Further force, and its size.
    pub further: Option<(UnitForce, T)>,
}

impl<T: Real> LoadedPosition<T> {
    pub fn new(model: &Model) -> Self {
        let elements = model.elements.len();
        Self {
            bodies: vec![MovingBody::at_rest(); model.bodies.len()],
            laws: vec![T::one(); elements],
            near: vec![T::zero(); elements],
            friction: vec![T::zero(); elements],
            share: 1.0,
            further: None,
        }
    }

    pub fn loads<'s>(&'s self, model: &'s Model, geometry: &'s Geometry<T>) -> AppliedLoads<'s, T> {
        let Self { bodies, laws, near, friction, share, further } = self;
        AppliedLoads { model, geometry, bodies, laws, near, friction, share: *share, further: *further }
    }
}

impl<T: Real> LoadedPosition<Dual<T>> {
    /// Copies a position, without derivatives.
    pub fn set_constant(&mut self, of: &LoadedPosition<T>) {
        self.bodies.iter_mut().zip(&of.bodies).for_each(|(to, from)| *to = from.along([Twist::zero(); 3]));
        set_constants(&mut self.laws, &of.laws);
        set_constants(&mut self.near, &of.near);
        set_constants(&mut self.friction, &of.friction);
        self.share = of.share;
        self.further = of.further.map(|(force, size)| (force, Dual::constant(size)));
    }
}

/// Equilibrium of all bodies at a position.
pub(super) struct Equilibrium<'a, T> {
    pub model: &'a Model,
    pub geometry: Geometry<T>,
    pub sites: LoadSites,
    pub position: LoadedPosition<T>,
    pub friction: Friction,
    required: Vec<Wrench<T>>,
    pub transmission: Transmission<T>,
    pub transmitted: TransmittedLoads<T>,
    /// Transmission of some wrenches alone.
    alone: Transmission<T>,
    /// Self-stresses of the redundant constraints, one per redundant row; empty if none are requested.
    pub stresses: Vec<SelfStress<T>>,
}

impl<'a, T: Real> Equilibrium<'a, T> {
    pub fn new(model: &'a Model, topology: &Topology, geometry: Geometry<T>) -> Self {
        Self {
            model,
            geometry,
            sites: LoadSites::of(model, topology),
            position: LoadedPosition::new(model),
            friction: Friction::new(model),
            required: vec![Wrench::zero(); model.bodies.len()],
            transmission: Transmission::new(model, topology),
            transmitted: TransmittedLoads::new(model),
            alone: Transmission::new(model, topology),
            stresses: Vec::new(),
        }
    }

    /// Sets the motion of the bodies and the speeds of the drivers.
    pub fn set_motion(&mut self, state: &State<T>, speed: impl Fn(usize) -> T) {
        let [v, a, _] = &state.motion.twists;
        for b in 1..self.position.bodies.len() {
            self.position.bodies[b] = MovingBody { pose: state.pose[b], v: v[b], a: a[b] };
        }
        self.transmitted.speeds.iter_mut().enumerate().for_each(|(d, to)| *to = speed(d));
    }

    /// Applied loads at the position.
    pub fn applied(&self) -> AppliedLoads<'_, T> {
        self.position.loads(self.model, &self.geometry)
    }

    /// All loads at the position.
    pub fn measures<'s>(&'s self, applied: &'s AppliedLoads<'s, T>) -> LoadMeasures<'s, T> {
        LoadMeasures::new(applied, &self.transmitted)
    }

    /// Solves for the reactions to the required wrenches: T and mu of (18) with F.
    pub fn solve(&mut self, topology: &Topology, state: &mut State<T>) {
        let Self { model, geometry, sites, position, required, transmission, transmitted, .. } = self;
        position.loads(model, geometry).required(required);
        transmission.load[0].copy_from_slice(required);
        transmission.transmit(topology, Transposed::of(state), &sites.way, 0);
        for (j, site) in sites.joints.iter().enumerate() {
            transmitted.joints[j] = joint_wrench(site, topology, transmission, &state.l[0]);
        }
        for (d, site) in sites.drivers.iter().enumerate() {
            transmitted.drivers[d] = match *site {
                Some(DriverSite::Coordinate(c)) => {
                    transmission.links[0][topology[c].link.0].on(state.x[0][c.0])
                }
                Some(DriverSite::Row(r)) => transmission.rows[0][r.0],
                None => T::constant(f64::NAN),
            };
        }
        // Internal forces cancel.
        transmitted.shaking = required.iter().fold(Wrench::zero(), |sum, f| sum - *f);
    }

    /// Reactions of all joints to the applied wrenches alone; `applied` reduces the required wrenches.
    pub fn response(
        &mut self,
        topology: &Topology,
        state: &mut State<T>,
        applied: impl IntoIterator<Item = (usize, Wrench<T>)>,
    ) -> Vec<Wrench<T>> {
        let Self { sites, alone, .. } = self;
        alone.load[0].fill(Wrench::zero());
        applied.into_iter().for_each(|(body, wrench)| alone.load[0][body] -= wrench);
        alone.transmit(topology, Transposed::of(state), &sites.way, 0);
        sites.joints.iter().map(|site| joint_wrench(site, topology, alone, &state.l[0])).collect()
    }

    /// Solves for the self-stresses.
    pub fn solve_stresses(&mut self, topology: &Topology, state: &mut State<T>) {
        self.stresses.clear();
        for r in topology.redundant() {
            if self.stresses.is_empty() {
                state.finish_wrenches(topology);
            }
            // With mu_r = 1 row r applies l to body j, whose required wrench is reduced by it.
            let pull = |RowTerm { row, factor }| {
                (topology[row].closure, state.l[0][row.0].times_plus(T::constant(factor), Wrench::zero()))
            };
            let pulls: Vec<_> = topology.parts_of_row(r).map(pull).collect();
            let on_bodies = pulls.iter().flat_map(|(c, l)| {
                let [i, j] = topology[*c].bodies;
                [(j.0, *l), (i.0, Wrench::zero() - *l)]
            });
            let mut joints = self.response(topology, state, on_bodies);
            for (site, to) in self.sites.joints.iter().zip(&mut joints) {
                pulls.iter().filter(|(c, _)| site.closures.contains(c)).for_each(|(_, l)| *to += *l);
            }
            let loads = TransmittedLoads { joints, ..TransmittedLoads::new(self.model) };
            let largest = LoadMeasures::of_stress(&self.applied(), &loads).largest_reaction();
            self.stresses.push(SelfStress { loads, largest });
        }
    }

    /// Largest contribution of self-stresses to a measure: if it is above zero, the measure is not determined. Only
    /// reactions have one.
    pub fn excess(&self, kind: &MeasureKind) -> T {
        let none = T::constant(-1.0);
        if !matches!(kind, MeasureKind::Reaction { .. }) {
            return none;
        }
        let applied = &self.applied();
        let of = |stress: &SelfStress<T>| {
            LoadMeasures::of_stress(applied, &stress.loads).excess(kind, stress.largest)
        };
        self.stresses.iter().fold(none, |most, stress| most.larger(of(stress)))
    }
}

impl Equilibrium<'_, f64> {
    /// True if no self-stress contributes to the measure.
    pub fn is_determined(&self, kind: &MeasureKind) -> bool {
        // A NaN compares as undetermined.
        self.excess(kind) <= 0.0
    }

    /// Solves for friction, whose normal forces depend on the friction itself.
    pub fn solve_friction(&mut self, topology: &Topology, state: &mut State<f64>) {
        let applied = self.applied();
        let units: Vec<_> = self.friction.elements().map(|e| applied.friction_unit(e)).collect();
        let response = |unit: Option<(JointId, Wrench)>| {
            let Some((joint, l)) = unit else { return Vec::new() };
            let [i, j] = self.model.joints[joint.0].bodies;
            self.response(topology, state, [(j.0, l), (i.0, Wrench::zero() - l)])
        };
        let responses: Vec<_> = units.into_iter().map(response).collect();
        let Self { model, geometry, position, friction, transmitted, stresses, .. } = self;
        let applied = position.loads(model, geometry);
        friction.set(&applied, transmitted, &responses);
        // If redundant constraints share the force across a pin, its friction is not determined.
        friction.solve(&applied, stresses);
        friction.write_moments(&mut position.friction);
        self.solve(topology, state);
    }
}

/// Unknown that transmits a driver's load.
fn driver_site(topology: &Topology, driver: DriverId) -> Option<DriverSite> {
    let coordinate = topology.driven_coordinates().find(|(_, d)| *d == driver);
    let closure = || topology.closures.iter().find(|c| c.driver == Some(driver));
    match coordinate {
        Some((c, _)) => Some(DriverSite::Coordinate(c)),
        None => closure().map(|closure| DriverSite::Row(closure.first_row)),
    }
}

/// Rows that transmit a joint's wrench. The couples of couplers between its coordinates belong to the couplers, except
/// the thread of a screw.
fn joint_site(model: &Model, topology: &Topology, joint: JointId) -> JointSite {
    let link = LinkId::each(&topology.links).find(|(_, link)| link.joint == Some(joint));
    let is_own = |c: &Closure| c.joint == joint && c.coupler.is_none_or(|k| model.couplers[k].is_thread());
    let closures = ClosureId::each(&topology.closures).filter(|(_, c)| is_own(c));
    JointSite {
        link: link.map(|(k, link)| (k, link.parent_end == 0)),
        closures: closures.map(|(c, _)| c).collect(),
    }
}

/// Reaction wrench of a joint on body j, with the wrenches `l` of the rows.
#[inline]
fn joint_wrench<T: Real>(
    site: &JointSite,
    topology: &Topology,
    transmission: &Transmission<T>,
    l: &[Wrench<T>],
) -> Wrench<T> {
    let mut sum = Wrench::zero();
    if let Some((k, forward)) = site.link {
        let sign = T::constant(if forward { 1.0 } else { -1.0 });
        // T_k is the wrench of the parent on the child.
        sum = transmission.links[0][k.0].times_plus(sign, sum);
    }
    for &c in &site.closures {
        for r in topology[c].row_ids().filter(|&r| topology[r].has_wrench()) {
            // Row r applies mu_r l_r to body j.
            sum = l[r.0].times_plus(transmission.rows[0][r.0], sum);
        }
    }
    sum
}
