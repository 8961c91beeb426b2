//! Bounds of an expression over an interval of time.
//!
//! Expressions are evaluated in intervals that carry an interval for their rate. The range `f([a, b])` is bounded by
//! the interval result of the operations, and by `f(m) + f'([a, b]) [-h/2, h/2]` about the midpoint m (mean value form,
//! whose excess falls with h^2), which is tighter for short intervals. Polynomials and splines are bounded by their
//! Bernstein coefficients. All bounds are exact except for rounding.

use std::f64::consts::{FRAC_PI_2, LN_10, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::number::Function;

use super::term::{ExpressionValue, Relation};

/// All numbers from `low` to `high`. A quantity that is undefined anywhere in the interval is unbounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// Maximum degree of polynomials that are bounded, without allocation; others are unbounded.
const HIGHEST_DEGREE: usize = 24;

impl Range {
    pub(crate) const UNBOUNDED: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Range between two numbers in either order; unbounded if either is NaN.
    pub(crate) fn between(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() { Self::UNBOUNDED } else { Self { low: a.min(b), high: a.max(b) } }
    }

    pub(crate) fn exactly(x: f64) -> Self {
        Self::between(x, x)
    }

    /// Smallest range that contains both.
    pub(crate) fn or(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Intersection of two ranges, which may be disjoint by a rounding error.
    fn and(self, other: Self) -> Self {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        Self { low: low.min(high), high: high.max(low) }
    }

    /// True if both ends are finite.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    fn has(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Maximum distance of the range from `x`.
    pub fn reach_from(self, x: f64) -> f64 {
        let reach = f64::max(self.high - x, x - self.low);
        if reach.is_nan() { f64::INFINITY } else { reach.max(0.0) }
    }

    /// Image under a monotone g.
    fn monotone(self, g: impl Fn(f64) -> f64) -> Self {
        Self::between(g(self.low), g(self.high))
    }

    /// Image under a monotone g that is defined on `domain` only.
    fn monotone_on(self, domain: Self, g: impl Fn(f64) -> f64) -> Self {
        if self.low >= domain.low && self.high <= domain.high { self.monotone(g) } else { Self::UNBOUNDED }
    }

    fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let least = if self.has(0.0) { 0.0 } else { a.min(b) };
        Self::between(least, a.max(b))
    }

    fn powi(self, exponent: i32) -> Self {
        match exponent {
            0 => Self::exactly(1.0),
            n if n < 0 => Self::exactly(1.0) / self.powi(n.saturating_neg()),
            n if n % 2 == 0 => {
                let least = if self.has(0.0) { 0.0 } else { self.low.abs().min(self.high.abs()) };
                let most = self.low.abs().max(self.high.abs());
                Self::between(least.powi(n), most.powi(n))
            }
            n => self.monotone(|x| x.powi(n)),
        }
    }

    fn abs(self) -> Self {
        let most = self.low.abs().max(self.high.abs());
        Self::between(if self.has(0.0) { 0.0 } else { self.low.abs().min(self.high.abs()) }, most)
    }

    fn sqrt(self) -> Self {
        self.monotone_on(Self { low: 0.0, high: f64::INFINITY }, f64::sqrt)
    }

    pub(crate) fn sin(self) -> Self {
        // Beyond this, the angle has no accurate digit left.
        const FARTHEST: f64 = 1e15;
        let width = self.high - self.low;
        if !(width < TAU && self.low.abs() < FARTHEST) {
            return Self { low: -1.0, high: 1.0 };
        }
        // True if some angle at + 2 pi k is in the range, within round-off.
        let reaches = |at: f64| {
            let hair = 4.0 * f64::EPSILON * (1.0 + self.low.abs());
            // Smallest at + 2 pi k that is not below the range
            let next = at + TAU * ((self.low - hair - at) / TAU).ceil();
            next <= self.high + hair
        };
        let Self { low, high } = Self::between(self.low.sin(), self.high.sin());
        let low = if reaches(-FRAC_PI_2) { -1.0 } else { low };
        let high = if reaches(FRAC_PI_2) { 1.0 } else { high };
        Self { low, high }
    }

    fn cos(self) -> Self {
        (self + Self::exactly(FRAC_PI_2)).sin()
    }

    fn tan(self) -> Self {
        let branch = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        let same = self.is_bounded() && branch(self.low) == branch(self.high);
        if same { self.monotone(f64::tan) } else { Self::UNBOUNDED }
    }
}

impl Relation {
    /// True if the comparison holds for all numbers of two ranges, false if it holds for none; `None` otherwise.
    pub(crate) fn holds_between(self, a: Range, b: Range) -> Option<bool> {
        let corners = [(a.low, b.low), (a.low, b.high), (a.high, b.low), (a.high, b.high)];
        let first = self.holds(a.low, b.high)?;
        corners.iter().all(|&(a, b)| self.holds(a, b) == Some(first)).then_some(first)
    }
}

impl Add for Range {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self::between(self.low + o.low, self.high + o.high)
    }
}

impl Sub for Range {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Range {
    type Output = Self;

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Range {
    type Output = Self;

    fn mul(self, o: Self) -> Self {
        // Zero times an unbounded number is zero: the bound only means that the number is unknown.
        let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
        let [a, b] = [product(self.low, o.low), product(self.low, o.high)];
        let [c, d] = [product(self.high, o.low), product(self.high, o.high)];
        Self::between(a.min(b), a.max(b)).or(Self::between(c.min(d), c.max(d)))
    }
}

impl Div for Range {
    type Output = Self;

    fn div(self, o: Self) -> Self {
        if o.has(0.0) { Self::UNBOUNDED } else { self * Self::between(1.0 / o.low, 1.0 / o.high) }
    }
}

/// Range of a quantity over an interval of time, and range of its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Range of the quantity.
    pub value: Range,
    /// Range of the rate, per s.
    pub rate: Range,
}

impl Stretch {
    pub(crate) const UNBOUNDED: Self = Self { value: Range::UNBOUNDED, rate: Range::UNBOUNDED };

    /// The time itself.
    pub(crate) fn time(from: f64, to: f64) -> Self {
        Self { value: Range::between(from, to), rate: Range::exactly(1.0) }
    }

    pub(crate) fn constant(x: f64) -> Self {
        Self { value: Range::exactly(x), rate: Range::exactly(0.0) }
    }

    /// Intersection with the mean value form, for a quantity with the value `middle` at the middle of an interval of
    /// this length.
    pub(crate) fn settled(self, middle: f64, length: f64) -> Self {
        let half = 0.5 * length;
        // If the quantity is not defined over the whole interval, its value in the middle proves nothing.
        let known = self.value.is_bounded();
        // f(m) + f'([a, b]) [-h/2, h/2], by the mean value theorem
        let mean = Range::exactly(middle) + self.rate * Range::between(-half, half);
        Self { value: if known && mean.is_bounded() { self.value.and(mean) } else { self.value }, ..self }
    }

    /// Range of c0 + c1 x + c2 x^2 + ... for x between `from` and `to`.
    pub(crate) fn of_polynomial(coefficients: &[f64], from: f64, to: f64) -> Self {
        let n = coefficients.len();
        if n > HIGHEST_DEGREE + 1 {
            return Self::UNBOUNDED;
        }
        let mut slopes = [0.0; HIGHEST_DEGREE + 1];
        for (k, slope) in slopes[..n.saturating_sub(1)].iter_mut().enumerate() {
            // p' = sum (k + 1) c_k+1 x^k
            *slope = (k + 1) as f64 * coefficients[k + 1];
        }
        let rate = of_polynomial(&slopes[..n.saturating_sub(1).max(1)], from, to);
        Self { value: of_polynomial(coefficients, from, to), rate }
    }

    /// Maximum magnitude of the rate, per s.
    pub(crate) fn fastest(self) -> f64 {
        self.rate.reach_from(0.0)
    }

    /// Composition with g, given the ranges of g and of its derivative.
    fn chain(self, g: Range, slope: Range) -> Self {
        // (g(x)). = g'(x) x.
        Self { value: g, rate: slope * self.rate }
    }

    /// Smallest ranges that contain both.
    pub(crate) fn or(self, o: Self) -> Self {
        Self { value: self.value.or(o.value), rate: self.rate.or(o.rate) }
    }
}

impl ExpressionValue for Stretch {
    fn number(x: f64) -> Self {
        Self::constant(x)
    }

    fn function(self, function: Function) -> Self {
        let (x, one) = (self.value, Range::exactly(1.0));
        let unit = Range { low: -1.0, high: 1.0 };
        let positive = Range { low: 0.0, high: f64::INFINITY };
        match function {
            Function::Sin => self.chain(x.sin(), x.cos()),
            Function::Cos => self.chain(x.cos(), -x.sin()),
            Function::Tan => self.chain(x.tan(), one + x.tan().square()),
            Function::Asin => self.chain(x.monotone_on(unit, f64::asin), asin_slope(x)),
            Function::Acos => self.chain(x.monotone_on(unit, f64::acos), -asin_slope(x)),
            Function::Atan => self.chain(x.monotone(f64::atan), one / (one + x.square())),
            Function::Sinh => self.chain(x.monotone(f64::sinh), x.abs().monotone(f64::cosh)),
            Function::Cosh => self.chain(x.abs().monotone(f64::cosh), x.monotone(f64::sinh)),
            Function::Tanh => self.chain(x.monotone(f64::tanh), one / x.abs().monotone(f64::cosh).square()),
            Function::Exp => self.chain(x.monotone(f64::exp), x.monotone(f64::exp)),
            Function::Ln => self.chain(x.monotone_on(positive, f64::ln), one / x),
            Function::Log10 => {
                let Self { value, rate } = self.function(Function::Ln);
                let per = Range::exactly(1.0 / LN_10);
                Self { value: value * per, rate: rate * per }
            }
            Function::Sqrt => self.chain(x.sqrt(), Range::exactly(0.5) / x.sqrt()),
            Function::Abs if x.low >= 0.0 => self,
            Function::Abs if x.high <= 0.0 => -self,
            Function::Abs => Self { value: x.abs(), rate: self.rate.or(-self.rate) },
        }
    }

    fn to_whole(self, exponent: i32) -> Self {
        let slope = match exponent {
            0 => Range::exactly(0.0),
            n => Range::exactly(f64::from(n)) * self.value.powi(n.saturating_sub(1)),
        };
        self.chain(self.value.powi(exponent), slope)
    }

    fn to_constant(self, exponent: f64) -> Self {
        if exponent.fract() == 0.0 && exponent.abs() < f64::from(i32::MAX) {
            return self.to_whole(exponent as i32);
        }
        let domain = Range { low: 0.0, high: f64::INFINITY };
        let power = |p: f64| self.value.monotone_on(domain, |x| x.powf(p));
        self.chain(power(exponent), Range::exactly(exponent) * power(exponent - 1.0))
    }

    /// Power with a positive base. With other bases it is undefined for all but integer exponents, which are constant.
    fn to(self, exponent: Self) -> Self {
        (exponent * self.function(Function::Ln)).function(Function::Exp)
    }

    fn angle(self, x: Self) -> Self {
        let y = self;
        let (across, along) = (y.value, x.value);
        // atan2(y, x). = (x y. - y x.) / (x^2 + y^2)
        let rate = (along * y.rate - across * x.rate) / (along.square() + across.square());
        // The angle jumps on the negative x axis.
        let value = if along.low <= 0.0 && across.has(0.0) {
            Range { low: -PI, high: PI }
        } else {
            let corner = |y: f64, x: f64| Range::exactly(y.atan2(x));
            let [low, high] =
                [across.low, across.high].map(|y| corner(y, along.low).or(corner(y, along.high)));
            low.or(high)
        };
        Self { value, rate }
    }

    fn length(self, o: Self) -> Self {
        // r = sqrt(x^2 + y^2),    r. = (x x. + y y.) / r,    abs(r.) <= abs(x.) + abs(y.)
        let length = (self.value.square() + o.value.square()).sqrt();
        let rate = (self.value * self.rate + o.value * o.rate) / length;
        // In any direction, a length changes no faster than the sum of its components.
        let fastest = self.rate.abs() + o.rate.abs();
        Self { value: length, rate: rate.and(fastest.or(-fastest)) }
    }

    fn smaller(self, o: Self) -> Self {
        if self.value.high < o.value.low {
            self
        } else if o.value.high < self.value.low {
            o
        } else {
            let value =
                Range { low: self.value.low.min(o.value.low), high: self.value.high.min(o.value.high) };
            Self { value, rate: self.rate.or(o.rate) }
        }
    }

    fn greater(self, o: Self) -> Self {
        -(-self).smaller(-o)
    }

    fn step(self, x0: Self, h0: Self, x1: Self, h1: Self) -> Self {
        let u = (self - x0) / (x1 - x0);
        if !(x0.value.high < x1.value.low && u.value.is_bounded()) {
            return Self::UNBOUNDED;
        }
        let within = |x: f64| x.clamp(0.0, 1.0);
        let inside = u.value.monotone(within);
        let mut slope = inside.monotone(|u| 6.0 * u * (1.0 - u));
        if inside.has(0.5) {
            slope.high = 1.5;
        }
        if u.value.low < 0.0 || u.value.high > 1.0 {
            slope.low = 0.0;
        }
        let s = Self { value: inside.monotone(|u| u * u * (3.0 - 2.0 * u)), rate: slope * u.rate };
        h0 + (h1 - h0) * s
    }

    /// The selected range if the comparison is decided, else both.
    fn choose(self, comparison: Relation, b: Self, x: Self, y: Self) -> Self {
        match comparison.holds_between(self.value, b.value) {
            Some(true) => x,
            Some(false) => y,
            // The value may jump, so the rate is unbounded.
            None => Self { rate: Range::UNBOUNDED, ..x.or(y) },
        }
    }

    /// Returns the value itself: subexpressions of parameters only are constant.
    fn settled(self) -> Self {
        self
    }
}

/// Range of 1 / sqrt(1 - x^2).
fn asin_slope(x: Range) -> Range {
    Range::exactly(1.0) / (Range::exactly(1.0) - x.square()).sqrt()
}

impl Add for Stretch {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, rate: self.rate + o.rate }
    }
}

impl Sub for Stretch {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, rate: self.rate - o.rate }
    }
}

impl Mul for Stretch {
    type Output = Self;

    fn mul(self, o: Self) -> Self {
        Self { value: self.value * o.value, rate: self.rate * o.value + self.value * o.rate }
    }
}

impl Div for Stretch {
    type Output = Self;

    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Self { value, rate: (self.rate - value * o.rate) / o.value }
    }
}

impl Neg for Stretch {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
}

/// Range of c0 + c1 x + c2 x^2 + ... for x between two numbers, bounded by its Bernstein coefficients there.
fn of_polynomial(coefficients: &[f64], from: f64, to: f64) -> Range {
    let n = coefficients.len().saturating_sub(1);
    let mut c = [0.0; HIGHEST_DEGREE + 1];
    c[..coefficients.len()].copy_from_slice(coefficients);
    let c = &mut c[..=n];
    // p = sum c_k u^k,  b_i = sum_{j<=i} C(i,j) / C(n,j) c_j,  min b_i <= p <= max b_i                    (theory (31))
    // In powers of x - from, by Horner's rule ...
    for k in 0..n {
        for i in (k..n).rev() {
            c[i] += from * c[i + 1];
        }
    }
    // ... and of u = (x - from) / (to - from); power k over the binomial n by k.
    let (mut power, mut binomial) = (1.0, 1.0);
    for (k, c) in c.iter_mut().enumerate() {
        *c *= power / binomial;
        power *= to - from;
        binomial *= (n - k) as f64 / (k + 1) as f64;
    }
    // Bernstein coefficient i is the sum over k up to i of binomial(i, k) c_k: Pascal's triangle, in place.
    for k in 1..=n {
        for i in (k..=n).rev() {
            c[i] += c[i - 1];
        }
    }
    c.iter().fold(Range::exactly(c[0]), |range, x| range.or(Range::exactly(*x)))
}

#[cfg(test)]
mod tests {
    use crate::law::{
        ConstantSpeed, Harmonic, Law, Piece, SmoothStep, SplineDegree, SplineEnds, Table, Trapezoid,
    };

    fn laws() -> Vec<Law> {
        let text = [
            "60*sin(2*pi*t)",
            "t^3 - 3*t^2 + 0.5",
            "1/(1 + t^2) - exp(-t)*cos(3*t)",
            "abs(sin(5*t)) + min(t, 1, 2 - t)",
            "max(t - 0.7, 0)^2",
            "step(t, 0.4, -1, 0.9, 2) + 0.1*t",
            "if(t < 0.8, t, 2*t - 3)",
            "sqrt(1 + t)*ln(2 + t) + log10(3 + t)",
            "atan2(sin(t), cos(t)) + hypot(t, 1 - t)",
            "asin(0.9*sin(t)) + acos(0.3*cos(2*t)) + atan(t)",
            "sinh(t) - cosh(t/2) + tanh(3*t) + tan(0.4*t)",
            "(1 + t)^1.5 + pow(2, t) + (2 + t)^t",
            "(t - 1)^4 - (t - 1)^-2*0 + (3 + t)^-2",
        ];
        let mut laws: Vec<Law> = text.iter().map(|text| Law::parse(text).unwrap()).collect();
        laws.push(Law::constant(3.0));
        laws.push(Law::constant_speed(ConstantSpeed { speed: -4.0, offset: 1.0 }).unwrap());
        let harmonic = Harmonic { amplitude: -2.0, frequency: 0.8, phase: 0.3, offset: 1.0 };
        laws.push(Law::harmonic(harmonic).unwrap());
        laws.push(Law::polynomial(&[1.0, -2.0, 0.5, 3.0, -1.0]).unwrap());
        let step = SmoothStep { from: 1.0, to: -2.0, start: 0.3, end: 1.1, degree: 5 };
        laws.push(Law::smooth_step(step).unwrap());
        let trapezoid = Trapezoid { from: 1.0, to: -2.0, start: 0.3, end: 1.1, ramp: 0.25 };
        laws.push(Law::trapezoid(trapezoid).unwrap());
        let (times, values) = (vec![-0.1, 0.5, 1.2, 2.5], vec![0.0, 3.0, -1.0, 0.0]);
        for (degree, ends) in [
            (SplineDegree::Cubic, SplineEnds::default()),
            (SplineDegree::Quintic, SplineEnds::default()),
            (SplineDegree::Cubic, SplineEnds::Periodic),
        ] {
            let (times, values) = (times.clone(), values.clone());
            laws.push(Law::table(&Table { times, values, degree, ends }).unwrap());
        }
        let pieces = vec![
            Piece::lasting(0.7, Law::parse("t^2").unwrap()),
            Piece::lasting(0.6, Law::parse("2*t").unwrap()).not_continued(),
            Piece::open_ended(Law::parse("-t").unwrap()),
        ];
        laws.push(Law::sequence(pieces).unwrap().scaled(-3.0));
        laws
    }

    #[test]
    fn a_law_stays_within_its_range() {
        for law in laws() {
            for (from, to) in [(0.0, 2.4), (0.1, 0.2), (0.75, 0.85), (0.5, 0.5), (1.15, 1.3)] {
                let range = law.over(from, to).value;
                assert!(range.is_bounded() || to - from > 1.0, "{law}: {range:?}");
                for k in 0..=500 {
                    let f = law.at(from + (to - from) * f64::from(k) / 500.0).value();
                    let hair = 1e-12 * (1.0 + f.abs());
                    assert!(f >= range.low - hair && f <= range.high + hair, "{law} is {f}: {range:?}");
                    let (d, rate) =
                        (law.at(from + (to - from) * f64::from(k) / 500.0).d(), law.over(from, to).rate);
                    let hair = 1e-11 * (1.0 + d.abs());
                    assert!(d >= rate.low - hair && d <= rate.high + hair, "{law} goes at {d}: {rate:?}");
                }
            }
        }
    }

    #[test]
    fn ranges_of_short_stretches_exceed_the_law_by_the_square_of_their_length() {
        for law in laws() {
            let excess = |h: f64| {
                let (from, to) = (0.61 - 0.5 * h, 0.61 + 0.5 * h);
                let range = law.over(from, to).value;
                let values = (0..=400).map(|k| law.at(from + h * f64::from(k) / 400.0).value());
                let (low, high) =
                    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                (range.high - high).max(low - range.low)
            };
            let (coarse, fine) = (excess(1e-2), excess(1e-3));
            assert!(coarse < 0.02, "{law}: {coarse}");
            assert!(fine < 0.02 * coarse + 1e-12, "{law}: {coarse} {fine}");
        }
    }

    #[test]
    fn what_is_not_defined_everywhere_is_not_bounded() {
        for text in ["sqrt(t)", "1/t", "ln(t)", "asin(2*t)", "tan(2*t)"] {
            let law = Law::parse(text).unwrap();
            assert!(!law.over(-1.0, 1.0).value.is_bounded(), "{text}");
            assert!(law.over(0.1, 0.2).value.is_bounded(), "{text}");
        }
        let table = Table {
            times: vec![0.0, 1.0],
            values: vec![0.0, 1.0],
            degree: SplineDegree::Cubic,
            ends: SplineEnds::default(),
        };
        assert!(!Law::table(&table).unwrap().over(0.5, 1.5).value.is_bounded());
    }

    #[test]
    fn a_pulse_between_rests_is_seen_however_short_it_is() {
        let law = Law::parse("step(t, 0.5, 0, 0.5001, 7) - step(t, 0.5001, 0, 0.5002, 7)").unwrap();
        assert_eq!([0.0, 1.0].map(|t| law.at(t).value()), [0.0, 0.0]);
        assert!(law.over(0.0, 1.0).value.high >= 7.0);
        assert!(law.over(0.6, 1.0).value.reach_from(0.0) == 0.0);
    }
}
