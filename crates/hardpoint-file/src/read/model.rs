//! The model as a whole: its keys, its units, and the order in which its sections are read.

use std::collections::HashMap;

use hardpoint::draft::Section;
use hardpoint::model::{ChangePointPolicy, LoadMode};
use toml::de::DeTable;

use crate::compose::{INCLUDE, MIRROR, PLANAR};
use crate::values::{EntryPlace, Fields, LENGTH, Reader, Shape, Table, Value, closest, table};
use hardpoint_table::{AngleUnit, LengthUnit};

use super::elements::{LOAD_MODES, LOADS};
use super::raw::Raw;
use super::{
    bodies, calibrate, cases, couplers, design, drivers, elements, equilibrium, hardpoints, joints, measures,
    metrics, optimize, page, parameters, points, shapes, start, sweep, times, tolerance, wheels,
};

/// The file as a whole.
pub(crate) const MODEL: Table = table! {
    /// A mechanism for Hardpoint.
    "Hardpoint model":
    /// Name of the mechanism, for headings.
    must "name": Shape::Text, "\"four-bar\"";
    /// Description of the mechanism, and the source of its numbers.
    may "description": Shape::Text, "\"...\"";
    /// The units of all numbers in this file. Time is always in seconds.
    must "units": Shape::Table(&UNITS), "{ length = \"mm\", angle = \"deg\" }";
    /// Named numbers for expressions in quotes, which are possible in place of numbers. Each is a design variable,
    /// unless it has `design = false` or is itself given by an expression.
    may "parameters": Shape::Entries("a parameter", &parameters::PARAMETER), "{ hub = { value = 60, unit = \"length\" } }";
    /// Named points of the design configuration: `name = [x, y, z]`, global, in the length unit. Expressions may use
    /// coordinates of others, like `"-left.y"`.
    may "hardpoints": Shape::Entries("a hardpoint", &Shape::exactly(3, &LENGTH)), "{ A = [0, 0, 0] }";
    /// Rigid bodies. `ground` always exists and is not declared.
    must "bodies": Shape::Entries("a body", &bodies::BODY_SHAPE), "{ crank = {} }";
    /// Joints between two bodies.
    may "joints": Shape::Entries("a joint", &Shape::Table(&joints::JOINT)), "{}";
    /// Gears, racks, belts and other linear relations between joint coordinates.
    may "couplers": Shape::Entries("a coupler", &Shape::Kinds(&couplers::COUPLER)), "{}";
    /// Prescribed motions: of joint coordinates, points, distances and orientations.
    may "drivers": Shape::Entries("a driver", &Shape::Kinds(&drivers::DRIVER)), "{}";
    /// Placements of bodies at which the assembly starts, for another assembly than that of the design configuration.
    may "start": Shape::Entries("a body", &Shape::Table(&start::START)), "{ rocker = { turn = [0, 0, -73.2] } }";
    /// Design variables: changes of the design, and their effects on other elements.
    may "design": Shape::Entries("a design variable", &Shape::Kinds(&design::VARIABLE)), "{}";
    /// Points of bodies whose motion is computed.
    may "points": Shape::Entries("a point", &Shape::Table(&points::POINT)), "{}";
    /// Vehicle data, for anti-dive and Ackermann.
    may "vehicle": Shape::Table(&wheels::VEHICLE), "{ wheelbase = 2600 }";
    /// Road wheels, for their measures.
    may "wheels": Shape::Entries("a wheel", &Shape::Table(&wheels::WHEEL)), "{}";
    /// Pairs of wheels, for their measures.
    may "axles": Shape::Entries("an axle", &Shape::Table(&wheels::AXLE)), "{}";
    /// Shapes of bodies, for clearances.
    may "shapes": Shape::Entries("a shape", &Shape::Kinds(&shapes::SHAPE)), "{}";
    /// Distances between shapes over the motion.
    may "clearances": Shape::Entries("a clearance", &Shape::Table(&shapes::CLEARANCE)), "{}";
    /// Direction and acceleration of gravity.
    may "gravity": Shape::Table(&elements::GRAVITY), "{ along = \"-z\" }";
    /// Loads with or without the inertia of the masses.
    or("\"dynamic\"") "loads": LOADS, "\"static\"";
    /// Masses, for loads.
    may "masses": Shape::Entries("a mass", &Shape::Kinds(&elements::MASS)), "{}";
    /// Applied forces: springs, dampers, friction, given forces; bushings and elastic joints.
    may "forces": Shape::Entries("a force", &Shape::Kinds(&elements::FORCE)), "{}";
    /// Static equilibrium at every output time: elastic joints open under load, and released drivers move.
    may "equilibrium": Shape::Table(&equilibrium::EQUILIBRIUM), "{ released = [\"bump\"] }";
    /// Numbers to compute from the motion, with their sensitivities.
    may "measures": Shape::Entries("a measure", &measures::MEASURE), "{}";
    /// Numbers of a measure's curve over the motion, with their sensitivities.
    may "metrics": Shape::Entries("a metric", &Shape::Table(&metrics::METRIC)), "{}";
    /// The output times. They may be left out if every case has its own.
    may "time": Shape::Kinds(&times::TIME), "{ end = 1.0, steps = 100 }";
    /// Behaviour at a change point, where two motions of the mechanism meet, such as a parallelogram with its bars in
    /// line.
    or("\"stop\"") "at_change_points": CHANGE_POINTS, "\"continue\"";
    /// Several motions of the mechanism, in place of the one by the drivers' own laws.
    may "cases": Shape::Entries("a case", &Shape::Table(&cases::CASE)), "{}";
    /// Plane of the mechanism: points may have two coordinates, and pins need no axis.
    may "planar": PLANAR, "\"xy\"";
    /// Other files; their entries apply unless this file has them itself.
    may "include": INCLUDE, "[\"corner.toml\"]";
    /// Applies the entries of one side to the other side as well.
    may "mirror": Shape::Table(&MIRROR), "{ across = \"y\", names = { left = \"right\" } }";
    /// Goals and limits of the optimisation.
    may "optimize": Shape::Table(&optimize::OPTIMIZE), "{ goals = { toe = { metric = \"toe_error\" } } }";
    /// Tolerances of the design, and the limits that it must keep.
    may "tolerance": Shape::Table(&tolerance::TOLERANCE), "{ variables = { B_x = 0.1 } }";
    /// Designs of a sweep, and the results that are stored.
    may "sweep": Shape::Table(&sweep::SWEEP), "{ variables = { B_x = [-5, 5] } }";
    /// Fitted variables of a calibration, and prior knowledge about them.
    may "calibrate": Shape::Table(&calibrate::CALIBRATE), "{ variables = { rod = 0.5 } }";
    /// Named designs: values of design variables, for comparison.
    may "designs": Shape::Entries("a design", &page::DESIGN), "{ softer = { B_x = 2.5 } }";
    /// Contents of the report's page.
    may "page": Shape::Table(&page::PAGE), "{ plots = [{ y = [\"toe\"], over = \"wheel_travel\" }] }";
};
const CHANGE_POINTS: Shape = Shape::Words(&[
    ("stop", "The motion ends there."),
    (
        "continue",
        "The motion continues smoothly if it can, and stops otherwise. At the change point, sensitivities and loads are undefined.",
    ),
]);
pub(super) const UNITS: Table = table! {
    /// The units of all numbers in the file.
    "Units":
    /// Unit of every length.
    must "length": Shape::Known("the symbol of a unit", || LengthUnit::ALL.map(|unit| (unit.symbol(), String::new())).into()), "\"mm\"";
    /// Unit of every angle.
    must "angle": Shape::Known("the symbol of a unit", || AngleUnit::ALL.map(|unit| (unit.symbol(), String::new())).into()), "\"deg\"";
};
/// Common other spellings of a unit's symbol.
const UNIT_WORDS: [(&str, &str); 12] = [
    ("millimetre", "mm"),
    ("millimeters", "mm"),
    ("centimetre", "cm"),
    ("centimeters", "cm"),
    ("metre", "m"),
    ("meters", "m"),
    ("inch", "in"),
    ("inches", "in"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
];
/// Tables of `docs/file-format.md`, by their names there.
#[cfg(test)]
pub(crate) fn tables() -> [(&'static str, Shape); 51] {
    use super::{declared, law, mesh};
    use crate::compose::INCLUDE_TABLE;

    [
        ("include", Shape::Table(&INCLUDE_TABLE)),
        ("mirror", Shape::Table(&MIRROR)),
        ("parameters", Shape::Table(&parameters::PARAMETER_TABLE)),
        ("frames", Shape::Kinds(&bodies::FRAME)),
        ("meshes", Shape::Table(&mesh::MESH_TABLE)),
        ("joints", Shape::Table(&joints::JOINT)),
        ("limits of joints", Shape::Table(&joints::LIMIT)),
        ("curves", Shape::Table(&joints::CURVE)),
        ("couplers", Shape::Kinds(&couplers::COUPLER)),
        ("terms", Shape::Table(&couplers::TERM)),
        ("drivers", Shape::Kinds(&drivers::DRIVER)),
        ("laws", Shape::Kinds(&law::LAW_TABLE)),
        ("pieces", Shape::Table(&law::PIECE)),
        ("start", Shape::Table(&start::START)),
        ("design variables", Shape::Kinds(&design::VARIABLE)),
        ("shape fields", Shape::Kinds(&design::SHAPE_FIELD)),
        ("fields", Shape::Table(&design::FIELD)),
        ("markers", Shape::Table(&design::MARKER)),
        ("points", Shape::Table(&points::POINT)),
        ("the vehicle", Shape::Table(&wheels::VEHICLE)),
        ("wheels", Shape::Table(&wheels::WHEEL)),
        ("axles", Shape::Table(&wheels::AXLE)),
        ("gravity", Shape::Table(&elements::GRAVITY)),
        ("shapes", Shape::Kinds(&shapes::SHAPE)),
        ("clearances", Shape::Table(&shapes::CLEARANCE)),
        ("masses", Shape::Kinds(&elements::MASS)),
        ("forces", Shape::Kinds(&elements::FORCE)),
        ("equilibrium", Shape::Table(&equilibrium::EQUILIBRIUM)),
        ("measures", Shape::Kinds(&measures::OWN_MEASURE)),
        ("metrics", Shape::Table(&metrics::METRIC)),
        ("time", Shape::Kinds(&times::TIME)),
        ("cases", Shape::Table(&cases::CASE)),
        ("grids", Shape::Kinds(&cases::SWEEP)),
        ("targets in files", Shape::Table(&metrics::TARGET_FILE)),
        ("forces in files", Shape::Table(&declared::FORCE_FILE)),
        ("moments in files", Shape::Table(&declared::MOMENT_FILE)),
        ("optimize", Shape::Table(&optimize::OPTIMIZE)),
        ("goals", Shape::Table(&optimize::GOAL)),
        ("limits", Shape::Kinds(&optimize::LIMIT)),
        ("tolerance", Shape::Table(&tolerance::TOLERANCE)),
        ("tolerances of variables", Shape::Table(&tolerance::ENTRY_TABLE)),
        ("correlations", Shape::Table(&tolerance::CORRELATION)),
        ("limits of tolerances", Shape::Table(&tolerance::LIMIT)),
        ("sweep", Shape::Table(&sweep::SWEEP)),
        ("ranges of variables", Shape::Table(&sweep::RANGE)),
        ("calibrate", Shape::Table(&calibrate::CALIBRATE)),
        ("priors of variables", Shape::Table(&calibrate::PRIOR)),
        ("groups of priors", Shape::Table(&calibrate::GROUP)),
        ("offsets", Shape::Table(&calibrate::OFFSET)),
        ("page", Shape::Table(&page::PAGE)),
        ("plots", Shape::Table(&page::PLOT)),
    ]
}

pub(crate) fn model<'a>(
    r: &mut Reader<'_>,
    table: &'a DeTable<'a>,
    twins: &HashMap<String, Value<'_>>,
) -> Raw {
    let mut raw = Raw::default();
    let fields = r.fields("the model", 0..0, table, MODEL.keys());
    let place = EntryPlace::of(&fields);
    r.lost_tables(&fields);
    raw.push(r, Section::Model, place);
    let name = r.need(&fields, "name");
    raw.draft.name = name.and_then(|f| r.text(&fields, f)).unwrap_or_default();
    raw.description = fields.get("description").and_then(|f| r.text(&fields, f));
    units(r, &fields);
    parameters::parameters(r, &fields, &mut raw);
    hardpoints::hardpoints(r, &fields, &mut raw);
    hardpoints::settle(r, &mut raw);
    bodies::bodies(r, &fields, &mut raw);
    joints::joints(r, &fields, &mut raw);
    couplers::couplers(r, &fields, &mut raw);
    measures::measures(r, &fields, &mut raw);
    joints::limit_measures(&mut raw);
    drivers::drivers(r, &fields, &mut raw);
    start::start(r, &fields, &mut raw);
    design::design(r, &fields, &mut raw, twins);
    points::points(r, &fields, &mut raw);
    wheels::vehicle(r, &fields, &mut raw);
    wheels::wheels(r, &fields, &mut raw);
    wheels::axles(r, &fields, &mut raw);
    shapes::shapes(r, &fields, &mut raw);
    shapes::clearances(r, &fields, &mut raw);
    elements::gravity(r, &fields, &mut raw);
    raw.draft.load_mode = r.word_of(&fields, "loads").map_or(LoadMode::default(), |k| LOAD_MODES[k]);
    elements::masses(r, &fields, &mut raw);
    elements::forces(r, &fields, &mut raw);
    equilibrium::equilibrium(r, &fields, &mut raw);
    metrics::metrics(r, &fields, &mut raw);
    shapes::least(r, &mut raw);
    joints::limit_metrics(r, &mut raw);
    times::time(r, &fields, &mut raw);
    let word = r.word_of(&fields, "at_change_points");
    raw.draft.at_change_points = word.map_or(ChangePointPolicy::default(), |k| ChangePointPolicy::WORDS[k].1);
    cases::cases(r, &fields, &mut raw);
    optimize::optimize(r, &fields, &mut raw);
    tolerance::tolerance(r, &fields, &mut raw);
    sweep::sweep(r, &fields, &mut raw);
    calibrate::calibrate(r, &fields, &mut raw);
    page::designs(r, &fields, &mut raw);
    page::page(r, &fields, &mut raw);
    raw
}

pub(super) fn units(r: &mut Reader<'_>, model: &Fields<'_>) {
    let Some(f) = model.get("units") else {
        let message = format!("{} has no `units`", model.what);
        r.report("HP0104", model.at.clone(), message).help = Some(
            "add near the top `units = { length = \"mm\", angle = \"deg\" }`; lengths may be in mm, cm, m or in, \
             angles in deg or rad"
                .into(),
        );
        return;
    };
    let subject = model.subject("units");
    let Some(table) = r.table(f.value, &subject, "a table of a length and an angle unit") else {
        return;
    };
    let fields = r.fields("`units`", f.value.span(), table, UNITS.keys());
    let [length, angle] = ["length", "angle"].map(|key| {
        let before = r.found.len();
        let found = r.word_of(&fields, key);
        let written = fields.get(key).and_then(|f| f.value.get_ref().as_str());
        if let (Some(written), Some(d)) = (written, r.found.get_mut(before)) {
            let words =
                UNIT_WORDS.iter().filter(|(_, symbol)| fields.key(key).shape.words().contains(symbol));
            let meant = closest(written, words.clone().map(|w| w.0));
            let meant = words.clone().find(|w| Some(w.0) == meant);
            d.help = meant.map(|(_, meant)| format!("did you mean `{meant}`?")).or(d.help.take());
        }
        found
    });
    r.units.length = length.map_or(LengthUnit::Metre, |k| LengthUnit::ALL[k]);
    r.units.angle = angle.map_or(AngleUnit::Radian, |k| AngleUnit::ALL[k]);
}
