//! A number that is written as an expression over named numbers.

use super::expression::{self, ExpressionError};
use super::program::{Operation, Program};
use crate::space::Real;

/// A number of a model that is written as an expression in the [language of laws](super), without the time: `hub + shim/2`.
///
/// Names that are no functions stand for parameters of the model, and those of two parts, like `ball.x`, for coordinates of
/// its hardpoints. Angles are in radians.
///
/// ```
/// use hardpoint::law::Expression;
///
/// let width = Expression::parse("2*hub + shim/2")?;
/// assert_eq!(width.names(), ["hub", "shim"]);
/// assert_eq!(width.at(&[100.0, 3.0]), 201.5);
/// # Ok::<(), hardpoint::law::ExpressionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    names: Vec<String>,
    program: Program,
    per_metre: f64,
}

impl Expression {
    /// The number that `text` writes, with lengths in metres.
    ///
    /// # Errors
    /// When `text` is not an expression; the error says where, and what to write instead.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let (program, names) = expression::parse_open(text)?;
        let names = names.into_iter().map(str::to_owned).collect();
        Ok(Self { text: text.to_owned(), names, program, per_metre: 1.0 })
    }

    /// The expression that is this number.
    pub fn constant(value: f64) -> Self {
        let program = Program::constant(value);
        Self { text: value.to_string(), names: Vec::new(), program, per_metre: 1.0 }
    }

    /// The same text, whose lengths are in a unit of which so many make a metre.
    #[must_use]
    pub fn with_unit(self, per_metre: f64) -> Self {
        Self { per_metre, ..self }
    }

    /// How many of its unit of length make a metre.
    pub fn per_metre(&self) -> f64 {
        self.per_metre
    }

    /// What was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names in it, in the order of their first use.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The value for these numbers in place of the [names](Self::names), as the text means them.
    ///
    /// # Panics
    /// When there are fewer numbers than names.
    pub fn at(&self, numbers: &[f64]) -> f64 {
        self.over(0.0, |k| numbers[k])
    }

    /// As [`at`](Self::at), over any scalar.
    pub(crate) fn over<T: Real>(&self, witness: T, number: impl Fn(usize) -> T) -> T {
        self.program.over(witness, number)
    }

    /// The expression with numbers in place of those names that have one; it has the other names.
    pub(crate) fn with_some(&self, number: impl Fn(usize) -> Option<f64>) -> Self {
        let numbers: Vec<Option<f64>> = (0..self.names.len()).map(number).collect();
        let mut left = 0;
        let leaves: Vec<Operation> = numbers
            .iter()
            .map(|number| match number {
                Some(value) => Operation::Constant(*value),
                None => {
                    left += 1;
                    Operation::Parameter(left - 1)
                }
            })
            .collect();
        let names = self.names.iter().zip(&numbers).filter(|(_, n)| n.is_none());
        Self {
            names: names.map(|(name, _)| name.clone()).collect(),
            program: self.program.with_leaves(|k| leaves[k]),
            ..self.clone()
        }
    }

    /// Whether expressions can use what has this name: letters, digits and `_`, no digit first, and none of the names that
    /// they know already.
    pub fn can_name(name: &str) -> bool {
        expression::is_free_name(name)
    }
}

/// Written the same, in the same unit.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.names == other.names && self.per_metre == other.per_metre
    }
}
