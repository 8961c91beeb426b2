//! HTML report: one file that opens from disk without network access and shows the motion in 3D together with its
//! curves, design sensitivities and checks.
//!
//! [`Payload`] contains all data of the page. [`html`] combines it with the code and style of the page in one file. The
//! page is written in TypeScript under `web/`; its bundle is stored in this crate's `page/` folder, so that the crate
//! builds without JavaScript tools. A test in this file writes `web/src/payload.ts`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, Serializer, ser::Error as _};

use crate::base91;
use crate::encoding::packed;

#[cfg(test)]
use ts_rs::TS;

/// One number per output step, as `f32`; NaN means "no value at this step" and is drawn as a gap.
///
/// In the page it is a list of tracks of the packed block, whose values follow each other in turn: see
/// [`crate::encoding`]. It cannot be serialised before it is packed.
///
/// ```
/// use hardpoint_report::page::Curve;
/// let curve = Curve::from(&[1.0, -2.0][..]);
/// assert_eq!(curve.values(), [1.0, -2.0]);
/// assert!(serde_json::to_string(&curve).is_err());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(TS), ts(type = "Array<number>"))]
pub struct Curve {
    values: Vec<f32>,
    tracks: Vec<u32>,
}

impl Curve {
    /// Values.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Converts the curve to tracks of a packed block.
    pub(crate) fn in_tracks(self, tracks: Vec<u32>) -> Self {
        Self { tracks, ..self }
    }
}

impl From<&[f64]> for Curve {
    fn from(values: &[f64]) -> Self {
        values.iter().copied().collect()
    }
}

impl From<Vec<f32>> for Curve {
    fn from(values: Vec<f32>) -> Self {
        Self { values, tracks: Vec::new() }
    }
}

impl FromIterator<f64> for Curve {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        values.into_iter().map(|value| value as f32).collect::<Vec<f32>>().into()
    }
}

impl Serialize for Curve {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.tracks.is_empty() && !self.values.is_empty() {
            return Err(S::Error::custom("a curve of the page was not packed"));
        }
        self.tracks.serialize(serializer)
    }
}

/// All data of a report. Lengths, angles and times are in [`Payload::units`].
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Payload {
    /// Headline, usually the model's title.
    pub title: String,
    /// Description in the model file; may be empty.
    pub description: String,
    /// Name of the model file.
    pub file: String,
    /// Program and version that made the report.
    pub generator: String,
    /// The user's units.
    pub units: Units,
    /// True if the whole motion was solved.
    pub status: Status,
    /// Key figures for the top of the page.
    pub summary: Vec<Fact>,
    /// Notes on the model that are not errors, each a sentence.
    pub notes: Vec<String>,
    /// Output times, `n` steps, ascending.
    pub times: Curve,
    /// Bodies; the first is ground, whose pose is constant.
    pub bodies: Vec<BodyTrack>,
    /// Joints and constraints that can be drawn at a location.
    pub joints: Vec<JointMark>,
    /// Gears, belts, racks, screws and other relations between the joints' coordinates.
    pub couplers: Vec<CouplerMark>,
    /// Driven coordinates.
    pub drivers: Vec<DriverMark>,
    /// Road wheels.
    pub wheels: Vec<WheelMark>,
    /// Distances between two bodies that are measured: often springs and dampers.
    pub distances: Vec<DistanceMark>,
    /// Forces on bodies, those of joints first; only for models with masses or applied forces.
    pub loads: Vec<LoadMark>,
    /// Axes of the vehicle in the world, if the mechanism belongs to one.
    pub vehicle: Option<VehicleAxes>,
    /// Quantities that can be plotted over time.
    pub quantities: Vec<Quantity>,
    /// Single values that characterise the design: metrics, then the static values of measures.
    pub values: Vec<Value>,
    /// Metrics with their most influential variables, of this motion or of all cases.
    pub metrics: Option<Table>,
    /// Quantity that the page shows first, an index into [`Payload::quantities`].
    pub first: Option<usize>,
    /// Quantity on the abscissa of that first plot, an index into [`Payload::quantities`]; time if there is none.
    pub over: Option<usize>,
    /// Plots that the model file asks for; none for those that suit the mechanism.
    pub plots: Vec<Plot>,
    /// Other designs over the same motion for comparison: changed, predicted, re-solved.
    pub designs: Vec<Design>,
    /// Named designs of the model file.
    pub named_designs: Vec<NamedDesign>,
    /// Measures over grids of two drivers.
    pub maps: Vec<GridMap>,
    /// Designs of a sweep.
    pub sweep: Option<SweepPlot>,
    /// Margin to singular positions over time, if anything is solved for.
    pub margin: Option<Margin>,
    /// Design variables with their sensitivities.
    pub variables: Vec<Variable>,
    /// Square root R of the covariance matrix of the variables' deviations, in their units, for the page of a tolerance
    /// study: a row for each variable. A curve with the derivatives g has the standard deviation |R^T g| to first
    /// order.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, ts(optional))]
    pub covariance_root: Option<Vec<Vec<f64>>>,
    /// Result of the study of which this is the page.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, ts(optional))]
    pub study: Option<StudyTables>,
    /// Facts about the model: bodies, joints, constraints, redundancy, admissibility.
    pub checks: Vec<Table>,
    /// Shapes and the distances between them; only for models with shapes.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, ts(optional))]
    pub clearance: Option<ClearanceMarks>,
    /// Text of the model, from which the page solves changed designs.
    pub model: Option<ModelText>,
}

/// Result of a study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct StudyTables {
    /// Title of its tab.
    pub title: String,
    /// Lines that answer the question of the study, shown above its tables and its plot.
    pub answer: Vec<Fact>,
    /// Tables of the result.
    pub tables: Vec<Table>,
}

/// Text of a model with all other files that it needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ModelText {
    /// Name of the file.
    pub file: String,
    /// Contents of the file.
    pub text: String,
    /// Contents of the files that it names, except meshes.
    pub files: BTreeMap<String, String>,
    /// Case of this motion, if the model has cases.
    pub case: Option<String>,
    /// Detail of the motion on the page; by default the highest that fits.
    pub shown: Option<Detail>,
}

/// Detail of a motion on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Detail {
    /// Stride of the shown steps among the stored ones.
    pub stride: usize,
    /// True if curves of body origins are shown.
    pub origins: bool,
    /// True if the motion of bodies by the variables, and the sensitivities of their origins, are shown.
    pub bodies: bool,
    /// True if sensitivities of the velocities and accelerations of body origins are shown.
    pub body_rates: bool,
    /// True if the sensitivities of body origins are compared with differences.
    pub body_differences: bool,
}

/// Unit symbols of the user.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Units {
    /// Length unit, for example `mm`.
    pub length: String,
    /// Angle unit, for example `deg`.
    pub angle: String,
    /// Time unit, for example `s`.
    pub time: String,
}

/// Status at the end of the run.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Status {
    /// False if the motion, or that of a design shown alongside, stops before its last step; the page then shows a
    /// banner.
    pub complete: bool,
    /// Status in one sentence.
    pub message: String,
}

/// Labelled figure, formatted with its unit.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Fact {
    /// Label of the figure.
    pub label: String,
    /// The figure.
    pub value: String,
}

/// Body with its hardpoints and its motion.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BodyTrack {
    /// Name of the body.
    pub name: String,
    /// Pose in the world, 7 numbers per step: x y z, then the unit quaternion w x y z (`world_from_body`).
    pub poses: Curve,
    /// Hardpoints in the body frame.
    pub skeleton: Vec<[f64; 3]>,
    /// Names of the hardpoints, in the order of `skeleton`.
    pub labels: Vec<String>,
    /// Roles of the points, in the order of `skeleton`.
    pub roles: Vec<PointRole>,
    /// Shape of the body, if the model names a file of it.
    pub mesh: Option<Mesh>,
}

/// Role of a hardpoint of a body; the first one that applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum PointRole {
    /// Location of a joint.
    Joint,
    /// Point on the axis of a hinge.
    Hinge,
    /// Point of a wheel: its centre, or its contact with the ground.
    Wheel,
    /// Measured point, or point driven in the world.
    Measured,
}

/// A triangle mesh in the body's frame.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Mesh {
    /// Name of the file.
    pub file: String,
    /// Three coordinates per vertex.
    pub positions: Curve,
    /// Three vertices per triangle: integers below 2^24, which `f32` represents exactly.
    pub triangles: Curve,
}

/// Joint or constraint between two bodies.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct JointMark {
    /// Name of the joint.
    pub name: String,
    /// Type.
    #[cfg_attr(test, ts(type = "JointKind"))]
    pub kind: &'static str,
    /// Index into [`Payload::bodies`].
    pub body_i: usize,
    /// Index into [`Payload::bodies`].
    pub body_j: usize,
    /// Location on body i, in its frame.
    pub at_i: [f64; 3],
    /// Location on body j, in its frame.
    pub at_j: [f64; 3],
    /// Unit vector along the joint's axis in the frame of body i, if the type has one.
    pub axis: Option<[f64; 3]>,
    /// Unit vector along the joint's axis in the frame of body j. In the design configuration both agree, except for
    /// types with an axis on each body.
    pub axis_j: Option<[f64; 3]>,
    /// Unit vector along the second axis, if there is one: in the frame of body j for `universal`, `constant_velocity`,
    /// `dot1` and `angle`, in that of body i for others.
    pub axis2: Option<[f64; 3]>,
    /// Straight guide between the bodies, if the type has one.
    pub slide: Option<SlideMark>,
    /// Hardpoints that define the axis in the design configuration, in the frame of body i, if it is defined by two.
    pub hinge: Option<[[f64; 3]; 2]>,
    /// Travel per revolution of a screw.
    pub lead: Option<f64>,
    /// Curve that a point of body j follows, as points in the frame of body i.
    pub curve: Option<JointCurve>,
    /// Shape in drawings, if the model defines one: `coilover`, `spring`, `damper`, `cylinder` or `rod`.
    pub draw: Option<String>,
    /// True if the joint closes a loop (cut joint) instead of carrying body j (tree joint).
    pub cut: bool,
}

/// Straight guide of a joint.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SlideMark {
    /// Unit vector along it in the frame of body i; `None` for a plane perpendicular to the joint's axis.
    pub along: Option<[f64; 3]>,
    /// True if either body may be the rail; otherwise it is body i.
    pub either: bool,
}

/// Planar curve on a body, sampled finely enough for drawing.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct JointCurve {
    /// True if the last point connects to the first.
    pub closed: bool,
    /// Points in the frame of the body.
    pub points: Vec<[f64; 3]>,
    /// Unit normal of its plane.
    pub normal: [f64; 3],
}

/// Linear relation between joint coordinates: `sum of coefficient x coordinate = 0`.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CouplerMark {
    /// Name of the coupler.
    pub name: String,
    /// Type in the model file.
    pub kind: CouplerKind,
    /// Terms; for a rack the rack first, then the pinion.
    pub terms: Vec<CouplerTerm>,
    /// Sizes in the model file: teeth of two gears, radii of two pulleys, radius of a rack's pinion, lead of a screw.
    pub sizes: Vec<f64>,
}

/// Type of a coupler in the model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(test, derive(TS))]
pub enum CouplerKind {
    /// Two gears with parallel axes.
    Gear,
    /// Two bevel gears.
    Bevel,
    /// Rack and pinion.
    Rack,
    /// Belt of two pulleys.
    Belt,
    /// Thread.
    Screw,
    /// Relation with coefficients.
    Linear,
}

/// Joint coordinate with its factor.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CouplerTerm {
    /// Index into [`Payload::joints`].
    pub joint: usize,
    /// True if the coordinate is an angle; a length otherwise.
    pub turns: bool,
    /// Factor per length unit or per radian of the coordinate.
    pub coefficient: f64,
}

/// Driven coordinate.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DriverMark {
    /// Name of the driver.
    pub name: String,
    /// Law in words.
    pub law: String,
    /// Index into [`Payload::joints`], if the driven joint is drawn.
    pub joint: Option<usize>,
    /// True if the driven coordinate is an angle; a length otherwise.
    pub turns: bool,
    /// Driven point in the frame of its body, if a point is driven.
    pub point: Option<BodyPlace>,
    /// Unit vector in the world along which the point is driven, or about which the body is rotated.
    pub along: Option<[f64; 3]>,
    /// Driven coordinate, `n` steps, in the length unit or in radians, relative to the design configuration.
    pub travel: Curve,
    /// If several drivers move: rate of each of the first [`Payload::quantities`] by this driver with the others at
    /// rest, in its unit per length unit or radian; empty for quantities that do not depend on positions alone.
    pub alone: Vec<Curve>,
}

/// Point on a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BodyPlace {
    /// Index into [`Payload::bodies`].
    pub body: usize,
    /// Location in the body's frame.
    pub at: [f64; 3],
}

/// A road wheel.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct WheelMark {
    /// Name of the wheel.
    pub name: String,
    /// Centre, on the carrier body.
    pub centre: BodyPlace,
    /// Unit vector along the spin axis, outboard, in the frame of the carrier body.
    pub axis: [f64; 3],
    /// Distance from the centre to the ground.
    pub radius: f64,
    /// Lower and upper point of the steering axis, if there is one.
    pub kingpin: Option<[BodyPlace; 2]>,
}

/// Shapes of bodies, and their distances over the motion.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ClearanceMarks {
    /// All shapes.
    pub shapes: Vec<ShapeMark>,
    /// Clearances of the model.
    pub clearances: Vec<ClearanceMark>,
    /// Pairs that are the nearest of their clearance at any shown step.
    pub pairs: Vec<PairTrack>,
}

/// Shape of a body.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ShapeMark {
    /// Name of the shape.
    pub name: String,
    /// Kind in the model file: `sphere`, `capsule`, `ring`, `cylinder`, `tyre`, `plane`, `hull` or `mesh`.
    pub kind: &'static str,
    /// Body that carries it, an index into [`Payload::bodies`]; of a rod without a body that of its first end.
    pub body: usize,
    /// Centre, both ends, or corners; none of a mesh.
    pub places: Vec<BodyPlace>,
    /// Unit vector along the axis or normal in the frame of `body`, of a ring, tyre or plane.
    pub axis: Option<[f64; 3]>,
    /// Radius, to the outside; of a ring that of the circle in the middle of its bar; 0 where there is none.
    pub radius: f64,
    /// Half of a tyre's width; otherwise 0.
    pub half_width: f64,
    /// Radius of a ring's bar, or of edges; that of a sphere or capsule is its radius.
    pub round: f64,
    /// Vertices of a mesh in the frame of `body`, three coordinates each; empty otherwise, and of other designs.
    pub vertices: Curve,
    /// Three vertices per triangle of a mesh, or corners of a hull: integers below 2^24; empty otherwise.
    pub triangles: Curve,
}

/// Clearance of the model.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ClearanceMark {
    /// Name of the clearance.
    pub name: String,
    /// Measures of it, indices into [`Payload::quantities`].
    pub quantities: Vec<usize>,
    /// Distance that is required of all its pairs, if it is the same for all.
    pub min: Option<f64>,
    /// Distance above which its pairs are not shown.
    pub beyond: Option<f64>,
}

/// Distance of two shapes over the motion.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct PairTrack {
    /// Both shapes, indices into [`ClearanceMarks::shapes`].
    pub shapes: [usize; 2],
    /// Clearances with this pair, indices into [`ClearanceMarks::clearances`].
    pub clearances: Vec<usize>,
    /// Distance, `n` steps; negative where the shapes overlap.
    pub distance: Curve,
    /// Nearest points of their surfaces in the world, six numbers per step.
    pub points: Curve,
    /// Intervals in which they touch, located exactly; `None` if they were not located.
    pub touching: Option<Vec<[f64; 2]>>,
    /// Times and distances of all local minima, located exactly; empty if they were not located.
    pub minima: Vec<[f64; 2]>,
}

/// Shapes and distances of another design.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DesignShapes {
    /// Shapes as in [`ClearanceMarks::shapes`], without the vertices of meshes, which no design changes.
    pub shapes: Vec<ShapeMark>,
    /// Pairs as in [`ClearanceMarks::pairs`].
    pub pairs: Vec<PairTrack>,
}

/// Measured distance between two points.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DistanceMark {
    /// Name of the measure.
    pub name: String,
    /// First point.
    pub from: BodyPlace,
    /// Second point.
    pub to: BodyPlace,
    /// Shape in drawings, if the model defines one; see [`JointMark::draw`].
    pub draw: Option<String>,
}

/// Force on a body: the reaction of a joint on body j, or an applied force of a spring or another element at a point.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LoadMark {
    /// Name of the joint or the force element.
    pub name: String,
    /// Index into [`Payload::joints`], for the reaction of a joint.
    pub joint: Option<usize>,
    /// Point of application.
    pub at: BodyPlace,
    /// Three numbers per step: force in the world, N. Components that redundant constraints leave undetermined are
    /// omitted; NaN if the force is unknown.
    pub force: Curve,
    /// True if undetermined components are omitted at any time.
    pub is_part: bool,
}

/// Unit vectors of the vehicle axes in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct VehicleAxes {
    /// Direction of travel.
    pub forward: [f64; 3],
    /// Upward direction.
    pub up: [f64; 3],
}

/// Plot that the page opens with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Plot {
    /// Quantities of one unit on the ordinate, indices into [`Payload::quantities`].
    pub y: Vec<usize>,
    /// Quantity on the abscissa; time if there is none.
    pub over: Option<usize>,
}

/// Named design of the model file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct NamedDesign {
    /// Name.
    pub name: String,
    /// Changes of variables from the nominal design; all others are nominal.
    pub changes: Vec<NamedChange>,
}

/// Change of a variable.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct NamedChange {
    /// Name of the variable.
    pub name: String,
    /// Change from the nominal design, in its unit.
    pub by: f64,
}

/// Single value that characterises the design.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Value {
    /// Name of the metric or measure.
    pub name: String,
    /// Kind of value, in a few words: `design configuration`, `at the start`, `range`, `largest`, ...
    pub what: String,
    /// Unit.
    pub unit: String,
    /// Value, if the motion reaches it.
    pub value: Option<f64>,
    /// Time of the value, if it is taken at one time.
    pub time: Option<f64>,
    /// Quantity that it is evaluated from, an index into [`Payload::quantities`].
    pub quantity: Option<usize>,
    /// Required minimum and maximum, if the model defines them.
    pub target: Option<[Option<f64>; 2]>,
    /// Part of the target that limits the curve of the quantity.
    pub gate: Option<Gate>,
    /// Derivatives by every design variable, in the order of [`Payload::variables`]; empty if the mechanism cannot
    /// follow one.
    pub sensitivities: Vec<Option<f64>>,
}

/// Limits of a curve that follow from the target of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Gate {
    /// Minimum.
    pub low: Option<f64>,
    /// Maximum.
    pub high: Option<f64>,
    /// Time of the limits; the whole curve if there is none.
    pub at: Option<f64>,
}

/// Another design over the same output times. Unknown curves are empty.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Design {
    /// Name on the page: `changed`, `predicted to first order`, ...
    pub name: String,
    /// Source of the design.
    pub kind: DesignKind,
    /// Change of each variable, in the order of [`Payload::variables`], in their units.
    pub change: Vec<f64>,
    /// Sentence on the admissibility of the change; may be empty.
    pub note: String,
    /// Poses of its bodies, as in [`BodyTrack::poses`].
    pub poses: Vec<Curve>,
    /// Hardpoints in the bodies' frames, as in [`BodyTrack::skeleton`].
    pub skeletons: Vec<Vec<[f64; 3]>>,
    /// Forces, as in [`LoadMark::force`], in the order of [`Payload::loads`].
    pub loads: Vec<Curve>,
    /// Quantities, in the order of [`Payload::quantities`].
    pub quantities: Vec<Option<DesignCurves>>,
    /// Values, in the order of [`Payload::values`].
    pub values: Vec<Option<f64>>,
    /// Margin to singular positions.
    pub margin: Option<Curve>,
    /// Shapes and their distances, if the design was solved and the model has shapes.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, ts(optional))]
    pub clearance: Option<DesignShapes>,
}

/// Source of another design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// Solved again.
    Exact,
    /// Predicted from first derivatives.
    FirstOrder,
    /// Predicted from first and second derivatives.
    SecondOrder,
    /// Edge of the band of the curves of many designs, or a curve between them, not a design itself; edges by standard
    /// deviations come first.
    Band,
    /// The nominal design with rigid joints in place of the elastic ones.
    Rigid,
}

/// Quantity of another design with its two time derivatives; unknown curves are empty.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DesignCurves {
    /// The quantity, `n` steps.
    pub value: Curve,
    /// First time derivative.
    pub rate: Curve,
    /// Second time derivative.
    pub accel: Curve,
}

/// Quantity that can be plotted over time, with its two time derivatives.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Quantity {
    /// Name of the quantity, for example `toe`.
    pub name: String,
    /// Unit of `value`.
    pub unit: String,
    /// Unit of `rate`.
    pub rate_unit: String,
    /// Unit of `accel`.
    pub accel_unit: String,
    /// Heading in the list of quantities: `measure`, `point`, `body` or `joint`.
    pub group: String,
    /// Type of the measure as model files write it, such as `toe`; `position` for a coordinate of a point or body.
    pub kind: String,
    /// The quantity, `n` steps.
    pub value: Curve,
    /// First time derivative.
    pub rate: Curve,
    /// Second time derivative.
    pub accel: Curve,
    /// Target curve of a metric, `n` steps; empty without one.
    pub wanted: Curve,
}

/// Designs of a sweep, or a part of them, each as a point over variables and metrics.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepPlot {
    /// Meaning of a point: `design`, `posture`, or `point` of a front.
    pub what: String,
    /// Number of solved designs.
    pub designs: usize,
    /// Point k is design `k * step`.
    pub step: usize,
    /// Swept variables, then metrics.
    pub axes: Vec<SweepAxis>,
    /// Sobol indices, if requested.
    pub indices: Vec<SweepIndex>,
}

/// Variable or metric of a sweep.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepAxis {
    /// Name, with the case if there are several.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// True if it is a metric.
    pub metric: bool,
    /// Value of a design variable in the nominal design; `null` for all else.
    pub nominal: Option<f64>,
    /// Target of a metric; `null` without one.
    pub target: Option<f64>,
    /// Value in each point.
    pub values: Curve,
}

/// Sobol indices of a metric with respect to a variable, each with its standard error.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepIndex {
    /// Metric, an index into [`SweepPlot::axes`].
    pub metric: usize,
    /// Variable, an index into [`SweepPlot::axes`].
    pub variable: usize,
    /// First-order index and its standard error.
    pub first: [f64; 2],
    /// Total index and its standard error.
    pub total: [f64; 2],
}

/// Case that sweeps two drivers over a grid. Tables have a row for each position of the second driver and a column for
/// each position of the first.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridMap {
    /// Name of the case.
    pub name: String,
    /// Drivers of the grid.
    pub drivers: [GridDriver; 2],
    /// Number of positions reached, and reasons for the unreached ones.
    pub note: String,
    /// Measured quantities.
    pub quantities: Vec<GridQuantity>,
}

/// Driver of a grid.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridDriver {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Positions, increasing.
    pub places: Vec<f64>,
}

/// Measure over a grid.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridQuantity {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Values, row by row.
    pub values: Curve,
    /// Derivatives by design variables; empty if they would be too many for a page.
    pub sensitivities: Vec<GridSensitivity>,
}

/// Derivative of a measure by a design variable over a grid.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridSensitivity {
    /// Name of the variable.
    pub variable: String,
    /// Unit of the derivative.
    pub unit: String,
    /// Derivatives, row by row.
    pub values: Curve,
}

/// Margin of the mechanism to singular positions: 1 is best, 0 is a singular position.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Margin {
    /// Margin, `n` steps.
    pub value: Curve,
    /// Meaning of its minimum.
    pub note: String,
}

/// Design variable: its design velocities, admissibility and sensitivities.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Variable {
    /// Name of the variable.
    pub name: String,
    /// Meaning in a few words; may be empty.
    pub description: String,
    /// Unit of the variable, `1` for a pure number.
    pub unit: String,
    /// Admissibility of the change.
    pub admissibility: Admissibility,
    /// Sentence with the joints concerned and their defects; empty if every joint stays closed.
    pub note: String,
    /// Design velocities of the hardpoints that it moves.
    pub arrows: Vec<Arrow>,
    /// Typical change, if the model defines one.
    pub typical: Option<f64>,
    /// Manufacturing tolerance in either direction, if the model defines one.
    pub tolerance: Option<f64>,
    /// Lower and upper bound of the change from the nominal design, if the model defines them.
    pub bounds: Option<[Option<f64>; 2]>,
    /// First-order motion of each body per unit of the variable: six numbers per step, dx dy dz in the length unit and
    /// a rotation vector in rad; empty if it is not shown.
    pub shifts: Vec<Curve>,
    /// Sensitivities, at most one per quantity; empty if the mechanism cannot follow the variable.
    pub sensitivities: Vec<Sensitivity>,
}

/// Admissibility of a design variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Admissibility {
    /// All joints stay closed in the design configuration.
    Admissible,
    /// Joints would open; the mechanism closes them by moving.
    Reassembled,
    /// No motion closes the joints that open: there is no sensitivity.
    CannotFollow,
}

/// Design velocity of one hardpoint, per unit of the variable, in the frame of its body.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Arrow {
    /// Index into [`Payload::bodies`].
    pub body: usize,
    /// Position of the hardpoint.
    pub at: [f64; 3],
    /// Velocity of its location.
    pub v: [f64; 3],
    /// Velocity of its orientation.
    pub turn: [f64; 3],
}

/// Total derivative of one quantity and its two time derivatives by one design variable.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Sensitivity {
    /// Index into [`Payload::quantities`].
    pub quantity: usize,
    /// Derivative of the quantity, `n` steps.
    pub value: Curve,
    /// Derivative of its first time derivative.
    pub rate: Curve,
    /// Derivative of its second time derivative.
    pub accel: Curve,
    /// Difference quotients of re-solved designs, if requested.
    pub fd: Option<FiniteDifference>,
}

/// Central differences of re-solved designs, for comparison with a [`Sensitivity`].
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct FiniteDifference {
    /// Stride of the curves among the `n` steps, starting with the first: they are drawn as a few marks.
    pub stride: usize,
    /// Difference quotient of the quantity.
    pub value: Curve,
    /// Difference quotient of its first time derivative.
    pub rate: Curve,
    /// Difference quotient of its second time derivative.
    pub accel: Curve,
    /// Change of the variable to either side.
    pub step: f64,
    /// Unit of `step`.
    pub step_unit: String,
    /// Largest relative disagreement over time in value, rate and accel.
    pub worst: [f64; 3],
}

/// Table of facts with formatted cells.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Table {
    /// Heading.
    pub title: String,
    /// Sentence under the heading; may be empty.
    pub note: String,
    /// Column headings.
    pub header: Vec<String>,
    /// Rows, each as long as `header`.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Removes the columns that are empty in every row.
    pub fn without_empty_columns(self) -> Self {
        let full = |k: usize| self.rows.is_empty() || self.rows.iter().any(|row| !row[k].is_empty());
        let kept: Vec<usize> = (0..self.header.len()).filter(|k| full(*k)).collect();
        let pick = |row: &Vec<String>| kept.iter().map(|k| row[*k].clone()).collect();
        Self { header: pick(&self.header), rows: self.rows.iter().map(pick).collect(), ..self }
    }
}

/// Assembles the report as one self-contained HTML file.
///
/// # Errors
/// If the payload cannot be serialised, which does not happen with plain numbers and strings.
pub fn html(payload: &Payload) -> Result<String, serde_json::Error> {
    Ok(file(&payload.title, &packed(payload)?))
}

/// Engine of a page, and its style and code, deflated and in letters.
const ENGINE: &str = include_str!(concat!(env!("OUT_DIR"), "/engine.txt"));
const CODE: &str = include_str!(concat!(env!("OUT_DIR"), "/code.txt"));

/// Name of the file with the engine and the code that the pages of a folder share.
pub const SHARED: &str = "hardpoint.js";

/// Contents of the file [`SHARED`]. It is a plain script, which a page may load from disk.
pub fn shared_script() -> String {
    let part = |id: &str, text: &str| format!("document.getElementById(\"{id}\").textContent = \"{text}\"\n");
    part("engine", ENGINE) + &part("code", CODE)
}

/// Page of this crate that loads its engine and its code from the file [`SHARED`] next to it, with a link to the page
/// of all models.
pub fn sharing(page: &str, models: &str) -> String {
    const END: &str = "<script type=\"text/plain\" id=\"code\"></script>";
    let missing =
        format!("document.getElementById('page').textContent = 'This page needs {SHARED} in its folder.'");
    let load = format!("{END}\n<script src=\"{SHARED}\" onerror=\"{missing}\"></script>");
    let head = format!("<link rel=\"up\" href=\"{}\">\n</head>", escape_text(models));
    page.replacen("</head>", &head, 1).replacen(ENGINE, "", 1).replacen(CODE, "", 1).replacen(END, &load, 1)
}

/// HTML file of a packed payload.
pub(crate) fn file(title: &str, packed: &[u8]) -> String {
    fill(include_str!("../page/report.html"), |slot| match slot {
        "title" => escape_text(title),
        "payload" => base91::encode(packed),
        "engine" => ENGINE.to_owned(),
        "code" => CODE.to_owned(),
        _ => panic!("the report template names an unknown slot `{slot}`"),
    })
}

/// Element in which a page finds its server: empty in a file.
const SERVER: &str = "<script type=\"application/json\" id=\"server\">";

/// Page as sent by a server, with data `about` the server. The page must be one of this crate.
///
/// # Errors
/// If `about` cannot be serialised.
pub fn served(page: &str, about: &impl Serialize) -> Result<String, serde_json::Error> {
    let about = serde_json::to_string(about)?.replace('<', "\\u003c");
    Ok(page.replacen(SERVER, &format!("{SERVER}{about}"), 1))
}

/// Replaces every `{{slot}}` of the template; inserted content is not searched for slots.
pub(crate) fn fill(template: &str, content: impl Fn(&str) -> String) -> String {
    let mut pieces = template.split("{{");
    let mut page = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (slot, text) = piece.split_once("}}").expect("the report template closes its slots");
        page += &content(slot);
        page += text;
    }
    page
}

/// Escapes text between tags, or for an attribute in double quotes.
pub(crate) fn escape_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::{fs, path::Path};

    pub(crate) fn payload(title: &str) -> Payload {
        Payload {
            title: title.into(),
            description: String::new(),
            file: "sample.toml".into(),
            generator: "hardpoint".into(),
            units: Units { length: "mm".into(), angle: "deg".into(), time: "s".into() },
            status: Status { complete: true, message: "solved".into() },
            summary: vec![],
            notes: vec![],
            times: Curve::default(),
            bodies: vec![],
            joints: vec![],
            couplers: vec![],
            drivers: vec![],
            wheels: vec![],
            distances: vec![],
            loads: vec![],
            vehicle: None,
            quantities: vec![],
            values: vec![],
            metrics: None,
            first: None,
            over: None,
            plots: vec![],
            designs: vec![],
            named_designs: vec![],
            maps: vec![],
            sweep: None,
            margin: None,
            variables: vec![],
            covariance_root: None,
            study: None,
            checks: vec![],
            clearance: None,
            model: None,
        }
    }

    #[test]
    fn text_of_the_model_cannot_end_the_script_or_name_a_slot() {
        let page = html(&payload("</script><b>{{code}}")).unwrap();
        assert!(page.contains("<title>&lt;/script&gt;&lt;b&gt;{{code}}</title>"));
        assert!(!page.contains("<b>"));
        assert_eq!(
            page.matches("</script").count(),
            5,
            "ends of the server, the payload, the engine, the code and what starts it"
        );
    }

    #[test]
    fn a_page_without_shapes_has_no_key_for_them() {
        assert!(!serde_json::to_string(&payload("sample")).unwrap().contains("clearance"));
    }

    #[test]
    fn pages_of_a_folder_share_the_engine_and_the_code() {
        let page = html(&payload("sample")).unwrap();
        let (sharing, script) = (sharing(&page, "index.html"), shared_script());
        assert!(sharing.len() + ENGINE.len() + CODE.len() < page.len() + 400);
        assert!(sharing.contains("<script type=\"text/plain\" id=\"engine\"></script>"));
        assert!(sharing.contains("<script src=\"hardpoint.js\""));
        assert!(script.contains(ENGINE) && script.contains(CODE));
        // A text in double quotes.
        assert!([ENGINE, CODE].iter().all(|text| !text.contains(['"', '\\', '\n'])));
    }

    #[test]
    fn a_page_hears_of_its_server_and_of_nothing_else() {
        let page = html(&payload("sample")).unwrap();
        let served = served(&page, &["</script>"]).unwrap();
        assert!(served.contains(r#"id="server">["\u003c/script>"]</script>"#));
        assert_eq!(served.matches("</script").count(), page.matches("</script").count());
    }

    #[test]
    fn page_asks_the_network_for_nothing() {
        let page = html(&payload("sample")).unwrap();
        // Packed data may contain any letters, but begins no tag.
        let tag_of = |script: &str| script.split_once('>').unwrap().0.to_owned();
        let markup: String = page
            .split("</script")
            .map(|part| match part.split_once("<script") {
                Some((before, script)) => before.to_owned() + &tag_of(script),
                None => part.to_owned(),
            })
            .collect();
        for markup in [&markup, include_str!("../page/report.html")] {
            assert!(!markup.contains("src=") && !markup.contains("href=") && !markup.contains("import("));
        }
        assert!(!include_str!("../page/app.css").contains("url("));
        assert!(!include_str!("../page/app.js").contains("import("));
    }

    #[test]
    fn typescript_types_are_those_of_the_payload() {
        let config = ts_rs::Config::default();
        let mut expected = String::from(
            "// Written by the tests of `crates/hardpoint-report/src/page.rs`; change the structs there.\n",
        );
        let kinds: Vec<String> = hardpoint::joint::ALL.iter().map(|t| format!("'{}'", t.name)).collect();
        expected +=
            &format!("\n/**\n * Type of a joint.\n */\nexport type JointKind = {};\n", kinds.join(" | "));
        macro_rules! declare {
            ($($name:ident)*) => { $(
                expected += "\n";
                expected += &<$name as TS>::docs().unwrap_or_default();
                expected += &format!("export {}\n", <$name as TS>::decl(&config)).replace(" \n", "\n");
            )* };
        }
        declare!(
            Curve Payload ModelText Detail Units Status Fact BodyTrack PointRole Mesh JointMark SlideMark JointCurve CouplerMark CouplerKind CouplerTerm
            DriverMark BodyPlace WheelMark ClearanceMarks ShapeMark ClearanceMark PairTrack DesignShapes DistanceMark LoadMark VehicleAxes Quantity Plot NamedDesign NamedChange Value Gate Design DesignKind DesignCurves
            GridMap GridDriver GridQuantity GridSensitivity SweepPlot SweepAxis SweepIndex Margin StudyTables Variable Admissibility Arrow Sensitivity FiniteDifference Table
        );
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/src/payload.ts");
        if fs::read_to_string(&path).ok().as_deref() != Some(&expected) {
            fs::write(&path, expected).unwrap();
            panic!(
                "web/src/payload.ts was out of date and has been rewritten: rebuild the page and commit both"
            );
        }
    }
}
