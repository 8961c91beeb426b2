//! Points of curves on bodies whose joints move.

use hardpoint::joint::Quantity;
use hardpoint::space::Vec3;
use toml_edit::Value;

use crate::read::ModelFile;

use super::edit::Edit;
use super::text::Step::{At, Key};
use super::text::value_at;

impl Edit<'_> {
    /// Moves the points of curves with the markers that carry them: in a changed design a curve keeps its shape and
    /// its place at the marker, while its points in the file are in the design configuration.
    pub(super) fn curves(&mut self) {
        let model = &self.file.model;
        let [before, after] = [&[][..], &self.values].map(|design| model.geometry(design));
        for (j, joint) in model.joints.iter().enumerate().filter(|(_, joint)| joint.curve.is_some()) {
            let frame = model.bodies[joint.bodies[0].0].frame;
            let [old, new] = [&before, &after].map(|geometry| frame.compose(geometry.markers[j][0]));
            if old == new {
                continue;
            }
            let path = [Key("joints"), Key(&joint.name), Key("curve"), Key("points")];
            let file = self.file;
            let points = value_at(&mut self.document, &path).and_then(|points| points.as_array());
            let points: Vec<Option<Vec3>> =
                points.into_iter().flatten().map(|point| written_place(file, point)).collect();
            for (k, place) in points.into_iter().enumerate() {
                // Points with a name are hardpoints: others may use them, and reading back decides.
                let Some(place) = place else { continue };
                let moved = new.compose(old.inverse()).point(place);
                for axis in 0..3 {
                    if moved[axis] != place[axis] {
                        let way = [&path[..], &[At(k), At(axis)]].concat();
                        self.write(&way, Quantity::Length, place.norm(), moved[axis]);
                    }
                }
            }
        }
    }
}

/// Place written as numbers, m; two of them are those of the plane of a planar model.
fn written_place(file: &ModelFile, point: &Value) -> Option<Vec3> {
    let number = |x: &Value| x.as_float().or_else(|| x.as_integer().map(|i| i as f64));
    let numbers: Option<Vec<f64>> = (point.as_array()?.iter())
        .map(|x| number(x).map(|x| file.units.to_si(Quantity::Length, x)))
        .collect();
    match (&numbers?[..], file.plane) {
        ([x, y, z], _) => Some(Vec3::new(*x, *y, *z)),
        (pair @ [_, _], Some(plane)) => {
            let of = |axis: usize| plane.coordinate(axis).map_or(0.0, |k| pair[k]);
            Some(Vec3::new(of(0), of(1), of(2)))
        }
        _ => None,
    }
}
