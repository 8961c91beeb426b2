//! The control: iteration, checks and state.

use std::fmt::Write;

use hardpoint::motion::{DrivenCoordinate, MotionCheck};

use super::super::curves;
use super::super::emit::literal;
use super::super::measures::MeasureSource;
use super::super::replay::start_inputs;
use super::Source;

const MEASURES: &str = include_str!("../measures.c");
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

impl Source<'_> {
    /// Parts of the control that depend on the model.
    pub(super) fn control(&self, prepare: &str) -> Vec<(&'static str, String)> {
        let step = self.step;
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
            ("tables", self.tables()),
            ("checks", self.checks().to_string()),
            ("outputs", width.to_string()),
            ("measures", self.results()),
            ("start", self.start()),
        ]
    }

    /// Units of coordinates and drivers, the kind of each determinant, and the function of the measures.
    fn tables(&self) -> String {
        let (step, name) = (self.step, &self.name);
        let units = |which: &str, list: &[DrivenCoordinate]| {
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
        if self.has_formulas() {
            tables += &self.measuring();
        }
        tables
    }

    /// Statements that copy determinants from the checks, and compute the measures.
    fn results(&self) -> String {
        let blocks = self.step.logarithmic.len();
        let first = MotionCheck::ALL.len();
        let mut results = String::new();
        for b in 0..blocks {
            let _ = writeln!(results, "    p->determinant[{b}] = check[{}];", first + b);
        }
        for (at, measure) in self.measures.list.iter().enumerate() {
            if let MeasureSource::Step(n) = measure.from {
                let excess = first + blocks + n;
                let _ = writeln!(
                    results,
                    "    if (!(check[{excess}] <= 0.0))\n        o->measure[{at}].value = NAN;\n    \
                     o->measure[{at}].rate = o->measure[{at}].acceleration = NAN;"
                );
            }
        }
        if self.has_formulas() {
            let g = if self.has_design() { "g, " } else { "" };
            let _ = writeln!(results, "    {}_measure(p, {g}w, o);", self.name);
        }
        results.trim_end().to_owned()
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
}

/// A list that is not empty: C has no arrays without elements.
fn or_zero(list: Vec<String>) -> Vec<String> {
    if list.is_empty() { vec!["0".to_owned()] } else { list }
}
