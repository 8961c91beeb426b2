//! Errors of the mechanism as a whole, with the names of the model.

use crate::draft::some_of;
use crate::model::{BodyId, DriverId, GROUND, JointId, Model};

use super::plan::SparseRow;
use super::{Closure, CutReason, Formulation, Link, RowId, Topology};

/// Error of a mechanism that its drivers cannot drive.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TopologyError {
    /// Under-driven: motions remain that no driver prescribes (HP0301).
    #[error("{}", under_driven_text(*.freedom, .bodies, .unconnected))]
    UnderDriven {
        /// Number of remaining free motions.
        freedom: usize,
        /// Joints that move in the free motions.
        joints: Vec<JointId>,
        /// Names, in the same order.
        joint_names: Vec<String>,
        /// Names of the bodies that move in them.
        bodies: Vec<String>,
        /// Names of those of these bodies that no joint connects to ground, directly or by other bodies.
        unconnected: Vec<String>,
    },
    /// Singular in the design configuration: motions are free there that are not free nearby (HP0304).
    #[error("the mechanism is singular in the design configuration ({})", dozen(.bodies))]
    Singular {
        /// Number of motions that are free in this position only.
        freedom: usize,
        /// Joints that move in the free motions.
        joints: Vec<JointId>,
        /// Names, in the same order.
        joint_names: Vec<String>,
        /// Names of the bodies that move in them.
        bodies: Vec<String>,
    },
    /// Over-driven: drivers prescribe more coordinates than there are degrees of freedom (HP0302).
    #[error("{}", over_driven_text(.driver_names, *.released, *.mobility))]
    OverDriven {
        /// Contradicting drivers: those that are held, then those that an equilibrium releases.
        drivers: Vec<DriverId>,
        /// Names, in the same order.
        driver_names: Vec<String>,
        /// Number of the last ones, which an equilibrium releases, and for which no motion is left.
        released: usize,
        /// Degrees of freedom that these drivers prescribe; other drivers may prescribe further ones.
        mobility: usize,
        /// Joints whose constraints fail.
        joints: Vec<JointId>,
        /// Names of the joints, each with the constraint that fails.
        joint_names: Vec<String>,
    },
    /// Immovable: the joints prevent any motion that a driver prescribes (HP0303).
    #[error("the mechanism is immovable: its joints prevent any motion ({})", dozen(.bodies))]
    Immovable {
        /// Joints whose constraints fail with any motion.
        joints: Vec<JointId>,
        /// Names of the joints, each with the constraint that fails.
        joint_names: Vec<String>,
        /// Names of the bodies in their loops.
        bodies: Vec<String>,
    },
    /// A joint that deflects in some of its directions only, and cannot be cut, would be cut (HP0306).
    #[error("{}", elastic_loop_text(.joint_name, .cut))]
    ElasticLoop {
        /// The joint.
        joint: JointId,
        /// Name of the joint.
        joint_name: String,
        /// Reason why it would be cut.
        cut: CutReason,
    },
}

fn over_driven_text(drivers: &[String], released: usize, mobility: usize) -> String {
    let (held, released) = drivers.split_at(drivers.len() - released);
    let prescribe = if held.len() == 1 { "driver prescribes" } else { "drivers prescribe" };
    let degrees = if mobility == 1 { "degree" } else { "degrees" };
    let left = match released.is_empty() {
        true => String::new(),
        false => format!(", which leaves none to the released {}", dozen(released)),
    };
    let held = held.len();
    format!("the mechanism is over-driven: {held} {prescribe} {mobility} {degrees} of freedom{left}")
}

fn under_driven_text(freedom: usize, bodies: &[String], unconnected: &[String]) -> String {
    let s = if freedom == 1 { "motion remains" } else { "motions remain" };
    let text = format!("the mechanism is under-driven: {freedom} {s} free ({})", dozen(bodies));
    match unconnected.len() == bodies.len() {
        true => text + ", as these bodies are not connected to ground",
        false => text,
    }
}

fn elastic_loop_text(joint: &str, cut: &CutReason) -> String {
    let why = match cut {
        CutReason::AlwaysCut | CutReason::ClosesLoop => "closes a loop of elastic joints",
        CutReason::Requested => "cannot be cut as requested",
        CutReason::Absolute => "cannot be cut, as absolute coordinates require",
    };
    format!("joint `{joint}` {why}: it is elastic in some of its directions only")
}

/// Joins names with commas. A longer list is cut after twelve names, with the number of the others.
fn dozen(names: &[String]) -> String {
    some_of(names, ", ", 12)
}

impl TopologyError {
    /// Returns the stable code, `HP03..`.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnderDriven { .. } => "HP0301",
            Self::OverDriven { .. } => "HP0302",
            Self::Immovable { .. } => "HP0303",
            Self::Singular { .. } => "HP0304",
            Self::ElasticLoop { .. } => "HP0306",
        }
    }

    /// The error without the openings of elastic joints, which are drivers from `first` on.
    pub(crate) fn without_openings(mut self, first: DriverId) -> Self {
        if let Self::OverDriven { drivers, driver_names, released, mobility, .. } = &mut self {
            let held = drivers.len() - *released;
            let own = drivers[..held].partition_point(|d| *d < first);
            drivers.drain(own..held);
            driver_names.drain(own..held);
            *mobility = mobility.saturating_sub(held - own);
        }
        self
    }

    /// Returns the notes: facts about the error.
    pub fn notes(&self) -> Vec<String> {
        match self {
            Self::UnderDriven { joint_names, unconnected, .. } => {
                let of = |what: &str, names: &[String]| {
                    (!names.is_empty()).then(|| format!("{what}: {}", dozen(names)))
                };
                let lists = [
                    of("bodies that are not connected to ground", unconnected),
                    of("joints that still move", joint_names),
                ];
                lists.into_iter().flatten().collect()
            }
            Self::Singular { freedom, joint_names, .. } => vec![
                format!(
                    "to first order {} there that {} not free nearby: a dead point or a change point",
                    if *freedom == 1 {
                        "a motion is free".into()
                    } else {
                        format!("{freedom} motions are free")
                    },
                    if *freedom == 1 { "is" } else { "are" }
                ),
                format!("joints of that motion: {}", dozen(joint_names)),
            ],
            Self::OverDriven { driver_names, joint_names, .. } => vec![
                format!("contradicting drivers: {}", dozen(driver_names)),
                format!("constraints that fail: {}", dozen(joint_names)),
            ],
            Self::Immovable { joint_names, .. } => {
                vec![format!("constraints that fail with any motion: {}", dozen(joint_names))]
            }
            Self::ElasticLoop { .. } => Vec::new(),
        }
    }

    /// Returns the help text: an instruction that corrects the error.
    pub fn help(&self) -> String {
        match self {
            Self::UnderDriven { unconnected, bodies, .. } if !unconnected.is_empty() => {
                let others = match unconnected.len() == bodies.len() {
                    true => "",
                    false => "; then see which motions of the others remain",
                };
                format!("connect {} to ground by a joint, or remove them{others}", dozen(unconnected))
            }
            Self::UnderDriven { freedom: 1, .. } => {
                "add a driver on one of these joints, or a joint or rod that prevents the motion".into()
            }
            Self::UnderDriven { freedom, .. } => {
                format!("add {freedom} drivers on these joints, or joints or rods that prevent the motions")
            }
            Self::Singular { .. } => "move the design configuration a little along its motion, away from the position in which its links line up; if the mechanism moves only because of its special proportions, add a driver on one of these joints"
                .into(),
            Self::OverDriven { driver_names, mobility, .. } => {
                let excess = match driver_names.len().saturating_sub(*mobility) {
                    0 | 1 => "one".into(),
                    n => n.to_string(),
                };
                format!("remove any {excess} of these drivers, or use a joint with more freedom")
            }
            Self::Immovable { .. } => {
                "make parallel axes exactly parallel, or use joints with more freedom (a spherical joint instead of \
                 a revolute joint, a cylindrical joint instead of a translational one)"
                    .into()
            }
            Self::ElasticLoop { joint_name, cut, .. } => {
                let in_all = format!("give `{joint_name}` stiffnesses in all its directions");
                match cut {
                    CutReason::AlwaysCut | CutReason::ClosesLoop => {
                        format!("{in_all}, or make another joint of the loop rigid")
                    }
                    CutReason::Requested => format!("remove `cut = true` from `{joint_name}`, or {in_all}"),
                    CutReason::Absolute => {
                        "solve the model in relative coordinates: leave out the option `--absolute`".into()
                    }
                }
            }
        }
    }

    /// Returns the joints of the error.
    pub fn joints(&self) -> &[JointId] {
        match self {
            Self::UnderDriven { joints, .. }
            | Self::Singular { joints, .. }
            | Self::OverDriven { joints, .. }
            | Self::Immovable { joints, .. } => joints,
            Self::ElasticLoop { joint, .. } => std::slice::from_ref(joint),
        }
    }
}

/// Returns the error of free motions, each given by its coordinates and their speeds. `nearby` of the motions are free
/// in other positions too.
pub(super) fn free_motions(
    model: &Model,
    topology: &Topology,
    free: &[SparseRow],
    nearby: usize,
) -> TopologyError {
    let moving = free.iter().flatten().filter(|(_, x)| x.abs() > 1e-6);
    let moving: Vec<&Link> = moving.map(|&(c, _)| &topology[topology[c].link]).collect();
    let mut joints: Vec<JointId> = moving.iter().filter_map(|link| link.joint).collect();
    let mut bodies: Vec<BodyId> = moving.iter().map(|link| link.child).collect();
    bodies.sort_unstable();
    bodies.dedup();
    joints.sort_unstable();
    joints.dedup();
    if topology.formulation == Formulation::Absolute {
        // Absolute coordinates belong to no joint: name the joints of the moving bodies.
        joints = (0..model.joints.len())
            .filter(|&j| model.joints[j].bodies.iter().any(|b| bodies.binary_search(b).is_ok()))
            .map(JointId)
            .collect();
    }
    let joint_names = joints.iter().map(|j| format!("`{}`", model.joints[j.0].name)).collect();
    let connected = connected_to_ground(model);
    let named = |b: &BodyId| format!("`{}`", model.bodies[b.0].name);
    let unconnected = bodies.iter().filter(|b| !connected[b.0]).map(named).collect();
    let bodies = bodies.iter().map(named).collect();
    if nearby < free.len() {
        return TopologyError::Singular { freedom: free.len() - nearby, joints, joint_names, bodies };
    }
    TopologyError::UnderDriven { freedom: free.len(), joints, joint_names, bodies, unconnected }
}

/// Per body: true if joints connect it to ground, directly or by other bodies.
fn connected_to_ground(model: &Model) -> Vec<bool> {
    let mut neighbours: Vec<Vec<BodyId>> = vec![Vec::new(); model.bodies.len()];
    for joint in &model.joints {
        let [i, j] = joint.bodies;
        neighbours[i.0].push(j);
        neighbours[j.0].push(i);
    }
    let mut connected = vec![false; model.bodies.len()];
    connected[GROUND.0] = true;
    let mut open = vec![GROUND];
    while let Some(body) = open.pop() {
        for &next in &neighbours[body.0] {
            if !std::mem::replace(&mut connected[next.0], true) {
                open.push(next);
            }
        }
    }
    connected
}

/// Returns the error of rows that fail under the drivers' motion, each with its failure per driver.
pub(super) fn contradiction(
    model: &Model,
    topology: &Topology,
    contradictions: &[(RowId, Vec<f64>)],
) -> TopologyError {
    let mut drivers: Vec<DriverId> = Vec::new();
    let mut joints = Vec::new();
    let mut joint_names: Vec<String> = Vec::new();
    let mut bodies: Vec<BodyId> = Vec::new();
    for (r, fails) in contradictions {
        let closure = topology.closure_of(*r);
        drivers.extend((0..fails.len()).filter(|&d| fails[d] != 0.0).map(DriverId));
        drivers.extend(closure.driver);
        joints.push(closure.joint);
        let around = |c: &Closure| c.links.iter().map(|k| topology[k.link].child).collect::<Vec<_>>();
        bodies.extend(around(closure));
        if let Some(block) = closure.block.map(|b| &topology[b]) {
            bodies.extend(block.closures.iter().flat_map(|&c| around(&topology[c])));
            bodies.extend(block.link_ids().map(|k| topology[k].child));
        }
        joint_names.push(topology.row_name(model, *r));
    }
    drivers.sort_unstable();
    drivers.dedup();
    joints.sort_unstable();
    joints.dedup();
    joint_names.dedup();
    bodies.sort_unstable();
    bodies.dedup();
    if topology.mobility == 0 {
        let bodies = bodies.iter().map(|b| format!("`{}`", model.bodies[b.0].name)).collect();
        return TopologyError::Immovable { joints, joint_names, bodies };
    }
    // Each independent contradiction is one driver too many, of those that contradict each other.
    let excess = model.drivers.len() - topology.mobility;
    let mobility = drivers.len().saturating_sub(excess);
    let is_released = |d: &DriverId| model.equilibrium.iter().any(|e| e.released.contains(d));
    let (last, mut drivers): (Vec<DriverId>, Vec<DriverId>) = drivers.into_iter().partition(is_released);
    let released = last.len();
    drivers.extend(last);
    let driver_names = drivers.iter().map(|d| format!("`{}`", model.drivers[d.0].name)).collect();
    TopologyError::OverDriven { drivers, driver_names, released, mobility, joints, joint_names }
}
