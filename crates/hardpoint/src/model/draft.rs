//! What somebody wrote, before it is checked: names for references, SI units and radians.

use crate::law::Law;
use crate::space::{Pose, Vec3};

use super::End;

/// A mechanism as written. Fill it by hand or from a file; [`super::Model::from_draft`] checks it.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// The mechanism's name.
    pub name: String,
    /// Named points of the design configuration.
    pub hardpoints: Vec<HardpointDraft>,
    /// Bodies other than `ground`, which is always there.
    pub bodies: Vec<BodyDraft>,
    /// Joints.
    pub joints: Vec<JointDraft>,
    /// Drivers.
    pub drivers: Vec<DriverDraft>,
    /// Design variables.
    pub design: Vec<VariableDraft>,
    /// Points to follow.
    pub points: Vec<PointDraft>,
    /// Measures.
    pub measures: Vec<MeasureDraft>,
    /// Output times, s.
    pub times: Vec<f64>,
}

/// A named point.
#[derive(Clone, Debug)]
pub struct HardpointDraft {
    /// Its name.
    pub name: String,
    /// Global position, m.
    pub position: Vec3,
}

/// Where something is: at a named hardpoint, or at coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A hardpoint's name.
    Hardpoint(String),
    /// Global coordinates in the design configuration, m.
    At(Vec3),
}

/// Where an axis points.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// Along a global vector of any length.
    Along(Vec3),
    /// From one named hardpoint to another.
    Through(String, String),
}

/// A body.
#[derive(Clone, Debug)]
pub struct BodyDraft {
    /// Its name.
    pub name: String,
    /// Its reference frame.
    pub frame: FrameDraft,
}

/// How a body's reference frame is given.
#[derive(Clone, Debug, Default)]
pub enum FrameDraft {
    /// Origin at the mean of the body's joint hardpoints, axes parallel to the global ones.
    #[default]
    Default,
    /// Position and orientation.
    Pose(Pose),
    /// Origin, a point on the x axis, and a point in the xy plane on the side of +y.
    Points(Place, Place, Place),
}

/// A joint.
#[derive(Clone, Debug)]
pub struct JointDraft {
    /// Its name.
    pub name: String,
    /// The name of its type.
    pub kind: String,
    /// Names of bodies i and j.
    pub bodies: [String; 2],
    /// Its place, or its two places for a rod or leg. May be empty where the axis passes through
    /// hardpoints: then it is the first of them.
    pub at: Vec<Place>,
    /// Direction of the markers' z axis.
    pub axis: Option<Line>,
    /// Direction of the markers' x axis.
    pub axis2: Option<Line>,
    /// Whether it should be cut rather than carry the tree.
    pub cut: bool,
}

/// A driver.
#[derive(Clone, Debug)]
pub struct DriverDraft {
    /// Its name.
    pub name: String,
    /// The joint's name.
    pub joint: String,
    /// The coordinate's name; may be left out where the joint has only one.
    pub coordinate: Option<String>,
    /// The coordinate over time, m or rad.
    pub law: Law,
}

/// A design variable.
#[derive(Clone, Debug)]
pub struct VariableDraft {
    /// Its name.
    pub name: String,
    /// What changes with it.
    pub changes: Vec<ChangeDraft>,
    /// Whether rods keep their lengths.
    pub fixed_length: bool,
}

/// A part of a design variable; see [`super::Change`].
#[derive(Clone, Debug)]
pub enum ChangeDraft {
    /// A hardpoint moves.
    Move {
        /// The hardpoint's name.
        hardpoint: String,
        /// Global velocity per unit of the variable.
        velocity: Vec3,
    },
    /// Both markers of a joint turn about a line through their places.
    Tilt {
        /// The joint's name.
        joint: String,
        /// The line to turn about, by one radian per radian of the variable.
        about: Line,
    },
    /// Markers of a joint move and turn.
    Marker {
        /// The joint's name.
        joint: String,
        /// Which markers.
        end: End,
        /// Global velocity per unit.
        position: Vec3,
        /// Global rotation vector rate per unit.
        rotation: Vec3,
    },
    /// The paper's V and U of the marker on one body.
    Field {
        /// The joint's name.
        joint: String,
        /// The name of the body whose marker it is.
        body: String,
        /// V, in the body's frame.
        v: Vec3,
        /// U, 3-1-3 Euler angle rates.
        u: Vec3,
    },
}

/// A point to follow.
#[derive(Clone, Debug)]
pub struct PointDraft {
    /// Its name.
    pub name: String,
    /// The name of the body that carries it.
    pub body: String,
    /// Where it is in the design configuration.
    pub at: Place,
}

/// A point as a measure names it.
#[derive(Clone, Debug, PartialEq)]
pub enum PointRef {
    /// A point of the model, by name.
    Named(String),
    /// A place on a body.
    On {
        /// The body's name.
        body: String,
        /// The place.
        at: Place,
    },
}

/// A measure.
#[derive(Clone, Debug)]
pub struct MeasureDraft {
    /// Its name.
    pub name: String,
    /// What it measures.
    pub kind: MeasureKindDraft,
}

/// What a measure measures; see [`super::MeasureKind`].
#[derive(Clone, Debug)]
pub enum MeasureKindDraft {
    /// A joint's coordinate.
    Coordinate {
        /// The joint's name.
        joint: String,
        /// The coordinate's name; may be left out where the joint has only one.
        coordinate: Option<String>,
    },
    /// Distance between two points.
    Distance {
        /// From this point.
        from: PointRef,
        /// To this one.
        to: PointRef,
    },
    /// Position of a point along a global direction.
    Coordinates {
        /// The point.
        point: PointRef,
        /// The direction, of any length.
        along: Vec3,
    },
    /// Toe of a left wheel.
    Toe {
        /// The body's name.
        body: String,
        /// Spin axis, outboard.
        spin_axis: Line,
    },
    /// Camber of a left wheel.
    Camber {
        /// The body's name.
        body: String,
        /// Spin axis, outboard.
        spin_axis: Line,
    },
}
