//! The functions of one number, each with its name, its value and its derivatives in one row.

use super::Real;

/// Generates [`Function`] from rows: a variant, its name in expressions, the function of an `f64`, and its first three
/// derivatives at `x`, where its value is `y`.
macro_rules! functions {
    (|$x:ident, $y:ident| $($(#[$doc:meta])* $function:ident $name:literal, $of:expr, $derivatives:expr;)*) => {
        /// A function of one number, with its name in expressions and its derivatives.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Function {
            $($(#[$doc])* $function,)*
        }

        impl Function {
            /// All functions, in the order in which help lists them.
            pub const ALL: &[Self] = &[$(Self::$function),*];

            /// Name in expressions.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$function => $name,)*
                }
            }

            /// Value at `x`, computed by the standard library.
            pub(super) fn of(self, x: f64) -> f64 {
                match self {
                    $(Self::$function => $of(x),)*
                }
            }

            /// First three derivatives at `x`, where its value is `y`.
            #[inline(always)]
            pub(super) fn derivatives<T: Real>(self, $x: T, $y: T) -> [T; 3] {
                match self {
                    $(Self::$function => $derivatives,)*
                }
            }
        }
    };
}

functions! { |x, y|
    /// Sine of an angle, rad.
    Sin "sin", f64::sin, {
        let cos = x.map(Self::Cos);
        [cos, -y, -cos]
    };
    /// Cosine of an angle, rad.
    Cos "cos", f64::cos, {
        let sin = x.map(Self::Sin);
        [-sin, -y, sin]
    };
    /// Tangent of an angle, rad.
    Tan "tan", f64::tan, {
        let d = y * y + 1.0;
        let dd = y * d * 2.0;
        [d, dd, (d * d + y * dd) * 2.0]
    };
    /// Arc sine, rad in [-pi/2, pi/2].
    Asin "asin", f64::asin, of_asin(x);
    /// Arc cosine, rad in [0, pi].
    Acos "acos", f64::acos, {
        let [d, dd, ddd] = of_asin(x);
        [-d, -dd, -ddd]
    };
    /// Arc tangent, rad in [-pi/2, pi/2].
    Atan "atan", f64::atan, {
        let d = T::one() / (x * x + 1.0);
        [d, x * d * d * -2.0, (x * x * 6.0 + -2.0) * d * d * d]
    };
    /// Hyperbolic sine.
    Sinh "sinh", f64::sinh, {
        let cosh = x.map(Self::Cosh);
        [cosh, y, cosh]
    };
    /// Hyperbolic cosine.
    Cosh "cosh", f64::cosh, {
        let sinh = x.map(Self::Sinh);
        [sinh, y, sinh]
    };
    /// Hyperbolic tangent.
    Tanh "tanh", f64::tanh, {
        // Not 1 - tanh², which loses all digits where tanh is close to 1.
        let cosh = x.map(Self::Cosh);
        let d = T::one() / (cosh * cosh);
        let dd = y * d * -2.0;
        [d, dd, (d * d + y * dd) * -2.0]
    };
    /// Exponential function.
    Exp "exp", f64::exp, [y; 3];
    /// Natural logarithm.
    Ln "ln", f64::ln, of_ln(x);
    /// Logarithm to base 10.
    Log10 "log10", f64::log10, {
        let [d, dd, ddd] = of_ln(x);
        let per = 1.0 / std::f64::consts::LN_10;
        [d * per, dd * per, ddd * per]
    };
    /// Square root.
    Sqrt "sqrt", f64::sqrt, {
        let (d, inverse) = (T::constant(0.5) / y, T::one() / x);
        [d, d * inverse * -0.5, d * inverse * inverse * 0.75]
    };
    /// Absolute value.
    Abs "abs", f64::abs, [x.sign(), T::zero(), T::zero()];
}

/// Derivatives of the arc sine: s, x s³, (1 + 2 x²) s⁵ with s = 1/√(1 - x²).
#[inline(always)]
fn of_asin<T: Real>(x: T) -> [T; 3] {
    // Factored, because 1 - x² loses digits where |x| is close to 1.
    let s2 = T::one() / ((-x + 1.0) * (x + 1.0));
    let s = s2.sqrt();
    [s, x * s * s2, (x * x * 2.0 + 1.0) * s * s2 * s2]
}

/// Derivatives of the natural logarithm.
#[inline(always)]
fn of_ln<T: Real>(x: T) -> [T; 3] {
    let inverse = T::one() / x;
    [inverse, -inverse * inverse, inverse * inverse * inverse * 2.0]
}
