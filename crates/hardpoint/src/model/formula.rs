//! Named numbers, and formulas over them: what of the model follows the design other than in proportion.

use crate::constraint::Row;
use crate::expression::Expression;
use crate::joint::Quantity;
use crate::model::{DriverId, HardpointId, JointId, Model, NumberId, ParameterId};
use crate::space::Real;

/// A parameter of the model: a number with a name, for formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedNumber {
    /// Name.
    pub name: String,
    /// Value in the nominal design, m, rad or a plain number.
    pub value: f64,
    /// Quantity of the value.
    pub quantity: Quantity,
}

/// A number that formulas use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// A parameter.
    Parameter(ParameterId),
    /// A coordinate of a hardpoint: 0 for x, 1 for y, 2 for z.
    Coordinate(HardpointId, usize),
    /// The design value of a coordinate of a joint, as the joint keeps it: the length of a rod or leg, given or drawn;
    /// a course. Only laws that count from zero use it.
    Kept(JointId, usize),
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
    /// A number of a mass or force.
    Number(NumberId),
}

impl Model {
    /// Name of a number that a formula gives, as in messages.
    pub fn target_name(&self, of: Target) -> String {
        match of {
            Target::Parameter(p) => format!("`{}`", self.parameters[p.0].name),
            Target::Coordinate(h, axis) => {
                let name = &self.hardpoints[h.0].name;
                format!("`{name}.{}`", ["x", "y", "z"][axis])
            }
            Target::Length(j) => format!("the length of `{}`", self.joints[j.0].name),
            Target::Law(d, _) => format!("the law of `{}`", self.drivers[d.0].name),
            Target::Number(n) => {
                let number = &self.numbers[n.0];
                format!("`{}` of `{}`", number.key, number.owner)
            }
        }
    }
}

/// A number of the model that follows others.
#[derive(Clone, Debug)]
pub struct Formula {
    /// Number that the formula defines.
    pub of: Target,
    pub(crate) expression: Expression,
    /// Sources of the names in the expression, each with the number of units of the text per SI unit.
    pub(crate) inputs: Vec<(Source, f64)>,
    /// Number of units of the text per SI unit of the result.
    pub(crate) per_unit: f64,
}

impl Formula {
    /// Text of the expression.
    pub fn text(&self) -> &str {
        self.expression.text()
    }

    /// Numbers that the formula uses.
    pub fn sources(&self) -> impl Iterator<Item = Source> {
        self.inputs.iter().map(|i| i.0)
    }

    /// Result in SI for these sources in SI, over any scalar.
    pub(crate) fn at<T: Real>(&self, source: impl Fn(Source) -> T) -> T {
        let number = |k: usize| {
            let (from, per_unit) = self.inputs[k];
            source(from) * T::constant(per_unit)
        };
        self.expression.over(number) / T::constant(self.per_unit)
    }
}

impl Model {
    /// The value of a parameter or coordinate in the nominal design, m, rad or a plain number.
    pub(crate) fn nominal(&self, source: Source) -> f64 {
        match source {
            Source::Parameter(p) => self.parameters[p.0].value,
            Source::Coordinate(h, axis) => self.hardpoints[h.0].position[axis],
            Source::Kept(j, coordinate) => self.nominal_coordinate(j, coordinate),
        }
    }

    /// Design value of a joint's coordinate in the nominal design, as far as the joint keeps one; 0 for all others.
    fn nominal_coordinate(&self, j: JointId, coordinate: usize) -> f64 {
        let joint = &self.joints[j.0];
        match joint.kind.coordinates[coordinate].row {
            // L as given, or abs(P_j - P_i)
            Row::Distance => {
                let [from, to] = joint.at.map(|h| self.position(h));
                joint.length.unwrap_or_else(|| (to - from).norm())
            }
            // atan2(y_i . z_j, x_i . z_j)
            Row::Course => {
                let ([x, y, _], e) = (joint.frames[0].cols, joint.frames[1].cols[2]);
                y.dot(e).atan2(x.dot(e))
            }
            Row::Point(_)
            | Row::PointOnBase(_)
            | Row::Dot1(..)
            | Row::Dot2(_)
            | Row::Angle
            | Row::AngleOnJ
            | Row::HeadingOnJ
            | Row::CardanAngle
            | Row::Heading
            | Row::Cosine
            | Row::Offset
            | Row::Contact
            | Row::ConstantVelocity
            | Row::LowestPoint(_) => 0.0,
        }
    }

    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<ParameterId> {
        self.parameters.iter().position(|p| p.name == name).map(ParameterId)
    }
}
