//! Wheels and axles as written.

use crate::model::{Side, TorqueReaction, VehicleEnd};

use super::{DirectionDraft, LocationDraft, PointRef};

/// A road wheel; see [`Wheel`](crate::model::Wheel).
#[derive(Clone, Debug)]
pub struct WheelDraft {
    /// Name.
    pub name: String,
    /// Name of the body that carries the wheel.
    pub body: String,
    /// Centre in the design configuration.
    pub centre: LocationDraft,
    /// Orientation in the design configuration.
    pub spin: WheelSpinDraft,
    /// Distance from the centre to the ground in the wheel plane, m.
    pub radius: f64,
    /// Side of the vehicle; if `None`, the side of the centre.
    pub side: Option<Side>,
    /// Lower and upper point of the kingpin axis.
    pub kingpin: Option<[PointRef; 2]>,
    /// Name of the driver that moves the wheel up and down; optional if there is only one driver.
    pub bump: Option<String>,
    /// Name of the driver that steers the wheel.
    pub steer: Option<String>,
    /// Planes of the lower and the upper arm: each through two pivots and a ball joint, or through a strut's top mount
    /// and perpendicular to its axis.
    pub planes: Option<[Vec<PointRef>; 2]>,
    /// Ends of its spring.
    pub spring: Option<[PointRef; 2]>,
    /// End of the vehicle.
    pub end: Option<VehicleEnd>,
    /// Reaction of the drive torque. If `None`: outboard on a body that carries wheels of both sides (a live axle),
    /// otherwise inboard.
    pub drive: Option<TorqueReaction>,
    /// Reaction of the brake torque; outboard if `None`.
    pub brakes: Option<TorqueReaction>,
}

/// Two wheels side by side; see [`Axle`](crate::model::Axle).
#[derive(Clone, Debug)]
pub struct AxleDraft {
    /// Name.
    pub name: String,
    /// The name of the left wheel.
    pub left: String,
    /// The name of the right wheel.
    pub right: String,
}

/// Orientation of a wheel in the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum WheelSpinDraft {
    /// Spin axis, pointing outboard.
    Axis(DirectionDraft),
    /// Alignment angles, rad.
    Angles {
        /// Positive for toe-in.
        toe: f64,
        /// Positive if the top leans outboard.
        camber: f64,
    },
}
