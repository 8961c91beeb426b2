//! Motion that prescribes all six coordinates of one frame relative to another: a chain of driven slides and hinges
//! with bodies between them.

use hardpoint::law::Law as Function;
use hardpoint::space::{Mat3, Pose, Vec3};

use crate::law;
use crate::markers::{ElementSource, Marker};
use crate::mechanism::{Coordinate, Drives, Joint, Law, Mechanism};
use crate::report::ImportLog;
use crate::turn::{X, Y, Z};

/// Tolerance for equal values, in the unit of the file or rad.
const SAME: f64 = 1e-9;

/// One coordinate: a displacement along an axis of frame I, or a rotation about an axis of the frame rotated so far.
struct Step {
    kind: &'static str,
    axis: Vec3,
    law: String,
    first: f64,
}

/// Drives frame J relative to frame I: three displacements along the axes of I, followed by three rotations about the
/// given axes, all as expressions of the time.
///
/// # Errors
/// Returns the reason why the motion is not supported.
pub fn drive(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    [i, j]: [Marker; 2],
    displacements: [String; 3],
    turns: [(usize, String); 3],
) -> Result<(), String> {
    if i.body == j.body {
        return Err("its markers are on the same body".into());
    }
    let start = m.times.map_or(0.0, |t| t.start);
    let value = |text: &str| {
        let law = Function::parse(text).map_err(|_| format!("`{text}` cannot be evaluated"))?;
        Some(law.at(start).0[0])
            .filter(|x| x.is_finite())
            .ok_or_else(|| format!("`{text}` is not finite at {start} s"))
    };
    let (mut steps, mut pose) = (Vec::new(), i.pose);
    for (k, law) in displacements.into_iter().enumerate() {
        let (axis, first) = (i.pose.rot.cols[k], value(&law)?);
        pose.r += axis * first;
        steps.push(Step { kind: "translational", axis, law, first });
    }
    for (k, law) in turns {
        let axis = pose.rot.cols[k];
        let first = value(&law)?;
        pose.rot = pose.rot * Mat3::about([X, Y, Z][k].into(), first);
        steps.push(Step { kind: "revolute", axis, law, first });
    }
    // Constant coordinates need no joint.
    steps.retain(|s| law::constant(&s.law).is_none());
    let note = source.note(notes);
    let at = j.pose.r;
    let count = steps.len();
    let mut carrier = i.body;
    for (k, step) in steps.into_iter().enumerate() {
        let body = if k + 1 == count {
            j.body
        } else {
            let frame = Pose { rot: i.pose.rot, r: at };
            m.body(&format!("{}_{}", source.name, k + 1), note.clone(), Some(frame))
        };
        let name = format!("{}_{}", source.name, k + 1);
        let joint = m.joint(Joint::new(&name, note.clone(), step.kind, [carrier, body], at).along(step.axis));
        let coordinate = if step.kind == "revolute" { "angle" } else { "displacement" };
        let text = match step.first {
            0.0 => step.law,
            first => format!("{} - ({first})", step.law),
        };
        m.driver(
            &name,
            note.clone(),
            Drives::Coordinate(Coordinate { joint, name: coordinate }),
            Law::Text(text),
        );
        carrier = body;
    }
    if count == 0 {
        m.joint(Joint::new(source.name, note, "fixed", [i.body, j.body], at));
    }
    let off = (pose.r - at).norm() > SAME * (1.0 + at.norm()) || pose.rot.angle_to(j.pose.rot) > SAME;
    if off {
        let why = "the drawn positions of its markers differ from its initial values: it moves them from their drawn positions";
        notes.approximated(source.kind, source.name, source.at, why);
    } else {
        notes.taken(source.kind, source.name, source.at);
    }
    Ok(())
}
