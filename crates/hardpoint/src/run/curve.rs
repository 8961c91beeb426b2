//! Curves between solved times: polynomials with the values, rates and accelerations at both ends of each interval,
//! with their extrema, crossings of a value, and error estimates.

use std::ops::Range;

use crate::number::{self, Real};

/// Distance of the time just before a jump of a law, as a fraction of the run: far above the resolution of times, and
/// too short for any motion.
pub(super) const JUST_BEFORE: f64 = 1e-12;

/// A curve over time: at each time the first `orders` of value, rate and acceleration.
pub(super) struct SampledCurve<'t, T> {
    pub(super) times: &'t [f64],
    pub(super) orders: usize,
    /// Values at which it has kinks, since it is a magnitude that vanishes there.
    pub(super) kinks: &'static [f64],
    /// True if its extrema are among its times.
    pub(super) is_located: bool,
    pub(super) values: Vec<[T; 3]>,
}

/// Extremum of the parabola through three neighbouring times of a curve without rates.
pub(super) struct Vertex<T> {
    pub(super) value: T,
    pub(super) time: f64,
    /// The three times.
    pub(super) around: [f64; 3],
    /// Estimate of the error of the value at this time, and of the height that it lacks since the time is off; `None`
    /// if there are too few times.
    pub(super) errors: Option<[f64; 2]>,
}

/// Estimate of a kink between two times, at which a curve has an extremum.
pub(super) struct CornerEstimate {
    pub(super) time: f64,
    /// Value where the tangents at both times meet.
    pub(super) value: f64,
    /// This time, times beside it, between which it most likely is, and the middle of the interval.
    pub(super) around: [f64; 6],
}

/// The polynomial of a curve in one interval.
pub(super) struct Polynomial<T> {
    from: f64,
    length: f64,
    /// Coefficients in the fraction of the interval.
    c: [T; 6],
    /// The kink whose squared distance it is, if any.
    fold: Option<Fold>,
}

/// A kink near an interval of a curve. The curve is a magnitude there, `y = kink + side abs(v)`, and the nearer the
/// vector v is to zero, the more sharply it bends. The square
/// `(y - kink)^2 = v . v` is smooth, and interpolated instead.
#[derive(Clone, Copy)]
pub(super) struct Fold {
    kink: f64,
    /// 1 for values above the kink, -1 for those below it.
    side: f64,
}

/// Distance of a kink, in lengths of the interval, within which squares are interpolated: beyond, both are as good.
const FOLD_REACH: f64 = 4.0;

impl Fold {
    /// Square of the distance from the kink with its first two rates, from those of the curve.
    fn square<T: Real>(self, [y, rate, acceleration]: [T; 3]) -> [T; 3] {
        let (d, two) = (y - T::constant(self.kink), T::constant(2.0));
        if !rate.value().is_finite() {
            // At the kink:  v = 0,  (v . v). = 2 v . v. = 0
            let zero = T::constant(0.0 * d.value());
            return [zero, zero, T::constant(f64::NAN)];
        }
        // 2 d y.,  2 (y.^2 + d y..)
        [d * d, two * d * rate, two * (rate * rate + d * acceleration)]
    }

    /// Value and rate of the curve from those of the square.
    fn root<T: Real>(self, [square, rate]: [T; 2]) -> [T; 2] {
        if square.value() <= 0.0 {
            // At the kink, where the interpolation of a square may be negative. It is the end of the curve's range.
            return [T::constant(self.kink), T::constant(f64::NAN)];
        }
        let (d, side) = (square.sqrt(), T::constant(self.side));
        // y = kink + side d,  y. = side d. = side (d^2). / (2 d)
        [T::constant(self.kink) + side * d, side * rate / (d + d)]
    }
}

impl<T: Real> Polynomial<T> {
    /// Value and rate at a time.
    pub(super) fn at(&self, t: T) -> [T; 2] {
        let (c, h) = (T::constant, self.length);
        let s = (t - c(self.from)) / c(h);
        let [c0, c1, c2, c3, c4, c5] = self.c;
        let value = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let slope = c1 + s * (c(2.0) * c2 + s * (c(3.0) * c3 + s * (c(4.0) * c4 + s * c(5.0) * c5)));
        let found = [value, slope / c(h)];
        self.fold.map_or(found, |fold| fold.root(found))
    }

    /// Taylor coefficients of the rate at a time, per fraction of the interval; NaN where they are not known.
    fn rates(&self, t: f64) -> [T; 5] {
        let s = T::constant((t - self.from) / self.length);
        // p(s + u) = c0 + c1 u + ... + c5 u^5
        let mut c = self.c;
        for i in 0..5 {
            for j in (i..5).rev() {
                c[j] += s * c[j + 1];
            }
        }
        let k = T::constant;
        match self.fold {
            None => [c[1], k(2.0) * c[2], k(3.0) * c[3], k(4.0) * c[4], k(5.0) * c[5]],
            Some(fold) => {
                let [d, side, unknown] = [c[0].sqrt(), k(fold.side), k(f64::NAN)];
                // d^2 = c0 + c1 u + c2 u^2 + ..:  d. = c1 / 2 d,  d.. = (c2 - d.^2) / d
                let rate = c[1] / (d + d);
                [side * rate, side * (c[2] - rate * rate) / d, unknown, unknown, unknown]
            }
        }
    }
}

impl<T: Real> SampledCurve<'_, T> {
    /// Number of orders that are known at a time: at a kink the value alone.
    pub(super) fn known(&self, k: usize) -> usize {
        self.known_of(&self.values[k])
    }

    /// The kink within reach of interval k, if there is one.
    pub(super) fn fold(&self, k: usize) -> Option<Fold> {
        if self.kinks.is_empty() || self.orders == 1 {
            return None;
        }
        let ends = number::both([k, k + 1], |end| number::each(&self.values[end], |x| x.value()));
        if !ends.iter().all(|[y, ..]| y.is_finite()) {
            return None;
        }
        let h = self.times[k + 1] - self.times[k];
        let far = |kink: f64| number::both(ends, |[y, ..]| y - kink);
        let nearest = |kink: &&f64| far(**kink).map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
        let kink = *self.kinks.iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b)))?;
        let is_near = |[y, rate, acceleration]: &[f64; 3]| {
            let d = (y - kink).abs();
            // From d^2 = v . v:  v. . v. = d.^2 + d d.. - v . v..,  where the last is small near the kink
            let bend = if acceleration.is_finite() { d * acceleration.abs() } else { 0.0 };
            rate.is_nan() || d <= FOLD_REACH * h * (rate * rate + bend).sqrt()
        };
        let [a, b] = far(kink);
        let side = if a.abs() > b.abs() { a } else { b };
        ends.iter().any(is_near).then_some(Fold { kink, side: side.signum() })
    }

    /// Value, rate and acceleration at a time, or those of the square of the distance from a kink.
    fn numbers(&self, k: usize, fold: Option<Fold>) -> [T; 3] {
        fold.map_or(self.values[k], |fold| fold.square(self.values[k]))
    }

    /// Number of these that are known.
    fn known_of<U: Real>(&self, numbers: &[U; 3]) -> usize {
        numbers[..self.orders].iter().take_while(|x| x.value().is_finite()).count()
    }

    /// Numbers of orders at both ends of an interval that are known, without accelerations that the interval does not
    /// resolve: near a kink they are greater than all rates by far.
    fn resolved<U: Real>(&self, ends: &[[U; 3]; 2], h: f64) -> [usize; 2] {
        let known = number::both(ends.each_ref(), |end| self.known_of(end));
        if known != [3, 3] {
            return known;
        }
        let [a, b] = number::both(ends.each_ref(), |end| number::each(end, |x| x.value()));
        let rates = a[1].abs() + b[1].abs() + ((b[0] - a[0]) / h).abs();
        let is_resolved = |end: [f64; 3]| {
            h * end[2].abs() <= UNRESOLVED * rates || h * h * end[2].abs() <= ROUND_OFF * end[0].abs()
        };
        number::both([a, b], |end| if is_resolved(end) { 3 } else { 2 })
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
        let fold = self.fold(k);
        let ends = number::both([k, k + 1], |end| self.numbers(end, fold));
        let known = number::both(self.resolved(&ends, length), |known| known.min(orders));
        Polynomial { from: self.times[k], length, c: Self::coefficients(&ends, length, known), fold }
    }

    fn coefficients([a, b]: &[[T; 3]; 2], h: f64, known: [usize; 2]) -> [T; 6] {
        let c = T::constant;
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
            [2, 3] => {
                // Remainders at s = 1:  c2 + c3 + c4 = p,  2 c2 + 3 c3 + 4 c4 = q,  c2 + 3 c3 + 6 c4 = b2
                let (p, q) = (b0 - a0 - a1, b1 - a1);
                let c3 = c(5.0) * q - c(8.0) * p - c(2.0) * b2;
                [a0, a1, c(6.0) * p - c(3.0) * q + b2, c3, c(3.0) * p - c(2.0) * q + b2, zero]
            }
            [3, 2] => {
                // c3 + c4 = p,  3 c3 + 4 c4 = q
                let (p, q) = (b0 - a0 - a1 - a2, b1 - a1 - c(2.0) * a2);
                [a0, a1, a2, c(4.0) * p - q, q - c(3.0) * p, zero]
            }
            [2, 2] => {
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
        let coefficients = self.bernstein(k, self.fold(k));
        if coefficients.is_some_and(|b| b.is_sorted() || b.iter().rev().is_sorted()) {
            return Vec::new();
        }
        // A square turns where its root does.
        let Polynomial { from, length, c, .. } = self.polynomial(k);
        let c = number::each(&c, |c| c.value());
        let rate = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]];
        roots(&rate).into_iter().map(|s| from + s * length).collect()
    }

    /// True if a maximum (sign 1) or minimum (-1) in interval k is a kink as far as its ends show: the slope changes
    /// its sign there, by more than the accelerations at both ends account for.
    pub(super) fn has_corner(&self, k: usize, sign: f64) -> bool {
        let slopes = [self.values[k][1].value(), self.values[k + 1][1].value()];
        let turns = sign * slopes[0] > 0.0 && sign * slopes[1] < 0.0;
        if !turns || !(self.orders == 3 || self.is_located) || self.fold(k).is_some() {
            return false;
        }
        let [a, b] = number::both([k, k + 1], |end| number::each(&self.values[end], |x| x.value()));
        let bend = (self.times[k + 1] - self.times[k]) * a[2].abs().max(b[2].abs());
        let change = (a[1] - b[1]).abs();
        // Rates of a curve that is constant are round-off.
        let round_off = RATE_ROUND_OFF * (a[0].abs() + b[0].abs()) / self.run();
        let is_bent = change > f64::max(BENT * bend, round_off);
        (a[2] - b[2]).is_finite() && is_bent
    }

    /// True if the ends of interval k are so near each other that a kink between them is located.
    pub(super) fn is_at_corner(&self, k: usize) -> bool {
        self.times[k + 1] - self.times[k] <= AT_CORNER * self.run()
    }

    /// Length of the run, s.
    fn run(&self) -> f64 {
        self.times[self.values.len() - 1] - self.times[0]
    }

    /// Value and solved time of the maximum (sign 1) or minimum (-1) at a kink that is located in interval k.
    ///
    /// ```text
    /// y_b  =  part y_1b + (1 - part) y_2b,      part = y_2. / (y_2. - y_1.)                          as in (62)
    /// ```
    pub(super) fn corner(&self, k: usize, sign: f64) -> Option<(T, f64)> {
        if !self.is_at_corner(k) || !self.has_corner(k, sign) {
            return None;
        }
        let [a, b] = [self.values[k], self.values[k + 1]];
        let number = |end: usize| self.values[end][0].value();
        let [rise, from, to] = [number(k + 1) - number(k), a[1].value(), b[1].value()];
        let h = self.times[k + 1] - self.times[k];
        let round_off = AT_CORNER * (number(k).abs() + number(k + 1).abs());
        if !(rise.abs() <= h * (from.abs() + to.abs()) + round_off) {
            // The value jumps.
            return None;
        }
        // The tangents meet beyond both values, within the interval.
        let later = ((rise - h * to) / (from - to)).clamp(0.0, h);
        let part = to / (to - from);
        let mixed = T::constant(part) * a[0] + T::constant(1.0 - part) * b[0];
        let value = number(k) + from * later;
        let time = self.times[if sign * rise > 0.0 { k + 1 } else { k }];
        Some((mixed + T::constant(value - mixed.value()), time))
    }

    /// Values and times of the extrema inside interval k. The derivative of one next to a kink that is not located is
    /// unknown: `sign` is 1 for maxima, -1 for minima.
    pub(super) fn extrema(&self, k: usize, sign: f64) -> Vec<(T, f64)> {
        let is_smooth = !self.has_corner(k, sign);
        if !is_smooth && self.is_at_corner(k) {
            return self.corner(k, sign).into_iter().collect();
        }
        let turns = self.turns(k).into_iter();
        let value = |t: f64| {
            let value = self.at(k, T::constant(t))[0];
            if is_smooth { value } else { T::constant(value.value()) + unknown_change(value) }
        };
        turns.map(|t| (value(t), t)).collect()
    }

    /// Estimate of the kink in interval k: the parabolas with the values, rates and accelerations of both ends meet
    /// there.
    pub(super) fn corner_estimate(&self, k: usize) -> CornerEstimate {
        let [a, b] = number::both([k, k + 1], |end| number::each(&self.values[end], |x| x.value()));
        let (from, h) = (self.times[k], self.times[k + 1] - self.times[k]);
        let tangents = ((b[0] - a[0] - h * b[1]) / (a[1] - b[1])).clamp(0.0, h);
        let mut u = tangents;
        for _ in 0..3 {
            let v = u - h;
            let apart = a[0] - b[0] + u * (a[1] + 0.5 * u * a[2]) - v * (b[1] + 0.5 * v * b[2]);
            u = (u - apart / (a[1] - b[1] + u * a[2] - v * b[2])).clamp(0.0, h);
        }
        let least = 0.3 * AT_CORNER * self.run();
        let moved = (u - tangents).abs();
        // The error of the parabolas is to that of the tangents about as that is to the interval.
        let [near, far] = [(4.0 * moved * moved / h).max(least), moved.max(0.01 * h)];
        let around = [u - far, u - near, u, u + near, u + far, 0.5 * h];
        CornerEstimate {
            time: from + u,
            value: a[0] + a[1] * tangents,
            around: around.map(|u| from + u.clamp(0.0, h)),
        }
    }

    /// Upper bound of the polynomial of interval k times `sign`: the largest of its Bernstein coefficients.
    pub(super) fn bound(&self, k: usize, sign: f64) -> f64 {
        // There is no bound next to a kink or a gap.
        let fold = self.fold(k);
        let Some(coefficients) = self.bernstein(k, fold) else { return f64::INFINITY };
        let most = |of: [f64; 6]| of.into_iter().fold(f64::NEG_INFINITY, |most, c| most.max(sign * c));
        match fold {
            None => most(coefficients),
            Some(fold) => most(number::each(&coefficients, |c| fold.root([c, 0.0])[0])),
        }
    }

    /// Largest distance of its values from `at`.
    pub(super) fn farthest(&self, at: f64) -> f64 {
        self.values.iter().map(|x| (x[0].value() - at).abs()).fold(0.0, f64::max)
    }

    /// True if its value at time k is `at`, within a part of the largest distance from it.
    pub(super) fn is_at(&self, k: usize, at: f64, farthest: f64) -> bool {
        (self.values[k][0].value() - at).abs() <= THERE * farthest
    }

    /// True if all values in interval k are farther than this from `at`.
    fn is_apart(&self, k: usize, at: f64, far: f64) -> bool {
        self.bound(k, 1.0) < at - far || self.bound(k, -1.0) < -at - far
    }

    /// Bernstein coefficients of the polynomial of interval k, the inner ones of a cubic twice; `None` next to a kink
    /// or a gap. Near a kink those of the square of the distance from it.
    fn bernstein(&self, k: usize, fold: Option<Fold>) -> Option<[f64; 6]> {
        let h = self.times[k + 1] - self.times[k];
        let plain = |k: usize| number::each(&self.values[k], |x| x.value());
        let [a, b] = match fold {
            None => [plain(k), plain(k + 1)],
            Some(fold) => [fold.square(plain(k)), fold.square(plain(k + 1))],
        };
        Some(match self.resolved(&[a, b], h) {
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
    pub(super) fn within(&self, k: usize, t: f64) -> f64 {
        let [low, high] = [self.times[k], self.times[k + 1]];
        let end = if t - low < high - t { low } else { high };
        if (t - end).abs() < THERE * (high - low) { end } else { t.clamp(low, high) }
    }

    /// A time of interval k at which the curve has a given value, with its derivative.
    fn moved(&self, k: usize, t: f64) -> T {
        let t = T::constant(t);
        let [value, rate] = self.at(k, t);
        // x(t, b) = at:  t_b = -x_b / x.
        t - (value - T::constant(value.value())) / rate
    }

    /// Value at a time of interval k at which the abscissa is `at`, or nearly: with the derivative at constant
    /// abscissa, which is unknown where the curve is vertical.
    pub(super) fn value_over(&self, x: Option<&Self>, k: usize, t: f64, at: f64) -> T {
        let time = T::constant(t);
        let value = self.at(k, time)[0];
        let Some(x) = x else { return value };
        // y(x = at) = y + (at - x) dy/dx
        let miss = T::constant(at) - x.at(k, time)[0];
        if miss.vanishes() {
            return value;
        }
        let slope = self.slope_over(x, k, t);
        if slope.value().is_finite() { value + miss * slope } else { value + unknown_change(miss) }
    }

    /// Slope `dy/dx` over an abscissa at a time of interval k, with the derivative at constant time; NaN where the
    /// curve is vertical, or the abscissa does not move. Where the abscissa turns or rests at this time, it is the
    /// limit.
    pub(super) fn slope_over(&self, abscissa: &Self, k: usize, t: f64) -> T {
        if self.orders == 1
            && let Some((y, x)) = self.difference(t).zip(abscissa.difference(t))
        {
            // The derivatives may be known at the ends of interval k alone.
            return T::constant(y / x);
        }
        let [y, x] = [self.series(k, t), abscissa.series(k, t)];
        // l'Hopital: the ratio of the first coefficients that are not round-off.
        match (x.first_above(RESTS), y.first_above(RESTS_TOO)) {
            (Some(first), Some(earlier)) if earlier < first => T::constant(f64::NAN),
            (Some(first @ (0 | 1)), _) => y.rates[first] / x.rates[first],
            (Some(_), _) => self.slope_from_other_end(abscissa, k, t),
            (None, _) => T::constant(f64::NAN),
        }
    }

    /// Rate at a time by the parabola through the three nearest solved times; `None` with fewer times, or beside a jump
    /// (a pair of times).
    fn difference(&self, t: f64) -> Option<f64> {
        let times = &self.times[..self.values.len()];
        let apart = |k: &usize| (times[*k] - t).abs();
        let middle = (1..times.len().checked_sub(1)?).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let [t0, t1, t2] = number::each(&[middle - 1, middle, middle + 1], |k| times[k]);
        let [y0, y1, y2] = number::each(&[middle - 1, middle, middle + 1], |k| self.values[k][0].value());
        let [h0, h1] = [t1 - t0, t2 - t1];
        if h0.min(h1) < JUMP * h0.max(h1) {
            return None;
        }
        // Newton's form: y01 + y012 ((t - t0) + (t - t1))
        let [y01, y12] = [(y1 - y0) / h0, (y2 - y1) / h1];
        Some(y01 + (y12 - y01) / (t2 - t0) * (t - t0 + t - t1))
    }

    /// Slope where the abscissa rests with its acceleration, so that derivatives would be needed that are not solved:
    /// that of the cubic over the abscissa from the other end of interval k, which is near.
    fn slope_from_other_end(&self, x: &Self, k: usize, t: f64) -> T {
        let other = if t - self.times[k] < self.times[k + 1] - t { k + 1 } else { k };
        let ([y, y_rate, y_acceleration], [at, rate, acceleration]) = (self.values[other], x.values[other]);
        let time = T::constant(t);
        let (rise, run) = (self.at(k, time)[0] - y, x.at(k, time)[0] - at);
        // y' = y. / x.,    y'' = (y.. - y' x..) / x.^2,    rise = y' run + y'' run^2 / 2 + c run^3
        let first = y_rate / rate;
        let second = (y_acceleration - first * acceleration) / (rate * rate);
        let three = T::constant(3.0);
        // y' + y'' run + 3 c run^2
        three * rise / run - T::constant(2.0) * first - T::constant(0.5) * second * run
    }

    /// Order of the first derivative of the rate that is not zero at a time of interval k: 0 where the curve moves, 1
    /// where it turns; `None` if it does not move.
    pub(super) fn order_of_rest(&self, k: usize, t: f64) -> Option<usize> {
        self.series(k, t).first_above(RESTS)
    }

    /// Estimate of the interpolation error at a time of interval k; `None` if there are too few times.
    fn error_at(&self, k: usize, t: f64) -> Option<f64> {
        let (first, end) = (k.saturating_sub(1), usize::min(k + 3, self.values.len()));
        let near = SampledCurve {
            times: &self.times[first..end],
            orders: self.orders,
            kinks: self.kinks,
            is_located: self.is_located,
            values: self.values[first..end]
                .iter()
                .map(|numbers| number::each(numbers, |x| x.value()))
                .collect(),
        };
        Some(apart(&near, k - first, t)?[0].abs())
    }

    /// Maxima (sign 1) or minima (-1) of a curve without rates next to these times; none if they are among the times.
    pub(super) fn vertices(&self, near: Range<usize>, sign: f64) -> impl Iterator<Item = Vertex<T>> {
        let near = if self.orders == 1 && !self.is_located { near } else { 0..0 };
        near.filter_map(move |k| self.vertex(k, sign))
    }

    /// Times k - 1, k and k + 1; `None` if the curve is not known or jumps there.
    fn around(&self, k: usize) -> Option<[f64; 3]> {
        let is_inside = k > 0 && k + 1 < self.values.len();
        if !is_inside || !(k - 1..=k + 1).all(|k| self.values[k][0].value().is_finite()) {
            return None;
        }
        let [a, b, c] = [self.times[k - 1], self.times[k], self.times[k + 1]];
        (f64::min(b - a, c - b) > 2.0 * JUST_BEFORE * self.run()).then_some([a, b, c])
    }

    /// The kink nearest to time k, if it is not within the values of this time and its neighbours.
    fn fold_around(&self, k: usize) -> Option<Fold> {
        let y = |k: usize| self.values[k][0].value();
        let far = |kink: &f64| (y(k) - kink).abs();
        let kink = self.kinks.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let side = if y(k) < kink { -1.0 } else { 1.0 };
        (k - 1..=k + 1).all(|k| side * (y(k) - kink) > 0.0).then_some(Fold { kink, side })
    }

    /// Maximum (sign 1) or minimum (-1) next to time k, by the parabola through the values at this time and its
    /// neighbours, or through the squares of their distances from a kink.
    fn vertex(&self, k: usize, sign: f64) -> Option<Vertex<T>> {
        let around = self.around(k)?;
        // Nearer to a neighbour it is next to that one, unless there is no parabola.
        let y = |k: usize| sign * self.values[k][0].value();
        let is_lower = [k - 1, k + 1].map(|other| y(other) <= y(k));
        let is_outer = |side: usize, other: usize| is_lower[side] || self.around(other).is_none();
        if !(is_outer(0, k - 1) && is_outer(1, k + 1)) {
            return None;
        }
        let [a, b, c] = around;
        let fold = self.fold_around(k);
        let sign = fold.map_or(sign, |fold| sign * fold.side);
        let of = T::constant;
        let number = |k: usize| {
            let y = self.values[k][0];
            fold.map_or(y, |Fold { kink, .. }| (y - of(kink)) * (y - of(kink)))
        };
        let [p, q, r] = [number(k - 1), number(k), number(k + 1)];
        // z = p + d (t - a) + e (t - a) (t - b)
        let d = (q - p) / of(b - a);
        let e = ((r - q) / of(c - b) - d) / of(c - a);
        if !(sign * e.value() < 0.0) {
            return None;
        }
        let t = of(0.5) * (of(a + b) - d / e);
        let time = t.value();
        let is_before = is_lower[0] || (a <= time && time <= b);
        let is_after = is_lower[1] || (b <= time && time <= c);
        if !(is_before && is_after) {
            return None;
        }
        let at = |t: T| p + d * (t - of(a)) + e * (t - of(a)) * (t - of(b));
        let errors = self.fourth(k).map(|fourth| {
            // z + f (t - a) (t - b) (t - c)  goes through a fourth time.
            let x = self.times[fourth];
            let f = (number(fourth) - at(of(x))).value() / ((x - a) * (x - b) * (x - c));
            let [a, b, c] = around.map(|other| time - other);
            let rate = f * (a * b + a * c + b * c);
            [(f * a * b * c).abs(), (0.25 * rate * rate / e.value()).abs()]
        });
        let Some(fold) = fold else { return Some(Vertex { value: at(t), time, around, errors }) };
        let value = fold.root([at(t), T::zero()])[0];
        // dy = dz / 2 (y - kink)
        let distance = (value.value() - fold.kink).abs();
        let errors = errors.map(|errors| errors.map(|error| 0.5 * error / distance));
        Some(Vertex { value, time, around, errors })
    }

    /// The time nearest to time k beyond its neighbours, without a jump between them.
    fn fourth(&self, k: usize) -> Option<usize> {
        let before = k.checked_sub(2).filter(|_| self.around(k - 1).is_some());
        let after = Some(k + 2).filter(|_| self.around(k + 1).is_some());
        let far = |other: &usize| (self.times[*other] - self.times[k]).abs();
        before.into_iter().chain(after).min_by(|i, k| far(i).total_cmp(&far(k)))
    }

    fn series(&self, k: usize, t: f64) -> RateSeries<T> {
        let polynomial = self.polynomial(k);
        RateSeries { rates: polynomial.rates(t), value: polynomial.at(T::constant(t))[0].value() }
    }

    pub(super) fn number(&self, k: usize, t: f64) -> f64 {
        self.at(k, T::constant(t))[0].value()
    }
}

/// Taylor coefficients of the rate of a curve at a time, per fraction of its interval.
struct RateSeries<T> {
    rates: [T; 5],
    value: f64,
}

impl<T: Real> RateSeries<T> {
    /// Index of the first coefficient above this fraction of the largest, and above the round-off of the value.
    fn first_above(&self, part: f64) -> Option<usize> {
        let sizes = number::each(&self.rates, |rate| rate.value().abs());
        let largest = sizes.into_iter().fold(0.0, f64::max);
        let least = f64::max(part * largest, ROUND_OFF * self.value.abs());
        sizes.into_iter().position(|size| size > least)
    }
}

/// Fraction of the largest coefficient of its rate below which an abscissa rests. The next coefficient determines the
/// slope with a relative error of this size, and a rate of this size with the round-off divided by it: about the same.
const RESTS: f64 = 1e-8;
/// The same for a curve over an abscissa that rests: above, it is vertical.
const RESTS_TOO: f64 = 1e-5;
/// Round-off of a curve between solved times, as a fraction of its value.
const ROUND_OFF: f64 = 1e-14;

/// Zero with an unknown derivative, unless the derivative of `by` is zero.
pub(super) fn unknown_change<T: Real>(by: T) -> T {
    // The root of a square has none at zero.
    let change = by - T::constant(by.value());
    (change * change).sqrt()
}

/// Ratio of two consecutive intervals below which the shorter one is a jump.
const JUMP: f64 = 1e-6;
/// Factor of the rates in an interval above which the change of the rate by an acceleration is not resolved there.
const UNRESOLVED: f64 = 1e3;

/// Change of the rate in an interval beyond which it has a kink, as a multiple of that by the accelerations at both
/// of its ends.
const BENT: f64 = 2.0;
/// Rates that would change a value by less than this fraction of it over the run are round-off.
const RATE_ROUND_OFF: f64 = 1e-11;
/// Interval, as a fraction of the run, in which a kink is located.
pub(super) const AT_CORNER: f64 = 1e-11;

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
    /// The kink whose squared distance it is, if any.
    fold: Option<Fold>,
}

/// Value, rate and acceleration at four times.
const MOST_KNOWN: usize = 12;

impl WidePolynomial {
    /// Returns `None` if no neighbouring time is known.
    pub(super) fn new(y: &SampledCurve<'_, f64>, k: usize) -> Option<Self> {
        let last = y.values.len() - 1;
        let h = y.times[k + 1] - y.times[k];
        // Near a kink, or if it would extend across one, it is a polynomial of the square.
        let neighbours = [k.checked_sub(1), Some(k), Some(k + 1).filter(|other| *other < last)];
        let fold = neighbours.into_iter().flatten().find_map(|k| y.fold(k));
        let numbers = |k: usize| y.numbers(k, fold);
        // The polynomial does not extend across other kinks or a jump (a pair of times).
        let smooth = |end: usize| fold.is_some() || y.known(end) == y.orders;
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
            let known = y.known_of(&numbers(i));
            at[count..count + known].fill(i);
            count += known;
        }
        let (nodes, mut c) = (number::each(&at, |i| y.times[i]), number::each(&at, |i| numbers(i)[0]));
        for order in 1..count {
            for i in (order..count).rev() {
                c[i] = if at[i - order] == at[i] {
                    // Half the acceleration, or the rate.
                    numbers(at[i])[order] / order as f64
                } else {
                    (c[i] - c[i - 1]) / (nodes[i] - nodes[i - order])
                };
            }
        }
        Some(Self { count, nodes, c, fold })
    }

    /// Value and rate.
    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        let ends = self.nodes[..self.count].iter().zip(&self.c[..self.count]).rev();
        let found = ends
            .fold([0.0; 2], |[value, rate], (node, c)| [value * (t - node) + c, rate * (t - node) + value]);
        self.fold.map_or(found, |fold| fold.root(found))
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

/// Part of the largest distance from a value within which the abscissa may reach it at a turn between two times, if
/// there are too few times for an estimate of the interpolation error.
const NEAR_A_TURN: f64 = 1e-4;

/// Intervals in which the abscissa is `at`, in order, and the time of each. At a turn between two times it is `at`
/// within the interpolation error: otherwise it would depend on these times whether the abscissa reaches its extremum.
pub(super) fn crossings<'c, T: Real>(
    y: &'c SampledCurve<'_, T>,
    x: &'c Option<SampledCurve<'_, T>>,
    at: f64,
) -> impl Iterator<Item = (usize, f64)> + 'c {
    let x = x.as_ref();
    let farthest = x.map_or(0.0, |x| x.farthest(at));
    let intervals = 0..y.values.len().saturating_sub(1);
    intervals.flat_map(move |k| {
        let Some(x) = x else {
            return crossing_time::<T>(None, k, [y.times[k], y.times[k + 1]], at)
                .into_iter()
                .map(|t| (k, t))
                .collect();
        };
        if x.is_apart(k, at, NEAR_A_TURN * farthest) {
            return Vec::new();
        }
        let is_at = |end: usize| x.is_at(end, at, farthest);
        let turns_at = |t: f64| {
            let miss = (x.number(k, t) - at).abs();
            let is_near = miss <= NEAR_A_TURN * farthest;
            is_near && x.error_at(k, t).is_none_or(|error| miss <= error.max(THERE * farthest))
        };
        let turns = x.turns(k).into_iter().map(|t| (t, turns_at(t)));
        let ends = number::both([k, k + 1], |end| (x.times[end], is_at(end)));
        let places: Vec<_> = ends[..1].iter().copied().chain(turns).chain([ends[1]]).collect();
        let inner = places.windows(2).map(|pair| {
            let is_apart = pair.iter().all(|(_, is_there)| !is_there);
            is_apart.then(|| crossing_time(Some(x), k, [pair[0].0, pair[1].0], at)).flatten()
        });
        let reached = places.iter().map(|(t, is_there)| is_there.then_some(*t));
        // In order of time: each place, then the part after it.
        let found = reached.zip(inner.chain([None])).flat_map(|(place, part)| place.or(part));
        found.map(|t| (k, t)).collect::<Vec<_>>()
    })
}

/// Time at which the abscissa is `at` in a monotone part of interval k, with its derivative; `None` if the abscissa
/// does not reach it.
pub(super) fn crossing<T: Real>(
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    part: [f64; 2],
    at: f64,
) -> Option<T> {
    let t = crossing_time(x, k, part, at)?;
    Some(x.map_or(T::constant(t), |x| x.moved(k, t)))
}

fn crossing_time<T: Real>(
    x: Option<&SampledCurve<'_, T>>,
    k: usize,
    [mut low, mut high]: [f64; 2],
    at: f64,
) -> Option<f64> {
    let Some(x) = x else { return (low <= at && at <= high).then_some(at) };
    let polynomial = x.polynomial(k);
    let miss = |t: f64| polynomial.at(T::constant(t))[0].value() - at;
    if !(miss(low) * miss(high) <= 0.0) {
        return None;
    }
    let rising = miss(high) > miss(low);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (miss(middle) < 0.0) == rising { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
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
            kinks: &[],
            is_located: false,
            values: times.iter().map(|t| f(*t)).collect(),
        };
        [of(|t| [t.sin(), t.cos(), -t.sin()]), of(|t| [t.powi(5), 5.0 * t.powi(4), 20.0 * t.powi(3)])]
    }

    #[test]
    fn no_polynomial_exceeds_its_bound_and_bounds_are_near() {
        let times = [0.0, 0.3, 1.1, 1.4];
        for curve in curves(&times) {
            for orders in [2, 3] {
                let curve = SampledCurve {
                    orders,
                    times: &times,
                    kinks: &[],
                    is_located: false,
                    values: curve.values.clone(),
                };
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
    fn a_polynomial_of_degree_four_is_its_own_interpolation_without_one_acceleration() {
        let times = [0.3, 1.1];
        for unknown in [0, 1] {
            let mut values = times.map(|t: f64| [t.powi(4), 4.0 * t.powi(3), 12.0 * t * t]).to_vec();
            values[unknown][2] = f64::NAN;
            let curve = SampledCurve { times: &times, orders: 3, kinks: &[], is_located: false, values };
            let [value, rate] = curve.at(0, 0.7_f64);
            assert!((value - 0.7_f64.powi(4)).abs() < 1e-14 && (rate - 4.0 * 0.7_f64.powi(3)).abs() < 1e-13);
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
