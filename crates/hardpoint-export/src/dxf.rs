//! DXF: hardpoints as points with their names, bodies as lines between their places.

use dxf::entities::{Entity, EntityType, Line, ModelPoint, Text};
use dxf::enums::{AcadVersion, Units};
use dxf::tables::Layer;
use dxf::{Color, Drawing, Point};
use hardpoint::joint::Quantity;
use hardpoint::space::Vec3;
use hardpoint_file::{LengthUnit, ModelFile};

use crate::links::{lines, places, rods};
use crate::tables::hardpoints;
use crate::{Exported, Format};

/// See the module.
pub const FORMAT: Format =
    Format { name: "dxf", about: "skeleton of hardpoints and bodies as DXF", endings: &["dxf"], write };

/// The layer of hardpoints and their names.
const HARDPOINTS: &str = "hardpoints";
/// The height of names, as a part of the mechanism's size.
const TEXT: f64 = 0.015;
/// AutoCAD's colours from red to magenta, for the layers of bodies in turn.
const COLOURS: u8 = 6;
/// What names of layers must not have.
const ODD: [char; 13] = ['<', '>', '/', '\\', '"', ':', ';', '?', '*', '|', ',', '=', '`'];

fn write(file: &ModelFile, out: &mut Exported) {
    let (model, units) = (&file.model, file.units);
    let mut drawing = Drawing::new();
    // The first version with units that every reader knows.
    drawing.header.version = AcadVersion::R2000;
    drawing.header.default_drawing_units = match units.length {
        LengthUnit::Millimetre => Units::Millimeters,
        LengthUnit::Centimetre => Units::Centimeters,
        LengthUnit::Metre => Units::Meters,
        LengthUnit::Inch => Units::Inches,
    };
    let mut layers = Layers { drawing: &mut drawing, count: 0 };
    let layer = layers.add(HARDPOINTS);
    let height = TEXT * units.from_si(Quantity::Length, model.size());
    for (name, [x, y, z]) in hardpoints(file) {
        let at = Point::new(x, y, z);
        layers.put(&layer, EntityType::ModelPoint(ModelPoint::new(at.clone())));
        let text = Text { location: at, text_height: height, value: said(name), ..Text::default() };
        layers.put(&layer, EntityType::Text(text));
    }
    let shown = |at: Vec3| {
        let [x, y, z] = at.to_array().map(|x| units.from_si(Quantity::Length, x));
        Point::new(x, y, z)
    };
    let line = |[a, b]: [Vec3; 2]| EntityType::Line(Line::new(shown(a), shown(b)));
    for (b, places) in places(model).iter().enumerate().skip(1) {
        let body = &model.bodies[b];
        let links = lines(places);
        if links.is_empty() {
            out.unsaid("body", &body.name, "it has a single place, and no line");
            continue;
        }
        let layer = layers.add(&body.name);
        for link in links {
            layers.put(&layer, line(link.map(|at| body.frame.point(at))));
        }
    }
    for (joint, ends) in rods(model) {
        let [i, j] = joint.bodies.map(|b| model.bodies[b.0].frame);
        let layer = layers.add(&joint.name);
        layers.put(&layer, line([i.point(ends[0]), j.point(ends[1])]));
    }
    let mut bytes = Vec::new();
    match drawing.save(&mut bytes) {
        Ok(()) => out.text = String::from_utf8_lossy(&bytes).into_owned(),
        Err(error) => out.unsaid("drawing", &model.name, error.to_string()),
    }
    let rods = rods(model).count();
    let joints = model.named_joints().count() - rods;
    if joints > 0 {
        out.unsaid("joints", &joints.to_string(), "DXF has no joints: only their places are written");
    }
    if model.hardpoints.iter().any(|h| h.unnamed) {
        out.unsaid("places", "coordinates", "places without a hardpoint's name have no point of their own");
    }
    out.without_motions(file, "DXF");
}

/// A text of one line; what is not ASCII as files of this version write it.
fn said(text: &str) -> String {
    let letter = |c: char| match c {
        c if c.is_control() => " ".to_owned(),
        c if c.is_ascii() => c.to_string(),
        c => format!("\\U+{:04X}", u32::from(c)),
    };
    text.chars().map(letter).collect()
}

struct Layers<'d> {
    drawing: &'d mut Drawing,
    count: usize,
}

impl Layers<'_> {
    /// A layer of its own for each, whatever of its name is not allowed.
    fn add(&mut self, name: &str) -> String {
        let allowed = |c: char| if ODD.contains(&c) || c.is_control() { '_' } else { c };
        let plain = said(&name.chars().map(allowed).collect::<String>());
        let taken = |d: &Drawing, name: &str| d.layers().any(|l| l.name.eq_ignore_ascii_case(name));
        let mut own = plain.clone();
        let mut k = 1;
        while taken(self.drawing, &own) {
            k += 1;
            own = format!("{plain}_{k}");
        }
        let colour = if self.count == 0 { 7 } else { ((self.count - 1) % usize::from(COLOURS)) as u8 + 1 };
        self.count += 1;
        let layer = Layer { name: own.clone(), color: Color::from_index(colour), ..Layer::default() };
        self.drawing.add_layer(layer);
        own
    }

    fn put(&mut self, layer: &str, entity: EntityType) {
        let mut entity = Entity::new(entity);
        entity.common.layer = layer.to_owned();
        self.drawing.add_entity(entity);
    }
}
