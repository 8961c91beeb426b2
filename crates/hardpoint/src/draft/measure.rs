//! Measures as written, and what their fields mean in a model.

use crate::draft::{DirectionDraft, NumberDraft, PointRef, RayDraft};
use crate::expression::Expression;
use crate::law::Law;
use crate::model::{
    Axes, AxleMeasure, BodyId, Combination, Direction, DriverId, ElementId, ElementUnit, JointId,
    MeasureKind, OrientationAngle, OutputSource, PointId, Ray, ReactionPart, Solid, WheelId, WheelMeasure,
    measures,
};
use crate::space::Vec3;

use super::check::MeasureCheck;

/// A type of measure as model files name it, but for those of wheels and axles, which are [`WheelMeasure`] and [`AxleMeasure`].
#[derive(Debug)]
pub struct MeasureType {
    /// Name.
    pub name: &'static str,
    /// What it measures, in a sentence.
    pub summary: &'static str,
    /// What is to be said of it.
    pub fields: &'static [MeasureField],
}

/// A field of a measure.
#[derive(Debug)]
pub struct MeasureField {
    /// Name in model files.
    pub key: &'static str,
    /// What it is.
    pub kind: FieldKind,
    /// True if it must be given.
    pub required: bool,
    /// What it means.
    pub summary: &'static str,
}

/// What a field of a measure may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// The name of a joint.
    Joint,
    /// The name of a coordinate of that joint.
    Coordinate,
    /// A point.
    Point,
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
    /// The name of a body.
    Body,
    /// One of [`OrientationAngle::WORDS`].
    OrientationAngle,
    /// One of [`ReactionPart::WORDS`].
    ReactionPart,
    /// One of [`Axes::WORDS`].
    Axes,
    /// The name of a force.
    Force,
    /// The name of a wheel.
    Wheel,
    /// A force over a way, as points of a table.
    Table,
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
    /// A point.
    Point(PointRef),
    /// A global direction, of any length.
    Direction(Vec3),
    /// A direction, which may follow hardpoints.
    Line(DirectionDraft),
    /// A direction to measure an angle from or to.
    Ray(RayDraft),
    /// One of the angles that say how a body is turned.
    Angle(OrientationAngle),
    /// What of a joint's reaction is measured.
    Part(ReactionPart),
    /// Along which axes something is given.
    Axes(Axes),
    /// A number.
    Number(NumberDraft),
    /// A number over time.
    Law(Law),
    /// Points of a table, SI.
    Table(Vec<[f64; 2]>),
    /// What a closed surface bounds.
    Solid(Solid),
    /// An expression.
    Expression(Expression),
}

/// What is written as a `Draft` and means this in a model. The fields of a measure are of such types.
pub(super) trait Field: Sized {
    type Draft;
    const KIND: FieldKind;
    const REQUIRED: bool = true;
    /// As written, if it is; `None` where it is something else, or missing.
    fn draft(written: Option<FieldDraft>) -> Option<Self::Draft>;
    /// What it means; `None`, and a fault, where that is not known.
    fn resolve(draft: &Self::Draft, key: &'static str, check: &mut MeasureCheck<'_, '_>) -> Option<Self>;
}

/// How a type of measure is written, and what of the model it means.
macro_rules! in_drafts {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$model:pat_param, $words:pat_param| $dimension:expr, $known:expr, $says:expr;
    )*) => {
        /// What a measure measures, as written; see [`MeasureKind`].
        #[derive(Clone, Debug)]
        pub enum MeasureKindDraft {
            /// It could not be read.
            Unread,
            $($(#[doc = $doc])* $variant { $($(#[doc = $field_doc])* $field: $draft,)* },)*
            /// Something about a wheel.
            Wheel {
                /// The wheel's name.
                wheel: String,
                /// What about it.
                what: WheelMeasure,
            },
            /// Something about both wheels of an axle.
            Axle {
                /// The axle's name.
                axle: String,
                /// What about it.
                what: AxleMeasure,
            },
        }

        impl MeasureType {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self {
                name: $name,
                summary: concat!($($doc),*).trim_ascii(),
                fields: &[$(MeasureField {
                    key: stringify!($field),
                    kind: <$type as Field>::KIND,
                    required: <$type as Field>::REQUIRED,
                    summary: concat!($($field_doc),*).trim_ascii(),
                }),*],
            }),*];

            /// A measure of this type from its fields; `None` where one of them is missing, or not of its kind.
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

        impl MeasureKindDraft {
            /// What it means in a model; of wheels and axles the check says it.
            pub(super) fn resolve(&self, check: &mut MeasureCheck<'_, '_>) -> Option<MeasureKind> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $(let $field = <$type as Field>::resolve($field, stringify!($field), check);)*
                        Some(MeasureKind::$variant { $($field: $field?),* })
                    })*
                    Self::Unread => None,
                    Self::Wheel { wheel, what } => check.wheel(wheel, *what),
                    Self::Axle { axle, what } => check.axle(axle, *what),
                }
            }
        }
    };
}

measures!(in_drafts);
