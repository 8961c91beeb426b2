//! Kinematic admissibility of design variables.

use std::collections::HashMap;

use crate::constraint::Row;
use crate::design::DesignVelocity;
use crate::model::{CouplerTerm, JointId, Model};
use crate::number;
use crate::space::Twist;

/// Admissibility of a design variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Admissibility {
    /// Every joint stays closed with all bodies where they are: no re-assembly (paper, section 4).
    Admissible,
    /// Some joints open at the design configuration, and the mechanism closes again on its branch: its sensitivities
    /// are those of the re-assembled mechanism.
    Reassembled {
        /// The joints that open.
        joints: Vec<JointDefect>,
    },
    /// The redundant constraints contradict each other under the change: there is no sensitivity.
    CannotFollow {
        /// The joints that resist, with their largest defect over the motion.
        joints: Vec<JointDefect>,
        /// The time of the largest defect, s.
        time: f64,
    },
    /// The motion was not solved, so only the design configuration is known to be closed.
    Unknown,
}

/// Opening of a joint per unit of a design variable.
#[derive(Clone, Debug, PartialEq)]
pub struct JointDefect {
    /// The joint.
    pub joint: JointId,
    /// Elementary constraint with the largest defect.
    pub row: Row,
    /// Defect per unit of the variable: m or a cosine, per m, rad or unit of tau.
    pub value: f64,
}

/// Defects below this fraction of the field's speed are round-off of velocities in the file.
const OPEN: f64 = 1e-7;

/// Effect of a variable on one elementary constraint of a joint at the design configuration, with all bodies fixed.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// The joint; of a coupler its first one.
    pub joint: JointId,
    /// The constraint.
    pub row: Row,
    /// Signed opening per unit of the variable: m or a cosine, per m, rad or unit of tau.
    pub value: f64,
}

/// Conditions of all joints that a variable changes: `l . (z_j - z_i) - L' = 0` for each of their elementary
/// constraints (`docs/theory.md` (8), paper section 4: Dot-1, Dot-2, spherical, distance).
pub fn conditions_at_design(model: &Model, field: &DesignVelocity) -> Vec<Condition> {
    let twists = |k: usize| {
        number::both([0, 1], |end| {
            let twist = field.twist_of(JointId(k), end).unwrap_or(Twist::ZERO);
            model.bodies[model.joints[k].bodies[end].0].frame.carry(twist)
        })
    };
    let mut touched: Vec<usize> = field.markers.iter().map(|m| m.joint.0).collect();
    touched.extend(field.kept.iter().map(|(j, _)| j.0));
    touched.sort_unstable();
    touched.dedup();
    let mut driven: HashMap<JointId, Vec<Row>> = HashMap::new();
    for driver in &model.drivers {
        driven.entry(driver.joint).or_default().push(model.driven(driver).row);
    }
    let mut conditions = Vec::new();
    for k in touched {
        let (joint, z) = (JointId(k), twists(k));
        let kept = field.kept_rate(joint).unwrap_or_default();
        let ends = model.ends(joint);
        // A driven coordinate is a constraint too: it must stay at zero in the design configuration.
        let driven = driven.get(&joint).into_iter().flatten().copied();
        let rows = model.joints[k].kind.rows.iter().copied().chain(driven);
        // l . (z_j - z_i) - L', which is (11) with W = 0: the paper's (4.3), (4.6), (4.9) and (4.11) differentiated by
        // tau at tau = 0 (`docs/theory.md` (32)).
        let value = |row: Row| row.wrench(&ends).on(z[1] - z[0]) - kept.by(row);
        conditions.extend(rows.map(|row| Condition { joint, row, value: value(row) }));
    }
    for coupler in &model.couplers {
        let change = |t: &CouplerTerm| {
            let z = twists(t.joint.0);
            // sum c_k l_k . (z_j - z_i), per c_0 so that it is in the unit of the first term
            t.coefficient * model.coupled(t).row.wrench(&model.ends(t.joint)).on(z[1] - z[0])
        };
        let first = coupler.terms[0];
        let value = coupler.terms.iter().map(change).sum::<f64>() / first.coefficient;
        conditions.push(Condition { joint: first.joint, row: model.coupled(&first).row, value });
    }
    conditions
}

/// The joints that a variable opens at the design configuration while all bodies stay, each with the condition that
/// fails most. None means admissible there.
pub fn admissibility_at_design(model: &Model, field: &DesignVelocity) -> Vec<JointDefect> {
    // A joint opens if abs(l . (z_j - z_i) - L') > 1e-7 of the field's largest speed.
    let scale = field.markers.iter().map(|m| m.twist.w.norm().max(m.twist.v.norm())).fold(0.0, f64::max);
    let mut joints: Vec<JointDefect> = Vec::new();
    let mut place_of: HashMap<JointId, usize> = HashMap::new();
    for Condition { joint, row, value } in conditions_at_design(model, field) {
        let value = value.abs();
        if !(value > OPEN * scale) {
            continue;
        }
        let next = joints.len();
        match place_of.entry(joint).or_insert(next) {
            k if *k == next => joints.push(JointDefect { joint, row, value }),
            k if value > joints[*k].value => (joints[*k].row, joints[*k].value) = (row, value),
            _ => {}
        }
    }
    joints
}
