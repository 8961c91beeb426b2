//! Planar mechanisms: points with two coordinates, pins without an axis, bodies given by their points.
//!
//! The shorthand is expanded on the values of the text before they are read; expanded values have its location.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

use hardpoint::draft::{ElementType, FieldKind, MeasureField, MeasureType};
use hardpoint::joint;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::values::{Leaf, Reader, Shape, Table, Value, shown, table_of, walk};

use super::entries::{fill, lay_under};
use super::mirror::images;

pub(crate) const PLANAR: Shape = Shape::Words(&[
    ("xy", "In the plane of x and y; angles count about z."),
    ("yz", "In the plane of y and z; angles count about x."),
    ("zx", "In the plane of z and x; angles count about y."),
    (
        "xz",
        "In the plane of x and z; angles are about -y: counter-clockwise if x points to the right and z up.",
    ),
]);

/// The plane of a planar model. Its normal is the first axis of its name times the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    /// The axes of its name, in that order: 0, 1 or 2 for x, y or z.
    pub axes: [usize; 2],
    word: &'static str,
    normal: &'static str,
}

const PLANES: [Plane; 4] = [
    Plane { axes: [0, 1], word: "xy", normal: "z" },
    Plane { axes: [1, 2], word: "yz", normal: "x" },
    Plane { axes: [2, 0], word: "zx", normal: "y" },
    Plane { axes: [0, 2], word: "xz", normal: "-y" },
];
const AXES: [&str; 3] = ["x", "y", "z"];

impl Plane {
    /// Plane of a model.
    pub(crate) fn of(model: &DeTable<'_>) -> Option<Self> {
        Self::named(model.get("planar")?.get_ref().as_str()?)
    }

    /// Plane with a name, such as `xy`.
    pub(crate) fn named(word: &str) -> Option<Self> {
        PLANES.into_iter().find(|plane| plane.word == word)
    }

    /// Index of the coordinate along this axis among a point's two coordinates in the text; `None` for the axis out of
    /// the plane.
    pub(crate) fn coordinate(self, axis: usize) -> Option<usize> {
        self.axes.iter().position(|a| *a == axis)
    }
}

fn text<'a>(text: impl Into<Cow<'a, str>>, at: Range<usize>) -> Value<'a> {
    Spanned::new(at, DeValue::String(text.into()))
}

fn key<'a>(name: impl Into<Cow<'a, str>>, at: Range<usize>) -> Spanned<Cow<'a, str>> {
    Spanned::new(at, name.into())
}

/// Expands everything that a planar model leaves out.
pub(super) fn planar(r: &mut Reader<'_>, format: &'static Table, model: &mut DeTable<'_>) {
    let Some(value) = model.get("planar") else { return };
    let Some(plane) = Plane::of(model) else {
        let message = "`planar` must be `\"xy\"`, `\"yz\"`, `\"zx\"` or `\"xz\"`";
        r.report("HP0106", value.span(), message).help = Some("for example `planar = \"xy\"`".into());
        return;
    };
    let at = value.span();
    r.plane = Some(plane.word);
    for (section, value) in model.iter_mut() {
        walk("", format.shape_of(section.get_ref()), value, &mut |_, leaf| {
            if let Leaf::Pair(list) = leaf {
                three(list, plane);
            }
        });
    }
    bodies_by_points(r, format, model);
    let sections = |model: &mut DeTable<'_>, section: &str, change: &mut dyn FnMut(&mut DeTable<'_>)| {
        let entries = model.get_mut(section).and_then(table_of);
        entries.into_iter().flat_map(|t| t.iter_mut()).filter_map(|(_, v)| table_of(v)).for_each(change);
    };
    let word = |table: &DeTable<'_>, key: &str| -> Option<String> {
        Some(table.get(key)?.get_ref().as_str()?.to_owned())
    };
    let square = |table: &mut DeTable<'_>, name: &'static str| {
        if !table.contains_key(name) {
            table.insert(key(name, at.clone()), text(plane.normal, at.clone()));
        }
    };
    sections(model, "joints", &mut |joint| {
        let kind = word(joint, "type").and_then(|kind| joint::named(&kind));
        if kind.is_some_and(|kind| kind.normal_in_plane) {
            square(joint, "axis");
        }
    });
    sections(model, "measures", &mut |measure| {
        let kind = word(measure, "type").and_then(|kind| MeasureType::named(&kind));
        let fields = kind.filter(|kind| kind.normal_in_plane).map_or(&[][..], |kind| kind.fields);
        if let Some(direction) = fields.iter().find(|f| f.kind == FieldKind::Direction) {
            square(measure, direction.key);
        }
    });
    sections(model, "forces", &mut |force| {
        let kind = word(force, "type").and_then(|kind| ElementType::ALL.iter().find(|t| t.name == kind));
        // Forces act in the plane; all other directions are its normal.
        let is_normal = |f: &&MeasureField| f.kind == FieldKind::Direction && f.key != "along";
        kind.into_iter().flat_map(|t| t.fields).filter(is_normal).for_each(|f| square(force, f.key));
    });
    sections(model, "drivers", &mut |driver| {
        if driver.contains_key("body") {
            square(driver, "about");
        }
    });
    variables(r, model, plane);
    if !model.contains_key("time") {
        let mut time = DeTable::new();
        for (name, number) in [("end", "1.0"), ("steps", "100")] {
            if let Ok(number) = DeValue::parse(number) {
                time.insert(key(name, at.clone()), Spanned::new(at.clone(), number.into_inner()));
            }
        }
        model.insert(key("time", at.clone()), Spanned::new(at.clone(), DeValue::Table(time)));
    }
}

/// Expands bodies that are lists of hardpoints: a shared hardpoint is a pin; others are points of the body.
fn bodies_by_points<'a>(r: &mut Reader<'_>, format: &'static Table, model: &mut DeTable<'a>) {
    let Some(bodies) = model.get_mut("bodies").and_then(table_of) else { return };
    /// A hardpoint, where it is listed, and the bodies on it.
    type Pin = (String, Range<usize>, Vec<Listed>);
    let mut pins: Vec<Pin> = Vec::new();
    let mut numbers: HashMap<String, usize> = HashMap::new();
    let mut ground = None;
    for (name, value) in bodies.iter_mut() {
        let DeValue::Array(points) = value.get_ref().clone() else { continue };
        for point in &points {
            let Some(at) = point.get_ref().as_str() else {
                let message = format!("body `{}` must be a list of hardpoints' names", shown(name.get_ref()));
                r.report("HP0105", point.span(), message).help =
                    Some("for example `crank = [\"A\", \"B\"]`".into());
                continue;
            };
            let body = Listed { name: name.get_ref().to_string(), at: name.span() };
            let pin = *numbers.entry(at.to_owned()).or_insert(pins.len());
            if pin == pins.len() {
                pins.push((at.to_owned(), point.span(), Vec::new()));
            }
            if pins[pin].2.last().is_some_and(|last| last.name == body.name) {
                let message = format!("body `{}` has the hardpoint `{}` twice", shown(&body.name), shown(at));
                r.report("HP0201", point.span(), message).help =
                    Some("list each of its hardpoints once".into());
                continue;
            }
            pins[pin].2.push(body);
        }
        *value = Spanned::new(value.span(), DeValue::Table(DeTable::new()));
        if **name.get_ref() == *"ground" {
            ground = Some(name.clone());
        }
    }
    // Ground always exists, and is listed for its points only.
    if ground.is_some() {
        let without = std::mem::take(bodies).into_iter().filter(|(name, _)| **name.get_ref() != *"ground");
        *bodies = without.collect();
    }
    let names: HashSet<String> = bodies.keys().map(|name| name.get_ref().to_string()).collect();
    let image = images(model);
    for (point, at, on) in pins {
        // Entries that are written on both sides are not changed.
        let image = |name: &str| image(name).filter(|there| !names.contains(there));
        let hinges = hinges(&point, &on, image);
        if let ([body], []) = (on.as_slice(), hinges.as_slice())
            && body.name != "ground"
        {
            let mut follow = DeTable::new();
            follow.insert(key("body", at.clone()), text(body.name.clone(), body.at.clone()));
            follow.insert(key("at", at.clone()), text(point.clone(), at.clone()));
            let follow = Spanned::new(at.clone(), DeValue::Table(follow));
            let points = section(model, "points", &at);
            lay_under(format.entries_of("points"), points, key(point.clone(), at.clone()), follow);
        }
        for (name, pair) in hinges {
            let mut joint = DeTable::new();
            joint.insert(key("type", at.clone()), text("revolute", at.clone()));
            let pair: DeArray<'a> = pair.into_iter().map(|body| text(body.name, body.at)).collect();
            joint.insert(key("bodies", at.clone()), Spanned::new(at.clone(), DeValue::Array(pair)));
            joint.insert(key("at", at.clone()), text(point.clone(), at.clone()));
            let joint = Spanned::new(at.clone(), DeValue::Table(joint));
            let joints = section(model, "joints", &at);
            // A joint of any type connects these bodies already.
            match joints.get_mut(&*name).and_then(table_of).filter(|hand| !hand.contains_key("bodies")) {
                Some(hand) => fill(hand, joint),
                None => lay_under(format.entries_of("joints"), joints, key(name, at.clone()), joint),
            };
        }
    }
}

/// A body given by its points, with their locations.
#[derive(Clone)]
struct Listed {
    name: String,
    at: Range<usize>,
}

/// Hinges at a point between the bodies that share it: one has the name of the point, the others also that of a body.
///
/// `image` returns the name of a mirror image, if there is one. If the point is its own image, a body of one side has
/// its hinge under its own name, so that its image has one as well; if only bodies of one side meet, one of them meets
/// its own image.
fn hinges(point: &str, on: &[Listed], image: impl Fn(&str) -> Option<String>) -> Vec<(String, [Listed; 2])> {
    let is_shared = image(point).is_none();
    let other_side = |body: &Listed| image(&body.name).filter(|_| is_shared);
    let base = on.iter().position(|body| other_side(body).is_none()).unwrap_or(0);
    let mut all = Vec::new();
    if let Some(name) = other_side(&on[base]) {
        all.push((point.to_owned(), [on[base].clone(), Listed { name, ..on[base].clone() }]));
    }
    let mut is_free = all.is_empty();
    for (_, other) in on.iter().enumerate().filter(|(k, _)| *k != base) {
        let takes = other_side(other).is_none() && std::mem::replace(&mut is_free, false);
        let name = if takes { point.to_owned() } else { format!("{point}_{}", other.name) };
        all.push((name, [on[base].clone(), other.clone()]));
    }
    all
}

/// A table of the model, created if necessary.
fn section<'m, 'a>(model: &'m mut DeTable<'a>, name: &'static str, at: &Range<usize>) -> &'m mut DeTable<'a> {
    let entry = model.entry(key(name, at.clone()));
    let value = entry.or_insert_with(|| Spanned::new(at.clone(), DeValue::Table(DeTable::new())));
    if !value.get_ref().is_table() {
        *value = Spanned::new(value.span(), DeValue::Table(DeTable::new()));
    }
    match value.get_mut() {
        DeValue::Table(table) => table,
        _ => unreachable!("it is a table now"),
    }
}

/// Adds the third coordinate to two coordinates in the plane.
fn three(list: &mut DeArray<'_>, plane: Plane) {
    let Some(last) = list.iter().last().map(Value::span) else { return };
    let mut two: Vec<_> = std::mem::replace(list, DeArray::new()).into_iter().collect();
    let Ok(zero) = DeValue::parse("0") else { return };
    two.push(Spanned::new(last, zero.into_inner()));
    *list = (0..3).filter_map(|axis| two.get(plane.coordinate(axis).unwrap_or(2)).cloned()).collect();
}

/// Splits design variables along both axes of the plane, `along = "xy"`, into one for each.
fn variables(r: &mut Reader<'_>, model: &mut DeTable<'_>, plane: Plane) {
    let Some(design) = model.get_mut("design").and_then(table_of) else { return };
    for (name, value) in std::mem::take(design) {
        let along = value.get_ref().as_table().and_then(|t| t.get("along"));
        let along = along.and_then(|v| Some((v.get_ref().as_str()?.to_owned(), v.span())));
        let both = along.filter(|(word, _)| word == plane.word || word == "xyz");
        let moves = value.get_ref().as_table().is_some_and(|t| t.contains_key("move"));
        let entries = match both {
            None => vec![(name, value)],
            // An entry without its main key, perhaps misspelt, is reported once and under its own name.
            Some((_, at)) if !moves => {
                let mut one = value;
                if let Some(table) = table_of(&mut one) {
                    table.insert(key("along", at.clone()), text(AXES[plane.axes[0]], at));
                }
                vec![(name, one)]
            }
            Some((_, at)) => (0..3)
                .filter(|axis| plane.coordinate(*axis).is_some())
                .map(|axis| {
                    let mut one = value.clone();
                    if let Some(table) = table_of(&mut one) {
                        table.insert(key("along", at.clone()), text(AXES[axis], at.clone()));
                    }
                    (key(format!("{}_{}", name.get_ref(), AXES[axis]), name.span()), one)
                })
                .collect(),
        };
        for (name, value) in entries {
            if design.contains_key(&**name.get_ref()) {
                let [first, second] = plane.axes.map(|axis| AXES[axis]);
                let message = format!("there are two design variables named `{}`", shown(name.get_ref()));
                r.report("HP0201", name.span(), message).help = Some(format!(
                    "`along = \"{}\"` makes the variables NAME_{first} and NAME_{second}; rename one of the two",
                    plane.word
                ));
            } else {
                design.insert(name, value);
            }
        }
    }
}
