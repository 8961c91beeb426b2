//! Resolution of measures and elements from their fields.

use crate::draft::measure::Field;
use crate::draft::{
    DirectionDraft, ElementKindDraft, FieldDraft, FieldKind, MeasureKindDraft, NumberDraft, PointRef,
    RayDraft, TablePointDraft,
};
use crate::expression::Expression;
use crate::law::Law;
use crate::model::element::CoupledStiffness;
use crate::model::{
    Angle, Axes, BodyId, ClearanceId, Combination, Coupling, CubicStiffness, CubicTorsionalStiffness,
    Damping, Density, Dimension, Direction, DriverId, ElasticDirection, ElasticId, ElementId, ElementKind,
    ElementUnit, Force, Inertia, JacobianValue, JointId, Length, Mass, MeasureKind, Moment, MomentTable,
    OrientationAngle, OutputSource, Plain, PointId, Ray, ReactionPart, Solid, SpringTable, Stiffness,
    TorsionalDamping, TorsionalStiffness, WheelId, WheelPoint, each_number, element, elements, measures,
};
use crate::space::Vec3;

use super::{Checker, Here};

macro_rules! measures_in_checks {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal [$($attributes:tt)*] {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$model:pat_param, $words:pat_param|
            dimension: $dimension:expr, known: $known:expr, kinks: $kinks:expr, positive: $positive:expr,
            words: $says:expr;
    )*) => {
        impl MeasureKindDraft {
            /// Resolves the measure to its form in a model; the check resolves those of wheels and axles.
            pub(super) fn resolve(&self, check: &mut FieldCheck<'_, '_>) -> Option<MeasureKind> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $(let $field = <$type as Resolve>::resolve($field, stringify!($field), check);)*
                        Some(MeasureKind::$variant { $($field: $field?),* })
                    })*
                    Self::Unread => None,
                    Self::Wheel { wheel, what } => check.check.wheel_measure(wheel, *what, check.here),
                    Self::Axle { axle, what } => check.check.axle_measure(axle, *what, check.here),
                }
            }
        }
    };
}
measures!(measures_in_checks);

macro_rules! elements_in_checks {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal $table:ident {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        }
    )*) => {
        impl ElementKindDraft {
            /// Resolves the element to its form in a model.
            pub(super) fn resolve(&self, check: &mut FieldCheck<'_, '_>) -> Option<ElementKind> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $(let $field = <$type as Resolve>::resolve($field, stringify!($field), check);)*
                        Some(ElementKind::$variant(element::$variant { $($field: $field?),* }))
                    })*
                    Self::Unread => None,
                }
            }
        }
    };
}
elements!(elements_in_checks);

/// Check of the fields of one measure or element.
pub(super) struct FieldCheck<'c, 'd> {
    check: &'c mut Checker<'d>,
    owner: &'c str,
    here: Here,
    /// Joint of the measure or element, for the field that names its coordinate.
    joint: Option<JointId>,
}

impl<'c, 'd> FieldCheck<'c, 'd> {
    pub fn new(check: &'c mut Checker<'d>, owner: &'c str, here: Here) -> Self {
        Self { check, owner, here, joint: None }
    }
}

/// Field that is resolved to its form in a model.
trait Resolve: Field {
    /// Resolves the value; `None`, with an error, if it is not known.
    fn resolve(draft: &Self::Draft, key: &'static str, c: &mut FieldCheck<'_, '_>) -> Option<Self>;
}

/// Draft type and model type of each kind of field.
macro_rules! field {
    (
        $type:ty, $kind:ident $(($unit:expr))?, $form:ident: $draft:ty,
        |$written:ident, $key:ident, $c:ident| $resolve:expr
    ) => {
        impl Field for $type {
            type Draft = $draft;
            const KIND: FieldKind = FieldKind::$kind $(($unit))?;

            fn draft(written: Option<FieldDraft>) -> Option<$draft> {
                if let Some(FieldDraft::$form(draft)) = written { Some(draft) } else { None }
            }
        }

        impl Resolve for $type {
            fn resolve($written: &$draft, $key: &'static str, $c: &mut FieldCheck<'_, '_>) -> Option<Self> {
                $resolve
            }
        }
    };
    (
        $type:ty, $kind:ident $(($unit:expr))?, $form:ident: Option<$draft:ty>,
        may |$written:ident, $key:ident, $c:ident| $resolve:expr
    ) => {
        impl Field for $type {
            type Draft = Option<$draft>;
            const KIND: FieldKind = FieldKind::$kind $(($unit))?;
            const REQUIRED: bool = false;

            fn draft(written: Option<FieldDraft>) -> Option<Self::Draft> {
                match written {
                    None => Some(None),
                    Some(FieldDraft::$form(draft)) => Some(Some(draft)),
                    Some(_) => None,
                }
            }
        }

        impl Resolve for $type {
            fn resolve(
                $written: &Self::Draft,
                $key: &'static str,
                $c: &mut FieldCheck<'_, '_>,
            ) -> Option<Self> {
                $resolve
            }
        }
    };
}

/// An optional field, of a type that is one itself.
macro_rules! optional_field {
    ($type:ty, $kind:ident $(($unit:expr))?, $form:ident: $draft:ty) => {
        field!(Option<$type>, $kind $(($unit))?, $form: Option<$draft>, may |written, key, c| match written {
            Some(written) => <$type as Resolve>::resolve(written, key, c).map(Some),
            None => Some(None),
        });
    };
}

field!(JointId, Joint, Name: String, |name, key, c| {
    c.joint = c.check.joint(name, c.here.key(key));
    c.joint
});
field!(usize, Coordinate, Name: Option<String>, may |name, _key, c| {
    c.check.coordinate(c.joint?, name.as_deref(), c.here)
});
field!(PointId, Point, Point: PointRef, |point, key, c| c.check.point(point, c.owner, c.here.key(key)));
optional_field!(PointId, Point, Point: PointRef);
field!(Vec<PointId>, Points, Points: Vec<PointRef>, |points, key, c| {
    let found: Vec<_> = points.iter().map(|point| PointId::resolve(point, key, c)).collect();
    found.into_iter().collect()
});
field!(WheelId, Wheel, Name: String, |name, key, c| c.check.wheel_named(name, c.here.key(key)));
optional_field!(WheelId, Wheel, Name: String);
field!(ClearanceId, Clearance, Name: String, |name, key, c| c.check.clearance_named(name, c.here.key(key)));
field!(Solid, Mesh, Solid: Solid, |solid, _key, _c| Some(*solid));
field!(Option<SpringTable>, Table, Table: Option<Vec<TablePointDraft>>, may |points, key, c| match points {
    Some(points) => c.check.spring_table(points, c.owner, c.here, key).map(Some),
    None => Some(None),
});
field!(Option<MomentTable>, MomentTable, Table: Option<Vec<TablePointDraft>>, may |points, key, c| match points {
    Some(points) => c.check.spring_table(points, c.owner, c.here, key).map(|table| Some(MomentTable(table))),
    None => Some(None),
});
field!(Option<CoupledStiffness>, Matrix, Matrix: Option<Box<[[NumberDraft; 6]; 6]>>, may |rows, key, c| match rows {
    Some(rows) => c.check.coupled_stiffness(rows, c.owner, c.here, key).map(Some),
    None => Some(None),
});
field!(Vec3, Direction, Direction: Vec3, |v, key, c| {
    Some(c.check.line(&DirectionDraft::Along(*v), c.owner, c.here, key)?.1)
});
optional_field!(Vec3, Direction, Direction: Vec3);
field!(Direction, Line, Line: DirectionDraft, |line, key, c| Some(c.check.line(line, c.owner, c.here, key)?.0));
optional_field!(Direction, Line, Line: DirectionDraft);
field!(Ray, Ray, Ray: RayDraft, |ray, key, c| c.check.ray(ray, c.owner, c.here, key));
field!(OutputSource, Output, Name: String, |name, key, c| c.check.output(name, c.here.key(key)));
field!(BodyId, Body, Name: String, |name, key, c| c.check.body(name, c.here.key(key)));
optional_field!(BodyId, Body, Name: String);
field!(ReactionPart, ReactionPart, Part: ReactionPart, |part, _key, _c| Some(*part));
field!(ElasticId, Force, Name: String, |name, key, c| c.check.elastic(name, c.here.key(key)));
field!(ElasticDirection, ElasticDirection, Elastic: ElasticDirection, |direction, _key, _c| Some(*direction));
field!(ElementId, Force, Name: String, |name, key, c| c.check.force(name, c.here.key(key)));
optional_field!(ElementId, Force, Name: String);
field!(Option<Axes>, Axes, Axes: Option<Axes>, may |axes, _key, _c| Some(*axes));
field!(Option<WheelPoint>, WheelPoint, WheelPoint: Option<WheelPoint>, may |point, _key, _c| Some(*point));
field!(OrientationAngle, OrientationAngle, Angle: OrientationAngle, |angle, _key, _c| Some(*angle));
field!(DriverId, Driver, Name: Option<String>, may |name, _key, c| {
    c.check.driver_or_only(name.as_deref(), c.owner, c.here)
});
field!(Option<DriverId>, Driver, Name: Option<String>, may |name, _key, c| match name {
    Some(name) => c.check.driver_or_only(Some(name), c.owner, c.here).map(Some),
    None => Some(None),
});
field!(Vec<DriverId>, Drivers, Names: Option<Vec<String>>, may |names, key, c| {
    let found: Vec<_> = match names {
        Some(names) => names.iter().map(|name| c.check.driver_named(name, c.here.key(key))).collect(),
        None => c.check.driver_ids.clone(),
    };
    found.into_iter().collect()
});
field!(Option<Vec<DriverId>>, Drivers, Names: Option<Vec<String>>, may |names, key, c| match names {
    Some(_) => Vec::<DriverId>::resolve(names, key, c).map(Some),
    None => Some(None),
});
field!(JacobianValue, JacobianValue, Jacobian: Option<JacobianValue>, may |value, _key, _c| {
    Some(value.unwrap_or_default())
});
field!(Combination, Expression, Expression: Expression, |expression, key, c| {
    let at = c.here.key(key);
    let inputs: Vec<_> = expression.names().iter().map(|n| c.check.output(n, at.clone())).collect();
    Some(Combination {
        expression: expression.clone(),
        inputs: inputs.into_iter().map(|source| Some((source?, 1.0))).collect::<Option<_>>()?,
        per_unit: 1.0,
        dimension: Dimension::NUMBER,
    })
});

field!(Option<Law>, Law, Law: Option<Law>, may |law, _key, _c| Some(law.clone()));

macro_rules! number_field {
    ($type:ident) => {
        field!($type, Number(ElementUnit::$type), Number: NumberDraft, |number, key, c| {
            c.check.element_number(number, c.owner, key, c.here.key(key)).map($type)
        });
        optional_field!($type, Number(ElementUnit::$type), Number: NumberDraft);
    };
}
each_number!(number_field);
