//! Named numbers, and formulas over them: what of the model follows the design other than in proportion.

use std::collections::BTreeMap;

use super::*;
use crate::law::Expression;
use crate::space::Real;

/// A parameter of the model: a number with a name, for formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedNumber {
    /// Its name.
    pub name: String,
    /// Its value in the nominal design, m, rad or a plain number.
    pub value: f64,
    /// What it measures.
    pub quantity: Quantity,
}

/// A number that formulas use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// A parameter.
    Parameter(ParameterId),
    /// A coordinate of a hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(HardpointId, usize),
}

/// A number that a formula gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The value of a parameter.
    Parameter(ParameterId),
    /// A coordinate of a hardpoint.
    Coordinate(HardpointId, usize),
    /// The length that a rod is given.
    Length(JointId),
    /// A parameter of a driver's law, which is a plain number.
    Law(DriverId, usize),
}

/// A number of the model that follows others.
#[derive(Clone, Debug)]
pub struct Formula {
    /// What it gives.
    pub of: Target,
    pub(super) expression: Expression,
    /// What the expression's names mean, and how many of the text's units make one SI unit of it.
    pub(super) inputs: Vec<(Source, f64)>,
    /// How many of the text's units make one SI unit of the result.
    pub(super) per_unit: f64,
}

impl Formula {
    /// What it was written as.
    pub fn text(&self) -> &str {
        self.expression.text()
    }

    /// What it follows.
    pub fn sources(&self) -> impl Iterator<Item = Source> {
        self.inputs.iter().map(|i| i.0)
    }

    /// Its result in SI for these sources in SI, over any scalar.
    pub(super) fn at<T: Real>(&self, source: impl Fn(Source) -> T) -> T {
        let number = |k: usize| {
            let (from, per_unit) = self.inputs[k];
            source(from) * T::constant(per_unit)
        };
        self.expression.over(number) / T::constant(self.per_unit)
    }
}

impl Model {
    /// The value of a parameter or coordinate in the nominal design, m, rad or a plain number.
    pub(super) fn nominal(&self, source: Source) -> f64 {
        match source {
            Source::Parameter(p) => self.parameters[p.0].value,
            Source::Coordinate(h, axis) => self.hardpoints[h.0].position[axis],
        }
    }

    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<ParameterId> {
        self.parameters.iter().position(|p| p.name == name).map(ParameterId)
    }
}

/// What the parameters and formulas of a draft give with all design variables at zero: for numbers that no change of the
/// design can move.
#[derive(Clone, Debug, Default)]
pub struct Nominal {
    /// Of each hardpoint of the draft, m; null where a formula of it is faulty.
    pub positions: Vec<Vec3>,
    /// By name: its value in SI if it has one, its quantity, and a design variable or hardpoint that it follows.
    pub(super) parameters: BTreeMap<String, (Option<f64>, Quantity, Option<String>)>,
}

/// Why an expression is no constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotConstant {
    /// It names what is no parameter.
    Unknown(String),
    /// It uses this parameter, which follows this (`design variable `b``, or `hardpoint `A``).
    Follows(String, String),
    /// It uses a parameter that is faulty, which is reported elsewhere.
    Faulty,
    /// Its value is not finite.
    NotFinite,
}
