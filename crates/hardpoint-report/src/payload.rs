//! Payload of the page from a solution, in the user's units.
//!
//! All measures, named points and origins of bodies are quantities with sensitivities, compared with central
//! differences of re-solved designs if the caller has them. If that is too much for a page that opens at once, detail
//! is reduced in this order: the comparison of bodies is dropped, the motion is thinned, and finally the sensitivities
//! of bodies are dropped. The CSV files always contain everything.

mod clearance;
mod designs;
mod drawing;
mod first;
mod loads;
mod rigid;
mod values;

pub use designs::ChangedDesign;

use std::collections::BTreeMap;
use std::path::Path;

use hardpoint::joint::Quantity as Kind;
use hardpoint::load::Loads;
use hardpoint::model::{BodyId, Dimension, Driver, DriverId, Metric, Model, OutputSource, VariableId};
use hardpoint::run::{Clearances, DriverRates};
use hardpoint::sensitivity::{BodySensitivity, admissibility_at_design};
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Solution};
use hardpoint_file::{Appearance, ModelFile, Units};
use hardpoint_study::difference::Difference;
use hardpoint_study::{Comparison, NonsmoothClearances};
use hardpoint_table::series::{self, Scale, settled};

use crate::clearance::ClearanceFact;
use crate::course::{Course, RoundOff};
use crate::deflection::DeflectionFact;
use crate::encoding::{packed, size_in_page};
use crate::facts::{Facts, VariableAdmissibility};
use crate::figures::{error, number, order_unit, rounded, seconds, symbol};
use crate::joint_limits::JointLimitFact;
use crate::metric::MetricFact;
use crate::page::{
    self, Admissibility, Curve, Design, Detail, Fact, FiniteDifference, Margin, ModelText, NamedChange,
    NamedDesign, Payload, Plot, Quantity, Sensitivity, Status, Units as PageUnits, Variable,
};
use crate::summary::{RunStatus, Summary};

use loads::LoadCurve;

/// Approximate maximum number of output times on a page.
const MOST_STEPS: usize = 1000;
/// Maximum size of the page without its code, in bytes.
const MOST_BYTES: usize = 8 << 20;
/// Minimum and maximum size of a value of a smooth curve on the page, in bytes; the page is packed to measure its size
/// if these bounds do not decide whether it fits.
const BYTES_PER_VALUE: [f64; 2] = [0.2, 3.0];
/// Largest number of pairs of shapes in an estimate of the page's size: of many pairs few are ever the nearest ones.
const MOST_PAIRS: usize = 64;
/// Opening of a joint that the page calls a re-assembly, relative to the motion of the variable that opens it: rounded
/// coordinates of a file open joints by less.
const VISIBLE: f64 = 1e-5;
/// Number of marks of differences along a curve.
const MARKS: usize = 36;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Contents of a page: a run, and results that are shown alongside. [`Request::of`] contains the run only; a study adds
/// its own results.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Analysis that solved the model.
    pub analysis: &'a Analysis<'a>,
    /// Facts of the whole run.
    pub course: &'a Course,
    /// Summary of the run.
    pub summary: &'a Summary,
    /// `differences[b]`: differences by variable b, if there are any; empty without differences.
    pub differences: &'a [Option<Difference>],
    /// Another design over the same motion, if any.
    pub changed: Option<ChangedDesign<'a>>,
    /// Minima and contacts of the clearances, if the caller has them already.
    pub clearances: Option<&'a Clearances>,
}

impl<'a> Request<'a> {
    /// Contents of a run without studies.
    pub fn of(
        file: &'a ModelFile,
        analysis: &'a Analysis<'a>,
        course: &'a Course,
        summary: &'a Summary,
    ) -> Self {
        Self { file, analysis, course, summary, differences: &[], changed: None, clearances: None }
    }
}

/// Payload of a run.
pub fn payload(request: &Request<'_>) -> Payload {
    fitted(request, &|payload| payload).0
}

/// Changed design for a page of the nominal design with that detail; `request` is that of the nominal design.
pub fn design(request: &Request<'_>, changed: &ChangedDesign<'_>, shown: Detail) -> Design {
    let compose = Compose::new(request, None, shown);
    let (bodies, values) = (compose.bodies(), compose.values(request.summary));
    compose.exact(changed, request.course.stride, &bodies, &values)
}

/// Page as one self-contained HTML file. `finish` adds the results of a study to the payload.
///
/// # Errors
/// If the payload cannot be serialised, which does not happen with plain numbers and strings.
pub fn report(
    request: &Request<'_>,
    finish: &dyn Fn(Payload) -> Payload,
) -> Result<String, serde_json::Error> {
    let (payload, weighed) = fitted(request, finish);
    let data = weighed.map_or_else(|| packed(&payload), Ok)?;
    Ok(page::file(&payload.title, &data))
}

/// Finished payload with the highest detail that fits into a page, packed already if its size had to be measured.
fn fitted(request: &Request<'_>, finish: &dyn Fn(Payload) -> Payload) -> (Payload, Option<Vec<u8>>) {
    let (model, solution) = (&request.file.model, &request.course.kept);
    let size = Size {
        steps: solution.motion.len(),
        bodies: model.bodies.len() - 1,
        variables: model.variables.len(),
        outputs: solution.measured.outputs.len(),
        loads: loads::count(model) + model.elastic_directions().len() + model.given_forces().len(),
        compared: request.differences.iter().any(Option::is_some),
        pairs: model.clearances.iter().map(|c| c.pairs.len()).sum::<usize>().min(MOST_PAIRS),
        designs: request.changed.as_ref().map_or(0, ChangedDesign::designs)
            + usize::from(request.summary.rigid.is_some()),
    };
    let alone = driver_rates(request);
    let clearances = match request.clearances {
        Some(found) => Some(Ok(found.clone())),
        None => clearance::located(request),
    };
    let compose = |detail: Detail| finish(composed(request, alone.as_ref(), clearances.as_ref(), detail));
    let levels = Detail::levels(size, Bodies::of(request.course));
    let (last, levels) = levels.split_last().expect("there is always a least level");
    for level in levels {
        let [least, most] = BYTES_PER_VALUE.map(|bytes| level.values(size) * bytes);
        if least > MOST_BYTES as f64 {
            continue;
        }
        let payload = compose(*level);
        if most <= MOST_BYTES as f64 {
            return (payload, None);
        }
        if let Some(data) = packed(&payload).ok().filter(|data| size_in_page(data) <= MOST_BYTES) {
            return (payload, Some(data));
        }
    }
    (compose(*last), None)
}

/// Rates of each driver alone, if several move and there are variables: over an abscissa other than time, a driver
/// compensates while a variable changes. If only one driver moves, its rates are those of the motion.
fn driver_rates(request: &Request<'_>) -> Option<DriverRates> {
    let (model, times) = (request.analysis.model(), &request.course.kept.motion.times);
    let moves = |driver: &Driver| {
        let travel = Span::of(times.iter().map(|t| driver.law.at(*t).value()));
        travel.range() > 0.0
    };
    let several = model.drivers.iter().filter(|d| moves(d)).count() > 1;
    // An equilibrium has no rates of its own.
    if !several && model.equilibrium.is_none() || model.variables.is_empty() {
        return None;
    }
    let model = Model { times: times.clone(), ..model.clone() };
    let analysis = Analysis::with(&model, request.analysis.topology().formulation).ok()?;
    let drivers: Vec<DriverId> = (0..model.drivers.len()).map(DriverId).collect();
    Some(analysis.driver_rates(&drivers))
}

/// Payload with a given detail.
fn composed(
    request: &Request<'_>,
    alone: Option<&DriverRates>,
    clearances: Option<&Result<Clearances, String>>,
    detail: Detail,
) -> Payload {
    let &Request { file, course, summary, differences, ref changed, .. } = request;
    let (model, units, solution) = (&file.model, file.units, &course.kept);
    let compose = Compose::new(request, alone, detail);
    let (bodies, values) = (compose.bodies(), compose.values(summary));
    let mut designs = changed
        .as_ref()
        .map_or_else(Vec::new, |changed| compose.designs(changed, course.stride, &bodies, &values));
    let loads = compose.solved_loads(&[]);
    let deflections = DeflectionFact::all(model, units, &loads);
    let mut notes = summary.model.all_notes();
    match &summary.rigid {
        Some(Ok(solved)) => designs.push(compose.rigid(solved, &loads, &bodies, &values)),
        Some(Err(why)) => notes.push(why.clone()),
        None => {}
    }
    let located = match clearances {
        Some(Ok(found)) => Some(found),
        Some(Err(why)) => {
            notes.push(why.clone());
            None
        }
        None => None,
    };
    let distances = located.map(|found| ClearanceFact::all(request.analysis.model(), units, found));
    Payload {
        title: model.name.clone(),
        description: file.description.clone().unwrap_or_default(),
        file: file_name(file.file_name()),
        generator: crate::GENERATOR.into(),
        units: PageUnits {
            length: units.length.symbol().into(),
            angle: units.angle.symbol().into(),
            time: "s".into(),
        },
        status: status(
            summary,
            changed.as_ref().and_then(|changed| changed.stopped(file)),
            Detail { stride: detail.stride * course.stride, ..detail },
        ),
        summary: headline(summary),
        notes,
        times: compose.curve(|k| solution.motion.times[k]),
        bodies,
        joints: compose.joints(),
        couplers: compose.couplers(),
        drivers: compose.drivers(),
        wheels: compose.wheels(),
        distances: compose.distances(),
        loads: compose.loads(&loads),
        vehicle: compose.vehicle(),
        quantities: compose.quantities(&loads),
        values,
        first: compose.first(course),
        over: None,
        plots: compose.plots(),
        designs,
        named_designs: compose.named_designs(),
        maps: Vec::new(),
        sweep: None,
        margin: summary.margin.as_ref().map(|m| Margin {
            value: compose.curve(|k| m.series.get(k).copied().unwrap_or(f64::NAN)),
            note: m.sentence(),
        }),
        variables: compose.variables(&summary.model, differences),
        covariance_root: None,
        study: None,
        metrics: MetricFact::page_table(&summary.metrics),
        checks: summary
            .assembly
            .iter()
            .flat_map(|a| a.tables())
            .chain(DeflectionFact::table(&deflections))
            .chain(JointLimitFact::table(&summary.joint_limits))
            .chain(distances.and_then(|facts| ClearanceFact::table(&facts)))
            .chain(summary.validity_table())
            .chain(summary.model.tables())
            .collect(),
        clearance: compose.clearance(located),
        model: Some(ModelText {
            file: file_name(file.file_name()),
            text: file.text().to_owned(),
            files: file.page_texts(),
            case: file.case.clone(),
            shown: Some(detail),
        }),
    }
}

/// Stored motion of bodies by the variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bodies {
    /// All orders.
    Whole,
    /// Translations and rotations only, with a stride.
    Places(usize),
    /// Nothing.
    Nothing,
}

impl Bodies {
    fn of(course: &Course) -> Self {
        match course.shift_stride() {
            _ if course.has_bodies() => Self::Whole,
            Some(stride) => Self::Places(stride),
            None => Self::Nothing,
        }
    }
}

/// Size of the contents.
#[derive(Clone, Copy, Debug)]
struct Size {
    steps: usize,
    /// Bodies without ground.
    bodies: usize,
    variables: usize,
    outputs: usize,
    /// Forces on bodies, deflections and given forces.
    loads: usize,
    /// True if there are differences for comparison.
    compared: bool,
    /// Pairs of shapes whose distances are shown.
    pairs: usize,
    /// Other designs that are shown alongside.
    designs: usize,
}

impl Detail {
    /// Levels of detail, from full to minimum.
    fn levels(size: Size, bodies: Bodies) -> Vec<Self> {
        let stride = size.steps.div_ceil(MOST_STEPS).max(1);
        let all = Self { stride, origins: true, bodies: true, body_rates: true, body_differences: true };
        let exact = Self { body_differences: false, ..all };
        let places = Self { body_rates: false, ..exact };
        let none = Self { bodies: false, ..places };
        // Fewer steps first, as long as curves stay smooth. Then the bodies lose their sensitivities, which draw a
        // changed design. Then fewer steps still.
        let coarser = |detail: Self, every: usize, least: usize| {
            let first = stride.next_multiple_of(every);
            let strides = (first..).step_by(every).map(move |stride| Self { stride, ..detail });
            strides.take_while(move |d| d.stride == first || size.steps.div_ceil(d.stride) >= least)
        };
        let smooth = MOST_STEPS / 4;
        let mut levels: Vec<Self> = match bodies {
            Bodies::Whole => {
                let exact = [all].into_iter().chain(coarser(exact, 1, smooth));
                exact.chain(coarser(places, 1, smooth)).collect()
            }
            Bodies::Places(every) => coarser(places, every, smooth).collect(),
            Bodies::Nothing => Vec::new(),
        };
        levels.extend(coarser(none, 1, MOST_STEPS / 10));
        // With very many bodies, the curves of their origins would be most of the page.
        levels.extend(levels.last().map(|d| Self { origins: false, ..*d }));
        levels
    }

    /// Number of values in the curves of the page.
    fn values(self, size: Size) -> f64 {
        let steps = size.steps.div_ceil(self.stride);
        let origins = 3 * size.bodies;
        let shown = if self.origins { origins } else { 0 };
        let motion = 3 * (size.outputs + shown + size.loads) + 7 * (size.bodies + 1 + size.pairs);
        // Translation and rotation of a body; the sensitivity of its origin's position is the same numbers.
        let bodies = if self.bodies { 2 * origins } else { 0 };
        let rates = if self.body_rates { 2 * origins } else { 0 };
        let compared = size.outputs + if self.body_differences { origins } else { 0 };
        let marks = if size.compared { 3 * compared * MARKS.min(steps) } else { 0 };
        ((motion * (1 + size.designs) + size.variables * (3 * size.outputs + bodies + rates)) * steps
            + size.variables * marks) as f64
    }
}

/// Stride of the marks among the shown output times, rounded so that the number of marks is nearest to 36.
pub fn stride_of_marks(steps: usize) -> usize {
    ((steps + MARKS / 2) / MARKS).max(1)
}

/// Stride of the marks among the shown steps: every `shown`-th of the stored ones is shown, and differences are known
/// at every `known`-th.
fn shown_stride_of_marks(known: usize, shown: usize, steps: usize) -> usize {
    // Stride of the steps that are both shown and known
    let common = (1..=known).find(|n| (n * shown).is_multiple_of(known)).unwrap_or(known);
    stride_of_marks(steps).div_ceil(common) * common
}

fn file_name(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.into(), |n| n.to_string_lossy().into_owned())
}

/// Status of the run, with the sentence on a changed design that stopped early.
fn status(summary: &Summary, changed: Option<String>, detail: Detail) -> Status {
    let steps = &summary.steps;
    let complete = summary.status == RunStatus::Complete && changed.is_none();
    let today = match (&summary.stop, summary.status) {
        (Some(stop), RunStatus::Stopped) => {
            let (code, what) = (stop.code, &stop.message);
            format!("Solved {} of {} steps; then {what} ({code}).", steps.solved, steps.asked)
        }
        (_, RunStatus::Interrupted) => {
            format!("Solved {} of {} steps; then the run was interrupted.", steps.solved, steps.asked)
        }
        _ => format!("All {} steps were solved.", steps.asked),
    };
    let mut message = match changed {
        Some(changed) => format!("{changed} Today's design: {}", uncapitalised(&today)),
        None => today,
    };
    if detail.stride > 1 {
        let (shown, stride) = (summary.steps.solved.div_ceil(detail.stride), detail.stride);
        message += &format!(
            " This page shows every {} step, {shown} in all; the tables hold all of them.",
            ordinal(stride)
        );
    }
    if detail.bodies && !detail.body_rates && !summary.model.variables.is_empty() {
        message += " Of body origins the sensitivities of velocities and accelerations are not shown; `run --bodies` writes them.";
    }
    if !detail.bodies && summary.model.counts.bodies > 0 && !summary.model.variables.is_empty() {
        message += " Sensitivities of body origins are not shown; `run --bodies` writes them.";
    }
    Status { complete, message }
}

fn uncapitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().to_string() + letters.as_str())
}

/// Ordinal number: `2nd`, `4th`, `32nd`.
fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

/// Key figures at the top of the page.
fn headline(summary: &Summary) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let (model, steps) = (&summary.model, &summary.steps);
    let cut = model.joints.iter().filter(|j| j.role == "cut").count();
    let span = format!("{} to {} s", number(steps.start), number(steps.last_solved.unwrap_or(steps.start)));
    let bodies = match model.counts.bodies {
        1 => "1 body".to_owned(),
        n => format!("{n} bodies"),
    };
    let mut facts = vec![
        fact("degrees of freedom", model.freedom_line()),
        fact("bodies and joints", format!("{bodies}, {} ({cut} cut)", model.joints_text())),
        fact("loops", model.loops_line()),
    ];
    if model.counts.redundant_constraints > 0 {
        facts.push(fact("redundant constraints", model.counts.redundant_constraints.to_string()));
    }
    facts.push(fact("steps", format!("{}, {span}", steps.solved)));
    facts.push(fact("worst residual", format!("{} m or rad", error(summary.effort.worst_residual_si))));
    if let Some(margin) = &summary.margin {
        facts
            .push(fact("least margin", format!("{} at {} s", rounded(margin.least, 2), number(margin.time))));
    }
    if !model.variables.is_empty() {
        facts.push(fact("design variables", model.variables_line()));
    }
    // There is no clock in the browser.
    if summary.timings.solve > 0.0 {
        facts.push(fact("solved in", seconds(summary.timings.solve)));
    }
    facts
}

struct Compose<'a> {
    model: &'a Model,
    looks: &'a Appearance,
    /// Minimum and maximum of metrics by name, SI.
    limits: &'a BTreeMap<String, [Option<f64>; 2]>,
    units: Units,
    analysis: &'a Analysis<'a>,
    course: &'a Course,
    /// Stored results.
    solution: &'a Solution,
    /// Shown output times, as indices of stored ones.
    steps: Vec<usize>,
    detail: Detail,
    round_off: RoundOff,
    /// Rates of each driver alone at the stored output times, if several move.
    alone: Option<&'a DriverRates>,
}

/// Minimum and maximum of a curve.
#[derive(Clone, Copy, Debug)]
struct Span {
    least: f64,
    greatest: f64,
}

impl Span {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let none = Self { least: f64::INFINITY, greatest: f64::NEG_INFINITY };
        values.fold(none, |s, x| Self { least: s.least.min(x), greatest: s.greatest.max(x) })
    }

    /// Negative if there is no value.
    fn range(self) -> f64 {
        self.greatest - self.least
    }

    /// Value of the curve without round-off: 0 if it is round-off, and constant if the curve varies by round-off only.
    fn shown(self, x: f64, round_off: f64) -> f64 {
        let x =
            if x.is_finite() && self.range() <= round_off { 0.5 * (self.least + self.greatest) } else { x };
        settled(x, round_off)
    }
}

impl<'a> Compose<'a> {
    fn new(request: &Request<'a>, alone: Option<&'a DriverRates>, detail: Detail) -> Self {
        let &Request { file, analysis, course, .. } = request;
        Self {
            model: &file.model,
            looks: &file.drawing,
            limits: &file.limits,
            units: file.units,
            analysis,
            course,
            solution: &course.kept,
            steps: (0..course.kept.motion.len()).step_by(detail.stride).collect(),
            detail,
            round_off: course.round_off(&file.model),
            alone,
        }
    }

    fn curve(&self, value: impl Fn(usize) -> f64) -> Curve {
        self.steps.iter().map(|&k| value(k)).collect()
    }

    /// Value, rate and acceleration up to `orders`; the others are empty.
    fn curves(&self, orders: usize, value: impl Fn(usize, usize) -> f64) -> [Curve; 3] {
        [0, 1, 2].map(|order| if order < orders { self.curve(|k| value(k, order)) } else { Curve::default() })
    }

    fn length(&self, v: Vec3) -> [f64; 3] {
        v.to_array().map(|x| self.units.from_si(Kind::Length, x))
    }

    /// Quantities: all outputs, then x, y and z of every body's origin, then deflections and
    /// given forces.
    fn quantities(&self, loads: &Loads) -> Vec<Quantity> {
        let measured = &self.solution.measured;
        let outputs = measured.outputs.iter().enumerate().map(|(m, output)| {
            let value = |k, order: usize| measured.value(k, m)[order];
            let group = if matches!(output.source, OutputSource::Measure(_)) { "measure" } else { "point" };
            let kind = self.model.type_of(output.source);
            let quantity =
                self.quantity(&output.name, output.dimension, output.known.orders, (group, kind), value);
            Quantity { wanted: self.wanted(output.source, output.dimension), ..quantity }
        });
        let bodies = if self.detail.origins { self.model.bodies.len() } else { 1 };
        let origins = (1..bodies).flat_map(|b| (0..3).map(move |axis| (b, axis))).map(|(b, axis)| {
            let name = format!("{}.{}", self.model.bodies[b].name, AXES[axis]);
            let value = |k, order: usize| {
                let s = &self.solution.motion.at(k).body(b);
                [s.r, s.v, s.a][order].to_array()[axis]
            };
            self.quantity(&name, Dimension::LENGTH, 3, ("body", "position"), value)
        });
        let of_loads =
            self.load_curves(loads).into_iter().map(|LoadCurve { name, group, dimension, curve }| Quantity {
                value: curve,
                ..self.quantity(&name, dimension, 0, (group, group), |_, _| f64::NAN)
            });
        outputs.chain(origins).chain(of_loads).collect()
    }

    /// Plots of the model file.
    fn plots(&self) -> Vec<Plot> {
        let outputs = &self.solution.measured.outputs;
        let place = |source: OutputSource| outputs.iter().position(|o| o.source == source);
        let plot = |plot: &hardpoint::model::Plot| {
            let y = plot.y.iter().map(|source| place(*source)).collect::<Option<Vec<_>>>()?;
            match plot.over {
                None => Some(Plot { y, over: None }),
                Some(over) => Some(Plot { y, over: Some(place(over)?) }),
            }
        };
        self.model.plots.iter().filter_map(plot).collect()
    }

    /// Named designs of the model file.
    fn named_designs(&self) -> Vec<NamedDesign> {
        // A motion that is solved without variables has no designs.
        let change = |(variable, by): &(VariableId, f64)| {
            let of = self.model.variables.get(variable.0)?;
            Some(NamedChange { name: of.name.clone(), by: self.units.from_si(of.quantity, *by) })
        };
        let design = |design: &hardpoint::model::NamedDesign| {
            let changes = design.changes.iter().map(change).collect::<Option<_>>()?;
            Some(NamedDesign { name: design.name.clone(), changes })
        };
        self.model.designs.iter().filter_map(design).collect()
    }

    /// Quantity from a function of step and order, SI. `group` and `kind` are its heading and its type.
    fn quantity(
        &self,
        name: &str,
        dimension: Dimension,
        orders: usize,
        (group, kind): (&str, &str),
        value: impl Fn(usize, usize) -> f64,
    ) -> Quantity {
        let [unit, rate_unit, accel_unit] = [0, 1, 2].map(|order| order_unit(self.units, dimension, order));
        let spans = [0, 1, 2].map(|order| Span::of((0..self.solution.motion.len()).map(|k| value(k, order))));
        let (per_si, round_off) =
            (self.units.per_si(dimension), [0, 1, 2].map(|order| self.round_off.value(dimension, order)));
        let [value, rate, accel] =
            self.curves(orders, |k, order| spans[order].shown(value(k, order), round_off[order]) * per_si);
        let (name, group, wanted) = (name.into(), group.into(), Curve::default());
        Quantity { name, unit, rate_unit, accel_unit, group, kind: kind.into(), value, rate, accel, wanted }
    }

    /// Target curve of the first metric that has one for this output.
    fn wanted(&self, of: OutputSource, kind: Dimension) -> Curve {
        let (measured, times) = (&self.solution.measured, &self.solution.motion.times);
        let has = |m: &&Metric| m.of == of && m.take.target_points().is_some();
        let Some(metric) = self.model.metrics.iter().find(has) else { return Curve::default() };
        let over = metric.over.and_then(|over| measured.outputs.iter().position(|o| o.source == over));
        let at = |k: usize| over.map_or(times[k], |m| measured.value(k, m)[0]);
        self.curve(|k| self.units.from_si(kind, metric.target_at(at(k)).unwrap_or(f64::NAN)))
    }

    fn variables(&self, facts: &Facts, differences: &[Option<Difference>]) -> Vec<Variable> {
        let is_compared = differences.iter().any(Option::is_some);
        let nonsmooth = is_compared.then(|| NonsmoothClearances::of(self.model, self.solution));
        let variable = |(b, fact): (usize, &crate::facts::VariableFact)| {
            let known =
                matches!(fact.answer, VariableAdmissibility::Admissible | VariableAdmissibility::Reassembled);
            let of = &self.model.variables[b];
            let shown = |x: f64| self.units.from_si(of.quantity, x);
            let difference = differences.get(b).and_then(Option::as_ref).zip(nonsmooth.as_ref());
            Variable {
                name: fact.name.clone(),
                description: fact.change.replace('`', ""),
                unit: fact.unit.clone(),
                admissibility: match fact.answer {
                    VariableAdmissibility::Admissible | VariableAdmissibility::Unknown => {
                        Admissibility::Admissible
                    }
                    VariableAdmissibility::Reassembled if self.opens_visibly(VariableId(b)) => {
                        Admissibility::Reassembled
                    }
                    VariableAdmissibility::Reassembled => Admissibility::Admissible,
                    VariableAdmissibility::CannotFollow => Admissibility::CannotFollow,
                },
                note: fact.note(),
                arrows: self.arrows(VariableId(b)),
                typical: of.typical.map(shown),
                tolerance: of.tolerance.map(shown),
                bounds: of.bounds.map(|ends| ends.map(|x| x.is_finite().then(|| shown(x)))),
                shifts: if known && self.detail.bodies { self.shifts(b) } else { Vec::new() },
                sensitivities: if known { self.sensitivities(b, difference) } else { Vec::new() },
            }
        };
        facts.variables.iter().enumerate().map(variable).collect()
    }

    /// True if a variable opens a joint by a visible part of its own motion.
    fn opens_visibly(&self, variable: VariableId) -> bool {
        let field = self.model.field(variable);
        let speed = field.markers.iter().map(|m| m.twist.w.norm().max(m.twist.v.norm())).fold(0.0, f64::max);
        admissibility_at_design(self.model, &field).iter().any(|open| !(open.value <= VISIBLE * speed))
    }

    /// First-order motion of every body by a variable.
    fn shifts(&self, b: usize) -> Vec<Curve> {
        let by = self.model.variables[b].quantity;
        let [place, ..] = self.derivatives_shown(b, Dimension::LENGTH);
        let turn = Scale {
            per_si: self.units.derivative_from_si(Kind::Number, by, 1.0),
            round_off: self.round_off.of(b, Kind::Angle.into(), 0),
        };
        let of_body = |body: usize| -> Curve {
            series::of_shifts(&self.course.shifts(&self.steps, b, body), [place, turn]).into()
        };
        (0..self.model.bodies.len()).map(of_body).collect()
    }

    fn sensitivities(
        &self,
        b: usize,
        difference: Option<(&Difference, &NonsmoothClearances)>,
    ) -> Vec<Sensitivity> {
        let measured = &self.solution.measured;
        let columns = measured.outputs.len();
        let bodies = self.model.bodies.len();
        let (model, solution) = (self.model, self.solution);
        let comparison =
            difference.map(|(d, nonsmooth)| Comparison::with_clearances(model, solution, nonsmooth, d));
        let difference = difference.map(|(d, _)| d);
        let mut list = Vec::new();
        for (m, output) in measured.outputs.iter().enumerate() {
            let overlay = difference.zip(comparison.as_ref()).map(|(d, comparison)| {
                (d, comparison.of_output(m), move |k: usize, order: usize| {
                    d.outputs[k / d.stride * columns + m][order]
                })
            });
            let scales = self.derivatives_shown(b, output.dimension);
            let orders = output.known.orders;
            let exact = [0, 1, 2].map(|order| -> Curve {
                let of = (VariableId(b), m, order);
                if order < orders {
                    series::of_output(self.solution, &self.steps, of, scales[order]).into()
                } else {
                    Curve::default()
                }
            });
            list.push(self.sensitivity(list.len(), (b, orders), scales, exact, overlay));
        }
        let bodies_shown = if self.detail.bodies { bodies } else { 1 };
        for body in 1..bodies_shown {
            let scales = self.derivatives_shown(b, Dimension::LENGTH);
            let orders = if self.detail.body_rates { 3 } else { 1 };
            let mut exact = self.of_origin(b, body, orders, scales);
            for axis in 0..3 {
                let of = |s: &BodySensitivity, order: usize| series::ORIGIN[order](s).to_array()[axis];
                let overlay = difference.zip(comparison.as_ref()).filter(|_| self.detail.body_differences);
                let overlay = overlay.map(|(d, comparison)| {
                    (d, comparison.of_origin(BodyId(body)), move |k: usize, order: usize| {
                        of(&d.bodies[k / d.stride * bodies + body], order)
                    })
                });
                let exact = exact.each_mut().map(|curves| std::mem::take(&mut curves[axis]));
                list.push(self.sensitivity(list.len(), (b, orders), scales, exact, overlay));
            }
        }
        list
    }

    /// Derivatives of x, y and z of a body's origin by variable b, for each order of time derivative.
    fn of_origin(&self, b: usize, body: usize, orders: usize, scales: [Scale; 3]) -> [[Curve; 3]; 3] {
        [0, 1, 2].map(|order| {
            if order >= orders {
                return Default::default();
            }
            if order == 0 {
                let shifts = self.course.shifts(&self.steps, b, body);
                return [0, 1, 2].map(|axis| shifts.iter().map(|s| scales[0].shown(s[axis])).collect());
            }
            series::of_origin(self.solution, &self.steps, (VariableId(b), body, order), scales[order])
                .map(Curve::from)
        })
    }

    /// Sensitivity, with the comparison if there is one.
    fn sensitivity<F: Fn(usize, usize) -> f64>(
        &self,
        quantity: usize,
        (b, orders): (usize, usize),
        scales: [Scale; 3],
        [value, rate, accel]: [Curve; 3],
        overlay: Option<(&Difference, [f64; 3], F)>,
    ) -> Sensitivity {
        let fd = overlay.map(|(d, worst, difference)| {
            let stride = shown_stride_of_marks(d.stride, self.detail.stride, self.steps.len());
            let marks = |order: usize| {
                let of = |&k: &usize| scales[order].shown(difference(k, order));
                let steps = self.steps.iter().step_by(stride).filter(|_| order < orders);
                steps.map(of).collect::<Curve>()
            };
            let [value, rate, accel] = [0, 1, 2].map(marks);
            let by = self.model.variables[b].quantity;
            let step = self.units.from_si(by, d.step);
            FiniteDifference {
                stride,
                value,
                rate,
                accel,
                step,
                step_unit: symbol(self.units, by).into(),
                worst,
            }
        });
        Sensitivity { quantity, value, rate, accel, fd }
    }

    /// Returns the conversions of a derivative by variable b, by the order of its time derivative.
    fn derivatives_shown(&self, b: usize, kind: Dimension) -> [Scale; 3] {
        let per_si = self.units.derivative_from_si(kind, self.model.variables[b].quantity, 1.0);
        [0, 1, 2].map(|order| Scale { per_si, round_off: self.round_off.of(b, kind, order) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRUT: Size = Size {
        steps: 501,
        bodies: 4,
        variables: 16,
        outputs: 13,
        loads: 0,
        compared: true,
        pairs: 0,
        designs: 0,
    };

    #[test]
    fn a_suspension_is_shown_with_all_that_there_is() {
        let all = Detail::levels(STRUT, Bodies::Whole)[0];
        assert_eq!(
            all,
            Detail { stride: 1, origins: true, bodies: true, body_rates: true, body_differences: true }
        );
        assert!(all.values(STRUT) * BYTES_PER_VALUE[1] <= MOST_BYTES as f64);
        // Sensitivities of bodies that are not stored cannot be shown.
        assert!(Detail::levels(STRUT, Bodies::Nothing).iter().all(|d| !d.bodies));
    }

    #[test]
    fn marks_are_distinct_and_numerous() {
        for steps in 1..=2 * MOST_STEPS {
            let marks = steps.div_ceil(stride_of_marks(steps));
            assert!(marks >= steps.min(2 * MARKS / 3) && 2 * marks <= 3 * MARKS, "{marks} of {steps}");
        }
    }

    #[test]
    fn marks_are_where_differences_are_known() {
        for (known, shown, steps) in
            [(1, 1, 501), (13, 1, 501), (13, 2, 251), (13, 4, 126), (7, 3, 90), (1, 5, 9)]
        {
            let stride = shown_stride_of_marks(known, shown, steps);
            assert_eq!(stride * shown % known, 0);
            assert!(stride >= stride_of_marks(steps), "{stride}");
        }
        let all = stride_of_marks(501);
        assert_eq!(shown_stride_of_marks(all, 1, 501), all);
    }

    #[test]
    fn a_long_motion_is_thinned() {
        let long = Size { steps: 100_001, ..STRUT };
        let all = Detail::levels(long, Bodies::Whole)[0];
        assert!(all.body_differences && all.stride == 101, "{all:?}");
    }

    #[test]
    fn levels_show_less_and_less_and_a_hundred_steps_remain() {
        for size in
            [STRUT, Size { steps: 7, ..STRUT }, Size { steps: 30_000, bodies: 80, variables: 240, ..STRUT }]
        {
            let levels = Detail::levels(size, Bodies::Whole);
            assert!(levels.is_sorted_by(|a, b| !b.bodies || a.bodies), "bodies go and do not come back");
            let last = levels.last().unwrap();
            assert!(
                !last.origins && size.steps.div_ceil(last.stride) >= size.steps.min(MOST_STEPS / 10),
                "{last:?}"
            );
        }
    }
}
