//! Gaps of a design configuration whose joints are open, and the assembly that closed them.

use crate::joint::Quantity;
use crate::model::{BodyId, DriverId, JointId, Model};

/// A design configuration is singular if its path ends before this fraction of the gaps is closed. A path that ends
/// later ends at a limit of the mechanism; starting from nearby positions does not help then.
pub(super) const SINGULAR_DRAWING: f64 = 0.05;

/// Assembly of a mechanism that was open in the design configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    /// Open constraints of the design configuration, largest gaps first.
    pub gaps: Vec<Gap>,
    /// Bodies that moved, with their displacements.
    pub moved: Vec<AssemblyShift>,
    /// Number of assemblies found around the design configuration if the path from it leads to none; the nearest was
    /// chosen. 0 if the path closed the mechanism.
    pub found_nearby: usize,
    /// Number of those that are as near as the chosen one, itself included, such as the two mirror images of bars drawn
    /// in line: the design configuration does not decide between them.
    pub equally_near: usize,
}

/// Gap of an open constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Open constraint.
    pub of: Closing,
    /// Size, m or as a cosine.
    pub size: f64,
    /// Quantity of the gap.
    pub quantity: Quantity,
}

/// A constraint that closes a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// A joint.
    Joint(JointId),
    /// A driver across a cut joint.
    Driver(DriverId),
    /// A coupler, by its index in the model.
    Coupler(usize),
}

/// Displacement of a body by the assembly, relative to the design configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyShift {
    /// The body.
    pub body: BodyId,
    /// Displacement of the origin of its frame, m.
    pub distance: f64,
    /// Angle of its rotation, rad.
    pub angle: f64,
}

impl Closing {
    /// Kind and name, for messages.
    pub fn name(self, model: &Model) -> String {
        match self {
            Self::Joint(j) => format!("joint `{}`", model.joints[j.0].name),
            Self::Driver(d) => format!("driver `{}`", model.drivers[d.0].name),
            Self::Coupler(c) => format!("coupler `{}`", model.couplers[c].name),
        }
    }
}
