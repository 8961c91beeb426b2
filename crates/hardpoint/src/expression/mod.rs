//! Numbers written as expressions: of time (the law of a driver), or of other numbers of the model.
//!
//! # The language of expressions
//!
//! | written | meaning |
//! |---|---|
//! | `1`, `.5`, `1e-3` | numbers, with a decimal point |
//! | `t`, `pi` | the time in seconds, and 3.14159... |
//! | any other name | a parameter, if [`Law::parse_with`](crate::law::Law::parse_with) is given one of that name |
//! | `+ - * / ^`, `( )` | `^` binds first and from the right, then the sign (`-t^2` is `-(t^2)`), then `* /`, then `+ -` |
//! | `sin cos tan asin acos atan sinh cosh tanh` | of one argument, angles in radians |
//! | `exp ln log10 sqrt abs` | of one argument |
//! | `atan2(y, x)`, `hypot(x, y)`, `pow(x, p)` | of two arguments |
//! | `min(a, b, ...)`, `max(a, b, ...)` | of two or more arguments |
//! | `step(x, x0, h0, x1, h1)` | `h0` up to `x0`, `h1` from `x1` on, between them `h0 + (h1 - h0)(3u² - 2u³)` |
//! | `if(a < b, x, y)` | `x` where the comparison (`<`, `<=`, `>`, `>=`) holds, else `y` |
//!
//! Derivatives are propagated as [jets](crate::number::Jet), so they carry rounding error only, no step size; `abs`,
//! `min`, `max`, `step` and `if` are differentiated on the side that is active.

mod enclosure;
mod formula;
mod parse;
mod program;
mod range;
mod term;

pub(crate) use enclosure::Enclosure;
pub use formula::Expression;
pub use parse::ExpressionError;
pub(crate) use parse::{names, parse};
pub(crate) use program::Program;
pub use range::{Range, Stretch};
pub(crate) use term::ExpressionValue;
