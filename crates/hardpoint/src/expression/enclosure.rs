//! Bounds of an expression and of its first three rates over an interval of time, with outward rounding.
//!
//! [`Stretch`](super::range::Stretch) bounds value and rate up to rounding, for the steps of a motion. Proofs need
//! further rates as well, and bounds that hold in spite of rounding. Where an operation changes its branch within the
//! interval, the rates may jump: they are unbounded then, and the value alone is bounded.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::number::{Function, Interval, Jet, Real};

use super::range::Range;
use super::term::{ExpressionValue, Relation};

/// Bounds of a value and of its first three rates, all over the same interval of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Enclosure(pub Jet<Interval, 4>);

impl Enclosure {
    /// The time itself.
    pub(crate) fn time(over: Interval) -> Self {
        Self(Jet::time(over))
    }

    /// Unknown value and rates.
    pub(crate) fn unbounded() -> Self {
        Self(Jet([Interval::ENTIRE; 4]))
    }

    fn value(self) -> Interval {
        self.0.value()
    }

    /// A continuous quantity with a kink: its value is bounded, its rates are not.
    fn with_kink(value: Interval) -> Self {
        Self(Jet([value, Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE]))
    }
}

impl ExpressionValue for Enclosure {
    fn number(x: f64) -> Self {
        Self(Jet::constant(Interval::constant(x)))
    }

    fn function(self, function: Function) -> Self {
        let x = self.value();
        if function == Function::Abs && x.low < 0.0 && x.high > 0.0 {
            return Self::with_kink(Real::abs(x));
        }
        Self(self.0.map(function))
    }

    fn to_whole(self, exponent: i32) -> Self {
        Self(self.0.powi(exponent))
    }

    fn to_constant(self, exponent: f64) -> Self {
        if exponent.fract() == 0.0 && exponent.abs() < f64::from(i32::MAX) {
            return self.to_whole(exponent as i32);
        }
        let power =
            |lowered: f64| self.value().pow(Interval::constant(exponent) - Interval::constant(lowered));
        // x^p, p x^(p-1), p (p-1) x^(p-2), p (p-1) (p-2) x^(p-3)
        let p = Interval::constant(exponent);
        let (q, r) = (p * (p + -1.0), p * (p + -1.0) * (p + -2.0));
        Self(self.0.compose([power(0.0), p * power(1.0), q * power(2.0), r * power(3.0)]))
    }

    /// Power with a positive base. With other bases it is undefined for all but integer exponents, which are constant.
    fn to(self, exponent: Self) -> Self {
        (exponent * self.function(Function::Ln)).function(Function::Exp)
    }

    fn angle(self, x: Self) -> Self {
        // Unbounded where it may jump.
        Self(self.0.atan2(x.0))
    }

    fn length(self, o: Self) -> Self {
        Self(self.0.hypot(o.0))
    }

    fn smaller(self, o: Self) -> Self {
        let (a, b) = (self.value(), o.value());
        if a.high <= b.low {
            self
        } else if b.high <= a.low {
            o
        } else {
            Self::with_kink(-(-a).larger(-b))
        }
    }

    fn greater(self, o: Self) -> Self {
        -(-self).smaller(-o)
    }

    fn step(self, x0: Self, h0: Self, x1: Self, h1: Self) -> Self {
        let (x, start, end) = (self.value(), x0.value(), x1.value());
        if !(start.high < end.low) {
            return Self::unbounded();
        }
        if x.high <= start.low {
            return h0;
        }
        if x.low >= end.high {
            return h1;
        }
        // h0 + (h1 - h0) (3 u² - 2 u³); the rate is continuous at both ends, so that a part before or after the step
        // only adds to the bounds.
        let u = ((self - x0) / (x1 - x0)).0;
        let inside = Interval { low: 0.0, high: 1.0 };
        let kept = Jet([u.value().and(inside), u.d(), u.dd(), u.ddd()]);
        let constant = |x: f64| Interval::constant(x);
        let v = kept.value();
        let s = v.square() * (constant(3.0) - v * 2.0);
        // s' = 6 u (1 - u), at most 3/2
        let slope = (v * (constant(1.0) - v) * 6.0).and(Interval { low: 0.0, high: 1.5 });
        let bend = constant(6.0) - v * 12.0;
        let mut rise = kept.compose([s.and(inside), slope, bend, constant(-12.0)]);
        if x.low < start.high || x.high > end.low {
            // The second rate jumps there.
            let still = constant(0.0);
            rise = Jet([rise.0[0], rise.0[1].or(still), rise.0[2].or(still), Interval::ENTIRE]);
        }
        h0 + (h1 - h0) * Self(rise)
    }

    /// The selected value if the comparison is decided, but for a single instant, else both: the value may jump.
    fn choose(self, comparison: Relation, b: Self, x: Self, y: Self) -> Self {
        let (difference, range) = ((self - b).0, |x: Interval| Range { low: x.low, high: x.high });
        // Equal at one instant at most.
        let passes = !difference.d().contains(0.0);
        let decided = match difference.value() {
            Interval { high, .. } if passes && high <= 0.0 => comparison.holds(-1.0, 0.0),
            Interval { low, .. } if passes && low >= 0.0 => comparison.holds(1.0, 0.0),
            _ => comparison.holds_between(range(self.value()), range(b.value())),
        };
        match decided {
            Some(true) => x,
            Some(false) => y,
            None => Self::with_kink(x.value().or(y.value())),
        }
    }

    fn settled(self) -> Self {
        Self(Jet::constant(self.value()))
    }
}

impl Add for Enclosure {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
}

impl Sub for Enclosure {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
}

impl Mul for Enclosure {
    type Output = Self;

    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
}

impl Div for Enclosure {
    type Output = Self;

    fn div(self, o: Self) -> Self {
        Self(self.0 / o.0)
    }
}

impl Neg for Enclosure {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}
