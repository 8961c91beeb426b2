//! `loads.csv`: what joints put on bodies, for whoever goes on with finite elements.

use std::io::Write;

use csv::Writer;
use hardpoint::model::Model;
use hardpoint::space::Vec3;
use hardpoint::study::Loads;
use hardpoint_file::Units;

use crate::csv::no_formula;

/// Writes a row for every output time and joint: where it is on its second body, and the force and moment that it puts on that body, global
/// and along the global axes as drawn, which have turned with the body. What redundant constraints leave open is empty.
///
/// # Errors
/// Where `out` cannot be written.
pub fn write(model: &Model, units: Units, loads: &Loads, out: impl Write) -> csv::Result<()> {
    let mut writer = Writer::from_writer(out);
    let length = units.length.symbol();
    let mut header = vec!["t [s]".to_owned(), "joint".into(), "body".into()];
    let axes = |what: &str, unit: &str| ["x", "y", "z"].map(|k| format!("{what}.{k} [{unit}]"));
    header.extend(axes("place", length));
    header.extend(axes("force", "N"));
    header.extend(axes("moment", "N*m"));
    header.extend(axes("force in body", "N"));
    header.extend(axes("moment in body", "N*m"));
    writer.write_record(&header)?;
    let shown = |x: f64| if x.is_finite() { x.to_string() } else { String::new() };
    let known = |v: Vec3, known: [bool; 3]| {
        let all = v.to_array().into_iter().zip(known);
        all.map(|(x, known)| if known { shown(x) } else { String::new() }).collect::<Vec<_>>()
    };
    for (k, t) in loads.times.iter().enumerate() {
        for (joint, load) in model.joints.iter().zip(loads.joints_at(k)).filter(|(j, _)| !j.unnamed) {
            let mut row = vec![shown(*t), no_formula(&joint.name).into_owned()];
            row.push(no_formula(&model.bodies[joint.bodies[1].0].name).into_owned());
            row.extend(load.place.to_array().map(|x| shown(x * units.length.per_metre())));
            row.extend(known(load.force, load.known[0]));
            row.extend(known(load.moment, load.known[1]));
            row.extend(known(load.in_body[0], load.known_in_body[0]));
            row.extend(known(load.in_body[1], load.known_in_body[1]));
            writer.write_record(&row)?;
        }
    }
    writer.flush()?;
    Ok(())
}
