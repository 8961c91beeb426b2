//! Encoding of a page's data: JSON and all curves as one deflated block in base 91.
//!
//! The curves are packed as [`tracks`](hardpoint_table::tracks): those that the page computes with at full precision,
//! those that it only draws and ranks within a small error.

use std::io::Write;

use flate2::{Compression, write::DeflateEncoder};
use hardpoint_table::tracks::{Precision, Tracks};
use serde::Serialize;

use crate::base91;
use crate::page::{Curve, Design, PairTrack, Payload, ShapeMark};

/// Packs the payload: encodes and deflates it.
///
/// # Errors
/// If the payload cannot be serialised, which does not happen with plain numbers and strings.
pub(crate) fn packed(payload: &Payload) -> Result<Vec<u8>, serde_json::Error> {
    Ok(deflated(&block(payload)?))
}

/// Number of bytes of the page a packed payload takes.
pub(crate) fn size_in_page(packed: &[u8]) -> usize {
    base91::length(packed.len())
}

/// A page is 0.6 % larger than at the default level 6, and is packed in less than half the time.
const LEVEL: u32 = 3;

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::new(LEVEL));
    deflated.write_all(bytes).and_then(|()| deflated.finish()).expect("a vector takes all that is written")
}

/// Encoded payload before deflation.
fn block(payload: &Payload) -> Result<Vec<u8>, serde_json::Error> {
    let mut payload = payload.clone();
    let mut tracks = Tracks::default();
    each_curve(&mut payload, &mut |curve, precision, parts| {
        let tracks = tracks.add(curve.values(), precision, parts);
        *curve = std::mem::take(curve).in_tracks(tracks);
    });
    Ok(tracks.block(&serde_json::to_vec(&payload)?))
}

/// Visits every curve of the payload, with its precision and number of values per step.
fn each_curve(payload: &mut Payload, visit: &mut impl FnMut(&mut Curve, Precision, usize)) {
    use Precision::{Approximate, Full};
    visit(&mut payload.times, Full, 1);
    for body in &mut payload.bodies {
        visit(&mut body.poses, Full, 7);
        if let Some(mesh) = &mut body.mesh {
            visit(&mut mesh.positions, Full, 3);
            visit(&mut mesh.triangles, Full, 3);
        }
    }
    for driver in &mut payload.drivers {
        visit(&mut driver.travel, Full, 1);
        driver.alone.iter_mut().for_each(|curve| visit(curve, Full, 1));
    }
    payload.loads.iter_mut().for_each(|load| visit(&mut load.force, Full, 3));
    if let Some(clearance) = &mut payload.clearance {
        each_curve_of_shapes(&mut clearance.shapes, &mut clearance.pairs, visit);
    }
    for q in &mut payload.quantities {
        [&mut q.value, &mut q.rate, &mut q.accel, &mut q.wanted]
            .into_iter()
            .for_each(|curve| visit(curve, Full, 1));
    }
    payload.designs.iter_mut().for_each(|design| each_curve_of(design, visit));
    for quantity in payload.maps.iter_mut().flat_map(|map| &mut map.quantities) {
        visit(&mut quantity.values, Full, 1);
        quantity.sensitivities.iter_mut().for_each(|s| visit(&mut s.values, Approximate, 1));
    }
    for axis in payload.sweep.iter_mut().flat_map(|sweep| &mut sweep.axes) {
        visit(&mut axis.values, Approximate, 1);
    }
    if let Some(margin) = &mut payload.margin {
        // The margin is drawn over decades.
        visit(&mut margin.value, Full, 1);
    }
    for variable in &mut payload.variables {
        variable.shifts.iter_mut().for_each(|shifts| visit(shifts, Approximate, 6));
        for s in &mut variable.sensitivities {
            [&mut s.value, &mut s.rate, &mut s.accel]
                .into_iter()
                .for_each(|curve| visit(curve, Approximate, 1));
            if let Some(d) = &mut s.fd {
                [&mut d.value, &mut d.rate, &mut d.accel]
                    .into_iter()
                    .for_each(|curve| visit(curve, Approximate, 1));
            }
        }
    }
}

fn each_curve_of(design: &mut Design, visit: &mut impl FnMut(&mut Curve, Precision, usize)) {
    use Precision::Full;
    design.poses.iter_mut().for_each(|poses| visit(poses, Full, 7));
    design.loads.iter_mut().for_each(|force| visit(force, Full, 3));
    for q in design.quantities.iter_mut().flatten() {
        [&mut q.value, &mut q.rate, &mut q.accel].into_iter().for_each(|curve| visit(curve, Full, 1));
    }
    design.margin.iter_mut().for_each(|margin| visit(margin, Full, 1));
    if let Some(clearance) = &mut design.clearance {
        each_curve_of_shapes(&mut clearance.shapes, &mut clearance.pairs, visit);
    }
}

fn each_curve_of_shapes(
    shapes: &mut [ShapeMark],
    pairs: &mut [PairTrack],
    visit: &mut impl FnMut(&mut Curve, Precision, usize),
) {
    use Precision::Full;
    for shape in shapes {
        visit(&mut shape.vertices, Full, 3);
        visit(&mut shape.triangles, Full, 3);
    }
    for pair in pairs {
        visit(&mut pair.distance, Full, 1);
        visit(&mut pair.points, Full, 6);
    }
}

/// Value with curves that can be passed on in plain layout, one number after the other: a curve is then the index of
/// its first number and their count. For callers within the same program, which need no packing.
pub trait Plain: Serialize + Sized {
    /// Appends the curves to `numbers` and replaces them by their positions.
    fn lay_out(&mut self, numbers: &mut Vec<f32>);
}

fn laid_out(numbers: &mut Vec<f32>) -> impl FnMut(&mut Curve, Precision, usize) {
    |curve, _, _| {
        let place = [numbers.len(), curve.values().len()].map(|n| n as u32);
        numbers.extend_from_slice(curve.values());
        *curve = std::mem::take(curve).in_tracks(place.to_vec());
    }
}

impl Plain for Payload {
    fn lay_out(&mut self, numbers: &mut Vec<f32>) {
        each_curve(self, &mut laid_out(numbers));
    }
}

impl Plain for Design {
    fn lay_out(&mut self, numbers: &mut Vec<f32>) {
        each_curve_of(self, &mut laid_out(numbers));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{fs, io::Read, path::Path};

    use crate::page::{Margin, tests::payload};
    use flate2::read::DeflateDecoder;

    /// Page with a curve of every form; the tests of the page read its packed block.
    fn sample() -> Payload {
        let mut sample = payload("packed");
        sample.times = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        let wave = |k: i32| if (3..5).contains(&k) { f64::NAN } else { (0.1 * f64::from(k)).sin() };
        sample.margin = Some(Margin { value: (0..40).map(wave).collect(), note: String::new() });
        sample.bodies = vec![crate::page::BodyTrack {
            name: "ground".into(),
            poses: (0..40).flat_map(|k| [f64::from(k), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]).collect(),
            skeleton: vec![],
            labels: vec![],
            roles: vec![],
            mesh: None,
        }];
        let mut variable = crate::page::Variable {
            name: "x".into(),
            description: String::new(),
            unit: "mm".into(),
            admissibility: crate::page::Admissibility::Admissible,
            note: String::new(),
            arrows: vec![],
            typical: None,
            tolerance: None,
            bounds: None,
            shifts: vec![],
            sensitivities: vec![],
        };
        variable.sensitivities.push(crate::page::Sensitivity {
            quantity: 0,
            value: (0..40).map(|k| (0.1 * f64::from(k)).cos()).collect(),
            rate: (0..40).map(|_| f64::NAN).collect(),
            accel: Curve::default(),
            fd: None,
        });
        sample.variables = vec![variable];
        sample
    }

    #[test]
    fn the_page_is_tested_with_a_block_as_it_is_written() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/test/packed.txt");
        let expected = block(&sample()).unwrap();
        let written = fs::read_to_string(&path).unwrap_or_default();
        let mut found = Vec::new();
        let bytes = base91::decode(written.trim()).unwrap_or_default();
        let read = DeflateDecoder::new(&bytes[..]).read_to_end(&mut found);
        if read.is_err() || found != expected {
            fs::write(&path, base91::encode(&deflated(&expected)) + "\n").unwrap();
            panic!("web/test/packed.txt was out of date and has been rewritten: commit it");
        }
    }
}
