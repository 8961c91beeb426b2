//! Columns of the result files, which all follow one rule (`docs/results.md`).
//!
//! Components of a vector are named by their order: `wheel.x`, `wheel.vx`, `wheel.ax`, `wheel.jx`; those of an angular
//! vector `wheel.omega_x`, `wheel.alpha_x`. Scalars have the order in words: `toe`, `toe rate`, `toe acceleration`.

use hardpoint::Solution;
use hardpoint::joint::Quantity::{self, Angle, Length};
use hardpoint::measure::Output;
use hardpoint::model::{Model, OrientationAngle, VariableId};
use hardpoint::run::Jerks;
use hardpoint::space::{Angles, Vec3};
use serde::Serialize;

use crate::Units;
use crate::figures::order_unit;

/// Column of a result file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// Unit; `1` for a plain number.
    pub unit: String,
}

impl Column {
    fn new(name: String, unit: impl Into<String>) -> Self {
        Self { name, unit: unit.into() }
    }

    /// Header in a CSV file: `wheel.vx [mm/s]`.
    pub fn header(&self) -> String {
        if self.unit == "1" { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// Columns of a model's results, with their values.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'m> {
    /// The model.
    pub model: &'m Model,
    /// Units.
    pub units: Units,
    /// True if bodies are included.
    pub bodies: bool,
    /// Angles of bodies in addition to their quaternions, if requested.
    pub angles: Option<Angles>,
}

/// Letter before a component of a position's time derivative.
const LETTERS: [&str; 4] = ["", "v", "a", "j"];

impl Columns<'_> {
    /// Columns of the motion, without time.
    pub fn of_motion(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for body in self.bodies() {
            columns.extend(self.components(body, LETTERS[0], Length, 0));
            columns.extend(["qw", "qx", "qy", "qz"].map(|q| Column::new(format!("{body}.{q}"), "1")));
            if let Some(angles) = self.angles {
                let unit = order_unit(self.units, Angle, 0);
                let name = |place| OrientationAngle { angles, place }.name();
                columns
                    .extend((0..3).map(|place| Column::new(format!("{body}.{}", name(place)), unit.clone())));
            }
            columns.extend(self.rates(body));
        }
        columns.extend(self.of_outputs());
        columns
    }

    /// Velocity and acceleration of a body, of a mechanism that is not at rest.
    fn rates(&self, body: &str) -> Vec<Column> {
        if self.is_at_rest() {
            return Vec::new();
        }
        let rates =
            [(LETTERS[1], Length, 1), ("omega_", Angle, 1), (LETTERS[2], Length, 2), ("alpha_", Angle, 2)];
        rates.into_iter().flat_map(|(prefix, of, order)| self.components(body, prefix, of, order)).collect()
    }

    /// True if the model is in equilibrium at every output time: nothing has a rate.
    fn is_at_rest(&self) -> bool {
        self.model.equilibrium.is_some()
    }

    /// Columns of the sensitivities by one variable, without time, variable and its unit. Units are those of the
    /// numerator.
    pub fn of_sensitivities(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for body in self.bodies() {
            columns.extend(self.components(body, LETTERS[0], Length, 0));
            columns.extend(self.components(body, "pi_", Angle, 0));
            columns.extend(self.rates(body));
        }
        columns.extend(self.of_outputs());
        columns.into_iter().map(|c| Column { name: format!("d {}", c.name), ..c }).collect()
    }

    /// Columns of the third time derivatives of all bodies.
    pub fn of_jerk(&self) -> Vec<Column> {
        if self.is_at_rest() {
            return Vec::new();
        }
        let of_body = |body: &hardpoint::model::Body| {
            let place = self.components(&body.name, LETTERS[3], Length, 3);
            place.into_iter().chain(self.components(&body.name, "angular_jerk_", Angle, 3))
        };
        self.model.bodies[1..].iter().flat_map(of_body).collect()
    }

    /// Appends the values of the motion at output time k of a solution.
    pub fn motion(&self, solution: &Solution, k: usize, row: &mut Vec<f64>) {
        let units = self.units;
        if self.bodies {
            for s in solution.motion.at(k).iter().skip(1) {
                push(row, |x| units.from_si(Length, x), s.r);
                row.extend(s.quaternion());
                if let Some(angles) = self.angles {
                    row.extend(angles.of(s.rotation).map(|x| units.from_si(Angle, x)));
                }
                if !self.is_at_rest() {
                    push(row, |x| units.from_si(Length, x), s.v);
                    push(row, |x| units.from_si(Angle, x), s.omega);
                    push(row, |x| units.from_si(Length, x), s.a);
                    push(row, |x| units.from_si(Angle, x), s.alpha);
                }
            }
        }
        for (m, output) in solution.measured.outputs.iter().enumerate() {
            let orders = solution.measured.value(k, m).into_iter().take(output.known.orders);
            row.extend(orders.map(|x| units.from_si(output.dimension, x)));
        }
    }

    /// Appends the sensitivities by variable b at output time k; `None` if the mechanism cannot follow the variable.
    pub fn sensitivities(&self, solution: &Solution, k: usize, b: usize, row: &mut Vec<f64>) -> Option<()> {
        let bodies = solution.sensitivities.at(k, b)?;
        let (units, by) = (self.units, self.model.variables[b].quantity);
        if self.bodies {
            for d in bodies.iter().skip(1) {
                let parts = [
                    (Length, d.dr),
                    (Angle, d.dpi),
                    (Length, d.dv),
                    (Angle, d.domega),
                    (Length, d.da),
                    (Angle, d.dalpha),
                ];
                let known = if self.is_at_rest() { 2 } else { parts.len() };
                parts
                    .into_iter()
                    .take(known)
                    .for_each(|(of, v)| push(row, |x| units.derivative_from_si(of, by, x), v));
            }
        }
        for (m, output) in solution.measured.outputs.iter().enumerate() {
            let orders = solution.measured.d(k, VariableId(b), m).into_iter().take(output.known.orders);
            row.extend(orders.map(|x| units.derivative_from_si(output.dimension, by, x)));
        }
        Some(())
    }

    /// Appends the third time derivatives at output time k.
    pub fn jerk(&self, jerks: &Jerks, k: usize, row: &mut Vec<f64>) {
        if self.is_at_rest() {
            return;
        }
        for body in &jerks.at(k)[1..] {
            push(row, |x| self.units.from_si(Length, x), body.jerk);
            push(row, |x| self.units.from_si(Angle, x), body.angular);
        }
    }

    fn bodies(&self) -> impl Iterator<Item = &str> {
        let bodies = if self.bodies { &self.model.bodies[1..] } else { &[] };
        bodies.iter().map(|b| b.name.as_str())
    }

    fn components(&self, body: &str, prefix: &str, quantity: Quantity, order: usize) -> [Column; 3] {
        let unit = order_unit(self.units, quantity, order);
        ["x", "y", "z"].map(|c| Column::new(format!("{body}.{prefix}{c}"), unit.clone()))
    }

    fn of_outputs(&self) -> Vec<Column> {
        let outputs = hardpoint::measure::outputs(self.model);
        let columns = |o: &Output| {
            let orders = 0..o.known.orders;
            let unit = |order| order_unit(self.units, o.dimension, order);
            orders.map(|order| Column::new(o.order_name(order), unit(order))).collect::<Vec<_>>()
        };
        outputs.iter().flat_map(columns).collect()
    }
}

fn push(row: &mut Vec<f64>, shown: impl Fn(f64) -> f64, v: Vec3) {
    row.extend(v.to_array().map(shown));
}
