//! Drivers, and the equilibrium of released ones, as written.

use crate::joint::{self, JointType, Quantity};
use crate::law::Law;
use crate::model::{Dimension, WheelMeasure};

use super::measure::not_drivable;
use super::{DirectionDraft, MeasureDraft, MeasureKindDraft, PointRef};

/// A driver.
#[derive(Clone, Debug)]
pub struct DriverDraft {
    /// Name.
    pub name: String,
    /// Quantity that the driver prescribes.
    pub drives: DrivenDraft,
    /// True if the laws give the absolute value, as for measures; false if they count from the design configuration.
    pub from_zero: bool,
    /// True if the driver moves in the opposite sense of its laws.
    pub reversed: bool,
    /// Law of the prescribed quantity, m or rad.
    pub law: Law,
    /// Symbol of the unit in which laws of this driver are written, for messages; empty for a plain number.
    pub unit: &'static str,
}

/// Quantity that a driver prescribes.
#[derive(Clone, Debug)]
pub enum DrivenDraft {
    /// Entry that could not be read.
    Unread,
    /// Coordinate of a joint.
    Coordinate {
        /// The joint's name.
        joint: String,
        /// Name of the coordinate; optional if the joint has only one.
        coordinate: Option<String>,
    },
    /// Displacement of a point along a global direction, m.
    Position {
        /// The point.
        point: PointRef,
        /// The direction, of any length.
        along: DirectionDraft,
    },
    /// Change of the distance between two points, m.
    Distance {
        /// First point.
        from: PointRef,
        /// Second point.
        to: PointRef,
    },
    /// Rotation angle of a body about a direction fixed in another body, rad.
    Orientation {
        /// The body's name.
        body: String,
        /// Name of the body in which the direction is fixed; ground if `None`.
        relative_to: Option<String>,
        /// The direction.
        about: DirectionDraft,
        /// Direction of the body whose angle, as seen along `about`, is prescribed; its part perpendicular to `about`
        /// counts. If `None`, one that depends on `about` alone.
        axis2: Option<DirectionDraft>,
    },
    /// Value of a measure, such as wheel travel or a steer angle.
    Measure(String),
    /// Height of the contact point of a wheel, by its name.
    Contact(String),
}

impl DrivenDraft {
    /// Quantity of the driver's values, if it is known; `type_of` returns the type of a joint.
    pub fn quantity(
        &self,
        measures: &[MeasureDraft],
        type_of: impl FnOnce(&str) -> Option<&'static JointType>,
    ) -> Option<Quantity> {
        match self {
            Self::Unread => None,
            Self::Coordinate { joint, coordinate } => type_of(joint)?.quantity_of(coordinate.as_deref()),
            Self::Position { .. } => joint::TRAVEL.quantity_of(None),
            Self::Distance { .. } => joint::LEG.quantity_of(None),
            Self::Orientation { .. } => joint::HEADING.quantity_of(None),
            Self::Contact(_) => Some(Quantity::Length),
            Self::Measure(name) => match measures.iter().find(|m| m.name == *name).map(|m| &m.kind) {
                // Measures listed by a wheel, such as `WHEEL.toe`, may be added after the drivers. Their names imply
                // the quantity.
                None => quantity_at_wheel(WheelMeasure::named(name.rsplit_once('.')?.1)?),
                Some(MeasureKindDraft::Coordinate { joint, coordinate }) => {
                    type_of(joint)?.quantity_of(coordinate.as_deref())
                }
                Some(MeasureKindDraft::Distance { .. } | MeasureKindDraft::Coordinates { .. }) => {
                    Some(Quantity::Length)
                }
                Some(MeasureKindDraft::Angle { .. } | MeasureKindDraft::Toe { .. }) => Some(Quantity::Angle),
                Some(MeasureKindDraft::Wheel { what, .. }) => quantity_at_wheel(*what),
                Some(MeasureKindDraft::Unread | not_drivable!()) => None,
            },
        }
    }
}

/// Quantity of a wheel measure, if a driver can prescribe it.
fn quantity_at_wheel(what: WheelMeasure) -> Option<Quantity> {
    match what.dimension() {
        Dimension::LENGTH => Some(Quantity::Length),
        Dimension::ANGLE => Some(Quantity::Angle),
        _ => None,
    }
}

/// Equilibrium as written.
#[derive(Clone, Debug, Default)]
pub struct EquilibriumDraft {
    /// Names of the drivers that are released.
    pub released: Vec<String>,
}
