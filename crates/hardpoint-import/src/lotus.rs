//! Models of Lotus Suspension Analysis (`.shk`): one corner, recognised by the names of its points.

use hardpoint::space::Vec3;

use crate::corner::{Corner, Role, role_of};
use crate::mechanism::{Mechanism, end_named};
use crate::report::{ImportLog, SourceSpan};
use crate::{Format, Input};

/// Lotus format.
pub const FORMAT: Format = Format {
    name: "lotus",
    about: "Lotus Suspension Analysis model",
    endings: &["shk"],
    recognises: |text| text.lines().any(|l| l.trim() == "TEMP_SETTINGS"),
    read,
    binary: false,
};

/// Number of lines of a point in the template: its name, five lines of words, and three of numbers.
const LINES_OF_A_POINT: usize = 9;
/// Maximum number of parts and points of a template.
const MOST: usize = 500;

/// Line with its position.
#[derive(Clone, Copy)]
struct Line<'t> {
    text: &'t str,
    at: SourceSpan,
}

impl Line<'_> {
    /// Returns the numbers of a line, or none if it contains anything else.
    fn numbers(&self) -> Vec<f64> {
        let words = self.text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
        let list: Option<Vec<f64>> =
            words.map(|w| w.replace(['D', 'd'], "e").parse().ok().filter(|x: &f64| x.is_finite())).collect();
        list.unwrap_or_default()
    }
}

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let lines = lines(input.text);
    let Some(settings) = lines.iter().position(|l| l.text == "TEMP_SETTINGS") else {
        notes.problem_with(
            "HP0803",
            None,
            "the block `TEMP_SETTINGS` with the names of the points is missing",
            "save the model from Lotus again",
        );
        return None;
    };
    let names = names(&lines, settings, notes)?;
    let block = suspension(&lines, notes)?;
    let heading = &lines[block];
    let (mut places, mut scalars) = (Vec::new(), Vec::new());
    for line in lines.iter().skip(block + 2) {
        match line.numbers()[..] {
            [x, y, z] => places.push(([x, y, z], line.at)),
            [x] => scalars.push((x, line.at)),
            _ => break,
        }
    }
    if places.len() < names.len() {
        let message = format!("the file has {} names of points, but {} positions", names.len(), places.len());
        notes.problem_with(
            "HP0803",
            Some(heading.at),
            message,
            "write each position as a line of three numbers below the second line of the block",
        );
        return None;
    }
    let mut m = Mechanism::new(input.stem, "mm", "deg");
    let at = |role| names.iter().position(|name| role_of(name) == Some(role)).map(|k| places[k].0);
    let forward = is_forward(at);
    let why = if forward {
        "not rotated: according to the front pivots, x points forward"
    } else {
        "rotated by 180 deg about z, so that x points forward and y left"
    };
    notes.approximated("axes", "", Some(heading.at), why);
    let radius = radius(&scalars, notes);
    let end = heading.text.split_whitespace().next().and_then(end_named);
    let mut corner = Corner { at: Some(heading.at), rack: true, radius, end, ..Corner::default() };
    for (name, (place, at)) in names.iter().zip(&places) {
        if name.contains("C of G") {
            let why = "the centre of gravity has no mass in the file";
            notes.refused("point", name, Some(*at), why);
            continue;
        }
        let place = if forward { Vec3::from(*place) } else { half_round(*place) };
        m.hardpoints.push((name.to_string(), place));
        notes.taken("point", name, Some(*at));
        if let Some(role) = role_of(name) {
            corner.points.insert(role, place);
        }
    }
    complete(&mut corner);
    let mut rack = None;
    corner.build(&mut m, notes, &mut rack);
    (!m.hardpoints.is_empty()).then_some(m)
}

/// Returns the lines of a file with their positions.
fn lines(text: &str) -> Vec<Line<'_>> {
    let mut start = 0;
    text.split_inclusive('\n')
        .map(|whole| {
            let text = whole.trim();
            let from = start + whole.len() - whole.trim_start().len();
            start += whole.len();
            Line { text, at: SourceSpan { text: 0, start: from, end: from + text.len() } }
        })
        .collect()
}

/// Returns the line of the first block of a suspension.
fn suspension(lines: &[Line<'_>], notes: &mut ImportLog) -> Option<usize> {
    let is_heading = |line: &Line<'_>| ["FRONT SUSPENSION", "REAR SUSPENSION"].contains(&line.text);
    let mut blocks = (0..lines.len()).filter(|k| is_heading(&lines[*k]));
    let Some(block) = blocks.next() else {
        notes.problem_with(
            "HP0803",
            None,
            "the block `FRONT SUSPENSION` or `REAR SUSPENSION` is missing",
            "save the model from Lotus again",
        );
        return None;
    };
    for other in blocks {
        notes.refused(
            "block",
            lines[other].text,
            Some(lines[other].at),
            "the names of the points apply to one suspension: only the first is imported",
        );
    }
    Some(block)
}

/// Returns true if a file has x forward, as the pivots of an arm show. Lotus uses x back and y right.
fn is_forward(at: impl Fn(Role) -> Option<[f64; 3]>) -> bool {
    let pivots = [[Role::LowerFront, Role::LowerRear], [Role::UpperFront, Role::UpperRear]];
    pivots.iter().find_map(|[front, rear]| Some(at(*front)?[0] > at(*rear)?[0])).unwrap_or(false)
}

/// Returns the radius of the wheel, the first of the numbers after the points.
fn radius(scalars: &[(f64, SourceSpan)], notes: &mut ImportLog) -> Option<f64> {
    let ((radius, at), others) = scalars.split_first()?;
    notes.approximated(
        "radius",
        &format!("{radius}"),
        Some(*at),
        "the first number after the points is assumed to be the loaded radius of the wheel",
    );
    for (number, at) in others {
        let why = "the file does not name its meaning";
        notes.refused("number", &format!("{number}"), Some(*at), why);
    }
    Some(*radius).filter(|r| *r > 0.0)
}

/// Returns the names of the points. They follow the name of the template, the numbers of parts and points, and the
/// names of the parts.
fn names<'t>(lines: &[Line<'t>], settings: usize, notes: &mut ImportLog) -> Option<Vec<&'t str>> {
    let header = lines.get(settings + 3);
    let counts = header.map(Line::numbers).unwrap_or_default();
    let (parts, points) = match counts[..] {
        [parts, points, ..]
            if (0.0..=MOST as f64).contains(&parts) && (1.0..=MOST as f64).contains(&points) =>
        {
            (parts as usize, points as usize)
        }
        _ => {
            let at = header.map(|h| h.at);
            let help = "write the numbers of parts and points three lines below `TEMP_SETTINGS`";
            notes.problem_with("HP0804", at, "the numbers of parts and points are not readable", help);
            return None;
        }
    };
    if let Some(template) = lines.get(settings + 2) {
        notes.taken("template", template.text, Some(template.at));
    }
    let first = settings + 4 + parts;
    let names: Vec<&str> =
        (0..points).filter_map(|k| lines.get(first + k * LINES_OF_A_POINT)).map(|l| l.text).collect();
    if names.len() < points || names.iter().any(|n| n.is_empty() || n.parse::<f64>().is_ok()) {
        let at = Some(lines[settings].at);
        notes.problem_with(
            "HP0802",
            at,
            "the names of the points are not at their expected lines",
            "save the model from Lotus again",
        );
        return None;
    }
    Some(names)
}

/// Converts from x back, y right to x forward, y left.
pub fn half_round([x, y, z]: [f64; 3]) -> Vec3 {
    // Zero is written without a sign.
    Vec3::from([0.0 - x, 0.0 - y, z])
}

/// Removes a spindle point that coincides with the wheel centre, since it defines no axis.
fn complete(corner: &mut Corner) {
    let [spindle, centre] = [Role::Spindle, Role::WheelCentre].map(|r| corner.points.get(&r).copied());
    if let (Some(spindle), Some(centre)) = (spindle, centre)
        && (spindle - centre).norm() == 0.0
    {
        corner.points.remove(&Role::Spindle);
    }
}
