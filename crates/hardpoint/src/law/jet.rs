//! Truncated Taylor arithmetic in the time, to third order.

use std::cmp::Ordering;
use std::f64::consts::LN_10;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::{Arithmetic, Scalar};

/// A quantity's value and its first three time derivatives at one instant.
///
/// In the quantity's own unit per s⁰, s, s², s³. Every operation is exact up to rounding: products follow Leibniz'
/// rule and functions of one argument that of Faà di Bruno, no differences are taken.
///
/// ```
/// use hardpoint::law::TimeJet;
///
/// let t = TimeJet::time(3.0);
/// assert_eq!((t * t).derivatives(), [9.0, 6.0, 2.0, 0.0]);
/// ```
///
/// `TimeJet` is short for `TimeJet<f64>`; the derivatives of a law by its parameters are taken by the same arithmetic in
/// numbers that carry one derivative more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeJet<S = f64> {
    derivatives: [S; 4],
}

impl<S: Arithmetic> TimeJet<S> {
    /// The quantity that is `value` at all times.
    #[inline(always)]
    pub fn constant(value: S) -> Self {
        let zero = value.like(0.0);
        Self::from_derivatives([value, zero, zero, zero])
    }

    /// The time itself, at time `t` in seconds.
    #[inline(always)]
    pub fn time(t: S) -> Self {
        Self::from_derivatives([t, t.like(1.0), t.like(0.0), t.like(0.0)])
    }

    /// The quantity with the given value, first, second and third derivative.
    #[inline(always)]
    pub const fn from_derivatives(derivatives: [S; 4]) -> Self {
        Self { derivatives }
    }

    /// The value and the first, second and third derivative.
    #[inline(always)]
    pub const fn derivatives(self) -> [S; 4] {
        self.derivatives
    }

    /// The value f.
    #[inline(always)]
    pub const fn value(self) -> S {
        self.derivatives[0]
    }

    /// The first time derivative df/dt.
    #[inline(always)]
    pub const fn d(self) -> S {
        self.derivatives[1]
    }

    /// The second time derivative d²f/dt².
    #[inline(always)]
    pub const fn dd(self) -> S {
        self.derivatives[2]
    }

    /// The third time derivative d³f/dt³.
    #[inline(always)]
    pub const fn ddd(self) -> S {
        self.derivatives[3]
    }

    /// The sine of an angle in radians.
    #[inline(always)]
    pub fn sin(self) -> Self {
        let (sin, cos) = self.value().sin_cos();
        self.compose([sin, cos, -sin, -cos])
    }

    /// The cosine of an angle in radians.
    #[inline(always)]
    pub fn cos(self) -> Self {
        let (sin, cos) = self.value().sin_cos();
        self.compose([cos, -sin, -cos, sin])
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let sqrt = self.value().sqrt();
        let inverse = self.value().like(1.0) / self.value();
        let g_d = sqrt.like(0.5) / sqrt;
        self.compose([sqrt, g_d, g_d * inverse * -0.5, g_d * inverse * inverse * 0.75])
    }

    /// The power with a constant whole exponent.
    #[inline(always)]
    pub fn powi(self, exponent: i32) -> Self {
        // As in `compose_power`, a vanishing coefficient wins over an infinite power.
        let (x, p) = (self.value(), f64::from(exponent));
        let mut g = [x.powi(exponent), x.like(0.0), x.like(0.0), x.like(0.0)];
        let mut coefficient = p;
        for k in 1..4 {
            if coefficient != 0.0 {
                g[k as usize] = x.powi(exponent.saturating_sub(k)) * coefficient;
            }
            coefficient *= p - f64::from(k);
        }
        self.compose(g)
    }

    /// This quantity times one that is the same at all times.
    #[inline(always)]
    pub(super) fn times(self, factor: S) -> Self {
        let [f, d, dd, ddd] = self.derivatives;
        Self::from_derivatives([f * factor, d * factor, dd * factor, ddd * factor])
    }

    /// This quantity plus one that is the same at all times.
    #[inline(always)]
    pub(super) fn plus(mut self, offset: S) -> Self {
        self.derivatives[0] = self.derivatives[0] + offset;
        self
    }

    /// g(self), from g and its first three derivatives at the value.
    #[inline(always)]
    fn compose(self, [g, g_d, g_dd, g_ddd]: [S; 4]) -> Self {
        // (g∘u)' = g' u',  (g∘u)'' = g'' u'² + g' u'',  (g∘u)''' = g''' u'³ + 3 g'' u' u'' + g' u'''
        let [_, d, dd, ddd] = self.derivatives;
        Self::from_derivatives([
            g,
            g_d * d,
            g_dd * d * d + g_d * dd,
            g_ddd * d * d * d + g_dd * d * dd * 3.0 + g_d * ddd,
        ])
    }
}

impl<S: Scalar> TimeJet<S> {
    /// Whether the value and all three derivatives are finite.
    pub fn is_finite(self) -> bool {
        self.derivatives.iter().all(|derivative| derivative.value().is_finite())
    }

    /// The tangent of an angle in radians.
    pub fn tan(self) -> Self {
        let tan = self.value().tan();
        let g_d = tan * tan + 1.0;
        let g_dd = tan * g_d * 2.0;
        self.compose([tan, g_d, g_dd, (g_d * g_d + tan * g_dd) * 2.0])
    }

    /// The arc sine, in radians from -π/2 to π/2.
    pub fn asin(self) -> Self {
        let [g_d, g_dd, g_ddd] = asin_derivatives(self.value());
        self.compose([self.value().asin(), g_d, g_dd, g_ddd])
    }

    /// The arc cosine, in radians from 0 to π.
    pub fn acos(self) -> Self {
        let [g_d, g_dd, g_ddd] = asin_derivatives(self.value());
        self.compose([self.value().acos(), -g_d, -g_dd, -g_ddd])
    }

    /// The arc tangent, in radians from -π/2 to π/2.
    pub fn atan(self) -> Self {
        let x = self.value();
        let g_d = S::ONE / (x * x + 1.0);
        self.compose([x.atan(), g_d, x * g_d * g_d * -2.0, (x * x * 6.0 + -2.0) * g_d * g_d * g_d])
    }

    /// The angle from the x axis to the point (`x`, `self`), in radians from -π to π.
    pub fn atan2(self, x: Self) -> Self {
        // θ' = n / r² with n = x y' - y x'; lengths are scaled out first so that r² can not overflow.
        let scale = S::ONE / self.value().hypot(x.value());
        let (x_jet, y_jet) = (x.times(scale), self.times(scale));
        let (x, y) = (x_jet.derivatives, y_jet.derivatives);
        let n = x[0] * y[1] - y[0] * x[1];
        let n_d = x[0] * y[2] - y[0] * x[2];
        let n_dd = x[0] * y[3] + x[1] * y[2] - y[1] * x[2] - y[0] * x[3];
        let [r2, r2_d, r2_dd, _] = (x_jet * x_jet + y_jet * y_jet).derivatives;
        let d = n / r2;
        let dd = (n_d - d * r2_d) / r2;
        let ddd = (n_dd - dd * r2_d * 2.0 - d * r2_dd) / r2;
        Self::from_derivatives([y[0].atan2(x[0]), d, dd, ddd])
    }

    /// The hyperbolic sine.
    pub fn sinh(self) -> Self {
        let (sinh, cosh) = (self.value().sinh(), self.value().cosh());
        self.compose([sinh, cosh, sinh, cosh])
    }

    /// The hyperbolic cosine.
    pub fn cosh(self) -> Self {
        let (sinh, cosh) = (self.value().sinh(), self.value().cosh());
        self.compose([cosh, sinh, cosh, sinh])
    }

    /// The hyperbolic tangent.
    pub fn tanh(self) -> Self {
        let (tanh, cosh) = (self.value().tanh(), self.value().cosh());
        // Not 1 - tanh², which loses all digits where tanh is close to 1.
        let g_d = S::ONE / (cosh * cosh);
        let g_dd = tanh * g_d * -2.0;
        self.compose([tanh, g_d, g_dd, (g_d * g_d + tanh * g_dd) * -2.0])
    }

    /// The exponential function.
    pub fn exp(self) -> Self {
        self.compose([self.value().exp(); 4])
    }

    /// The natural logarithm.
    pub fn ln(self) -> Self {
        let inverse = S::ONE / self.value();
        self.compose([self.value().ln(), inverse, -inverse * inverse, inverse * inverse * inverse * 2.0])
    }

    /// The logarithm to base 10.
    pub fn log10(self) -> Self {
        let mut log10 = self.ln() * (1.0 / LN_10);
        log10.derivatives[0] = self.value().log10();
        log10
    }

    /// The power with a constant exponent.
    pub fn powf(self, exponent: S) -> Self {
        let x = self.value();
        self.compose_power(exponent, |lowered_by| x.powf(exponent + -f64::from(lowered_by)))
    }

    /// The power with an exponent that may vary in time; the base is then to be positive.
    pub fn pow(self, exponent: Self) -> Self {
        if exponent.derivatives[1..] == [S::ZERO; 3] {
            return self.powf(exponent.value());
        }
        // xᵖ = exp(p ln x), with the value taken from the more accurate `powf`.
        let power = self.value().powf(exponent.value());
        (exponent * self.ln()).compose([power; 4])
    }

    /// The length of the vector (`self`, `other`).
    pub fn hypot(self, other: Self) -> Self {
        let length = self.value().hypot(other.value());
        let (x, y) = (self.times(S::ONE / length), other.times(S::ONE / length));
        let mut hypot = (x * x + y * y).sqrt().times(length);
        hypot.derivatives[0] = length;
        hypot
    }

    /// The absolute value, differentiated on the side that is active just after this instant.
    pub fn abs(self) -> Self {
        if self.cmp_just_after(Self::constant(S::ZERO)) == Some(Ordering::Less) { -self } else { self }
    }

    /// The smaller of the two just after this instant; not a number if either is.
    pub fn min(self, other: Self) -> Self {
        match self.cmp_just_after(other) {
            Some(Ordering::Greater) => other,
            Some(_) => self,
            None => self.undecided(other),
        }
    }

    /// The larger of the two just after this instant; not a number if either is.
    pub fn max(self, other: Self) -> Self {
        match self.cmp_just_after(other) {
            Some(Ordering::Less) => other,
            Some(_) => self,
            None => self.undecided(other),
        }
    }

    /// The cubic step in `self` from `h0`, up to `x0`, to `h1`, from `x1` on; `x0 < x1`, else not a number.
    ///
    /// Its first derivative is continuous, the second jumps at `x0` and `x1`, where it is that just after this
    /// instant.
    pub fn step(self, x0: Self, h0: Self, x1: Self, h1: Self) -> Self {
        if !(x0.value().value() < x1.value().value()) {
            return Self::undefined();
        }
        match (self.cmp_just_after(x0), self.cmp_just_after(x1)) {
            (Some(Ordering::Less), _) => h0,
            (_, Some(Ordering::Greater | Ordering::Equal)) => h1,
            _ => {
                // h0 + (h1 - h0) (3 u² - 2 u³)
                let u = (self - x0) / (x1 - x0);
                h0 + (h1 - h0) * (u * u * (Self::constant(S::fixed(3.0)) - u * 2.0))
            }
        }
    }

    /// What has no value.
    pub(super) fn undefined() -> Self {
        Self::from_derivatives([S::fixed(f64::NAN); 4])
    }

    /// The power with `exponent`, from the function that gives x^(exponent - k).
    fn compose_power(self, exponent: S, lowered: impl Fn(i32) -> S) -> Self {
        // g⁽ᵏ⁾ = p (p - 1) ... (p - k + 1) x^(p - k). A vanishing coefficient wins over an infinite power: the
        // third derivative of x² is zero at x = 0 also.
        let term = |coefficient: S, k| {
            if coefficient == S::ZERO { S::ZERO } else { coefficient * lowered(k) }
        };
        let p = exponent;
        self.compose([lowered(0), term(p, 1), term(p * (p + -1.0), 2), term(p * (p + -1.0) * (p + -2.0), 3)])
    }

    /// How the two quantities compare at the next instant: ties are decided by the first derivative that differs.
    pub(super) fn cmp_just_after(self, other: Self) -> Option<Ordering> {
        self.derivatives.map(S::value).partial_cmp(&other.derivatives.map(S::value))
    }

    /// The one of two incomparable jets that holds the NaN, so that it is not lost.
    fn undecided(self, other: Self) -> Self {
        if self.derivatives.iter().any(|derivative| derivative.value().is_nan()) { self } else { other }
    }
}

/// The first three derivatives of the arc sine: s, x s³, (1 + 2 x²) s⁵ with s = 1/√(1 - x²).
fn asin_derivatives<S: Scalar>(x: S) -> [S; 3] {
    // Factored, because 1 - x² loses digits where |x| is close to 1.
    let s2 = S::ONE / ((-x + 1.0) * (x + 1.0));
    let s = s2.sqrt();
    [s, x * s * s2, (x * x * 2.0 + 1.0) * s * s2 * s2]
}

impl<S: Arithmetic> Add for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.derivatives, other.derivatives);
        Self::from_derivatives([a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]])
    }
}

impl<S: Arithmetic> Sub for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (a, b) = (self.derivatives, other.derivatives);
        Self::from_derivatives([a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]])
    }
}

impl<S: Arithmetic> Mul for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // (a b)⁽ⁿ⁾ = Σ C(n, k) a⁽ⁿ⁻ᵏ⁾ b⁽ᵏ⁾
        let (a, b) = (self.derivatives, other.derivatives);
        Self::from_derivatives([
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            a[2] * b[0] + a[1] * b[1] * 2.0 + a[0] * b[2],
            a[3] * b[0] + (a[2] * b[1] + a[1] * b[2]) * 3.0 + a[0] * b[3],
        ])
    }
}

impl<S: Arithmetic> Div for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // From a = q b, differentiated: q⁽ⁿ⁾ b = a⁽ⁿ⁾ - Σ_{k≥1} C(n, k) q⁽ⁿ⁻ᵏ⁾ b⁽ᵏ⁾
        let (a, b) = (self.derivatives, other.derivatives);
        let q = a[0] / b[0];
        let q_d = (a[1] - q * b[1]) / b[0];
        let q_dd = (a[2] - q_d * b[1] * 2.0 - q * b[2]) / b[0];
        let q_ddd = (a[3] - (q_dd * b[1] + q_d * b[2]) * 3.0 - q * b[3]) / b[0];
        Self::from_derivatives([q, q_d, q_dd, q_ddd])
    }
}

impl<S: Arithmetic> Mul<f64> for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        let [f, d, dd, ddd] = self.derivatives;
        Self::from_derivatives([f * factor, d * factor, dd * factor, ddd * factor])
    }
}

impl<S: Arithmetic> Neg for TimeJet<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [f, d, dd, ddd] = self.derivatives;
        Self::from_derivatives([-f, -d, -dd, -ddd])
    }
}

#[cfg(test)]
mod tests {
    use num_dual::{Dual3, Dual3_64, DualNum};

    use super::*;

    /// A few roundings on each side; the largest condition number among the points below is about 100.
    const TOLERANCE: f64 = 1e3 * f64::EPSILON;

    /// An argument's own derivatives: all different from zero, so that no term of the chain rule drops out.
    const SLOPES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.7, -0.4, 1.3], [-1.9, 2.3, -0.6]];

    fn dual(jet: TimeJet) -> Dual3_64 {
        let [value, d, dd, ddd] = jet.derivatives();
        Dual3::new(value, d, dd, ddd)
    }

    fn assert_agrees(name: &str, ours: TimeJet, oracle: Dual3_64) {
        let oracle = [oracle.re, oracle.v1, oracle.v2, oracle.v3];
        let size = oracle.iter().fold(1.0, |size: f64, derivative| size.max(derivative.abs()));
        for order in 0..4 {
            let error = (ours.derivatives()[order] - oracle[order]).abs();
            assert!(error <= TOLERANCE * size, "{name}, order {order}: {ours:?} is not {oracle:?}");
        }
    }

    fn arguments(points: &[f64]) -> Vec<TimeJet> {
        let jet = |x: f64| SLOPES.map(|[d, dd, ddd]| TimeJet::from_derivatives([x, d, dd, ddd]));
        points.iter().flat_map(|&x| jet(x)).collect()
    }

    #[test]
    fn functions_of_one_argument_agree_with_num_dual_to_third_order() {
        type Case = (&'static str, fn(TimeJet) -> TimeJet, fn(Dual3_64) -> Dual3_64, &'static [f64]);
        let cases: [Case; 19] = [
            ("neg", |x| -x, |x| -x, &[-1.2, 0.0, 0.4]),
            ("times a number", |x| x * 2.5, |x| x * 2.5, &[-1.2, 0.0, 0.4]),
            ("sin", TimeJet::sin, |x| x.sin(), &[-1.2, 0.0, 0.4, 7.0]),
            ("cos", TimeJet::cos, |x| x.cos(), &[-1.2, 0.0, 0.4, 7.0]),
            ("tan", TimeJet::tan, |x| x.tan(), &[-1.2, 0.0, 0.4, 7.0]),
            ("asin", TimeJet::asin, |x| x.asin(), &[-0.9, 0.0, 0.4]),
            ("acos", TimeJet::acos, |x| x.acos(), &[-0.9, 0.0, 0.4]),
            ("atan", TimeJet::atan, |x| x.atan(), &[-3.0, 0.0, 0.4]),
            ("sinh", TimeJet::sinh, |x| x.sinh(), &[-3.0, 0.0, 0.4]),
            ("cosh", TimeJet::cosh, |x| x.cosh(), &[-3.0, 0.0, 0.4]),
            ("tanh", TimeJet::tanh, |x| x.tanh(), &[-3.0, 0.0, 0.4]),
            ("exp", TimeJet::exp, |x| x.exp(), &[-3.0, 0.0, 0.4]),
            ("ln", TimeJet::ln, |x| x.ln(), &[0.3, 1.0, 9.0]),
            ("log10", TimeJet::log10, |x| x.log10(), &[0.3, 1.0, 9.0]),
            ("sqrt", TimeJet::sqrt, |x| x.sqrt(), &[0.3, 1.0, 9.0]),
            ("powi(5)", |x| x.powi(5), |x| x.powi(5), &[-1.3, 0.6, 2.0]),
            ("powi(-2)", |x| x.powi(-2), |x| x.powi(-2), &[-1.3, 0.6, 2.0]),
            ("powf(2.4)", |x| x.powf(2.4), |x| x.powf(2.4), &[0.3, 1.0, 2.0]),
            ("powf(-0.5)", |x| x.powf(-0.5), |x| x.powf(-0.5), &[0.3, 1.0, 2.0]),
        ];
        for (name, ours, oracle, points) in cases {
            for x in arguments(points) {
                assert_agrees(name, ours(x), oracle(dual(x)));
            }
        }
    }

    #[test]
    fn functions_of_two_arguments_agree_with_num_dual_to_third_order() {
        type Case = (
            &'static str,
            fn(TimeJet, TimeJet) -> TimeJet,
            fn(Dual3_64, Dual3_64) -> Dual3_64,
            &'static [f64],
        );
        let cases: [Case; 7] = [
            ("add", |x, y| x + y, |x, y| x + y, &[-1.2, 0.4, 3.0]),
            ("sub", |x, y| x - y, |x, y| x - y, &[-1.2, 0.4, 3.0]),
            ("mul", |x, y| x * y, |x, y| x * y, &[-1.2, 0.4, 3.0]),
            ("div", |x, y| x / y, |x, y| x / y, &[-1.2, 0.6, 3.0]),
            ("atan2", TimeJet::atan2, |y, x| y.atan2(x), &[-1.2, 0.6, 3.0]),
            ("hypot", TimeJet::hypot, |x, y| (x * x + y * y).sqrt(), &[-1.2, 0.6, 3.0]),
            ("pow", TimeJet::pow, |x, p| (p * x.ln()).exp(), &[0.5, 1.0, 2.0]),
        ];
        for (name, ours, oracle, points) in cases {
            for x in arguments(points) {
                for y in arguments(points) {
                    assert_agrees(name, ours(x, y), oracle(dual(x), dual(y)));
                }
            }
        }
    }

    #[test]
    fn step_between_its_ends_agrees_with_num_dual_to_third_order() {
        let jet = |x, [d, dd, ddd]: [f64; 3]| TimeJet::from_derivatives([x, d, dd, ddd]);
        for x in arguments(&[0.2, 0.5, 0.9]) {
            let (x0, h0) = (jet(0.1, SLOPES[1]), jet(-3.0, SLOPES[2]));
            let (x1, h1) = (jet(1.3, SLOPES[2]), jet(2.0, SLOPES[1]));
            let u = (dual(x) - dual(x0)) / (dual(x1) - dual(x0));
            let oracle = dual(h0) + (dual(h1) - dual(h0)) * (u * u * 3.0 - u * u * u * 2.0);
            assert_agrees("step", x.step(x0, h0, x1, h1), oracle);
        }
    }

    #[test]
    fn ties_are_decided_just_after_the_instant() {
        let (zero, rising) = (TimeJet::constant(0.0), TimeJet::time(0.0));
        let falling = -rising;
        assert_eq!(falling.abs().d(), 1.0);
        assert_eq!(rising.abs().d(), 1.0);
        assert_eq!(rising.min(zero), zero);
        assert_eq!(zero.max(rising), rising);
        assert_eq!(zero.min(falling), falling);

        let step = |t: f64| {
            let [x0, h0, x1, h1] = [0.0, 5.0, 1.0, 6.0].map(TimeJet::constant);
            TimeJet::time(t).step(x0, h0, x1, h1).derivatives()
        };
        assert_eq!(step(-1e-9), [5.0, 0.0, 0.0, 0.0]);
        assert_eq!(step(0.0), [5.0, 0.0, 6.0, -12.0]);
        assert_eq!(step(1.0), [6.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_value_that_is_not_a_number_is_never_hidden() {
        let (nan, one) = (TimeJet::constant(f64::NAN), TimeJet::constant(1.0));
        for hidden in [nan.min(one), one.min(nan), nan.max(one), one.max(nan), nan.abs()] {
            assert!(hidden.value().is_nan());
        }
        assert!(nan.step(one, one, one * 2.0, one).value().is_nan());
        assert!(one.step(one, one, one, one).value().is_nan(), "x0 = x1");
    }

    #[test]
    fn whole_powers_of_zero_have_finite_derivatives() {
        assert_eq!(TimeJet::time(0.0).powi(2).derivatives(), [0.0, 0.0, 2.0, 0.0]);
        assert_eq!(TimeJet::time(0.0).powf(3.0).derivatives(), [0.0, 0.0, 0.0, 6.0]);
        assert_eq!(TimeJet::time(0.0).pow(TimeJet::constant(1.0)).derivatives(), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(TimeJet::time(0.0).powi(0).derivatives(), [1.0, 0.0, 0.0, 0.0]);
        assert!(!TimeJet::time(0.0).sqrt().is_finite());
    }

    #[test]
    fn huge_lengths_overflow_neither_angle_nor_length() {
        let (x, y) = (TimeJet::from_derivatives([3e200, 3.0, 0.0, 0.0]), TimeJet::constant(4e200));
        assert!((x.hypot(y).d() - 1.8).abs() <= TOLERANCE);
        assert!((y.atan2(x).d() * 1e200 + 0.48).abs() <= TOLERANCE);
    }
}
