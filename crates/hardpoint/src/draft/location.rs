//! Locations, points and directions as written.

use crate::expression::Expression;
use crate::space::Vec3;

/// A named point.
#[derive(Clone, Debug)]
pub struct HardpointDraft {
    /// Name.
    pub name: String,
    /// Global position, m.
    pub position: Vec3,
}

/// Location: a named hardpoint, or coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum LocationDraft {
    /// A hardpoint's name.
    Hardpoint(String),
    /// Global coordinates in the design configuration, m.
    At(Vec3),
    /// Global coordinates defined by expressions.
    Formula(Box<[Expression; 3]>),
}

/// Direction of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum DirectionDraft {
    /// Along a global vector of any length.
    Along(Vec3),
    /// From one named hardpoint to another.
    Through(String, String),
}

/// Point of a body whose motion is computed.
#[derive(Clone, Debug)]
pub struct PointDraft {
    /// Name.
    pub name: String,
    /// Name of its body.
    pub body: String,
    /// Location in the design configuration.
    pub at: LocationDraft,
}

/// Reference to a point in a measure.
#[derive(Clone, Debug, PartialEq)]
pub enum PointRef {
    /// A point of the model, by name.
    Named(String),
    /// Location on a body.
    On {
        /// The body's name.
        body: String,
        /// Location.
        at: LocationDraft,
    },
}
