//! A mechanism as somebody wrote it, with names as references, and the check that makes a model of it.
//!
//! [`Model::from_draft`](crate::model::Model::from_draft) checks all of a [`Draft`] at once and gives either a
//! [`Model`](crate::model::Model) or every [`DraftError`] that it found.

mod build;
mod change;
mod check;
mod element;
mod error;
mod idle;
mod measure;

pub use change::{ChangeDraft, ShapeDraft};
pub use check::{ConstantError, Nominal};
pub use element::{ElementDraft, ElementKindDraft, ElementType, NumberDraft};
pub use error::{DraftError, DraftLocation, Section, did_you_mean, some_of};
pub use measure::{FieldDraft, FieldKind, MeasureField, MeasureKindDraft, MeasureType};

use std::collections::BTreeMap;

use crate::expression::Expression;
use crate::joint::{self, JointType, Quantity};
use crate::law::Law;
use crate::model::{
    AllocationRule, ChangePointPolicy, Dimension, LoadMode, Reduction, Side, SweepMethod, SweepSettings,
    ToleranceSettings, TorqueReaction, Transmission, Vehicle, VehicleEnd, WheelMeasure,
};
use crate::space::{Pose, Vec3};

/// A mechanism as written. Fill it in code, word by word or field by field, or from a file;
/// [`Model::from_draft`](crate::model::Model::from_draft) checks it.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// The mechanism's name.
    pub name: String,
    /// Named numbers for formulas.
    pub parameters: Vec<ParameterDraft>,
    /// Numbers that are written as expressions over parameters and coordinates of hardpoints.
    pub formulas: Vec<FormulaDraft>,
    /// Named points of the design configuration.
    pub hardpoints: Vec<HardpointDraft>,
    /// Bodies other than `ground`, which is always there.
    pub bodies: Vec<BodyDraft>,
    /// Joints.
    pub joints: Vec<JointDraft>,
    /// Couplers between joint coordinates.
    pub couplers: Vec<CouplerDraft>,
    /// Drivers.
    pub drivers: Vec<DriverDraft>,
    /// Design variables.
    pub design: Vec<VariableDraft>,
    /// Points to follow.
    pub points: Vec<PointDraft>,
    /// Road wheels.
    pub wheels: Vec<WheelDraft>,
    /// The vehicle that the wheels belong to, as far as it is known.
    pub vehicle: Vehicle,
    /// Pairs of wheels.
    pub axles: Vec<AxleDraft>,
    /// Masses.
    pub masses: Vec<ElementDraft>,
    /// Forces.
    pub forces: Vec<ElementDraft>,
    /// Acceleration of gravity, m/s^2, global.
    pub gravity: Vec3,
    /// Loads with or without inertia.
    pub load_mode: LoadMode,
    /// Measures.
    pub measures: Vec<MeasureDraft>,
    /// Metrics.
    pub metrics: Vec<MetricDraft>,
    /// Output times, s.
    pub times: Vec<f64>,
    /// Behaviour at change points.
    pub at_change_points: ChangePointPolicy,
    /// Several motions, in place of the one that the drivers' own laws and these times make.
    pub cases: Vec<CaseDraft>,
    /// Cases that sweep two drivers over a grid.
    pub grids: Vec<GridDraft>,
    /// Settings of the optimisation.
    pub optimization: Option<OptimizationSettingsDraft>,
    /// Settings of the tolerance study.
    pub tolerancing: Option<ToleranceSettingsDraft>,
    /// Settings of the sweep, if the file has them.
    pub sweeping: Option<SweepSettingsDraft>,
    /// Entries that could not be read.
    pub unread: UnreadEntries,
}

/// Entries of a draft that could not be read from its text. The check ignores the placeholders in the draft, with all
/// errors that would follow from them, and makes no model.
#[derive(Clone, Debug, Default)]
pub struct UnreadEntries(BTreeMap<(Section, usize), Vec<&'static str>>);

impl UnreadEntries {
    /// Notes that a field of an entry could not be read: by its name in model files, an empty one for the entry as a
    /// whole. Of [`Section::Model`] the fields are the tables of the file.
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

    /// True if that field could not be read of any entry of a list.
    pub(crate) fn anywhere(&self, section: Section, field: &str) -> bool {
        self.0.iter().any(|((s, _), fields)| *s == section && fields.contains(&field))
    }

    /// True if there is nothing.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// A named number.
#[derive(Clone, Debug)]
pub struct ParameterDraft {
    /// Name.
    pub name: String,
    /// Value, m, rad or a plain number; of no account where a formula gives it.
    pub value: f64,
    /// Quantity of the value.
    pub quantity: Quantity,
}

/// A number of the model that an expression gives.
#[derive(Clone, Debug)]
pub struct FormulaDraft {
    /// Number that the formula defines.
    pub of: FormulaOf,
    /// Expression that defines it.
    pub expression: Expression,
}

/// A number that a formula may give, in place of what the draft says itself.
#[derive(Clone, Debug, PartialEq)]
pub enum FormulaOf {
    /// The value of a parameter.
    Parameter(String),
    /// A coordinate of a named hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The length of a rod.
    Length(String),
    /// A parameter of a driver's law, by the names of both: a plain number, as the law's text means it.
    Law(String, String),
    /// The same of the law that a case gives a driver, by the names of case, driver and parameter.
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
    /// Global coordinates that expressions give.
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
    /// Place, or its two places for a rod or leg. May be empty where the axis passes through
    /// hardpoints: then it is the first of them. A joint with one place may be given two that lie apart, on body i and
    /// on body j, for the mechanism to be assembled there.
    pub at: Vec<LocationDraft>,
    /// Direction of the markers' z axis.
    pub axis: Option<DirectionDraft>,
    /// Direction of the markers' x axis.
    pub axis2: Option<DirectionDraft>,
    /// The global axis (0, 1 or 2) across which it is the mirror image of another joint: where `axis2` is not given,
    /// its default is the image of that joint's default.
    pub mirror: Option<usize>,
    /// Length of a rod, or a follower's distance from its curve, m; else it is measured between its places.
    pub length: Option<f64>,
    /// Advance of a screw, m per turn.
    pub lead: Option<f64>,
    /// The curve on body i that a point of body j follows.
    pub curve: Option<CurveDraft>,
    /// True if it should be cut rather than carry the tree.
    pub cut: bool,
}

/// A smooth curve through points in the design configuration, in the plane perpendicular to its joint's axis.
#[derive(Clone, Debug, Default)]
pub struct CurveDraft {
    /// The points, in order; the curve of a cam is closed and does not repeat the first one.
    pub points: Vec<LocationDraft>,
    /// True if it returns to its first point.
    pub closed: bool,
}

/// A coupler.
#[derive(Clone, Debug)]
pub struct CouplerDraft {
    /// Name.
    pub name: String,
    /// Relation of the coupler.
    pub kind: CouplerKindDraft,
    /// Value of the sum of its terms; zero for gears, racks and belts.
    pub constant: f64,
}

/// Relation of a coupler. Angles and displacements count along the axes of their joints, body j relative to body i.
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

/// A joint coordinate times a number.
#[derive(Clone, Debug)]
pub struct TermDraft {
    /// The joint's name.
    pub joint: String,
    /// The coordinate's name; may be left out where the joint has only one.
    pub coordinate: Option<String>,
    /// The factor, per m or per rad of the coordinate.
    pub coefficient: f64,
}

/// A driver.
#[derive(Clone, Debug)]
pub struct DriverDraft {
    /// Name.
    pub name: String,
    /// Quantity that the driver prescribes.
    pub drives: DrivenDraft,
    /// True if its laws count from zero, as those of measures do; else they count from the design configuration.
    pub from_zero: bool,
    /// Law of the prescribed quantity, m or rad.
    pub law: Law,
}

/// Quantity that a driver prescribes.
#[derive(Clone, Debug)]
pub enum DrivenDraft {
    /// It could not be read.
    Unread,
    /// A joint's coordinate.
    Coordinate {
        /// The joint's name.
        joint: String,
        /// The coordinate's name; may be left out where the joint has only one.
        coordinate: Option<String>,
    },
    /// The way of a point along a global direction.
    Position {
        /// The point.
        point: PointRef,
        /// The direction, of any length.
        along: DirectionDraft,
    },
    /// The change of the distance between two points.
    Distance {
        /// From this point.
        from: PointRef,
        /// To this one.
        to: PointRef,
    },
    /// The angle by which a body has turned, seen along a direction fixed in another.
    Orientation {
        /// The body's name.
        body: String,
        /// The body that carries the direction; ground if left out.
        relative_to: Option<String>,
        /// The direction.
        about: DirectionDraft,
    },
    /// The value of a measure, like wheel travel or a steer angle.
    Measure(String),
}

/// Quantity of a measure of a wheel, if a driver may have it.
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
            Self::Measure(name) => match measures.iter().find(|m| m.name == *name).map(|m| &m.kind) {
                // The measures that a wheel lists, `WHEEL.toe`, may be added after the drivers: their names say what
                // they are.
                None => quantity_at_wheel(WheelMeasure::named(name.rsplit_once('.')?.1)?),
                Some(MeasureKindDraft::Coordinate { joint, coordinate }) => {
                    type_of(joint)?.quantity_of(coordinate.as_deref())
                }
                Some(MeasureKindDraft::Distance { .. } | MeasureKindDraft::Coordinates { .. }) => {
                    Some(Quantity::Length)
                }
                Some(MeasureKindDraft::Angle { .. } | MeasureKindDraft::Toe { .. }) => Some(Quantity::Angle),
                Some(MeasureKindDraft::Wheel { what, .. }) => quantity_at_wheel(*what),
                Some(_) => None,
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
    /// True if rods keep their lengths.
    pub fixed_length: bool,
    /// Between which values it may lie, m, rad or a plain number; it is 0 in the model in the design configuration.
    pub bounds: Option<[f64; 2]>,
    /// Typical size of a change, used to compare variables.
    pub typical: Option<f64>,
    /// By how much it may be off when it is made, either way.
    pub tolerance: Option<f64>,
}

/// A point to follow.
#[derive(Clone, Debug)]
pub struct PointDraft {
    /// Name.
    pub name: String,
    /// The name of the body that carries it.
    pub body: String,
    /// Location in the design configuration.
    pub at: LocationDraft,
}

/// A point as a measure names it.
#[derive(Clone, Debug, PartialEq)]
pub enum PointRef {
    /// A point of the model, by name.
    Named(String),
    /// A place on a body.
    On {
        /// The body's name.
        body: String,
        /// The place.
        at: LocationDraft,
    },
}

/// A road wheel; see [`Wheel`](crate::model::Wheel).
#[derive(Clone, Debug)]
pub struct WheelDraft {
    /// Name.
    pub name: String,
    /// The name of the body that it turns on.
    pub body: String,
    /// Centre in the design configuration.
    pub centre: LocationDraft,
    /// Orientation in the design configuration.
    pub spin: WheelSpinDraft,
    /// From the centre to the ground in the wheel's plane, m.
    pub radius: f64,
    /// On which side of the vehicle it is; where it is left out, the side of its centre.
    pub side: Option<Side>,
    /// A lower and an upper point of the axis that it steers about.
    pub kingpin: Option<[PointRef; 2]>,
    /// The name of the driver that moves it up and down; may be left out where there is only one.
    pub bump: Option<String>,
    /// The name of the driver that steers it.
    pub steer: Option<String>,
    /// The planes of the lower and the upper arm: each by two pivots and a ball joint, or by a strut's top mount and
    /// another point of its axis.
    pub planes: Option<[Vec<PointRef>; 2]>,
    /// The ends of its spring.
    pub spring: Option<[PointRef; 2]>,
    /// At which end of the vehicle it is.
    pub end: Option<VehicleEnd>,
    /// Place where its drive torque is reacted; where it is left out, outboard on a body that carries wheels of both
    /// sides (a live axle), else inboard.
    pub drive: Option<TorqueReaction>,
    /// Place where its brake torque is reacted; where it is left out, outboard.
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
    /// With this spin axis, pointing outboard.
    Axis(DirectionDraft),
    /// At these angles, rad.
    Angles {
        /// Positive for toe-in.
        toe: f64,
        /// Positive where its top leans outboard.
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

/// A metric; see [`Metric`](crate::model::Metric). Its numbers are in units of which that many make a metre or a
/// radian, since what they measure follows from the measures.
#[derive(Clone, Debug)]
pub struct MetricDraft {
    /// Name.
    pub name: String,
    /// The name of the measure, or of a point's component.
    pub of: String,
    /// The same of the abscissa; time where it is left out.
    pub over: Option<String>,
    /// Reduction of the curve.
    pub take: Reduction,
    /// The part of the curve that counts.
    pub window: Option<[f64; 2]>,
    /// The name of the case whose motion it sums up; each where it is left out.
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
    /// The names of drivers, and the laws that they follow in it, in m or rad.
    pub laws: Vec<(String, Law)>,
    /// Motion of all other drivers.
    pub rest: OtherDrivers,
    /// Output times, s; those of the draft where they are left out.
    pub times: Option<Vec<f64>>,
    /// Loads with or without inertia; those of the draft where there is none.
    pub load_mode: Option<LoadMode>,
}

/// A case that sweeps two drivers over a grid; see [`Grid`](crate::model::Grid).
#[derive(Clone, Debug, Default)]
pub struct GridDraft {
    /// Name.
    pub name: String,
    /// The names of two drivers, and where each of them is, counted from the drawing, in m or rad.
    pub sweeps: Vec<(String, Vec<f64>)>,
}

/// Motion of the drivers that a case does not name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OtherDrivers {
    /// They are fixed in the design configuration.
    #[default]
    Held,
    /// They follow their own laws.
    AsAbove,
}

/// Settings of an optimisation; see [`OptimizationSettings`](crate::model::OptimizationSettings).
#[derive(Clone, Debug)]
pub struct OptimizationSettingsDraft {
    /// The names of the design variables that may change; all that have bounds where they are left out.
    pub variables: Option<Vec<String>>,
    /// Goals; their sum is minimised.
    pub goals: Vec<GoalDraft>,
    /// Conditions that the design must satisfy.
    pub limits: Vec<LimitDraft>,
    /// Minimum margin of every motion from singular positions, between 0 and 1.
    pub margin: Option<f64>,
    /// From how many designs the search starts.
    pub starts: usize,
    /// After that many iterations a search ends.
    pub iterations: usize,
}

impl Default for OptimizationSettingsDraft {
    fn default() -> Self {
        let (goals, limits) = (Vec::new(), Vec::new());
        Self { variables: None, goals, limits, margin: None, starts: 1, iterations: 100 }
    }
}

/// A goal; see [`Goal`](crate::model::Goal). Its numbers are in units of which that many make a metre or a radian,
/// since what they measure follows from the metric.
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

/// A limit; see [`Limit`](crate::model::Limit). Its numbers are in units of which that many make a metre or a radian.
#[derive(Clone, Debug)]
pub struct LimitDraft {
    /// Name.
    pub name: String,
    /// Limited quantity.
    pub of: LimitTargetDraft,
    /// It must not be less than this; equal to `most` where it must have one value.
    pub least: Option<f64>,
    /// It must not be more than this.
    pub most: Option<f64>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Quantity that a limit applies to; see [`LimitTarget`](crate::model::LimitTarget). References are names.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitTargetDraft {
    /// It could not be read.
    Unread,
    /// A metric.
    Metric(String),
    /// A coordinate of a hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(String, usize),
    /// The distance of two hardpoints.
    Distance([String; 2]),
    /// The length of a rod or leg, between its places in the design configuration or as it is given.
    Length(String),
}

/// Settings of a tolerance study; see [`ToleranceSettings`](crate::model::ToleranceSettings).
#[derive(Clone, Debug)]
pub struct ToleranceSettingsDraft {
    /// Tolerances of single variables, by their names or by the name of the entry that defines them. All other
    /// variables with a [tolerance](VariableDraft::tolerance) are added.
    pub tolerances: Vec<ToleranceDraft>,
    /// Correlations of the variables.
    pub correlations: Vec<CorrelationDraft>,
    /// Limits of metrics.
    pub limits: Vec<LimitDraft>,
    /// The names of the metrics; all of them where they are left out.
    pub metrics: Option<Vec<String>>,
    /// The names of the measures; all of them where they are left out.
    pub curves: Option<Vec<String>>,
    /// Default distribution of deviations.
    pub scatter: ScatterDraft,
    /// Number of Monte Carlo designs.
    pub samples: usize,
    /// From this number.
    pub seed: u64,
    /// Rule of the allocation of the loosest tolerances, if requested.
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

/// Distribution of deviations, as far as it is given; see [`Scatter`](crate::model::Scatter).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScatterDraft {
    /// Place in [`Scatter::NAMES`](crate::model::Scatter::NAMES).
    pub kind: Option<usize>,
    /// Number of standard deviations in the tolerance.
    pub sigmas: Option<f64>,
}

/// A tolerance; see [`Tolerance`](crate::model::Tolerance). Its reach is in units of which that many make a metre or a
/// radian.
#[derive(Clone, Debug)]
pub struct ToleranceDraft {
    /// The name of a design variable, or the part before `_x`, `_y`, `_z` of several.
    pub name: String,
    /// By how much it may be off; the variable's own tolerance where it is left out.
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

/// Settings of a sweep; see [`SweepSettings`].
#[derive(Clone, Debug)]
pub struct SweepSettingsDraft {
    /// Method that chooses the designs, if given.
    pub method: Option<SweepMethod>,
    /// Ranges of the variables; if left out, all variables that have bounds, within these.
    pub ranges: Option<Vec<SweepRangeDraft>>,
    /// The designs of a list, in place of all that.
    pub designs: Option<DesignListDraft>,
    /// In a factorial, that many values of a variable that says nothing else.
    pub levels: usize,
    /// Number of designs.
    pub samples: usize,
    /// From this number.
    pub seed: u64,
    /// The names of the metrics; all of them where they are left out.
    pub metrics: Option<Vec<String>>,
    /// The names of the measures whose curves are kept.
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

/// A range of a variable; see [`SweepRange`](crate::model::SweepRange). Its ends are in units of which that many make a
/// metre or a radian; those of a parameter are its values.
#[derive(Clone, Debug)]
pub struct SweepRangeDraft {
    /// The variable's name.
    pub name: String,
    /// Lower end; the variable's lower bound if left out.
    pub low: Option<f64>,
    /// Upper end; the variable's upper bound if left out.
    pub high: Option<f64>,
    /// In a factorial, that many values.
    pub levels: Option<usize>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}

/// Designs that are listed in a file, each as it would stand in a range.
#[derive(Clone, Debug)]
pub struct DesignListDraft {
    /// The file.
    pub file: String,
    /// Per column, the variable's name.
    pub names: Vec<String>,
    /// Per design, its values.
    pub rows: Vec<Vec<f64>>,
    /// Number of user units of length per metre.
    pub per_metre: f64,
    /// Number of user units of angle per radian.
    pub per_radian: f64,
}
