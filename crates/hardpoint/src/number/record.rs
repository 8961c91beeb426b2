//! The recording scalar as a [`Real`]: kernels are recorded by running them on it.

use std::cell::{Cell, RefCell};

use hardpoint_tape::{Call, Number};

use super::Function;
use super::real::{LARGEST_ANGLE, Real};

thread_local! {
    /// True if a value that depends on inputs was read on this thread.
    static LOOKED_AT: Cell<bool> = const { Cell::new(false) };
    static STRICT: Cell<bool> = const { Cell::new(false) };
    static LIMITS: RefCell<Vec<Number>> = const { RefCell::new(Vec::new()) };
}

/// Discards what was recorded before.
pub(crate) fn begin() {
    LOOKED_AT.set(false);
    STRICT.set(false);
    LIMITS.take();
}

/// Runs `f` as part of a recording that must hold for all values of its inputs: a decision on an input-dependent number
/// that happens to be zero makes the recording non-arithmetic.
pub(crate) fn strictly<R>(f: impl FnOnce() -> R) -> R {
    STRICT.set(true);
    let result = f();
    STRICT.set(false);
    result
}

/// Conditions recorded since [`begin`], which must not be positive when the program runs.
pub(crate) fn limits() -> Vec<Number> {
    LIMITS.take()
}

/// True if everything since [`begin`] is arithmetic: no value that depends on inputs was read, since a program would
/// treat everything computed from it as constant.
pub(crate) fn is_arithmetic() -> bool {
    !LOOKED_AT.get()
}

/// Decisions depend on the values of the recorded run.
impl Real for Number {
    #[inline(never)]
    fn operation<R>(operation: impl FnOnce() -> R) -> R {
        operation()
    }
    fn constant(x: f64) -> Self {
        Number::constant(x)
    }
    fn value(self) -> f64 {
        // A constant has the same value in every run.
        if self.known().is_none() {
            LOOKED_AT.set(true);
        }
        Number::value(self)
    }
    fn decisive(self) -> f64 {
        let value = Number::value(self);
        if STRICT.get() && self.known().is_none() && value == 0.0 {
            LOOKED_AT.set(true);
        }
        value
    }
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Number::times_plus(self, factor, addend)
    }
    fn sqrt(self) -> Self {
        Number::sqrt(self)
    }
    fn abs(self) -> Self {
        Number::abs(self)
    }
    fn round(self) -> Self {
        Number::round(self)
    }
    fn sign_or(self, next: Self) -> Self {
        // A value that is zero by chance may have either sign.
        let is_zero = self.decisive() == 0.0;
        if is_zero && self.known().is_some() { next } else { self.abs() / self }
    }
    fn exceeds(self, o: Self) -> bool {
        LIMITS.with_borrow_mut(|limits| limits.push(o - self));
        true
    }
    fn select(self, other: Self, first: bool) -> Self {
        LOOKED_AT.set(true);
        if first { self } else { other }
    }
    fn map(self, function: Function) -> Self {
        self.call(match function {
            Function::Sin => return self.sin_cos_of_any().0,
            Function::Cos => return self.sin_cos_of_any().1,
            Function::Sqrt => return self.sqrt(),
            Function::Abs => return self.abs(),
            Function::Log10 => return self.call(Call::Ln) * std::f64::consts::LOG10_E,
            // A test records every function.
            _ => *Call::ALL
                .iter()
                .find(|c| c.name() == function.name())
                .expect("a function that is recorded as a call"),
        })
    }
    fn is_zero(self) -> bool {
        self.known().unwrap_or_else(|| Real::value(self)) == 0.0
    }
    fn vanishes(self) -> bool {
        self.known() == Some(0.0)
    }
    fn sin_cos_of_any(self) -> (Self, Self) {
        LIMITS.with_borrow_mut(|limits| limits.push(self.abs() + -LARGEST_ANGLE));
        self.sin_cos()
    }
    fn pow(self, exponent: Self) -> Self {
        Number::powf(self, exponent)
    }
    fn hypot(self, o: Self) -> Self {
        (self * self + o * o).sqrt()
    }
    fn atan2(self, x: Self) -> Self {
        Number::atan2(self, x)
    }
    fn larger(self, o: Self) -> Self {
        Number::larger(self, o)
    }
}

#[cfg(test)]
mod tests {
    use hardpoint_tape::{Options, record};

    use super::*;
    use crate::number::Jet;

    #[test]
    fn signs_are_arithmetic_and_what_exceeds_is_a_limit() {
        begin();
        let recorded = record(|| {
            let [x, rate] = [-2.0, 3.0].map(Number::input);
            let [size, growing] = Jet([x, rate]).abs().derivatives();
            assert!(x.exceeds(Number::constant(-5.0)));
            [vec![size, growing], limits()].concat()
        });
        assert!(is_arithmetic());
        let program = recorded.program(Options::default()).0;
        let run = |inputs: [f64; 2]| {
            let mut outputs = [0.0; 3];
            program.evaluate(&inputs, &[], &mut Vec::new(), &mut outputs);
            outputs
        };
        assert_eq!(run([-2.0, 3.0]), [2.0, -3.0, -3.0]);
        assert_eq!(run([2.0, 3.0]), [2.0, 3.0, -7.0]);
        assert_eq!(run([-6.0, 0.0])[2], 1.0);
        // Zero has two sides, and a program chooses neither.
        assert!(run([0.0, 3.0])[..2].iter().all(|x| x.is_nan()));
    }

    #[test]
    fn every_function_can_be_recorded() {
        for &function in Function::ALL {
            let recorded = record(|| [Number::input(0.6).map(function)]);
            let mut output = [0.0];
            recorded.program(Options::default()).0.evaluate(&[0.6], &[], &mut Vec::new(), &mut output);
            let expected = Real::map(0.6, function);
            assert!((output[0] - expected).abs() < 1e-15, "{}", function.name());
        }
    }

    #[test]
    fn the_sign_of_what_is_zero_by_chance_is_no_arithmetic() {
        for (x, fits) in [(0.0, false), (1.0, true)] {
            begin();
            record(|| [strictly(|| Number::input(x).sign())]);
            assert_eq!(is_arithmetic(), fits);
        }
    }
}
