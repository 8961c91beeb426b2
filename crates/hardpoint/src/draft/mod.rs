//! Drafts: mechanisms as written, with names as references, and the check that turns a draft into a model.
//!
//! [`Model::from_draft`](crate::model::Model::from_draft) checks a whole [`Draft`] at once and returns either a
//! [`Model`](crate::model::Model) or every [`DraftError`] in it.

mod build;
mod change;
mod check;
mod element;
mod error;
mod idle;
mod measure;
mod number;
mod shape;

pub use change::{ChangeDraft, ShapeDraft};
pub(crate) use check::{CheckElement, ElementCheck};
pub use check::{ConstantError, Nominal};
pub use element::{ElementDraft, ElementKindDraft, ElementType};
pub(crate) use error::short;
pub use error::{DraftError, DraftLocation, Section, did_you_mean, some_of};
use measure::not_drivable;
pub use measure::{FieldDraft, FieldKind, MeasureField, MeasureKindDraft, MeasureType};
pub use number::{NumberDraft, TablePointDraft};
pub use shape::{
    BetweenDraft, BodyShapeDraft, BodyShapeKindDraft, ClearanceDraft, EndsDraft, MinimumDraft,
    matches_pattern,
};

use std::collections::BTreeMap;

use crate::expression::Expression;
use crate::joint::{self, JointType, Quantity};
use crate::law::Law;
use crate::model::{
    AllocationRule, ChangePointPolicy, Dimension, LoadMode, Reduction, Side, SweepMethod, SweepSettings,
    ToleranceSettings, TorqueReaction, Transmission, Vehicle, VehicleEnd, WheelMeasure,
};
use crate::space::{Pose, Vec3};

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

/// Equilibrium as written.
#[derive(Clone, Debug, Default)]
pub struct EquilibriumDraft {
    /// Names of the drivers that are released.
    pub released: Vec<String>,
}

/// Entries of a draft that could not be read from its text. The check ignores the placeholders in the draft, with all
/// errors that would follow from them, and makes no model.
#[derive(Clone, Debug, Default)]
pub struct UnreadEntries(BTreeMap<(Section, usize), Vec<&'static str>>);

impl UnreadEntries {
    /// Marks a field of an entry as unread: by its name in model files, or an empty name for the whole entry. The
    /// fields of [`Section::Model`] are the tables of the file.
    pub fn note(&mut self, section: Section, index: usize, field: &'static str) {
        self.0.entry((section, index)).or_default().push(field);
    }

    /// True if a field of an entry could not be read.
    pub fn has(&self, section: Section, index: usize, field: &str) -> bool {
        self.0.get(&(section, index)).is_some_and(|fields| fields.iter().any(|f| *f == field || f.is_empty()))
    }

    /// True if any field of an entry could not be read.
    pub fn any(&self, section: Section, index: usize) -> bool {
        self.0.contains_key(&(section, index))
    }

    /// True if any field of any entry of a list could not be read.
    pub(crate) fn any_of(&self, section: Section) -> bool {
        self.0.range((section, 0)..=(section, usize::MAX)).next().is_some()
    }

    /// True if this field of any entry of a list could not be read.
    pub(crate) fn anywhere(&self, section: Section, field: &str) -> bool {
        self.0.iter().any(|((s, _), fields)| *s == section && fields.contains(&field))
    }

    /// True if all entries were read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// A named number.
#[derive(Clone, Debug)]
pub struct ParameterDraft {
    /// Name.
    pub name: String,
    /// Value: m, rad or a plain number. Ignored if a formula defines it.
    pub value: f64,
    /// Quantity of the value.
    pub quantity: Quantity,
}

/// Number of the model that is defined by an expression.
#[derive(Clone, Debug)]
pub struct FormulaDraft {
    /// Number that the formula defines.
    pub of: FormulaOf,
    /// Expression that defines it.
    pub expression: Expression,
}

/// Number that a formula can define; it overrides the number in the draft.
#[derive(Clone, Debug, PartialEq)]
pub enum FormulaOf {
    /// The value of a parameter.
    Parameter(String),
    /// A coordinate of a named hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The length of a rod.
    Length(String),
    /// Parameter of a driver's law, by the names of driver and parameter: a plain number in the units of the law's
    /// text.
    Law(String, String),
    /// Parameter of the law that a case gives a driver, by the names of case, driver and parameter.
    CaseLaw(String, String, String),
}

/// A named point.
#[derive(Clone, Debug)]
pub struct HardpointDraft {
    /// Name.
    pub name: String,
    /// Global position, m.
    pub position: Vec3,
}

/// Location: a named hardpoint, or coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum LocationDraft {
    /// A hardpoint's name.
    Hardpoint(String),
    /// Global coordinates in the design configuration, m.
    At(Vec3),
    /// Global coordinates defined by expressions.
    Formula(Box<[Expression; 3]>),
}

/// Direction of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum DirectionDraft {
    /// Along a global vector of any length.
    Along(Vec3),
    /// From one named hardpoint to another.
    Through(String, String),
}

/// A body.
#[derive(Clone, Debug)]
pub struct BodyDraft {
    /// Name.
    pub name: String,
    /// Reference frame.
    pub frame: FrameDraft,
}

/// Definition of a body's reference frame.
#[derive(Clone, Debug, Default)]
pub enum FrameDraft {
    /// Origin at the mean of the body's joint hardpoints, axes parallel to the global ones.
    #[default]
    Default,
    /// Position and orientation.
    Pose(Pose),
    /// Origin, a point on the x axis, and a point in the xy plane on the side of +y.
    Points(LocationDraft, LocationDraft, LocationDraft),
}

/// A joint.
#[derive(Clone, Debug, Default)]
pub struct JointDraft {
    /// Name.
    pub name: String,
    /// The name of its type.
    pub kind: String,
    /// Names of bodies i and j.
    pub bodies: [String; 2],
    /// Location of the joint, or its two ends for a rod or leg. If it is empty and the axis passes through hardpoints,
    /// the first of them is used. A joint with one location may have two that do not coincide, on body i and on body j:
    /// the assembly closes the gap.
    pub at: Vec<LocationDraft>,
    /// Direction of the markers' z axis.
    pub axis: Option<DirectionDraft>,
    /// Direction of the markers' x axis.
    pub axis2: Option<DirectionDraft>,
    /// Global axis (0, 1 or 2) across which the joint is the mirror image of another one. Without `axis2`, the default
    /// x axis is the image of the other joint's default.
    pub mirror: Option<usize>,
    /// Length of a rod, or distance of a follower from its curve, m. If `None`, the value of the design configuration
    /// is used.
    pub length: Option<f64>,
    /// Advance of a screw, m per turn.
    pub lead: Option<f64>,
    /// Curve on body i that a point of body j follows.
    pub curve: Option<CurveDraft>,
    /// True if the joint must be a cut joint instead of a tree joint.
    pub cut: bool,
}

/// A smooth curve through points in the design configuration, in the plane perpendicular to its joint's axis.
#[derive(Clone, Debug, Default)]
pub struct CurveDraft {
    /// Points in order. The curve of a cam is closed and does not repeat its first point.
    pub points: Vec<LocationDraft>,
    /// True if the curve is closed.
    pub closed: bool,
}

/// A coupler.
#[derive(Clone, Debug)]
pub struct CouplerDraft {
    /// Name.
    pub name: String,
    /// Relation of the coupler.
    pub kind: CouplerKindDraft,
    /// Constant value of the sum of the terms; zero for gears, racks and belts.
    pub constant: f64,
}

/// Relation of a coupler. Angles and displacements are those of body j relative to body i, positive along the axes of
/// their joints.
#[derive(Clone, Debug)]
pub enum CouplerKindDraft {
    /// `sum of coefficient x coordinate = constant`.
    Linear(Vec<TermDraft>),
    /// Two joints, each with the coordinate that the transmission couples.
    Pair {
        /// Transmission between the two coordinates.
        by: Transmission,
        /// The joints' names.
        joints: [String; 2],
    },
}

/// Joint coordinate times a coefficient.
#[derive(Clone, Debug)]
pub struct TermDraft {
    /// The joint's name.
    pub joint: String,
    /// Name of the coordinate; optional if the joint has only one.
    pub coordinate: Option<String>,
    /// Coefficient, per m or per rad of the coordinate.
    pub coefficient: f64,
}

/// A driver.
#[derive(Clone, Debug)]
pub struct DriverDraft {
    /// Name.
    pub name: String,
    /// Quantity that the driver prescribes.
    pub drives: DrivenDraft,
    /// True if the laws give the absolute value, as for measures; false if they count from the design configuration.
    pub from_zero: bool,
    /// True if the driver moves in the opposite sense of its laws.
    pub reversed: bool,
    /// Law of the prescribed quantity, m or rad.
    pub law: Law,
    /// Symbol of the unit in which laws of this driver are written, for messages; empty for a plain number.
    pub unit: &'static str,
}

/// Placement at which the assembly of a body starts.
#[derive(Clone, Debug, PartialEq)]
pub struct StartPlacementDraft {
    /// The body's name.
    pub body: String,
    /// Rotation vector of the displacement from the design configuration, about the global origin, rad.
    pub turn: Vec3,
    /// Translation after the rotation, m.
    pub shift: Vec3,
}

/// Quantity that a driver prescribes.
#[derive(Clone, Debug)]
pub enum DrivenDraft {
    /// Entry that could not be read.
    Unread,
    /// Coordinate of a joint.
    Coordinate {
        /// The joint's name.
        joint: String,
        /// Name of the coordinate; optional if the joint has only one.
        coordinate: Option<String>,
    },
    /// Displacement of a point along a global direction, m.
    Position {
        /// The point.
        point: PointRef,
        /// The direction, of any length.
        along: DirectionDraft,
    },
    /// Change of the distance between two points, m.
    Distance {
        /// First point.
        from: PointRef,
        /// Second point.
        to: PointRef,
    },
    /// Rotation angle of a body about a direction fixed in another body, rad.
    Orientation {
        /// The body's name.
        body: String,
        /// Name of the body in which the direction is fixed; ground if `None`.
        relative_to: Option<String>,
        /// The direction.
        about: DirectionDraft,
        /// Direction of the body whose angle, as seen along `about`, is prescribed; its part perpendicular to `about`
        /// counts. If `None`, one that depends on `about` alone.
        axis2: Option<DirectionDraft>,
    },
    /// Value of a measure, such as wheel travel or a steer angle.
    Measure(String),
    /// Height of the contact point of a wheel, by its name.
    Contact(String),
}

/// Quantity of a wheel measure, if a driver can prescribe it.
fn quantity_at_wheel(what: WheelMeasure) -> Option<Quantity> {
    match what.dimension() {
        Dimension::LENGTH => Some(Quantity::Length),
        Dimension::ANGLE => Some(Quantity::Angle),
        _ => None,
    }
}

impl DrivenDraft {
    /// Quantity of the driver's values, if it is known; `type_of` returns the type of a joint.
    pub fn quantity(
        &self,
        measures: &[MeasureDraft],
        type_of: impl FnOnce(&str) -> Option<&'static JointType>,
    ) -> Option<Quantity> {
        match self {
            Self::Unread => None,
            Self::Coordinate { joint, coordinate } => type_of(joint)?.quantity_of(coordinate.as_deref()),
            Self::Position { .. } => joint::TRAVEL.quantity_of(None),
            Self::Distance { .. } => joint::LEG.quantity_of(None),
            Self::Orientation { .. } => joint::HEADING.quantity_of(None),
            Self::Contact(_) => Some(Quantity::Length),
            Self::Measure(name) => match measures.iter().find(|m| m.name == *name).map(|m| &m.kind) {
                // Measures listed by a wheel, such as `WHEEL.toe`, may be added after the drivers. Their names imply
                // the quantity.
                None => quantity_at_wheel(WheelMeasure::named(name.rsplit_once('.')?.1)?),
                Some(MeasureKindDraft::Coordinate { joint, coordinate }) => {
                    type_of(joint)?.quantity_of(coordinate.as_deref())
                }
                Some(MeasureKindDraft::Distance { .. } | MeasureKindDraft::Coordinates { .. }) => {
                    Some(Quantity::Length)
                }
                Some(MeasureKindDraft::Angle { .. } | MeasureKindDraft::Toe { .. }) => Some(Quantity::Angle),
                Some(MeasureKindDraft::Wheel { what, .. }) => quantity_at_wheel(*what),
                Some(MeasureKindDraft::Unread | not_drivable!()) => None,
            },
        }
    }
}

/// A design variable.
#[derive(Clone, Debug, Default)]
pub struct VariableDraft {
    /// Name.
    pub name: String,
    /// Changes of the design per unit of the variable.
    pub changes: Vec<ChangeDraft>,
    /// True if the lengths of rods stay constant.
    pub fixed_length: bool,
    /// Lower and upper bound, m, rad or a plain number; the variable is 0 in the nominal design.
    pub bounds: Option<[f64; 2]>,
    /// Typical size of a change, used to compare variables, in the unit of the variable.
    pub typical: Option<f64>,
    /// Tolerance: half width of the deviations, in the unit of the variable.
    pub tolerance: Option<f64>,
}

/// Point of a body whose motion is computed.
#[derive(Clone, Debug)]
pub struct PointDraft {
    /// Name.
    pub name: String,
    /// Name of its body.
    pub body: String,
    /// Location in the design configuration.
    pub at: LocationDraft,
}

/// Reference to a point in a measure.
#[derive(Clone, Debug, PartialEq)]
pub enum PointRef {
    /// A point of the model, by name.
    Named(String),
    /// Location on a body.
    On {
        /// The body's name.
        body: String,
        /// Location.
        at: LocationDraft,
    },
}

/// A road wheel; see [`Wheel`](crate::model::Wheel).
#[derive(Clone, Debug)]
pub struct WheelDraft {
    /// Name.
    pub name: String,
    /// Name of the body that carries the wheel.
    pub body: String,
    /// Centre in the design configuration.
    pub centre: LocationDraft,
    /// Orientation in the design configuration.
    pub spin: WheelSpinDraft,
    /// Distance from the centre to the ground in the wheel plane, m.
    pub radius: f64,
    /// Side of the vehicle; if `None`, the side of the centre.
    pub side: Option<Side>,
    /// Lower and upper point of the kingpin axis.
    pub kingpin: Option<[PointRef; 2]>,
    /// Name of the driver that moves the wheel up and down; optional if there is only one driver.
    pub bump: Option<String>,
    /// Name of the driver that steers the wheel.
    pub steer: Option<String>,
    /// Planes of the lower and the upper arm: each through two pivots and a ball joint, or through a strut's top mount
    /// and perpendicular to its axis.
    pub planes: Option<[Vec<PointRef>; 2]>,
    /// Ends of its spring.
    pub spring: Option<[PointRef; 2]>,
    /// End of the vehicle.
    pub end: Option<VehicleEnd>,
    /// Reaction of the drive torque. If `None`: outboard on a body that carries wheels of both sides (a live axle),
    /// otherwise inboard.
    pub drive: Option<TorqueReaction>,
    /// Reaction of the brake torque; outboard if `None`.
    pub brakes: Option<TorqueReaction>,
}

/// Two wheels side by side; see [`Axle`](crate::model::Axle).
#[derive(Clone, Debug)]
pub struct AxleDraft {
    /// Name.
    pub name: String,
    /// The name of the left wheel.
    pub left: String,
    /// The name of the right wheel.
    pub right: String,
}

/// Orientation of a wheel in the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum WheelSpinDraft {
    /// Spin axis, pointing outboard.
    Axis(DirectionDraft),
    /// Alignment angles, rad.
    Angles {
        /// Positive for toe-in.
        toe: f64,
        /// Positive if the top leans outboard.
        camber: f64,
    },
}

/// A measure.
#[derive(Clone, Debug)]
pub struct MeasureDraft {
    /// Name.
    pub name: String,
    /// Kind of the measure.
    pub kind: MeasureKindDraft,
}

/// A limit of a joint; see [`JointLimit`](crate::model::JointLimit). A measure has its name.
#[derive(Clone, Debug)]
pub struct JointLimitDraft {
    /// Name of the joint.
    pub joint: String,
    /// Name of its coordinate, or [`JointLimitDraft::ARTICULATION`].
    pub of: String,
    /// Lower end, m or rad.
    pub min: Option<f64>,
    /// Upper end, m or rad.
    pub max: Option<f64>,
    /// True if the motion ends where the limit is reached.
    pub stop: bool,
}

impl JointLimitDraft {
    /// Word for the articulation of a joint, in place of a coordinate.
    pub const ARTICULATION: &'static str = "articulation";

    /// Name of the limit, and of its measure.
    pub fn name(&self) -> String {
        format!("{}.{}", self.joint, self.of)
    }

    /// Measure of the limit; `axis` is that of an articulation.
    pub fn measure(&self, axis: Option<DirectionDraft>) -> MeasureDraft {
        let joint = self.joint.clone();
        let kind = match self.of == Self::ARTICULATION {
            true => MeasureKindDraft::Articulation { joint, axis },
            false => MeasureKindDraft::Coordinate { joint, coordinate: Some(self.of.clone()) },
        };
        MeasureDraft { name: self.name(), kind }
    }
}

/// A metric; see [`Metric`](crate::model::Metric). Its numbers are in user units, because their dimension follows from
/// the measures.
#[derive(Clone, Debug)]
pub struct MetricDraft {
    /// Name.
    pub name: String,
    /// Name of a measure, or of a component of a point.
    pub of: String,
    /// Name of the abscissa, likewise; time if `None`.
    pub over: Option<String>,
    /// Reduction of the curve.
    pub take: Reduction,
    /// Range of the abscissa that is evaluated.
    pub window: Option<[f64; 2]>,
    /// Name of the case that is evaluated; all cases if `None`.
    pub case: Option<String>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
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

/// One of several motions; see [`Case`](crate::model::Case).
#[derive(Clone, Debug, Default)]
pub struct CaseDraft {
    /// Name.
    pub name: String,
    /// Names of drivers, and their laws in this case, m or rad.
    pub laws: Vec<(String, Law)>,
    /// Motion of all other drivers.
    pub rest: OtherDrivers,
    /// Output times, s; those of the draft if `None`.
    pub times: Option<Vec<f64>>,
    /// Loads with or without inertia; the mode of the draft if `None`.
    pub load_mode: Option<LoadMode>,
}

/// A case that sweeps two drivers over a grid; see [`Grid`](crate::model::Grid).
#[derive(Clone, Debug, Default)]
pub struct GridDraft {
    /// Name.
    pub name: String,
    /// Names of two drivers, and the positions of each, from the design configuration, m or rad.
    pub sweeps: Vec<(String, Vec<f64>)>,
}

/// Motion of the drivers that a case does not name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OtherDrivers {
    /// Fixed in the design configuration.
    #[default]
    Held,
    /// Own laws, as in the model.
    AsAbove,
}

/// Settings of an optimisation; see [`OptimizationSettings`](crate::model::OptimizationSettings).
#[derive(Clone, Debug)]
pub struct OptimizationSettingsDraft {
    /// Names of the optimised design variables; all that have bounds if `None`.
    pub variables: Option<Vec<String>>,
    /// Goals; their sum is minimised.
    pub goals: Vec<GoalDraft>,
    /// Conditions that the design must satisfy.
    pub limits: Vec<LimitDraft>,
    /// Minimum margin of every motion from singular positions, between 0 and 1.
    pub margin: Option<f64>,
    /// Number of starting designs.
    pub starts: usize,
    /// True if the searches also start from the other assemblies of the mechanism.
    pub other_assemblies: bool,
    /// True if the searches also start with all drivers in the opposite sense.
    pub both_senses: bool,
    /// Maximum number of iterations per start.
    pub iterations: usize,
    /// Names of the goals of a trade-off; empty for all of them.
    pub trade_off: Vec<String>,
}

impl Default for OptimizationSettingsDraft {
    fn default() -> Self {
        let (goals, limits, trade_off) = (Vec::new(), Vec::new(), Vec::new());
        Self {
            variables: None,
            goals,
            limits,
            margin: None,
            starts: 1,
            other_assemblies: false,
            both_senses: false,
            iterations: 100,
            trade_off,
        }
    }
}

/// A goal; see [`Goal`](crate::model::Goal). Its numbers are in user units, because their dimension follows from the
/// metric.
#[derive(Clone, Debug)]
pub struct GoalDraft {
    /// Name.
    pub name: String,
    /// The name of the metric.
    pub metric: String,
    /// Weight of one unit of the metric.
    pub weight: f64,
    /// Target value.
    pub target: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// A limit; see [`Limit`](crate::model::Limit). Its numbers are in user units.
#[derive(Clone, Debug)]
pub struct LimitDraft {
    /// Name.
    pub name: String,
    /// Limited quantity.
    pub of: LimitTargetDraft,
    /// Lower bound; equal to `most` for an equality.
    pub least: Option<f64>,
    /// Upper bound.
    pub most: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Quantity that a limit applies to; see [`LimitTarget`](crate::model::LimitTarget). References are names.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitTargetDraft {
    /// Entry that could not be read.
    Unread,
    /// A metric.
    Metric(String),
    /// A coordinate of a hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The distance of two hardpoints.
    Distance([String; 2]),
    /// Length of a rod or leg: the given length, or the distance between its ends in the design configuration.
    Length(String),
}

/// Settings of a tolerance study; see [`ToleranceSettings`].
#[derive(Clone, Debug)]
pub struct ToleranceSettingsDraft {
    /// Tolerances of single variables, by their names or by the name of the entry that defines them. All other
    /// variables with a [tolerance](VariableDraft::tolerance) are added.
    pub tolerances: Vec<ToleranceDraft>,
    /// Correlations of the variables.
    pub correlations: Vec<CorrelationDraft>,
    /// Limits of metrics.
    pub limits: Vec<LimitDraft>,
    /// Names of the metrics; all if `None`.
    pub metrics: Option<Vec<String>>,
    /// Names of the measures; all if `None`.
    pub curves: Option<Vec<String>>,
    /// Default distribution of deviations.
    pub scatter: ScatterDraft,
    /// Number of Monte Carlo designs.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Rule of the tolerance allocation, if requested.
    pub allocation: Option<AllocationRule>,
}

impl Default for ToleranceSettingsDraft {
    fn default() -> Self {
        Self {
            tolerances: Vec::new(),
            correlations: Vec::new(),
            limits: Vec::new(),
            metrics: None,
            curves: None,
            scatter: ScatterDraft::default(),
            samples: ToleranceSettings::SAMPLES,
            seed: ToleranceSettings::SEED,
            allocation: None,
        }
    }
}

/// Distribution of deviations, as far as given; see [`Scatter`](crate::model::Scatter).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScatterDraft {
    /// Index in [`Scatter::NAMES`](crate::model::Scatter::NAMES).
    pub kind: Option<usize>,
    /// Number of standard deviations in the tolerance.
    pub sigmas: Option<f64>,
}

/// A tolerance; see [`Tolerance`](crate::model::Tolerance). Its reach is in user units.
#[derive(Clone, Debug)]
pub struct ToleranceDraft {
    /// Name of a design variable, or the common part of several before `_x`, `_y`, `_z`.
    pub name: String,
    /// Half width of the deviations; the variable's own tolerance if `None`.
    pub reach: Option<f64>,
    /// Distribution of the deviations.
    pub scatter: ScatterDraft,
    /// Relative cost of the tolerance.
    pub cost: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// A correlation; see [`Correlation`](crate::model::Correlation).
#[derive(Clone, Debug)]
pub struct CorrelationDraft {
    /// Name.
    pub name: String,
    /// The names of two design variables.
    pub between: [String; 2],
    /// Their coefficient.
    pub coefficient: f64,
}

/// Settings of a calibration; see [`CalibrationSettings`](crate::model::CalibrationSettings).
#[derive(Clone, Debug, Default)]
pub struct CalibrationSettingsDraft {
    /// Names of the fitted variables; all if `None`.
    pub fitted: Option<Vec<String>>,
    /// Priors of variables.
    pub priors: Vec<PriorDraft>,
    /// True if the tolerances of variables are the priors of all others.
    pub tolerance_priors: bool,
    /// Groups of variables with a common deviation.
    pub groups: Vec<PriorGroupDraft>,
    /// Fitted offsets.
    pub offsets: Vec<OffsetDraft>,
}

/// Gaussian prior of a variable; see [`VariablePrior`](crate::model::VariablePrior). In user units.
#[derive(Clone, Debug)]
pub struct PriorDraft {
    /// Name of the design variable.
    pub name: String,
    /// Standard deviation.
    pub sigma: f64,
    /// Mean of its value; the nominal value if `None`.
    pub mean: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Group of variables with a common deviation; see [`PriorGroup`](crate::model::PriorGroup). In user units.
#[derive(Clone, Debug)]
pub struct PriorGroupDraft {
    /// Name.
    pub name: String,
    /// Names of its members.
    pub variables: Vec<String>,
    /// Standard deviation of a member from the common deviation.
    pub within: f64,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Offset of a driver or an output; see [`Offset`](crate::model::Offset). In user units.
#[derive(Clone, Debug)]
pub struct OffsetDraft {
    /// Name of the driver or output.
    pub name: String,
    /// Standard deviation of its prior about 0; `None` without a prior.
    pub sigma: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Settings of a sweep; see [`SweepSettings`].
#[derive(Clone, Debug)]
pub struct SweepSettingsDraft {
    /// Method that chooses the designs, if given.
    pub method: Option<SweepMethod>,
    /// Ranges of the variables; if `None`, the bounds of all variables that have bounds.
    pub ranges: Option<Vec<SweepRangeDraft>>,
    /// List of designs, which replaces the method and the ranges.
    pub designs: Option<DesignListDraft>,
    /// Number of levels of a factorial for variables without their own.
    pub levels: usize,
    /// Number of designs.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Names of the metrics; all if `None`.
    pub metrics: Option<Vec<String>>,
    /// Names of the measures whose curves are stored.
    pub curves: Vec<String>,
}

impl Default for SweepSettingsDraft {
    fn default() -> Self {
        Self {
            method: None,
            ranges: None,
            designs: None,
            levels: SweepSettings::LEVELS,
            samples: SweepSettings::SAMPLES,
            seed: SweepSettings::SEED,
            metrics: None,
            curves: Vec::new(),
        }
    }
}

/// A plot; see [`Plot`](crate::model::Plot).
#[derive(Clone, Debug)]
pub struct PlotDraft {
    /// Names of the outputs on the ordinate.
    pub y: Vec<String>,
    /// Name of the output on the abscissa, or [`TIME`](Self::TIME).
    pub over: String,
}

impl PlotDraft {
    /// Abscissa of a plot over time, unless a measure has that name.
    pub const TIME: &'static str = "time";
}

/// A named design; see [`NamedDesign`](crate::model::NamedDesign).
#[derive(Clone, Debug)]
pub struct NamedDesignDraft {
    /// Name.
    pub name: String,
    /// Names of variables with their values in user units; those of a parameter are values of the parameter.
    pub values: Vec<(String, f64)>,
    /// Length units of the file per metre.
    pub per_metre: f64,
    /// Angle units of the file per radian.
    pub per_radian: f64,
}

/// A range of a variable; see [`SweepRange`](crate::model::SweepRange). Its ends are in user units; those of a
/// parameter are values of the parameter.
#[derive(Clone, Debug)]
pub struct SweepRangeDraft {
    /// The variable's name.
    pub name: String,
    /// Lower end; the variable's lower bound if left out.
    pub low: Option<f64>,
    /// Upper end; the variable's upper bound if left out.
    pub high: Option<f64>,
    /// Number of levels in a factorial.
    pub levels: Option<usize>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Designs listed in a file, with values as in a range.
#[derive(Clone, Debug)]
pub struct DesignListDraft {
    /// Name of the file.
    pub file: String,
    /// Name of the variable of each column.
    pub names: Vec<String>,
    /// Values of each design.
    pub rows: Vec<Vec<f64>>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}
