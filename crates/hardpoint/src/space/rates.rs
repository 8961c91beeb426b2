//! A quantity with its time derivatives.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::{Dual, Function, Real};

/// A number and its first two time derivatives.
///
/// Measures are written once over [`Real`]; on these they get their rates by the product and chain rules, on [`Dual`]s of
/// these the design derivatives of all three as well.
#[derive(Clone, Copy, Debug)]
pub struct Rates<T = f64>(pub [T; 3]);

/// A measure: value, rate and acceleration, and their derivatives by one design variable.
pub type Jet = Dual<Rates>;

impl<T: Real> Rates<T> {
    /// `g(self)`, from g and its first two derivatives at the value.
    #[inline(always)]
    fn chain(self, g: [T; 3]) -> Self {
        let [_, t, tt] = self.0;
        Self([g[0], g[1] * t, g[2] * t * t + g[1] * tt])
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let r = self.0[0].like(1.0) / self.0[0];
        let square = r * r;
        self.chain([r, -square, (r + r) * square])
    }
}

impl<T: Real> Add for Rates<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Self([a + x, b + y, c + z])
    }
}

impl<T: Real> Sub for Rates<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Self([a - x, b - y, c - z])
    }
}

impl<T: Real> Mul for Rates<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        let twice = b * y;
        Self([a * x, b * x + a * y, c * x + (twice + twice) + a * z])
    }
}

impl<T: Real> Div for Rates<T> {
    type Output = Self;
    #[inline(always)]
    #[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
    fn div(self, o: Self) -> Self {
        self * o.recip()
    }
}

impl<T: Real> Neg for Rates<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c] = self.0;
        Self([-a, -b, -c])
    }
}

impl<T: Real> AddAssign for Rates<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Real> SubAssign for Rates<T> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

/// Lanes, and whatever else only looks at a number, see the value.
impl<T: Real> Real for Rates<T> {
    const LANES: usize = T::LANES;
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        let o = self.0[0].zero();
        Self([o.like(x), o, o])
    }
    #[inline(always)]
    fn like_lanes(self, lane: impl FnMut(usize) -> f64) -> Self {
        let o = self.0[0].zero();
        Self([o.like_lanes(lane), o, o])
    }
    #[inline(always)]
    fn lane(self, k: usize) -> f64 {
        self.0[0].lane(k)
    }
    #[inline(always)]
    fn store(self, out: &mut [f64]) {
        self.0[0].store(out);
    }
    #[inline(always)]
    fn each_lane(components: &[Self; 8], out: impl FnMut(usize, &[f64; 8])) {
        T::each_lane(&components.map(|c| c.0[0]), out);
    }
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.0.into_iter().all(T::vanishes)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let x = self.0[0];
        let r = x.sqrt();
        let first = x.like(0.5) / r;
        self.chain([r, first, -(first / (x + x))])
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let sign = self.0[0].like_lanes(|k| f64::signum(self.0[0].lane(k)));
        Self(self.0.map(|x| x * sign))
    }
    #[inline(always)]
    fn round(self) -> Self {
        let o = self.0[0].zero();
        Self([self.0[0].round(), o, o])
    }
    fn select(self, other: Self, first: impl Fn(usize) -> bool + Copy) -> Self {
        Self([0, 1, 2].map(|k| self.0[k].select(other.0[k], first)))
    }
    fn map(self, function: Function) -> Self {
        // The slope, differentiated in its turn.
        let x = Dual::variable(self.0[0]);
        let y = x.map(function);
        let slope = function.slope(x, y);
        self.chain([y.v, slope.v, slope.d])
    }
    fn powf(self, exponent: f64) -> Self {
        let power = |by: f64| self.0[0].powf(exponent - by);
        let [first, second] = [exponent, exponent * (exponent - 1.0)].map(|c| self.0[0].like(c));
        self.chain([power(0.0), power(1.0) * first, power(2.0) * second])
    }
    #[inline(always)]
    fn within<R>(self, f: impl FnOnce() -> R) -> R {
        self.0[0].within(f)
    }
    #[inline(always)]
    fn larger(self, o: Self) -> Self {
        let most = self.0[0].larger(o.0[0]);
        let [_, first, second] = self.select(o, |k| most.lane(k) == self.lane(k)).0;
        Self([most, first, second])
    }
    #[inline(always)]
    fn rate(self) -> Self {
        let [_, first, second] = self.0;
        Self([first, second, first.like(f64::NAN)])
    }
    #[inline(always)]
    fn largest(self) -> f64 {
        self.0[0].largest()
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0[0].sin_cos();
        (self.chain([s, c, -s]), self.chain([c, -s, -c]))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        // Turned so that the point lies on the axis, where atan has derivatives 1 and 0.
        let angle = self.0[0].atan2(x.0[0]);
        let (s, c) = angle.sin_cos();
        let turned = |k: usize| [self.0[k] * c - x.0[k] * s, x.0[k] * c + self.0[k] * s];
        let ([_, r], [y1, x1], [y2, _]) = (turned(0), turned(1), turned(2));
        // angle' = y'/r; angle'' = y''/r - 2 x' y' / r^2.
        let first = y1 / r;
        let twice = x1 / r * first;
        Self([angle, first, y2 / r - (twice + twice)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::{DualNum, HyperHyperDual, third_partial_derivative};

    /// f(t, b) with independent code for its derivatives: mixed partials by hyper-hyper-dual numbers.
    fn partials(f: impl Fn(HyperHyperDual<f64>, HyperHyperDual<f64>) -> HyperHyperDual<f64>) -> Jet {
        // t + t' + t'', b: eps1 and eps2 on t, eps3 on b, at t = 0.3, b = 0.7.
        let g = |[t1, t2, b]: [HyperHyperDual<f64>; 3]| f(t1 + t2, b);
        let (v, t, _, b, tt, tb, _, ttb) =
            third_partial_derivative(|(t1, t2, b)| g([t1, t2, b]), (0.1, 0.2, 0.7));
        Jet { v: Rates([v, t, tt]), d: Rates([b, tb, ttb]) }
    }

    fn ours(f: impl Fn(Jet, Jet) -> Jet) -> Jet {
        let t = Dual::constant(Rates([0.3, 1.0, 0.0]));
        let b = Dual::variable(Rates([0.7, 0.0, 0.0]));
        f(t, b)
    }

    fn assert_same(a: Jet, b: Jet) {
        for (x, y) in [(a.v, b.v), (a.d, b.d)] {
            for j in 0..3 {
                assert!((x.0[j] - y.0[j]).abs() < 1e-11 * (1.0 + y.0[j].abs()), "{a:?}\n{b:?}");
            }
        }
    }

    #[test]
    fn jets_agree_with_hyper_duals() {
        let k = |x: f64| Dual::constant(Rates([x, 0.0, 0.0]));
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
