//! Curves between solved times: polynomials with the values, rates and accelerations at both ends of each interval,
//! with their extrema, crossings of a value, and error estimates.

use crate::number::Real;

/// A curve over time: at each time the first `orders` of value, rate and acceleration.
pub(super) struct SampledCurve<'t, T> {
    pub(super) times: &'t [f64],
    pub(super) orders: usize,
    pub(super) values: Vec<[T; 3]>,
}

/// The polynomial of a curve in one interval.
pub(super) struct Polynomial<T> {
    from: f64,
    length: f64,
    /// Coefficients in the fraction of the interval.
    c: [T; 6],
}

impl<T: Real> Polynomial<T> {
    /// Value and rate at a time.
    pub(super) fn at(&self, t: T) -> [T; 2] {
        let (c, h) = (T::constant, self.length);
        let s = (t - c(self.from)) / c(h);
        let [c0, c1, c2, c3, c4, c5] = self.c;
        let value = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let slope = c1 + s * (c(2.0) * c2 + s * (c(3.0) * c3 + s * (c(4.0) * c4 + s * c(5.0) * c5)));
        [value, slope / c(h)]
    }
}

impl<T: Real> SampledCurve<'_, T> {
    /// Number of orders that are known at a time: at a kink the value alone.
    pub(super) fn known(&self, k: usize) -> usize {
        self.values[k][..self.orders].iter().take_while(|x| x.value().is_finite()).count()
    }

    /// Interval of a time.
    pub(super) fn interval(&self, t: f64) -> usize {
        let after = self.times[..self.values.len()].partition_point(|end| *end <= t);
        after.clamp(1, self.values.len() - 1) - 1
    }

    /// Polynomial of interval k with the values, rates and accelerations that are known at its ends.
    pub(super) fn polynomial(&self, k: usize) -> Polynomial<T> {
        self.polynomial_of(k, self.orders)
    }

    /// Polynomial of interval k with at most this number of orders.
    pub(super) fn polynomial_of(&self, k: usize, orders: usize) -> Polynomial<T> {
        let length = self.times[k + 1] - self.times[k];
        let known = [k, k + 1].map(|end| self.known(end).min(orders));
        Polynomial { from: self.times[k], length, c: self.coefficients(k, length, known) }
    }

    fn coefficients(&self, k: usize, h: f64, known: [usize; 2]) -> [T; 6] {
        let ([a, b], c) = ([&self.values[k], &self.values[k + 1]], T::constant);
        // p(s) = c0 + c1 s + ... + c5 s^5,  s = (t - t_k) / h,  with y, h y., h^2 y.. at s = 0 and s = 1
        let zero = c(0.0);
        // Newton's form on [0, 0, 0, 1, 1, 1], or with fewer ends of each.
        let [a0, a1, a2] = [a[0], a[1] * c(h), a[2] * c(0.5 * h * h)];
        let [b0, b1, b2] = [b[0], b[1] * c(h), b[2] * c(0.5 * h * h)];
        match known {
            [3, 3] => {
                // Remainders of value, rate and half the acceleration at s = 1.
                let p = b0 - a0 - a1 - a2;
                let q = b1 - a1 - c(2.0) * a2;
                let r = b2 - a2;
                let c3 = c(10.0) * p - c(4.0) * q + r;
                let c4 = c(-15.0) * p + c(7.0) * q - c(2.0) * r;
                [a0, a1, a2, c3, c4, c(6.0) * p - c(3.0) * q + r]
            }
            [2 | 3, 2 | 3] => {
                let rise = b0 - a0;
                [a0, a1, c(3.0) * rise - c(2.0) * a1 - b1, a1 + b1 - c(2.0) * rise, zero, zero]
            }
            // A kink at one end: all orders of the other.
            [3, _] => [a0, a1, a2, b0 - a0 - a1 - a2, zero, zero],
            [2, _] => [a0, a1, b0 - a0 - a1, zero, zero, zero],
            [_, 3] => {
                // b0 - b1 u + b2 u^2 + q u^3,  u = 1 - s
                let q = a0 - b0 + b1 - b2;
                [a0, b1 - c(2.0) * b2 - c(3.0) * q, b2 + c(3.0) * q, -q, zero, zero]
            }
            [_, 2] => {
                let q = a0 - b0 + b1;
                [a0, b1 - c(2.0) * q, q, zero, zero, zero]
            }
            [_, _] => [a0, b0 - a0, zero, zero, zero, zero],
        }
    }

    /// Value and rate at a time of interval k.
    pub(super) fn at(&self, k: usize, t: T) -> [T; 2] {
        self.polynomial(k).at(t)
    }

    /// Parts of interval k in which the curve is monotone.
    pub(super) fn monotone(
        times: &[f64],
        curve: Option<&Self>,
        k: usize,
    ) -> impl Iterator<Item = [f64; 2]> + use<T> {
        let turns = curve.map_or(Vec::new(), |curve| curve.turns(k));
        let mut from = times[k];
        turns.into_iter().chain([times[k + 1]]).map(move |to| [std::mem::replace(&mut from, to), to])
    }

    /// Times of the extrema inside interval k.
    pub(super) fn turns(&self, k: usize) -> Vec<f64> {
        // If the Bernstein coefficients are monotone, so is the polynomial.
        let coefficients = self.bernstein(k);
        if coefficients.is_some_and(|b| b.is_sorted() || b.iter().rev().is_sorted()) {
            return Vec::new();
        }
        let Polynomial { from, length, c } = self.polynomial(k);
        let c = c.map(|c| c.value());
        let rate = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]];
        roots(&rate).into_iter().map(|s| from + s * length).collect()
    }

    /// Upper bound of the polynomial of interval k times `sign`: the largest of its Bernstein coefficients.
    pub(super) fn bound(&self, k: usize, sign: f64) -> f64 {
        // There is no bound next to a kink or a gap.
        let Some(coefficients) = self.bernstein(k) else { return f64::INFINITY };
        coefficients.into_iter().fold(f64::NEG_INFINITY, |most, c| most.max(sign * c))
    }

    /// Bernstein coefficients of the polynomial of interval k, the inner ones of a cubic twice; `None` next to a kink
    /// or a gap.
    fn bernstein(&self, k: usize) -> Option<[f64; 6]> {
        let h = self.times[k + 1] - self.times[k];
        let [a, b] = [k, k + 1].map(|k| self.values[k].map(|x| x.value()));
        Some(match [self.known(k), self.known(k + 1)] {
            [1, 1] => [a[0], a[0], a[0], b[0], b[0], b[0]],
            [2, 2] => {
                let [inner, outer] = [a[0] + h * a[1] / 3.0, b[0] - h * b[1] / 3.0];
                [a[0], inner, inner, outer, outer, b[0]]
            }
            [3, 3] => [
                a[0],
                a[0] + h * a[1] / 5.0,
                a[0] + h * (2.0 * a[1] / 5.0 + h * a[2] / 20.0),
                b[0] - h * (2.0 * b[1] / 5.0 - h * b[2] / 20.0),
                b[0] - h * b[1] / 5.0,
                b[0],
            ],
            [_, _] => return None,
        })
    }

    /// A time clamped to interval k.
    pub(super) fn within(&self, k: usize, t: T) -> f64 {
        let (t, [low, high]) = (t.value(), [self.times[k], self.times[k + 1]]);
        let end = if t - low < high - t { low } else { high };
        if (t - end).abs() < THERE * (high - low) { end } else { t.clamp(low, high) }
    }

    /// A time of interval k at which the curve is `at`, with the derivative of one step of Newton's method.
    fn moved(&self, k: usize, t: f64, at: f64) -> T {
        let t = T::constant(t);
        let [value, rate] = self.at(k, t);
        // x(t, b) = at:  t_b = -x_b / x.,  which the dual of one Newton step t - (x - at) / x. carries
        t - (value - T::constant(at)) / rate
    }

    pub(super) fn number(&self, k: usize, t: f64) -> f64 {
        self.at(k, T::constant(t))[0].value()
    }
}

/// Binomial coefficients C(n, k).
const CHOOSE: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Roots with a change of sign between 0 and 1 of a polynomial of degree 4 at most. Between consecutive roots of its
/// derivative it has at most one.
fn roots(c: &[f64]) -> Vec<f64> {
    let value = |s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
    // In Bernstein's form the coefficients enclose the polynomial.
    let n = c.len() - 1;
    // b_i = sum_{j<=i} C(i,j) / C(n,j) c_j                                                                (31)
    let enclosing = (0..=n).map(|i| (0..=i).map(|j| CHOOSE[i][j] / CHOOSE[n][j] * c[j]).sum::<f64>());
    let [low, high] = enclosing.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], b| [l.min(b), h.max(b)]);
    if n == 0 || !(low < 0.0 && high > 0.0) {
        return Vec::new();
    }
    let derivative: Vec<f64> = (1..=n).map(|k| k as f64 * c[k]).collect();
    let mut ends = vec![0.0];
    ends.extend(roots(&derivative));
    ends.push(1.0);
    let mut found = Vec::new();
    for pair in ends.windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let rising = value(low) < 0.0;
        if rising == (value(high) < 0.0) {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (value(middle) < 0.0) == rising { low = middle } else { high = middle }
        }
        found.push(0.5 * (low + high));
    }
    found
}

/// Polynomial through the known orders at the ends of an interval and at the next output time on either side, in
/// Newton's form: twice the degree of the interval's own. Their difference estimates the error of the latter.
pub(super) struct WidePolynomial {
    /// Number of known values and derivatives.
    count: usize,
    /// Each time, repeated for each known order.
    nodes: [f64; MOST_KNOWN],
    /// Divided differences.
    c: [f64; MOST_KNOWN],
}

/// Value, rate and acceleration at four times.
const MOST_KNOWN: usize = 12;

impl WidePolynomial {
    /// Returns `None` if no neighbouring time is known.
    pub(super) fn new(y: &SampledCurve<'_, f64>, k: usize) -> Option<Self> {
        let last = y.values.len() - 1;
        let h = y.times[k + 1] - y.times[k];
        // The polynomial does not extend across a kink or a jump (a pair of times).
        let smooth = |end: usize| y.known(end) == y.orders;
        let goes_on = |end: usize, other: usize| {
            smooth(end) && y.known(other) > 0 && (y.times[end] - y.times[other]).abs() > THERE * h
        };
        let before = k.checked_sub(1).filter(|other| goes_on(k, *other));
        let after = Some(k + 2).filter(|other| *other <= last && goes_on(k + 1, *other));
        if before.or(after).is_none() || !(y.known(k) > 0 && y.known(k + 1) > 0) {
            return None;
        }
        // The interval's own ends first.
        let (mut count, mut at) = (0, [0; MOST_KNOWN]);
        for i in [k, k + 1].into_iter().chain(before).chain(after) {
            let known = y.known(i);
            at[count..count + known].fill(i);
            count += known;
        }
        let (nodes, mut c) = (at.map(|i| y.times[i]), at.map(|i| y.values[i][0]));
        for order in 1..count {
            for i in (order..count).rev() {
                c[i] = if at[i - order] == at[i] {
                    // Half the acceleration, or the rate.
                    y.values[at[i]][order] / order as f64
                } else {
                    (c[i] - c[i - 1]) / (nodes[i] - nodes[i - order])
                };
            }
        }
        Some(Self { count, nodes, c })
    }

    /// Value and rate.
    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        let ends = self.nodes[..self.count].iter().zip(&self.c[..self.count]).rev();
        ends.fold([0.0; 2], |[value, rate], (node, c)| [value * (t - node) + c, rate * (t - node) + value])
    }
}

/// Value and rate of the polynomial through more times, minus those of the interval's own.
pub(super) fn apart(curve: &SampledCurve<'_, f64>, k: usize, t: f64) -> Option<[f64; 2]> {
    let (own, wide) = (curve.at(k, t), WidePolynomial::new(curve, k)?.at(t));
    Some([wide[0] - own[0], wide[1] - own[1]])
}

/// Bisections of an interval: to the last bit of a time.
const HALVINGS: usize = 60;

/// Relative tolerance, per span, within which the abscissa has reached a value: a motion that starts at the value must
/// not reach it later because of round-off.
pub(super) const THERE: f64 = 1e-9;

/// Intervals in which the abscissa is `at`, in order, and the time of each, which depends on the design.
pub(super) fn crossings<'c, T: Real>(
    y: &'c SampledCurve<'_, T>,
    x: &'c Option<SampledCurve<'_, T>>,
    at: f64,
) -> impl Iterator<Item = (usize, T)> + 'c {
    let x = x.as_ref();
    let distances = x.into_iter().flat_map(|x| &x.values).map(move |x| (x[0].value() - at).abs());
    let near = THERE * distances.fold(0.0, f64::max);
    let intervals = 0..y.values.len().saturating_sub(1);
    intervals.flat_map(move |k| {
        let there = |end: usize| x.is_some_and(|x| (x.values[end][0].value() - at).abs() <= near);
        let located = |t: f64| x.map(|x| x.moved(k, t, at));
        if let Some(end) = [k, k + 1].into_iter().find(|end| there(*end)) {
            return Vec::from_iter(located(y.times[end]).map(|t| (k, t)));
        }
        let parts = SampledCurve::monotone(y.times, x, k);
        parts.filter_map(|part| Some((k, crossing(x, k, part, at)?))).collect()
    })
}

/// Time at which the abscissa is `at` in a monotone part of interval k, which depends on the design; `None` if the
/// abscissa does not reach it.
pub(super) fn crossing<T: Real>(
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    [mut low, mut high]: [f64; 2],
    at: f64,
) -> Option<T> {
    let Some(x) = x else { return (low <= at && at <= high).then(|| T::constant(at)) };
    let miss = |t: f64| x.number(k, t) - at;
    if !(miss(low) * miss(high) <= 0.0) {
        return None;
    }
    let rising = miss(high) > miss(low);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (miss(middle) < 0.0) == rising { low = middle } else { high = middle }
    }
    Some(x.moved(k, 0.5 * (low + high), at))
}

/// Abscissa at a time of interval k.
pub(super) fn along<T: Real>(x: &Option<SampledCurve<'_, T>>, k: usize, t: f64) -> f64 {
    x.as_ref().map_or(t, |x| x.number(k, t))
}

/// Abscissa at an output time.
pub(super) fn abscissa_at<T: Real>(y: &SampledCurve<'_, T>, x: &Option<SampledCurve<'_, T>>, k: usize) -> T {
    x.as_ref().map_or(T::constant(y.times[k]), |x| x.values[k][0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = sin t, y = t^5, at uneven times.
    fn curves(times: &[f64]) -> [SampledCurve<'_, f64>; 2] {
        let of = |f: fn(f64) -> [f64; 3]| SampledCurve {
            times,
            orders: 3,
            values: times.iter().map(|t| f(*t)).collect(),
        };
        [of(|t| [t.sin(), t.cos(), -t.sin()]), of(|t| [t.powi(5), 5.0 * t.powi(4), 20.0 * t.powi(3)])]
    }

    #[test]
    fn no_polynomial_exceeds_its_bound_and_bounds_are_near() {
        let times = [0.0, 0.3, 1.1, 1.4];
        for curve in curves(&times) {
            for orders in [2, 3] {
                let curve = SampledCurve { orders, times: &times, values: curve.values.clone() };
                for k in 0..3 {
                    for sign in [1.0, -1.0] {
                        let h = times[k + 1] - times[k];
                        let at = |j: u32| sign * curve.number(k, times[k] + h * f64::from(j) / 64.0);
                        let most = (0..=64).map(at).fold(f64::NEG_INFINITY, f64::max);
                        let bound = curve.bound(k, sign);
                        // The rates and accelerations at the ends are differences of the Bernstein coefficients.
                        let ends = [curve.values[k], curve.values[k + 1]];
                        let apart = ends.map(|[_, v, a]| h * v.abs() + h * h * a.abs() / 10.0);
                        assert!(
                            bound > most - 1e-14 && bound < most + apart[0].max(apart[1]) / 2.0,
                            "{orders} {k} {sign}: {bound} {most}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_polynomial_of_degree_five_is_its_own_interpolation() {
        let times = [0.0, 0.3, 1.1];
        let [x, y] = curves(&times);
        for t in [0.35_f64, 0.8, 1.05] {
            let [value, rate] = y.at(1, t);
            assert!((value - t.powi(5)).abs() < 1e-14 && (rate - 5.0 * t.powi(4)).abs() < 1e-13);
            assert!((x.at(1, t)[0] - t.sin()).abs() < 1e-5);
        }
    }
}
