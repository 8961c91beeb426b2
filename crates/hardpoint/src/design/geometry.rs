//! Geometry of a design: all body-fixed data.
//!
//! | here | theory | paper | |
//! |---|---|---|---|
//! | `markers[j][e]`: `r`, `rot` | M_i, M_j = (s, C) | s (3.1), C (2.2) | marker in its body: position, m, and axes |
//! | `kept[j]` | L, d0, c0, r0 | C of (4.10), squared there | constants of its rows |
//! | `points[k]` | | `s_o` of any point of the body | m, in its body's frame |
//! | `spin_axes[w]` | e' | | unit vector, in the frame of the wheel's body |
//! | `axes[e]` | C | C (2.2) | axes of a bushing, in the frames of its bodies |

use crate::constraint::Row;
use crate::joint::Need;
use crate::model::{Joint, JointId, Model};
use crate::number::{self, Real};
use crate::space::{Mat3, Pose, Vec3};

/// Body-fixed data of one design: all that the analysis uses besides the drivers' laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry<T = f64> {
    /// Per joint: marker i in body i and marker j in body j.
    pub markers: Vec<[Pose<T>; 2]>,
    /// Per joint: constants of its constraints in the design configuration.
    pub kept: Vec<JointConstants<T>>,
    /// Per point of the model: position in its body's frame, m.
    pub points: Vec<Vec3<T>>,
    /// Per wheel of the model: spin axis in its body's frame, a unit vector.
    pub spin_axes: Vec<Vec3<T>>,
    /// Per mass and force of the model: its axes, if it has any of its own, in the frames of the bodies i and j.
    pub axes: Vec<Option<[Mat3<T>; 2]>>,
    /// Per number of the model's masses and forces: value, SI.
    pub numbers: Vec<T>,
    /// [`Model::size`](crate::model::Model::size), m: reference length at every step, computed once.
    pub size: f64,
}

impl<T: Real> Geometry<T> {
    /// Markers between which an elastic joint opens: those of the joint, but marker j has the axes of marker i in the
    /// design configuration also if the joint's second axis is on body j.
    pub(crate) fn elastic_markers(&self, model: &Model, joint: JointId) -> [Pose<T>; 2] {
        elastic_markers(model, joint, self.markers[joint.0])
    }
}

/// Markers between which an elastic joint with these markers opens.
pub(super) fn elastic_markers<T: Real>(
    model: &Model,
    joint: JointId,
    [m_i, m_j]: [Pose<T>; 2],
) -> [Pose<T>; 2] {
    let Joint { kind, bodies, .. } = &model.joints[joint.0];
    let rot = match kind.axis2 {
        // A_j^T A_i C_i in the design configuration
        Need::OnBodyJ => {
            let [frame_i, frame_j] = number::both(*bodies, |b| model.bodies[b.0].frame.rot);
            (frame_j.transpose() * frame_i).spread() * m_i.rot
        }
        Need::Required | Need::Optional | Need::Orienting | Need::Unused => m_j.rot,
    };
    [m_i, Pose { rot, r: m_j.r }]
}

/// Body-fixed data that measures use.
#[derive(Clone, Debug)]
pub(crate) struct BodyFixed<T> {
    /// Per point of the model: position in its body's frame, m.
    pub points: Vec<Vec3<T>>,
    /// Per measure: directions that it depends on, unit vectors in their bodies' frames.
    pub directions: Vec<[Option<Vec3<T>>; 2]>,
    /// Per measure of a joint's coordinate or of a deflection: marker i in body i and marker j in body j.
    pub markers: Vec<Option<[Pose<T>; 2]>>,
    /// Per shape of the model: the numbers that no point gives.
    pub shapes: Vec<ShapeGeometry<T>>,
    /// Size of the mechanism, m, as in [`Geometry`].
    pub size: f64,
}

/// The numbers of a shape that no point gives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeGeometry<T> {
    /// The axis or normal, a unit vector in the frame of its body, if it has one that points do not give.
    pub axis: Option<Vec3<T>>,
    /// Radius of a ring or cylinder, width of a tyre, m; otherwise 0.
    pub size: T,
    /// Radius around the core, m.
    pub round: T,
}

impl<T: Copy> ShapeGeometry<T> {
    /// Applies a function to every number.
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U + Copy) -> ShapeGeometry<U> {
        ShapeGeometry { axis: self.axis.map(|a| a.map(f)), size: f(self.size), round: f(self.round) }
    }
}

impl<T: Copy> BodyFixed<T> {
    /// Applies a function to every number.
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U + Copy) -> BodyFixed<U> {
        let pose =
            |p: Pose<T>| Pose { rot: Mat3 { cols: number::each(&p.rot.cols, |c| c.map(f)) }, r: p.r.map(f) };
        BodyFixed {
            points: self.points.iter().map(|p| p.map(f)).collect(),
            directions: self.directions.iter().map(|d| number::both(*d, |d| d.map(|d| d.map(f)))).collect(),
            markers: self.markers.iter().map(|m| m.map(|m| number::both(m, pose))).collect(),
            shapes: self.shapes.iter().map(|s| s.map(f)).collect(),
            size: self.size,
        }
    }
}

/// Constants of a joint, defined by the design configuration, or their rates of change by a design variable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointConstants<T = f64> {
    /// Distance between the markers, m: the length of a rod.
    pub distance: T,
    /// Displacement of marker j along z_i, m.
    pub offset: T,
    /// Cosine of the angle between z_i and z_j.
    pub cosine: T,
    /// Angle of z_j about z_i, seen along z_i, rad.
    pub course: T,
    /// Distance of marker j from the curve of marker i, positive on its left, m.
    pub contact: T,
    /// Height of the lowest point of a wheel above marker i, m.
    pub height: T,
}

impl<T: Real> JointConstants<T> {
    /// Returns the constant of a row; 0 for rows without one.
    pub fn by(&self, row: Row) -> T {
        match row {
            Row::Distance => self.distance,
            Row::Offset => self.offset,
            Row::Cosine => self.cosine,
            Row::Course => self.course,
            Row::Contact => self.contact,
            Row::LowestPoint(_) => self.height,
            _ => T::zero(),
        }
    }

    pub(super) fn map<U>(self, f: impl Fn(T) -> U) -> JointConstants<U> {
        JointConstants {
            distance: f(self.distance),
            offset: f(self.offset),
            cosine: f(self.cosine),
            course: f(self.course),
            contact: f(self.contact),
            height: f(self.height),
        }
    }

    pub(super) fn vanishes(self) -> bool {
        self.numbers().into_iter().all(T::vanishes)
    }

    /// Returns all constants.
    pub(crate) fn numbers(&self) -> [T; 6] {
        [self.distance, self.offset, self.cosine, self.contact, self.course, self.height]
    }

    /// Returns the largest magnitude of the constants.
    pub(crate) fn size(&self) -> T {
        self.numbers().into_iter().map(T::abs).fold(T::zero(), T::larger)
    }
}
