//! Interval arithmetic with outward rounding: bounds that are proofs.

use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::{Function, Jet, Real};

/// All numbers from `low` to `high`.
///
/// The result of an operation contains the exact result for all numbers of its operands. Where that is not defined for
/// all of them (a division by an interval with zero, the root of an interval with negative numbers), the result is the
/// [entire line](Self::ENTIRE), which also represents NaN, and which every further operation keeps.
///
/// Code over [`Real`] that branches on a value proves nothing for the other branch. Where a comparison is not the same
/// for all numbers, [`value`](Real::value) is NaN, [`order`](Real::order) is `None`, [`exceeds`](Real::exceeds) is
/// false, and [`select`](Real::select) is the entire line: formulas that turn these into NaN are safe, and others must
/// not run on intervals.
///
/// ```
/// use hardpoint::number::{Interval, Real};
///
/// let x = Interval::between(1.0, 2.0);
/// let y = x * x - x; // the interval is larger than the range of x² - x, [0, 2]
/// assert!(y.contains(0.0) && y.contains(2.0) && y.width() < 4.0 + 1e-12);
/// assert_eq!(x / (x + -1.5), Interval::ENTIRE);
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// Relative error of a function of the standard library that is certainly not exceeded: those in use are accurate to
/// one or two units in the last place, `2.2e-16` each at most.
const LIBRARY: f64 = 4.0 * f64::EPSILON;
/// Angles beyond this, rad, are too inaccurate to decide in which quarter of a turn they are.
const FARTHEST: f64 = 1e9;

impl std::fmt::Debug for Interval {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "[{:?}, {:?}]", self.low, self.high)
    }
}

/// Lower bound of a sum: the next lower number, unless the sum is exact.
#[inline(always)]
fn sum_down(a: f64, b: f64) -> f64 {
    let s = a + b;
    // Knuth's exact error of a sum; NaN after an overflow.
    let part = s - a;
    let error = (a - (s - part)) + (b - part);
    if error >= 0.0 { s } else { infinite_down(s) }
}

/// The next lower number; minus infinity for NaN, and the largest number for an overflow.
#[inline(always)]
fn infinite_down(x: f64) -> f64 {
    if x.is_nan() { f64::NEG_INFINITY } else { x.next_down() }
}

/// Upper bound of a sum.
#[inline(always)]
fn sum_up(a: f64, b: f64) -> f64 {
    -sum_down(-a, -b)
}

/// Least and greatest of four products or quotients, rounded outwards.
#[inline(always)]
fn hull([a, b, c, d]: [f64; 4]) -> Interval {
    if (a + b + c + d).is_nan() {
        // Infinity times zero, or infinities of both signs.
        return Interval::ENTIRE;
    }
    Interval { low: a.min(b).min(c.min(d)).next_down(), high: a.max(b).max(c.max(d)).next_up() }
}

impl Interval {
    /// All numbers, or an undefined number.
    pub const ENTIRE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Smallest interval with both numbers; the entire line if either is NaN.
    #[inline(always)]
    pub fn between(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() { Self::ENTIRE } else { Self { low: a.min(b), high: a.max(b) } }
    }

    /// The interval from `-radius` to `radius`.
    #[inline(always)]
    pub fn symmetric(radius: f64) -> Self {
        Self::between(-radius, radius)
    }

    /// True if both bounds are finite.
    #[inline(always)]
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// True if the interval has a single number.
    #[inline(always)]
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// Distance between the bounds, rounded up.
    #[inline(always)]
    pub fn width(self) -> f64 {
        sum_up(self.high, -self.low)
    }

    /// A number near the middle, within the interval; NaN if it is unbounded.
    #[inline(always)]
    pub fn middle(self) -> f64 {
        if !self.is_bounded() {
            return f64::NAN;
        }
        (0.5 * self.low + 0.5 * self.high).clamp(self.low, self.high)
    }

    /// Largest magnitude.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// True if `x` is in the interval.
    #[inline(always)]
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// True if all numbers of the other interval are in this one.
    #[inline(always)]
    pub fn encloses(self, o: Self) -> bool {
        self.low <= o.low && o.high <= self.high
    }

    /// True if all numbers of the other interval are inside of this one, none at its bounds.
    #[inline(always)]
    pub fn strictly_encloses(self, o: Self) -> bool {
        self.low < o.low && o.high < self.high
    }

    /// Smallest interval with both.
    #[inline(always)]
    #[must_use]
    pub fn or(self, o: Self) -> Self {
        Self { low: self.low.min(o.low), high: self.high.max(o.high) }
    }

    /// Numbers that are in both of two intervals for the same quantity, which therefore have some in common.
    #[inline(always)]
    #[must_use]
    pub fn and(self, o: Self) -> Self {
        let (low, high) = (self.low.max(o.low), self.high.min(o.high));
        // Disjoint intervals do not enclose the same quantity: nothing is known of it.
        if low <= high { Self { low, high } } else { Self::ENTIRE }
    }

    /// Square.
    #[inline(always)]
    #[must_use]
    pub fn square(self) -> Self {
        self.even(|x| x * x)
    }

    /// Range of a function that is even, and rises with the magnitude, of relative error `f64::EPSILON`.
    #[inline(always)]
    fn even(self, f: impl Fn(f64) -> f64) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let low = if self.contains(0.0) { 0.0 } else { f(a.min(b)).next_down().max(0.0) };
        Self { low, high: f(a.max(b)).next_up() }
    }

    /// Range of a function of the library that rises.
    #[inline(always)]
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        let (low, high) = (f(self.low), f(self.high));
        if low.is_nan() || high.is_nan() {
            return Self::ENTIRE;
        }
        Self { low: below(low), high: above(high) }
    }

    /// Range of a function of the library that rises and is defined on `domain` only.
    fn rising_on(self, domain: [f64; 2], f: impl Fn(f64) -> f64) -> Self {
        if domain[0] <= self.low && self.high <= domain[1] { self.rising(f) } else { Self::ENTIRE }
    }

    /// Range of a power of a positive number, from those of its ends.
    fn positive_power(self, exponent: Self) -> Self {
        // x^p is monotone in x and in p: its extrema over a box are at corners.
        if !(self.low > 0.0 && self.is_bounded() && exponent.is_bounded()) {
            return Self::ENTIRE;
        }
        let corners = [
            self.low.powf(exponent.low),
            self.low.powf(exponent.high),
            self.high.powf(exponent.low),
            self.high.powf(exponent.high),
        ];
        let Self { low, high } = hull(corners);
        Self { low: below(low).max(0.0), high: above(high) }
    }

    /// Integer power, of a positive exponent.
    fn whole_power(self, exponent: u32) -> Self {
        // Products of n factors have a relative error of n units in the last place.
        let power = |x: f64| (0..exponent).fold(1.0, |power, _| power * x);
        let error = f64::from(exponent) * f64::EPSILON;
        let (a, b) = (power(self.low), power(self.high));
        if a.is_nan() || b.is_nan() {
            return Self::ENTIRE;
        }
        let [down, up] =
            [|x: f64, e: f64| (x - x.abs() * e).next_down(), |x: f64, e: f64| (x + x.abs() * e).next_up()];
        if exponent % 2 == 1 {
            return Self { low: down(a, error), high: up(b, error) };
        }
        let low = if self.contains(0.0) { 0.0 } else { down(a.min(b), error).max(0.0) };
        Self { low, high: up(a.max(b), error) }
    }

    /// Sine and cosine.
    fn turned(self) -> (Self, Self) {
        let all = Self { low: -1.0, high: 1.0 };
        if !(self.magnitude() <= FARTHEST && self.width() < TAU) {
            return if self.is_bounded() { (all, all) } else { (Self::ENTIRE, Self::ENTIRE) };
        }
        let ((s0, c0), (s1, c1)) = (self.low.sin_cos(), self.high.sin_cos());
        let mut ends = [Self::between(s0, s1), Self::between(c0, c1)];
        for range in &mut ends {
            *range = Self { low: below(range.low).max(-1.0), high: above(range.high).min(1.0) };
        }
        let [mut sin, mut cos] = ends;
        // Extrema at multiples of a quarter turn, which the bounds may miss by their rounding.
        let hair = LIBRARY * (1.0 + self.magnitude());
        let first = ((self.low - hair) / FRAC_PI_2).ceil();
        let last = ((self.high + hair) / FRAC_PI_2).floor();
        let mut quarter = first;
        while quarter <= last {
            match (quarter as i64).rem_euclid(4) {
                0 => cos.high = 1.0,
                1 => sin.high = 1.0,
                2 => cos.low = -1.0,
                _ => sin.low = -1.0,
            }
            quarter += 1.0;
        }
        (sin, cos)
    }

    fn tan(self) -> Self {
        let hair = LIBRARY * (1.0 + self.magnitude());
        let branch = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        let same = self.magnitude() <= FARTHEST && branch(self.low - hair) == branch(self.high + hair);
        if same { self.rising(f64::tan) } else { Self::ENTIRE }
    }

    fn atan2_of(self, x: Self) -> Self {
        let y = self;
        if !(y.is_bounded() && x.is_bounded()) {
            return Self::ENTIRE;
        }
        // The angle jumps on the negative x axis and is undefined at the origin; elsewhere, its extrema over a box are
        // at corners.
        if x.low <= 0.0 && y.contains(0.0) {
            return Self::ENTIRE;
        }
        let corners = [y.low.atan2(x.low), y.low.atan2(x.high), y.high.atan2(x.low), y.high.atan2(x.high)];
        let Self { low, high } = hull(corners);
        Self { low: below(low), high: above(high) }
    }
}

impl Jet<Interval, 4> {
    /// These bounds of a quantity and its rates over an interval of time, with those that follow from narrow ones at a
    /// time within it, since when the time is `since`: by Taylor's theorem
    ///
    /// `f in f_0 + f._0 s + f.. s^2 / 2`, `f. in f._0 + f.._0 s + f... s^2 / 2`, `f.. in f.._0 + f... s`.
    #[must_use]
    pub fn narrowed(self, narrow: Self, since: Interval) -> Self {
        let (Jet([mut f, mut d, mut dd, ddd]), Jet([f0, d0, dd0, _])) = (self, narrow);
        let half_square = since.square() * 0.5;
        // Where a rate is not known, nothing follows from it.
        let and = |x: Interval, y: Interval| if y.is_bounded() { x.and(y) } else { x };
        dd = and(dd, dd0 + ddd * since);
        d = and(and(d, d0 + dd0 * since + ddd * half_square), d0 + dd * since);
        f = and(and(f, f0 + d0 * since + dd * half_square), f0 + d * since);
        Jet([f, d, dd, ddd])
    }
}

/// A number certainly below the exact value that the library rounded to `x`.
#[inline(always)]
fn below(x: f64) -> f64 {
    (x - x.abs() * LIBRARY).next_down()
}

/// A number certainly above the exact value that the library rounded to `x`.
#[inline(always)]
fn above(x: f64) -> f64 {
    (x + x.abs() * LIBRARY).next_up()
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { low: sum_down(self.low, o.low), high: sum_up(self.high, o.high) }
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let zero = |x: Self| x.low == 0.0 && x.high == 0.0;
        // Exact, so that planar mechanisms stay in their plane; an undefined number times zero remains undefined.
        if (zero(self) || zero(o)) && self.is_bounded() && o.is_bounded() {
            return Self { low: 0.0, high: 0.0 };
        }
        hull([self.low * o.low, self.low * o.high, self.high * o.low, self.high * o.high])
    }
}

impl Div for Interval {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        if o.contains(0.0) || !o.is_bounded() {
            return Self::ENTIRE;
        }
        if self.low == 0.0 && self.high == 0.0 {
            return self;
        }
        hull([self.low / o.low, self.low / o.high, self.high / o.low, self.high / o.high])
    }
}

impl Add<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        self + Self::constant(o)
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
}

impl AddAssign for Interval {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl SubAssign for Interval {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl Real for Interval {
    /// The single number `x`; the entire line for NaN.
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::between(x, x)
    }
    /// The single number; NaN if there are more.
    #[inline(always)]
    fn value(self) -> f64 {
        if self.is_point() { self.low } else { f64::NAN }
    }
    #[inline(always)]
    fn decisive(self) -> f64 {
        self.value()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        if !(self.low >= 0.0) {
            return Self::ENTIRE;
        }
        // Correctly rounded by every processor.
        Self { low: self.low.sqrt().next_down().max(0.0), high: self.high.sqrt().next_up() }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        if self == Self::ENTIRE {
            return self;
        }
        let (a, b) = (self.low.abs(), self.high.abs());
        Self { low: if self.contains(0.0) { 0.0 } else { a.min(b) }, high: a.max(b) }
    }
    /// Rounding is monotone.
    #[inline(always)]
    fn round(self) -> Self {
        Self { low: self.low.round_ties_even(), high: self.high.round_ties_even() }
    }
    /// 1 if no number is negative, -1 if none is positive: then `abs` is the number times the sign everywhere. If there
    /// are both, the entire line.
    #[inline(always)]
    fn sign_or(self, next: Self) -> Self {
        if self.low == 0.0 && self.high == 0.0 {
            next
        } else if self.low >= 0.0 {
            Self::constant(1.0)
        } else if self.high <= 0.0 {
            Self::constant(-1.0)
        } else {
            Self::ENTIRE
        }
    }
    /// True if every number of this interval is larger than every number of the other.
    #[inline(always)]
    fn exceeds(self, o: Self) -> bool {
        self.low > o.high
    }
    /// The larger of two numbers; NaN, that is the entire line, if either is.
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        if self == Self::ENTIRE || o == Self::ENTIRE {
            return Self::ENTIRE;
        }
        Self { low: self.low.max(o.low), high: self.high.max(o.high) }
    }
    /// The entire line: it is not known whether the condition holds for all numbers, and where it changes, derivatives
    /// jump even if they are the same on both sides.
    #[inline(always)]
    fn select(self, _other: Self, _first: bool) -> Self {
        Self::ENTIRE
    }
    fn map(self, function: Function) -> Self {
        if !self.is_bounded() {
            return Self::ENTIRE;
        }
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        match function {
            Function::Sin => self.turned().0,
            Function::Cos => self.turned().1,
            Function::Tan => self.tan(),
            Function::Asin => self.rising_on([-1.0, 1.0], f64::asin),
            Function::Acos => (-self).rising_on([-1.0, 1.0], |x| (-x).acos()),
            Function::Atan => self.rising_on(all, f64::atan),
            Function::Sinh => self.rising_on(all, f64::sinh),
            Function::Cosh => {
                let size = self.abs().rising_on(all, f64::cosh);
                Self { low: size.low.max(1.0), ..size }
            }
            Function::Tanh => self.rising_on(all, f64::tanh),
            Function::Exp => {
                let power = self.rising_on(all, f64::exp);
                Self { low: power.low.max(0.0), ..power }
            }
            Function::Ln if self.low > 0.0 => self.rising_on(all, f64::ln),
            Function::Log10 if self.low > 0.0 => self.rising_on(all, f64::log10),
            Function::Ln | Function::Log10 => Self::ENTIRE,
            Function::Sqrt => self.sqrt(),
            Function::Abs => self.abs(),
        }
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }
    /// `None` unless the order is the same for all numbers.
    #[inline(always)]
    fn order(self, o: Self) -> Option<Ordering> {
        if self.high < o.low {
            Some(Ordering::Less)
        } else if self.low > o.high {
            Some(Ordering::Greater)
        } else if self.is_point() && self == o {
            Some(Ordering::Equal)
        } else {
            None
        }
    }
    fn pow(self, exponent: Self) -> Self {
        match exponent.value() {
            p if p.fract() == 0.0 && p.abs() <= f64::from(i32::MAX) => self.powi(p as i32),
            _ => self.positive_power(exponent),
        }
    }
    fn powi(self, exponent: i32) -> Self {
        if !self.is_bounded() {
            return Self::ENTIRE;
        }
        // Long products are slow and inaccurate.
        const LONGEST: u32 = 64;
        let n = exponent.unsigned_abs();
        let power = match n {
            0 => Self::constant(1.0),
            1 => self,
            n if n <= LONGEST => self.whole_power(n),
            _ if self.low > 0.0 => self.positive_power(Self::constant(f64::from(exponent.saturating_abs()))),
            _ => Self::ENTIRE,
        };
        if exponent < 0 { Self::constant(1.0) / power } else { power }
    }
    fn hypot(self, o: Self) -> Self {
        // It rises with both magnitudes.
        let (x, y) = (self.abs(), o.abs());
        if !(x.is_bounded() && y.is_bounded()) {
            return Self::ENTIRE;
        }
        Self { low: below(x.low.hypot(y.low)).max(0.0), high: above(x.high.hypot(y.high)) }
    }
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.is_zero()
    }
    fn atan2(self, x: Self) -> Self {
        self.atan2_of(x)
    }
    /// The angle is counted from `near`, in a frame that is turned to it, so that it does not jump.
    fn angle_near(self, cos: Self, near: Self) -> Self {
        let Self { low: at, .. } = Self::constant(near.middle());
        let (s, c) = Self::constant(at).turned();
        // sin(angle - near), cos(angle - near)
        (self * c - cos * s).atan2_of(cos * c + self * s) + at
    }
    fn sin_cos_of_any(self) -> (Self, Self) {
        self.turned()
    }
    fn sin_cos(self) -> (Self, Self) {
        self.turned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;

    /// Deterministic generator of numbers in (-1, 1).
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// An interval about a number, of a width between 1e-18 and 10 times its size, or a point.
    fn random(next: &mut impl FnMut() -> f64, size: f64) -> Interval {
        let (middle, decade) = (size * next(), 9.5 * (next() - 0.9));
        let width = if next() > 0.8 { 0.0 } else { size * next().abs() * 10f64.powf(decade) };
        Interval::between(middle, middle + width)
    }

    fn sample(x: Interval, next: &mut impl FnMut() -> f64) -> f64 {
        let s = 0.5 * (next() + 1.0);
        (x.low + s * (x.high - x.low)).clamp(x.low, x.high)
    }

    type Of<T> = fn(T, T) -> T;

    /// Every operation and function, by name: over intervals, over numbers, and over jets of intervals and of numbers.
    macro_rules! operations {
        ($($name:literal: |$x:ident, $y:ident| $of:expr;)*) => {
            vec![$((
                $name,
                (|$x, $y| $of) as Of<Interval>,
                (|$x, $y| $of) as Of<f64>,
                (|$x, $y| $of) as Of<Jet<Interval, 4>>,
                (|$x, $y| $of) as Of<Jet<f64, 4>>,
                (|$x, $y| $of) as Of<Dual<Interval>>,
                (|$x, $y| $of) as Of<Dual<f64>>,
            )),*]
        };
    }

    type Row = (
        &'static str,
        Of<Interval>,
        Of<f64>,
        Of<Jet<Interval, 4>>,
        Of<Jet<f64, 4>>,
        Of<Dual<Interval>>,
        Of<Dual<f64>>,
    );

    fn every_operation() -> Vec<Row> {
        operations! {
            "add": |x, y| x + y;
            "sub": |x, y| x - y;
            "mul": |x, y| x * y;
            "div": |x, y| x / y;
            "neg": |x, _y| -x;
            "add a number": |x, _y| x + 0.3;
            "times a number": |x, _y| x * -1.7;
            "times_plus": |x, y| x.times_plus(y, x);
            "sqrt": |x, _y| Real::sqrt(x);
            "abs": |x, _y| Real::abs(x);
            "larger": |x, y| x.larger(y);
            "hypot": |x, y| Real::hypot(x, y);
            "atan2": |x, y| Real::atan2(x, y);
            "angle_near": |x, y| x.angle_near(y, Real::constant(13.0));
            "pow": |x, y| Real::pow(x, y);
            "powf(2.6)": |x, _y| Real::powf(x, 2.6);
            "powi 2": |x, _y| Real::powi(x, 2);
            "powi 3": |x, _y| Real::powi(x, 3);
            "powi 9": |x, _y| Real::powi(x, 9);
            "powi -4": |x, _y| Real::powi(x, -4);
            "powi 80": |x, _y| Real::powi(x, 80);
            "sin": |x, _y| Real::sin_cos(x).0;
            "cos": |x, _y| Real::sin_cos(x).1;
            "sin of any": |x, _y| x.sin_cos_of_any().0;
            "cos of any": |x, _y| x.sin_cos_of_any().1;
            "Sin": |x, _y| x.map(Function::Sin);
            "Cos": |x, _y| x.map(Function::Cos);
            "Tan": |x, _y| x.map(Function::Tan);
            "Asin": |x, _y| x.map(Function::Asin);
            "Acos": |x, _y| x.map(Function::Acos);
            "Atan": |x, _y| x.map(Function::Atan);
            "Sinh": |x, _y| x.map(Function::Sinh);
            "Cosh": |x, _y| x.map(Function::Cosh);
            "Tanh": |x, _y| x.map(Function::Tanh);
            "Exp": |x, _y| x.map(Function::Exp);
            "Ln": |x, _y| x.map(Function::Ln);
            "Log10": |x, _y| x.map(Function::Log10);
            "Sqrt": |x, _y| x.map(Function::Sqrt);
            "Abs": |x, _y| x.map(Function::Abs);
        }
    }

    #[test]
    fn every_operation_encloses_its_values_over_all_numbers() {
        let mut next = numbers(7);
        for (name, over, at, ..) in every_operation() {
            let mut bounded = 0;
            for k in 0..4000 {
                let size = [1.0, 0.01, 20.0][k % 3];
                let (x, y) = (random(&mut next, size), random(&mut next, size));
                let bounds = over(x, y);
                bounded += usize::from(bounds != Interval::ENTIRE);
                for j in 0..12 {
                    // The ends, then between them.
                    let (a, b) = match j {
                        0 => (x.low, y.low),
                        1 => (x.high, y.low),
                        2 => (x.low, y.high),
                        3 => (x.high, y.high),
                        _ => (sample(x, &mut next), sample(y, &mut next)),
                    };
                    let value = at(a, b);
                    let inside = bounds.contains(value) || value.is_nan() && bounds == Interval::ENTIRE;
                    // The kernel's polynomials are accurate to one unit in the last place of 1; long products are
                    // rounded in every factor.
                    let hair = match name {
                        "sin" | "cos" => 4e-16,
                        "powi 80" => 80.0 * f64::EPSILON * value.abs(),
                        _ => 0.0,
                    };
                    let near = bounds.low - hair <= value && value <= bounds.high + hair;
                    assert!(
                        inside || near,
                        "{name} of {x:?} and {y:?}: {value} at {a}, {b} is not in {bounds:?}"
                    );
                }
            }
            assert!(bounded > 700, "{name} is bounded for {bounded} of 4000");
        }
    }

    #[test]
    fn wider_operands_have_wider_results() {
        let mut next = numbers(11);
        for (name, over, ..) in every_operation() {
            for _ in 0..2000 {
                let (x, y) = (random(&mut next, 2.0), random(&mut next, 2.0));
                let part = |x: Interval, next: &mut _| Interval::between(sample(x, next), sample(x, next));
                let (all, inner) = (over(x, y), over(part(x, &mut next), part(y, &mut next)));
                // But for the rounding of the library at another place.
                let hair = 4.0 * LIBRARY * (1.0 + if all.is_bounded() { all.magnitude() } else { 0.0 });
                let wider = Interval { low: all.low - hair, high: all.high + hair };
                assert!(wider.encloses(inner), "{name} of {x:?} and {y:?}: {inner:?} is not in {all:?}");
            }
        }
    }

    #[test]
    fn derivatives_over_intervals_enclose_those_of_all_numbers() {
        let mut next = numbers(13);
        for (name, _, _, over, at, of_dual, dual_at) in every_operation() {
            let mut bounded = 0;
            for _ in 0..1500 {
                let mut jet = || Jet([0; 4].map(|_| random(&mut next, 1.5)));
                let (x, y) = (jet(), jet());
                let bounds = over(x, y);
                let of = |x: Jet<Interval, 4>| Dual { v: x.0[0], d: x.0[1] };
                let slope = of_dual(of(x), of(y));
                bounded += usize::from(bounds.0[3].is_bounded());
                for _ in 0..6 {
                    let (a, b) =
                        (Jet(x.0.map(|x| sample(x, &mut next))), Jet(y.0.map(|y| sample(y, &mut next))));
                    let value = at(a, b);
                    for n in 0..4 {
                        let (bounds, value) = (bounds.0[n], value.0[n]);
                        // The value is rounded in several operations.
                        let size =
                            1.0 + value.abs() + if bounds.is_bounded() { bounds.magnitude() } else { 0.0 };
                        let hair = 1e-11 * size;
                        let inside = bounds.low - hair <= value && value <= bounds.high + hair;
                        assert!(
                            inside || !value.is_finite(),
                            "{name}, order {n}, of {x:?} and {y:?}: {value} is not in {bounds:?}"
                        );
                        assert!(
                            value.is_finite() || bounds == Interval::ENTIRE || n > 0 || value.abs() > 1e300
                        );
                    }
                    let at = |x: Jet<f64, 4>| Dual { v: x.0[0], d: x.0[1] };
                    let (d, bounds) = (dual_at(at(a), at(b)).d, slope.d);
                    let hair = 1e-11 * (1.0 + d.abs());
                    assert!(!d.is_finite() || bounds.low - hair <= d && d <= bounds.high + hair, "{name}");
                }
            }
            // Branches of jets are not the same for all numbers.
            let branches = ["larger", "powf(2.6)"].contains(&name);
            assert!(
                if branches { bounded == 0 } else { bounded > 60 },
                "{name} is bounded for {bounded} of 1500"
            );
        }
    }

    #[test]
    fn sums_and_products_are_rounded_outwards_and_no_farther_than_a_unit() {
        let mut next = numbers(17);
        for _ in 0..20_000 {
            let (a, b) = (next() * 1e3, next());
            let (x, y) = (Interval::constant(a), Interval::constant(b));
            let product = x * y;
            // The exact error of a product.
            let error = a.mul_add(b, -(a * b));
            assert!(product.low <= a * b + error.min(0.0) && a * b + error.max(0.0) <= product.high);
            assert!(product.width() <= 4.0 * f64::EPSILON * (a * b).abs());
            let (sum, s) = (x + y, a + b);
            let part = s - a;
            let error = (a - (s - part)) + (b - part);
            assert!(if error < 0.0 { sum.low < s && sum.high == s } else { sum.low == s });
            assert!(if error > 0.0 { sum.high > s } else { sum.high == s });
            let root = Interval::constant(a.abs()).sqrt();
            assert!(
                root.low.mul_add(root.low, -a.abs()) <= 0.0 && root.high.mul_add(root.high, -a.abs()) >= 0.0
            );
        }
        let half = Interval::constant(0.5);
        assert_eq!(half + half, Interval::constant(1.0), "an exact sum");
        assert_eq!(half * Interval::constant(0.0), Interval::constant(0.0), "planar mechanisms stay planar");
    }

    #[test]
    fn what_is_not_known_is_the_entire_line() {
        let (all, x, zero) = (Interval::ENTIRE, Interval::between(-1.0, 2.0), Interval::constant(0.0));
        assert_eq!(Interval::constant(f64::NAN), all);
        for unknown in [
            all + x,
            x - all,
            all * zero,
            zero * all,
            x / x,
            Real::sqrt(x),
            x.map(Function::Ln),
            x.map(Function::Asin),
            x.sign(),
            Real::atan2(zero, x),
            x.larger(all),
            x.select(zero, true),
            x.select(zero, false),
            Real::abs(all),
            Interval::constant(1e308) * Interval::constant(10.0) * zero,
            Interval::constant(1.0).and(Interval::constant(2.0)),
        ] {
            assert_eq!(unknown, all);
        }
        assert!(x.value().is_nan() && !x.exceeds(zero) && !zero.exceeds(x) && x.order(zero).is_none());
        assert!(
            Interval::between(0.1, 2.0).exceeds(zero)
                && Interval::between(0.0, 2.0).sign() == Interval::constant(1.0)
        );
        // A kink inside: the rates are not known.
        let jet = Jet::<Interval, 3>([x, Interval::constant(1.0), zero]);
        let [_, rate, second] = Real::abs(jet).0;
        assert!(!rate.is_bounded() && second == all, "{rate:?} {second:?}");
        let [.., second] = jet.larger(Jet::constant(zero)).0;
        assert_eq!(second, all);
    }

    #[test]
    fn an_angle_that_is_counted_does_not_jump_where_the_principal_angle_does() {
        // About pi, and about 7 pi.
        let (s, c) = (Interval::between(-0.1, 0.1), Interval::between(-1.0, -0.9));
        assert_eq!(s.atan2_of(c), Interval::ENTIRE);
        for turns in [0.0, 3.0] {
            let near = PI * (1.0 + 2.0 * turns) + 0.3;
            let angle = s.angle_near(c, Interval::constant(near));
            assert!(angle.contains(PI * (1.0 + 2.0 * turns)) && angle.width() < 0.3, "{angle:?}");
        }
    }
}
