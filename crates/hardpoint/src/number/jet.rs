//! Truncated Taylor arithmetic in time.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::{Function, Real};

/// The value of a quantity and its first N - 1 time derivatives at one instant; N is at most 4.
///
/// Units are those of the quantity per s⁰, s, s², s³. Every operation is exact up to rounding: products follow Leibniz'
/// rule, and functions of one argument that of Faà di Bruno; no finite differences are used. Where a quantity is not
/// smooth, its derivatives are those of the branch that is active just after the instant.
///
/// ```
/// use hardpoint::number::Jet;
///
/// let t = Jet::<f64, 3>::time(3.0);
/// assert_eq!((t * t).derivatives(), [9.0, 6.0, 2.0]);
/// ```
///
/// Over [`Dual`](super::Dual)s, the value and all time derivatives are also differentiated with respect to a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<T = f64, const N: usize = 4>(pub [T; N]);

/// A value and its first two time derivatives.
///
/// Measures are written once over [`Real`]. Evaluated on this type they also have their rates, by the product and chain
/// rules; on [`Dual`](super::Dual)s of it, the design derivatives of all three as well.
pub type Rates<T = f64> = Jet<T, 3>;

impl<T: Real, const N: usize> Jet<T, N> {
    /// A quantity that is constant in time.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        let mut f = [T::zero(); N];
        f[0] = value;
        Self(f)
    }

    /// The time itself as a quantity, at time `t`, s.
    #[inline(always)]
    pub fn time(t: T) -> Self {
        let mut time = Self::constant(t);
        if N > 1 {
            time.0[1] = T::one();
        }
        time
    }

    /// The value and the derivatives.
    #[inline(always)]
    pub const fn derivatives(self) -> [T; N] {
        self.0
    }

    /// The value f.
    #[inline(always)]
    pub const fn value(self) -> T {
        self.0[0]
    }

    /// The first time derivative df/dt.
    #[inline(always)]
    pub const fn d(self) -> T {
        self.0[1]
    }

    /// The second time derivative d²f/dt².
    #[inline(always)]
    pub const fn dd(self) -> T {
        self.0[2]
    }

    /// The third time derivative d³f/dt³.
    #[inline(always)]
    pub const fn ddd(self) -> T {
        self.0[3]
    }

    /// True if the value and all derivatives are finite.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.value().is_finite())
    }

    /// A jet without a value: NaN.
    #[inline(always)]
    pub(crate) fn undefined() -> Self {
        Self([T::constant(f64::NAN); N])
    }

    /// This quantity times a factor that is constant in time.
    #[inline(always)]
    pub(crate) fn times(mut self, factor: T) -> Self {
        T::operation(|| {
            for n in 0..N {
                self.0[n] = self.0[n] * factor;
            }
            self
        })
    }

    /// This quantity plus an offset that is constant in time.
    #[inline(always)]
    pub(crate) fn plus(mut self, offset: T) -> Self {
        self.0[0] += offset;
        self
    }

    /// g(self), from g and its first three derivatives at this value.
    #[inline(always)]
    pub(crate) fn compose(self, [g, g_d, g_dd, g_ddd]: [T; 4]) -> Self {
        T::operation(|| {
            const { assert!(0 < N && N <= 4, "jets have up to three derivatives") }
            // (g∘u)' = g' u',  (g∘u)'' = g'' u'² + g' u'',  (g∘u)''' = g''' u'³ + 3 g'' u' u'' + g' u'''
            let (u, mut f) = (self.0, self.0);
            f[0] = g;
            if N > 1 {
                f[1] = g_d * u[1];
            }
            if N > 2 {
                f[2] = g_dd * u[1] * u[1] + g_d * u[2];
            }
            if N > 3 {
                f[3] = g_ddd * u[1] * u[1] * u[1] + g_dd * u[1] * u[2] * 3.0 + g_d * u[3];
            }
            Self(f)
        })
    }

    /// A less common function, compiled separately from the common ones.
    #[inline(never)]
    fn compose_rare(self, function: Function) -> Self {
        let x = self.0[0];
        let y = x.map(function);
        let [d, dd, ddd] = function.derivatives(x, y);
        self.compose([y, d, dd, ddd])
    }

    /// The power with an exponent that is constant in time.
    #[inline(always)]
    fn power(self, exponent: T) -> Self {
        T::operation(|| {
            // g⁽ᵏ⁾ = p (p - 1) ... (p - k + 1) x^(p - k). A zero coefficient takes precedence over an infinite power:
            // the third derivative of x² is zero at x = 0, too.
            let (x, zero) = (self.0[0], T::zero());
            let mut g = [x.pow(exponent), zero, zero, zero];
            let mut coefficient = exponent;
            for (k, g) in g.iter_mut().enumerate().take(N).skip(1) {
                let lowered = exponent + -(k as f64);
                if !coefficient.vanishes() {
                    *g = zero.select(coefficient * x.pow(lowered), coefficient.is_zero());
                }
                coefficient = coefficient * lowered;
            }
            self.compose(g)
        })
    }

    /// The square root, given the root of the value.
    #[inline(always)]
    fn root(self, root: T) -> Self {
        T::operation(|| {
            // From r r = x, differentiated: 2 r r⁽ⁿ⁾ = x⁽ⁿ⁾ - Σ_{0<k<n} C(n, k) r⁽ⁿ⁻ᵏ⁾ r⁽ᵏ⁾
            let (x, mut r) = (self.0, self.0);
            r[0] = root;
            let twice = r[0] + r[0];
            if N > 1 {
                r[1] = x[1] / twice;
            }
            if N > 2 {
                r[2] = (x[2] - r[1] * r[1] * 2.0) / twice;
            }
            if N > 3 {
                r[3] = (x[3] - r[1] * r[2] * 6.0) / twice;
            }
            Self(r)
        })
    }

    /// Sine and cosine, given those of the value.
    #[inline(always)]
    fn turned(self, (sin, cos): (T, T)) -> (Self, Self) {
        (self.compose([sin, cos, -sin, -cos]), self.compose([cos, -sin, -cos, sin]))
    }

    /// True if all time derivatives are zero.
    #[inline(always)]
    fn is_still(self) -> bool {
        self.0[1..].iter().all(|x| x.is_zero())
    }
}

impl<T: Real, const N: usize> Add for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, o: Self) -> Self {
        T::operation(|| {
            for n in 0..N {
                self.0[n] += o.0[n];
            }
            self
        })
    }
}

impl<T: Real, const N: usize> Sub for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, o: Self) -> Self {
        T::operation(|| {
            for n in 0..N {
                self.0[n] -= o.0[n];
            }
            self
        })
    }
}

impl<T: Real, const N: usize> Mul for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        T::operation(|| {
            // (a b)⁽ⁿ⁾ = Σ C(n, k) a⁽ⁿ⁻ᵏ⁾ b⁽ᵏ⁾
            let (a, b, mut f) = (self.0, o.0, self.0);
            f[0] = a[0] * b[0];
            if N > 1 {
                f[1] = a[1] * b[0] + a[0] * b[1];
            }
            if N > 2 {
                f[2] = a[2] * b[0] + a[1] * b[1] * 2.0 + a[0] * b[2];
            }
            if N > 3 {
                f[3] = a[3] * b[0] + (a[2] * b[1] + a[1] * b[2]) * 3.0 + a[0] * b[3];
            }
            Self(f)
        })
    }
}

impl<T: Real, const N: usize> Div for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        T::operation(|| {
            // From a = q b, differentiated: q⁽ⁿ⁾ b = a⁽ⁿ⁾ - Σ_{k≥1} C(n, k) q⁽ⁿ⁻ᵏ⁾ b⁽ᵏ⁾
            let (a, b, mut q) = (self.0, o.0, self.0);
            q[0] = a[0] / b[0];
            if N > 1 {
                q[1] = (a[1] - q[0] * b[1]) / b[0];
            }
            if N > 2 {
                q[2] = (a[2] - q[1] * b[1] * 2.0 - q[0] * b[2]) / b[0];
            }
            if N > 3 {
                q[3] = (a[3] - (q[2] * b[1] + q[1] * b[2]) * 3.0 - q[0] * b[3]) / b[0];
            }
            Self(q)
        })
    }
}

impl<T: Real, const N: usize> Neg for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        T::operation(|| {
            for n in 0..N {
                self.0[n] = -self.0[n];
            }
            self
        })
    }
}

impl<T: Real, const N: usize> Add<f64> for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, o: f64) -> Self {
        self.0[0] = self.0[0] + o;
        self
    }
}

impl<T: Real, const N: usize> Mul<f64> for Jet<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, factor: f64) -> Self {
        T::operation(|| {
            for n in 0..N {
                self.0[n] = self.0[n] * factor;
            }
            self
        })
    }
}

impl<T: Real, const N: usize> AddAssign for Jet<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Real, const N: usize> SubAssign for Jet<T, N> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

/// Comparisons and tests use the value only.
impl<T: Real, const N: usize> Real for Jet<T, N> {
    #[inline(always)]
    fn operation<R>(operation: impl FnOnce() -> R) -> R {
        T::operation(operation)
    }
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::constant(T::constant(x))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.0[0].value()
    }
    #[inline(always)]
    fn decisive(self) -> f64 {
        self.0[0].decisive()
    }
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.0.into_iter().all(T::vanishes)
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self.0.iter().all(|x| x.is_zero())
    }
    #[inline(always)]
    fn order(self, o: Self) -> Option<Ordering> {
        let differing = (0..N - 1).find(|&n| self.0[n].order(o.0[n]) != Some(Ordering::Equal));
        let n = differing.unwrap_or(N - 1);
        self.0[n].order(o.0[n])
    }
    #[inline(always)]
    fn held(self) -> Self {
        Self::constant(self.0[0])
    }
    #[inline(always)]
    fn without_derivatives(self) -> Self {
        let stays = self.is_still() && !self.0[0].value().is_nan();
        let mut alone = if stays { self } else { Self::undefined() };
        alone.0[0] = self.0[0].without_derivatives();
        alone
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.root(self.0[0].sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.times(self.sign().0[0])
    }
    #[inline(always)]
    fn sign_or(self, next: Self) -> Self {
        Self::constant(self.0.into_iter().rev().fold(next.0[0], |next, x| x.sign_or(next)))
    }
    #[inline(always)]
    fn exceeds(self, o: Self) -> bool {
        self.0[0].exceeds(o.0[0])
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self::constant(self.0[0].round())
    }
    #[inline(always)]
    fn select(mut self, o: Self, first: bool) -> Self {
        for n in 0..N {
            self.0[n] = self.0[n].select(o.0[n], first);
        }
        self
    }
    #[inline(always)]
    fn map(self, function: Function) -> Self {
        match function {
            Function::Sin => self.sin_cos_of_any().0,
            Function::Cos => self.sin_cos_of_any().1,
            Function::Sqrt => self.root(self.0[0].map(Function::Sqrt)),
            Function::Abs => self.abs(),
            _ => self.compose_rare(function),
        }
    }
    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        if exponent.is_still() {
            return self.power(exponent.0[0]);
        }
        // xᵖ = exp(p ln x), for a positive base; the value itself comes from `pow`, which is more accurate.
        let power = self.0[0].pow(exponent.0[0]);
        (exponent * self.map(Function::Ln)).compose([power; 4])
    }
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        // As in `power`, a zero coefficient takes precedence over an infinite power.
        let x = self.0[0];
        let mut g = [x.powi(exponent), T::zero(), T::zero(), T::zero()];
        let mut coefficient = f64::from(exponent);
        for k in 1..N as i32 {
            if coefficient != 0.0 {
                g[k as usize] = x.powi(exponent.saturating_sub(k)) * coefficient;
            }
            coefficient *= f64::from(exponent) - f64::from(k);
        }
        self.compose(g)
    }
    #[inline(always)]
    fn hypot(self, o: Self) -> Self {
        T::operation(|| {
            // Scaled to prevent squares from overflowing.
            let length = self.0[0].hypot(o.0[0]);
            let scale = T::one() / length;
            let (x, y) = (self.times(scale), o.times(scale));
            let mut hypot = (x * x + y * y).sqrt().times(length);
            hypot.0[0] = length;
            hypot
        })
    }
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        let most = self.0[0].larger(o.0[0]);
        let mut larger = self.select(o, most.value() == self.0[0].value());
        larger.0[0] = most;
        larger
    }
    #[inline(always)]
    fn angle_near(self, cos: Self, near: Self) -> Self {
        // Whole turns are constant in time.
        let mut angle = self.atan2(cos);
        angle.0[0] = self.0[0].angle_near(cos.0[0], near.0[0]);
        angle
    }
    #[inline(always)]
    fn rate(self) -> Self {
        let mut rate = Self::undefined();
        for n in 1..N {
            rate.0[n - 1] = self.0[n];
        }
        rate
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        self.turned(self.0[0].sin_cos())
    }
    #[inline(always)]
    fn sin_cos_of_any(self) -> (Self, Self) {
        self.turned(self.0[0].sin_cos_of_any())
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        T::operation(|| {
            // The angle is the imaginary part of l = log(x + i y). With w⁽ⁿ⁾ = z⁽ⁿ⁾/z and z' = l' z: l' = w', l'' = w''
            // - w'², l''' = w''' - 3 w' w'' + 2 w'³. Scaled to prevent squares from overflowing.
            let mut angle = self.0;
            angle[0] = self.0[0].atan2(x.0[0]);
            let scale = T::one() / self.0[0].hypot(x.0[0]);
            let (y, x) = (self.times(scale).0, x.times(scale).0);
            let square = x[0] * x[0] + y[0] * y[0];
            let real = |n: usize| (x[n] * x[0] + y[n] * y[0]) / square;
            let imaginary = |n: usize| (y[n] * x[0] - x[n] * y[0]) / square;
            if N > 1 {
                angle[1] = imaginary(1);
            }
            if N > 2 {
                angle[2] = imaginary(2) - real(1) * imaginary(1) * 2.0;
            }
            if N > 3 {
                let (a, b) = (real(1), imaginary(1));
                let cube = (a * a * 3.0 - b * b) * b;
                angle[3] = imaginary(3) - (a * imaginary(2) + b * real(2)) * 3.0 + cube * 2.0;
            }
            Self(angle)
        })
    }
}

#[cfg(test)]
mod tests {
    use num_dual::{Dual3, Dual3_64, DualNum, HyperHyperDual, third_partial_derivative};

    use super::*;
    use crate::number::Dual;

    /// A few roundings on each side; the largest condition number at the points below is about 100.
    const TOLERANCE: f64 = 1e3 * f64::EPSILON;

    /// Derivatives of the argument: all different from zero, so that every term of the chain rule contributes.
    const SLOPES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.7, -0.4, 1.3], [-1.9, 2.3, -0.6]];

    fn dual(jet: Jet) -> Dual3_64 {
        let [value, d, dd, ddd] = jet.derivatives();
        Dual3::new(value, d, dd, ddd)
    }

    fn assert_agrees(name: &str, ours: Jet, oracle: Dual3_64) {
        let oracle = [oracle.re, oracle.v1, oracle.v2, oracle.v3];
        let size = oracle.iter().fold(1.0, |size: f64, derivative| size.max(derivative.abs()));
        for order in 0..4 {
            let error = (ours.derivatives()[order] - oracle[order]).abs();
            assert!(error <= TOLERANCE * size, "{name}, order {order}: {ours:?} is not {oracle:?}");
        }
    }

    fn arguments(points: &[f64]) -> Vec<Jet> {
        let jet = |x: f64| SLOPES.map(|[d, dd, ddd]| Jet([x, d, dd, ddd]));
        points.iter().flat_map(|&x| jet(x)).collect()
    }

    #[test]
    fn functions_of_one_argument_agree_with_num_dual_to_third_order() {
        type Case = (&'static str, fn(Jet) -> Jet, fn(Dual3_64) -> Dual3_64, &'static [f64]);
        let cases: [Case; 19] = [
            ("neg", |x| -x, |x| -x, &[-1.2, 0.0, 0.4]),
            ("times a number", |x| x * 2.5, |x| x * 2.5, &[-1.2, 0.0, 0.4]),
            ("sin", |x| x.map(Function::Sin), |x| x.sin(), &[-1.2, 0.0, 0.4, 7.0]),
            ("cos", |x| x.map(Function::Cos), |x| x.cos(), &[-1.2, 0.0, 0.4, 7.0]),
            ("tan", |x| x.map(Function::Tan), |x| x.tan(), &[-1.2, 0.0, 0.4, 7.0]),
            ("asin", |x| x.map(Function::Asin), |x| x.asin(), &[-0.9, 0.0, 0.4]),
            ("acos", |x| x.map(Function::Acos), |x| x.acos(), &[-0.9, 0.0, 0.4]),
            ("atan", |x| x.map(Function::Atan), |x| x.atan(), &[-3.0, 0.0, 0.4]),
            ("sinh", |x| x.map(Function::Sinh), |x| x.sinh(), &[-3.0, 0.0, 0.4]),
            ("cosh", |x| x.map(Function::Cosh), |x| x.cosh(), &[-3.0, 0.0, 0.4]),
            ("tanh", |x| x.map(Function::Tanh), |x| x.tanh(), &[-3.0, 0.0, 0.4]),
            ("exp", |x| x.map(Function::Exp), |x| x.exp(), &[-3.0, 0.0, 0.4]),
            ("ln", |x| x.map(Function::Ln), |x| x.ln(), &[0.3, 1.0, 9.0]),
            ("log10", |x| x.map(Function::Log10), |x| x.log10(), &[0.3, 1.0, 9.0]),
            ("sqrt", |x| x.map(Function::Sqrt), |x| x.sqrt(), &[0.3, 1.0, 9.0]),
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
        type Case = (&'static str, fn(Jet, Jet) -> Jet, fn(Dual3_64, Dual3_64) -> Dual3_64, &'static [f64]);
        let cases: [Case; 7] = [
            ("add", |x, y| x + y, |x, y| x + y, &[-1.2, 0.4, 3.0]),
            ("sub", |x, y| x - y, |x, y| x - y, &[-1.2, 0.4, 3.0]),
            ("mul", |x, y| x * y, |x, y| x * y, &[-1.2, 0.4, 3.0]),
            ("div", |x, y| x / y, |x, y| x / y, &[-1.2, 0.6, 3.0]),
            ("atan2", Real::atan2, |y, x| y.atan2(x), &[-1.2, 0.6, 3.0]),
            ("hypot", Real::hypot, |x, y| (x * x + y * y).sqrt(), &[-1.2, 0.6, 3.0]),
            ("pow", Real::pow, |x, p| (p * x.ln()).exp(), &[0.5, 1.0, 2.0]),
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
    fn whole_powers_of_zero_have_finite_derivatives() {
        assert_eq!(Jet::time(0.0).powi(2).derivatives(), [0.0, 0.0, 2.0, 0.0]);
        assert_eq!(Jet::time(0.0).powf(3.0).derivatives(), [0.0, 0.0, 0.0, 6.0]);
        assert_eq!(Jet::time(0.0).pow(Jet::constant(1.0)).derivatives(), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(Jet::time(0.0).powi(0).derivatives(), [1.0, 0.0, 0.0, 0.0]);
        assert!(!Jet::<f64>::time(0.0).sqrt().is_finite());
    }

    #[test]
    fn huge_lengths_overflow_neither_angle_nor_length() {
        let (x, y) = (Jet([3e200, 3.0, 0.0, 0.0]), Jet::constant(4e200));
        assert!((x.hypot(y).d() - 1.8).abs() <= TOLERANCE);
        assert!((y.atan2(x).d() * 1e200 + 0.48).abs() <= TOLERANCE);
    }

    /// A measure with its rates, and the derivatives of all three with respect to one variable.
    type Varied = Dual<Rates>;

    /// f(t, b) with its derivatives from independent code: mixed partials by hyper-hyper-dual numbers.
    fn partials(f: impl Fn(HyperHyperDual<f64>, HyperHyperDual<f64>) -> HyperHyperDual<f64>) -> Varied {
        // t + t' + t'', b: eps1 and eps2 on t, eps3 on b, at t = 0.3, b = 0.7.
        let g = |[t1, t2, b]: [HyperHyperDual<f64>; 3]| f(t1 + t2, b);
        let (v, t, _, b, tt, tb, _, ttb) =
            third_partial_derivative(|(t1, t2, b)| g([t1, t2, b]), (0.1, 0.2, 0.7));
        Varied { v: Jet([v, t, tt]), d: Jet([b, tb, ttb]) }
    }

    fn ours(f: impl Fn(Varied, Varied) -> Varied) -> Varied {
        let t = Dual::constant(Jet([0.3, 1.0, 0.0]));
        let b = Dual::variable(Jet([0.7, 0.0, 0.0]));
        f(t, b)
    }

    fn assert_same(a: Varied, b: Varied) {
        for (x, y) in [(a.v, b.v), (a.d, b.d)] {
            for j in 0..3 {
                assert!((x.0[j] - y.0[j]).abs() < 1e-11 * (1.0 + y.0[j].abs()), "{a:?}\n{b:?}");
            }
        }
    }

    #[test]
    fn rates_of_duals_agree_with_hyper_duals() {
        let k = |x: f64| Dual::constant(Jet([x, 0.0, 0.0]));
        assert_same(
            ours(|t, b| (t * t * b + k(2.0) * b).sqrt()),
            partials(|t, b| (t * t * b + b * 2.0).sqrt()),
        );
        assert_same(ours(|t, b| b / (t * b * b + t)), partials(|t, b| b / (t * b * b + t)));
        assert_same(ours(|t, b| (t * t * b).sin_cos().1), partials(|t, b| (t * t * b).cos()));
        assert_same(ours(|t, b| (t * t * b + t).asin()), partials(|t, b| (t * t * b + t).asin()));
        assert_same(
            ours(|t, b| (t * t - b).atan2(b * t - k(1.0))),
            partials(|t, b| (t * t - b).atan2(b * t - 1.0)),
        );
    }
}
