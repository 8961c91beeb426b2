//! `loads.csv`: reactions of joints, for use in finite element models; `drivers.csv`: loads of drivers.

use std::io::Write;

use hardpoint::load::Loads;
use hardpoint::model::{Dimension, Model};
use hardpoint::space::Vec3;
use hardpoint_file::Units;
use hardpoint_table::csv::CsvWriter;

use crate::figures::{order_unit, unit};

/// Formatted number; empty for a missing one.
fn shown(x: f64) -> String {
    if x.is_finite() { x.to_string() } else { String::new() }
}

/// Writes a row for every output time: for every driver its force or moment, the prescribed speed, its power, and the
/// work done since the first output time, by the trapezoidal rule.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_drivers(model: &Model, units: Units, loads: &Loads, out: impl Write) -> csv::Result<()> {
    let mut writer = CsvWriter::new(out);
    let mut header = vec!["t [s]".to_owned()];
    for driver in &model.drivers {
        let (quantity, name) = (model.driven(driver).quantity, &driver.name);
        let force = model.force_on(driver);
        let what = if force == Dimension::MOMENT { "moment" } else { "force" };
        header.push(format!("{name} {what} [{}]", unit(units, force)));
        header.push(format!("{name} speed [{}]", order_unit(units, quantity, 1)));
        header.extend([format!("{name} power [W]"), format!("{name} work [J]")]);
    }
    writer.row(&header)?;
    let mut work = vec![0.0; model.drivers.len()];
    for (k, t) in loads.times.iter().enumerate() {
        let mut row = vec![shown(*t)];
        for (d, load) in loads.drivers_at(k).iter().enumerate() {
            let power = |k: usize| loads.drivers_at(k)[d].force * loads.drivers_at(k)[d].speed;
            if k > 0 {
                // (P_k + P_k-1) (t_k - t_k-1) / 2
                work[d] += 0.5 * (power(k) + power(k - 1)) * (t - loads.times[k - 1]);
            }
            let (_, per_si) = units.of(model.driven(&model.drivers[d]).quantity);
            row.extend([load.force, load.speed * per_si, power(k), work[d]].map(shown));
        }
        writer.row(&row)?;
    }
    writer.end()?;
    Ok(())
}

/// Writes a row for every output time and joint: its point on body j, and the reaction force and moment on that body,
/// in global axes and in axes that coincide with the global ones in the design configuration and turn with body j.
/// Undetermined components (redundant constraints) are empty.
///
/// # Errors
/// If `out` cannot be written.
pub fn write(model: &Model, units: Units, loads: &Loads, out: impl Write) -> csv::Result<()> {
    let mut writer = CsvWriter::new(out);
    let length = units.length.symbol();
    let mut header = vec!["t [s]".to_owned(), "joint".into(), "body".into()];
    let axes = |what: &str, unit: &str| ["x", "y", "z"].map(|k| format!("{what}.{k} [{unit}]"));
    header.extend(axes("place", length));
    header.extend(axes("force", "N"));
    header.extend(axes("moment", "N*m"));
    header.extend(axes("force in body", "N"));
    header.extend(axes("moment in body", "N*m"));
    writer.row(&header)?;
    let known = |v: Vec3, known: [bool; 3]| {
        let all = v.to_array().into_iter().zip(known);
        all.map(|(x, known)| if known { shown(x) } else { String::new() }).collect::<Vec<_>>()
    };
    for (k, t) in loads.times.iter().enumerate() {
        for (joint, load) in model.joints.iter().zip(loads.joints_at(k)).filter(|(j, _)| !j.unnamed) {
            let mut row = vec![shown(*t), joint.name.clone()];
            row.push(model.bodies[joint.bodies[1].0].name.clone());
            row.extend(load.place.to_array().map(|x| shown(x * units.length.per_metre())));
            row.extend(known(load.force, load.known[0]));
            row.extend(known(load.moment, load.known[1]));
            row.extend(known(load.in_body[0], load.known_in_body[0]));
            row.extend(known(load.in_body[1], load.known_in_body[1]));
            writer.row(&row)?;
        }
    }
    writer.end()?;
    Ok(())
}
