//! Adapts values of a template to the hardpoints of a table: the radius of a wheel, a point of its axis, the travel of
//! a case.

use hardpoint::model::CaseId;
use hardpoint::{Analysis, Run};
use hardpoint_file::{at_keys, hardpoint_in, with_keys};

use crate::session::Session;

/// Range of a wheel's centre height relative to the template's in which the ground is taken to be at z = 0. Beyond it,
/// the heights of the table have another origin.
const RADII: [f64; 2] = [0.5, 2.0];
/// Relative tolerance of equal heights.
const SAME: f64 = 1e-6;
/// Number of fractions of the travel of a case that are tried.
const PARTS: u32 = 20;
/// Maximum angle between a wheel's axis and the y axis, as a cosine: 20 deg.
const SIDEWAYS: f64 = 0.94;

const SPINDLE: &str = "spindle";
const CENTRE: &str = "wheel_centre";

/// Adds a point of the wheel's axis if the table has none: inboard of the centre as in the template, without camber and
/// toe.
pub fn spindle(session: &Session, template: &str, wanted: &[String], places: &mut Vec<(String, [f64; 3])>) {
    let is_wanted = wanted.iter().any(|w| w == SPINDLE);
    let of = |name: &str| places.iter().find(|p| p.0 == name).map(|p| p.1);
    let (Some(centre), true) = (of(CENTRE), is_wanted) else { return };
    match of(SPINDLE) {
        None => {
            let own = |name: &str| hardpoint_in(template, name).map_or(0.0, |p| p[1]);
            let inboard = (own(CENTRE) - own(SPINDLE)).copysign(centre[1]);
            places.push((SPINDLE.to_owned(), [centre[0], centre[1] - inboard, centre[2]]));
            session.remark(&format!(
                "the table has no `{SPINDLE}`: it is placed {} mm inboard of `{CENTRE}`, without camber and toe",
                inboard.abs()
            ));
        }
        Some(at) => {
            let along = [0, 1, 2].map(|k| centre[k] - at[k]);
            let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 0.0 && along[1].abs() < SIDEWAYS * length {
                session.remark(&format!(
                    "the axis from `{SPINDLE}` to `{CENTRE}` is far from the y axis: check these two hardpoints"
                ));
            } else if along[1] * centre[1] < 0.0 {
                session.remark(&format!(
                    "`{SPINDLE}` lies outboard of `{CENTRE}`: the template has it on the wheel's axis, inboard of the centre"
                ));
            }
        }
    }
}

/// Adapts the text to the hardpoints; remarks report the changes, and what could not be adapted.
pub fn fitted(session: &Session, template: &str, text: String) -> String {
    let text = radii(session, template, text);
    travel(session, text)
}

/// Sets the radii of wheels so that they touch the ground at z = 0, as in the template.
fn radii(session: &Session, template: &str, mut text: String) -> String {
    let Ok(file) = hardpoint_file::parse(&text, "") else { return text };
    for wheel in &file.model.wheels {
        let keys = ["wheels", wheel.name.as_str()];
        let own = |key: &str| at_keys(template, &[keys[0], keys[1], key]);
        let radius = own("radius").and_then(|r| r.trim().parse::<f64>().ok());
        let centre = own("centre").map(|c| c.trim().trim_matches('"').to_owned());
        let (Some(radius), Some(centre)) = (radius, centre) else { continue };
        let height = |text: &str| hardpoint_in(text, &centre).map(|p| p[2]);
        let (Some(drawn), Some(z)) = (height(template), height(&text)) else { continue };
        if (drawn - radius).abs() > SAME * radius || (z - radius).abs() <= SAME * radius {
            continue;
        }
        if (RADII[0] * radius..=RADII[1] * radius).contains(&z) {
            text = with_keys(&text, &[keys[0], keys[1], "radius"], &z.to_string());
            session.remark(&format!(
                "the radius of `{}` is {z} mm, the height of `{centre}` above the ground at z = 0",
                wheel.name
            ));
        } else {
            session.remark(&format!(
                "`{centre}` is at z = {z} mm, and the radius of `{}` remains {radius} mm: the ground of the table is not at z = 0; \
                 check the radius",
                wheel.name
            ));
        }
    }
    text
}

/// Reduces the travel of cases to the reach of the linkage.
fn travel(session: &Session, mut text: String) -> String {
    let names: Vec<String> = match hardpoint_file::parse(&text, "") {
        Ok(file) => file.model.cases.iter().map(|c| c.name.clone()).collect(),
        Err(_) => return text,
    };
    for (case, name) in names.iter().enumerate() {
        let laws = laws(&text, name);
        if laws.is_empty() || ends(&text, case) {
            continue;
        }
        let part = |k: u32| f64::from(k) / f64::from(PARTS);
        let scaled = |factor: f64| {
            laws.iter().fold(text.clone(), |text, (driver, law)| {
                let value = format!("\"{factor}*({law})\"");
                with_keys(&text, &["cases", name, "laws", driver], &value)
            })
        };
        match (1..PARTS).rev().map(|k| (part(k), scaled(part(k)))).find(|(_, text)| ends(text, case)) {
            Some((factor, shorter)) => {
                text = shorter;
                session.remark(&format!(
                    "the travel of case `{name}` is beyond this linkage: its laws are multiplied by {factor}"
                ));
            }
            None => session.remark(&format!(
                "the linkage cannot reach the travel of case `{name}`, nor a part of it: check the hardpoints, and change its laws"
            )),
        }
    }
    text
}

/// Drivers whose laws in a case are texts, with these laws.
fn laws(text: &str, case: &str) -> Vec<(String, String)> {
    let Ok(file) = hardpoint_file::parse(text, "") else { return Vec::new() };
    let drivers = file.model.drivers.iter();
    drivers
        .filter_map(|driver| {
            let law = at_keys(text, &["cases", case, "laws", &driver.name])?;
            let law = law.trim().strip_prefix('"')?.strip_suffix('"')?;
            Some((driver.name.clone(), law.to_owned()))
        })
        .collect()
}

/// Returns whether the motion of a case reaches its last output time.
fn ends(text: &str, case: usize) -> bool {
    let Ok(file) = hardpoint_file::parse(text, "") else { return false };
    if case >= file.model.cases.len() {
        return false;
    }
    let model = file.model.in_case(CaseId(case));
    let Ok(analysis) = Analysis::new(&model) else { return false };
    analysis.solve(Run::new().without_sensitivities()).stop.is_none()
}
