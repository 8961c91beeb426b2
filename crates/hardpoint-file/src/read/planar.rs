//! Mechanisms in a plane: points of two coordinates, pins without an axis, bodies that are said by their points.
//!
//! All of it is made of the text's values before they are read; what is made stands where the text is that says it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use hardpoint::joint;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::shown;
use crate::format::Shape;
use crate::tree::{Reader, Value};
use crate::walk::{Leaf, table_of, walk};

use super::MODEL;
use super::include::{fill, lay_under};

pub(crate) const PLANAR: Shape = Shape::Words(&[
    ("xy", "In the plane of x and y; angles count about z."),
    ("yz", "In the plane of y and z; angles count about x."),
    ("zx", "In the plane of z and x; angles count about y."),
]);
/// Planes by the axes that are square to them, x, y and z.
const PLANES: [&str; 3] = ["yz", "zx", "xy"];
const AXES: [&str; 3] = ["x", "y", "z"];
/// Joint types whose axis is square to the plane where none is given.
const PINS: [&str; 5] = ["revolute", "planar", "pin_in_slot", "point_on_curve", "revolute_spherical"];

/// The axis square to the plane of a planar model.
pub(crate) fn normal(model: &DeTable<'_>) -> Option<usize> {
    normal_of(model.get("planar")?.get_ref().as_str()?)
}

/// The axis square to a plane.
pub(crate) fn normal_of(plane: &str) -> Option<usize> {
    PLANES.iter().position(|p| *p == plane)
}

/// Which of a point's two coordinates in the text is the one along this axis; none for the one out of the plane.
pub(crate) fn coordinate(normal: usize, axis: usize) -> Option<usize> {
    Some((axis + 2 - normal) % 3).filter(|k| *k < 2)
}

fn text<'a>(text: impl Into<Cow<'a, str>>, at: Range<usize>) -> Value<'a> {
    Spanned::new(at, DeValue::String(text.into()))
}

fn key<'a>(name: impl Into<Cow<'a, str>>, at: Range<usize>) -> Spanned<Cow<'a, str>> {
    Spanned::new(at, name.into())
}

impl Reader<'_> {
    /// Says all that a planar model leaves out because it lies in a plane.
    pub(super) fn planar(&mut self, model: &mut DeTable<'_>) {
        let Some(value) = model.get("planar") else { return };
        let Some(normal) = normal(model) else {
            let message = "`planar` must be `\"xy\"`, `\"yz\"` or `\"zx\"`";
            self.report("HP0106", value.span(), message).help = Some("for example `planar = \"xy\"`".into());
            return;
        };
        let at = value.span();
        for (section, value) in model.iter_mut() {
            let shape = MODEL.keys().find(|k| k.key == section.get_ref()).map(|k| k.shape);
            let Some(shape) = shape else { continue };
            walk("", shape, value, &mut |_, leaf| {
                if let Leaf::Pair(list) = leaf {
                    three(list, normal);
                }
            });
        }
        self.bodies_by_points(model);
        let sections = |model: &mut DeTable<'_>, section: &str, change: &mut dyn FnMut(&mut DeTable<'_>)| {
            let entries = model.get_mut(section).and_then(table_of);
            entries.into_iter().flat_map(|t| t.iter_mut()).filter_map(|(_, v)| table_of(v)).for_each(change);
        };
        let word = |table: &DeTable<'_>, key: &str| -> Option<String> {
            Some(table.get(key)?.get_ref().as_str()?.to_owned())
        };
        let square = |table: &mut DeTable<'_>, name: &'static str| {
            if !table.contains_key(name) {
                table.insert(key(name, at.clone()), text(AXES[normal], at.clone()));
            }
        };
        sections(model, "joints", &mut |joint| {
            let kind = word(joint, "type").and_then(|kind| joint::named(&kind)).map_or("", |kind| kind.name);
            if PINS.contains(&kind) {
                square(joint, "axis");
            }
        });
        sections(model, "measures", &mut |measure| {
            if word(measure, "type").as_deref() == Some("angle")
                || word(measure, "type").as_deref() == Some("angular_velocity")
                    && !measure.contains_key("along")
            {
                let name = if measure.contains_key("body") { "along" } else { "about" };
                square(measure, name);
            }
        });
        sections(model, "measures", &mut |measure| {
            if word(measure, "type").as_deref() == Some("shaking_moment") {
                square(measure, "along");
            }
        });
        sections(model, "forces", &mut |force| {
            if word(force, "type").as_deref() == Some("moment") {
                square(force, "about");
            }
            if word(force, "type").as_deref() == Some("slide_friction") {
                square(force, "normal");
            }
        });
        sections(model, "drivers", &mut |driver| {
            if driver.contains_key("body") {
                square(driver, "about");
            }
        });
        variables(model, normal);
        if !["time", "cases"].iter().any(|key| model.contains_key(*key)) {
            let mut time = DeTable::new();
            for (name, number) in [("end", "1.0"), ("steps", "100")] {
                if let Ok(number) = DeValue::parse(number) {
                    time.insert(key(name, at.clone()), Spanned::new(at.clone(), number.into_inner()));
                }
            }
            model.insert(key("time", at.clone()), Spanned::new(at.clone(), DeValue::Table(time)));
        }
    }

    /// Bodies that are lists of hardpoints: where two have the same there is a pin; what one alone has is a point of it to follow.
    fn bodies_by_points<'a>(&mut self, model: &mut DeTable<'a>) {
        let Some(bodies) = model.get_mut("bodies").and_then(table_of) else { return };
        /// A hardpoint, where it is listed, and the bodies on it.
        type Pin<'a> = (Cow<'a, str>, Range<usize>, Vec<Value<'a>>);
        let mut pins: Vec<Pin<'a>> = Vec::new();
        let mut numbers: HashMap<String, usize> = HashMap::new();
        let mut ground = None;
        for (name, value) in bodies.iter_mut() {
            let DeValue::Array(points) = value.get_ref().clone() else { continue };
            for point in &points {
                let Some(at) = point.get_ref().as_str() else {
                    let message =
                        format!("body `{}` must be a list of hardpoints' names", shown(name.get_ref()));
                    self.report("HP0105", point.span(), message).help =
                        Some("for example `crank = [\"A\", \"B\"]`".into());
                    continue;
                };
                let body = text(name.get_ref().clone(), name.span());
                let pin = *numbers.entry(at.to_owned()).or_insert(pins.len());
                if pin == pins.len() {
                    pins.push((Cow::Owned(at.to_owned()), point.span(), Vec::new()));
                }
                pins[pin].2.push(body);
            }
            *value = Spanned::new(value.span(), DeValue::Table(DeTable::new()));
            if **name.get_ref() == *"ground" {
                ground = Some(name.clone());
            }
        }
        // It is always there, and is listed for its points only.
        if ground.is_some() {
            let without =
                std::mem::take(bodies).into_iter().filter(|(name, _)| **name.get_ref() != *"ground");
            *bodies = without.collect();
        }
        let shape = |section: &str| MODEL.keys().find(|k| k.key == section).map_or(Shape::Text, |k| k.shape);
        for (point, at, on) in pins {
            for (k, other) in on.iter().enumerate().skip(1) {
                let mut joint = DeTable::new();
                joint.insert(key("type", at.clone()), text("revolute", at.clone()));
                let pair: DeArray<'a> = [on[0].clone(), other.clone()].into_iter().collect();
                joint.insert(key("bodies", at.clone()), Spanned::new(at.clone(), DeValue::Array(pair)));
                joint.insert(key("at", at.clone()), text(point.clone(), at.clone()));
                let name = match (k, other.get_ref().as_str()) {
                    (2.., Some(body)) => Cow::Owned(format!("{point}_{body}")),
                    _ => point.clone(),
                };
                let joint = Spanned::new(at.clone(), DeValue::Table(joint));
                let joints = section(model, "joints", &at);
                // Whatever type it is, between these bodies it is.
                match joints.get_mut(&*name).and_then(table_of).filter(|hand| !hand.contains_key("bodies")) {
                    Some(hand) => fill(hand, joint),
                    None => lay_under(shape("joints"), joints, key(name, at.clone()), joint),
                };
            }
            if let [body] = on.as_slice()
                && body.get_ref().as_str() != Some("ground")
            {
                let mut follow = DeTable::new();
                follow.insert(key("body", at.clone()), body.clone());
                follow.insert(key("at", at.clone()), text(point.clone(), at.clone()));
                let follow = Spanned::new(at.clone(), DeValue::Table(follow));
                lay_under(shape("points"), section(model, "points", &at), key(point, at.clone()), follow);
            }
        }
    }
}

/// A table of the model, which is there from now on.
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

/// Two coordinates in the plane, with the third.
fn three(list: &mut DeArray<'_>, normal: usize) {
    let Some(last) = list.iter().last().map(Value::span) else { return };
    let mut two = std::mem::replace(list, DeArray::new()).into_iter();
    let (Some(first), Some(second), Ok(zero)) = (two.next(), two.next(), DeValue::parse("0")) else { return };
    let zero = Spanned::new(last, zero.into_inner());
    *list = match normal {
        0 => [zero, first, second],
        1 => [second, zero, first],
        _ => [first, second, zero],
    }
    .into_iter()
    .collect();
}

/// Design variables along both axes of the plane, `along = "xy"`, become one along each.
fn variables(model: &mut DeTable<'_>, normal: usize) {
    let Some(design) = model.get_mut("design").and_then(table_of) else { return };
    for (name, value) in std::mem::take(design) {
        let along = value.get_ref().as_table().and_then(|t| t.get("along"));
        let along = along.and_then(|v| Some((v.get_ref().as_str()?.to_owned(), v.span())));
        let Some((_, at)) = along.filter(|(word, _)| word == PLANES[normal] || word == "xyz") else {
            design.insert(name, value);
            continue;
        };
        for axis in (0..3).filter(|axis| *axis != normal) {
            let mut one = value.clone();
            if let Some(table) = table_of(&mut one) {
                table.insert(key("along", at.clone()), text(AXES[axis], at.clone()));
            }
            design.insert(key(format!("{}_{}", name.get_ref(), AXES[axis]), name.span()), one);
        }
    }
}
