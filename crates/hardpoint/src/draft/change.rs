//! Changes as written, and the quantity of the variable that makes them.

use crate::draft::DirectionDraft;
use crate::joint::Quantity;
use crate::law::{Law, ParameterKind};
use crate::model::End;
use crate::model::change::changes;
use crate::space::Vec3;

/// Changes as written, with names as references.
macro_rules! in_drafts {
    ($(
        $(#[doc = $doc:literal])* $kind:ident {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$known:pat_param| $quantity:expr, $target:expr, |$words:pat_param| $says:expr;
    )*) => {
        /// Part of a design variable; see [`Change`](crate::model::Change). References are names.
        #[derive(Clone, Debug)]
        pub enum ChangeDraft {
            $($(#[doc = $doc])* $kind { $($(#[doc = $field_doc])* $field: $draft,)* },)*
            /// Rotation of both markers of a joint about a line through their origins.
            Tilt {
                /// The joint's name.
                joint: String,
                /// Rotation axis; one radian per radian of the variable.
                about: DirectionDraft,
            },
            /// Play of a joint: its pin or ball is off its centre, on body j.
            Play {
                /// The joint's name.
                joint: String,
                /// Axis of the joint's marker (0, 1 or 2) along which it is.
                along: usize,
            },
            /// Change of shape of whole bodies. Everything on them follows: joints with the markers of both bodies,
            /// axes, points.
            Shape {
                /// The names of the bodies.
                bodies: Vec<String>,
                /// Velocity field of the body's points.
                field: ShapeDraft,
            },
        }

        impl ChangeDraft {
            /// Returns the quantity of a variable that makes this change.
            fn quantity(&self, known: &Known<'_, '_>) -> Quantity {
                match self {
                    $(#[allow(unused_variables, reason = "what it measures follows from some of its fields")]
                    Self::$kind { $($field),* } => { let $known = known; $quantity })*
                    Self::Tilt { .. } => Quantity::Angle,
                    Self::Play { .. } => Quantity::Length,
                    Self::Shape { field, .. } => field.quantity(),
                }
            }
        }
    };
}

changes!(in_drafts);

impl ChangeDraft {
    /// Returns the quantity of a variable that makes these changes, given the quantities of parameters and drivers; a
    /// plain number if the changes differ.
    pub fn quantity_of<'l>(
        changes: &[Self],
        parameter: impl Fn(&str) -> Option<Quantity>,
        driver: impl Fn(&str) -> Option<(&'l Law, Quantity)>,
    ) -> Quantity {
        let known = Known { parameter: &parameter, driver: &driver };
        let mut quantities = changes.iter().map(|change| change.quantity(&known));
        let first = quantities.next().unwrap_or(Quantity::Number);
        if quantities.all(|q| q == first) { first } else { Quantity::Number }
    }
}

/// Quantities of parameters, and drivers with their laws, as far as they are known.
struct Known<'k, 'l> {
    parameter: &'k dyn Fn(&str) -> Option<Quantity>,
    driver: &'k dyn Fn(&str) -> Option<(&'l Law, Quantity)>,
}

impl Known<'_, '_> {
    fn parameter(&self, name: &str) -> Quantity {
        (self.parameter)(name).unwrap_or(Quantity::Number)
    }

    fn parameter_of_law(&self, driver: &str, name: &str) -> Quantity {
        let Some((law, driven)) = (self.driver)(driver) else { return Quantity::Number };
        match law.parameters().into_iter().find(|p| p.name == name).map(|p| p.kind) {
            Some(ParameterKind::Value) => driven,
            Some(ParameterKind::Angle) => Quantity::Angle,
            _ => Quantity::Number,
        }
    }
}

/// Velocity field over a body: the velocity of each of its points in the design configuration, per unit of the
/// variable. Points are given by names of hardpoints.
#[derive(Clone, Debug)]
pub enum ShapeDraft {
    /// Translation along a direction of any length.
    Translate(Vec3),
    /// Rotation about a line through a hardpoint.
    Rotate {
        /// Direction of the line.
        about: DirectionDraft,
        /// Hardpoint.
        at: String,
    },
    /// Scaling away from a hardpoint, in all directions or along one.
    Scale {
        /// Hardpoint.
        from: String,
        /// Direction of the scaling; all directions if `None`.
        along: Option<DirectionDraft>,
    },
    /// Deflection of a cantilever beam, clamped at one hardpoint and loaded at another.
    Bend {
        /// Clamped end.
        from: String,
        /// Free, loaded end.
        to: String,
        /// Direction of the deflection, of any length; only the component perpendicular to the beam is used.
        towards: Vec3,
    },
    /// Interpolation of given velocities of hardpoints, per unit, smooth between them.
    Through(Vec<(String, Vec3)>),
}

impl ShapeDraft {
    fn quantity(&self) -> Quantity {
        match self {
            Self::Rotate { .. } => Quantity::Angle,
            Self::Scale { .. } => Quantity::Number,
            Self::Translate(_) | Self::Bend { .. } | Self::Through(_) => Quantity::Length,
        }
    }
}
