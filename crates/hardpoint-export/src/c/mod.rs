//! The step of a mechanism as C99: a function of its drivers, without allocation.
//!
//! The formulas are the straight-line programs that the engine records of its own kernel; the iteration around them is
//! `control.c`. Templates have places as in `@name@`.

mod curves;
mod emit;
mod header;
mod replay;

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;

use hardpoint::measure::{MeasureFormulas, Output, outputs};
use hardpoint::model::{Model, OutputSource};
use hardpoint::motion::{DrivenStep, MotionCheck};
use hardpoint::sensitivity::Admissibility;
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;
use hardpoint_tape::{Operand, Program};

use crate::{Companion, ExportError, ExportOptions, ExportedModel, Format, Writer};
use emit::{Function, body_number, literal};
use header::check_header;
pub(crate) use header::identifier;
use replay::{ReplayResult, replay, start_inputs};

/// C format.
pub const FORMAT: Format = Format {
    name: "c",
    about: "C99 source with its header: motion as a function of the drivers",
    endings: &["c"],
    write: Writer::Recorded(write),
};

// Templates, in the order in which they are written: header, source.
const HEADER: &str = include_str!("header.h");
const MEASURE_TYPES: &str = include_str!("measures.h");
const JACOBIAN_DECLARED: &str = include_str!("jacobian.h");
const SOURCE: &str = include_str!("source.c");
const LARGER: &str = include_str!("larger.c");
const MEASURES: &str = include_str!("measures.c");
const CONTROL: &str = include_str!("control.c");
const JACOBIAN: &str = include_str!("jacobian.c");
// If requested: derivatives, and the design.
const DERIVATIVE_DECLARED: &str = include_str!("derivative.h");
const DERIVATIVE: &str = include_str!("derivative.c");
const DERIVED_MEASURES: &str = include_str!("derived_measures.c");
const DESIGN_DECLARED: &str = include_str!("design.h");
const DESIGN: &str = include_str!("design.c");
const FOLLOWS: &str = include_str!("follows.c");
const GRADIENT_DECLARED: &str = include_str!("gradient.h");
const GRADIENT: &str = include_str!("gradient.c");
/// Numbers that depend on the design alone.
const PREPARE: &str = "\
static void @name@_prepare(const double *b, double *w, double *g)
{
@calls@}

";
/// The design at a part of the path.
const PART_OF_DESIGN: &str = "        if (design) {
            for (k = 0; k < @NAME@_DESIGN; ++k)
                s->position.design[k] =
                    is_last ? design[k] : first.design[k] + (design[k] - first.design[k]) * (done + part);
            @name@_prepare(s->position.design, s->work, s->geometry);
        }
";
/// The design before the path.
const RESTORE_DESIGN: &str = "    if (design)
        @name@_prepare(s->position.design, s->work, s->geometry);
";
/// Residual that is round-off of positions, rad or sizes of loops.
const LEAST_MISFIT: f64 = 1e-9;
/// Check of a direction that changes the design.
const FOLLOWS_CALL: &str = "    if (!@name@_follows(s, &p, along, dx, o->residual, d))
        return @NAME@_LOCKED;
";
/// Numbers of a body, in the order of the programs: r, the columns of A, v, omega, a, alpha.
const BODY: usize = 24;

/// Parts of the source that are written if they are requested.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// Derivatives of all results in a direction.
    pub derivatives: bool,
    /// The design variables as arguments, and the derivatives of the measures by them.
    pub design: bool,
}

/// Source of a motion, with a list of its arguments and results.
pub struct MotionSource {
    pub source: String,
    pub header: String,
    /// Prefix of all names.
    pub name: String,
    pub measures: Vec<Measure>,
    /// Indices of the design variables that are arguments.
    pub design: Vec<usize>,
    /// Value of every driver at the start, m or rad.
    pub start: Vec<f64>,
    /// Name of the model file, without its folder, as in a comment.
    pub origin: String,
}

fn write(
    file: &ModelFile,
    stem: &str,
    options: ExportOptions,
    out: &mut ExportedModel,
) -> Result<(), ExportError> {
    if options.design && file.model.variables.is_empty() {
        let why = "the model has no design variables; export it without `--design`, or declare `variables`";
        return Err(ExportError::NotRecorded { why: why.to_owned() });
    }
    let parts = Parts { derivatives: options.design, design: options.design };
    let motion = generate(file, stem, parts, out)?;
    if motion.name != stem {
        out.report_unsupported("name", stem, format!("the prefix of all names is `{}`", motion.name));
    }
    if !options.design && !file.model.variables.is_empty() {
        let why = "their nominal values are constants of the formulas; `--design` makes them arguments";
        out.report_unsupported("design variables", &file.model.variables.len().to_string(), why);
    }
    out.text = motion.source;
    out.companion = Some(Companion { ending: "h", text: motion.header });
    Ok(())
}

/// Generates the source of a model, and reports unsupported features.
///
/// # Errors
///
/// The mechanism cannot be driven, its step has no formulas, or no header can have this name.
pub fn generate(
    file: &ModelFile,
    stem: &str,
    parts: Parts,
    out: &mut ExportedModel,
) -> Result<MotionSource, ExportError> {
    check_header(stem)?;
    let model = &file.model;
    let analysis = Analysis::new(model).map_err(ExportError::CannotBeDriven)?;
    let refused = |why: String| ExportError::NotRecorded { why };
    if model.drivers.is_empty() {
        return Err(refused("there is no driver".to_owned()));
    }
    let step = analysis.driven_step(parts.design).map_err(refused)?;
    let formulas = analysis.measure_formulas(parts.design);
    let measures = Measures::of(&analysis, &step, formulas.as_ref(), out);
    let design = arguments(&analysis, &step, out);
    let ReplayResult { end, undefined, residual } = replay(model, &step, formulas.as_ref());
    if let Some(t) = end {
        // A motion that ends before that time by itself is that of the model.
        let stop =
            analysis.solve(Run::new().without_sensitivities()).stop.filter(|stop| stop.failed_time <= t);
        let why = match stop {
            Some(stop) => format!("the motion of the model ends: {} ({})", stop.headline(model), stop.code()),
            None => "the formulas end there: the motion goes on with other rows of redundant constraints, or through a \
                     change point"
                .to_owned(),
        };
        out.report_unsupported("motion", &format!("from t = {t} s"), why);
    }
    report_undefined(&analysis, &measures, &undefined, out);
    let start = step.drivers.iter().map(|d| d.start).collect();
    let source = Source {
        file,
        stem,
        name: identifier(stem),
        step: &step,
        formulas: formulas.as_ref(),
        measures,
        design,
        derivatives: parts.derivatives,
        residual,
    };
    let (text, sizes) = source.text();
    let (header, origin) = (source.header(sizes), source.origin());
    let Source { name, measures: Measures { list: measures, .. }, design, .. } = source;
    Ok(MotionSource { source: text, header, name, measures, design, start, origin })
}

/// Reports the measures that are NaN at some output times.
fn report_undefined(
    analysis: &Analysis<'_>,
    measures: &Measures,
    undefined: &[Vec<usize>],
    out: &mut ExportedModel,
) {
    let partial = measures.list.iter().filter_map(|measure| match measure.from {
        MeasureSource::Formulas(k) => Some((measure, &undefined[k])),
        MeasureSource::Step(_) => None,
    });
    let partial: Vec<_> = partial.filter(|(_, times)| !times.is_empty()).collect();
    if partial.is_empty() {
        return;
    }
    let solution = analysis.solve(Run::new().without_sensitivities());
    for (measure, times) in partial {
        let name = &measure.output.name;
        // The engine has no rates at a kink either.
        let is_kink = |k: &&usize| {
            let column = solution.measured.index(name).filter(|_| **k < solution.motion.len());
            let values = column.map(|column| solution.measured.value(**k, column));
            let known = measure.output.known.orders;
            values.is_some_and(|values| values.iter().take(known).any(|x| x.is_nan()))
        };
        let kinks = times.iter().filter(is_kink).count();
        let of = |count: usize, why: &str| {
            (count > 0)
                .then(|| format!("NaN at {count} of {} output times, {why}", analysis.model().times.len()))
        };
        let why = [
            of(kinks, "where it is undefined or has a kink"),
            of(times.len() - kinks, "where its formula takes another case than in the design configuration"),
        ];
        out.report_unsupported("measure", name, why.into_iter().flatten().collect::<Vec<_>>().join("; "));
    }
}

/// Design variables that are arguments; the others are reported, and keep their nominal values.
fn arguments(analysis: &Analysis<'_>, step: &DrivenStep, out: &mut ExportedModel) -> Vec<usize> {
    let model = analysis.model();
    if step.design.is_empty() {
        return Vec::new();
    }
    let admissibility = analysis.solve(Run::new().without_measures()).sensitivities.admissibility;
    let mut found = Vec::new();
    for (k, variable) in step.design.iter().enumerate() {
        let why = if variable.changes_law {
            "nominal: it changes the law of a driver, which the caller passes"
        } else if let Some(Admissibility::CannotFollow { .. }) = admissibility.get(k) {
            "nominal: the mechanism cannot follow it, because redundant constraints contradict each other"
        } else {
            found.push(k);
            continue;
        };
        out.report_unsupported("design variable", &model.variables[k].name, why);
    }
    found
}

/// A measure or component of a point that is written.
pub struct Measure {
    pub output: Output,
    from: MeasureSource,
}

impl Measure {
    /// Number of known time derivatives, the value included.
    pub fn orders(&self) -> usize {
        match self.from {
            MeasureSource::Formulas(_) => self.output.known.orders,
            MeasureSource::Step(_) => 1,
        }
    }
}

/// Program that computes a measure.
#[derive(Clone, Copy)]
enum MeasureSource {
    /// The formulas, by the index of the output.
    Formulas(usize),
    /// The step, by the index among the measures of the step.
    Step(usize),
}

struct Measures {
    list: Vec<Measure>,
    /// Per measure that counts whole turns: place in the list, and value at the start.
    counted: Vec<(usize, f64)>,
}

impl Measures {
    /// The measures that can be written; the others are reported.
    fn of(
        analysis: &Analysis<'_>,
        step: &DrivenStep,
        formulas: Option<&MeasureFormulas>,
        out: &mut ExportedModel,
    ) -> Self {
        let model = analysis.model();
        let all = outputs(model);
        let first: Vec<f64> = model.times.first().copied().into_iter().collect();
        let start = analysis.without_metrics(first).solve(Run::new());
        let mut found = Self { list: Vec::new(), counted: Vec::new() };
        for (k, output) in all.into_iter().enumerate() {
            let of_step = match output.source {
                OutputSource::Measure(m) => step.step_measures.iter().position(|n| *n == m),
                OutputSource::Point(..) => None,
            };
            let is_formula = || formulas.is_some_and(|f| is_arithmetic(f, k));
            let from = match of_step {
                Some(n) => MeasureSource::Step(n),
                None if is_formula() => MeasureSource::Formulas(k),
                None => {
                    out.report_unsupported("measure", &output.name, why_not(model, output.source));
                    continue;
                }
            };
            if output.known.counted {
                found.counted.push((found.list.len(), start.measured.value(0, k)[0]));
            }
            found.list.push(Measure { output, from });
        }
        found
    }
}

/// True if the formulas compute an output: its guard is not the constant one.
fn is_arithmetic(formulas: &MeasureFormulas, output: usize) -> bool {
    match formulas.program.outputs[output] {
        Operand::Constant(k) => formulas.program.constants[k as usize] <= 0.0,
        Operand::Value(_) | Operand::Input(_) | Operand::Uniform(_) => true,
    }
}

fn why_not(model: &Model, source: OutputSource) -> &'static str {
    match source {
        OutputSource::Measure(m) if model.measures[m].kind.is_load() => {
            "not written: loads are not part of the motion"
        }
        OutputSource::Measure(_) | OutputSource::Point(..) => {
            "not written: it is found by iterations or decisions, not by a formula"
        }
    }
}

/// A source file that is being written.
struct Source<'a> {
    file: &'a ModelFile,
    stem: &'a str,
    /// Prefix of all names.
    name: String,
    step: &'a DrivenStep,
    formulas: Option<&'a MeasureFormulas>,
    measures: Measures,
    /// Indices of the design variables that are arguments.
    design: Vec<usize>,
    /// True if the derivatives are written.
    derivatives: bool,
    /// Largest residual of a constraint in the motion of the nominal design.
    residual: f64,
}

/// Sizes of the arrays of a state.
#[derive(Clone, Copy, Default)]
struct Sizes {
    /// Working values.
    work: usize,
    /// Numbers that depend on the design alone.
    geometry: usize,
}

/// Type of a parameter that is read only.
const READ: &str = "const double *";
/// Parameters of the generated functions: a position and its rates, and memory.
const POSITION: [(&str, &str); 2] = [(READ, "x"), (READ, "q")];
const RATES: [(&str, &str); 2] = [(READ, "qd"), (READ, "qdd")];
const WORK: (&str, &str) = ("double *", "w");

/// Functions of the programs, while they are written.
struct Functions<'a> {
    name: &'a str,
    larger: String,
    text: String,
    sizes: Sizes,
    /// Calls of the functions that compute the numbers of the design.
    prepare: String,
}

impl Functions<'_> {
    /// Writes a program as a function. If its inputs from `design_at` on are the design variables, then what depends on
    /// them alone is another function.
    fn write(
        &mut self,
        (which, about): (&str, &str),
        program: &Program,
        parameters: &[(&str, &str)],
        (mut inputs, design_at): (Vec<String>, Option<usize>),
        outputs: Vec<Option<String>>,
    ) {
        let staged = design_at.map(|at| {
            let is_design = |operand| matches!(operand, Operand::Input(k) if k as usize >= at);
            program.clone().staged(is_design)
        });
        let (first, program) = match &staged {
            Some((first, rest)) => (Some(first), rest),
            None => (None, program),
        };
        if let Some(first) = first {
            let at = self.sizes.geometry;
            let numbers = |count: usize| (0..count).map(move |k| format!("g[{}]", at + k));
            let to = numbers(first.outputs.len()).map(Some).collect();
            let parameters = [("const double *", "b"), ("double *", "w"), ("double *", "g")];
            let part = format!("{which}_geometry");
            self.function(
                (&part, "The part that depends on the design alone."),
                first,
                &parameters,
                &inputs,
                to,
            );
            let _ = writeln!(self.prepare, "    {}_{part}(b, w, g);", self.name);
            inputs.extend(numbers(first.outputs.len()));
            self.sizes.geometry += first.outputs.len();
        }
        self.function((which, about), program, parameters, &inputs, outputs);
    }

    fn function(
        &mut self,
        (which, about): (&str, &str),
        program: &Program,
        parameters: &[(&str, &str)],
        inputs: &[String],
        outputs: Vec<Option<String>>,
    ) {
        let _ = writeln!(self.text, "/* {about} */");
        let name = format!("{}_{which}", self.name);
        let inputs = inputs.to_vec();
        let function = Function { name: &name, larger: &self.larger, program, parameters, inputs, outputs };
        self.sizes.work = self.sizes.work.max(function.write(&mut self.text));
    }
}

impl Source<'_> {
    /// Text of the source file, and the sizes of its state.
    fn text(&self) -> (String, Sizes) {
        let Functions { text: functions, sizes, prepare, .. } = self.functions();
        let mut text = self.filled(SOURCE, &self.heading());
        if functions.contains(&format!("{}_larger(", self.name)) {
            text += &self.filled(LARGER, &[]);
        }
        text += &functions;
        text += &self.filled(CONTROL, &self.control(&prepare));
        if self.has_measures() {
            text += &self.filled(JACOBIAN, &[]);
        }
        if self.has_design() {
            text += &self.filled(DESIGN, &[]);
        }
        if self.derivatives {
            let derived = if self.has_formulas() {
                let design = if self.has_design() { "p.design, " } else { "" };
                format!("    {}_formulas_tangent(&p, {design}along, o, s->work, d);\n", self.name)
            } else {
                String::new()
            };
            let undefined =
                if self.has_measures() { self.filled(DERIVED_MEASURES, &[]) } else { String::new() };
            let mut follows = String::new();
            if self.has_design() {
                text += &self.filled(
                    FOLLOWS,
                    &[
                        ("checks", self.checks().to_string()),
                        ("misfit", literal(10.0 * self.residual + LEAST_MISFIT)),
                    ],
                );
                follows = self.filled(FOLLOWS_CALL, &[]);
            }
            let places = [
                ("outputs", self.step.coordinates.len().max(1).to_string()),
                ("follows", follows),
                ("derived_measures", derived + &undefined),
            ];
            text += &self.filled(DERIVATIVE, &places);
            if self.has_design() && self.has_measures() {
                text += &self.filled(GRADIENT, &[]);
            }
        }
        (text, sizes)
    }

    /// True if the design is an argument.
    fn has_design(&self) -> bool {
        !self.design.is_empty()
    }

    fn has_measures(&self) -> bool {
        !self.measures.list.is_empty()
    }

    /// Expressions of the design variables that programs read: arguments, or nominal.
    fn design_inputs(&self, of: &str) -> Vec<String> {
        let input = |k: usize| match self.design.iter().position(|d| *d == k) {
            Some(at) => format!("{of}[{at}]"),
            None => "0.0".to_owned(),
        };
        (0..self.step.design.len()).map(input).collect()
    }

    /// The functions of all programs.
    fn functions(&self) -> Functions<'_> {
        let mut functions = Functions {
            name: &self.name,
            larger: format!("{}_larger", self.name),
            text: String::new(),
            sizes: Sizes::default(),
            prepare: String::new(),
        };
        self.write_steps(&mut functions);
        if self.derivatives {
            self.write_step_tangents(&mut functions);
        }
        if let Some(formulas) = self.formulas.filter(|_| self.has_formulas()) {
            self.write_formulas(&mut functions, formulas);
        }
        functions
    }

    /// Parameters of functions that depend on the design: its variables, and the numbers that depend on them alone.
    fn design_parameters(&self) -> &'static [(&'static str, &'static str)] {
        if self.has_design() { &[(READ, "b"), (READ, "g")] } else { &[] }
    }

    /// Inputs of the programs of a step: coordinates with the pieces of the curves, drivers and, from the number beside
    /// them on, the design.
    fn step_inputs(&self) -> (Vec<String>, usize) {
        let mut inputs: Vec<String> = (0..self.step.position_inputs()).map(|k| format!("x[{k}]")).collect();
        let of_driver = |d: usize| ["q", "qd", "qdd"].map(|of| format!("{of}[{d}]"));
        inputs.extend((0..self.step.drivers.len()).flat_map(of_driver));
        let at = inputs.len();
        inputs.extend(self.design_inputs("b"));
        (inputs, at)
    }

    /// Correction, path and motion of a step.
    fn write_steps(&self, functions: &mut Functions<'_>) {
        let (step, geometry) = (self.step, self.design_parameters());
        let n = step.coordinates.len();
        let (inputs, at) = self.step_inputs();
        let design_at = self.has_design().then_some(at);
        let output_type = format!("{}_output *", self.name);
        let in_y = |count: usize| (0..count).map(|k| Some(format!("y[{k}]"))).collect::<Vec<_>>();
        functions.write(
            ("correct", "One Newton correction: the corrected coordinates, and the size of the correction."),
            &step.correction,
            &[&POSITION[..], geometry, &[WORK, ("double *", "y")]].concat(),
            (inputs.clone(), design_at),
            in_y(n + 1),
        );
        functions.write(
            ("path", "First and second derivative of every coordinate."),
            &step.path,
            &[&POSITION[..], geometry, &RATES, &[WORK, ("double *", "y")]].concat(),
            (inputs.clone(), design_at),
            in_y(2 * n),
        );
        functions.write(
            ("motion", "Motion of all bodies, and the numbers that it is checked by."),
            &step.motion,
            &[&POSITION[..], geometry, &RATES, &[WORK, ("double *", "check"), (&output_type, "o")]].concat(),
            (inputs, design_at),
            self.motion_outputs("o", true),
        );
    }

    /// Derivatives of correction and motion in a direction: of the coordinates, drivers and design.
    fn write_step_tangents(&self, functions: &mut Functions<'_>) {
        let (name, step) = (&self.name, self.step);
        let (n, drivers) = (step.coordinates.len(), step.drivers.len());
        let drivers_at = step.position_inputs();
        let design: &[(&str, &str)] = if self.has_design() { &[(READ, "b")] } else { &[] };
        let (mut inputs, at) = self.step_inputs();
        // The curves do not change.
        let change = |k: usize| if k < n { format!("dx[{k}]") } else { "0.0".to_owned() };
        inputs.extend((0..drivers_at).map(change));
        let of_driver = |d: usize| ["q", "qd", "qdd"].map(|of| format!("along->{of}[{d}]"));
        inputs.extend((0..drivers).flat_map(of_driver));
        inputs.extend(self.design_inputs("along->design"));
        let (direction_type, output_type) = (format!("const {name}_direction *"), format!("{name}_output *"));
        let of_position = |k: usize| k >= drivers_at && (k >= at || (k - drivers_at).is_multiple_of(3));
        functions.write(
            ("correct_tangent", "Derivative of the coordinates in a direction."),
            &step.correction.tangent(|k| of_position(k) && self.is_argument(at, k)),
            &[&POSITION[..], design, &[(&direction_type, "along"), WORK, ("double *", "dx")]].concat(),
            (inputs.clone(), None),
            (0..=n).map(|k| (k < n).then(|| format!("dx[{k}]"))).collect(),
        );
        let last = [(&direction_type[..], "along"), WORK, (&output_type, "d")];
        functions.write(
            ("motion_tangent", "Derivative of the motion in a direction."),
            &step.motion.tangent(|k| self.is_argument(at, k)),
            &[&POSITION[..], &RATES, &[(READ, "dx")], design, &last].concat(),
            (inputs, None),
            self.motion_outputs("d", false),
        );
    }

    /// True for inputs that programs are differentiated by: coordinates, drivers, and arguments of the design.
    fn is_argument(&self, design_at: usize, k: usize) -> bool {
        let is_piece = (self.step.coordinates.len()..self.step.position_inputs()).contains(&k);
        k < design_at && !is_piece || k >= design_at && self.design.contains(&(k - design_at))
    }

    /// Measures by the motion of the bodies, and their derivatives in a direction.
    fn write_formulas(&self, functions: &mut Functions<'_>, formulas: &MeasureFormulas) {
        let name = &self.name;
        let bodies = |of: &str| -> Vec<String> {
            let body = |b: &usize| (0..BODY).map(|k| body_number(of, *b, k)).collect::<Vec<_>>();
            formulas.bodies.iter().flat_map(body).collect()
        };
        let moving = bodies("o").len();
        let mut inputs = bodies("o");
        inputs.extend(formulas.turning.iter().map(|m| match self.counter_of(*m) {
            Some(c) => format!("p->turn[{c}]"),
            None => "0.0".to_owned(),
        }));
        inputs.push("0.0".to_owned());
        let at = inputs.len();
        inputs.extend(self.design_inputs("b"));
        let (position_type, output_type) = (format!("const {name}_position *"), format!("{name}_output *"));
        functions.write(
            ("formulas", "Measures; those whose guard is positive or NaN are undefined."),
            &formulas.program,
            &[
                &[(&position_type[..], "p")],
                self.design_parameters(),
                &[WORK, ("double *", "guard"), (&output_type, "o")],
            ]
            .concat(),
            (inputs.clone(), self.has_design().then_some(at)),
            self.formula_outputs(formulas, "o", true),
        );
        if self.derivatives {
            let mut direction = bodies("d");
            direction.resize(at, "0.0".to_owned());
            direction.extend(self.design_inputs("along->design"));
            let design: &[(&str, &str)] = if self.has_design() { &[(READ, "b")] } else { &[] };
            let direction_type = format!("const {name}_direction *");
            let result_type = format!("const {name}_output *");
            functions.write(
                ("formulas_tangent", "Derivatives of the measures in a direction."),
                &formulas.program.tangent(|k| k < moving || k >= at && self.is_argument(at, k)),
                &[
                    &[(&position_type[..], "p")],
                    design,
                    &[(&direction_type, "along"), (&result_type, "o"), WORK, (&output_type, "d")],
                ]
                .concat(),
                ([inputs, direction].concat(), None),
                self.formula_outputs(formulas, "d", false),
            );
        }
    }

    fn has_formulas(&self) -> bool {
        self.measures.list.iter().any(|m| matches!(m.from, MeasureSource::Formulas(_)))
    }

    /// Index of the counter of a measure's whole turns.
    fn counter_of(&self, measure: usize) -> Option<usize> {
        self.measures
            .counted
            .iter()
            .position(|(at, _)| self.measures.list[*at].output.source == OutputSource::Measure(measure))
    }

    /// Number of checks and of what is found with them: determinants, excesses.
    fn checks(&self) -> usize {
        MotionCheck::ALL.len() + self.step.logarithmic.len() + self.step.step_measures.len()
    }

    /// Lvalues of the motion's outputs, with or without the checks.
    fn motion_outputs(&self, of: &str, checks: bool) -> Vec<Option<String>> {
        let checks = (0..self.checks()).map(|k| checks.then(|| format!("check[{k}]")));
        let values = (0..self.step.step_measures.len()).map(|n| {
            let is_it = |m: &Measure| matches!(m.from, MeasureSource::Step(k) if k == n);
            let at = self.measures.list.iter().position(is_it)?;
            Some(format!("{of}->measure[{at}].value"))
        });
        let bodies = 1..self.file.model.bodies.len();
        let bodies = bodies.flat_map(|b| (0..BODY).map(move |k| Some(body_number(of, b, k))));
        checks.chain(values).chain(bodies).collect()
    }

    /// Lvalues of the outputs of the formulas, with or without the guards.
    fn formula_outputs(&self, formulas: &MeasureFormulas, of: &str, guards: bool) -> Vec<Option<String>> {
        let count = formulas.program.outputs.len() / 4;
        let mut at = vec![None; count];
        for (place, measure) in self.measures.list.iter().enumerate() {
            if let MeasureSource::Formulas(k) = measure.from {
                at[k] = Some(place);
            }
        }
        let guards = at.iter().map(|at| at.filter(|_| guards).map(|at| format!("guard[{at}]")));
        let numbers = at.iter().flat_map(|at| {
            let number = |order| at.map(|at| format!("{of}->measure[{at}].{order}"));
            ["value", "rate", "acceleration"].map(number)
        });
        guards.chain(numbers).collect()
    }

    /// Parts of the control that depend on the model.
    fn control(&self, prepare: &str) -> Vec<(&'static str, String)> {
        let step = self.step;
        let name = &self.name;
        let units = |which: &str, list: &[hardpoint::motion::DrivenCoordinate]| {
            let numbers: Vec<String> = list.iter().map(|c| literal(c.unit)).collect();
            format!("static const double {name}_{which}[] = {{{}}};\n", or_zero(numbers).join(", "))
        };
        let mut tables = units("coordinate_unit", &step.coordinates) + &units("driver_unit", &step.drivers);
        let logarithmic = step.logarithmic.iter().map(|l| u8::from(*l).to_string()).collect();
        let _ = writeln!(
            tables,
            "static const int {name}_logarithmic[] = {{{}}}; /* determinants that are logarithms */",
            or_zero(logarithmic).join(", ")
        );
        let first = MotionCheck::ALL.len();
        let mut results = String::new();
        for b in 0..step.logarithmic.len() {
            let _ = writeln!(results, "    p->determinant[{b}] = check[{}];", first + b);
        }
        for (at, measure) in self.measures.list.iter().enumerate() {
            if let MeasureSource::Step(n) = measure.from {
                let excess = first + step.logarithmic.len() + n;
                let _ = writeln!(
                    results,
                    "    if (!(check[{excess}] <= 0.0))\n        o->measure[{at}].value = NAN;\n    \
                     o->measure[{at}].rate = o->measure[{at}].acceleration = NAN;"
                );
            }
        }
        let mut measures = String::new();
        if self.has_formulas() {
            let g = if self.has_design() { "g, " } else { "" };
            let _ = writeln!(results, "    {name}_measure(p, {g}w, o);");
            measures = self.measuring();
        }
        let width = usize::max(2 * step.coordinates.len(), step.coordinates.len() + 1);
        let when = |text: &str| if self.has_design() { self.filled(text, &[]) } else { String::new() };
        vec![
            ("pieces", self.filled(&curves::pieces(step), &[])),
            ("pieces_of_position", self.filled(&curves::place_pieces(step, "        ", "p->x"), &[])),
            ("prepare", when(&PREPARE.replace("@calls@", prepare))),
            ("part_of_design", when(PART_OF_DESIGN)),
            ("restore_design", when(RESTORE_DESIGN)),
            ("design_type", when(" const double design[],")),
            ("no_design", when(" 0,")),
            ("and_design", when(" and to the design, if one is passed")),
            ("tables", tables + &measures),
            ("checks", self.checks().to_string()),
            ("outputs", width.to_string()),
            ("measures", results.trim_end().to_owned()),
            ("start", self.start()),
        ]
    }

    /// The function that evaluates the formulas, marks those that are undefined, and counts whole turns.
    fn measuring(&self) -> String {
        let list = self.measures.list.iter().enumerate();
        let formulas = list.filter(|(_, m)| matches!(m.from, MeasureSource::Formulas(_)));
        let formulas: Vec<String> = formulas.map(|(at, _)| at.to_string()).collect();
        let counted: Vec<String> = self.measures.counted.iter().map(|(at, _)| at.to_string()).collect();
        let places = [
            ("formula_count", formulas.len().to_string()),
            ("counters", counted.len().to_string()),
            ("formulas", formulas.join(", ")),
            ("counted", or_zero(counted).join(", ")),
        ];
        self.filled(MEASURES, &places)
    }

    /// Statements that set the state at the start.
    fn start(&self) -> String {
        let step = self.step;
        let mut text = String::new();
        let mut set = |field: &str, k: usize, x: f64| {
            let _ = writeln!(text, "    s->position.{field}[{k}] = {};", literal(x));
        };
        step.coordinates.iter().enumerate().for_each(|(k, c)| set("x", k, c.start));
        step.drivers.iter().enumerate().for_each(|(k, c)| set("q", k, c.start));
        (0..self.design.len()).for_each(|k| set("design", k, 0.0));
        let inputs = start_inputs(step);
        let mut found = vec![0.0; step.motion.outputs.len()];
        step.motion.evaluate(&inputs, &[], &mut Vec::new(), &mut found);
        for b in 0..step.logarithmic.len() {
            let determinant = found[MotionCheck::ALL.len() + b];
            set("determinant", b, determinant);
            set("determinant_before", b, determinant);
        }
        for (k, (_, angle)) in self.measures.counted.iter().enumerate() {
            set("angle", k, *angle);
            set("turn", k, 0.0);
        }
        text += &self.filled(&curves::place_pieces(step, "    ", "s->position.x"), &[]);
        if self.has_design() {
            let _ = writeln!(text, "    {}_prepare(s->position.design, s->work, s->geometry);", self.name);
        }
        text.trim_end().to_owned()
    }

    fn header(&self, sizes: Sizes) -> String {
        let (model, step) = (&self.file.model, self.step);
        let upper = self.name.to_ascii_uppercase();
        let [driver_names, body_names, design_names, measure_names] = self.enumerations();
        let count = |name: &str, count: usize| format!("#define {upper}_{name} {count}\n");
        let designs =
            format!("\n/* Design variables: indices of `design`. */\nenum {{\n{design_names}\n}};\n");
        let with_design = |text: String| if self.has_design() { text } else { String::new() };
        let measure_text = self.filled(MEASURE_TYPES, &[("measure_constants", measure_names)]);
        let jacobian = self.filled(JACOBIAN_DECLARED, &[]);
        let field = format!("    {}_measure_value measure[{upper}_MEASURES];\n", self.name);
        let when = |text: String| if self.has_measures() { text } else { String::new() };
        let mut places = vec![
            ("drivers", step.drivers.len().to_string()),
            ("bodies", (model.bodies.len() - 1).to_string()),
            ("measures", self.measures.list.len().to_string()),
            ("coordinates", step.coordinates.len().to_string()),
            ("blocks", step.logarithmic.len().to_string()),
            ("coordinates_or_one", step.position_inputs().max(1).to_string()),
            ("blocks_or_one", step.logarithmic.len().max(1).to_string()),
            ("counted_or_one", self.measures.counted.len().max(1).to_string()),
            ("work", sizes.work.max(1).to_string()),
            ("design_count", with_design(count("DESIGN", self.design.len()))),
            ("design_names", with_design(designs)),
            (
                "position_design",
                with_design(format!(
                    "    double design[{upper}_DESIGN]; /* changes of the design variables from their nominal values */\n"
                )),
            ),
            (
                "state_design",
                with_design(format!(
                    "    double geometry[{}]; /* numbers that depend on the design alone */\n",
                    sizes.geometry.max(1)
                )),
            ),
            ("derivative", self.derivative_declarations()),
            ("driver_names", driver_names),
            ("body_names", body_names),
            ("measure_names", when(measure_text)),
            ("measure_field", when(field)),
            ("jacobian", when(jacobian)),
            ("start", self.start_values()),
        ];
        places.extend(self.heading());
        self.filled(HEADER, &places)
    }

    /// Constants of the drivers, bodies, design variables and measures, with distinct names.
    fn enumerations(&self) -> [String; 4] {
        let (model, si) = (&self.file.model, Units::default());
        let upper = self.name.to_ascii_uppercase();
        let mut taken = HashSet::new();
        let mut enumerated = |kind: &str, list: &mut dyn Iterator<Item = (String, String)>| {
            let mut lines = Vec::new();
            for (k, (name, about)) in list.enumerate() {
                let plain = format!("{upper}_{kind}_{}", identifier(&name).to_ascii_uppercase());
                let constant = std::iter::once(plain.clone()).chain((2..).map(|n| format!("{plain}_{n}")));
                let constant = constant.into_iter().find(|c| !taken.contains(c)).unwrap_or(plain);
                taken.insert(constant.clone());
                lines.push(format!("    {constant} = {k}, /* {} */", comment(&about)));
            }
            // C99 has a comma before the comment of the last one, too.
            lines.join("\n")
        };
        let mut drivers = model.drivers.iter().map(|driver| {
            let note = if driver.is_reversed { "; reversed, as in the model file" } else { "" };
            let unit = unit(si, model.driven(driver).quantity);
            (driver.name.clone(), format!("{}, {unit}{note}", driver.name))
        });
        let drivers = enumerated("DRIVER", &mut drivers);
        let mut bodies = model.bodies.iter().skip(1).map(|body| (body.name.clone(), body.name.clone()));
        let bodies = enumerated("BODY", &mut bodies);
        let mut variables = self.design.iter().map(|k| {
            let variable = &model.variables[*k];
            (variable.name.clone(), format!("{}, {}", variable.name, unit(si, variable.quantity)))
        });
        let variables = enumerated("DESIGN", &mut variables);
        let mut measures = self.measures.list.iter().map(|m| {
            let note = match m.from {
                MeasureSource::Formulas(_) => "",
                MeasureSource::Step(_) => "; without rates",
            };
            let Output { name, dimension, .. } = &m.output;
            (name.clone(), format!("{name}, {}{note}", unit(si, *dimension)))
        });
        let measures = enumerated("MEASURE", &mut measures);
        [drivers, bodies, variables, measures]
    }

    /// Declarations of the functions for derivatives and design variables.
    fn derivative_declarations(&self) -> String {
        let upper = self.name.to_ascii_uppercase();
        let with_design = |text: String| if self.has_design() { text } else { String::new() };
        let mut derivative = String::new();
        if self.derivatives {
            let places = [
                ("and_of_design", with_design(" and of the design".to_owned())),
                (
                    "locked",
                    with_design(format!(
                        " {upper}_LOCKED: redundant constraints would\n * contradict each other in this direction of \
                         the design."
                    )),
                ),
                ("direction_field", with_design(format!("    double design[{upper}_DESIGN];\n"))),
            ];
            derivative += &self.filled(DERIVATIVE_DECLARED, &places);
        }
        if self.has_design() {
            derivative += &self.filled(DESIGN_DECLARED, &[]);
            if self.has_measures() {
                derivative += &self.filled(GRADIENT_DECLARED, &[]);
            }
        }
        derivative
    }

    /// Values of the drivers at which the motion starts.
    fn start_values(&self) -> String {
        let (model, si) = (&self.file.model, Units::default());
        let values: Vec<String> = model
            .drivers
            .iter()
            .zip(&self.step.drivers)
            .map(|(driver, at)| {
                format!(
                    "{} at {} {}",
                    comment(&driver.name),
                    at.start,
                    unit(si, model.driven(driver).quantity)
                )
            })
            .collect();
        values.join(", ")
    }

    /// Places of the comment at the beginning of a file.
    fn heading(&self) -> [(&'static str, String); 4] {
        [
            ("title", comment(&self.file.model.name)),
            ("generator", GENERATOR.to_owned()),
            ("file", self.origin()),
            ("file_stem", comment(self.stem)),
        ]
    }

    /// Name of the model file, without its folder.
    fn origin(&self) -> String {
        let path = Path::new(self.file.file_name());
        comment(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy())
    }

    /// A template with its places filled.
    fn filled(&self, template: &str, places: &[(&str, String)]) -> String {
        let mut text = template.to_owned();
        for (place, with) in places {
            text = text.replace(&format!("@{place}@"), with);
        }
        // Arguments that functions have if the design is one.
        let arguments = [
            ("geometry_type", "const double *g, "),
            ("geometry", "p->design, g, "),
            ("g", "g, "),
            ("nominal", "p.design, "),
            ("state_geometry", "s->geometry, "),
        ];
        for (place, with) in arguments {
            text = text.replace(&format!("@{place}@"), if self.has_design() { with } else { "" });
        }
        text.replace("@name@", &self.name).replace("@NAME@", &self.name.to_ascii_uppercase())
    }
}

/// A list that is not empty: C has no arrays without elements.
fn or_zero(list: Vec<String>) -> Vec<String> {
    if list.is_empty() { vec!["0".to_owned()] } else { list }
}

/// Text within a comment.
pub fn comment(text: &str) -> String {
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    text.chars().map(plain).collect::<String>().replace("*/", "* /").replace("/*", "/ *").replace('@', "(at)")
}
