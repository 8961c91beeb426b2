//! The vehicle, its road wheels and axles, and the measures that they list.

use hardpoint::draft::{
    AxleDraft, DirectionDraft, LocationDraft, MeasureDraft, MeasureKindDraft, PointRef, Section, WheelDraft,
    WheelSpinDraft,
};
use hardpoint::model::{
    AxleMeasure, Side, TorqueReaction, Vehicle, VehicleEnd, WheelMeasure, WheelRequirement,
};
use hardpoint::space::Vec3;

use crate::values::{
    ANGLE, BODY, DRIVER, EntryPlace, Field, Fields, LENGTH, LINE, NUMBER, PLACE, Reader, Severity, Shape,
    Table, all_read, table,
};

use super::measures::{AXLE_MEASURE, WHEEL_MEASURE};
use super::points;
use super::points::POINT_REF;
use super::raw::Raw;

pub(crate) const WHEEL: Table = table! {
    /// A road wheel. Axes are x forward, y left, z up.
    "Wheel":
    /// The body that carries it: the knuckle.
    must "body": BODY, "\"knuckle\"";
    /// Centre in the design configuration: a hardpoint's name (it then follows the hardpoint), or coordinates.
    must "centre": PLACE, "\"wheel_centre\"";
    /// Spin axis in the design configuration, pointing outboard; or `toe` and `camber`.
    may "spin_axis": LINE, "[0, 1, 0]";
    /// Toe in the design configuration, instead of a spin axis; positive for toe-in, in the angle unit.
    may "toe": ANGLE, "0.1";
    /// Camber in the design configuration, instead of a spin axis; positive where the wheel's top leans outboard, in
    /// the angle unit.
    may "camber": ANGLE, "-1";
    /// Loaded or rolling radius, from the centre to the ground in the wheel's plane, in the length unit.
    must "radius": LENGTH, "310";
    /// Side of the vehicle. Default: left if the y of its centre is positive, else right.
    may "side": Shape::Words(&[("left", ""), ("right", "")]), "\"left\"";
    /// A lower and an upper point of the steering axis; they may be on different bodies.
    may "kingpin": Shape::exactly(2, &POINT_REF), "[\"lower_ball\", { body = \"ground\", at = \"strut_top\" }]";
    /// The driver that moves it up and down, for roll centres, bump steer and the like. Default: the only driver.
    may "bump": DRIVER, "\"jounce\"";
    /// The driver that steers it, for the virtual steering axis.
    may "steer": DRIVER, "\"rack\"";
    /// Planes of the lower and upper arm, for graphical instant centres: tables of a `body` and two or three points
    /// `at`.
    may "arm_planes": Shape::exactly(2, &ARM_PLANE_SHAPE),
        "[{ body = \"lca\", at = [\"lca_front\", \"lca_rear\", \"lower_ball\"] }, { body = \"strut\", at = [\"strut_top\", \"strut_lower\"] }]";
    /// Ends of its spring, for the motion ratio.
    may "spring": Shape::exactly(2, &POINT_REF), "[{ body = \"ground\", at = \"spring_top\" }, { body = \"lca\", at = \"spring_bottom\" }]";
    /// End of the vehicle, for anti-dive and similar measures.
    may "end": Shape::Words(&[("front", ""), ("rear", "")]), "\"front\"";
    /// Reaction of its drive torque, for anti-squat and anti-rise. Default: `"outboard"` for a live axle (its body
    /// carries wheels of both sides), else `"inboard"`.
    may "drive": REACTION, "\"inboard\"";
    /// Reaction of its brake torque, for anti-dive and anti-lift. Default: `"outboard"`.
    may "brakes": REACTION, "\"outboard\"";
    /// Measures of the wheel, named NAME.toe and so on: a list, or `"all"` possible ones.
    may "measures": Shape::Any("WheelMeasures", "", &[ALL, Shape::list(&WHEEL_MEASURE)]), "[\"toe\", \"camber\"]";
};
const REACTION: Shape = Shape::Words(&[
    ("inboard", "by the vehicle's body, through shafts"),
    ("outboard", "by the body that the wheel turns on"),
]);
const ARM_PLANE_SHAPE: Shape = Shape::Table(&ARM_PLANE);
const ARM_PLANE: Table = table! {
    /// The plane of an arm or a strut.
    "ArmPlane":
    /// The name of the arm's or strut's body.
    must "body": BODY, "\"lca\"";
    /// Three points of an arm, or two of a strut: hardpoints' names or coordinates in the design configuration.
    must "at": Shape::List(&PLACE, [2, 3]), "[\"lca_front\", \"lca_rear\", \"lower_ball\"]";
};
const ALL: Shape = Shape::Any("AllMeasures", "", &[Shape::Words(&[("all", "")])]);
pub(crate) const VEHICLE: Table = table! {
    /// Vehicle data besides the suspension.
    "Vehicle":
    /// Wheelbase, in the length unit.
    may "wheelbase": LENGTH, "2600";
    /// Height of the centre of gravity above the ground, in the length unit.
    may "cg_height": LENGTH, "550";
    /// Fraction of the braking force at the front wheels, 0 to 1.
    may "front_brake_share": NUMBER, "0.65";
    /// Fraction of the driving force at the front wheels, 0 to 1.
    may "front_drive_share": NUMBER, "0";
};
pub(crate) const AXLE: Table = table! {
    /// Two wheels of an axle.
    "Axle":
    /// The name of the left wheel.
    must "left": Shape::Name("a wheel"), "\"front_left\"";
    /// The name of the right wheel.
    must "right": Shape::Name("a wheel"), "\"front_right\"";
    /// Measures of the axle, named NAME.track and so on: a list, or `"all"` possible ones.
    may "measures": Shape::Any("AxleMeasures", "", &[ALL, Shape::list(&AXLE_MEASURE)]), "[\"track\", \"ackermann\"]";
};
const SIDES: [Side; 2] = [Side::Left, Side::Right];

pub(super) fn vehicle(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(f) = model.get("vehicle") else { return };
    let Some(table) = r.table(f.value, &model.subject("vehicle"), "a table with `wheelbase` and others")
    else {
        return;
    };
    r.unread.clear();
    let fields = r.fields("`vehicle`", f.value.span(), table, VEHICLE.keys());
    let number = |key: &str| r.number_of(&fields, key);
    let [wheelbase, cg_height, front_brake_share, front_drive_share] =
        ["wheelbase", "cg_height", "front_brake_share", "front_drive_share"].map(number);
    raw.push(r, Section::Vehicle, EntryPlace::of(&fields));
    raw.draft.vehicle = Vehicle { wheelbase, cg_height, front_brake_share, front_drive_share };
}

/// Reads axles; their measures follow those of the wheels.
pub(super) fn axles(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "axles", "axle") {
        let fields = r.entry("axle", &entry, AXLE.keys());
        let [left, right] = ["left", "right"].map(|key| r.name_of(&fields, key));
        let has_wheelbase = raw.draft.vehicle.wheelbase.is_some();
        // A wheel that names no driver takes the only one.
        let alone = raw.draft.drivers.len() == 1;
        let moves = [&left, &right].iter().all(|name| {
            let wheel = raw.draft.wheels.iter().find(|w| Some(&w.name) == name.as_ref());
            wheel.is_some_and(|w| w.bump.is_some() || alone)
        });
        let possible =
            |m: &AxleMeasure| (has_wheelbase || !m.needs_wheelbase()) && (moves || !m.depends_on_driver());
        let possible: Vec<_> = AxleMeasure::ALL.iter().copied().filter(possible).collect();
        let lacking = |m: &AxleMeasure| match m {
            m if m.needs_wheelbase() && !has_wheelbase => Some("`[vehicle]` has no `wheelbase`"),
            m if m.depends_on_driver() && !moves => Some("not both wheels have a `bump` driver"),
            _ => None,
        };
        left_out(r, &fields, AxleMeasure::ALL, AxleMeasure::name, lacking);
        let measures = listed(r, &fields, AxleMeasure::ALL, &possible, AxleMeasure::name);
        for (what, at) in measures {
            raw.places.push(Section::Measures, EntryPlace::at(at));
            let kind = MeasureKindDraft::Axle { axle: entry.0.clone(), what };
            raw.draft.measures.push(MeasureDraft { name: format!("{}.{}", entry.0, what.name()), kind });
        }
        raw.push(r, Section::Axles, EntryPlace::of(&fields));
        let (left, right) = (left.unwrap_or_default(), right.unwrap_or_default());
        raw.draft.axles.push(AxleDraft { name: entry.0, left, right });
    }
}

/// Reads wheels; their measures follow those of the model.
pub(super) fn wheels(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "wheels", "wheel") {
        let fields = r.entry("wheel", &entry, WHEEL.keys());
        let mut place = EntryPlace::of(&fields);
        let body = r.name_of(&fields, "body").unwrap_or_default();
        let centre = r.place_of(&fields, "centre");
        place.items("centre", Vec::new());
        let spin = spin(r, &fields, &mut place);
        let radius = r.number_of(&fields, "radius");
        let side = r.word_of(&fields, "side").map(|k| SIDES[k]);
        let end = r.word_of(&fields, "end").map(|k| VehicleEnd::ALL[k]);
        let [drive, brakes] =
            ["drive", "brakes"].map(|key| r.word_of(&fields, key).map(|k| TorqueReaction::ALL[k]));
        let bump = r.name_of(&fields, "bump");
        let kingpin = r.given(&fields, "kingpin", |r, f| {
            two_points(r, &fields, f, "a list of a lower and an upper point")
        });
        let steer = r.name_of(&fields, "steer");
        let planes = r.given(&fields, "arm_planes", |r, f| arm_planes(r, &fields, f));
        let spring = r.given(&fields, "spring", |r, f| two_points(r, &fields, f, "a list of two points"));
        if spin.is_none() {
            r.unread.push("spin_axis");
        }
        measures_of(r, &entry.0, &fields, raw);
        raw.push(r, Section::Wheels, place);
        raw.draft.wheels.push(WheelDraft {
            name: entry.0,
            body,
            centre: centre.unwrap_or(LocationDraft::At(Vec3::ZERO)),
            spin: spin.unwrap_or(WheelSpinDraft::Axis(DirectionDraft::Along(Vec3::AXES[1]))),
            radius: radius.unwrap_or(1.0),
            side,
            kingpin,
            bump,
            steer,
            planes,
            spring,
            end,
            drive,
            brakes,
        });
    }
}

/// A spin axis, or the angles toe and camber.
fn spin(r: &mut Reader<'_>, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<WheelSpinDraft> {
    if fields.get("spin_axis").is_some() {
        for key in ["toe", "camber"] {
            r.out_of_place(fields, key, "it follows from the `spin_axis`; give either that or the angles");
        }
        return r.line_of(fields, "spin_axis", place).map(WheelSpinDraft::Axis);
    }
    if fields.get("toe").is_none() && fields.get("camber").is_none() {
        if fields.lost {
            return None;
        }
        let message = format!("{} has no `spin_axis`", fields.what);
        r.report("HP0104", fields.at.clone(), message).help = Some(
            "add it, for example `spin_axis = [0, 1, 0]` for a left wheel, or the angles `toe = 0` and `camber = 0`"
                .into(),
        );
        return None;
    }
    let [toe, camber] = ["toe", "camber"].map(|key| {
        r.need(fields, key);
        r.number_of(fields, key)
    });
    Some(WheelSpinDraft::Angles { toe: toe?, camber: camber? })
}

/// The planes of both arms, each by points of one body.
fn arm_planes(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<[Vec<PointRef>; 2]> {
    let subject = fields.subject("arm_planes");
    let list = f.value.get_ref().as_array().filter(|list| list.len() == 2);
    let Some(list) = list else {
        r.wrong(f.value, &subject, "a list of a lower and an upper plane");
        return None;
    };
    let [lower, upper] = [0, 1].map(|k| {
        let table = r.table(&list[k], &subject, "a table with `body` and `at`")?;
        let plane = r.fields(subject.name.clone(), list[k].span(), table, ARM_PLANE.keys());
        let body = r.name_of(&plane, "body");
        let at = r.need(&plane, "at")?;
        let points = r.list(at.value, &plane.subject("at"), "a list of two or three hardpoints")?;
        let places = all_read(points.iter().map(|value| r.fixed_place(value, &plane.subject("at"))));
        let (body, places) = (body?, places?);
        Some(places.into_iter().map(|at| PointRef::On { body: body.clone(), at }).collect())
    });
    Some([lower?, upper?])
}

fn two_points(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    expected: &str,
) -> Option<[PointRef; 2]> {
    match f.value.get_ref().as_array() {
        Some(list) if list.len() == 2 => {
            let [lower, upper] = [0, 1].map(|k| points::point_ref(r, fields, Field { value: &list[k], ..f }));
            Some([lower?, upper?])
        }
        _ => {
            r.wrong(f.value, &fields.subject(f.key), expected);
            None
        }
    }
}

/// The measures that a wheel lists: `NAME.toe` and so on.
fn measures_of(r: &mut Reader<'_>, wheel: &str, fields: &Fields<'_>, raw: &mut Raw) {
    let has = |key: &str| fields.get(key).is_some();
    let end = fields.get("end").and_then(|f| f.value.get_ref().as_str());
    let vehicle = &raw.draft.vehicle;
    // A wheel that names no driver takes the only one.
    let moves = has("bump") || raw.draft.drivers.len() == 1;
    let has_kingpin = |need: WheelRequirement| need != WheelRequirement::Kingpin || has("kingpin");
    // Measures that need a steering driver, planes or a spring are left out silently if these are not given.
    let is_asked = |need: WheelRequirement| match need {
        WheelRequirement::Steer => has("steer"),
        WheelRequirement::Planes => has("arm_planes"),
        WheelRequirement::Spring => has("spring"),
        _ => true,
    };
    let has_driver =
        |need: WheelRequirement| !need.depends_on_driver() || need == WheelRequirement::Steer || moves;
    let is_at = |need: WheelRequirement| need.end().is_none_or(|at| end == Some(at.name()));
    let possible = |m: &WheelMeasure| {
        let need = m.needs();
        has_kingpin(need)
            && is_asked(need)
            && has_driver(need)
            && is_at(need)
            && vehicle.lacks(need).next().is_none()
    };
    let drivers = raw.draft.drivers.len();
    let no_driver = match drivers {
        0 => "no driver can be its `bump`".to_owned(),
        n => format!("`bump` is missing: {n} drivers could move the wheel up and down"),
    };
    // Pitch measures are left out silently without data of the vehicle or of its ends.
    let lacking = |m: &WheelMeasure| match m.needs() {
        need if !has_kingpin(need) => Some("the wheel has no `kingpin`"),
        need if !is_asked(need) => None,
        need if !has_driver(need) => Some(no_driver.as_str()),
        need if !is_at(need) => None,
        need => vehicle.lacks(need).next().map(|key| match key {
            "wheelbase" => "`[vehicle]` has no `wheelbase`",
            "cg_height" => "`[vehicle]` has no `cg_height`",
            _ => "`[vehicle]` has no share of the force for this end",
        }),
    };
    left_out(r, fields, WheelMeasure::ALL, WheelMeasure::name, lacking);
    let possible: Vec<_> = WheelMeasure::ALL.iter().copied().filter(possible).collect();
    for (what, at) in listed(r, fields, WheelMeasure::ALL, &possible, WheelMeasure::name) {
        raw.places.push(Section::Measures, EntryPlace::at(at));
        raw.draft.measures.push(MeasureDraft {
            name: format!("{wheel}.{}", what.name()),
            kind: MeasureKindDraft::Wheel { wheel: wheel.to_owned(), what },
        });
    }
}

/// HP0503: names the measures that `measures = "all"` leaves out, with the reason.
fn left_out<'w, T: Copy>(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    all: &[T],
    name: fn(T) -> &'static str,
    lacking: impl Fn(&T) -> Option<&'w str>,
) {
    let Some(f) = fields.get("measures").filter(|f| f.value.get_ref().as_str() == Some("all")) else {
        return;
    };
    let missing: Vec<(&str, T)> = all.iter().filter_map(|m| Some((lacking(m)?, *m))).collect();
    let mut reasons: Vec<&str> = Vec::new();
    for (why, _) in &missing {
        if !reasons.contains(why) {
            reasons.push(why);
        }
    }
    if reasons.is_empty() {
        return;
    }
    let total = all.len();
    let message = format!("{} measures {} of {total}", fields.what, total - missing.len());
    let d = r.remark(Severity::Note, "HP0503", f.value.span(), message);
    for why in reasons {
        let names = missing.iter().filter(|(w, _)| *w == why).map(|(_, m)| format!("`{}`", name(*m)));
        d.notes.push(format!("{why}, so there is no {}", names.collect::<Vec<_>>().join(", ")));
    }
    d.help = Some("add the missing entries, or list the requested measures by name".into());
}

/// Measures under `measures` with their locations: those listed, or all possible ones.
fn listed<T: Copy>(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    all: &[T],
    possible: &[T],
    name: fn(T) -> &'static str,
) -> Vec<(T, std::ops::Range<usize>)> {
    let Some(f) = fields.get("measures") else { return Vec::new() };
    let subject = fields.subject("measures");
    if f.value.get_ref().as_str() == Some("all") {
        return possible.iter().map(|m| (*m, f.value.span())).collect();
    }
    let expected = "`\"all\"` or a list of measures' names";
    let before = r.found.len();
    let mut found = Vec::new();
    for value in r.list(f.value, &subject, expected).into_iter().flatten() {
        let Some(word) = r.name(value, &subject, "the name of a measure") else { continue };
        match all.iter().find(|m| name(**m) == word) {
            Some(what) => found.push((*what, value.span())),
            None => {
                let names: Vec<_> = all.iter().map(|m| name(*m)).collect();
                r.unknown_word(value.span(), &subject, &word, &names);
            }
        }
    }
    if r.found.len() > before {
        r.unread.push("measures");
    }
    found
}
