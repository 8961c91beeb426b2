//! The command: a new model file from a template, or from points.

use super::axes::{Axes, plain};
use super::{fit, table};
use crate::args::New;
use crate::folder::write_new;
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;
use hardpoint::draft::did_you_mean;
use hardpoint_file::LengthUnit;
use std::io::{BufRead, IsTerminal};
use std::path::{Path, PathBuf};

/// A template.
pub struct Template {
    /// Name.
    pub name: &'static str,
    /// Description in a few words.
    pub what: &'static str,
    /// Text of the model.
    pub text: &'static str,
    /// True if its axes are those of a vehicle.
    is_vehicle: bool,
}

impl Template {
    /// True if it is planar, in the plane of x and y.
    fn is_planar(&self) -> bool {
        self.text.contains("\nplanar = \"xy\"")
    }
}

macro_rules! templates {
    ($($name:literal: $what:literal, $is_vehicle:literal;)*) => {
        &[$(Template {
            name: $name,
            what: $what,
            text: include_str!(concat!("../../templates/", $name, ".toml")),
            is_vehicle: $is_vehicle,
        }),*]
    };
}

/// All templates.
pub static TEMPLATES: &[Template] = templates! {
    "double-wishbone": "front suspension on two wishbones, with a rack", true;
    "macpherson": "front suspension on a strut, with a rack", true;
    "k-and-c": "front axle on bushings, on a rig for kinematics and compliance", true;
    "five-link": "rear suspension on five rods", true;
    "solid-axle": "live axle on three links and a Panhard rod, both sides", true;
    "four-bar": "crank, coupler and rocker in a plane", false;
    "slider-crank": "crank, rod and slider in a plane", false;
    "stewart": "platform on six legs", false;
    "delta": "Delta robot, by its dimensions as parameters", false;
};

/// Writes the model, or reports an error.
pub fn run(options: &New) -> Outcome {
    let session = Session::begin(false);
    if options.list {
        text::print(&list());
        return Outcome::Done;
    }
    session.end(begun(&session, options))
}

fn list() -> String {
    let rows: Vec<(&str, String)> = TEMPLATES.iter().map(|t| (t.name, t.what.to_owned())).collect();
    text::pairs(&rows)
}

fn begun(session: &Session, options: &New) -> Result<Outcome, Outcome> {
    let given = options.name.as_deref().unwrap_or(Path::new(""));
    let (path, name) = file_of(given).ok_or_else(|| {
        session.misunderstood(&format!("`{}` is not a file name", text::shown(&given.display().to_string())))
    })?;
    if path.exists() {
        return Err(exists(session, &path));
    }
    let template = template(session, options.template.as_deref())?;
    let places = match &options.hardpoints {
        Some(table) => places(session, template, table, options)?,
        None => Vec::new(),
    };
    let mut model = hardpoint_file::placed(template.text, &name, &places);
    if options.hardpoints.is_some() {
        model = fit::fitted(session, template.text, model);
    }
    // The model with the user's hardpoints is read back, so that errors in them are reported.
    let problems = hardpoint_file::parse(&model, &path.display().to_string()).err();
    write(session, &path, &model)?;
    if let Some(problems) = problems {
        session.not_read(&problems);
        return Ok(Outcome::BadModel);
    }
    let shown = text::argument(path.display().to_string());
    text::print(&format!(
        "{}: {}\n\n  hardpoint run {shown}\n  hardpoint studio {shown}\n",
        path.display(),
        template.what
    ));
    Ok(Outcome::Done)
}

/// File for a name, and the name of the model in it.
fn file_of(given: &Path) -> Option<(PathBuf, String)> {
    let is_toml = given.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let file = given.file_name()?.to_str()?;
    let name = if is_toml { given.file_stem()?.to_str()? } else { file };
    Some((
        if is_toml { given.to_owned() } else { given.with_file_name(format!("{file}.toml")) },
        name.to_owned(),
    ))
}

fn exists(session: &Session, path: &Path) -> Outcome {
    let what = format!("the file `{}` exists already", path.display());
    session.not_begun(&what, "nothing was written", "choose another name")
}

fn write(session: &Session, path: &Path, model: &str) -> Result<(), Outcome> {
    write_new(path, model.as_bytes()).map_err(|e| match e.error.kind() {
        std::io::ErrorKind::AlreadyExists => exists(session, path),
        _ => session.not_written(&e),
    })
}

/// Template of that name; without a name, the user is asked.
fn template(session: &Session, name: Option<&str>) -> Result<&'static Template, Outcome> {
    let name = match name {
        Some(name) => name.to_owned(),
        None => asked(&format!("{}\ntemplate: ", list())).ok_or_else(|| {
            session.misunderstood(
                "no template given; select one with `--template`; `hardpoint new --list` shows them",
            )
        })?,
    };
    template_named(session, &name)
}

/// Template of that name.
///
/// # Errors
/// Fails if there is none, which is reported.
pub fn template_named(session: &Session, name: &str) -> Result<&'static Template, Outcome> {
    let wanted = plain(name);
    TEMPLATES.iter().find(|t| plain(t.name) == wanted).ok_or_else(|| {
        let near = did_you_mean(name, TEMPLATES.iter().map(|t| t.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        let all: Vec<&str> = TEMPLATES.iter().map(|t| t.name).collect();
        let what = format!("there is no template `{}`{near}", text::shown(name));
        session.not_begun(&what, &format!("the templates: {}", all.join(", ")), "select one of them")
    })
}

/// Answer of the user on a terminal; `None` without a terminal.
fn asked(question: &str) -> Option<String> {
    if !(std::io::stdin().is_terminal() && std::io::stderr().is_terminal()) {
        return None;
    }
    text::complain(question);
    let mut answer = String::new();
    std::io::stdin().lock().read_line(&mut answer).ok()?;
    Some(answer.trim().to_owned()).filter(|answer| !answer.is_empty())
}

/// Coordinates of the template's hardpoints from a table, in mm and in the template's axes.
fn places(
    session: &Session,
    template: &Template,
    file: &Path,
    options: &New,
) -> Result<Vec<(String, [f64; 3])>, Outcome> {
    let shown = text::shown(&file.display().to_string()).into_owned();
    let refused = |what: &str, why: &str, help: &str| session.not_begun(what, why, help);
    let wanted = hardpoint_file::hardpoints_in(template.text);
    if wanted.is_empty() {
        let what = format!("the template `{}` does not accept hardpoints", template.name);
        return Err(refused(
            &what,
            "its hardpoints follow from its parameters",
            "leave `--hardpoints` out, and change the parameters",
        ));
    }
    let table = table::read(file, template.is_planar()).map_err(|problem| {
        refused(
            &format!("`{shown}` is not a table of hardpoints"),
            &problem,
            "give a name, x, y and z on each line",
        )
    })?;
    let unit = unit(session, options, table.unit.as_deref(), &shown)?;
    let axes = match (&options.axes, template.is_vehicle) {
        (Some(axes), _) => Some(axes.clone()),
        (None, true) => {
            asked("axes of the table (iso, sae, adams, lotus, or like \"x back, y right, z up\"): ")
        }
        (None, false) => Some("iso".to_owned()),
    };
    let axes = axes.ok_or_else(|| {
        session.misunderstood(
            "the axes of the table are unknown; give them with `--axes`, like `iso` or \"x back, y right, z up\"",
        )
    })?;
    let axes: Axes =
        axes.parse().map_err(|why: String| session.misunderstood(&format!("`--axes`: {why}")))?;
    let mut places: Vec<(String, [f64; 3])> = Vec::new();
    let mut unknown = Vec::new();
    for row in table.rows {
        let Some(name) = wanted.iter().find(|w| plain(w) == plain(&row.name)) else {
            unknown.push(row.name);
            continue;
        };
        if places.iter().any(|p| p.0 == *name) {
            let what = format!("`{shown}` has the hardpoint `{name}` twice");
            return Err(refused(
                &what,
                &format!("the second one is on line {}", row.line),
                "remove one of them",
            ));
        }
        places.push((name.clone(), axes.turned(row.place).map(|x| millimetres(unit, x))));
    }
    fit::spindle(session, template.text, &wanted, &mut places);
    let missing: Vec<&str> =
        wanted.iter().map(String::as_str).filter(|w| !places.iter().any(|p| p.0 == **w)).collect();
    for name in &unknown {
        let near = did_you_mean(name, missing.iter().copied());
        let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        session
            .remark(&format!("the template has no hardpoint `{}`: it is not used{near}", text::shown(name)));
    }
    if !missing.is_empty() {
        let names: Vec<String> = missing.iter().map(|n| format!("`{n}`")).collect();
        let what = format!("`{shown}` lacks the hardpoint {}", names.join(", "));
        let help =
            "add them, or rename them as in the template; the template without a table shows each of them";
        return Err(refused(&what, "hardpoints of the template and of the table cannot be mixed", help));
    }
    if template.is_planar() {
        in_one_plane(session, &places, &shown)?;
    }
    Ok(places)
}

/// Converts a length to mm and keeps its digits: powers of ten move the decimal point, and inches leave no round-off.
fn millimetres(unit: LengthUnit, x: f64) -> f64 {
    let moved = |by: i32| {
        let text = format!("{x:e}");
        let (digits, exponent) = text.split_once('e')?;
        format!("{digits}e{}", exponent.parse::<i32>().ok()? + by).parse::<f64>().ok()
    };
    let moved = match unit {
        LengthUnit::Millimetre => Some(x),
        LengthUnit::Centimetre => moved(1),
        LengthUnit::Metre => moved(3),
        // Arithmetic in double precision keeps fifteen digits.
        LengthUnit::Inch => format!("{:.14e}", x * 25.4).parse().ok(),
    };
    moved.unwrap_or_else(|| unit.metres(x) * 1e3)
}

/// Unit of a table: from the command line, from the table, or from the user's answer.
fn unit(session: &Session, options: &New, said: Option<&str>, shown: &str) -> Result<LengthUnit, Outcome> {
    let named = LengthUnit::of_symbol;
    let known = "valid units: mm, cm, m or in";
    let wrong = |text: &str| session.misunderstood(&format!("`--units {}`: {known}", text::shown(text)));
    let given = options.units.as_deref().map(|text| named(text).ok_or_else(|| wrong(text))).transpose()?;
    let Some(said) = said else {
        return match given {
            Some(unit) => Ok(unit),
            None => {
                let text = asked("unit of the table (mm, cm, m, in): ").ok_or_else(|| {
                    session.misunderstood("the unit of the table is unknown; give it with `--units`")
                })?;
                named(&text).ok_or_else(|| wrong(&text))
            }
        };
    };
    let what = format!("the columns of `{shown}` are in `{}`", text::shown(said));
    match (named(said), given) {
        (None, _) => Err(session.not_begun(&what, known, "write the table in one of them")),
        (Some(unit), Some(given)) if unit != given => {
            let why = format!("`--units` says `{}`", given.symbol());
            Err(session.not_begun(&what, &why, "leave `--units` out, or correct the names of the columns"))
        }
        (Some(unit), _) => Ok(unit),
    }
}

/// Checks that the hardpoints of a planar template lie in its plane, z = 0, or in a parallel plane.
fn in_one_plane(session: &Session, places: &[(String, [f64; 3])], shown: &str) -> Result<(), Outcome> {
    let Some((first, [_, _, z])) = places.first() else { return Ok(()) };
    if let Some((other, [_, _, there])) = places.iter().find(|(_, p)| p[2] != *z) {
        let what = format!("the hardpoints of `{shown}` do not lie in the plane of x and y");
        let why = format!("`{first}` is at z = {z} mm, `{other}` at z = {there} mm");
        let help = "leave their z out, or select the coordinates in the plane with `--axes`, \
                    like \"x forward, z left, y up\" for those in x and z";
        return Err(session.not_begun(&what, &why, help));
    }
    if *z != 0.0 {
        session.remark(&format!("all hardpoints are at z = {z} mm: the model has them at z = 0"));
    }
    Ok(())
}
