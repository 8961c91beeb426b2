//! From a solution to everything that the page shows, in the user's units.
//!
//! All measures and named points, and the origins of all bodies, are offered as quantities with their
//! sensitivities; each is compared with central differences of re-solved designs where the caller has them.
//! A long motion is thinned and, where that is not enough, the bodies lose their sensitivities, so that the
//! page stays small enough to open at once: the CSV files hold everything.

mod designs;
mod drawing;

use std::path::Path;

use hardpoint::joint::Quantity as Kind;
use hardpoint::model::{BodyId, Dimension, Model, OutputSource, VariableId};
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;
use hardpoint::study::{Comparison, Difference, WhatIf};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, Units};

use crate::course::{Course, RoundOff};
use crate::facts::{Answer, Facts};
use crate::figures::{error, number, order_unit, rounded, seconds, symbol};
use crate::metric::MetricFact;
use crate::page::{
    Admissibility, Curve, Fact, FiniteDifference, Margin, Payload, Quantity, Sensitivity, Status,
    Units as PageUnits, Variable,
};
use crate::summary::{RunStatus, Summary};
use crate::validity::ValidityFact;

/// The page shows at most about this many output times.
const MOST_STEPS: usize = 1000;
/// All curves together take at most about this many bytes of the page.
const MOST_BYTES: usize = 4 << 20;
/// A value of a curve in the page: 4 bytes in base64.
const BYTES_PER_VALUE: f64 = 16.0 / 3.0;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Everything that the page shows of a run. `differences[b]` are those of variable b, where there are any.
pub fn payload(
    file: &ModelFile,
    analysis: &Analysis<'_>,
    course: &Course,
    differences: &[Option<Difference>],
    summary: &Summary,
) -> Payload {
    payload_beside(file, analysis, course, differences, summary, None)
}

/// The same with a changed design beside today's, where one is given; `course` is what was gathered of today's whole solution.
pub fn payload_beside(
    file: &ModelFile,
    analysis: &Analysis<'_>,
    course: &Course,
    differences: &[Option<Difference>],
    summary: &Summary,
    changed: Option<&WhatIf>,
) -> Payload {
    let (model, units, solution) = (&file.model, file.units, &course.kept);
    let size = Size {
        steps: solution.motion.len(),
        bodies: model.bodies.len() - 1,
        variables: model.variables.len(),
        outputs: solution.measured.outputs.len(),
        compared: differences.iter().any(Option::is_some),
        designs: changed.map_or(0, |_| designs::MOST),
    };
    let detail = Detail::that_fits(size, course.has_bodies());
    let steps: Vec<usize> = (0..solution.motion.len()).step_by(detail.stride).collect();
    let compose =
        Compose { model, units, analysis, solution, steps, detail, round_off: course.round_off(model) };
    let (bodies, values) = (compose.bodies(), Vec::new());
    let designs =
        changed.map_or_else(Vec::new, |what_if| compose.designs(what_if, course.stride, &bodies, &values));
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
        status: status(summary, Detail { stride: detail.stride * course.stride, ..detail }),
        summary: headline(summary),
        notes: summary.model.all_notes(),
        times: compose.curve(|k| solution.motion.times[k]),
        bodies,
        joints: compose.joints(),
        couplers: compose.couplers(),
        drivers: compose.drivers(),
        wheels: compose.wheels(),
        distances: compose.distances(),
        vehicle: compose.vehicle(),
        quantities: compose.quantities(),
        values,
        first: None,
        over: None,
        designs,
        margin: summary.margin.as_ref().map(|m| Margin {
            value: compose.curve(|k| m.series.get(k).copied().unwrap_or(f64::NAN)),
            note: m.sentence(),
        }),
        variables: compose.variables(&summary.model, differences),
        checks: MetricFact::table(&summary.metrics)
            .into_iter()
            .chain(summary.assembly.iter().flat_map(|a| a.tables()))
            .chain(ValidityFact::table(summary))
            .chain(summary.model.tables())
            .collect(),
    }
}

/// How much the page shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Detail {
    /// Every so many steps.
    stride: usize,
    /// Curves of body origins.
    origins: bool,
    /// Sensitivities of body origins.
    bodies: bool,
    /// Their comparison with differences.
    body_differences: bool,
}

/// How much there is to show.
#[derive(Clone, Copy, Debug)]
struct Size {
    steps: usize,
    /// Without ground.
    bodies: usize,
    variables: usize,
    outputs: usize,
    /// Whether there are differences to compare with.
    compared: bool,
    /// Other designs that are shown beside this one.
    designs: usize,
}

impl Detail {
    /// All that there is, or as much of it as keeps the page small.
    fn that_fits(size: Size, bodies: bool) -> Self {
        let stride = size.steps.div_ceil(MOST_STEPS).max(1);
        let all = Self { stride, origins: true, bodies: true, body_differences: true };
        let exact_bodies = Self { body_differences: false, ..all };
        let least = Self { bodies: false, ..exact_bodies };
        // Fewer steps first, as long as curves stay smooth; then the bodies lose their sensitivities, by which a changed design
        // is drawn; then fewer steps still.
        let coarser = |detail: Self, least: usize| {
            let strides = (stride..).map(move |stride| Self { stride, ..detail });
            strides.take_while(move |d| d.stride == stride || size.steps.div_ceil(d.stride) >= least)
        };
        let with_bodies = std::iter::once(all).chain(coarser(exact_bodies, MOST_STEPS / 4));
        let without = || coarser(least, MOST_STEPS / 10);
        // In a model of very many bodies, their own curves would be most of the page.
        let coarsest = without().last().map_or(least, |d| Self { origins: false, ..d });
        let mut levels = with_bodies.filter(|_| bodies).chain(without());
        levels.find(|d| d.bytes(size) <= MOST_BYTES as f64).unwrap_or(coarsest)
    }

    /// What the curves of the page take.
    fn bytes(self, size: Size) -> f64 {
        let both = if size.compared { 2 } else { 1 };
        let origins = 3 * size.bodies;
        // With the two curves, of place and turn, by which a changed design is drawn.
        let of_origins = match (self.bodies, self.body_differences) {
            (true, true) => origins * both + 2 * size.bodies,
            (true, false) => origins + 2 * size.bodies,
            (false, _) => 0,
        };
        let shown = if self.origins { origins } else { 0 };
        let motion = 3 * (size.outputs + shown) + 7 * (size.bodies + 1);
        let curves = motion * (1 + size.designs) + 3 * size.variables * (size.outputs * both + of_origins);
        (curves * size.steps.div_ceil(self.stride)) as f64 * BYTES_PER_VALUE
    }
}

fn file_name(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.into(), |n| n.to_string_lossy().into_owned())
}

fn status(summary: &Summary, detail: Detail) -> Status {
    let steps = &summary.steps;
    let mut message = match (&summary.stop, summary.status) {
        (Some(stop), RunStatus::Stopped) => {
            let (code, what) = (stop.code, &stop.message);
            format!("Solved {} of {} steps; then {what} ({code}).", steps.solved, steps.asked)
        }
        (_, RunStatus::Interrupted) => {
            format!("Solved {} of {} steps; then the run was interrupted.", steps.solved, steps.asked)
        }
        _ => format!("All {} steps were solved.", steps.asked),
    };
    if detail.stride > 1 {
        let (shown, stride) = (summary.steps.solved.div_ceil(detail.stride), detail.stride);
        message += &format!(
            " This page shows every {} step, {shown} in all; the tables hold all of them.",
            ordinal(stride)
        );
    }
    if !detail.bodies && summary.model.counts.bodies > 0 && !summary.model.variables.is_empty() {
        message += " Sensitivities of body origins are not shown; `run --bodies` writes them.";
    }
    Status { complete: summary.status == RunStatus::Complete, message }
}

/// `2nd`, `4th`, `32nd`.
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

/// The handful of figures at the top.
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
    facts.push(fact("solved in", seconds(summary.timings.solve)));
    facts
}

struct Compose<'a> {
    model: &'a Model,
    units: Units,
    analysis: &'a Analysis<'a>,
    solution: &'a Solution,
    /// The output times that are shown.
    steps: Vec<usize>,
    detail: Detail,
    round_off: RoundOff,
}

/// Orders of time derivative of a body's origin.
type Orders = [fn(&BodySensitivity) -> Vec3; 3];
const ORIGIN: Orders = [|s| s.dr, |s| s.dv, |s| s.da];

impl Compose<'_> {
    fn curve(&self, value: impl Fn(usize) -> f64) -> Curve {
        self.steps.iter().map(|&k| value(k)).collect()
    }

    /// Of value, rate and acceleration so many; the others are empty.
    fn curves(&self, orders: usize, value: impl Fn(usize, usize) -> f64) -> [Curve; 3] {
        [0, 1, 2].map(|order| if order < orders { self.curve(|k| value(k, order)) } else { Curve::default() })
    }

    fn length(&self, v: Vec3) -> [f64; 3] {
        v.to_array().map(|x| self.units.from_si(Kind::Length, x))
    }

    /// All outputs, then x, y and z of every body's origin.
    fn quantities(&self) -> Vec<Quantity> {
        let measured = &self.solution.measured;
        let outputs = measured.outputs.iter().enumerate().map(|(m, output)| {
            let value = |k, order: usize| self.units.from_si(output.dimension, measured.value(k, m)[order]);
            let group = if matches!(output.source, OutputSource::Measure(_)) { "measure" } else { "point" };
            self.quantity(&output.name, output.dimension, output.known.orders, group, value)
        });
        let bodies = if self.detail.origins { self.model.bodies.len() } else { 1 };
        let origins = (1..bodies).flat_map(|b| (0..3).map(move |axis| (b, axis))).map(|(b, axis)| {
            let name = format!("{}.{}", self.model.bodies[b].name, AXES[axis]);
            let value = |k, order: usize| {
                let s = &self.solution.motion.at(k).body(b);
                self.length([s.r, s.v, s.a][order])[axis]
            };
            self.quantity(&name, Kind::Length, 3, "body", value)
        });
        outputs.chain(origins).collect()
    }

    fn quantity(
        &self,
        name: &str,
        kind: impl Into<Dimension>,
        orders: usize,
        group: &str,
        value: impl Fn(usize, usize) -> f64,
    ) -> Quantity {
        let kind = kind.into();
        let [unit, rate_unit, accel_unit] = [0, 1, 2].map(|order| order_unit(self.units, kind, order));
        let [value, rate, accel] = self.curves(orders, value);
        Quantity { name: name.into(), unit, rate_unit, accel_unit, group: group.into(), value, rate, accel }
    }

    fn variables(&self, facts: &Facts, differences: &[Option<Difference>]) -> Vec<Variable> {
        let variable = |(b, fact): (usize, &crate::facts::VariableFact)| {
            let known = matches!(fact.answer, Answer::Admissible | Answer::Reassembled);
            let of = &self.model.variables[b];
            let shown = |x: f64| self.units.from_si(of.quantity, x);
            let difference = differences.get(b).and_then(Option::as_ref);
            Variable {
                name: fact.name.clone(),
                description: fact.change.replace('`', ""),
                unit: fact.unit.clone(),
                admissibility: match fact.answer {
                    Answer::Admissible | Answer::Unknown => Admissibility::Admissible,
                    Answer::Reassembled => Admissibility::Reassembled,
                    Answer::CannotFollow => Admissibility::CannotFollow,
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

    /// How every body moves with a variable, to first order.
    fn shifts(&self, b: usize) -> Vec<Curve> {
        let by = self.model.variables[b].quantity;
        let of_body = |body: usize| {
            let at = |&k: &usize| {
                let shift = self.solution.sensitivities.at(k, b).map(|s| s.body(body));
                let shift = shift.unwrap_or(BodySensitivity::ZERO);
                let dr = shift.dr.to_array().map(|x| self.units.derivative_from_si(Kind::Length, by, x));
                let turn = shift.dpi.to_array().map(|x| self.units.derivative_from_si(Kind::Number, by, x));
                dr.into_iter().chain(turn)
            };
            self.steps.iter().flat_map(at).collect()
        };
        (0..self.model.bodies.len()).map(of_body).collect()
    }

    fn sensitivities(&self, b: usize, difference: Option<&Difference>) -> Vec<Sensitivity> {
        let measured = &self.solution.measured;
        let columns = measured.outputs.len();
        let bodies = self.model.bodies.len();
        let comparison = difference.map(|d| Comparison::of(self.model, self.solution, d));
        let mut list = Vec::new();
        for (m, output) in measured.outputs.iter().enumerate() {
            let overlay = difference.zip(comparison.as_ref()).map(|(d, comparison)| {
                (d, comparison.of_output(m), move |k: usize, order: usize| d.outputs[k * columns + m][order])
            });
            let exact = |k: usize, order: usize| measured.d(k, VariableId(b), m)[order];
            list.push(self.sensitivity(
                list.len(),
                (output.dimension, output.known.orders),
                b,
                exact,
                overlay,
            ));
        }
        for (body, axis) in (1..bodies).flat_map(|body| (0..3).map(move |axis| (body, axis))) {
            if !self.detail.bodies {
                break;
            }
            let of = |s: &BodySensitivity, order: usize| ORIGIN[order](s).to_array()[axis];
            let overlay = difference.zip(comparison.as_ref()).filter(|_| self.detail.body_differences);
            let overlay = overlay.map(|(d, comparison)| {
                (d, comparison.of_origin(BodyId(body)), move |k: usize, order: usize| {
                    of(&d.bodies[k * bodies + body], order)
                })
            });
            let exact = |k: usize, order: usize| {
                self.solution.sensitivities.at(k, b).map_or(f64::NAN, |s| of(&s.body(body), order))
            };
            list.push(self.sensitivity(list.len(), (Dimension::LENGTH, 3), b, exact, overlay));
        }
        list
    }

    /// One sensitivity, with the comparison where there is one; round-off becomes 0.
    fn sensitivity<F: Fn(usize, usize) -> f64>(
        &self,
        quantity: usize,
        (kind, orders): (Dimension, usize),
        b: usize,
        exact: impl Fn(usize, usize) -> f64,
        overlay: Option<(&Difference, [f64; 3], F)>,
    ) -> Sensitivity {
        let by = self.model.variables[b].quantity;
        let least = [0, 1, 2].map(|order| self.round_off.of(b, kind, order));
        let shown = |x: f64, order: usize| {
            if x.abs() <= least[order] { 0.0 } else { self.units.derivative_from_si(kind, by, x) }
        };
        let [value, rate, accel] = self.curves(orders, |k, order| shown(exact(k, order), order));
        let fd = overlay.map(|(d, worst, difference)| {
            let [value, rate, accel] = self.curves(orders, |k, order| shown(difference(k, order), order));
            let step = self.units.from_si(by, d.step);
            FiniteDifference { value, rate, accel, step, step_unit: symbol(self.units, by).into(), worst }
        });
        Sensitivity { quantity, value, rate, accel, fd }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRUT: Size =
        Size { steps: 501, bodies: 4, variables: 16, outputs: 13, compared: true, designs: 0 };

    #[test]
    fn a_suspension_keeps_the_sensitivities_of_its_bodies() {
        let detail = Detail::that_fits(STRUT, true);
        assert_eq!(detail, Detail { stride: 2, origins: true, bodies: true, body_differences: false });
        assert!(detail.bytes(STRUT) <= MOST_BYTES as f64);
        let short = Size { steps: 201, ..STRUT };
        let detail = Detail::that_fits(short, true);
        assert_eq!(detail, Detail { stride: 1, origins: true, bodies: true, body_differences: true });
        // What is not there cannot be shown.
        assert!(!Detail::that_fits(short, false).bodies);
    }

    #[test]
    fn a_long_motion_is_thinned() {
        let long = Size { steps: 100_001, ..STRUT };
        let detail = Detail::that_fits(long, true);
        assert!(detail.bodies && (101..=400).contains(&detail.stride), "{detail:?}");
        assert!(detail.bytes(long) <= MOST_BYTES as f64);
    }

    #[test]
    fn many_variables_cost_the_bodies_their_curves() {
        let many = Size { variables: 30, bodies: 12, ..STRUT };
        let detail = Detail::that_fits(many, true);
        assert!(detail.origins && !detail.bodies && !detail.body_differences, "{detail:?}");
        assert!(detail.bytes(many) <= MOST_BYTES as f64);
        // However much there is, a hundred steps remain.
        let huge = Detail::that_fits(Size { variables: 5000, ..STRUT }, true);
        assert!(!huge.bodies && huge.stride <= 5);
        let wide = Detail::that_fits(Size { variables: 0, bodies: 2000, ..STRUT }, true);
        assert!(!wide.origins, "{wide:?}");
    }
}
