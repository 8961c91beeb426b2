//! Source and header of a motion.

mod control;
mod declarations;
mod functions;

use std::path::Path;

use hardpoint::measure::MeasureFormulas;
use hardpoint::motion::{DrivenStep, MotionCheck};
use hardpoint::sensitivity::Admissibility;
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;

use self::functions::Functions;
use crate::{ExportError, ExportedModel};

use super::emit::{comment, literal};
use super::header::{check_header, identifier};
use super::measures::{Measure, MeasureSource, Measures};
use super::replay::{ReplayResult, replay};

const SOURCE: &str = include_str!("source.c");
const LARGER: &str = include_str!("larger.c");
const CONTROL: &str = include_str!("control.c");
const JACOBIAN: &str = include_str!("jacobian.c");
// If requested: derivatives, and the design.
const DERIVATIVE: &str = include_str!("derivative.c");
const DERIVED_MEASURES: &str = include_str!("derived_measures.c");
const DESIGN: &str = include_str!("design.c");
const FOLLOWS: &str = include_str!("follows.c");
/// Check of a direction that changes the design.
const FOLLOWS_CALL: &str = "    if (!@name@_follows(s, &p, along, dx, o->residual, d))
        return @NAME@_LOCKED;
";
const GRADIENT: &str = include_str!("gradient.c");
/// Residual that is round-off of positions, rad or sizes of loops.
const LEAST_MISFIT: f64 = 1e-9;

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
            text += &self.derivative();
        }
        (text, sizes)
    }

    /// The functions for derivatives of all results in a direction.
    fn derivative(&self) -> String {
        let mut text = String::new();
        let mut follows = String::new();
        if self.has_design() {
            let places = [
                ("checks", self.checks().to_string()),
                ("misfit", literal(10.0 * self.residual + LEAST_MISFIT)),
            ];
            text += &self.filled(FOLLOWS, &places);
            follows = self.filled(FOLLOWS_CALL, &[]);
        }
        let mut derived = String::new();
        if self.has_formulas() {
            let design = if self.has_design() { "p.design, " } else { "" };
            derived = format!("    {}_formulas_tangent(&p, {design}along, o, s->work, d);\n", self.name);
        }
        if self.has_measures() {
            derived += &self.filled(DERIVED_MEASURES, &[]);
        }
        let places = [
            ("outputs", self.step.coordinates.len().max(1).to_string()),
            ("follows", follows),
            ("derived_measures", derived),
        ];
        text += &self.filled(DERIVATIVE, &places);
        if self.has_design() && self.has_measures() {
            text += &self.filled(GRADIENT, &[]);
        }
        text
    }

    /// True if the design is an argument.
    fn has_design(&self) -> bool {
        !self.design.is_empty()
    }

    fn has_measures(&self) -> bool {
        !self.measures.list.is_empty()
    }

    fn has_formulas(&self) -> bool {
        self.measures.list.iter().any(|m| matches!(m.from, MeasureSource::Formulas(_)))
    }

    /// Number of checks and of what is found with them: determinants, excesses.
    fn checks(&self) -> usize {
        MotionCheck::ALL.len() + self.step.logarithmic.len() + self.step.step_measures.len()
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
