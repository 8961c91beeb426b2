//! Variables of the unit, in the order of their value references.

use hardpoint::joint::Quantity;
use hardpoint::model::Dimension;
use hardpoint_file::ModelFile;

use super::names::StructuredNames;
use crate::c::MotionSource;

/// Variable of the unit.
pub(super) struct Variable {
    pub name: String,
    pub about: String,
    pub role: Role,
    pub dimension: Dimension,
}

/// Role of a variable, with the index of its driver, design variable, measure or body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    /// Input: position, velocity or acceleration of a driver.
    Driver(usize, usize),
    Design(usize),
    /// Output: value, rate or acceleration of a measure.
    Measure(usize, usize),
    BodyPosition(usize),
    BodyRotation(usize),
}

impl Role {
    /// Kind in `fmi3.c`, index, and number of values.
    pub fn in_source(self) -> (&'static str, usize, usize) {
        match self {
            Self::Time => ("TIME", 0, 1),
            Self::Driver(k, order) => (["POSITION", "VELOCITY", "ACCELERATION"][order], k, 1),
            Self::Design(k) => ("DESIGN", k, 1),
            Self::Measure(k, order) => (["VALUE", "RATE", "SECOND"][order], k, 1),
            Self::BodyPosition(k) => ("BODY_POSITION", k, 3),
            Self::BodyRotation(k) => ("BODY_ROTATION", k, 9),
        }
    }

    pub fn is_output(self) -> bool {
        match self {
            Self::Time | Self::Driver(..) | Self::Design(_) => false,
            Self::Measure(..) | Self::BodyPosition(_) | Self::BodyRotation(_) => true,
        }
    }

    /// Order of the highest derivative of the drivers that an output depends on.
    pub fn order(self) -> usize {
        match self {
            Self::Driver(_, order) | Self::Measure(_, order) => order,
            Self::Time | Self::Design(_) | Self::BodyPosition(_) | Self::BodyRotation(_) => 0,
        }
    }
}

/// All variables, in the order of their value references.
pub(super) fn variables(file: &ModelFile, source: &MotionSource, names: &StructuredNames) -> Vec<Variable> {
    let model = &file.model;
    let dimension = |quantity: Quantity| Dimension::from(quantity);
    let mut list = vec![Variable {
        name: "time".to_owned(),
        about: "Independent variable".to_owned(),
        role: Role::Time,
        dimension: Dimension::NUMBER.rate(-1),
    }];
    for (k, driver) in model.drivers.iter().enumerate() {
        let quantity = dimension(model.driven(driver).quantity);
        for (order, of) in ["position", "velocity", "acceleration"].into_iter().enumerate() {
            list.push(Variable {
                name: format!("drivers.{}.{of}", names.drivers[k].1),
                about: match order {
                    0 => format!("Position of driver {} from the design configuration", driver.name),
                    _ => format!("{} of driver {}", ["", "Velocity", "Acceleration"][order], driver.name),
                },
                role: Role::Driver(k, order),
                dimension: quantity.rate(order as i8),
            });
        }
    }
    for (k, of) in source.design.iter().enumerate() {
        let variable = &model.variables[*of];
        list.push(Variable {
            name: format!("design.{}", names.design[k].1),
            about: format!("Change of design variable {} from the value of the model", variable.name),
            role: Role::Design(k),
            dimension: dimension(variable.quantity),
        });
    }
    for (k, measure) in source.measures.iter().enumerate() {
        for (order, of) in ["value", "rate", "acceleration"].into_iter().enumerate().take(measure.orders()) {
            list.push(Variable {
                name: format!("measures.{}.{of}", names.measures[k].1),
                about: match order {
                    0 => format!("Measure {}", measure.output.name),
                    _ => {
                        format!("{} of measure {}", ["", "Rate", "Acceleration"][order], measure.output.name)
                    }
                },
                role: Role::Measure(k, order),
                dimension: measure.output.dimension.rate(order as i8),
            });
        }
    }
    for (k, body) in model.bodies.iter().skip(1).enumerate() {
        list.push(Variable {
            name: format!("bodies.{}.position", names.bodies[k].1),
            about: format!("Origin of body {} in global axes", body.name),
            role: Role::BodyPosition(k),
            dimension: Dimension::LENGTH,
        });
        list.push(Variable {
            name: format!("bodies.{}.rotation", names.bodies[k].1),
            about: format!(
                "Rotation matrix of body {}: its columns are the axes in global components",
                body.name
            ),
            role: Role::BodyRotation(k),
            dimension: Dimension::NUMBER,
        });
    }
    list
}
