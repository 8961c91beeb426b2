//! Joint types, one file each.
//!
//! A joint is data. As a *tree* joint it is a chain of [`Freedom`]s that positions body j relative to body i; as a
//! *cut* joint it is a list of elementary constraints ([`Row`]) between its two markers. The solver uses freedoms and
//! rows only: to add a joint, add a file and list it here.
//!
//! # Frames, signs and units
//!
//! A joint connects body i, the first of its `bodies`, with body j, the second. It has a marker on each: an origin P
//! and right-handed axes x, y, z fixed in the body. In the design configuration both origins are at the joint's
//! hardpoint (or each at its own, for joints with two), z points along `axis`, and x along `axis2` if the type has one.
//! If only z matters, x is along the part of `axis2` perpendicular to z; without `axis2`, x is any perpendicular
//! direction, the same for both markers. If no direction matters and none is given, the axes are the global ones. If
//! `axis2` belongs to body j ([`Need::OnBodyJ`]), it is the z axis of marker j.
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
//! Angles are in rad and displacements in m. Angles and displacements are zero in the design configuration. A length is
//! the distance |d|; a driver prescribes its change from the design length. Reactions are the force (N) and the moment
//! (N m) that the joint applies to body j.

mod angle;
mod constant_velocity;
mod course;
mod cylindrical;
mod distance;
mod dot1;
mod dot2;
mod elastic;
mod fixed;
mod heading;
mod inline;
mod inplane;
mod leg;
mod orientation;
mod pad;
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
pub use elastic::DIRECTION_NAMES;
pub(crate) use elastic::{
    DIRECTIONS, elastic, free_directions, sprung_directions, tied_directions, with_turns,
};
pub(crate) use pad::pad;

/// Exports and lists the types.
macro_rules! joints {
    ($($file:ident $TYPE:ident)*) => {
        $(pub use $file::$TYPE;)*

        /// All joint types that models can use.
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

/// A joint type: its geometry, its freedoms as a tree joint, and its constraints as a cut joint.
///
/// Both markers have their z axis along the joint's `axis` and their x axis along `axis2` (or any direction
/// perpendicular to `axis`, the same for both), and their orientations coincide in the design configuration. Exception:
/// if `axis2` is [`Need::OnBodyJ`], it is the z axis of marker j.
#[derive(Debug)]
pub struct JointType {
    /// Name in model files.
    pub name: &'static str,
    /// Alternative names in model files.
    pub aliases: &'static [&'static str],
    /// Description in one line, for documentation and editors.
    pub summary: &'static str,
    /// Number of hardpoints of the joint: 1 (shared by both bodies), 2 (one on each), or 0 (only directions matter).
    pub places: usize,
    /// Requirement for `axis`.
    pub axis: Need,
    /// Requirement for `axis2`.
    pub axis2: Need,
    /// Kinds of vector of `axis` and `axis2`, for their images in a mirror.
    pub vector_kinds: [VectorKind; 2],
    /// True if `axis` defaults to the normal of the plane in a planar model.
    pub normal_in_plane: bool,
    /// Types with fewer constraints that may replace this one where constraints are redundant.
    pub relaxations: &'static [&'static JointType],
    /// True if a pin or bearings along `axis` connect the bodies.
    pub is_hinge: bool,
    /// Straight guide between the bodies.
    pub slide: Slide,
    /// Motions of body j relative to body i, in order from i to j; `None` if the joint is always cut.
    pub freedoms: Option<&'static [Freedom]>,
    /// Elementary constraints that the freedoms of the tree joint do not satisfy by themselves.
    pub tree_rows: &'static [Row],
    /// Elementary constraints of the cut joint (paper, section 4).
    pub rows: &'static [Row],
    /// Coordinates that drivers and measures can use.
    pub coordinates: &'static [CoordinateType],
}

impl JointType {
    /// Axes of its marker along which its pin or ball is off its centre if it has play; none for other types.
    pub fn play(&self) -> &'static [usize] {
        match self.freedoms {
            Some([Freedom::Ball]) => &[0, 1, 2],
            _ if self.is_hinge => &[0, 1],
            _ => &[],
        }
    }
}

/// Straight guide of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slide {
    /// No guide.
    None,
    /// A block or sleeve along z; either body may be the rail.
    Block,
    /// A point or pin of body j on a line of body i along axis 0 or 2 (x, z) of its marker.
    Line(usize),
    /// A point of body j in a plane of body i.
    Plane,
}

/// Requirement for an axis of a joint type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Required; as a second axis, perpendicular to the first.
    Required,
    /// Optional.
    Optional,
    /// Required, on body j, at any angle to the axis of body i.
    OnBodyJ,
    /// Optional: the type moves alike for all such axes, but they orient its markers, along whose axes elastic joints
    /// deflect and reactions have components. Of a second axis the part perpendicular to the first counts.
    Orienting,
    /// Not used by this type.
    Unused,
}

/// Kind of a vector, which determines its image in a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorKind {
    /// Polar vector: a direction of translation.
    Polar,
    /// Axial vector: an axis of rotation or the normal of a plane. Its image is the opposite of that of a polar vector.
    Axial,
}

impl VectorKind {
    /// Sign of the image of this kind relative to that of a polar vector.
    const fn sign(self) -> i8 {
        match self {
            Self::Polar => 1,
            Self::Axial => -1,
        }
    }
}

/// Marker axis of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateAxis {
    /// Displacement along axis 0, 1 or 2 of a marker (x, y, z).
    Along(usize),
    /// Rotation about axis 0, 1 or 2 of a marker.
    About(usize),
    /// No axis: a distance.
    Scalar,
}

/// Freedom in the chain of a tree joint, in the axes of the frame reached so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// Rotation about axis 0, 1 or 2 (x, y, z), rad.
    Turn(usize),
    /// Translation along axis 0, 1 or 2, m.
    Slide(usize),
    /// Arbitrary rotation: three quasi-coordinates about the axes of the frame reached so far.
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

/// Coordinate of a joint that a driver prescribes or a measure reads.
#[derive(Debug)]
pub struct CoordinateType {
    /// Name in model files: `angle`, `displacement`, `length`, ...
    pub name: &'static str,
    /// Quantity of the coordinate, which determines its unit.
    pub quantity: Quantity,
    /// Index of the corresponding freedom of the tree joint, if the joint has freedoms.
    pub freedom: Option<usize>,
    /// Constraint row that a driver adds to a cut joint.
    pub row: Row,
}

impl CoordinateType {
    /// Marker axis along or about which the coordinate is measured.
    pub const fn axis(&self) -> CoordinateAxis {
        match self.row {
            Row::Dot2(k) => CoordinateAxis::Along(k),
            Row::Angle | Row::CardanAngle | Row::Heading | Row::Course => CoordinateAxis::About(2),
            Row::AngleOnJ | Row::HeadingOnJ => CoordinateAxis::About(0),
            Row::Distance
            | Row::Point(_)
            | Row::PointOnBase(_)
            | Row::Dot1(..)
            | Row::Cosine
            | Row::Offset
            | Row::Contact
            | Row::ConstantVelocity
            | Row::LowestPoint(_) => CoordinateAxis::Scalar,
        }
    }
}

/// Angle of body j relative to body i about z_i, right-handed, rad.
pub(crate) const fn angle(freedom: usize) -> CoordinateType {
    CoordinateType { name: "angle", quantity: Quantity::Angle, freedom: Some(freedom), row: Row::Angle }
}

/// Displacement of marker j relative to marker i along z_i, m.
pub(crate) const fn displacement(freedom: usize) -> CoordinateType {
    displacement_along("displacement", 2, freedom)
}

/// Displacement of marker j relative to marker i along axis 0, 1 or 2 of marker i, m.
pub(crate) const fn displacement_along(name: &'static str, axis: usize, freedom: usize) -> CoordinateType {
    CoordinateType { name, quantity: Quantity::Length, freedom: Some(freedom), row: Row::Dot2(axis) }
}

/// Distance between the two markers, m; a driver prescribes its change from the design length.
pub(crate) const LENGTH: CoordinateType =
    CoordinateType { name: "length", quantity: Quantity::Length, freedom: None, row: Row::Distance };

/// Physical quantity of a number, which determines its unit for the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Length, internally in m.
    Length,
    /// Angle, internally in rad.
    Angle,
    /// Dimensionless number, like the parameter tau of a velocity field.
    Number,
}

/// Quantity of the residual of a constraint; cosines count as angles.
impl From<Row> for Quantity {
    fn from(row: Row) -> Self {
        if row.is_length() { Self::Length } else { Self::Angle }
    }
}

/// Returns the joint type with this name or alias.
pub fn named(name: &str) -> Option<&'static JointType> {
    ALL.iter().copied().find(|t| t.name == name || t.aliases.contains(&name))
}

impl JointType {
    /// Returns the index and type of the coordinate with this name.
    pub fn coordinate(&self, name: &str) -> Option<(usize, &CoordinateType)> {
        self.coordinates.iter().enumerate().find(|(_, c)| c.name == name)
    }

    /// Quantity of the coordinate with this name, or of the first one if no name is given.
    pub fn quantity_of(&self, coordinate: Option<&str>) -> Option<Quantity> {
        let coordinate = match coordinate {
            Some(name) => self.coordinate(name).map(|c| c.1),
            None => self.coordinates.first(),
        };
        Some(coordinate?.quantity)
    }

    /// Signs of the markers' axes x, y and z in the mirror: 1 if an axis becomes its image, -1 if the opposite of it.
    pub fn axes_in_mirror(&self) -> [i8; 3] {
        let [z, axis2] = self.vector_kinds.map(VectorKind::sign);
        let x = match self.axis2 {
            Need::Required | Need::Optional | Need::Orienting => axis2,
            // Any direction, mirrored as a polar vector.
            Need::OnBodyJ | Need::Unused => VectorKind::Polar.sign(),
        };
        // y = z x x, and the image of a product of polar vectors is the opposite of the product of their images.
        [x, -z * x, z]
    }

    /// Returns true if a coordinate of the mirrored joint is the opposite of that of the joint when both move as mirror
    /// images.
    pub fn is_reversed_in_mirror(&self, coordinate: &CoordinateType) -> bool {
        let signs = self.axes_in_mirror();
        match coordinate.axis() {
            CoordinateAxis::Along(k) => signs[k] < 0,
            CoordinateAxis::About(k) => signs[k] > 0,
            CoordinateAxis::Scalar => false,
        }
    }

    /// True if it is a spherical joint.
    pub fn is_ball(&self) -> bool {
        self.freedoms == Some(&[Freedom::Ball]) && self.tree_rows.is_empty()
    }

    /// True if it is a cross of two pins.
    pub fn is_cross(&self) -> bool {
        self.coordinates.iter().any(|c| matches!(c.row, Row::AngleOnJ | Row::HeadingOnJ))
    }

    /// True if its axis may tilt between the two bodies, which a point, a line or a plane holds together.
    pub fn articulates(&self) -> bool {
        self.is_cross() || self.freedoms.is_some_and(|f| f.contains(&Freedom::Ball))
    }

    /// True if the two bodies have no relative rotation, and at most one relative translation.
    pub fn turns_as_one(&self) -> bool {
        matches!(self.freedoms, Some([] | [Freedom::Slide(_)]))
    }

    /// True if a body slides on the other.
    pub fn slides(&self) -> bool {
        self.freedoms.is_some_and(|f| f.iter().any(|f| matches!(f, Freedom::Slide(_))))
    }

    /// True if the distance of its two points is constant, or a coordinate.
    pub fn is_rod(&self) -> bool {
        self.coordinates.iter().any(|c| c.row == Row::Distance)
    }

    /// True if its coordinate is the height of the contact point of a wheel.
    pub fn is_pad(&self) -> bool {
        self.coordinates.iter().any(|c| matches!(c.row, Row::LowestPoint(_)))
    }

    /// True if its point j follows a curve of body i.
    pub fn follows_curve(&self) -> bool {
        self.rows.contains(&Row::Contact)
    }

    /// True if a `lead` couples its displacement to its angle.
    pub fn has_lead(&self) -> bool {
        std::ptr::eq(self, &SCREW)
    }

    /// Number of coordinates as a tree joint; `None` if it is always cut.
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
    fn relaxations_have_fewer_constraints_and_other_numbers_of_them() {
        for t in ALL {
            let rows: Vec<usize> = t.relaxations.iter().map(|other| other.rows.len()).collect();
            assert!(rows.first().is_none_or(|first| *first < t.rows.len()), "{}", t.name);
            assert!(rows.is_sorted_by(|a, b| a > b), "{}", t.name);
        }
    }

    #[test]
    fn guides_are_along_freedoms() {
        for t in ALL {
            let along = |k: usize| t.freedoms.is_some_and(|f| f.contains(&Freedom::Slide(k)));
            let has_freedom = match t.slide {
                Slide::None => true,
                Slide::Block => along(2),
                Slide::Line(k) => along(k),
                Slide::Plane => along(0) && along(1),
            };
            assert!(has_freedom, "{}", t.name);
            assert!(!t.is_hinge || t.freedoms.is_some_and(|f| f.contains(&Freedom::Turn(2))), "{}", t.name);
        }
    }

    #[test]
    fn what_is_asked_of_joints_is_true_of_those_that_it_is_meant_for() {
        let those = |is: fn(&JointType) -> bool| -> Vec<&str> {
            ALL.iter().copied().filter(|t| is(t)).map(|t| t.name).collect()
        };
        assert_eq!(those(JointType::is_ball), ["spherical"]);
        assert_eq!(those(JointType::is_cross), ["universal"]);
        assert_eq!(
            those(JointType::articulates),
            ["spherical", "universal", "constant_velocity", "inline", "inplane"]
        );
        assert_eq!(those(JointType::turns_as_one), ["fixed", "translational"]);
        assert_eq!(
            those(JointType::slides),
            [
                "translational",
                "cylindrical",
                "planar",
                "pin_in_slot",
                "screw",
                "inline",
                "inplane",
                "orientation",
                "parallel",
                "dot1"
            ]
        );
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
