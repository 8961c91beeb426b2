//! Expressions over names, with their text.

use crate::number::Real;

use super::parse::{self, ExpressionError, parse_open};
use super::program::{Operation, Program};

/// A number of a model, written as an expression in the [language](super) without the time: `hub + shim/2`.
///
/// Names other than functions refer to parameters of the model; names of two parts, like `ball.x`, to coordinates of
/// its hardpoints. Angles are in radians.
///
/// ```
/// use hardpoint::expression::Expression;
///
/// let width = Expression::parse("2*hub + shim/2")?;
/// assert_eq!(width.names(), ["hub", "shim"]);
/// assert_eq!(width.at(&[100.0, 3.0]), 201.5);
/// # Ok::<(), hardpoint::expression::ExpressionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    names: Vec<String>,
    program: Program,
    per_metre: f64,
}

impl Expression {
    /// Parses an expression whose lengths are in metres.
    ///
    /// # Errors
    /// Returns an error with its position and a correction if `text` is not an expression.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let (program, names) = parse_open(text)?;
        let names = names.into_iter().map(str::to_owned).collect();
        Ok(Self { text: text.to_owned(), names, program, per_metre: 1.0 })
    }

    /// Constant expression with this value.
    pub fn constant(value: f64) -> Self {
        let program = Program::constant(value);
        Self { text: value.to_string(), names: Vec::new(), program, per_metre: 1.0 }
    }

    /// Sum of a name, which expressions may be unable to write, and a number.
    ///
    /// # Errors
    /// Returns an error if the number is not finite.
    pub fn sum(name: &str, number: f64) -> Result<Self, ExpressionError> {
        let sum = Self::parse(&format!("name + ({number:?})"))?;
        Ok(Self { text: format!("{name} + ({number:?})"), names: vec![name.to_owned()], ..sum })
    }

    /// This expression with its lengths in a unit of which `per_metre` make a metre.
    #[must_use]
    pub fn with_unit(self, per_metre: f64) -> Self {
        Self { per_metre, ..self }
    }

    /// Number of its length units per metre.
    pub fn per_metre(&self) -> f64 {
        self.per_metre
    }

    /// Text of the expression.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Names in the expression, in the order of their first use.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Value for these numbers in place of the [names](Self::names), in the units of the text.
    ///
    /// # Panics
    /// Panics if there are fewer numbers than names.
    pub fn at(&self, numbers: &[f64]) -> f64 {
        self.over(|k| numbers[k])
    }

    /// Value over any scalar type; see [`at`](Self::at).
    #[inline]
    pub(crate) fn over<T: Real>(&self, number: impl Fn(usize) -> T) -> T {
        self.evaluate(&number)
    }

    /// True if the result is a magnitude, whose square is smooth where it vanishes.
    pub(crate) fn is_magnitude(&self) -> bool {
        self.program.is_magnitude()
    }

    /// The body of [`over`](Self::over), compiled once per scalar type for all callers.
    fn evaluate<T: Real>(&self, number: &dyn Fn(usize) -> T) -> T {
        self.program.at(T::constant(f64::NAN), number)
    }

    /// This expression with numbers in place of the names for which `number` returns one; the other names remain.
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

    /// True if `name` is valid in expressions: letters, digits and `_`, not beginning with a digit, and not a built-in
    /// name.
    pub fn can_name(name: &str) -> bool {
        parse::is_free_name(name)
    }

    /// True if expressions read `name` as a constant: `pi`.
    pub fn is_constant(name: &str) -> bool {
        name == parse::PI
    }
}

/// Equal if the text and the unit are the same.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.names == other.names && self.per_metre == other.per_metre
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::law::Law;
    use crate::number::Dual;

    /// Every operation, with `a` between 0.2 and 0.9 and `b` near 2.
    const TEXTS: [&str; 26] = [
        "-a + 2*b - a/b",
        "sin(a*b)",
        "cos(a)^2",
        "tan(a)",
        "asin(a/b)",
        "acos(a*a)",
        "atan(a*b)",
        "sinh(a)",
        "cosh(a*b)",
        "tanh(a)",
        "exp(a/b)",
        "ln(a + b)",
        "log10(a*b)",
        "sqrt(a*b)",
        "abs(a - b)*a",
        "atan2(a, b)",
        "hypot(a, 3*b)",
        "a^b",
        "pow(b, a)",
        "b^-3 + a^2.5",
        "min(a, b, a*b)",
        "max(a^2, b*a)",
        "step(a, 0.1, b, 1, 3)",
        "step(a, 2, a*b, 3, 7)",
        "if(a < b, a*b, sqrt(a - b))",
        "if(a >= b, sqrt(a - b), b^2*a)",
    ];

    #[test]
    fn numbers_and_laws_of_the_same_text_agree_and_so_do_their_derivatives() {
        for text in TEXTS {
            let number = Expression::parse(text).unwrap();
            for (a, b) in [(0.2, 1.9), (0.7, 2.2), (0.85, 2.0)] {
                let given = |name: &str| if name == "a" { a } else { b };
                let names: Vec<(&str, f64)> = number.names().iter().map(|n| (n.as_str(), given(n))).collect();
                let law = Law::parse_with(text, &names).unwrap();
                let close = |found: f64, expected: f64, what: &str| {
                    assert!(
                        (found - expected).abs() < 2e-14 * expected.abs().max(1.0),
                        "{text}: {what} {found} {expected}"
                    );
                };
                close(number.over(|k| names[k].1), law.at(0.0).value(), "value");
                for by in 0..names.len() {
                    let seeded = |k: usize| Dual { v: names[k].1, d: f64::from(k == by) };
                    close(number.over(seeded).d, law.derivative(by, 0.0).value(), "derivative");
                    let twice = |x: f64| {
                        let at = |k: usize| {
                            let v = if k == by { x } else { names[k].1 };
                            Dual {
                                v: Dual { v, d: f64::from(k == by) },
                                d: Dual::constant(f64::from(k == by)),
                            }
                        };
                        number.over(at)
                    };
                    let (h, x) = (1e-5, names[by].1);
                    let second = (twice(x + h).v.d - twice(x - h).v.d) / (2.0 * h);
                    let found = twice(x).d.d;
                    assert!(
                        (found - second).abs() < 1e-7 * second.abs().max(1.0),
                        "{text}: {found} {second}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_has_no_value_is_not_a_number_in_any_scalar() {
        for text in
            ["sqrt(a - 2)", "if(ln(-a) < 1, 1, 2)", "step(a, 3*a, 1, 2, 5)", "min(a, 0/(a - a))", "asin(2*a)"]
        {
            let number = Expression::parse(text).unwrap();
            assert!(number.over(|_| 1.0).is_nan(), "{text}");
            assert!(number.over(|_| Dual::variable(1.0)).v.is_nan(), "{text}");
        }
    }

    #[test]
    fn numbers_in_place_of_names_leave_the_others() {
        let number = Expression::parse("a*b + c/b").unwrap();
        let left = number.with_some(|k| (k == 1).then_some(2.0));
        assert_eq!(left.names(), ["a", "c"]);
        assert_eq!(left.at(&[3.0, 8.0]), 10.0);
        assert_eq!(number.at(&[3.0, 2.0, 8.0]), 10.0);
        assert!(
            Expression::can_name("hub_2") && !Expression::can_name("sin") && !Expression::can_name("a.x")
        );
    }
}
