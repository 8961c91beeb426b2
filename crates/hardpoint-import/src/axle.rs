//! Members of corners and live axles: rods, springs and dampers between the vehicle body and an upright or axle.

use hardpoint::space::{Pose, Vec3};

use crate::mechanism::{Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::with_word;

/// Adds a body whose frame has its origin at `at` and is parallel to the global frame.
pub fn body(m: &mut Mechanism, name: &str, at: Vec3) -> usize {
    m.body(name, String::new(), Some(Pose { rot: crate::turn::none(), r: at }))
}

/// Adds both ends of a member as hardpoints.
pub fn ends(m: &mut Mechanism, name: &str, ends: [Vec3; 2], words: [&str; 2]) {
    let named = ends.into_iter().zip(words).map(|(end, word)| (with_word(name, word), end));
    m.hardpoints.extend(named);
}

/// Adds a rod between two bodies.
pub fn rod(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    name: &str,
    bodies: [usize; 2],
    [i, j]: [Vec3; 2],
    at: Option<SourceSpan>,
) {
    if i == j {
        let message = format!("both ends of `{name}` coincide");
        notes.problem_with("HP0804", at, message, "correct one of them");
        return;
    }
    m.joint(Joint::new(name, String::new(), "distance", bodies, i).between(i, j));
    notes.taken("link", name, at);
}

/// Adds a spring or damper as a leg, which is no constraint; its length is measured.
pub fn leg(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    name: &str,
    bodies: [usize; 2],
    [i, j]: [Vec3; 2],
    draw: &'static str,
    at: Option<SourceSpan>,
) {
    let mut leg = Joint::new(name, String::new(), "leg", bodies, i).between(i, j);
    leg.draw = Some(draw);
    m.joint(leg);
    notes.taken(draw, name, at);
}
