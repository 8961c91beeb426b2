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

/// Reduction of a curve to one number. Formulas: `docs/measures.md`.
#[derive(Clone, Debug, PartialEq)]
pub enum Reduction {
    /// The least value.
    Least,
    /// The greatest value.
    Greatest,
    /// The greatest less the least value.
    Range,
    /// The value at the last less that at the first output time.
    Change,
    /// The mean.
    Mean,
    /// The integral over the abscissa, which counts down where that goes back: of a power over time, or of a force over
    /// a way, the work.
    Integral,
    /// The root of the mean square of what is left beyond a target curve: points `[abscissa, value]`, in SI, with
    /// straight lines between and beyond them; beyond zero where there are none.
    Rms(Vec<[f64; 2]>),
    /// The root of the mean square of what is left beyond points `[abscissa, value]`, in SI, where the abscissa first
    /// is that of each: each point counts once, and nothing between them.
    RmsAtPoints(Vec<[f64; 2]>),
    /// The value where the abscissa first is this, in SI.
    Value(f64),
    /// The change per change of the abscissa there.
    Slope(f64),
}

impl Reduction {
    /// The names of all of them, as model files write them.
    pub const NAMES: [&str; 10] =
        ["min", "max", "range", "change", "mean", "integral", "rms", "rms_at_points", "value", "slope"];

    /// As model files write it.
    pub fn name(&self) -> &'static str {
        Self::NAMES[match self {
            Self::Least => 0,
            Self::Greatest => 1,
            Self::Range => 2,
            Self::Change => 3,
            Self::Mean => 4,
            Self::Integral => 5,
            Self::Rms(_) => 6,
            Self::RmsAtPoints(_) => 7,
            Self::Value(_) => 8,
            Self::Slope(_) => 9,
        }]
    }

    /// The target of an `rms` or `rms_at_points`, empty where an `rms` is beyond zero.
    pub fn target(&self) -> Option<&[[f64; 2]]> {
        match self {
            Self::Rms(target) | Self::RmsAtPoints(target) => Some(target),
            Self::Least
            | Self::Greatest
            | Self::Range
            | Self::Change
            | Self::Mean
            | Self::Integral
            | Self::Value(_)
            | Self::Slope(_) => None,
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
        match metric.take {
            Reduction::Slope(_) => of.over(self.abscissa(metric)),
            Reduction::Integral => of.times(self.abscissa(metric)),
            Reduction::Least
            | Reduction::Greatest
            | Reduction::Range
            | Reduction::Change
            | Reduction::Mean
            | Reduction::Rms(_)
            | Reduction::RmsAtPoints(_)
            | Reduction::Value(_) => of,
        }
    }
}
