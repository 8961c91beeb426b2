//! The trait of scalar types, and its implementation for `f64`.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::Function;

/// A scalar: a number that may also carry derivatives or record its arithmetic.
///
/// Plain numbers enter as constants: `T::constant(2.0)`.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The constant `x`.
    fn constant(x: f64) -> Self;

    /// Runs one operation of a compound number over this type. The recording scalar runs it in a function of its own: a
    /// recording is made once per model, and inlined its code would be a third of the crate.
    #[inline(always)]
    fn operation<R>(operation: impl FnOnce() -> R) -> R {
        operation()
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }

    /// The plain value. A recording in which it is read is not arithmetic, since a program would treat everything
    /// computed from the value as constant. Not to be confused with the inherent `value` of some number types.
    fn value(self) -> f64;

    /// The plain value for a decision, if the condition under which the decision holds is recorded separately (see
    /// [`exceeds`](Real::exceeds)).
    fn decisive(self) -> f64;

    /// `self * factor + addend`; programs may round only once.
    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    /// Square root.
    fn sqrt(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// Nearest integer.
    fn round(self) -> Self;

    /// 1 or -1 by the sign of the value, or `next` where it is zero. A recording is NaN there.
    fn sign_or(self, next: Self) -> Self;

    /// 1 or -1 by the sign just after the instant; 1 for a value that remains zero.
    #[inline(always)]
    fn sign(self) -> Self {
        self.sign_or(Self::constant(1.0))
    }

    /// True if this value is larger than the other. A recording assumes so, and adds the condition to its limits.
    fn exceeds(self, o: Self) -> bool;

    /// This value if `first`, else the `other`; the one not selected may be NaN. A recording in which this is called is
    /// not arithmetic.
    fn select(self, other: Self, first: bool) -> Self;

    /// The function of this value; by the standard library for plain numbers.
    fn map(self, function: Function) -> Self;

    /// True if it is zero, including any derivatives that it carries.
    fn is_zero(self) -> bool;

    /// Ordering of this value and another just after the instant: for numbers with time derivatives, the first
    /// derivative that differs decides ties.
    #[inline(always)]
    fn order(self, o: Self) -> Option<Ordering> {
        self.value().partial_cmp(&o.value())
    }

    /// This value as a constant in time: all time derivatives are zero, even where its operands had infinite ones.
    #[inline(always)]
    fn held(self) -> Self {
        self
    }

    /// This value alone: the derivatives that it carries are unknown, except where it depends on nothing, all of them
    /// being zero.
    #[inline(always)]
    fn without_derivatives(self) -> Self {
        self
    }

    /// This value to the power `exponent`.
    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        Self::constant(self.value().powf(exponent.value()))
    }

    /// This value to a fixed power.
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.pow(Self::constant(exponent))
    }

    /// This value to an integer power, by repeated squaring, in the order in which `f64::powi` multiplies.
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        let mut power = Self::one();
        let (mut square, mut left) = (self, exponent.unsigned_abs());
        loop {
            if left & 1 == 1 {
                power = power * square;
            }
            left >>= 1;
            if left == 0 {
                break;
            }
            square = square * square;
        }
        if exponent < 0 { Self::one() / power } else { power }
    }

    /// Length of the vector (self, o).
    #[inline(always)]
    fn hypot(self, o: Self) -> Self {
        Self::constant(self.value().hypot(o.value()))
    }

    /// The larger of two values; NaN if either is NaN.
    fn larger(self, o: Self) -> Self;

    /// True if it is known to be zero, including any derivatives that it carries.
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.decisive() == 0.0
    }

    /// Time derivative, for numbers that carry it; NaN for all others, and for the highest derivative carried.
    #[inline(always)]
    fn rate(self) -> Self {
        Self::constant(f64::NAN)
    }

    /// Inverse sine, rad.
    #[inline(always)]
    fn asin(self) -> Self {
        self.map(Function::Asin)
    }

    /// Angle of the point (x, self) from the x axis, rad in (-pi, pi].
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::constant(self.value().atan2(x.value()))
    }

    /// Angle with the sine `self` and the cosine `cos`, up to a common factor, that is nearest to `near`, rad.
    #[inline(always)]
    fn angle_near(self, cos: Self, near: Self) -> Self {
        const TURN: f64 = 2.0 * std::f64::consts::PI;
        // angle + 2 pi k, the nearest to `near`
        let angle = self.atan2(cos);
        angle + ((near - angle) * (1.0 / TURN)).round() * TURN
    }

    /// Sine and cosine of an angle of any size, rad; for plain numbers, those of the standard library.
    fn sin_cos_of_any(self) -> (Self, Self);

    /// Sine and cosine of an angle, rad, to about one unit in the last place for |x| up to 1e5 turns; of plain numbers,
    /// for any |x|.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos_within(self)
    }
}

/// Sine and cosine of an angle, rad, to about one unit in the last place for |x| up to 1e5 turns.
///
/// The angle is reduced by multiples of pi/2 in three parts (Cody and Waite), then evaluated by the polynomials of
/// fdlibm's kernels.
#[inline(always)]
#[expect(clippy::excessive_precision, reason = "the constants are written as published")]
fn sin_cos_within<T: Real>(angle: T) -> (T, T) {
    const PIO2_1: f64 = 1.570_796_326_734_125_6;
    const PIO2_2: f64 = 6.077_100_506_303_966e-11;
    const PIO2_3: f64 = 2.022_266_248_795_950_6e-21;
    let c = T::constant;
    let n = (angle * c(std::f64::consts::FRAC_2_PI)).round();
    let r = ((angle - n * c(PIO2_1)) - n * c(PIO2_2)) - n * c(PIO2_3);
    let z = r * r;
    let s = c(-2.505_076_025_340_686_3e-8) + z * c(1.589_690_995_211_55e-10);
    let s = c(8.333_333_333_322_489e-3)
        + z * (c(-1.984_126_982_985_795e-4) + z * (c(2.755_731_370_707_006_8e-6) + z * s));
    let sin = r + r * z * (c(-1.666_666_666_666_663_2e-1) + z * s);
    let k = c(2.087_572_321_298_175e-9) + z * c(-1.135_964_755_778_819_5e-11);
    let k = c(-1.388_888_888_887_411e-3)
        + z * (c(2.480_158_728_947_673e-5) + z * (c(-2.755_731_435_139_066_3e-7) + z * k));
    let half = c(0.5) * z;
    let cos = c(1.0) - (half - z * z * (c(4.166_666_666_666_66e-2) + z * k));
    // The quadrant as numbers 0 or +-1, without branches: (cos, sin) of n * 90 degrees.
    let q = n - c(4.0) * (n * c(0.25)).round(); // -2, -1, 0, 1, 2
    let odd = q * q * (c(4.0) - q * q) * c(1.0 / 3.0); // 1 where |q| = 1, else 0
    let odd = odd.round();
    let quarter_sin = q * odd; // +-1 where |q| = 1
    let quarter_cos = c(1.0) - odd - c(2.0) * (q * q * (q * q - c(1.0)) * c(1.0 / 12.0)).round();
    (sin * quarter_cos + cos * quarter_sin, cos * quarter_cos - sin * quarter_sin)
}

/// Largest angle, rad, for which [`Real::sin_cos`] is accurate to the last place.
pub(super) const LARGEST_ANGLE: f64 = 1e5 * std::f64::consts::TAU;

impl Real for f64 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn decisive(self) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sign_or(self, next: Self) -> Self {
        match self.partial_cmp(&0.0) {
            Some(Ordering::Greater) => 1.0,
            Some(Ordering::Less) => -1.0,
            _ => next,
        }
    }
    #[inline(always)]
    fn exceeds(self, o: Self) -> bool {
        self > o
    }
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        if o <= self || self.is_nan() { self } else { o }
    }
    #[inline(always)]
    fn select(self, other: Self, first: bool) -> Self {
        if first { self } else { other }
    }
    #[inline(always)]
    fn map(self, function: Function) -> Self {
        function.of(self)
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }
    #[inline(always)]
    fn sin_cos_of_any(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if self.abs() <= LARGEST_ANGLE { sin_cos_within(self) } else { f64::sin_cos(self) }
    }
    #[inline(always)]
    fn round(self) -> Self {
        // Adding and subtracting 1.5 * 2^52 rounds to the nearest integer without the library call that
        // `round_ties_even` is on a baseline CPU; exact for |x| < 2^51.
        const SHIFT: f64 = 6_755_399_441_055_744.0;
        (self + SHIFT) - SHIFT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_the_library_over_many_turns() {
        for k in -40_000..40_000 {
            let x = f64::from(k) * 0.007_853;
            let (s, c) = Real::sin_cos(x);
            assert!((s - x.sin()).abs() < 4e-16 && (c - x.cos()).abs() < 4e-16, "at {x}: {s} {c}");
        }
        for k in -8..=8 {
            let x = f64::from(k) * std::f64::consts::FRAC_PI_2;
            let (s, c) = Real::sin_cos(x);
            assert!((s - x.sin()).abs() < 4e-16 && (c - x.cos()).abs() < 4e-16, "at {k} quarters");
        }
        // Beyond the range of the polynomials, also of orientations that a file states
        for x in [1e6, 1e12, -1e16, 1e19, 1e200] {
            assert_eq!(Real::sin_cos(x), (x.sin(), x.cos()));
            assert!(crate::space::Mat3::about(crate::space::Vec3::AXES[2], x).cols[0].norm() < 1.0 + 4e-16);
        }
        assert!(Real::sin_cos(f64::INFINITY).0.is_nan());
    }
}
