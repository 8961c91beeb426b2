//! The functions of the programs: correction, path and motion of a step, measures, and their derivatives.

use std::fmt::Write;

use hardpoint::measure::MeasureFormulas;
use hardpoint::model::OutputSource;
use hardpoint_tape::{Operand, Program};

use super::super::emit::{BODY, Function, body_number};
use super::super::measures::{Measure, MeasureSource};
use super::{Sizes, Source};

/// Type of a parameter that is read only.
const READ: &str = "const double *";
/// Parameters of the generated functions: a position and its rates, and memory.
const POSITION: [(&str, &str); 2] = [(READ, "x"), (READ, "q")];
const RATES: [(&str, &str); 2] = [(READ, "qd"), (READ, "qdd")];
const WORK: (&str, &str) = ("double *", "w");

/// Functions of the programs, while they are written.
pub(super) struct Functions<'a> {
    name: &'a str,
    larger: String,
    pub text: String,
    pub sizes: Sizes,
    /// Calls of the functions that compute the numbers of the design.
    pub prepare: String,
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
    /// The functions of all programs.
    pub(super) fn functions(&self) -> Functions<'_> {
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

    /// Expressions of the design variables that programs read: arguments, or nominal.
    fn design_inputs(&self, of: &str) -> Vec<String> {
        let input = |k: usize| match self.design.iter().position(|d| *d == k) {
            Some(at) => format!("{of}[{at}]"),
            None => "0.0".to_owned(),
        };
        (0..self.step.design.len()).map(input).collect()
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

    /// Index of the counter of a measure's whole turns.
    fn counter_of(&self, measure: usize) -> Option<usize> {
        self.measures
            .counted
            .iter()
            .position(|(at, _)| self.measures.list[*at].output.source == OutputSource::Measure(measure))
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
}
