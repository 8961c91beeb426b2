//! Joint types as data: their geometry, their freedoms as tree joints, and their constraints as cut joints.

use crate::constraint::Row;

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

    /// Number of coordinates as a tree joint; `None` if it is always cut.
    pub fn freedom_count(&self) -> Option<usize> {
        self.freedoms.map(|f| f.iter().map(|f| f.coordinates()).sum())
    }
}
