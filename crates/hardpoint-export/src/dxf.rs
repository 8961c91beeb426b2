//! DXF: hardpoints as points with their names, bodies as lines between their points.

use hardpoint::joint::Quantity;
use hardpoint::space::Vec3;
use hardpoint_file::{LengthUnit, ModelFile};

use crate::contents::Target;
use crate::links::{body_points, lines, rods};
use crate::tables::hardpoints;
use crate::{ExportedModel, Format, Writer};

mod drawing;

use drawing::{Drawing, number, point, single_line};

/// DXF format.
pub const FORMAT: Format = Format {
    name: "dxf",
    about: "skeleton of hardpoints and bodies as DXF",
    endings: &["dxf"],
    write: Writer::Described(Target::Drawing, write),
};

/// Layer of the hardpoints and their names.
const HARDPOINTS: &str = "hardpoints";
/// Text height of the names, as a fraction of the mechanism size.
const TEXT: f64 = 0.015;

fn write(file: &ModelFile, out: &mut ExportedModel) {
    let (model, units) = (&file.model, file.units);
    // Codes of $INSUNITS.
    let unit = match units.length {
        LengthUnit::Inch => 1,
        LengthUnit::Millimetre => 4,
        LengthUnit::Centimetre => 5,
        LengthUnit::Metre => 6,
    };
    let mut drawing = Drawing::default();
    let layer = drawing.add_layer(HARDPOINTS);
    let height = number(TEXT * units.from_si(Quantity::Length, model.size()));
    for (name, at) in hardpoints(file) {
        drawing.add_entity(&layer, "POINT", "AcDbPoint", &point(10, at));
        let text = format!("{} 40\n{height}\n  1\n{}\n100\nAcDbText\n", point(10, at), single_line(name));
        drawing.add_entity(&layer, "TEXT", "AcDbText", &text);
    }
    let in_units = |at: Vec3| at.to_array().map(|x| units.from_si(Quantity::Length, x));
    let line = |[a, b]: [Vec3; 2]| point(10, in_units(a)) + &point(11, in_units(b));
    for (b, places) in body_points(model).iter().enumerate().skip(1) {
        let body = &model.bodies[b];
        let links = lines(places);
        if links.is_empty() {
            out.report_unsupported("body", &body.name, "it has a single point, and no line");
            continue;
        }
        let layer = drawing.add_layer(&body.name);
        for link in links {
            drawing.add_entity(&layer, "LINE", "AcDbLine", &line(link.map(|at| body.frame.point(at))));
        }
    }
    for (joint, ends) in rods(model) {
        let [i, j] = joint.bodies.map(|b| model.bodies[b.0].frame);
        let layer = drawing.add_layer(&joint.name);
        drawing.add_entity(&layer, "LINE", "AcDbLine", &line([i.point(ends[0]), j.point(ends[1])]));
    }
    out.text = drawing.to_text(unit);
}
