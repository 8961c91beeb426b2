//! Truncated Taylor arithmetic in several variables: values with their mixed partial derivatives.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::OnceLock;

use super::{Function, Interval, Real};

/// The Taylor coefficients of a quantity in one, two or three variables: its partial derivatives over factorials.
///
/// The coefficients are those of the monomials of which one exponent is at most 4 and the others are at most 1: values,
/// first and mixed derivatives, and all derivatives that bound the error of a cubic Hermite interpolation
/// (`docs/theory.md`, section 20): 5 for one variable, 16 for two, 44 for three. Constants have one, and combine with
/// all; a quantity in one variable and one in two do not combine.
///
/// The degree of a quantity may be limited (`to_degree`); that of a result is the lowest of its operands.
///
/// Every operation is exact up to rounding. Functions follow from their differential equations: with the operator
/// `D = sum x_i d/dx_i`, which multiplies a coefficient by its degree, `D f(u) = f'(u) D u`.
///
/// ```
/// use hardpoint::number::Taylor;
///
/// let [x, y] = [0, 1].map(|k| Taylor::variable([3.0, 2.0][k], k, 2));
/// let f = x * x * y;
/// assert_eq!(f.derivative([0, 0, 0]), 18.0);
/// assert_eq!(f.derivative([1, 1, 0]), 6.0); // 2 x
/// assert_eq!(f.derivative([2, 1, 0]), 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor<T> {
    /// Only those of its variables, up to its degree, are valid.
    coefficients: [T; MOST],
    variables: u8,
    degree: u8,
}

/// Exponents of a monomial.
pub type Exponents = [u8; 3];

/// Highest exponent of one variable.
const HIGHEST: u8 = 4;

/// Highest number of variables.
const VARIABLES: usize = 3;

/// Highest degree of a monomial.
const DEGREE: u8 = HIGHEST + 2;

/// Number of coefficients by number of variables, and by degree.
const COEFFICIENTS: [[usize; DEGREE as usize + 1]; VARIABLES + 1] =
    [[1; 7], [1, 2, 3, 4, 5, 5, 5], [1, 3, 6, 10, 14, 16, 16], [1, 4, 10, 20, 32, 41, MOST]];

/// Number of coefficients in all variables.
const MOST: usize = 44;

/// The monomials of a number of variables, by degree.
struct Monomials {
    exponents: Vec<Exponents>,
    degrees: Vec<usize>,
    /// Pairs of monomials (i, j) with the product k, j not the constant, from `begins[k]` to `begins[k + 1]`.
    pairs: Vec<[u8; 2]>,
    begins: Vec<usize>,
    /// Per monomial: the monomials with one more of each variable, if all of them are in the set.
    raised: Vec<Option<Vec<usize>>>,
}

impl Monomials {
    fn new(variables: usize) -> Self {
        let most = |k: usize| if k < variables { HIGHEST } else { 0 };
        let mut exponents: Vec<Exponents> = Vec::new();
        for a in 0..=most(0) {
            for b in 0..=most(1) {
                for c in 0..=most(2) {
                    if [a, b, c].iter().filter(|e| **e > 1).count() <= 1 {
                        exponents.push([a, b, c]);
                    }
                }
            }
        }
        let degree = |e: &Exponents| e.iter().map(|e| usize::from(*e)).sum::<usize>();
        exponents.sort_by_key(|e| (degree(e), std::cmp::Reverse(*e)));
        let degrees = exponents.iter().map(degree).collect();
        let (mut pairs, mut begins) = (Vec::new(), vec![0]);
        for of in &exponents {
            for (j, right) in exponents.iter().enumerate().skip(1) {
                let left = super::each(&[0, 1, 2], |n| of[n].wrapping_sub(right[n]));
                if let Some(i) = exponents.iter().position(|e| *e == left) {
                    pairs.push([i as u8, j as u8]);
                }
            }
            begins.push(pairs.len());
        }
        let raised = |e: &Exponents| {
            let one_more = |n: usize| {
                let mut raised = *e;
                raised[n] += 1;
                exponents.iter().position(|e| *e == raised)
            };
            (0..variables).map(one_more).collect::<Option<Vec<usize>>>()
        };
        let raised = exponents.iter().map(raised).collect();
        Self { exponents, degrees, pairs, begins, raised }
    }

    /// Pairs with the product k.
    #[inline]
    fn of(&self, k: usize) -> impl Iterator<Item = (usize, usize)> {
        self.pairs[self.begins[k]..self.begins[k + 1]].iter().map(|[i, j]| (usize::from(*i), usize::from(*j)))
    }
}

fn monomials(variables: usize) -> &'static Monomials {
    static OF: [OnceLock<Monomials>; VARIABLES + 1] = [const { OnceLock::new() }; VARIABLES + 1];
    OF[variables].get_or_init(|| Monomials::new(variables))
}

/// Degree of each coefficient of quantities of `variables` variables, which never decreases.
pub(crate) fn degrees(variables: usize) -> &'static [usize] {
    &monomials(variables).degrees
}

impl<T: Real> Taylor<T> {
    fn monomials(&self) -> &'static Monomials {
        monomials(usize::from(self.variables))
    }

    /// Number of coefficients that may differ from zero.
    #[inline]
    fn len(&self) -> usize {
        COEFFICIENTS[usize::from(self.variables)][usize::from(self.degree)]
    }

    /// A quantity that does not depend on the variables.
    #[inline]
    pub fn constant(value: T) -> Self {
        let mut coefficients = [T::zero(); MOST];
        coefficients[0] = value;
        Self { coefficients, variables: 0, degree: DEGREE }
    }

    /// Variable k of `variables` at this value.
    ///
    /// # Panics
    /// Panics unless there are one to three variables, and k is one of them.
    pub fn variable(value: T, k: usize, variables: usize) -> Self {
        assert!(k < variables && variables <= VARIABLES, "variable {k} of {variables}");
        let mut f = Self { variables: variables as u8, ..Self::constant(value) };
        f.coefficients[1 + k] = T::one();
        f
    }

    /// This quantity without coefficients above a degree: all that is computed from it has none either.
    pub(crate) fn to_degree(mut self, degree: usize) -> Self {
        self.degree = self.degree.min(degree as u8);
        self
    }

    /// A quantity of `variables` variables of which only the value is known: all other coefficients are `rest`.
    pub(crate) fn of_value(value: T, variables: usize, rest: T) -> Self {
        let mut f = Self { variables: variables as u8, ..Self::constant(value) };
        f.coefficients_mut()[1..].fill(rest);
        f
    }

    /// Value.
    #[inline]
    pub const fn value(self) -> T {
        self.coefficients[0]
    }

    /// Coefficients by degree: the constant, then those of the variables; only those of its variables up to its degree
    /// are valid.
    #[inline]
    pub const fn coefficients(&self) -> &[T] {
        &self.coefficients
    }

    /// Coefficients of the monomials of its variables, for changes.
    #[inline]
    pub(crate) fn coefficients_mut(&mut self) -> &mut [T] {
        let n = self.len();
        &mut self.coefficients[..n]
    }

    /// Partial derivative of this order in each variable.
    ///
    /// # Panics
    /// Panics if it is not among the coefficients.
    pub fn derivative(&self, order: Exponents) -> T {
        if self.variables == 0 {
            return if order == [0; 3] { self.coefficients[0] } else { T::zero() };
        }
        let place = self.monomials().exponents.iter().position(|e| *e == order);
        let factorial = |n: &u8| (1..=u32::from(*n)).product::<u32>();
        let factor: u32 = order.iter().map(factorial).product();
        self.coefficients[place.expect("a monomial of the set")] * f64::from(factor)
    }

    /// True if only the value may differ from zero.
    fn is_still(&self) -> bool {
        self.coefficients[1..self.len()].iter().all(|x| x.is_zero())
    }

    /// This quantity times a constant.
    fn times(self, factor: T) -> Self {
        self.each(|x| x * factor)
    }

    #[inline(always)]
    fn each(mut self, f: impl Fn(T) -> T) -> Self {
        for x in self.coefficients_mut() {
            *x = f(*x);
        }
        self
    }

    /// A quantity of the variables of both, from their coefficients.
    #[inline(always)]
    fn both(mut self, o: &Self, f: impl Fn(T, T) -> T) -> Self {
        self.variables = self.variables.max(o.variables);
        self.degree = self.degree.min(o.degree);
        for (a, b) in self.coefficients_mut().iter_mut().zip(&o.coefficients) {
            *a = f(*a, *b);
        }
        self
    }

    /// A constant that is to have derivatives by the variables of these.
    #[inline]
    fn constant_in(value: T, a: &Self, b: &Self) -> Self {
        let (variables, degree) = (a.variables.max(b.variables), a.degree.min(b.degree));
        Self { variables, degree, ..Self::constant(value) }
    }

    /// f(u) with the value f and `D f = s D u`, from the slope s, a function of u: `k f_k = sum j s_i u_j`.
    fn integral(self, value: T, slope: &Self) -> Self {
        let mut f = Self::constant_in(value, &self, slope);
        let m = f.monomials();
        for k in 1..f.len() {
            let mut sum = T::zero();
            for (i, j) in m.of(k) {
                sum += slope.coefficients[i] * self.coefficients[j] * m.degrees[j] as f64;
            }
            f.coefficients[k] = sum / T::constant(m.degrees[k] as f64);
        }
        f
    }

    /// Two functions f and g of u with `D f = g D u` and `D g = sign f D u`, from their values.
    fn pair(self, [f, g]: [T; 2], sign: f64) -> [Self; 2] {
        let mut both = super::both([f, g], |value| Self::constant_in(value, &self, &self));
        let m = self.monomials();
        for k in 1..self.len() {
            let mut sums = [T::zero(); 2];
            for (i, j) in m.of(k) {
                let u = self.coefficients[j] * m.degrees[j] as f64;
                sums[0] += both[1].coefficients[i] * u;
                sums[1] += both[0].coefficients[i] * u;
            }
            let degree = T::constant(m.degrees[k] as f64);
            both[0].coefficients[k] = sums[0] / degree;
            both[1].coefficients[k] = sums[1] * sign / degree;
        }
        both
    }

    /// Root with this value: `r_k = (x_k - sum r_i r_j) / 2 r_0`, over pairs without the constant.
    fn root(self, root: T) -> Self {
        let mut r = Self::constant_in(root, &self, &self);
        let m = self.monomials();
        for k in 1..self.len() {
            let mut rest = self.coefficients[k];
            for (i, j) in m.of(k).filter(|(i, _)| *i > 0) {
                rest -= r.coefficients[i] * r.coefficients[j];
            }
            r.coefficients[k] = rest / (root + root);
        }
        r
    }

    /// Power with a constant exponent p: `u D f = p f D u`, hence `k u_0 f_k = sum (p j - i) f_i u_j`.
    fn power(self, exponent: T) -> Self {
        let mut f = Self::constant_in(self.coefficients[0].pow(exponent), &self, &self);
        let m = self.monomials();
        for k in 1..self.len() {
            let mut sum = T::zero();
            for (i, j) in m.of(k) {
                let factor = exponent * m.degrees[j] as f64 + -(m.degrees[i] as f64);
                sum += factor * f.coefficients[i] * self.coefficients[j];
            }
            f.coefficients[k] = sum / (self.coefficients[0] * m.degrees[k] as f64);
        }
        f
    }

    /// Angle of the point (x, self), from its value and 1 / (x² + y²): `D a = (x D y - y D x) / (x² + y²)`.
    fn angle(self, x: Self, value: T, inverse_square: Self) -> Self {
        let mut turn = Self::constant_in(T::zero(), &self, &x);
        let m = turn.monomials();
        for k in 1..turn.len() {
            for (i, j) in m.of(k) {
                turn.coefficients[k] += (x.coefficients[i] * self.coefficients[j]
                    - self.coefficients[i] * x.coefficients[j])
                    * m.degrees[j] as f64;
            }
        }
        let mut angle = turn * inverse_square;
        for k in 1..turn.len() {
            angle.coefficients[k] = angle.coefficients[k] / T::constant(m.degrees[k] as f64);
        }
        angle.with_value(value)
    }

    fn with_value(mut self, value: T) -> Self {
        self.coefficients[0] = value;
        self
    }
}

impl Taylor<Interval> {
    /// These bounds of coefficients over a box, with those that follow from narrow ones at a point of it, from which
    /// the variables are `since`: `f_e in f_e(point) + sum (e_i + 1) f_{e + e_i} s_i`.
    #[must_use]
    pub(crate) fn narrowed(mut self, narrow: &Self, since: &[Interval]) -> Self {
        let m = self.monomials();
        for k in (0..self.len()).rev() {
            let Some(raised) = &m.raised[k] else { continue };
            let mut at = narrow.coefficients[k];
            for ((n, since), above) in since.iter().enumerate().zip(raised) {
                at += self.coefficients[*above] * f64::from(m.exponents[k][n] + 1) * *since;
            }
            // A coefficient without bounds may be undefined somewhere: it remains so.
            if at.is_bounded() && self.coefficients[k].is_bounded() {
                self.coefficients[k] = self.coefficients[k].and(at);
            }
        }
        self
    }
}

impl<T: Real> Add for Taylor<T> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.both(&o, |a, b| a + b)
    }
}

impl<T: Real> Sub for Taylor<T> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self.both(&o, |a, b| a - b)
    }
}

impl<T: Real> Mul for Taylor<T> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        // Most factors are constant.
        if o.is_still() {
            return self.times(o.coefficients[0]).to_degree(o.degree.into());
        }
        if self.is_still() {
            return o.times(self.coefficients[0]).to_degree(self.degree.into());
        }
        let mut f = Self::constant_in(T::zero(), &self, &o);
        let m = f.monomials();
        // Per coefficient, a bit: it is not zero.
        let [left, right] = super::both([&self, &o], |x| {
            (0..f.len()).fold(0_u64, |bits, k| bits | u64::from(!x.coefficients[k].is_zero()) << k)
        });
        for k in 0..f.len() {
            let mut sum = self.coefficients[k] * o.coefficients[0];
            // Most coefficients are zero where not every quantity depends on every variable.
            for (i, j) in m.of(k).filter(|(i, j)| (left >> i) & (right >> j) & 1 != 0) {
                sum += self.coefficients[i] * o.coefficients[j];
            }
            f.coefficients[k] = sum;
        }
        f
    }
}

impl<T: Real> Div for Taylor<T> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        // q_k = (a_k - sum q_i b_j) / b_0
        let mut q = Self::constant_in(T::zero(), &self, &o);
        let m = q.monomials();
        for k in 0..q.len() {
            let mut rest = self.coefficients[k];
            for (i, j) in m.of(k) {
                rest -= q.coefficients[i] * o.coefficients[j];
            }
            q.coefficients[k] = rest / o.coefficients[0];
        }
        q
    }
}

impl<T: Real> Neg for Taylor<T> {
    type Output = Self;
    fn neg(self) -> Self {
        self.each(|x| -x)
    }
}

impl<T: Real> Add<f64> for Taylor<T> {
    type Output = Self;
    fn add(mut self, o: f64) -> Self {
        self.coefficients[0] = self.coefficients[0] + o;
        self
    }
}

impl<T: Real> Mul<f64> for Taylor<T> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.each(|x| x * factor)
    }
}

impl<T: Real> AddAssign for Taylor<T> {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Real> SubAssign for Taylor<T> {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

/// Comparisons and tests use the value only.
impl<T: Real> Real for Taylor<T> {
    fn constant(x: f64) -> Self {
        Self::constant(T::constant(x))
    }
    fn value(self) -> f64 {
        self.coefficients[0].value()
    }
    fn decisive(self) -> f64 {
        self.coefficients[0].decisive()
    }
    fn vanishes(self) -> bool {
        self.coefficients[..self.len()].iter().all(|x| x.vanishes())
    }
    fn is_zero(self) -> bool {
        self.coefficients[..self.len()].iter().all(|x| x.is_zero())
    }
    fn order(self, o: Self) -> Option<Ordering> {
        self.coefficients[0].order(o.coefficients[0])
    }
    fn without_derivatives(self) -> Self {
        let unknown = T::constant(f64::NAN).without_derivatives();
        Self::of_value(self.coefficients[0].without_derivatives(), usize::from(self.variables), unknown)
    }
    fn sqrt(self) -> Self {
        self.root(self.coefficients[0].sqrt())
    }
    fn abs(self) -> Self {
        self.times(self.coefficients[0].sign())
    }
    fn sign_or(self, next: Self) -> Self {
        Self::constant(self.coefficients[0].sign_or(next.coefficients[0]))
    }
    fn exceeds(self, o: Self) -> bool {
        self.coefficients[0].exceeds(o.coefficients[0])
    }
    fn round(self) -> Self {
        Self::constant(self.coefficients[0].round())
    }
    fn select(self, o: Self, first: bool) -> Self {
        self.both(&o, |a, b| a.select(b, first))
    }
    fn map(self, function: Function) -> Self {
        let value = self.coefficients[0].map(function);
        let inverse = |x: Self| Self::constant(T::one()) / x;
        match function {
            Function::Sin => self.sin_cos_of_any().0,
            Function::Cos => self.sin_cos_of_any().1,
            Function::Tan => {
                let cos = self.sin_cos_of_any().1;
                self.integral(value, &inverse(cos * cos))
            }
            Function::Asin | Function::Acos => {
                let slope = inverse(((-self + 1.0) * (self + 1.0)).sqrt());
                self.integral(value, &if function == Function::Asin { slope } else { -slope })
            }
            Function::Atan => self.integral(value, &inverse(self * self + 1.0)),
            Function::Sinh => self.pair([value, self.coefficients[0].map(Function::Cosh)], 1.0)[0],
            Function::Cosh => self.pair([value, self.coefficients[0].map(Function::Sinh)], 1.0)[0],
            Function::Tanh => {
                let cosh = self.map(Function::Cosh);
                self.integral(value, &inverse(cosh * cosh))
            }
            // f and g are the same function.
            Function::Exp => self.pair([value, value], 1.0)[0],
            Function::Ln => self.integral(value, &inverse(self)),
            Function::Log10 => self.integral(value, &(inverse(self) * std::f64::consts::LOG10_E)),
            Function::Sqrt => self.root(value),
            Function::Abs => self.abs(),
        }
    }
    fn pow(self, exponent: Self) -> Self {
        if !exponent.is_still() {
            // xᵖ = exp(p ln x), for a positive base
            return (exponent * self.map(Function::Ln)).map(Function::Exp);
        }
        match Real::value(exponent) {
            p if p.fract() == 0.0 && p.abs() <= f64::from(i32::MAX) => self.powi(p as i32),
            _ => self.power(exponent.coefficients[0]),
        }
    }
    fn hypot(self, o: Self) -> Self {
        (self * self + o * o).root(self.coefficients[0].hypot(o.coefficients[0]))
    }
    fn larger(self, o: Self) -> Self {
        let most = self.coefficients[0].larger(o.coefficients[0]);
        if self.coefficients[0].exceeds(o.coefficients[0]) {
            self
        } else if o.coefficients[0].exceeds(self.coefficients[0]) {
            o
        } else {
            // Equal, or not the same everywhere: the derivatives are not known.
            let variables = self.variables.max(o.variables);
            Self::of_value(most, usize::from(variables), T::constant(f64::NAN))
        }
    }
    fn angle_near(self, cos: Self, near: Self) -> Self {
        // Whole turns are constant. The angle is counted in a frame that is turned to `near`, where it does not jump.
        let value = self.coefficients[0].angle_near(cos.coefficients[0], near.coefficients[0]);
        let slope = Self::constant(T::one()) / (self * self + cos * cos);
        self.angle(cos, value, slope)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.coefficients[0].sin_cos();
        // D sin = cos D u, D cos = -sin D u
        let [sin, cos] = self.pair([sin, cos], -1.0);
        (sin, cos)
    }
    fn sin_cos_of_any(self) -> (Self, Self) {
        let (sin, cos) = self.coefficients[0].sin_cos_of_any();
        let [sin, cos] = self.pair([sin, cos], -1.0);
        (sin, cos)
    }
    fn atan2(self, x: Self) -> Self {
        let slope = Self::constant(T::one()) / (self * self + x * x);
        self.angle(x, self.coefficients[0].atan2(x.coefficients[0]), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Jet;

    /// A few roundings of each of up to some hundred products.
    const TOLERANCE: f64 = 1e-11;

    type Of<T> = fn(T, T) -> T;
    type Nested = Jet<Jet<f64, 4>, 4>;
    type Row = (&'static str, Of<Taylor<f64>>, Of<Nested>, Of<Taylor<Interval>>);

    macro_rules! operations {
        ($($name:literal: |$x:ident, $y:ident| $of:expr;)*) => {
            [$((
                $name,
                (|$x, $y| $of) as Of<Taylor<f64>>,
                (|$x, $y| $of) as Of<Nested>,
                (|$x, $y| $of) as Of<Taylor<Interval>>,
            )),*]
        };
    }

    /// Names with the function over Taylor numbers, over nested jets, and over Taylor numbers of intervals.
    fn every_operation() -> impl IntoIterator<Item = Row> {
        operations! {
            "add": |x, y| x + y;
            "sub": |x, y| x - y;
            "mul": |x, y| x * y;
            "div": |x, y| x / y;
            "neg": |x, y| -x * y;
            "numbers": |x, y| (x + 0.3) * -1.7 + y;
            "sqrt": |x, y| Real::sqrt(x * y);
            "abs": |x, y| Real::abs(-x * y);
            "hypot": |x, y| Real::hypot(x, y);
            "atan2": |x, y| Real::atan2(x * y, -y);
            "angle_near": |x, y| (x * y).angle_near(-x, Real::constant(13.0));
            "pow": |x, y| Real::pow(x, y);
            "powf": |x, y| Real::powf(x * y, 2.6);
            "powi": |x, y| Real::powi(x * y, 3);
            "powi -2": |x, y| Real::powi(x * y, -2);
            "sin cos": |x, y| { let (s, c) = Real::sin_cos(x * y); s * c * c };
            "of any": |x, y| { let (s, c) = (x * y).sin_cos_of_any(); s + c * y };
            "larger": |x, y| (x + 1.0).larger(y * -1.0);
            "Sin": |x, y| (x * y).map(Function::Sin);
            "Cos": |x, y| (x * y).map(Function::Cos);
            "Tan": |x, y| (x * y).map(Function::Tan);
            "Asin": |x, y| (x * y).map(Function::Asin);
            "Acos": |x, y| (x * y).map(Function::Acos);
            "Atan": |x, y| (x * y).map(Function::Atan);
            "Sinh": |x, y| (x * y).map(Function::Sinh);
            "Cosh": |x, y| (x * y).map(Function::Cosh);
            "Tanh": |x, y| (x * y).map(Function::Tanh);
            "Exp": |x, y| (x * y).map(Function::Exp);
            "Ln": |x, y| (x * y).map(Function::Ln);
            "Log10": |x, y| (x * y).map(Function::Log10);
            "Sqrt": |x, y| (x * y).map(Function::Sqrt);
            "Abs": |x, y| (x * y).map(Function::Abs);
        }
    }

    #[test]
    fn mixed_derivatives_agree_with_nested_jets() {
        for (name, ours, nested, _) in every_operation() {
            let (x0, y0) = (0.7, 0.9);
            let found = ours(Taylor::variable(x0, 0, 2), Taylor::variable(y0, 1, 2));
            // The outer jet is along x, the inner one along y.
            let x = Jet([x0, 1.0, 0.0, 0.0].map(Jet::constant));
            let expected = nested(x, Jet::constant(Jet::time(y0)));
            for a in 0..4_u8 {
                for b in (0..4_u8).filter(|b| a <= 1 || *b <= 1) {
                    let expected = expected.0[usize::from(a)].0[usize::from(b)];
                    let x = found.derivative([a, b, 0]);
                    let same = (x - expected).abs() <= TOLERANCE * (1.0 + expected.abs());
                    assert!(same, "{name}, order {a} {b}: {x} is not {expected}");
                }
            }
        }
    }

    #[test]
    fn fourth_derivatives_are_those_of_third_ones() {
        // (f(x + h) - f(x - h)) / 2h deviates from f' by a multiple of h^2.
        const STEP: f64 = 1e-4;
        for (name, ours, ..) in every_operation() {
            let at =
                |dx: f64, dy: f64| ours(Taylor::variable(0.7 + dx, 0, 2), Taylor::variable(0.9 + dy, 1, 2));
            for (order, along, lower) in [
                ([4, 0, 0], [1.0, 0.0], [3, 0, 0]),
                ([0, 4, 0], [0.0, 1.0], [0, 3, 0]),
                ([4, 1, 0], [0.0, 1.0], [4, 0, 0]),
                ([1, 4, 0], [1.0, 0.0], [0, 4, 0]),
            ] {
                let [dx, dy] = along.map(|a: f64| a * STEP);
                let [after, before] = [at(dx, dy), at(-dx, -dy)].map(|f| f.derivative(lower));
                let difference = (after - before) / (2.0 * STEP);
                let exact = at(0.0, 0.0).derivative(order);
                let same = (difference - exact).abs() <= 1e-4 * (1.0 + exact.abs());
                assert!(same, "{name} {order:?}: {exact} is not {difference}");
            }
        }
    }

    #[test]
    fn bounds_over_boxes_contain_the_derivatives_inside() {
        for (name, ours, _, over) in every_operation() {
            let [x, y] = [[0.7, 0.72], [0.88, 0.9]].map(|[from, to]| Interval::between(from, to));
            let bounds = over(Taylor::variable(x, 0, 2), Taylor::variable(y, 1, 2));
            for (x, y) in [(0.7, 0.88), (0.71, 0.89), (0.72, 0.9), (0.703, 0.899)] {
                let at = ours(Taylor::variable(x, 0, 2), Taylor::variable(y, 1, 2));
                for (k, (bounds, at)) in bounds.coefficients().iter().zip(at.coefficients()).enumerate() {
                    assert!(bounds.is_bounded(), "{name} {k}");
                    let hair = 1e-12 * (1.0 + at.abs());
                    assert!(bounds.low - hair <= *at && *at <= bounds.high + hair, "{name} {k}: {at}");
                }
            }
        }
    }

    #[test]
    fn three_variables_have_44_monomials() {
        let [x, y, z] = [0, 1, 2].map(|k| Taylor::variable([2.0, 3.0, 5.0][k], k, 3));
        let f = x * x * x * x * y * z;
        assert_eq!(f.derivative([4, 1, 1]), 24.0);
        assert_eq!(f.derivative([1, 1, 1]), 32.0);
        assert_eq!(f.derivative([0, 0, 1]), 48.0);
        for (n, counts) in COEFFICIENTS.iter().enumerate() {
            for (degree, count) in counts.iter().enumerate() {
                assert_eq!(degrees(n).iter().filter(|d| **d <= degree).count(), *count, "{n} variables");
            }
        }
        assert_eq!(degrees(1), &[0, 1, 2, 3, 4]);
    }
}
