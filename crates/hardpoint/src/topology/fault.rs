//! What can be wrong with a mechanism as a whole, in the user's own names.

use super::*;
use crate::constraint::Row;

/// The mechanism cannot be driven as it is written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TopologyFault {
    /// Motions remain that no driver prescribes (HP0301).
    #[error("{}", under_driven_text(.freedom, .bodies))]
    UnderDriven {
        /// How many motions remain free.
        freedom: usize,
        /// The joints that move in them.
        joints: Vec<JointId>,
        /// Their names.
        joint_names: Vec<String>,
        /// Names of the bodies that move in them.
        bodies: Vec<String>,
    },
    /// Drivers prescribe more than can move, or contradict the joints (HP0302).
    #[error("the mechanism is over-driven: its joints and drivers contradict each other")]
    OverDriven {
        /// The drivers that meet the contradiction.
        drivers: Vec<DriverId>,
        /// Their names.
        driver_names: Vec<String>,
        /// The joints whose constraints fail.
        joints: Vec<JointId>,
        /// Their names, with the constraint that fails.
        joint_names: Vec<String>,
        /// By how many the constraints and drivers exceed what can move.
        excess: usize,
    },
}

fn under_driven_text(freedom: &usize, bodies: &[String]) -> String {
    let s = if *freedom == 1 { "motion remains" } else { "motions remain" };
    format!("the mechanism is under-driven: {freedom} {s} free ({})", some_of(bodies))
}

/// The names with commas between; of a long list the first dozen, and how many more there are.
fn some_of(names: &[String]) -> String {
    const SHOWN: usize = 12;
    let shown = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

impl TopologyFault {
    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnderDriven { .. } => "HP0301",
            Self::OverDriven { .. } => "HP0302",
        }
    }

    /// Facts.
    pub fn notes(&self) -> Vec<String> {
        match self {
            Self::UnderDriven { joint_names, .. } => {
                vec![format!("the joints that still move: {}", some_of(joint_names))]
            }
            Self::OverDriven { driver_names, joint_names, excess, .. } => {
                let mut notes = vec![format!("constraints that cannot follow: {}", some_of(joint_names))];
                if !driver_names.is_empty() {
                    notes.push(format!("drivers that meet there: {}", some_of(driver_names)));
                }
                notes.push(format!("{excess} more is prescribed than can move"));
                notes
            }
        }
    }

    /// What to do.
    pub fn help(&self) -> String {
        match self {
            Self::UnderDriven { freedom: 1, .. } => {
                "add a driver on one of these joints, or a joint or rod that holds the motion".into()
            }
            Self::UnderDriven { freedom, .. } => {
                format!("add {freedom} drivers on these joints, or joints or rods that hold the motions")
            }
            Self::OverDriven { driver_names, .. } if driver_names.len() > 1 => {
                "remove any one of these drivers, or free a joint".into()
            }
            Self::OverDriven { .. } => {
                "remove the driver, or use joints with more freedom (a universal or spherical joint in place of a \
                 revolute, a cylindrical joint in place of a slide)"
                    .into()
            }
        }
    }

    /// The joints that it is about.
    pub fn joints(&self) -> &[JointId] {
        match self {
            Self::UnderDriven { joints, .. } | Self::OverDriven { joints, .. } => joints,
        }
    }
}

/// The fault of motions left free, each given as a speed per coordinate.
pub(super) fn under_driven(model: &Model, topology: &Topology, free: &[Vec<f64>]) -> TopologyFault {
    let moving: Vec<usize> = (0..topology.coordinates.len())
        .filter(|&c| free.iter().any(|v| v[c].abs() > 1e-6))
        .map(|c| topology.coordinates[c].link)
        .collect();
    let mut joints: Vec<JointId> = moving.iter().filter_map(|&k| topology.links[k].joint).collect();
    let mut bodies: Vec<BodyId> = moving.iter().map(|&k| topology.links[k].child).collect();
    bodies.sort_unstable();
    bodies.dedup();
    joints.sort_unstable();
    joints.dedup();
    if topology.formulation == Formulation::Absolute {
        // No joint carries a coordinate there: name those of the moving bodies.
        joints = (0..model.joints.len())
            .filter(|&j| model.joints[j].bodies.iter().any(|b| bodies.contains(b)))
            .map(JointId)
            .collect();
    }
    TopologyFault::UnderDriven {
        freedom: free.len(),
        joint_names: joints.iter().map(|j| format!("`{}`", model.joints[j.0].name)).collect(),
        joints,
        bodies: bodies.iter().map(|b| format!("`{}`", model.bodies[b.0].name)).collect(),
    }
}

/// The fault of rows that fail under the drivers' motion.
pub(super) fn over_driven(
    model: &Model,
    topology: &Topology,
    contradictions: &[(usize, Vec<DriverId>)],
) -> TopologyFault {
    let mut drivers: Vec<DriverId> = contradictions.iter().flat_map(|(_, d)| d.clone()).collect();
    let mut joints = Vec::new();
    let mut joint_names: Vec<String> = Vec::new();
    for (r, _) in contradictions {
        let place = topology.rows[*r];
        let closure = &topology.closures[place.closure];
        drivers.extend(closure.driver);
        joints.push(closure.joint);
        let row: Row = closure.rows[place.index];
        joint_names.push(match closure.driver {
            Some(d) => format!("driver `{}` ({})", model.drivers[d.0].name, row.describe()),
            None => format!("`{}` ({})", model.joints[closure.joint.0].name, row.describe()),
        });
    }
    drivers.sort_unstable();
    drivers.dedup();
    joints.sort_unstable();
    joints.dedup();
    joint_names.dedup();
    TopologyFault::OverDriven {
        driver_names: drivers.iter().map(|d| format!("`{}`", model.drivers[d.0].name)).collect(),
        drivers,
        joints,
        joint_names,
        excess: contradictions.len(),
    }
}
