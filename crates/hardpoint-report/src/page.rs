//! The HTML report: one file that opens from disk, asks the network for nothing and shows the motion
//! in 3D beside its curves, design sensitivities and checks.
//!
//! [`Payload`] is everything the page knows. [`html`] puts it, the page's code and its style into one file.
//! The page itself is TypeScript under `web/`; its built bundle is kept in this crate's `page/` folder, so
//! building the crate needs no JavaScript tools. `web/src/payload.ts` is written by a test in this file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, Serializer, ser::Error as _};

use crate::encoding::{base64, packed};

#[cfg(test)]
use ts_rs::TS;

/// One number per output step, kept as `f32`; NaN means "no value at this step" and is drawn as a gap.
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

    /// The same values as tracks of a packed block.
    pub(crate) fn in_tracks(self, tracks: Vec<u32>) -> Self {
        Self { tracks, ..self }
    }
}

impl From<&[f64]> for Curve {
    fn from(values: &[f64]) -> Self {
        values.iter().copied().collect()
    }
}

impl FromIterator<f64> for Curve {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Self { values: values.into_iter().map(|value| value as f32).collect(), tracks: Vec::new() }
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

/// Everything one report shows. Lengths, angles and times are in [`Payload::units`].
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
    /// A handful of figures for the top of the page.
    pub summary: Vec<Fact>,
    /// Sentences about the model that are no errors.
    pub notes: Vec<String>,
    /// Output times, `n` steps, ascending.
    pub times: Curve,
    /// Bodies; the first is ground, whose pose is constant.
    pub bodies: Vec<BodyTrack>,
    /// Joints and constraints that have a place to be drawn at.
    pub joints: Vec<JointMark>,
    /// Gears, belts, racks, screws and other relations between the joints' coordinates.
    pub couplers: Vec<CouplerMark>,
    /// Driven coordinates.
    pub drivers: Vec<DriverMark>,
    /// Road wheels.
    pub wheels: Vec<WheelMark>,
    /// Distances that are measured between two bodies: springs and dampers are often given so.
    pub distances: Vec<DistanceMark>,
    /// Forces on bodies, of joints first; of a model in which something has mass or pushes.
    pub loads: Vec<LoadMark>,
    /// The vehicle's own axes in the world, where the mechanism belongs to one.
    pub vehicle: Option<VehicleAxes>,
    /// Quantities that can be plotted over time.
    pub quantities: Vec<Quantity>,
    /// Single numbers that the design is judged by: metrics, then the static values of measures.
    pub values: Vec<Value>,
    /// The quantity that the page opens on, an index into [`Payload::quantities`].
    pub first: Option<usize>,
    /// The quantity over which the page draws that one at first, an index into [`Payload::quantities`]; over time where
    /// there is none.
    pub over: Option<usize>,
    /// Other designs over the same motion, to be compared with this one: changed, predicted, re-solved.
    pub designs: Vec<Design>,
    /// Measures over grids of two drivers.
    pub maps: Vec<GridMap>,
    /// Designs that were swept over.
    pub sweep: Option<SweepPlot>,
    /// Margin from singular positions over time, if anything is solved for.
    pub margin: Option<Margin>,
    /// Design variables with their sensitivities.
    pub variables: Vec<Variable>,
    /// Facts about the model: bodies, joints, constraints, redundancy, admissibility.
    pub checks: Vec<Table>,
    /// The model's text: from it the page solves what the reader changes.
    pub model: Option<ModelText>,
}

/// The text of a model, with all that is read besides it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ModelText {
    /// Name of the file.
    pub file: String,
    /// The text.
    pub text: String,
    /// The files that it names, but for meshes.
    pub files: BTreeMap<String, String>,
    /// The case whose motion this is, where the model has cases.
    pub case: Option<String>,
    /// Detail of the motion on the page; as much as fits if it is not given.
    pub shown: Option<Detail>,
}

/// Detail of a motion on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Detail {
    /// Every that many steps of those that are kept.
    pub stride: usize,
    /// Curves of body origins.
    pub origins: bool,
    /// Motion of bodies by the variables, and with that the sensitivities of their origins.
    pub bodies: bool,
    /// Sensitivities of the velocities and accelerations of body origins.
    pub body_rates: bool,
    /// Comparison of the sensitivities of body origins with differences.
    pub body_differences: bool,
}

/// Unit symbols as the user writes them.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Units {
    /// For example `mm`.
    pub length: String,
    /// For example `deg`.
    pub angle: String,
    /// For example `s`.
    pub time: String,
}

/// Status at the end of the run.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Status {
    /// False when the motion, or that of a design beside it, stops before its last step; the page then says so in a
    /// banner.
    pub complete: bool,
    /// One sentence.
    pub message: String,
}

/// A labelled figure, already formatted with its unit.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Fact {
    /// Label of the figure.
    pub label: String,
    /// The figure.
    pub value: String,
}

/// A body, its hardpoints and where it was.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BodyTrack {
    /// The user's name.
    pub name: String,
    /// Pose in the world, 7 numbers per step: x y z, then the unit quaternion w x y z (`world_from_body`).
    pub poses: Curve,
    /// Hardpoints in the body frame.
    pub skeleton: Vec<[f64; 3]>,
    /// Names of the hardpoints, in the order of `skeleton`.
    pub labels: Vec<String>,
    /// Roles of the points, in the order of `skeleton`.
    pub roles: Vec<PointRole>,
    /// The body's own shape, where the model names a file of it.
    pub mesh: Option<Mesh>,
}

/// Role of a hardpoint of a body; of several roles the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum PointRole {
    /// A joint is there.
    Joint,
    /// It lies on the axis of a hinge.
    Hinge,
    /// It belongs to a wheel: its centre, or where it touches the ground.
    Wheel,
    /// It is measured, or driven by its place in the world.
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
    /// Three vertices per triangle: numbers below 2^24, which `f32` holds exactly.
    pub triangles: Curve,
}

/// A joint or constraint between two bodies.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct JointMark {
    /// The user's name.
    pub name: String,
    /// `revolute`, `spherical`, `translational`, `distance`, ...; an unknown kind gets a neutral mark.
    pub kind: String,
    /// Index into [`Payload::bodies`].
    pub body_i: usize,
    /// Index into [`Payload::bodies`].
    pub body_j: usize,
    /// Place on body i, in its frame.
    pub at_i: [f64; 3],
    /// Place on body j, in its frame.
    pub at_j: [f64; 3],
    /// Unit vector along the joint's axis in the frame of body i, where the kind has one.
    pub axis: Option<[f64; 3]>,
    /// The same in the frame of body j; in the design configuration the two agree, but for kinds with an axis on each
    /// body.
    pub axis_j: Option<[f64; 3]>,
    /// Unit vector along the second axis, where there is one: in the frame of body j for `universal`,
    /// `constant_velocity`, `dot1` and `angle`, in that of body i for others.
    pub axis2: Option<[f64; 3]>,
    /// The two hardpoints that the axis passes through in the design configuration, in the frame of body i, where it is
    /// given so.
    pub hinge: Option<[[f64; 3]; 2]>,
    /// Travel per turn of a screw.
    pub lead: Option<f64>,
    /// The curve that a point of body j follows, as points in the frame of body i.
    pub curve: Option<JointCurve>,
    /// Shape in drawings, if the model gives one: `coilover`, `spring`, `damper`, `cylinder` or `rod`.
    pub draw: Option<String>,
    /// True if the joint closes a loop instead of carrying body j.
    pub cut: bool,
}

/// A planar curve on a body, sampled finely enough to be drawn.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct JointCurve {
    /// True if its last point is followed by its first.
    pub closed: bool,
    /// Points in the frame of the body.
    pub points: Vec<[f64; 3]>,
    /// Unit normal of its plane.
    pub normal: [f64; 3],
}

/// A linear relation between joint coordinates: `sum of coefficient x coordinate = 0`.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CouplerMark {
    /// The user's name.
    pub name: String,
    /// `gear`, `bevel`, `rack`, `belt`, `screw`, `linear`: as the model file says.
    pub kind: String,
    /// Terms: of a rack first the rack, then the pinion.
    pub terms: Vec<CouplerTerm>,
    /// Teeth of two gears, radii of two pulleys, radius of a rack's pinion, lead of a screw: as the model file says.
    pub sizes: Vec<f64>,
}

/// A joint coordinate with its factor.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CouplerTerm {
    /// Index into [`Payload::joints`].
    pub joint: usize,
    /// True if the coordinate is an angle; a length otherwise.
    pub turns: bool,
    /// Per length unit or per radian of the coordinate.
    pub coefficient: f64,
}

/// Coordinate that a driver drives.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DriverMark {
    /// The user's name.
    pub name: String,
    /// Law in words.
    pub law: String,
    /// Index into [`Payload::joints`], where a joint is driven that is drawn.
    pub joint: Option<usize>,
    /// True if the driven coordinate is an angle; a length otherwise.
    pub turns: bool,
    /// The body whose point is driven, and the point in its frame, where that is so.
    pub point: Option<BodyPlace>,
    /// Unit vector in the world along which the point is driven, or about which the body is turned at it.
    pub along: Option<[f64; 3]>,
    /// The driven coordinate, `n` steps, in the length unit or in radians, counted from the drawing.
    pub travel: Curve,
    /// If several drivers move: rate of each of the first of [`Payload::quantities`] by this driver while the others
    /// are at rest, in its unit per length unit or radian; empty for quantities that do not follow from positions
    /// alone.
    pub alone: Vec<Curve>,
}

/// A place on a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct BodyPlace {
    /// Index into [`Payload::bodies`].
    pub body: usize,
    /// In the body's frame.
    pub at: [f64; 3],
}

/// A road wheel.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct WheelMark {
    /// The user's name.
    pub name: String,
    /// Centre, on the body that carries it.
    pub centre: BodyPlace,
    /// Unit vector along its spin axis, outboard, in that body's frame.
    pub axis: [f64; 3],
    /// From the centre to the ground.
    pub radius: f64,
    /// Lower and upper point of the axis that it steers about, where there is one.
    pub kingpin: Option<[BodyPlace; 2]>,
}

/// A distance that is measured between two places.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DistanceMark {
    /// Name of the measure.
    pub name: String,
    /// From where.
    pub from: BodyPlace,
    /// To where.
    pub to: BodyPlace,
    /// Shape in drawings, if the model gives one; see [`JointMark::draw`].
    pub draw: Option<String>,
}

/// A force on a body: what a joint puts on its second body, or what a spring or another force puts on a point.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LoadMark {
    /// The user's name of the joint or the force.
    pub name: String,
    /// Index into [`Payload::joints`], where a joint puts it there.
    pub joint: Option<usize>,
    /// Point of action.
    pub at: BodyPlace,
    /// Three numbers per step: the force in the world, N. What redundant constraints leave open is left out; not a
    /// number where nothing is known.
    pub force: Curve,
    /// True if something is left out of it at any time.
    pub is_part: bool,
}

/// Unit vectors in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct VehicleAxes {
    /// Direction of travel.
    pub forward: [f64; 3],
    /// Upwards.
    pub up: [f64; 3],
}

/// A single number that the design is judged by.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Value {
    /// The user's name of the metric or measure.
    pub name: String,
    /// Kind of value, in a few words: `design configuration`, `at the start`, `range`, `largest`, ...
    pub what: String,
    /// Unit.
    pub unit: String,
    /// The number, where the motion reaches it.
    pub value: Option<f64>,
    /// When it is taken, where it is taken at one time.
    pub time: Option<f64>,
    /// The quantity that it is taken of, an index into [`Payload::quantities`].
    pub quantity: Option<usize>,
    /// Least and largest value that is wanted, where the model says so.
    pub target: Option<[Option<f64>; 2]>,
    /// Derivatives by every design variable, in the order of [`Payload::variables`]; none where one cannot be followed.
    pub sensitivities: Vec<Option<f64>>,
}

/// Another design over the same output times. What is not known of it is empty.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Design {
    /// Name on the page: `changed`, `predicted to first order`, ...
    pub name: String,
    /// Source of the design.
    pub kind: DesignKind,
    /// By how much each variable is changed, in the order of [`Payload::variables`], in their units.
    pub change: Vec<f64>,
    /// A sentence on how the mechanism follows; may be empty.
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
    /// Distance from singular positions.
    pub margin: Option<Curve>,
}

/// Source of another design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// Solved anew.
    Exact,
    /// By sensitivities.
    FirstOrder,
    /// By first and second derivatives.
    SecondOrder,
    /// No design but one edge of where the curves of many lie.
    Band,
}

/// A quantity of another design with its two time derivatives; what is not known is empty.
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

/// Something that can be plotted over time, with its two time derivatives.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Quantity {
    /// The user's name, for example `toe`.
    pub name: String,
    /// Unit of `value`.
    pub unit: String,
    /// Unit of `rate`.
    pub rate_unit: String,
    /// Unit of `accel`.
    pub accel_unit: String,
    /// Heading under which it is offered: `measure`, `point`, `body` or `joint`.
    pub group: String,
    /// The quantity, `n` steps.
    pub value: Curve,
    /// First time derivative.
    pub rate: Curve,
    /// Second time derivative.
    pub accel: Curve,
    /// Target curve of a metric, `n` steps; empty without one.
    pub wanted: Curve,
}

/// Designs that were swept over: some of them, each as a point over variables and metrics.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepPlot {
    /// Meaning of a point: `design`, or `posture`.
    pub what: String,
    /// That many were solved.
    pub designs: usize,
    /// Point k is design `k * step`.
    pub step: usize,
    /// The swept variables, then the metrics.
    pub axes: Vec<SweepAxis>,
    /// Sobol's indices, where they were requested.
    pub indices: Vec<SweepIndex>,
}

/// A variable or a metric of swept designs.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepAxis {
    /// Name, and the case where there are several.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// True if it is a metric.
    pub metric: bool,
    /// Value in each point.
    pub values: Curve,
}

/// Sobol's indices of a metric by a variable, each with its standard error.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SweepIndex {
    /// The metric, an index into [`SweepPlot::axes`].
    pub metric: usize,
    /// The variable, an index into [`SweepPlot::axes`].
    pub variable: usize,
    /// First order.
    pub first: [f64; 2],
    /// Total.
    pub total: [f64; 2],
}

/// A case that sweeps two drivers over a grid. Tables have a row for each place of the second driver, with a number for
/// each of the first.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridMap {
    /// The case's name.
    pub name: String,
    /// The two drivers.
    pub drivers: [GridDriver; 2],
    /// Number of positions that were reached, and why others were not.
    pub note: String,
    /// Measured quantities.
    pub quantities: Vec<GridQuantity>,
}

/// A driver of a grid.
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

/// A measure over a grid.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridQuantity {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Values, row by row.
    pub values: Curve,
    /// Derivatives by design variables; none where they would be too many for a page.
    pub sensitivities: Vec<GridSensitivity>,
}

/// The derivative of a measure by a design variable over a grid.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct GridSensitivity {
    /// The variable.
    pub variable: String,
    /// The derivative's unit.
    pub unit: String,
    /// The derivatives, row by row.
    pub values: Curve,
}

/// Margin of the mechanism from singular positions: 1 is best, 0 is a singular position.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Margin {
    /// The margin, `n` steps.
    pub value: Curve,
    /// Meaning of its minimum.
    pub note: String,
}

/// A design variable: what it moves, whether the mechanism can follow, and what follows from it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Variable {
    /// The user's name.
    pub name: String,
    /// Meaning in a few words; may be empty.
    pub description: String,
    /// Unit of the variable, `1` for a pure number.
    pub unit: String,
    /// True if every joint stays intact under this design change.
    pub admissibility: Admissibility,
    /// A sentence with the joints concerned and their defect; empty when there is nothing to say.
    pub note: String,
    /// The design velocity at the hardpoints it moves.
    pub arrows: Vec<Arrow>,
    /// By how much it is typically changed, where the model says so.
    pub typical: Option<f64>,
    /// By how much it may be made wrong, either way, where the model says so.
    pub tolerance: Option<f64>,
    /// Least and largest change that is allowed, counted from the drawing, where the model says so.
    pub bounds: Option<[Option<f64>; 2]>,
    /// Per body, how it moves with the variable: six numbers per step, dx dy dz in the length unit and a rotation
    /// vector in rad, per unit of the variable; empty where that is not shown.
    pub shifts: Vec<Curve>,
    /// Sensitivities, at most one per quantity; empty when the mechanism cannot follow.
    pub sensitivities: Vec<Sensitivity>,
}

/// True if a mechanism can follow a design variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Admissibility {
    /// Every joint stays intact at the design configuration.
    Admissible,
    /// Some joint would open; the mechanism closes it again by moving.
    Reassembled,
    /// No motion closes the joint that opens: there is no sensitivity.
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

/// Total derivative of one quantity and of its rates with respect to one design variable.
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
    /// The same by re-solving a changed design, when that was requested.
    pub fd: Option<FiniteDifference>,
}

/// Central differences of re-solved designs, to be compared with a [`Sensitivity`].
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct FiniteDifference {
    /// The curves hold every that many of the `n` steps, from the first: they are drawn as a few marks.
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

/// A table of facts, its cells already formatted.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Table {
    /// Heading.
    pub title: String,
    /// A sentence under the heading; may be empty.
    pub note: String,
    /// Column headings.
    pub header: Vec<String>,
    /// Rows, each as long as `header`.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The same without the columns that are empty in every row.
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
/// When the payload does not serialise, which plain numbers and strings never do.
pub fn html(payload: &Payload) -> Result<String, serde_json::Error> {
    Ok(file(&payload.title, &packed(payload)?))
}

/// The file of a packed payload.
pub(crate) fn file(title: &str, packed: &[u8]) -> String {
    fill(include_str!("../page/report.html"), |slot| match slot {
        "title" => escape_text(title),
        "style" => include_str!("../page/app.css").to_owned(),
        "payload" => base64(packed),
        "engine" => include_str!(concat!(env!("OUT_DIR"), "/engine.wasm.txt")).to_owned(),
        "code" => include_str!(concat!(env!("OUT_DIR"), "/app.js.txt")).to_owned(),
        _ => panic!("the report template names an unknown slot `{slot}`"),
    })
}

/// Element in which a page finds the server that it comes from: empty in a file.
const SERVER: &str = "<script type=\"application/json\" id=\"server\">";

/// A page as a server sends it, reported `about` the server. Pages are those of this crate.
///
/// # Errors
/// When that does not serialise.
pub fn served(page: &str, about: &impl Serialize) -> Result<String, serde_json::Error> {
    let about = serde_json::to_string(about)?.replace('<', "\\u003c");
    Ok(page.replacen(SERVER, &format!("{SERVER}{about}"), 1))
}

/// Replaces every `{{slot}}` of the template; what is put in is never searched for slots again.
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

/// Text for between tags, or for an attribute in double quotes.
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
            first: None,
            over: None,
            designs: vec![],
            maps: vec![],
            sweep: None,
            margin: None,
            variables: vec![],
            checks: vec![],
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
    fn a_page_hears_of_its_server_and_of_nothing_else() {
        let page = html(&payload("sample")).unwrap();
        let served = served(&page, &["</script>"]).unwrap();
        assert!(served.contains(r#"id="server">["\u003c/script>"]</script>"#));
        assert_eq!(served.matches("</script").count(), page.matches("</script").count());
    }

    #[test]
    fn page_asks_the_network_for_nothing() {
        let page = html(&payload("sample")).unwrap();
        let (head, rest) = page.split_once("<style>").unwrap();
        let (_, body) = rest.split_once("</style>").unwrap();
        for markup in [head, body] {
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
        macro_rules! declare {
            ($($name:ident)*) => { $(
                expected += "\n";
                expected += &<$name as TS>::docs().unwrap_or_default();
                expected += &format!("export {}\n", <$name as TS>::decl(&config)).replace(" \n", "\n");
            )* };
        }
        declare!(
            Curve Payload ModelText Detail Units Status Fact BodyTrack PointRole Mesh JointMark JointCurve CouplerMark CouplerTerm
            DriverMark BodyPlace WheelMark DistanceMark LoadMark VehicleAxes Quantity Value Design DesignKind DesignCurves
            GridMap GridDriver GridQuantity GridSensitivity SweepPlot SweepAxis SweepIndex Margin Variable Admissibility Arrow Sensitivity FiniteDifference Table
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
