//! Masses and forces as written.

use crate::draft::{DirectionDraft, FieldDraft, MeasureField, NumberDraft, PointRef, TablePointDraft};
use crate::law::Law;
use crate::model::{
    Angle, Axes, BodyId, CoupledStiffness, CubicStiffness, CubicTorsionalStiffness, Damping, Density,
    Direction, Force, Inertia, JointId, Length, Mass, Moment, MomentTable, Plain, PointId, Solid,
    SpringTable, Stiffness, TorsionalDamping, TorsionalStiffness, WheelId, WheelPoint, elements, if_mass,
};
use crate::space::Vec3;

use super::measure::Field;

/// A mass or force as written.
#[derive(Clone, Debug)]
pub struct ElementDraft {
    /// Name.
    pub name: String,
    /// Kind of the element.
    pub kind: ElementKindDraft,
}

impl ElementDraft {
    /// Returns a mass or force with this name.
    pub fn new(name: impl Into<String>, kind: ElementKindDraft) -> Self {
        Self { name: name.into(), kind }
    }
}

/// A type of element as model files name it.
#[derive(Debug)]
pub struct ElementType {
    /// Name.
    pub name: &'static str,
    /// Description in one sentence.
    pub summary: &'static str,
    /// The table of model files that it is in: `masses` or `forces`.
    pub table: &'static str,
    /// Fields of the type.
    pub fields: &'static [MeasureField],
}

/// Element types as written.
macro_rules! in_drafts {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal $table:ident {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        }
    )*) => {
        /// Kind of an element as written; see [`ElementKind`](crate::model::ElementKind).
        #[derive(Clone, Debug)]
        #[allow(clippy::large_enum_variant, reason = "a draft has few elements, and builders name their fields")]
        pub enum ElementKindDraft {
            /// Entry that could not be read.
            Unread,
            $($(#[doc = $doc])* $variant { $($(#[doc = $field_doc])* $field: $draft,)* },)*
        }

        impl ElementType {
            /// All types.
            pub const ALL: &[Self] = &[$(Self {
                name: $name,
                summary: concat!($($doc),*).trim_ascii(),
                table: stringify!($table),
                fields: &[$(MeasureField {
                    key: stringify!($field),
                    kind: <$type as Field>::KIND,
                    required: <$type as Field>::REQUIRED,
                    summary: concat!($($field_doc),*).trim_ascii(),
                }),*],
            }),*];

            /// Returns an element of this type from its fields; `None` if a field is missing or of the wrong kind.
            pub fn draft(&self, mut field: impl FnMut(&MeasureField) -> Option<FieldDraft>) -> Option<ElementKindDraft> {
                let mut fields = self.fields.iter().map(|f| field(f)).collect::<Vec<_>>().into_iter();
                match self.name {
                    $($name => Some(ElementKindDraft::$variant {
                        $($field: <$type as Field>::draft(fields.next()?)?,)*
                    }),)*
                    _ => None,
                }
            }
        }

        impl ElementKindDraft {
            /// True if it has mass.
            pub fn has_mass(&self) -> bool {
                match self {
                    $(Self::$variant { .. } => if_mass!($table, true, false),)*
                    Self::Unread => false,
                }
            }
        }
    };
}

elements!(in_drafts);
