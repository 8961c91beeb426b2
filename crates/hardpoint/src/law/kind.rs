//! Interface of the kinds of laws; one file per kind.

use std::fmt;

use crate::expression::{Range, Stretch};
use crate::linalg::Segment;
use crate::number::{Interval, Jet, Real};

use super::breaks::Break;
use super::parameter::{Parameter, ParameterKind, Seed};

/// A kind of law.
///
/// The time is given as a jet. If it runs backwards (derivative -1), a law uses the branch that is active just *before*
/// the instant, so that one-sided limits need no code of their own.
pub(super) trait LawKind: fmt::Display {
    /// Value and time derivatives at a time, with the derivative with respect to one parameter if a seed is given.
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N>;

    /// All parameters, in the units in which the law was written.
    fn parameters(&self) -> Vec<Parameter>;

    /// Number of parameters.
    fn parameter_count(&self) -> usize;

    /// Kind of a parameter, as in [`parameters`](Self::parameters), without building the list.
    fn parameter_kind(&self, parameter: usize) -> ParameterKind;

    /// Sets the value of a parameter, in the unit in which the law was written.
    fn set(&mut self, parameter: usize, value: f64);

    /// Bounds of f and of its rate over the closed interval between two times; unbounded if it is undefined or jumps
    /// anywhere in it.
    fn over(&self, from: f64, to: f64) -> Stretch;

    /// Bounds of f and of its first three rates over an interval of time, with outward rounding. A rate is unbounded if
    /// one of a lower order jumps anywhere inside it, and all are if f is undefined.
    fn enclosure(&self, over: Interval) -> Jet<Interval, 4>;

    /// Polynomial pieces of a spline; empty for other laws.
    fn segments(&self) -> &[Segment] {
        &[]
    }

    /// Appends the breaks between `from` and `to` at which the value or the first two derivatives may jump.
    fn find_breaks(&self, _from: f64, _to: f64, _breaks: &mut Vec<Break>) {}
}

/// Declares the kinds of laws, each a type of a module; those that callers fill in are public.
macro_rules! kinds {
    ($($module:ident: $public:vis $kind:ident),* $(,)?) => {
        $($public use $module::$kind;)*

        /// A law of any kind.
        #[derive(Clone, PartialEq)]
        enum AnyLaw {
            $($kind($kind),)*
        }

        $(impl From<$kind> for AnyLaw {
            fn from(law: $kind) -> Self {
                Self::$kind(law)
            }
        })*

        impl LawKind for AnyLaw {
            #[inline(always)]
            fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
                match self { $(Self::$kind(law) => law.at(time, seed)),* }
            }

            fn parameters(&self) -> Vec<Parameter> {
                match self { $(Self::$kind(law) => law.parameters()),* }
            }

            fn parameter_count(&self) -> usize {
                match self { $(Self::$kind(law) => law.parameter_count()),* }
            }

            fn parameter_kind(&self, parameter: usize) -> ParameterKind {
                match self { $(Self::$kind(law) => law.parameter_kind(parameter)),* }
            }

            fn set(&mut self, parameter: usize, value: f64) {
                match self { $(Self::$kind(law) => law.set(parameter, value)),* }
            }

            fn over(&self, from: f64, to: f64) -> Stretch {
                match self { $(Self::$kind(law) => law.over(from, to)),* }
            }

            fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
                match self { $(Self::$kind(law) => law.enclosure(over)),* }
            }

            fn segments(&self) -> &[crate::linalg::Segment] {
                match self { $(Self::$kind(law) => law.segments()),* }
            }

            fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
                match self { $(Self::$kind(law) => law.find_breaks(from, to, breaks)),* }
            }
        }

        impl fmt::Display for AnyLaw {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self { $(Self::$kind(law) => law.fmt(f)),* }
            }
        }
    };
}
pub(super) use kinds;

/// Implements the parameters of a law that are its fields: their names, in this order, and their kinds.
macro_rules! parameters {
    ($($field:ident: $kind:expr),* $(,)?) => {
        fn parameters(&self) -> Vec<Parameter> {
            vec![$(parameter(stringify!($field), self.$field, $kind)),*]
        }

        fn parameter_count(&self) -> usize {
            [$($kind),*].len()
        }

        fn parameter_kind(&self, parameter: usize) -> ParameterKind {
            [$($kind),*][parameter]
        }

        fn set(&mut self, parameter: usize, value: f64) {
            *[$(&mut self.$field),*][parameter] = value;
        }
    };
}
pub(super) use parameters;

/// True if a time is before an instant; at the instant itself, if the time runs backwards. NaN is neither before nor
/// after.
#[inline(always)]
pub(super) fn is_before<T: Real, const N: usize>(time: &Jet<T, N>, instant: f64) -> bool {
    let t = time.value().value();
    t < instant || t == instant && time.d().value() < 0.0
}

/// True if a time is after an instant; at the instant itself, unless the time runs backwards.
#[inline(always)]
pub(super) fn is_after<T: Real, const N: usize>(time: &Jet<T, N>, instant: f64) -> bool {
    let t = time.value().value();
    t > instant || t == instant && !(time.d().value() < 0.0)
}

/// Bounds of a monotone law whose speed is largest at the time `middle`.
pub(super) fn one_way(law: &impl LawKind, middle: f64, from: f64, to: f64) -> Stretch {
    let at = |t: f64| law.at(Jet::<f64, 4>::time(t), None);
    let [start, fastest, end] = [at(from), at(middle.clamp(from, to)), at(to)];
    let rate = Range::between(start.d(), end.d()).or(Range::exactly(fastest.d()));
    Stretch { value: Range::between(start.value(), end.value()), rate }
}

/// Smallest bounds that contain those of two pieces that follow each other. The second rate may jump between them, so
/// that the third is unbounded.
pub(super) fn either(a: Jet<Interval, 4>, b: Jet<Interval, 4>) -> Jet<Interval, 4> {
    let [f, d, dd, _] = std::array::from_fn(|n| a.0[n].or(b.0[n]));
    Jet([f, d, dd, Interval::ENTIRE])
}

/// Bounds over an interval of time of a law in pieces, whose speed is continuous. Piece k ends where piece k + 1
/// begins, at `ends[k]`; the last one has no end. A piece of which only an end is in the interval is left out: its
/// value there is that of its neighbour.
pub(super) fn in_pieces(
    over: Interval,
    ends: &[f64],
    piece: impl Fn(usize, Interval) -> Jet<Interval, 4>,
) -> Jet<Interval, 4> {
    let mut all: Option<Jet<Interval, 4>> = None;
    for k in 0..=ends.len() {
        let start = k.checked_sub(1).map_or(f64::NEG_INFINITY, |before| ends[before]);
        let end = ends.get(k).copied().unwrap_or(f64::INFINITY);
        let part = Interval { low: over.low.max(start), high: over.high.min(end) };
        if part.low < part.high || over.is_point() && part.is_point() {
            let bounds = piece(k, part);
            all = Some(all.map_or(bounds, |all| either(all, bounds)));
        }
    }
    all.unwrap_or(Jet([Interval::ENTIRE; 4]))
}

/// Writes a sum in the usual notation: signs between the terms, zero terms omitted, `0` if none is left.
pub(super) fn write_sum(f: &mut fmt::Formatter<'_>, terms: &[(f64, &str)]) -> fmt::Result {
    let mut is_first = true;
    for &(factor, of) in terms.iter().filter(|(factor, _)| *factor != 0.0) {
        let sign = match (is_first, factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let size = factor.abs();
        match of {
            "" => write!(f, "{sign}{size}")?,
            _ if size == 1.0 => write!(f, "{sign}{of}")?,
            _ => write!(f, "{sign}{size}*{of}")?,
        }
        is_first = false;
    }
    if is_first { f.write_str("0") } else { Ok(()) }
}
