//! Metrics: one number for a whole curve.

use crate::number::Real;

use super::{CaseId, Dimension, Model, OutputSource};

/// One number that sums an output up over the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// Name.
    pub name: String,
    /// Output that the metric reduces.
    pub of: OutputSource,
    /// Over which output; over time where there is none.
    pub over: Option<OutputSource>,
    /// Reduction.
    pub take: Reduction,
    /// The part of the curve that counts: from where to where its abscissa goes, in SI; all of it where there is none.
    pub window: Option<[f64; 2]>,
    /// Case whose motion is reduced; `None` for each of them.
    pub case: Option<CaseId>,
}

/// The reductions: what they hold besides the curve, name in model files, part of the curve, unit, whether the value
/// has the direction of the output, and description. With the value of its curve (`take` in `run/metric.rs`) one is
/// complete; one of a further integral has its formulas in `run/quadrature.rs`.
macro_rules! reductions {
    ($(
        $(#[doc = $doc:literal])* $kind:ident $(($held:ident: $type:ty))? $name:literal {
            keys: $keys:ident, part: $part:expr, unit: $unit:ident, is_directed: $directed:literal,
        } |$words:pat_param| $says:expr;
    )*) => {
        /// Reduction of a curve to one number, whose arguments are in SI. Formulas: `docs/measures.md`.
        ///
        /// The points of a target are `[abscissa, value]`; that of an `rms` has straight lines between and beyond them,
        /// and is zero where there are none.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Reduction {
            $($(#[doc = $doc])* $kind $(($type))?,)*
        }

        impl Reduction {
            /// All reductions as model files write them, and what they are.
            pub const WORDS: &[(&str, &str)] = &[$(($name, concat!($($doc),*).trim_ascii())),*];

            /// All of them, in the order of [`WORDS`](Self::WORDS).
            pub const TYPES: &[ReductionType] = &[$(ReductionType {
                name: $name,
                keys: ReductionKeys::$keys,
                of: |_arguments| Self::$kind $((<$type as Argument>::of(_arguments)))?,
            }),*];

            /// As model files write it.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$kind { .. } => $name,)* }
            }

            /// Returns the part of the curve that it is taken of.
            pub fn part(&self) -> CurvePart<'_> {
                match self { $(Self::$kind $(($held))? => $part,)* }
            }

            /// Returns its unit, from those of the output and the abscissa.
            pub fn unit(&self) -> ReductionUnit {
                match self { $(Self::$kind { .. } => ReductionUnit::$unit,)* }
            }

            /// True if it is positive in the direction in which its output is; a size has no direction.
            pub fn is_directed(&self) -> bool {
                match self { $(Self::$kind { .. } => $directed,)* }
            }

            /// Returns it with other numbers for those of the abscissa and of the output.
            #[must_use]
            pub fn converted(&self, x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64) -> Self {
                let _numbers = [x, y];
                match self { $(Self::$kind $(($held))? => Self::$kind $(($held.converted(_numbers)))?,)* }
            }

            /// The target of an `rms` or `rms_at_points`, empty where an `rms` is beyond zero.
            pub fn target(&self) -> Option<&[[f64; 2]]> {
                match self {
                    $(Self::$kind $(($held))? => {
                        let targets: &[Option<&[[f64; 2]]>] = &[$($held.target())?];
                        targets.first().copied().flatten()
                    })*
                }
            }

            fn describe(&self, words: &MetricWords<'_>) -> String {
                match self {
                    $(#[allow(unused_variables, reason = "not every argument is said")]
                    Self::$kind $(($held))? => { let $words = words; $says })*
                }
            }
        }
    };
}

reductions! {
    /// The least value.
    Least "min" {
        keys: Window, part: CurvePart::Extrema(&[-1.0]), unit: Output, is_directed: true,
    } |w| format!("least {}{}", w.of, w.within);

    /// The greatest value.
    Greatest "max" {
        keys: Window, part: CurvePart::Extrema(&[1.0]), unit: Output, is_directed: true,
    } |w| format!("greatest {}{}", w.of, w.within);

    /// The greatest less the least value.
    Range "range" {
        keys: Window, part: CurvePart::Extrema(&[1.0, -1.0]), unit: Output, is_directed: false,
    } |w| format!("range of {} (max - min){}", w.of, w.within);

    /// The value at the last less that at the first output time.
    Change "change" {
        keys: Ends, part: CurvePart::Ends, unit: Output, is_directed: true,
    } |w| format!("change of {} from the first to the last output time", w.of);

    /// The mean over time, or over the travel of the abscissa to and fro.
    Mean "mean" {
        keys: Window, part: CurvePart::Path(PathIntegral::Mean), unit: Output, is_directed: true,
    } |w| format!("mean of {}{}{}", w.of, w.mean_over, w.within);

    /// The integral over the abscissa: of a power over time the work in J, and of a force or a moment over its way or
    /// angle.
    Integral "integral" {
        keys: Window, part: CurvePart::Path(PathIntegral::Integral), unit: OutputTimesAbscissa, is_directed: true,
    } |w| format!("integral of {} over {}{}", w.of, w.over, w.within);

    /// The root of the mean, as for `mean`, of the squared deviation from the target.
    Rms(target: Vec<[f64; 2]>) "rms" {
        keys: Target, part: CurvePart::Path(PathIntegral::Rms(target)), unit: Output, is_directed: false,
    } |w| {
        let beyond = if target.is_empty() { "" } else { " beyond its target" };
        format!("root mean square of {}{beyond}{}{}", w.of, w.mean_over, w.within)
    };

    /// The root mean square of the deviation from the target's points, each where the abscissa first has its value.
    RmsAtPoints(target: Vec<[f64; 2]>) "rms_at_points" {
        keys: Points, part: CurvePart::Points(target), unit: Output, is_directed: false,
    } |w| format!("root mean square of {} beyond the points of its target{}{}", w.of, w.mean_over, w.within);

    /// The value where the abscissa first is `at`.
    Value(at: f64) "value" {
        keys: Place, part: CurvePart::Place { at: *at, is_slope: false }, unit: Output, is_directed: true,
    } |w| format!("{} where {} is {}", w.of, w.over, (w.place)(*at));

    /// The change per change of the abscissa where that first is `at`.
    Slope(at: f64) "slope" {
        keys: Place, part: CurvePart::Place { at: *at, is_slope: true }, unit: OutputPerAbscissa, is_directed: true,
    } |w| format!("slope of {} over {} at {}", w.of, w.over, (w.place)(*at));
}

/// Part of a curve that a reduction is taken of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurvePart<'r> {
    /// Extrema, by their signs: 1 for the maximum, -1 for the minimum.
    Extrema(&'static [f64]),
    /// The values at the first and at the last output time.
    Ends,
    /// The whole path.
    Path(PathIntegral<'r>),
    /// The place where the abscissa first is this.
    Place {
        /// Abscissa.
        at: f64,
        /// True for the slope of the curve there, false for its value.
        is_slope: bool,
    },
    /// The places where the abscissa first is that of each of these points `[abscissa, value]`.
    Points(&'r [[f64; 2]]),
}

/// Integral over the path of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathIntegral<'r> {
    /// Mean over the travel of the abscissa, in both directions.
    Mean,
    /// Integral over the abscissa: backward travel counts negative.
    Integral,
    /// Root of the mean square of the difference from this target.
    Rms(&'r [[f64; 2]]),
}

/// Unit of a reduction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReductionUnit {
    /// That of the output.
    Output,
    /// That of the output, times that of the abscissa.
    OutputTimesAbscissa,
    /// That of the output, per that of the abscissa.
    OutputPerAbscissa,
}

/// Type of reduction, by its name in model files.
#[derive(Clone, Copy, Debug)]
pub struct ReductionType {
    /// Name.
    pub name: &'static str,
    /// Keys that it has besides the output.
    pub keys: ReductionKeys,
    /// Returns a reduction of this type with these arguments.
    pub of: fn(ReductionArguments) -> Reduction,
}

/// Keys of a metric that a reduction has besides the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReductionKeys {
    /// The abscissa, and a window of it.
    Window,
    /// These, and perhaps a target curve.
    Target,
    /// These, and points of a target.
    Points,
    /// The abscissa, and a place of it.
    Place,
    /// None: it is taken at the first and at the last output time.
    Ends,
}

/// Arguments of a reduction, with those of other types.
#[derive(Clone, Debug, Default)]
pub struct ReductionArguments {
    /// Place on the abscissa.
    pub at: f64,
    /// Points `[abscissa, value]` of a target.
    pub target: Vec<[f64; 2]>,
}

/// Argument of a reduction.
trait Argument {
    fn of(arguments: ReductionArguments) -> Self;
    /// Target, if the argument is one.
    fn target(&self) -> Option<&[[f64; 2]]>;
    /// Returns it with other numbers for those of abscissa and output.
    fn converted(&self, numbers: [&dyn Fn(f64) -> f64; 2]) -> Self;
}

impl Argument for f64 {
    fn of(arguments: ReductionArguments) -> Self {
        arguments.at
    }

    fn target(&self) -> Option<&[[f64; 2]]> {
        None
    }

    fn converted(&self, [x, _]: [&dyn Fn(f64) -> f64; 2]) -> Self {
        x(*self)
    }
}

impl Argument for Vec<[f64; 2]> {
    fn of(arguments: ReductionArguments) -> Self {
        arguments.target
    }

    fn target(&self) -> Option<&[[f64; 2]]> {
        Some(self)
    }

    fn converted(&self, [x, y]: [&dyn Fn(f64) -> f64; 2]) -> Self {
        self.iter().map(|p| [x(p[0]), y(p[1])]).collect()
    }
}

/// Parts of the description of a metric.
struct MetricWords<'a> {
    of: String,
    /// The abscissa.
    over: String,
    /// The abscissa of a mean; empty for time.
    mean_over: String,
    /// The window; empty for the whole curve.
    within: String,
    /// Formats a place on the abscissa.
    place: &'a dyn Fn(f64) -> String,
}

impl Reduction {
    /// Signs of the extrema that it is taken of: 1 for a maximum, -1 for a minimum.
    pub fn extrema(&self) -> &'static [f64] {
        match self.part() {
            CurvePart::Extrema(signs) => signs,
            CurvePart::Ends | CurvePart::Path(_) | CurvePart::Place { .. } | CurvePart::Points(_) => &[],
        }
    }

    /// The integral over the path that it is, if it is one.
    pub fn integral(&self) -> Option<PathIntegral<'_>> {
        match self.part() {
            CurvePart::Path(integral) => Some(integral),
            CurvePart::Extrema(_) | CurvePart::Ends | CurvePart::Place { .. } | CurvePart::Points(_) => None,
        }
    }

    /// Places of the abscissa that it is taken at.
    pub fn places(&self) -> Vec<f64> {
        match self.part() {
            CurvePart::Place { at, .. } => vec![at],
            CurvePart::Points(points) => points.iter().map(|p| p[0]).collect(),
            CurvePart::Extrema(_) | CurvePart::Ends | CurvePart::Path(_) => Vec::new(),
        }
    }

    /// True if it is taken at places of the abscissa, not of the whole curve.
    pub fn is_local(&self) -> bool {
        match self.part() {
            CurvePart::Place { .. } | CurvePart::Points(_) => true,
            CurvePart::Extrema(_) | CurvePart::Ends | CurvePart::Path(_) => false,
        }
    }

    /// The target, if there are points of it.
    pub fn target_points(&self) -> Option<&[[f64; 2]]> {
        self.target().filter(|target| !target.is_empty())
    }
}

impl Metric {
    /// The target curve at an abscissa, in SI; `None` where the metric has none, or where the abscissa is beyond its
    /// window.
    pub fn target_at(&self, at: f64) -> Option<f64> {
        let counts = self.window.is_none_or(|[low, high]| low <= at && at <= high);
        self.take.target_points().filter(|_| counts).map(|target| on_target(target, at))
    }
}

/// The target at an abscissa: straight lines between its points and beyond them, zero where there are none.
pub(crate) fn on_target<T: Real>(target: &[[f64; 2]], at: T) -> T {
    match target {
        [] => T::zero(),
        [[_, only]] => T::constant(*only),
        _ => {
            let k = target[1..target.len() - 1].iter().take_while(|p| p[0] < at.value()).count();
            let ([x0, y0], [x1, y1]) = (target[k], target[k + 1]);
            T::constant(y0) + (at - T::constant(x0)) * T::constant((y1 - y0) / (x1 - x0))
        }
    }
}

impl Model {
    /// Dimension of a metric's abscissa.
    pub fn abscissa(&self, metric: &Metric) -> Dimension {
        metric.over.map_or(Dimension::NUMBER.rate(-1), |over| self.dimension(over))
    }

    /// Dimension of a metric's value.
    pub fn metric_dimension(&self, metric: &Metric) -> Dimension {
        let of = self.dimension(metric.of);
        match metric.take.unit() {
            ReductionUnit::Output => of,
            ReductionUnit::OutputTimesAbscissa => of.times(self.abscissa(metric)),
            ReductionUnit::OutputPerAbscissa => of.over(self.abscissa(metric)),
        }
    }

    /// Describes a metric in words: `slope of toe over wheel_travel at 0 mm`. The functions format a place on the
    /// abscissa, in SI, without and with its unit.
    pub fn describe_metric(
        &self,
        metric: &Metric,
        number: &dyn Fn(f64) -> String,
        place: &dyn Fn(f64) -> String,
    ) -> String {
        let over = metric.over.map_or("time".into(), |over| self.output_name(over));
        let within = metric.window.map_or(String::new(), |[low, high]| {
            format!(" where {over} is {} to {}", number(low), place(high))
        });
        let mean_over = if metric.over.is_some() { format!(" over {over}") } else { String::new() };
        metric.take.describe(&MetricWords { of: self.output_name(metric.of), over, mean_over, within, place })
    }
}
