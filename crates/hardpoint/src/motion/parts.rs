//! A design laid out in the order in which the plan walks it.

use crate::model::{Geometry, Model};
use crate::space::{Pose, Real};
use crate::topology::Topology;

/// Marker poses per link and per closure, one design per lane.
#[derive(Clone, Debug)]
pub(crate) struct Parts<T> {
    /// Per link: the marker on the parent, in the parent.
    pub parent_marker: Vec<Pose<T>>,
    /// Per link: the child, seen from its marker.
    pub child_from_marker: Vec<Pose<T>>,
    /// Per closure: marker i in body i, marker j in body j.
    pub ends: Vec<[Pose<T>; 2]>,
    /// Per closure: design length of its joint.
    pub lengths: Vec<T>,
}

impl<T: Real> Parts<T> {
    /// Lane k takes `designs[k]`, or the last design where there are fewer.
    pub fn new(model: &Model, topology: &Topology, designs: &[Geometry], witness: T) -> Self {
        let lane = |k: usize| &designs[k.min(designs.len() - 1)];
        let marker = |joint: usize, end: usize| {
            if T::LANES == 1 {
                return lane(0).markers[joint][end].spread(witness);
            }
            gather(witness, |k| lane(k).markers[joint][end])
        };
        Self {
            parent_marker: topology
                .links
                .iter()
                .map(|l| match l.joint {
                    Some(j) => marker(j.0, l.parent_end),
                    None => model.bodies[l.child.0].frame.spread(witness),
                })
                .collect(),
            child_from_marker: topology
                .links
                .iter()
                .map(|l| match l.joint {
                    Some(j) => marker(j.0, 1 - l.parent_end).inverse(),
                    None => Pose::IDENTITY.spread(witness),
                })
                .collect(),
            ends: topology.closures.iter().map(|c| [marker(c.joint.0, 0), marker(c.joint.0, 1)]).collect(),
            lengths: topology
                .closures
                .iter()
                .map(|c| witness.like_lanes(|k| lane(k).lengths[c.joint.0]))
                .collect(),
        }
    }
}

fn gather<T: Real>(witness: T, pose: impl Fn(usize) -> Pose) -> Pose<T> {
    let mut out = Pose::IDENTITY.spread(witness);
    let component = |f: &dyn Fn(Pose) -> f64| witness.like_lanes(|k| f(pose(k)));
    for c in 0..3 {
        out.rot.cols[c].x = component(&|p| p.rot.cols[c].x);
        out.rot.cols[c].y = component(&|p| p.rot.cols[c].y);
        out.rot.cols[c].z = component(&|p| p.rot.cols[c].z);
    }
    out.r.x = component(&|p| p.r.x);
    out.r.y = component(&|p| p.r.y);
    out.r.z = component(&|p| p.r.z);
    out
}
