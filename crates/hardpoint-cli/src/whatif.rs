//! `hardpoint whatif`.

use std::io::Write;

use hardpoint::Analysis;
use hardpoint::joint::Quantity;
use hardpoint::run::nearest_admissible;
use hardpoint::{draft::did_you_mean, model::Model};
use hardpoint_file::{AngleUnit, Diagnostic, LengthUnit, ModelFile, Units};
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::metric::MetricChange;
use hardpoint_report::payload::{ChangedDesign, Request, report};
use hardpoint_report::summary::Summary;
use hardpoint_report::whatif::{ChangeFact, WhatIfFacts};
use hardpoint_study::request::named;
use hardpoint_study::whatif::{add_coordinates, add_tilts, variable_named, variable_names, what_if};

use crate::args::Whatif;
use crate::folder::{Folder, of_case};
use crate::outcome::Outcome;
use crate::run::trusted;
use crate::session::{Session, json_text};
use crate::text;

/// Maximum number of hardpoints whose coordinates are ranked by default.
const MOST_RANKED: usize = 200;
/// Number of variables of each unit in the ranking of a measure.
const SHOWN: usize = 8;

/// Joint opening below which a change is admissible, as a fraction of the mechanism's size, or in rad.
const OPEN: f64 = 1e-9;
/// Factor by which the nearest admissible change must reduce the joint opening to be suggested.
const NEARER: f64 = 1e3;

/// Prints the effects of a design change, or ranks the variables.
pub fn whatif(options: &Whatif) -> Outcome {
    let session = Session::begin(options.common.json);
    let each = |file: ModelFile, case: Option<&str>| whatif_in(&session, options, file, case);
    session.end(session.for_motions(&options.common.model, &options.motions, each))
}

/// Changes of design variables that the options give, by their index in the file, which gets the variables it lacks.
fn settings(session: &Session, options: &Whatif, file: &mut ModelFile) -> Result<Vec<(usize, f64)>, Outcome> {
    let mut settings: Vec<(usize, f64)> = Vec::new();
    if let Some(name) = &options.design {
        let designs = &file.model.designs;
        let k = named("design", name, designs.iter().map(|design| design.name.as_str()))
            .map_err(|error| session.refused(file, &error))?;
        settings.extend(designs[k].changes.iter().map(|(variable, by)| (variable.0, *by)));
    }
    for text in &options.set {
        let (variable, by) = setting(file, text).map_err(|why| session.misunderstood(&why))?;
        if settings.iter().any(|(known, _)| *known == variable) {
            let name = &file.model.variables[variable].name;
            let why = format!("`--set {text}`: `{name}` is set already; give each variable one change");
            return Err(session.misunderstood(&why));
        }
        settings.push((variable, by));
    }
    Ok(settings)
}

/// True for the chosen measures; by default for those of the model file, or all outputs if it has none.
pub fn is_wanted(model: &Model, chosen: &[String], name: &str) -> bool {
    match chosen.is_empty() {
        true => model.measures.is_empty() || model.measure(name).is_some(),
        false => chosen.iter().any(|n| n == name),
    }
}

pub fn whatif_in(
    session: &Session,
    options: &Whatif,
    mut file: ModelFile,
    case: Option<&str>,
) -> Result<Outcome, Outcome> {
    let settings = settings(session, options, &mut file)?;
    if file.model.hardpoints.iter().filter(|h| !h.unnamed).count() <= MOST_RANKED {
        add_coordinates(&mut file.model);
    }
    let mut change = vec![0.0; file.model.variables.len()];
    settings.iter().for_each(|(v, by)| change[*v] += by);
    let mut nearest = Vec::new();
    let found = if settings.is_empty() { None } else { nearest_of(&file, options, &change) };
    if let Some((model, found)) = found {
        if options.admissible {
            change = taken_over(&mut file.model, &model, &found);
        } else {
            nearest = ChangeFact::all(&model, file.units, &found);
        }
    }
    session.check_measures(&file, options.measure.iter().chain(&options.over))?;
    let folder = options.output.as_ref().map(|path| Folder::open(&of_case(path, case)));
    let folder = folder.transpose().map_err(|e| session.not_written(&e))?;
    save(session, options, &file, &change)?;
    session.fits(&mut file);
    let analysis = session.plan(&file, options.common.formulation())?;

    let today = session.solve(&analysis);
    let early = |diagnostic: Diagnostic| {
        session.tell(&file, &[diagnostic]);
        if session.interrupted() { Outcome::Interrupted } else { Outcome::Stopped }
    };
    if let Some(stop) = today.stop.as_ref().filter(|_| today.motion.is_empty() || session.interrupted()) {
        session.fail(&file, &[diagnose::stop(&file, stop, today.motion.len(), None)]);
        return Err(if session.interrupted() { Outcome::Interrupted } else { Outcome::Stopped });
    }
    let of_today = |stop| diagnose::stop(&file, stop, today.motion.len(), None);
    let mut outcome = today.stop.as_ref().map(of_today).map_or(Outcome::Done, early);
    let gathered = folder.as_ref().map(|_| {
        let course = Course::of(&file.model, &today);
        let mut summary = Summary::new(&file, &analysis, &course);
        summary.validity = trusted(session, &file, &analysis, &today);
        (course, summary)
    });
    let mut facts = WhatIfFacts::of_today(&file, analysis.topology(), &today);
    let changed = (!settings.is_empty()).then(|| what_if(&analysis, today, &change));
    if let Some(changed) = &changed {
        if let Some(stop) = &changed.exact.stop {
            outcome = early(diagnose::stop_of_changed(&file, stop, changed.exact.motion.len()));
        }
        facts = WhatIfFacts { nearest, ..facts.changed(&file, analysis.topology(), changed) };
    }

    session.tell(&file, &facts.diagnostics);

    let names = &options.measure;
    let wanted = |name: &str| is_wanted(&file.model, names, name);
    let mut written = None;
    if let Some((mut folder, (course, summary))) = folder.zip(gathered) {
        let beside = changed.as_ref().map(|changed| ChangedDesign::of(&file.model, changed));
        let request = Request { changed: beside, ..Request::of(&file, &analysis, &course, &summary) };
        let finish = |payload| facts.page(payload, names, options.over.as_deref(), &wanted);
        let html = report(&request, &finish).expect("a payload is plain data");
        let json = json_text(&facts);
        let result = folder
            .write("whatif.html", |out| out.write_all(html.as_bytes()))
            .and_then(|()| folder.write("whatif.json", |out| out.write_all(json.as_bytes())))
            .and_then(|()| folder.write("whatif.csv", |out| facts.write_csv(out).map_err(Into::into)));
        written = Some(folder.path_of("whatif.html"));
        result.and_then(|()| folder.commit(&[])).map_err(|e| session.not_written(&e))?;
    }
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&facts_text(&facts, &wanted));
        text::print(&written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display())));
        let saved = options.save.as_ref();
        text::print(&saved.map_or(String::new(), |path| format!("\nsaved: {}\n", path.display())));
    }
    Ok(outcome)
}

/// Saves the changed design, if wanted.
fn save(session: &Session, options: &Whatif, file: &ModelFile, change: &[f64]) -> Result<(), Outcome> {
    let Some(to) = &options.save else { return Ok(()) };
    session.may_save(&options.common.model, Some(to))?;
    // All cases share the design, so the saved file has all of them.
    let mut whole = session.read(&options.common.model)?;
    whole.model.variables.clone_from(&file.model.variables);
    session.save(&whole, change, to)
}

/// Nearest admissible change, and the model with its variables; `None` if the change is admissible.
fn nearest_of(file: &ModelFile, options: &Whatif, change: &[f64]) -> Option<(Model, Vec<f64>)> {
    let mut model = file.model.clone();
    add_tilts(&mut model);
    let analysis = Analysis::with(&model, options.common.formulation()).ok()?;
    let nearest = nearest_admissible(&analysis, change);
    let [asked, found] = nearest.defects;
    let moves = nearest.change.iter().any(|x| *x != 0.0);
    (asked > NEARER * found && asked > OPEN && moves).then_some((model, nearest.change))
}

/// Converts a change of another model's variables to this model, and adds the variables that it lacks.
fn taken_over(model: &mut Model, of: &Model, change: &[f64]) -> Vec<f64> {
    let mut own = Vec::new();
    for (variable, by) in of.variables.iter().zip(change).filter(|(_, by)| **by != 0.0) {
        own.extend(variable_named(model, &variable.name).map(|v| (v.0, *by)));
    }
    let mut change = vec![0.0; model.variables.len()];
    own.into_iter().for_each(|(v, by)| change[v] += by);
    change
}

fn facts_text(facts: &WhatIfFacts, wanted: &dyn Fn(&str) -> bool) -> String {
    let mut out = format!("{}\n", text::bold(&facts.name));
    if !facts.change.is_empty() {
        let table = facts.table(wanted);
        out += &text::pairs(&facts.change_rows());
        if table.rows.is_empty() {
            out += "\nThe model has no measures: add `[measures]` or `[points]` to see how the change affects the motion.\n";
        } else {
            out += &format!("{}  {}\n", text::section(&table), table.note);
        }
        out += &MetricChange::table(&facts.metrics).map_or(String::new(), |table| text::section(&table));
    }
    for measure in facts.ranked().into_iter().filter(|m| wanted(m)) {
        let ranking = facts.ranking(measure, SHOWN);
        out += &match ranking.rows.is_empty() {
            true => format!("\n{}\n", ranking.title),
            false => text::section(&ranking),
        };
        if !ranking.note.is_empty() {
            out += &format!("  {}\n", ranking.note);
        }
    }
    out
}

/// Variable of a `--set` and its change in SI.
fn setting(file: &mut ModelFile, text: &str) -> Result<(usize, f64), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("`--set {text}`: write NAME=CHANGE, like `tie_rod_outer.z=+2mm`"))?;
    let name = name.trim();
    let Some(variable) = variable_named(&mut file.model, name) else {
        let names = variable_names(&file.model);
        let hint = did_you_mean(name, names.iter().map(String::as_str));
        let hint = hint.map_or(String::new(), |known| format!("; did you mean `{known}`?"));
        return Err(format!(
            "`{name}` is not a design variable, hardpoint coordinate (NAME.x) or joint tilt (NAME.tilt_x) of the model{hint}"
        ));
    };
    let quantity = file.model.variables[variable.0].quantity;
    let by = in_si(value.trim(), quantity, file.units).map_err(|why| format!("`--set {text}`: {why}"))?;
    Ok((variable.0, by))
}

/// Parses a change and converts it to SI: `2`, `2.5mm`, `2,5 mm`, `1/2 in`, `-1 1/2 IN`, `0.5 °`.
pub fn in_si(text: &str, quantity: Quantity, units: Units) -> Result<f64, String> {
    let (value, written) = amount(text).ok_or_else(|| format!("`{text}` is not a number with a unit"))?;
    if !value.is_finite() {
        return Err(format!("`{text}` is not finite"));
    }
    let unit = if written == "°" { "deg".to_owned() } else { written.to_lowercase() };
    let (length, angle) = (LengthUnit::of_symbol(&unit), AngleUnit::of_symbol(&unit));
    match (quantity, length, angle) {
        (_, None, None) if unit.is_empty() => Ok(units.to_si(quantity, value)),
        (Quantity::Length, Some(unit), _) => Ok(unit.metres(value)),
        (Quantity::Angle, _, Some(unit)) => Ok(unit.radians(value)),
        (_, None, None) => Err(format!("there is no unit `{written}`; write mm, cm, m, in, deg or rad")),
        (Quantity::Length, ..) => Err(format!("it is a length, but {written} is not a unit of length")),
        (Quantity::Angle, ..) => Err(format!("it is an angle, but {written} is not a unit of angle")),
        (Quantity::Number, ..) => Err(format!("it is dimensionless, but the unit `{written}` was given")),
    }
}

/// Parses both ends of a range and converts them to SI. A unit after the second end is that of the first as well,
/// unless that has a unit of its own: `-3..6deg` is from -3 deg to 6 deg.
pub fn range_in_si([from, to]: [&str; 2], quantity: Quantity, units: Units) -> Result<[f64; 2], String> {
    let [from, to] = [from.trim(), to.trim()];
    let first = match (amount(from), amount(to)) {
        (Some((_, "")), Some((_, unit))) => format!("{from} {unit}"),
        _ => from.to_owned(),
    };
    Ok([in_si(&first, quantity, units)?, in_si(to, quantity, units)?])
}

/// Number and unit of a text, by the rules of the page's fields. The unit may be empty.
pub fn amount(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let (negative, rest) = match text.strip_prefix(['-', '−']) {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let rest = rest.trim_start();
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '/') || c.is_whitespace();
    let mut end = rest.find(|c| !is_number(c)).unwrap_or(rest.len());
    // The exponent of `1e3` is no unit.
    if let Some(exponent) = rest[end..].strip_prefix(['e', 'E']) {
        let digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        let count = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        if count > 0 && rest[..end].ends_with(|c: char| !c.is_whitespace()) {
            end = rest.len() - digits.len() + count;
        }
    }
    let (number, unit) = (rest[..end].trim(), rest[end..].trim());
    let whole = |text: &str| text.parse::<u32>().ok().filter(|_| !text.starts_with('+')).map(f64::from);
    let size = match number.split_once('/') {
        Some((top, bottom)) => {
            let top = top.trim();
            let (before, top) = top.split_once(char::is_whitespace).unwrap_or(("0", top));
            whole(before)? + whole(top.trim())? / whole(bottom.trim())?
        }
        None => number.replacen(',', ".", 1).parse().ok()?,
    };
    Some((if negative { -size } else { size }, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_after_a_range_is_that_of_both_ends() {
        let units = Units { length: LengthUnit::Millimetre, angle: AngleUnit::Radian };
        let length = |from, to| range_in_si([from, to], Quantity::Length, units);
        let angle =
            |from, to| range_in_si([from, to], Quantity::Angle, units).map(|ends| ends.map(f64::to_degrees));
        let near = |found: Result<[f64; 2], String>, expected: [f64; 2]| {
            let found = found.unwrap();
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
        };
        near(length("-1", "0.5in"), [-0.0254, 0.0127]);
        near(length("-1", "0.5"), [-0.001, 0.0005]);
        near(length("-1cm", "0.5in"), [-0.01, 0.0127]);
        near(length("-1cm", "5"), [-0.01, 0.005]);
        near(angle(" -3 ", " 6° "), [-3.0, 6.0]);
        assert_eq!(length("-1", "5deg"), Err("it is a length, but deg is not a unit of length".to_owned()));
        assert_eq!(length("a", "5mm"), Err("`a` is not a number with a unit".to_owned()));
    }

    #[test]
    fn amounts_are_read_as_in_the_fields_of_the_page() {
        let units = Units { length: LengthUnit::Millimetre, angle: AngleUnit::Degree };
        let length = |text: &str| in_si(text, Quantity::Length, units).map(|x| (x * 1e9).round() / 1e9);
        for (text, metres) in [
            ("2", 0.002),
            ("+2mm", 0.002),
            ("-2,5 mm", -0.0025),
            ("−2,5", -0.0025),
            (".5cm", 0.005),
            ("1e-2", 0.000_01),
            ("1E1mm", 0.01),
            ("1/2 in", 0.0127),
            ("1 1/2in", 0.0381),
            ("-1/4 IN", -0.006_35),
            ("3 MM", 0.003),
            ("1e3 mm", 1.0),
        ] {
            assert_eq!(length(text), Ok(metres), "{text}");
        }
        let angle = |text: &str| in_si(text, Quantity::Angle, units).map(f64::to_degrees);
        assert!((angle("0,5°").unwrap() - 0.5).abs() < 1e-12);
        assert!((angle("1 Deg").unwrap() - 1.0).abs() < 1e-12);
        for text in ["", "mm", "1,2,3", "1.2.3mm", "1 2 mm", "1/2/3", "--1", "1//2", "e3", "+-1", "1/ in"] {
            assert!(in_si(text, Quantity::Length, units).is_err(), "{text}");
        }
        assert_eq!(length("1/0"), Err("`1/0` is not finite".into()));
        assert_eq!(length("1 deg"), Err("it is a length, but deg is not a unit of length".into()));
        assert_eq!(
            length("1 Furlong"),
            Err("there is no unit `Furlong`; write mm, cm, m, in, deg or rad".into())
        );
    }
}
