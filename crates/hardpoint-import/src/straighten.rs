//! Axes that are meant to be parallel: sources write angles with few digits, and a loop whose axes are off by a little
//! cannot move.

use std::collections::BTreeSet;

use hardpoint::space::Vec3;

use crate::mechanism::Mechanism;
use crate::turn::{X, Y, Z};

/// Axes nearer to each other than this, in rad, may be meant to be parallel: half a turn is often written as 3.14.
pub const MEANT: f64 = 2e-3;

/// Axes that were straightened.
pub struct StraightenedAxes {
    /// The joints whose axes are turned.
    pub joints: Vec<String>,
    /// By how much at most, in rad.
    pub by: f64,
}

/// Turns the axes in loops that are nearly parallel to a global axis, or to one before them, until they are.
pub fn straighten(m: &mut Mechanism) -> Option<StraightenedAxes> {
    let mut known: Vec<Vec3> = [X, Y, Z].map(Vec3::from).to_vec();
    let mut done = StraightenedAxes { joints: Vec::new(), by: 0.0 };
    let turned: Vec<usize> = m.turned.iter().map(|frame| frame.joint).collect();
    // A frame turns about the axis that closes it, whatever that is near.
    for k in in_loops(m).into_iter().filter(|k| !turned.contains(k)) {
        let joint = &mut m.joints[k];
        // Where there are two they stay square.
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

/// The joints without those of bodies that hang on a single one: what remains are the loops, and what is between them.
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
