//! Errors of a mechanism as a whole, in the user's names.

use crate::draft::some_of;
use crate::model::{BodyId, DriverId, JointId, Model};

use super::blocks::SparseRow;
use super::{Closure, Formulation, Link, RowId, Topology};

/// The mechanism cannot be driven as it is written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TopologyError {
    /// Motions remain that no driver prescribes (HP0301).
    #[error("{}", under_driven_text(.freedom, .bodies))]
    UnderDriven {
        /// Number of remaining free motions.
        freedom: usize,
        /// The joints that move in them.
        joints: Vec<JointId>,
        /// Their names.
        joint_names: Vec<String>,
        /// Names of the bodies that move in them.
        bodies: Vec<String>,
    },
    /// The configuration in the design configuration is singular: motions are free there that are not free nearby
    /// (HP0304).
    #[error("the mechanism is singular in the design configuration ({})", dozen(.bodies))]
    Singular {
        /// Number of motions that are free in that position only.
        freedom: usize,
        /// The joints that move in them.
        joints: Vec<JointId>,
        /// Their names.
        joint_names: Vec<String>,
        /// Names of the bodies that move in them.
        bodies: Vec<String>,
    },
    /// Drivers prescribe more than can move (HP0302).
    #[error(
        "the mechanism is over-driven: {} prescribe {}",
        counted(.driver_names.len(), "driver"),
        counted(*.mobility, "degree of freedom").replace("degree of freedoms", "degrees of freedom")
    )]
    OverDriven {
        /// The drivers that contradict each other.
        drivers: Vec<DriverId>,
        /// Their names.
        driver_names: Vec<String>,
        /// Degrees of freedom without drivers.
        mobility: usize,
        /// The joints whose constraints fail.
        joints: Vec<JointId>,
        /// Their names, with the constraint that fails.
        joint_names: Vec<String>,
    },
    /// The joints hold each other: nothing that a driver moves can move (HP0303).
    #[error("the mechanism is immovable: its joints prevent any motion ({})", dozen(.bodies))]
    Immovable {
        /// The joints whose constraints fail as soon as something moves.
        joints: Vec<JointId>,
        /// Their names, with the constraint that fails.
        joint_names: Vec<String>,
        /// Names of the bodies in their loops.
        bodies: Vec<String>,
    },
}

/// `1 driver`, `2 drivers`.
fn counted(n: usize, one: &str) -> String {
    format!("{n} {one}{}", if n == 1 { "" } else { "s" })
}

fn under_driven_text(freedom: &usize, bodies: &[String]) -> String {
    let s = if *freedom == 1 { "motion remains" } else { "motions remain" };
    format!("the mechanism is under-driven: {freedom} {s} free ({})", dozen(bodies))
}

/// The names with commas between; of a long list the first dozen, and how many more there are.
fn dozen(names: &[String]) -> String {
    some_of(names, ", ", 12)
}

impl TopologyError {
    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnderDriven { .. } => "HP0301",
            Self::OverDriven { .. } => "HP0302",
            Self::Immovable { .. } => "HP0303",
            Self::Singular { .. } => "HP0304",
        }
    }

    /// Facts.
    pub fn notes(&self) -> Vec<String> {
        match self {
            Self::UnderDriven { joint_names, .. } => {
                vec![format!("joints that still move: {}", dozen(joint_names))]
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
        }
    }

    /// Instruction that corrects the error.
    pub fn help(&self) -> String {
        match self {
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
        }
    }

    /// The joints that it is about.
    pub fn joints(&self) -> &[JointId] {
        match self {
            Self::UnderDriven { joints, .. }
            | Self::Singular { joints, .. }
            | Self::OverDriven { joints, .. }
            | Self::Immovable { joints, .. } => joints,
        }
    }
}

/// The fault of motions left free, each given as the coordinates that move in it; `nearby` of them are free in other
/// positions too.
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
        // No joint carries a coordinate there: name those of the moving bodies.
        joints = (0..model.joints.len())
            .filter(|&j| model.joints[j].bodies.iter().any(|b| bodies.binary_search(b).is_ok()))
            .map(JointId)
            .collect();
    }
    let joint_names = joints.iter().map(|j| format!("`{}`", model.joints[j.0].name)).collect();
    let bodies = bodies.iter().map(|b| format!("`{}`", model.bodies[b.0].name)).collect();
    if nearby < free.len() {
        return TopologyError::Singular { freedom: free.len() - nearby, joints, joint_names, bodies };
    }
    TopologyError::UnderDriven { freedom: free.len(), joints, joint_names, bodies }
}

/// The fault of rows that fail under the drivers' motion, each with its failure per driver.
pub(super) fn contradicted(
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
    TopologyError::OverDriven {
        driver_names: drivers.iter().map(|d| format!("`{}`", model.drivers[d.0].name)).collect(),
        drivers,
        mobility: topology.mobility,
        joints,
        joint_names,
    }
}
