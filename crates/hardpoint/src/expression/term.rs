//! Scalar types of expressions, with their operations of two and more operands.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::number::{Function, Real};

/// Scalar type in which an expression is evaluated: a number with its derivatives, or [bounds](super::range::Stretch)
/// of a number.
pub(crate) trait ExpressionValue:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Constant `x`.
    fn number(x: f64) -> Self;
    /// Function of one argument.
    fn function(self, function: Function) -> Self;
    /// Power with an integer exponent.
    fn to_whole(self, exponent: i32) -> Self;
    /// Power with a constant exponent.
    fn to_constant(self, exponent: f64) -> Self;
    /// Power with any exponent.
    fn to(self, exponent: Self) -> Self;
    /// Angle of the point (`x`, `self`), rad.
    fn angle(self, x: Self) -> Self;
    /// Length of the vector (`self`, `o`).
    fn length(self, o: Self) -> Self;
    /// Minimum of the two; NaN if either is.
    fn smaller(self, o: Self) -> Self;
    /// Maximum of the two; NaN if either is.
    fn greater(self, o: Self) -> Self;
    /// Cubic step in `self` from `h0` at `x0` and below to `h1` at `x1` and above; NaN unless `x0 < x1`.
    fn step(self, x0: Self, h0: Self, x1: Self, h1: Self) -> Self;
    /// `x` if the comparison of `self` with `b` is true, else `y`; NaN if either operand is.
    fn choose(self, comparison: Relation, b: Self, x: Self, y: Self) -> Self;
    /// Value of a term that depends on constants alone.
    fn settled(self) -> Self;
}

/// Piecewise operations use the branch that is active just after the instant.
impl<T: Real> ExpressionValue for T {
    #[inline(always)]
    fn number(x: f64) -> Self {
        T::constant(x)
    }

    #[inline(always)]
    fn function(self, function: Function) -> Self {
        self.map(function)
    }

    #[inline(always)]
    fn to_whole(self, exponent: i32) -> Self {
        self.powi(exponent)
    }

    // Rare operations are compiled separately from the common ones.
    #[inline(never)]
    fn to_constant(self, exponent: f64) -> Self {
        self.powf(exponent)
    }

    #[inline(never)]
    fn to(self, exponent: Self) -> Self {
        self.pow(exponent)
    }

    #[inline(never)]
    fn angle(self, x: Self) -> Self {
        self.atan2(x)
    }

    #[inline(never)]
    fn length(self, o: Self) -> Self {
        self.hypot(o)
    }

    #[inline(never)]
    fn smaller(self, o: Self) -> Self {
        match self.order(o) {
            Some(Ordering::Less | Ordering::Equal) => self,
            Some(Ordering::Greater) => o,
            None => unordered(self, o),
        }
    }

    #[inline(never)]
    fn greater(self, o: Self) -> Self {
        match self.order(o) {
            Some(Ordering::Greater | Ordering::Equal) => self,
            Some(Ordering::Less) => o,
            None => unordered(self, o),
        }
    }

    #[inline(never)]
    fn step(self, x0: Self, h0: Self, x1: Self, h1: Self) -> Self {
        if order_of_values(x0, x1) != Some(Ordering::Less) {
            return undefined(self);
        }
        let order = |end: T| self.order(end).or_else(|| order_of_values(self, end));
        match (order(x0), order(x1)) {
            (Some(Ordering::Less), _) => h0,
            (_, Some(Ordering::Equal | Ordering::Greater)) => h1,
            (Some(_), Some(_)) => {
                // h0 + (h1 - h0) (3 u² - 2 u³)
                let u = (self - x0) / (x1 - x0);
                h0 + (h1 - h0) * (u * u * (T::constant(3.0) - u * 2.0))
            }
            _ => undefined(self),
        }
    }

    #[inline(never)]
    fn choose(self, comparison: Relation, b: Self, x: Self, y: Self) -> Self {
        match order_of_values(self, b) {
            Some(order) if comparison.holds_for(order) => x,
            Some(_) => y,
            None => undefined(self + b),
        }
    }

    #[inline(always)]
    fn settled(self) -> Self {
        self.held()
    }
}

/// NaN in value and derivatives.
#[inline(always)]
fn undefined<T: Real>(like: T) -> T {
    T::constant(f64::NAN) * like
}

/// Minimum or maximum of two operands without an order: of equal values the one whose derivatives are unknown.
#[inline(always)]
fn unordered<T: Real>(x: T, o: T) -> T {
    match order_of_values(x, o) {
        Some(_) if x.order(x).is_none() => x,
        Some(_) => o,
        None => undefined(x + o),
    }
}

/// Ordering of the values alone; of bounds of values, where it is the same for all that they contain.
#[inline(always)]
fn order_of_values<T: Real>(x: T, o: T) -> Option<Ordering> {
    x.value().partial_cmp(&o.value()).or_else(|| x.order(o))
}

/// Function of two quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Atan2,
    Pow,
    Hypot,
    Min,
    Max,
}

impl Binary {
    #[inline(always)]
    pub(crate) fn of<V: ExpressionValue>(self, x: V, y: V) -> V {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Atan2 => x.angle(y),
            Self::Pow => x.to(y),
            Self::Hypot => x.length(y),
            Self::Min => x.smaller(y),
            Self::Max => x.greater(y),
        }
    }
}

/// Comparison of two values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Relation {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Relation {
    /// True if `a` compares with `b` in this way; `None` if either is NaN.
    pub(crate) fn holds(self, a: f64, b: f64) -> Option<bool> {
        a.partial_cmp(&b).map(|order| self.holds_for(order))
    }

    /// True if values in this order compare in this way.
    fn holds_for(self, order: Ordering) -> bool {
        match self {
            Self::Less => order == Ordering::Less,
            Self::LessOrEqual => order != Ordering::Greater,
            Self::Greater => order == Ordering::Greater,
            Self::GreaterOrEqual => order != Ordering::Less,
        }
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual3_64;

    use super::*;
    use crate::number::Jet;

    #[test]
    fn step_between_its_ends_agrees_with_num_dual_to_third_order() {
        // Derivatives of the arguments: all different from zero, so that every term of the chain rule contributes.
        const SLOPES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.7, -0.4, 1.3], [-1.9, 2.3, -0.6]];
        let jet = |x, [d, dd, ddd]: [f64; 3]| Jet([x, d, dd, ddd]);
        let dual = |Jet([x, d, dd, ddd]): Jet| Dual3_64::new(x, d, dd, ddd);
        for (x, slopes) in [0.2, 0.5, 0.9].iter().flat_map(|x| SLOPES.map(|slopes| (*x, slopes))) {
            let x = jet(x, slopes);
            let (x0, h0) = (jet(0.1, SLOPES[1]), jet(-3.0, SLOPES[2]));
            let (x1, h1) = (jet(1.3, SLOPES[2]), jet(2.0, SLOPES[1]));
            let u = (dual(x) - dual(x0)) / (dual(x1) - dual(x0));
            let oracle = dual(h0) + (dual(h1) - dual(h0)) * (u * u * 3.0 - u * u * u * 2.0);
            let oracle = [oracle.re, oracle.v1, oracle.v2, oracle.v3];
            let size = oracle.iter().fold(1.0, |size: f64, derivative| size.max(derivative.abs()));
            let ours = x.step(x0, h0, x1, h1).derivatives();
            for order in 0..4 {
                let error = (ours[order] - oracle[order]).abs();
                assert!(error <= 1e3 * f64::EPSILON * size, "order {order}: {ours:?} is not {oracle:?}");
            }
        }
    }

    #[test]
    fn ties_are_decided_just_after_the_instant() {
        let (zero, rising): (Jet, Jet) = (Jet::constant(0.0), Jet::time(0.0));
        let falling = -rising;
        assert_eq!(Real::abs(falling).d(), 1.0);
        assert_eq!(Real::abs(rising).d(), 1.0);
        assert_eq!(rising.smaller(zero), zero);
        assert_eq!(zero.greater(rising), rising);
        assert_eq!(zero.smaller(falling), falling);

        let step = |t: f64| {
            let [x0, h0, x1, h1] = [0.0, 5.0, 1.0, 6.0].map(Jet::constant);
            Jet::time(t).step(x0, h0, x1, h1).derivatives()
        };
        assert_eq!(step(-1e-9), [5.0, 0.0, 0.0, 0.0]);
        assert_eq!(step(0.0), [5.0, 0.0, 6.0, -12.0]);
        assert_eq!(step(1.0), [6.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_value_that_is_not_a_number_is_never_hidden() {
        let (nan, one): (Jet, Jet) = (Jet::constant(f64::NAN), Jet::constant(1.0));
        for hidden in [nan.smaller(one), one.smaller(nan), nan.greater(one), one.greater(nan), Real::abs(nan)]
        {
            assert!(hidden.value().is_nan());
        }
        assert!(nan.step(one, one, one * 2.0, one).value().is_nan());
        assert!(one.step(one, one, one, one).value().is_nan(), "x0 = x1");
    }
}
