//! The joint types: one file each, all of the same shape.
//!
//! A joint is data. As a *tree* joint it is a chain of [`Freedom`]s that places body j relative to body i; as a *cut*
//! joint it is a list of elementary constraints ([`Row`]) between its two markers. The engine knows freedoms and rows,
//! not joints: a new joint is one file, named here.
//!
//! # Frames, signs and units
//!
//! A joint connects body i, the first of its `bodies`, with body j, the second. It has a marker on each: an origin P
//! and right-handed axes x, y, z fixed in the body. In the design configuration both origins are at the joint's
//! hardpoint (or each at its own, for joints with two), z points along `axis`, and x along `axis2` if the type has one.
//! Where only z matters, x is any perpendicular direction, the same for both markers.
//!
//! ```text
//!          z_i   z_j                       d = P_j - P_i, from marker i to marker j
//!           |   /
//!           |  /    angle of j relative to i: about z_i, positive by the right-hand rule,
//!     i ----P_i        from x_i to x_j, counted in whole turns along the motion
//!            \ d
//!             P_j ---- j    displacement of j relative to i: d . z_i, positive along z_i
//! ```
//!
//! Angles are in rad and displacements in m. All coordinates are zero in the design configuration, except for lengths,
//! which are whole distances. Reactions are the force and the moment that the joint applies to body j.

mod angle;
mod constant_velocity;
mod course;
mod cylindrical;
mod distance;
mod dot1;
mod dot2;
mod fixed;
mod heading;
mod inline;
mod inplane;
mod leg;
mod orientation;
mod parallel;
mod pin_in_slot;
mod planar;
mod point_on_curve;
mod revolute;
mod revolute_spherical;
mod screw;
mod spherical;
mod translational;
mod travel;
mod universal;

use crate::constraint::Row;
pub(crate) use course::COURSE;

/// Exports and lists the types.
macro_rules! joints {
    ($($file:ident $TYPE:ident)*) => {
        $(pub use $file::$TYPE;)*

        /// Every joint type that a model may use.
        pub const ALL: &[&JointType] = &[$(&$TYPE),*];
    };
}

joints! {
    fixed FIXED
    revolute REVOLUTE
    translational TRANSLATIONAL
    cylindrical CYLINDRICAL
    spherical SPHERICAL
    universal UNIVERSAL
    constant_velocity CONSTANT_VELOCITY
    planar PLANAR
    pin_in_slot PIN_IN_SLOT
    screw SCREW
    inline INLINE
    inplane INPLANE
    orientation ORIENTATION
    parallel PARALLEL
    dot1 DOT1
    dot2 DOT2
    angle ANGLE
    distance DISTANCE
    revolute_spherical REVOLUTE_SPHERICAL
    point_on_curve POINT_ON_CURVE
    leg LEG
    travel TRAVEL
    heading HEADING
}

/// A joint type: its geometry, its freedoms as a tree joint, its constraints as a cut joint.
///
/// Both markers have their z axis along the joint's `axis` and their x axis along `axis2` (or any
/// direction perpendicular to `axis`, the same for both), and coincide in orientation at the design
/// configuration; only where `axis2` is [`Need::OnBodyJ`] is it the z axis of marker j.
#[derive(Debug)]
pub struct JointType {
    /// The name in model files.
    pub name: &'static str,
    /// Other names by which people know it.
    pub aliases: &'static [&'static str],
    /// One line for documentation and editors.
    pub summary: &'static str,
    /// Number of hardpoints of the joint: 1 shared by both bodies, 2, one on each, or 0 if only directions matter.
    pub places: usize,
    /// True if it needs an axis.
    pub axis: Need,
    /// True if it needs a second axis, perpendicular to the first.
    pub axis2: Need,
    /// Rules by which a mirror makes the images of `axis` and of `axis2`.
    pub vector_kinds: [VectorKind; 2],
    /// True if `axis` is perpendicular to the plane of a planar model unless the file gives it.
    pub normal_in_plane: bool,
    /// Motions of body j relative to body i, in order from i to j; `None` if it is always cut.
    pub freedoms: Option<&'static [Freedom]>,
    /// Elementary constraints that its freedoms in the tree do not keep by themselves.
    pub tree_rows: &'static [Row],
    /// Elementary constraints where it is cut (paper, section 4).
    pub rows: &'static [Row],
    /// The coordinates that a driver or a measure may name.
    pub coordinates: &'static [CoordinateType],
}

/// True if a piece of geometry belongs to a joint type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Must be given; a second axis perpendicular to the first.
    Required,
    /// May be given.
    Optional,
    /// Must be given, and belongs to body j, at any angle to the axis of body i.
    OnBodyJ,
    /// Has no meaning for this joint.
    Unused,
}

/// Rule by which a mirror makes the image of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorKind {
    /// As of an arrow: a direction to move along.
    Polar,
    /// As of a turn: a direction to turn about, or the normal of a plane. It is the opposite of the image of an arrow.
    Axial,
}

impl VectorKind {
    /// The sign of a direction of this kind relative to the image of an arrow.
    const fn sign(self) -> i8 {
        match self {
            Self::Polar => 1,
            Self::Axial => -1,
        }
    }
}

/// The part of its joint's axes in a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateAxis {
    /// A displacement along axis 0, 1 or 2 of a marker (x, y, z).
    Along(usize),
    /// A turn about one of them.
    About(usize),
    /// None: a distance.
    Scalar,
}

/// One step of a tree joint's chain, in the axes of the frame reached so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// A turn about axis 0, 1 or 2 (x, y, z).
    Turn(usize),
    /// A slide along axis 0, 1 or 2.
    Slide(usize),
    /// Any rotation: three quasi-coordinates about the axes of the frame reached so far.
    Ball,
}

impl Freedom {
    /// Number of coordinates of the freedom.
    pub const fn coordinates(self) -> usize {
        match self {
            Self::Turn(_) | Self::Slide(_) => 1,
            Self::Ball => 3,
        }
    }
}

/// A coordinate of a joint: what a driver prescribes or a measure reads.
#[derive(Debug)]
pub struct CoordinateType {
    /// The name in model files: `angle`, `displacement`, `length`, ...
    pub name: &'static str,
    /// Quantity of the coordinate, hence its unit.
    pub quantity: Quantity,
    /// Freedom of the tree joint that it is, if the joint has freedoms.
    pub freedom: Option<usize>,
    /// The constraint that a driver on a cut joint adds.
    pub row: Row,
}

impl CoordinateType {
    /// The axis of a marker that it is along or about.
    pub const fn axis(&self) -> CoordinateAxis {
        match self.row {
            Row::Dot2(k) => CoordinateAxis::Along(k),
            Row::Angle | Row::Heading | Row::Course => CoordinateAxis::About(2),
            Row::AngleOnJ => CoordinateAxis::About(0),
            Row::Distance
            | Row::Point(_)
            | Row::PointOnBase(_)
            | Row::Dot1(..)
            | Row::Cosine
            | Row::Offset
            | Row::Contact
            | Row::ConstantVelocity => CoordinateAxis::Scalar,
        }
    }
}

/// Angle of body j relative to body i about z_i, counter-clockwise, rad.
pub(crate) const fn angle(freedom: usize) -> CoordinateType {
    CoordinateType { name: "angle", quantity: Quantity::Angle, freedom: Some(freedom), row: Row::Angle }
}

/// Displacement of marker j along z_i, m.
pub(crate) const fn displacement(freedom: usize) -> CoordinateType {
    displacement_along("displacement", 2, freedom)
}

/// Displacement of marker j along axis 0, 1 or 2 of marker i, m.
pub(crate) const fn displacement_along(name: &'static str, axis: usize, freedom: usize) -> CoordinateType {
    CoordinateType { name, quantity: Quantity::Length, freedom: Some(freedom), row: Row::Dot2(axis) }
}

/// Change of the distance between the two markers from the design length, m.
pub(crate) const LENGTH: CoordinateType =
    CoordinateType { name: "length", quantity: Quantity::Length, freedom: None, row: Row::Distance };

/// Quantity of a number; the user's units follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Metres inside.
    Length,
    /// Radians inside.
    Angle,
    /// A plain number, like the parameter tau of a velocity field.
    Number,
}

/// Quantity of a constraint's residual; cosines count as angles.
impl From<Row> for Quantity {
    fn from(row: Row) -> Self {
        if row.is_length() { Self::Length } else { Self::Angle }
    }
}

/// The joint type of that name, or with that alias.
pub fn named(name: &str) -> Option<&'static JointType> {
    ALL.iter().copied().find(|t| t.name == name || t.aliases.contains(&name))
}

impl JointType {
    /// The coordinate of that name.
    pub fn coordinate(&self, name: &str) -> Option<(usize, &CoordinateType)> {
        self.coordinates.iter().enumerate().find(|(_, c)| c.name == name)
    }

    /// Quantity of the coordinate with this name, or of the first one without a name.
    pub fn quantity_of(&self, coordinate: Option<&str>) -> Option<Quantity> {
        let coordinate = match coordinate {
            Some(name) => self.coordinate(name).map(|c| c.1),
            None => self.coordinates.first(),
        };
        Some(coordinate?.quantity)
    }

    /// Returns whether a coordinate of the image of a joint is the opposite of the joint's own while both move as
    /// mirror images.
    pub fn is_reversed_in_mirror(&self, coordinate: &CoordinateType) -> bool {
        let [z, axis2] = self.vector_kinds.map(VectorKind::sign);
        let x = match self.axis2 {
            Need::Required | Need::Optional => axis2,
            // Any direction, mirrored as an arrow.
            Need::OnBodyJ | Need::Unused => VectorKind::Polar.sign(),
        };
        // y = z x x, and the image of a product of arrows is the opposite of the product of their images.
        let signs = [x, -z * x, z];
        match coordinate.axis() {
            CoordinateAxis::Along(k) => signs[k] < 0,
            CoordinateAxis::About(k) => signs[k] > 0,
            CoordinateAxis::Scalar => false,
        }
    }

    /// True if it is a ball and nothing else.
    pub fn is_ball(&self) -> bool {
        self.freedoms == Some(&[Freedom::Ball]) && self.tree_rows.is_empty()
    }

    /// True if its two bodies turn as one, and slide along one line at most.
    pub fn turns_as_one(&self) -> bool {
        matches!(self.freedoms, Some([] | [Freedom::Slide(_)]))
    }

    /// True if the distance of its two points is kept, or may be driven.
    pub fn is_rod(&self) -> bool {
        self.coordinates.iter().any(|c| c.row == Row::Distance)
    }

    /// True if its point j follows a curve on body i.
    pub fn follows_curve(&self) -> bool {
        self.rows.contains(&Row::Contact)
    }

    /// True if a `lead` couples its displacement to its angle.
    pub fn has_lead(&self) -> bool {
        std::ptr::eq(self, &SCREW)
    }

    /// Number of coordinates of the joint in the tree; `None` if it is always cut.
    pub fn freedom_count(&self) -> Option<usize> {
        self.freedoms.map(|f| f.iter().map(|f| f.coordinates()).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn freedoms_and_constraints_of_every_joint_add_up_to_six() {
        for t in ALL {
            if let Some(n) = t.freedom_count() {
                assert_eq!(n + t.rows.len() - t.tree_rows.len(), 6, "{}", t.name);
            }
        }
    }

    #[test]
    fn what_is_asked_of_joints_is_true_of_those_that_it_is_meant_for() {
        let those = |is: fn(&JointType) -> bool| -> Vec<&str> {
            ALL.iter().copied().filter(|t| is(t)).map(|t| t.name).collect()
        };
        assert_eq!(those(JointType::is_ball), ["spherical"]);
        assert_eq!(those(JointType::turns_as_one), ["fixed", "translational"]);
        assert_eq!(those(JointType::is_rod), ["distance", "revolute_spherical", "leg"]);
        assert_eq!(those(JointType::follows_curve), ["point_on_curve"]);
        assert_eq!(those(JointType::has_lead), ["screw"]);
    }

    #[test]
    fn a_mirror_reverses_turns_about_what_a_joint_slides_along_and_nothing_else() {
        let reversed = ALL.iter().flat_map(|t| {
            let of = |c: &&CoordinateType| t.is_reversed_in_mirror(c);
            t.coordinates.iter().filter(of).map(|c| (t.name, c.name)).collect::<Vec<_>>()
        });
        assert_eq!(reversed.collect::<Vec<_>>(), [("cylindrical", "angle"), ("screw", "angle")]);
    }

    #[test]
    fn names_are_unique_and_found() {
        for t in ALL {
            assert!(std::ptr::eq(named(t.name).unwrap(), *t));
            for alias in t.aliases {
                assert!(std::ptr::eq(named(alias).unwrap(), *t), "{alias} represents two types");
            }
        }
        assert!(named("hinge").is_none());
    }
}
