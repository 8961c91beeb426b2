//! Laws of motion: what a driver prescribes as a function of the time, with exact time derivatives.
//!
//! A [`Law`] is read from an expression in `t`:
//!
//! | written | meaning |
//! |---|---|
//! | `1`, `.5`, `1e-3` | numbers, with a decimal point |
//! | `t`, `pi` | the time in seconds, and 3.14159... |
//! | `+ - * / ^`, `( )` | `^` binds first and from the right, then the sign (`-t^2` is `-(t^2)`), then `* /`, then `+ -` |
//! | `sin cos tan asin acos atan sinh cosh tanh` | of one argument, angles in radians |
//! | `exp ln log10 sqrt abs` | of one argument |
//! | `atan2(y, x)`, `hypot(x, y)`, `pow(x, p)` | of two arguments |
//! | `min(a, b, ...)`, `max(a, b, ...)` | of two or more arguments |
//! | `step(x, x0, h0, x1, h1)` | `h0` up to `x0`, `h1` from `x1` on, between them `h0 + (h1 - h0)(3u² - 2u³)` |
//! | `if(a < b, x, y)` | `x` where the comparison (`<`, `<=`, `>`, `>=`) holds, else `y` |
//!
//! Derivatives are propagated as [`TimeJet`]s, so they carry rounding error only, no step size.
//!
//! What is *not* here: a law says nothing of where it is not smooth. `abs`, `min`, `max`, `step` and `if` are
//! differentiated on the side that is active; see [`Law::at`].

mod expression;
mod jet;
mod program;

use std::fmt;

pub use expression::ExpressionError;
pub use jet::TimeJet;
use program::{Operation, Program};

/// The law of motion of a driver, f(t), in the driver's own unit with t in seconds.
///
/// Two laws are equal when they were written the same and are scaled the same.
///
/// # Example
///
/// A cubic, whose derivatives at t = 2 s can be checked by hand:
///
/// ```
/// use hardpoint::law::Law;
///
/// let lift = Law::parse("5 + t^3/4")?;
/// let at = lift.at(2.0);
/// assert_eq!(at.value(), 7.0); // 5 + 8/4
/// assert_eq!(at.d(), 3.0); // 3 t²/4
/// assert_eq!(at.dd(), 3.0); // 6 t/4
/// assert_eq!(at.ddd(), 1.5); // 6/4
/// # Ok::<(), hardpoint::law::ExpressionError>(())
/// ```
#[derive(Clone)]
pub struct Law {
    text: String,
    factor: f64,
    program: Program,
}

impl Law {
    /// The law that `text` writes, in whatever unit the text's author had in mind.
    ///
    /// # Errors
    ///
    /// When `text` is not an expression of the [module's](self) language. The error says where, and what to write
    /// instead:
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let error = Law::parse("3*sinn(t)").unwrap_err();
    /// assert_eq!(error.span, 2..6);
    /// assert_eq!(error.message, "unknown name `sinn`");
    /// assert!(error.help.unwrap().starts_with("did you mean `sin`?"));
    /// ```
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { text: text.to_owned(), factor: 1.0, program: expression::parse(text)? })
    }

    /// The law that holds `value` at all times, in the driver's own unit.
    pub fn constant(value: f64) -> Self {
        let mut program = Program::default();
        program.emit(Operation::Constant(value));
        Self { text: value.to_string(), factor: 1.0, program }
    }

    /// This law times `factor`, as for a change of unit. The text remains as written.
    ///
    /// ```
    /// use hardpoint::law::Law;
    ///
    /// let travel_mm = Law::parse("25*t")?;
    /// let travel = travel_mm.scaled(1e-3);
    /// assert_eq!(travel.at(2.0).value(), 0.05);
    /// assert_eq!(travel.to_string(), "25*t");
    /// # Ok::<(), hardpoint::law::ExpressionError>(())
    /// ```
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.factor *= factor;
        self
    }

    /// The value and the first three time derivatives at time `t`: driver unit per s⁰, s, s², s³; `t` in seconds.
    ///
    /// Where the law is not smooth these are the derivatives of one side: `abs`, `min`, `max` and `step` take the
    /// side that is active just after `t`, `if` the side whose condition holds at `t`.
    ///
    /// Where the law is not defined (`sqrt` of a negative number, a division by zero) the result is not finite;
    /// reporting that is left to whoever knows the driver's name.
    pub fn at(&self, t: f64) -> TimeJet {
        self.program.evaluate(t) * self.factor
    }
}

/// Shows the text the law was read from, without the factor of [`Law::scaled`].
impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl fmt::Debug for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The program holds function addresses, which differ from run to run; the text says all of it.
        f.debug_struct("Law").field("text", &self.text).field("factor", &self.factor).finish_non_exhaustive()
    }
}

impl PartialEq for Law {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.factor == other.factor
    }
}

#[cfg(test)]
mod tests;
