//! The whole draft.

use crate::model::{ChangePointPolicy, LoadMode, Vehicle};
use crate::space::Vec3;

use super::{
    AxleDraft, BodyDraft, BodyShapeDraft, CalibrationSettingsDraft, CaseDraft, ClearanceDraft, CouplerDraft,
    DriverDraft, ElementDraft, EquilibriumDraft, FormulaDraft, GridDraft, HardpointDraft, JointDraft,
    JointLimitDraft, MeasureDraft, MetricDraft, NamedDesignDraft, OptimizationSettingsDraft, ParameterDraft,
    PlotDraft, PointDraft, StartPlacementDraft, SweepSettingsDraft, ToleranceSettingsDraft, UnreadEntries,
    VariableDraft, WheelDraft,
};

/// Mechanism as written, with names as references. Fill it in code, with builder methods or field by field, or from a
/// file; [`Model::from_draft`](crate::model::Model::from_draft) checks it.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// Name of the mechanism.
    pub name: String,
    /// Named numbers for formulas.
    pub parameters: Vec<ParameterDraft>,
    /// Numbers defined by expressions over parameters and coordinates of hardpoints.
    pub formulas: Vec<FormulaDraft>,
    /// Named points of the design configuration.
    pub hardpoints: Vec<HardpointDraft>,
    /// Bodies other than `ground`, which is predefined.
    pub bodies: Vec<BodyDraft>,
    /// Joints.
    pub joints: Vec<JointDraft>,
    /// Couplers between joint coordinates.
    pub couplers: Vec<CouplerDraft>,
    /// Drivers.
    pub drivers: Vec<DriverDraft>,
    /// Placements at which the assembly starts, of bodies that do not start in the design configuration.
    pub start: Vec<StartPlacementDraft>,
    /// Design variables.
    pub design: Vec<VariableDraft>,
    /// Points to follow.
    pub points: Vec<PointDraft>,
    /// Road wheels.
    pub wheels: Vec<WheelDraft>,
    /// Data of the vehicle that the wheels belong to, as far as given.
    pub vehicle: Vehicle,
    /// Pairs of wheels.
    pub axles: Vec<AxleDraft>,
    /// Shapes of bodies.
    pub shapes: Vec<BodyShapeDraft>,
    /// Clearances between shapes.
    pub clearances: Vec<ClearanceDraft>,
    /// Masses.
    pub masses: Vec<ElementDraft>,
    /// Forces.
    pub forces: Vec<ElementDraft>,
    /// Acceleration of gravity, m/s^2, global.
    pub gravity: Vec3,
    /// Loads with or without inertia.
    pub load_mode: LoadMode,
    /// Equilibrium of elastic joints and released drivers, if they open under load.
    pub equilibrium: Option<EquilibriumDraft>,
    /// Measures.
    pub measures: Vec<MeasureDraft>,
    /// Limits of joints.
    pub joint_limits: Vec<JointLimitDraft>,
    /// Metrics.
    pub metrics: Vec<MetricDraft>,
    /// Output times, s.
    pub times: Vec<f64>,
    /// Behaviour at change points.
    pub at_change_points: ChangePointPolicy,
    /// Cases (motions), instead of the single motion of the drivers' own laws over these times.
    pub cases: Vec<CaseDraft>,
    /// Cases that sweep two drivers over a grid.
    pub grids: Vec<GridDraft>,
    /// Settings of the optimisation.
    pub optimization: Option<OptimizationSettingsDraft>,
    /// Settings of the tolerance study.
    pub tolerancing: Option<ToleranceSettingsDraft>,
    /// Settings of the sweep.
    pub sweeping: Option<SweepSettingsDraft>,
    /// Settings of the calibration.
    pub calibrating: Option<CalibrationSettingsDraft>,
    /// Plots that a page opens with.
    pub plots: Vec<PlotDraft>,
    /// Named designs.
    pub designs: Vec<NamedDesignDraft>,
    /// Entries that could not be read.
    pub unread: UnreadEntries,
}
