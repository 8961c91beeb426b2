//! The recording scalar as a [`Real`]: kernels are recorded by running them with it.

use std::cell::{Cell, RefCell};

use hardpoint_tape::{Call, Number};

use super::Function;
use super::real::{LARGEST_ANGLE, Real};

thread_local! {
    /// Whether something that is recorded on this thread was looked at lane by lane.
    static BY_LANES: Cell<bool> = const { Cell::new(false) };
    static STRICT: Cell<bool> = const { Cell::new(false) };
    static LIMITS: RefCell<Vec<Number>> = const { RefCell::new(Vec::new()) };
}

/// Forgets what was recorded before.
pub(crate) fn begin() {
    BY_LANES.set(false);
    STRICT.set(false);
    LIMITS.take();
}

/// Records what goes by no value that is unknown: where a number that may be another is looked at and is zero by chance, it is no
/// arithmetic.
pub(crate) fn strictly<R>(f: impl FnOnce() -> R) -> R {
    STRICT.set(true);
    let result = f();
    STRICT.set(false);
    result
}

/// What has come up since [`begin`], and must not be positive where the program is run.
pub(crate) fn limits() -> Vec<Number> {
    LIMITS.take()
}

/// Whether everything since [`begin`] is arithmetic: no lane was looked at, since a program takes what is made of it for a constant.
pub(crate) fn is_arithmetic() -> bool {
    !BY_LANES.get()
}

/// Decisions go by the values of the run that is recorded.
impl Real for Number {
    const LANES: usize = 1;
    fn like(self, x: f64) -> Self {
        Number::constant(x)
    }
    fn like_lanes(self, mut lane: impl FnMut(usize) -> f64) -> Self {
        Number::constant(lane(0))
    }
    fn lane(self, _: usize) -> f64 {
        BY_LANES.set(true);
        self.value()
    }
    fn store(self, out: &mut [f64]) {
        out[0] = self.lane(0);
    }
    fn each_lane(components: &[Self; 8], mut out: impl FnMut(usize, &[f64; 8])) {
        out(0, &components.map(|x| x.lane(0)));
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
    fn select(self, other: Self, first: impl Fn(usize) -> bool + Copy) -> Self {
        BY_LANES.set(true);
        if first(0) { self } else { other }
    }
    fn map(self, function: Function) -> Self {
        self.call(match function {
            Function::Sin => return self.sin_cos_of_any().0,
            Function::Cos => return self.sin_cos_of_any().1,
            Function::Sqrt => return self.sqrt(),
            Function::Abs => return self.abs(),
            Function::Log10 => return self.call(Call::Ln) * std::f64::consts::LOG10_E,
            Function::Tan => Call::Tan,
            Function::Asin => Call::Asin,
            Function::Acos => Call::Acos,
            Function::Atan => Call::Atan,
            Function::Sinh => Call::Sinh,
            Function::Cosh => Call::Cosh,
            Function::Tanh => Call::Tanh,
            Function::Exp => Call::Exp,
            Function::Ln => Call::Ln,
        })
    }
    fn is_zero(self, _: usize) -> bool {
        match self.known() {
            Some(x) => x == 0.0,
            None => self.lane(0) == 0.0,
        }
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
    fn within<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
    fn larger(self, o: Self) -> Self {
        Number::larger(self, o)
    }
    fn largest(self) -> f64 {
        if STRICT.get() && self.known().is_none() && self.value() == 0.0 {
            BY_LANES.set(true);
        }
        self.value()
    }
}
