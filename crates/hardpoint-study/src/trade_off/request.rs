//! Request for a trade-off.

use hardpoint::model::{Model, OptimizationSettings};

use crate::optimize;
use crate::request::{RequestError, named};

/// Request for a trade-off.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Variables, limits and options of the searches. Its goals are the traded ones, in order.
    pub settings: OptimizationSettings,
    /// Number of designs on the front; of a front of three goals the largest triangle that does not exceed it.
    pub points: usize,
}

/// Options that override those of the model file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Names of the traded goals; empty for those of the model file.
    pub goals: Vec<String>,
    /// Number of designs on the front.
    pub points: Option<usize>,
    /// Number of starts of the search for the optimum of each goal.
    pub starts: Option<usize>,
    /// Maximum number of iterations of these searches.
    pub iterations: Option<usize>,
}

impl Request {
    /// Default number of designs on a front of two goals.
    pub const POINTS_OF_TWO: usize = 15;
    /// Default number of designs on a front of three goals: nine along each side of a triangle.
    pub const POINTS_OF_THREE: usize = 45;
    /// Maximum number of designs on a front.
    pub const MOST_POINTS: u32 = 2000;
    /// Minimum number of designs on a front of two and of three goals.
    const LEAST_POINTS: [usize; 2] = [3, 6];

    /// Request for the trade-off of a model file, with overrides. Without `trade_off` in `[optimize]` it is about all
    /// of its goals.
    ///
    /// # Errors
    /// A [`RequestError`] unless there are two or three different goals, or if an override is invalid.
    pub fn of(model: &Model, overrides: Overrides) -> Result<Self, RequestError> {
        let Overrides { goals, points, starts, iterations } = overrides;
        let request = optimize::Overrides {
            starts,
            iterations,
            // A front is a set of designs of one mechanism: its points have one assembly and one sense.
            other_assemblies: Some(false),
            both_senses: Some(false),
            ..optimize::Overrides::default()
        };
        let mut settings = optimize::Request::of(model, request)?.settings;
        let mut traded = Vec::new();
        for name in &goals {
            let goal = named("goal", name, settings.goals.iter().map(|g| g.name.as_str()))?;
            if traded.contains(&goal) {
                return Err(RequestError::invalid(
                    format!("goal `{name}` is named twice"),
                    "name two or three different goals",
                ));
            }
            traded.push(goal);
        }
        let of_file = settings.trade_off.iter();
        let of_file = of_file.filter_map(|name| settings.goals.iter().position(|g| g.name == *name));
        if traded.is_empty() {
            traded.extend(of_file);
        }
        if traded.is_empty() {
            traded.extend(0..settings.goals.len());
        }
        match (traded.len(), goals.is_empty()) {
            (2 | 3, _) => {}
            (n @ (0 | 1), true) => {
                return Err(RequestError::model(
                    format!("a trade-off requires two or three goals, and `[optimize]` has {n}"),
                    "add goals that conflict to `[optimize.goals]`",
                ));
            }
            (n, true) => {
                return Err(RequestError::model(
                    format!("a trade-off is between two or three goals, and `[optimize]` has {n}"),
                    "name those to trade, like `trade_off = [\"one\", \"other\"]` in `[optimize]`, and turn the \
                     others into limits",
                ));
            }
            (n, false) => {
                let goals = if n == 1 { "goal is" } else { "goals are" };
                return Err(RequestError::invalid(
                    format!("{n} {goals} named, and a trade-off is between two or three"),
                    "name two or three goals",
                ));
            }
        }
        settings.goals = traded.iter().map(|k| settings.goals[*k].clone()).collect();
        let [default, least] = match traded.len() {
            2 => [Self::POINTS_OF_TWO, Self::LEAST_POINTS[0]],
            _ => [Self::POINTS_OF_THREE, Self::LEAST_POINTS[1]],
        };
        let points = points.unwrap_or(default);
        if points < least {
            return Err(RequestError::invalid(
                format!("{points} designs are too few for a front of {} goals", traded.len()),
                format!("give at least {least}"),
            ));
        }
        RequestError::unless_counted("designs of a front", points, Self::MOST_POINTS)?;
        Ok(Self { settings, points })
    }

    /// Checks the number of a selected design of the front.
    ///
    /// # Errors
    /// A [`RequestError`] if the front has fewer designs.
    pub fn check_point(&self, point: Option<usize>) -> Result<(), RequestError> {
        match point {
            Some(k) if k >= self.points => Err(RequestError::invalid(
                format!("there is no point {k}"),
                format!("the points are numbered from 0 to {}", self.points - 1),
            )),
            _ => Ok(()),
        }
    }
}
