//! Measures as written.

use crate::draft::{DirectionDraft, NumberDraft, PointRef, TablePointDraft};
use crate::expression::Expression;
use crate::joint::VectorKind;
use crate::law::Law;
use crate::model::{
    Axes, AxleMeasure, BodyId, ClearanceId, Combination, Direction, DriverId, ElasticDirection, ElasticId,
    ElementId, ElementUnit, JacobianValue, JointId, OrientationAngle, OutputSource, PointId, Ray,
    ReactionPart, Solid, WheelId, WheelMeasure, measures,
};
use crate::space::Vec3;

/// A measure.
#[derive(Clone, Debug)]
pub struct MeasureDraft {
    /// Name.
    pub name: String,
    /// Kind of the measure.
    pub kind: MeasureKindDraft,
}

/// Type of measure, by its name in model files. Measures of wheels and axles are [`WheelMeasure`] and [`AxleMeasure`].
#[derive(Debug)]
pub struct MeasureType {
    /// Name.
    pub name: &'static str,
    /// Description of the measure in one sentence.
    pub summary: &'static str,
    /// Kind of its direction, for the image in a mirror.
    pub vector_kind: VectorKind,
    /// True if its direction defaults to the normal of the plane in a planar model.
    pub normal_in_plane: bool,
    /// Fields of the type.
    pub fields: &'static [MeasureField],
}

/// A field of a measure.
#[derive(Debug)]
pub struct MeasureField {
    /// Name in model files.
    pub key: &'static str,
    /// Kind of the field.
    pub kind: FieldKind,
    /// True if the field is required.
    pub required: bool,
    /// Meaning of the field.
    pub summary: &'static str,
}

/// Kind of value that a field of a measure holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// The name of a joint.
    Joint,
    /// The name of a coordinate of that joint.
    Coordinate,
    /// A point.
    Point,
    /// Several points.
    Points,
    /// A global direction.
    Direction,
    /// A direction, which may follow hardpoints.
    Line,
    /// A direction to measure an angle from or to.
    Ray,
    /// The name of a measure, or of a component of a point.
    Output,
    /// The name of a driver.
    Driver,
    /// Several names of drivers.
    Drivers,
    /// The name of a body.
    Body,
    /// One of [`OrientationAngle::WORDS`].
    OrientationAngle,
    /// One of [`ReactionPart::WORDS`].
    ReactionPart,
    /// One of [`JacobianValue::WORDS`].
    JacobianValue,
    /// One of [`ElasticDirection::WORDS`].
    ElasticDirection,
    /// One of [`Axes::WORDS`].
    Axes,
    /// One of [`WheelPoint::WORDS`](crate::model::WheelPoint::WORDS).
    WheelPoint,
    /// The name of a force.
    Force,
    /// The name of a wheel.
    Wheel,
    /// The name of a clearance.
    Clearance,
    /// Force over deflection, as points of a table.
    Table,
    /// Moment over angle, as points of a table.
    MomentTable,
    /// A symmetric matrix of stiffnesses.
    Matrix,
    /// A closed surface.
    Mesh,
    /// A number, which may be an expression over parameters.
    Number(ElementUnit),
    /// A number over time.
    Law,
    /// An expression over outputs.
    Expression,
}

/// A field of a measure as written.
#[derive(Clone, Debug)]
pub enum FieldDraft {
    /// A name.
    Name(String),
    /// Several names.
    Names(Vec<String>),
    /// A point.
    Point(PointRef),
    /// Several points.
    Points(Vec<PointRef>),
    /// A global direction, of any length.
    Direction(Vec3),
    /// A direction, which may follow hardpoints.
    Line(DirectionDraft),
    /// A direction to measure an angle from or to.
    Ray(RayDraft),
    /// Orientation angle of a body.
    Angle(OrientationAngle),
    /// Component of a joint's reaction.
    Part(ReactionPart),
    /// Part of a Jacobian's singular values.
    Jacobian(JacobianValue),
    /// Direction of an elastic joint or bushing.
    Elastic(ElasticDirection),
    /// Axes in which a vector is given.
    Axes(Axes),
    /// Point of a wheel at which a force acts.
    WheelPoint(crate::model::WheelPoint),
    /// A number.
    Number(NumberDraft),
    /// A number over time.
    Law(Law),
    /// Points of a table.
    Table(Vec<TablePointDraft>),
    /// Rows of a matrix of stiffnesses.
    Matrix(Box<[[NumberDraft; 6]; 6]>),
    /// Solid that a closed surface encloses.
    Solid(Solid),
    /// An expression.
    Expression(Expression),
}

/// A direction that an angle is measured from or to; see [`Ray`](crate::model::Ray).
#[derive(Clone, Debug)]
pub enum RayDraft {
    /// From one point to another.
    Between([PointRef; 2]),
    /// Fixed in a body.
    Fixed {
        /// The body's name.
        body: String,
        /// Direction in the design configuration.
        axis: DirectionDraft,
    },
}

/// Value that is written as a `Draft` and resolved to this type in a model. Fields of measures and elements have such
/// types.
pub(super) trait Field: Sized {
    type Draft;
    const KIND: FieldKind;
    const REQUIRED: bool = true;
    /// Returns the value as written; `None` if it is missing or of another kind.
    fn draft(written: Option<FieldDraft>) -> Option<Self::Draft>;
}

/// Measure types as written.
macro_rules! in_drafts {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal
        [$class:ident, $drivable:ident, $vector:ident, normal: $normal:literal] {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$model:pat_param, $words:pat_param|
            dimension: $dimension:expr, known: $known:expr, kinks: $kinks:expr, positive: $positive:expr,
            words: $says:expr;
    )*) => {
        /// Kind of a measure as written; see [`MeasureKind`](crate::model::MeasureKind).
        #[derive(Clone, Debug)]
        pub enum MeasureKindDraft {
            /// Entry that could not be read.
            Unread,
            $($(#[doc = $doc])* $variant { $($(#[doc = $field_doc])* $field: $draft,)* },)*
            /// A measure of a wheel.
            Wheel {
                /// The wheel's name.
                wheel: String,
                /// Measured quantity.
                what: WheelMeasure,
            },
            /// A measure of both wheels of an axle.
            Axle {
                /// The axle's name.
                axle: String,
                /// Measured quantity.
                what: AxleMeasure,
            },
        }

        impl MeasureType {
            /// All types.
            pub const ALL: &[Self] = &[$(Self {
                name: $name,
                summary: concat!($($doc),*).trim_ascii(),
                vector_kind: VectorKind::$vector,
                normal_in_plane: $normal,
                fields: &[$(MeasureField {
                    key: stringify!($field),
                    kind: <$type as Field>::KIND,
                    required: <$type as Field>::REQUIRED,
                    summary: concat!($($field_doc),*).trim_ascii(),
                }),*],
            }),*];

            /// Returns the type of this name.
            pub fn named(name: &str) -> Option<&'static Self> {
                Self::ALL.iter().find(|t| t.name == name)
            }

            /// Returns a measure of this type from its fields; `None` if a field is missing or of the wrong kind.
            pub fn draft(&self, mut field: impl FnMut(&MeasureField) -> Option<FieldDraft>) -> Option<MeasureKindDraft> {
                let mut fields = self.fields.iter().map(|f| field(f)).collect::<Vec<_>>().into_iter();
                match self.name {
                    $($name => Some(MeasureKindDraft::$variant {
                        $($field: <$type as Field>::draft(fields.next()?)?,)*
                    }),)*
                    _ => None,
                }
            }
        }
    };
}

measures!(in_drafts);

/// Pattern of the measures that are not the value of one coordinate, which a driver could prescribe.
macro_rules! pattern {
    ([$($kinds:ident)*] NotDrivable $kind:ident $($rest:tt)*) => { pattern! { [$($kinds)* $kind] $($rest)* } };
    ($kinds:tt Drivable $kind:ident $($rest:tt)*) => { pattern! { $kinds $($rest)* } };
    ([$($kind:ident)*]) => {
        macro_rules! not_drivable {
            () => { $(MeasureKindDraft::$kind { .. } |)* MeasureKindDraft::Axle { .. } };
        }
    };
}
macro_rules! by_drivability {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal
        [$class:ident, $drivable:ident, $($attributes:tt)*] { $($fields:tt)* } |$model:pat_param, $words:pat_param|
            dimension: $dimension:expr, known: $known:expr, kinks: $kinks:expr, positive: $positive:expr,
            words: $says:expr;
    )*) => {
        pattern! { [] $($drivable $variant)* }
    };
}
measures!(by_drivability);
pub(super) use not_drivable;
