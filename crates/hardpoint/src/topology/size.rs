//! Sizes of loops. Gaps, corrections and steps are relative to the size of their own loop, independent of the rest of
//! the model.

use std::collections::BTreeSet;

use crate::design::Geometry;
use crate::model::{Extent, JointId, Model};
use crate::space::{Real, Vec3};

use super::{Closure, Coordinate, Topology};

/// Sets the sizes of the loops, and the reference sizes of coordinates and rows.
pub(super) fn measure(model: &Model, topology: &mut Topology) {
    let joints_of_body = joints_of_bodies(model);
    let whole = model.size();
    let extents: Vec<(Vec<JointId>, f64)> =
        topology.closures.iter().map(|c| loop_size(model, topology, c, &joints_of_body, whole)).collect();
    for (closure, (joints, size)) in topology.closures.iter_mut().zip(extents) {
        (closure.extent, closure.size) = (joints, size);
    }
    for place in &mut topology.rows {
        let closure = &topology.closures[place.closure.0];
        place.unit = if closure.rows[place.index].is_length() { closure.size } else { 1.0 };
    }
    // A coupler is one row: all of its terms have the reference size of the first one.
    for k in 0..topology.coupled_rows.len() {
        let r = topology.coupled_rows[k];
        for term in topology[r].terms.clone() {
            topology[term.row].unit = topology[r].unit;
        }
    }
    // Links without a loop are placed by drivers alone.
    let mut largest = vec![0.0_f64; topology.links.len()];
    for closure in &topology.closures {
        for around in &closure.links {
            let largest = &mut largest[around.link.0];
            *largest = largest.max(closure.size);
        }
    }
    for coordinate in topology.coordinates.iter_mut().filter(|c| c.is_length) {
        let size = largest[coordinate.link.0];
        coordinate.unit = if size > 0.0 { size } else { whole };
        coordinate.per_unit = 1.0 / coordinate.unit;
    }
}

/// Reference lengths of the coordinates in a design, m: like [`Coordinate::unit`](super::Coordinate::unit), but with
/// sizes of the loops that follow the design smoothly and do not depend on the orientation of the whole.
pub(crate) fn units_of<T: Real>(model: &Model, topology: &Topology, geometry: &Geometry<T>) -> Vec<T> {
    let place = |j: &JointId, e: usize| {
        let body = model.joints[j.0].bodies[e];
        model.bodies[body.0].frame.spread().point(geometry.markers[j.0][e].r)
    };
    // Twice the root mean square distance from the mean: of two places, their distance.
    let size = |closure: &Closure| {
        let places = || closure.extent.iter().flat_map(|j| [0, 1].map(|e| place(j, e)));
        let per = T::constant(1.0 / places().count().max(1) as f64);
        let mean = places().fold(Vec3::zero(), |sum, p| sum + p) * per;
        let square = places().map(|p| (p - mean).dot(p - mean)).fold(T::zero(), |sum, x| sum + x) * per;
        if closure.extent.is_empty() { T::constant(closure.size) } else { square.sqrt() * T::constant(2.0) }
    };
    let mut largest: Vec<Option<T>> = vec![None; topology.links.len()];
    for closure in &topology.closures {
        let size = size(closure);
        for around in &closure.links {
            let largest = &mut largest[around.link.0];
            *largest = Some(largest.map_or(size, |known| known.larger(size)));
        }
    }
    let unit = |c: &Coordinate| {
        let largest = largest[c.link.0].filter(|_| c.is_length);
        largest.unwrap_or_else(|| T::constant(c.unit))
    };
    topology.coordinates.iter().map(unit).collect()
}

/// Returns the joints of each body.
fn joints_of_bodies(model: &Model) -> Vec<Vec<usize>> {
    let mut joints = vec![Vec::new(); model.bodies.len()];
    for (k, joint) in model.joints.iter().enumerate() {
        for body in joint.bodies {
            joints[body.0].push(k);
        }
    }
    joints
}

/// Returns the joints of a loop and their extent. If they coincide, or if bodies move freely: those of all joints of
/// its bodies; no joint, and the size of the whole, if these coincide too.
fn loop_size(
    model: &Model,
    topology: &Topology,
    closure: &Closure,
    joints_of_body: &[Vec<usize>],
    whole: f64,
) -> (Vec<JointId>, f64) {
    let links = || closure.links.iter().map(|around| &topology[around.link]);
    let around: BTreeSet<JointId> =
        links().filter_map(|l| l.joint).chain(std::iter::once(closure.joint)).collect();
    let size = extent(model, around.iter().copied());
    if size > 0.0 && links().all(|l| l.joint.is_some()) {
        return (around.into_iter().collect(), size);
    }
    let bodies = links().map(|l| l.child);
    let joints: BTreeSet<JointId> =
        bodies.flat_map(|b| joints_of_body[b.0].iter().map(|j| JointId(*j))).collect();
    let size = extent(model, joints.iter().copied());
    if size > 0.0 { (joints.into_iter().collect(), size) } else { (Vec::new(), whole) }
}

/// Returns the extent of the markers of joints in the design configuration; 0 if they coincide.
fn extent(model: &Model, joints: impl Iterator<Item = JointId>) -> f64 {
    Extent::of(joints.flat_map(|j| [0, 1].map(|end| model.marker(j, end).r))).size_or_zero()
}
