//! Scalar types: plain numbers, and numbers that carry derivatives or record their arithmetic.
//!
//! | number | carries |
//! |---|---|
//! | `f64` | the value only |
//! | [`Dual`] | the derivative with respect to one variable; nested: second derivatives |
//! | [`Jet`] | up to three time derivatives |
//! | [`Taylor`] | mixed partial derivatives by up to three variables |
//! | [`Interval`] | bounds: all numbers that the value may be |
//! | [`hardpoint_tape::Number`] | its recorded arithmetic: kernels are recorded with it |
//!
//! All of them implement [`Real`], and they nest: a `Dual<Jet<f64, 3>>` is a measure with its rates, and the
//! derivatives of all three with respect to a design variable. Code written once over [`Real`] runs on each of them. A
//! [`Function`] of one number is defined once, with its name and its derivatives.

mod dual;
mod function;
mod interval;
mod jet;
mod real;
pub(crate) mod record;
mod taylor;

pub use dual::Dual;
pub use function::Function;
pub use interval::Interval;
pub use jet::{Jet, Rates};
pub use real::Real;
pub(crate) use taylor::degrees;
pub use taylor::{Exponents, Taylor};

/// An array of at least one number, by index: `std::array::from_fn`, inlined everywhere.
#[inline(always)]
pub(crate) fn array<T: Copy, const N: usize>(number: impl Fn(usize) -> T) -> [T; N] {
    let mut out = [number(0); N];
    for k in 1..N {
        out[k] = number(k);
    }
    out
}

/// A function of every number of an array: `map`, inlined everywhere.
#[inline(always)]
pub(crate) fn each<T: Copy, U: Copy, const N: usize>(of: &[T; N], function: impl Fn(T) -> U) -> [U; N] {
    array(
        #[inline(always)]
        |k| function(of[k]),
    )
}

/// A function of both parts of a pair: `map`, inlined everywhere.
#[inline(always)]
pub(crate) fn both<T, U>([first, second]: [T; 2], mut function: impl FnMut(T) -> U) -> [U; 2] {
    [function(first), function(second)]
}
