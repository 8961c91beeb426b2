//! Alignment of nearly parallel axes: sources write angles with few digits, and a loop with slightly misaligned axes
//! cannot move.

use std::collections::BTreeSet;

use hardpoint::space::Vec3;

use crate::mechanism::Mechanism;
use crate::turn::{X, Y, Z};

/// Angle below which axes are assumed to be parallel, rad: half a turn is often written as 3.14.
pub const MEANT: f64 = 2e-3;

/// Axes that were aligned.
pub struct StraightenedAxes {
    /// Names of the joints whose axes were rotated.
    pub joints: Vec<String>,
    /// Maximum angle of rotation, rad.
    pub by: f64,
}

/// Aligns the axes in loops that are nearly parallel to a global axis or to a previous axis.
pub fn straighten(m: &mut Mechanism) -> Option<StraightenedAxes> {
    let mut known: Vec<Vec3> = [X, Y, Z].map(Vec3::from).to_vec();
    let mut done = StraightenedAxes { joints: Vec::new(), by: 0.0 };
    let turned: Vec<usize> = m.turned.iter().map(|frame| frame.joint).collect();
    // The axis of an assembled frame follows from its closure.
    for k in in_loops(m).into_iter().filter(|k| !turned.contains(k)) {
        let joint = &mut m.joints[k];
        // Pairs of axes remain perpendicular.
        let (Some(axis), None, None) = (joint.axis.and_then(Vec3::unit), joint.axis2, joint.through) else {
            continue;
        };
        match known.iter().find(|other| other.cross(axis).norm() <= MEANT) {
            Some(other) => {
                let off = other.cross(axis).norm();
                if off > 0.0 {
                    joint.axis = Some(if other.dot(axis) < 0.0 { -*other } else { *other });
                    done.joints.push(joint.name.clone());
                    done.by = done.by.max(off);
                }
            }
            None => known.push(axis),
        }
    }
    (!done.joints.is_empty()).then_some(done)
}

/// Returns the joints that remain when bodies with a single joint are removed repeatedly: those in loops and between
/// loops.
fn in_loops(m: &Mechanism) -> BTreeSet<usize> {
    let mut left: BTreeSet<usize> = (0..m.joints.len()).collect();
    loop {
        let mut joints_of = vec![0_usize; m.bodies.len()];
        left.iter().flat_map(|k| m.joints[*k].bodies).for_each(|b| joints_of[b] += 1);
        let before = left.len();
        left.retain(|k| m.joints[*k].bodies.iter().all(|b| joints_of[*b] > 1));
        if left.len() == before {
            return left;
        }
    }
}
