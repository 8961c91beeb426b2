//! The step of a mechanism as C99: a function of its drivers, without allocation.
//!
//! The formulas are the straight-line programs that the engine records of its own kernel; the iteration around them is
//! `control.c`. Templates have places as in `@name@`.

mod emit;
mod replay;

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;

use hardpoint::measure::{MeasureFormulas, Output, outputs};
use hardpoint::model::{Model, OutputSource};
use hardpoint::motion::{DrivenStep, MotionCheck};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;
use hardpoint_tape::Operand;

use crate::{Companion, ExportError, ExportedModel, Format, Writer};
use emit::{Function, literal};
use replay::{ReplayResult, replay};

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
/// Numbers of a body, in the order of the programs: r, the columns of A, v, omega, a, alpha.
const BODY: usize = 24;

fn write(file: &ModelFile, stem: &str, out: &mut ExportedModel) -> Result<(), ExportError> {
    let model = &file.model;
    let analysis = Analysis::new(model).map_err(ExportError::CannotBeDriven)?;
    let refused = |why: String| ExportError::NotRecorded { why };
    if model.drivers.is_empty() {
        return Err(refused("there is no driver".to_owned()));
    }
    let step = analysis.driven_step().map_err(refused)?;
    let formulas = analysis.measure_formulas();
    let measures = Measures::of(&analysis, &step, formulas.as_ref(), out);
    if !model.variables.is_empty() {
        let why = "their nominal values are constants of the formulas";
        out.report_unsupported("design variables", &model.variables.len().to_string(), why);
    }
    let ReplayResult { end, undefined } = replay(model, &step, formulas.as_ref());
    if let Some(t) = end {
        let why = "the formulas end there: the motion goes on with other rows of redundant constraints, or through a \
                   change point";
        out.report_unsupported("motion", &format!("from t = {t} s"), why);
    }
    for measure in &measures.list {
        if let MeasureSource::Formulas(k) = measure.from
            && undefined[k] > 0
        {
            let why = format!(
                "NaN at {} of {} output times, where its formula takes another case than at the first",
                undefined[k],
                model.times.len()
            );
            out.report_unsupported("measure", &measure.output.name, why);
        }
    }
    let source =
        Source { file, stem, name: identifier(stem), step: &step, formulas: formulas.as_ref(), measures };
    let (text, work) = source.text();
    out.text = text;
    out.companion = Some(Companion { ending: "h", text: source.header(work) });
    Ok(())
}

/// A measure or component of a point that is written.
struct Measure {
    output: Output,
    from: MeasureSource,
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
}

impl Source<'_> {
    /// Text of the source file, and the number of its working values.
    fn text(&self) -> (String, usize) {
        let (functions, work) = self.functions();
        let mut text = self.filled(SOURCE, &self.heading());
        if functions.contains(&format!("{}_larger(", self.name)) {
            text += &self.filled(LARGER, &[]);
        }
        text += &functions;
        text += &self.filled(CONTROL, &self.control());
        if !self.measures.list.is_empty() {
            text += &self.filled(JACOBIAN, &[]);
        }
        (text, work)
    }

    /// The functions of all programs.
    fn functions(&self) -> (String, usize) {
        let (name, step) = (&self.name, self.step);
        let larger = format!("{name}_larger");
        let (n, drivers) = (step.coordinates.len(), step.drivers.len());
        let mut inputs: Vec<String> = (0..n).map(|k| format!("x[{k}]")).collect();
        inputs.extend((0..drivers).flat_map(|d| ["q", "qd", "qdd"].map(|of| format!("{of}[{d}]"))));
        let read = "const double *";
        let position = [(read, "x"), (read, "q")];
        let rates = [(read, "qd"), (read, "qdd")];
        let work = ("double *", "w");
        let output_type = format!("{name}_output *");
        let position_type = format!("const {name}_position *");
        let in_y = |count: usize| (0..count).map(|k| Some(format!("y[{k}]"))).collect();

        let mut text = String::new();
        let mut most = 1;
        let mut write = |which: &str, about: &str, program, parameters: &[_], inputs, outputs| {
            let _ = writeln!(text, "/* {about} */");
            let function = format!("{name}_{which}");
            let function =
                Function { name: &function, larger: &larger, program, parameters, inputs, outputs };
            most = most.max(function.write(&mut text));
        };
        write(
            "correct",
            "One Newton correction: the corrected coordinates, and the size of the correction.",
            &step.correction,
            &[&position[..], &[work, ("double *", "y")]].concat(),
            inputs.clone(),
            in_y(n + 1),
        );
        write(
            "path",
            "First and second derivative of every coordinate.",
            &step.path,
            &[&position[..], &rates, &[work, ("double *", "y")]].concat(),
            inputs.clone(),
            in_y(2 * n),
        );
        write(
            "motion",
            "Motion of all bodies, and the numbers that it is checked by.",
            &step.motion,
            &[&position[..], &rates, &[work, ("double *", "check"), (&output_type, "o")]].concat(),
            inputs,
            self.motion_outputs(),
        );
        if let Some(formulas) = self.formulas.filter(|_| self.has_formulas()) {
            let body = |b: &usize| (0..BODY).map(|k| body_number(*b, k)).collect::<Vec<_>>();
            let mut inputs: Vec<String> = formulas.bodies.iter().flat_map(body).collect();
            inputs.extend(formulas.turning.iter().map(|m| match self.counter_of(*m) {
                Some(c) => format!("p->turn[{c}]"),
                None => "0.0".to_owned(),
            }));
            inputs.push("0.0".to_owned());
            let outputs = self.formula_outputs(formulas);
            write(
                "formulas",
                "Measures; those whose guard is positive or NaN are undefined.",
                &formulas.program,
                &[(&position_type[..], "p"), work, ("double *", "guard"), (&output_type, "o")],
                inputs,
                outputs,
            );
        }
        (text, most)
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

    fn motion_outputs(&self) -> Vec<Option<String>> {
        let checks = (0..self.checks()).map(|k| Some(format!("check[{k}]")));
        let values = (0..self.step.step_measures.len()).map(|n| {
            let is_it = |m: &Measure| matches!(m.from, MeasureSource::Step(k) if k == n);
            let at = self.measures.list.iter().position(is_it)?;
            Some(format!("o->measure[{at}].value"))
        });
        let bodies = 1..self.file.model.bodies.len();
        let bodies = bodies.flat_map(|b| (0..BODY).map(move |k| Some(body_number(b, k))));
        checks.chain(values).chain(bodies).collect()
    }

    fn formula_outputs(&self, formulas: &MeasureFormulas) -> Vec<Option<String>> {
        let count = formulas.program.outputs.len() / 4;
        let mut at = vec![None; count];
        for (place, measure) in self.measures.list.iter().enumerate() {
            if let MeasureSource::Formulas(k) = measure.from {
                at[k] = Some(place);
            }
        }
        let guards = at.iter().map(|at| at.map(|at| format!("guard[{at}]")));
        let numbers = at.iter().flat_map(|at| {
            ["value", "rate", "acceleration"].map(|of| at.map(|at| format!("o->measure[{at}].{of}")))
        });
        guards.chain(numbers).collect()
    }

    /// Parts of the control that depend on the model.
    fn control(&self) -> Vec<(&'static str, String)> {
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
            let _ = writeln!(results, "    {name}_measure(p, w, o);");
            measures = self.measuring();
        }
        let width = usize::max(2 * step.coordinates.len(), step.coordinates.len() + 1);
        vec![
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
        let coordinates = step.coordinates.iter().map(|c| c.start);
        let inputs: Vec<f64> =
            coordinates.chain(step.drivers.iter().flat_map(|d| [d.start, 0.0, 0.0])).collect();
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
        text.trim_end().to_owned()
    }

    fn header(&self, work: usize) -> String {
        let (model, step) = (&self.file.model, self.step);
        let upper = self.name.to_ascii_uppercase();
        let si = Units::default();
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
            (driver.name.clone(), format!("{}, {}", driver.name, unit(si, model.driven(driver).quantity)))
        });
        let driver_names = enumerated("DRIVER", &mut drivers);
        let mut bodies = model.bodies.iter().skip(1).map(|body| (body.name.clone(), body.name.clone()));
        let body_names = enumerated("BODY", &mut bodies);
        let mut measures = self.measures.list.iter().map(|m| {
            let note = match m.from {
                MeasureSource::Formulas(_) => "",
                MeasureSource::Step(_) => "; without rates",
            };
            let Output { name, dimension, .. } = &m.output;
            (name.clone(), format!("{name}, {}{note}", unit(si, *dimension)))
        });
        let measure_names = enumerated("MEASURE", &mut measures);
        let has_measures = !self.measures.list.is_empty();
        let measure_text = self.filled(MEASURE_TYPES, &[("measure_constants", measure_names)]);
        let jacobian = self.filled(JACOBIAN_DECLARED, &[]);
        let field = format!("    {}_measure_value measure[{upper}_MEASURES];\n", self.name);
        let when = |text: String| if has_measures { text } else { String::new() };
        let start: Vec<String> = model
            .drivers
            .iter()
            .zip(&step.drivers)
            .map(|(driver, at)| {
                format!(
                    "{} at {} {}",
                    comment(&driver.name),
                    at.start,
                    unit(si, model.driven(driver).quantity)
                )
            })
            .collect();
        let mut places = vec![
            ("drivers", step.drivers.len().to_string()),
            ("bodies", (model.bodies.len() - 1).to_string()),
            ("measures", self.measures.list.len().to_string()),
            ("coordinates", step.coordinates.len().to_string()),
            ("blocks", step.logarithmic.len().to_string()),
            ("coordinates_or_one", step.coordinates.len().max(1).to_string()),
            ("blocks_or_one", step.logarithmic.len().max(1).to_string()),
            ("counted_or_one", self.measures.counted.len().max(1).to_string()),
            ("work", work.to_string()),
            ("driver_names", driver_names),
            ("body_names", body_names),
            ("measure_names", when(measure_text)),
            ("measure_field", when(field)),
            ("jacobian", when(jacobian)),
            ("start", start.join(", ")),
        ];
        places.extend(self.heading());
        self.filled(HEADER, &places)
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
        text.replace("@name@", &self.name).replace("@NAME@", &self.name.to_ascii_uppercase())
    }
}

/// Lvalue of number k of a body.
fn body_number(body: usize, k: usize) -> String {
    let at = match k {
        0..3 => format!("r[{k}]"),
        3..12 => format!("axis[{}][{}]", (k - 3) / 3, k % 3),
        12..15 => format!("v[{}]", k % 3),
        15..18 => format!("omega[{}]", k % 3),
        18..21 => format!("a[{}]", k % 3),
        _ => format!("alpha[{}]", k % 3),
    };
    format!("o->body[{}].{at}", body - 1)
}

/// A list that is not empty: C has no arrays without elements.
fn or_zero(list: Vec<String>) -> Vec<String> {
    if list.is_empty() { vec!["0".to_owned()] } else { list }
}

/// C identifier that resembles a name.
pub(crate) fn identifier(name: &str) -> String {
    let mut plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    if !plain.starts_with(|c: char| c.is_ascii_alphabetic()) {
        plain.insert_str(0, "m_");
    }
    plain
}

/// Text within a comment.
fn comment(text: &str) -> String {
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    text.chars().map(plain).collect::<String>().replace("*/", "* /").replace("/*", "/ *").replace('@', "(at)")
}
