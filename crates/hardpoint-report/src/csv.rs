//! `motion.csv` and `sensitivity.csv`: every solved number, in the user's units, with all its digits.
//!
//! Numbers are the shortest decimals that read back as the same double. A column's unit stands in its
//! header. In `sensitivity.csv` that is the unit of the numerator; that of the denominator is in column `per`.

use std::io::Write;

use csv::WriterBuilder;
use hardpoint::Solution;
use hardpoint::joint::Quantity::{self, Angle, Length};
use hardpoint::measure::Output;
use hardpoint::model::{Model, VariableId};
use hardpoint::motion::BodyState;
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;
use hardpoint::study::Jerks;
use hardpoint_file::Units;
use serde::{Serialize, Serializer};

use crate::facts::variable_unit;
use crate::figures::order_unit;

const ORDERS: [&str; 3] = ["", " rate", " acceleration"];

/// Writes time, state of every body but ground, then value, rate and acceleration of every output.
///
/// # Errors
/// Where `out` cannot be written.
pub fn write_motion(model: &Model, units: Units, solution: &Solution, out: impl Write) -> csv::Result<()> {
    let mut header = vec!["t [s]".to_owned()];
    for body in &model.bodies[1..] {
        let name = &body.name;
        header.extend(components(name, "", units, Length, 0));
        header.extend(["qw", "qx", "qy", "qz"].map(|q| format!("{name}.{q}")));
        header.extend(components(name, "v", units, Length, 1));
        header.extend(components(name, "omega_", units, Angle, 1));
        header.extend(components(name, "a", units, Length, 2));
        header.extend(components(name, "alpha_", units, Angle, 2));
    }
    header.extend(output_headers(solution, units, ""));
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(out);
    writer.write_record(&header)?;
    let mut row = Vec::with_capacity(header.len());
    for (k, &t) in solution.motion.times.iter().enumerate() {
        row.clear();
        row.push(t);
        for state in &solution.motion.at(k)[1..] {
            push_state(&mut row, units, state);
        }
        for (m, output) in solution.measured.outputs.iter().enumerate() {
            row.extend(
                known(output, solution.measured.value(k, m)).map(|x| units.from_si(output.dimension, x)),
            );
        }
        writer.serialize(numbers(&row))?;
    }
    writer.flush()?;
    Ok(())
}

/// Writes time, and the third time derivatives of every body but ground: of its origin, and of its orientation.
///
/// # Errors
/// Where `out` cannot be written.
pub fn write_jerk(model: &Model, units: Units, jerks: &Jerks, out: impl Write) -> csv::Result<()> {
    let mut header = vec!["t [s]".to_owned()];
    for body in &model.bodies[1..] {
        header.extend(components(&body.name, "jerk_", units, Length, 3));
        header.extend(components(&body.name, "angular_jerk_", units, Angle, 3));
    }
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(out);
    writer.write_record(&header)?;
    for (k, &t) in jerks.times.iter().enumerate() {
        let mut row = vec![t];
        for body in &jerks.at(k)[1..] {
            row.extend(body.jerk.to_array().map(|x| units.from_si(Length, x)));
            row.extend(body.angular.to_array().map(|x| units.from_si(Angle, x)));
        }
        writer.serialize(numbers(&row))?;
    }
    writer.flush()?;
    Ok(())
}

/// Writes one row per output time and design variable: derivatives of everything in `motion.csv` by that
/// variable, orientation as a rotation vector `pi`. Variables that the mechanism cannot follow have no rows.
///
/// # Errors
/// Where `out` cannot be written.
pub fn write_sensitivity(
    model: &Model,
    units: Units,
    solution: &Solution,
    out: impl Write,
) -> csv::Result<()> {
    let mut header = vec!["t [s]".to_owned(), "variable".to_owned(), "per".to_owned()];
    for body in &model.bodies[1..] {
        let name = format!("d {}", body.name);
        header.extend(components(&name, "", units, Length, 0));
        header.extend(components(&name, "pi_", units, Angle, 0));
        header.extend(components(&name, "v", units, Length, 1));
        header.extend(components(&name, "omega_", units, Angle, 1));
        header.extend(components(&name, "a", units, Length, 2));
        header.extend(components(&name, "alpha_", units, Angle, 2));
    }
    header.extend(output_headers(solution, units, "d "));
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(out);
    writer.write_record(&header)?;
    let mut row = Vec::with_capacity(header.len());
    for (k, &t) in solution.motion.times.iter().enumerate() {
        for (b, variable) in model.variables.iter().enumerate() {
            let Some(bodies) = solution.sensitivities.at(k, b) else { continue };
            row.clear();
            for d in &bodies[1..] {
                push_sensitivity(&mut row, units, variable.quantity, d);
            }
            for (m, output) in solution.measured.outputs.iter().enumerate() {
                let d = known(output, solution.measured.d(k, VariableId(b), m));
                row.extend(d.map(|x| units.derivative_from_si(output.dimension, variable.quantity, x)));
            }
            writer.serialize((t, &variable.name, variable_unit(model, units, variable), numbers(&row)))?;
        }
    }
    writer.flush()?;
    Ok(())
}

/// The fields of a row.
pub(crate) fn numbers(row: &[f64]) -> Vec<Number> {
    row.iter().map(|x| Number(*x)).collect()
}

fn components(body: &str, prefix: &str, units: Units, quantity: Quantity, order: usize) -> [String; 3] {
    let unit = order_unit(units, quantity, order);
    ["x", "y", "z"].map(|c| format!("{body}.{prefix}{c} [{unit}]"))
}

fn output_headers(solution: &Solution, units: Units, prefix: &str) -> Vec<String> {
    let outputs = solution.measured.outputs.iter();
    outputs
        .flat_map(|o| {
            let header = |(k, order): (usize, &str)| {
                format!("{prefix}{}{order} [{}]", o.name, order_unit(units, o.dimension, k))
            };
            ORDERS.into_iter().enumerate().take(o.known.orders).map(header)
        })
        .collect()
}

/// Of value, rate and acceleration of an output, those that can be known.
fn known(output: &Output, orders: [f64; 3]) -> impl Iterator<Item = f64> {
    orders.into_iter().take(output.known.orders)
}

/// A number; an empty field where there is none, as for the curvature of a path at rest.
pub(crate) struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        if self.0.is_nan() { s.serialize_none() } else { s.serialize_f64(self.0) }
    }
}

fn push_state(row: &mut Vec<f64>, units: Units, s: &BodyState) {
    let mut push = |q: Quantity, v: Vec3| row.extend(v.to_array().map(|x| units.from_si(q, x)));
    push(Length, s.r);
    row.extend(s.quaternion());
    let mut push = |q: Quantity, v: Vec3| row.extend(v.to_array().map(|x| units.from_si(q, x)));
    push(Length, s.v);
    push(Angle, s.omega);
    push(Length, s.a);
    push(Angle, s.alpha);
}

fn push_sensitivity(row: &mut Vec<f64>, units: Units, by: Quantity, d: &BodySensitivity) {
    let parts = [
        (Length, d.dr),
        (Angle, d.dpi),
        (Length, d.dv),
        (Angle, d.domega),
        (Length, d.da),
        (Angle, d.dalpha),
    ];
    for (of, v) in parts {
        row.extend(v.to_array().map(|x| units.derivative_from_si(of, by, x)));
    }
}
