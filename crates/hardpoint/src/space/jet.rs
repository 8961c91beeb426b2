//! A quantity with its time derivatives and their design derivatives.

use super::Vec3;
use std::ops::{Add, Mul, Neg, Sub};

/// A number that knows its first two time derivatives and, for one design variable b, the design
/// derivative of all three.
///
/// `c[i][j]` is the derivative taken i times in b (0, 1) and j times in t (0, 1, 2). Measures are
/// written once as functions of jets; rates and sensitivities follow by the product and chain rules.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Jet {
    /// `[[f, f_t, f_tt], [f_b, f_bt, f_btt]]`.
    pub c: [[f64; 3]; 2],
}

impl Jet {
    /// A number that depends on neither t nor b.
    pub const fn constant(x: f64) -> Self {
        Self { c: [[x, 0.0, 0.0], [0.0; 3]] }
    }

    /// The value.
    pub fn value(self) -> f64 {
        self.c[0][0]
    }

    /// `g(self)`, from g and its first three derivatives at the value.
    #[inline]
    fn chain(self, g: [f64; 4]) -> Self {
        let [[_, t, tt], [b, bt, btt]] = self.c;
        Self {
            c: [
                [g[0], g[1] * t, g[2] * t * t + g[1] * tt],
                [
                    g[1] * b,
                    g[2] * b * t + g[1] * bt,
                    g[3] * b * t * t + g[2] * (2.0 * bt * t + b * tt) + g[1] * btt,
                ],
            ],
        }
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        let x = self.value();
        let r = x.sqrt();
        self.chain([r, 0.5 / r, -0.25 / (r * x), 0.375 / (r * x * x)])
    }

    /// Reciprocal.
    pub fn recip(self) -> Self {
        let r = 1.0 / self.value();
        self.chain([r, -r * r, 2.0 * r * r * r, -6.0 * r * r * r * r])
    }

    /// Inverse sine, rad.
    pub fn asin(self) -> Self {
        let x = self.value();
        let k = 1.0 / (1.0 - x * x);
        let r = k.sqrt();
        self.chain([x.asin(), r, x * k * r, (1.0 + 2.0 * x * x) * k * k * r])
    }

    /// Angle of the point (x, self) from the x axis, rad in (-pi, pi].
    pub fn atan2(self, x: Self) -> Self {
        // Turned so that the point lies on the axis, where atan has derivatives 1, 0, -2.
        let angle = self.value().atan2(x.value());
        let (s, c) = angle.sin_cos();
        let (s, c) = (Self::constant(s), Self::constant(c));
        let u = (self * c - x * s) * (x * c + self * s).recip();
        let mut turned = u.chain([0.0, 1.0, 0.0, -2.0]);
        turned.c[0][0] = angle;
        turned
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self { c: std::array::from_fn(|i| std::array::from_fn(|j| self.c[i][j] + o.c[i][j])) }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self { c: self.c.map(|r| r.map(|x| -x)) }
    }
}

impl Mul for Jet {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let time = |f: [f64; 3], g: [f64; 3]| {
            [f[0] * g[0], f[1] * g[0] + f[0] * g[1], f[2] * g[0] + 2.0 * f[1] * g[1] + f[0] * g[2]]
        };
        let (fb, gb) = (time(self.c[1], o.c[0]), time(self.c[0], o.c[1]));
        Self { c: [time(self.c[0], o.c[0]), std::array::from_fn(|j| fb[j] + gb[j])] }
    }
}

impl Vec3<Jet> {
    /// Scalar product of jets.
    #[inline]
    pub fn dot_jet(self, o: Self) -> Jet {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Length, as a jet.
    pub fn norm_jet(self) -> Jet {
        self.dot_jet(self).sqrt()
    }

    /// A vector of jets from its derivatives: `c[i][j]` as in [`Jet`].
    #[inline]
    pub fn from_derivatives(c: [[Vec3; 3]; 2]) -> Self {
        let component = |k: usize| Jet { c: c.map(|row| row.map(|v| v[k])) };
        Self::new(component(0), component(1), component(2))
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
        Jet { c: [[v, t, tt], [b, tb, ttb]] }
    }

    fn ours(f: impl Fn(Jet, Jet) -> Jet) -> Jet {
        let t = Jet { c: [[0.3, 1.0, 0.0], [0.0; 3]] };
        let b = Jet { c: [[0.7, 0.0, 0.0], [1.0, 0.0, 0.0]] };
        f(t, b)
    }

    fn assert_same(a: Jet, b: Jet) {
        for i in 0..2 {
            for j in 0..3 {
                assert!((a.c[i][j] - b.c[i][j]).abs() < 1e-11 * (1.0 + b.c[i][j].abs()), "{a:?}\n{b:?}");
            }
        }
    }

    #[test]
    fn jets_agree_with_hyper_duals() {
        let k = Jet::constant;
        assert_same(
            ours(|t, b| (t * t * b + k(2.0) * b).sqrt()),
            partials(|t, b| (t * t * b + b * 2.0).sqrt()),
        );
        assert_same(ours(|t, b| (t * b * b + t).recip()), partials(|t, b| (t * b * b + t).recip()));
        assert_same(ours(|t, b| (t * t * b + t).asin()), partials(|t, b| (t * t * b + t).asin()));
        assert_same(
            ours(|t, b| (t * t - b).atan2(b * t - k(1.0))),
            partials(|t, b| (t * t - b).atan2(b * t - 1.0)),
        );
    }
}
