//! Drafts: mechanisms as written, with names as references, and the check that turns a draft into a model.
//!
//! [`Model::from_draft`](crate::model::Model::from_draft) checks a whole [`Draft`] at once and returns either a
//! [`Model`](crate::model::Model) or every [`DraftError`] in it.

mod body;
mod build;
mod calibrating;
mod case;
mod change;
mod check;
mod coupler;
mod driver;
mod element;
mod error;
mod formula;
mod idle;
mod joint;
mod joint_limit;
mod location;
mod measure;
mod mechanism;
mod metric;
mod number;
mod optimization;
mod page;
mod shape;
mod sweeping;
mod tolerancing;
mod unread;
mod variable;
mod wheel;

pub use body::{BodyDraft, FrameDraft, StartPlacementDraft};
pub use calibrating::{CalibrationSettingsDraft, OffsetDraft, PriorDraft, PriorGroupDraft};
pub use case::{CaseDraft, GridDraft, OtherDrivers};
pub use change::{ChangeDraft, ShapeDraft};
pub(crate) use check::{CheckElement, ElementCheck, StiffnessRule};
pub use check::{ConstantError, Nominal};
pub use coupler::{CouplerDraft, CouplerKindDraft, TermDraft};
pub use driver::{DrivenDraft, DriverDraft, EquilibriumDraft};
pub use element::{ElementDraft, ElementKindDraft, ElementType};
pub use error::{DraftError, DraftLocation, Section, did_you_mean, some_of};
pub(crate) use error::{short, with_digits};
pub use formula::{FormulaDraft, FormulaOf, ParameterDraft};
pub use joint::{CurveDraft, JointDraft};
pub use joint_limit::JointLimitDraft;
pub use location::{DirectionDraft, HardpointDraft, LocationDraft, PointDraft, PointRef};
pub use measure::{
    FieldDraft, FieldKind, MeasureDraft, MeasureField, MeasureKindDraft, MeasureType, RayDraft,
};
pub use mechanism::Draft;
pub use metric::MetricDraft;
pub use number::{NumberDraft, TablePointDraft};
pub use optimization::{GoalDraft, LimitDraft, LimitTargetDraft, OptimizationSettingsDraft};
pub use page::{NamedDesignDraft, PlotDraft};
pub use shape::{
    BetweenDraft, BodyShapeDraft, BodyShapeKindDraft, ClearanceDraft, EndsDraft, MinimumDraft,
    matches_pattern,
};
pub use sweeping::{DesignListDraft, SweepRangeDraft, SweepSettingsDraft};
pub use tolerancing::{CorrelationDraft, ScatterDraft, ToleranceDraft, ToleranceSettingsDraft};
pub use unread::UnreadEntries;
pub use variable::VariableDraft;
pub use wheel::{AxleDraft, WheelDraft, WheelSpinDraft};
