//! Members of a live axle: rods, springs and dampers between the body of the vehicle and one rigid axle.

use hardpoint::space::{Pose, Vec3};

use crate::mechanism::{Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::with_word;

/// A body whose frame has its origin there and is parallel to the global one.
pub fn body(m: &mut Mechanism, name: &str, at: Vec3) -> usize {
    m.body(name, String::new(), Some(Pose { rot: crate::turn::none(), r: at }))
}

/// Names both ends of a member as hardpoints.
pub fn ends(m: &mut Mechanism, name: &str, ends: [Vec3; 2], words: [&str; 2]) {
    let named = ends.into_iter().zip(words).map(|(end, word)| (with_word(name, word), end));
    m.hardpoints.extend(named);
}

/// A rod between two bodies.
pub fn rod(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    name: &str,
    bodies: [usize; 2],
    [i, j]: [Vec3; 2],
    at: Option<SourceSpan>,
) {
    if i == j {
        let message = format!("both ends of `{name}` are at one place");
        notes.problem_with("HP0804", at, message, "correct one of them");
        return;
    }
    m.joint(Joint::new(name, String::new(), "distance", bodies, i).between(i, j));
    notes.taken("link", name, at);
}

/// A spring or a damper as a leg, which holds nothing and has a length that is worth knowing.
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
