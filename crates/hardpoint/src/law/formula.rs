//! Law given by an expression in `t`, with named parameters.

use std::fmt;

use crate::expression::{self, Enclosure, ExpressionError, Program, Stretch};
use crate::number::{Interval, Jet, Real};

use super::breaks::Break;
use super::jumps::find_switches;
use super::kind::LawKind;
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};

/// An expression, its parameters, and its programs.
#[derive(Clone)]
pub(super) struct ExpressionLaw {
    text: String,
    names: Vec<String>,
    values: Vec<f64>,
    /// Program with symbolic parameters, for derivatives with respect to them.
    symbolic: Program,
    /// Program with the values of the parameters inserted, for all other evaluations.
    program: Program,
}

impl ExpressionLaw {
    pub(super) fn parse(text: &str, parameters: &[(&str, f64)]) -> Result<Self, ExpressionError> {
        let (names, values): (Vec<&str>, Vec<f64>) = parameters.iter().copied().unzip();
        let symbolic = expression::parse(text, &names)?;
        if let Some((name, value)) = parameters.iter().find(|(_, value)| !value.is_finite()) {
            let message = format!("the parameter `{name}` must be a finite number, not {value}");
            return Err(ExpressionError { span: 0..text.len(), message, help: None });
        }
        let program = symbolic.with_values(&values);
        let names = names.into_iter().map(str::to_owned).collect();
        Ok(Self { text: text.to_owned(), names, values, symbolic, program })
    }

    pub(super) fn constant(value: f64) -> Self {
        let program = Program::constant(value);
        let (names, values) = (Vec::new(), Vec::new());
        Self { text: value.to_string(), names, values, symbolic: program.clone(), program }
    }
}

impl LawKind for ExpressionLaw {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let program = if seed.is_some() { &self.symbolic } else { &self.program };
        program.at(time, |index| Jet::constant(seeded(self.values[index], index, seed)))
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        self.program.at(Stretch::time(from, to), |_| Stretch::UNBOUNDED)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        self.program.at(Enclosure::time(over), |_| Enclosure::unbounded()).0
    }

    fn parameters(&self) -> Vec<Parameter> {
        let named = self.names.iter().zip(&self.values);
        named.map(|(name, &value)| parameter(name, value, ParameterKind::Number)).collect()
    }

    fn parameter_count(&self) -> usize {
        self.names.len()
    }

    fn parameter_kind(&self, _: usize) -> ParameterKind {
        ParameterKind::Number
    }

    fn set(&mut self, parameter: usize, value: f64) {
        self.values[parameter] = value;
        self.program = self.symbolic.with_values(&self.values);
    }

    fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
        find_switches(&self.program, from, to, breaks);
    }
}

/// Writes the text, followed by the values of its parameters.
impl fmt::Display for ExpressionLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)?;
        for (k, (name, value)) in self.names.iter().zip(&self.values).enumerate() {
            write!(f, "{}{name} = {value}", if k == 0 { " with " } else { ", " })?;
        }
        Ok(())
    }
}

impl PartialEq for ExpressionLaw {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.names == other.names && self.values == other.values
    }
}
