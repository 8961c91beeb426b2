//! Motion of an answer's model, compared with the task.

use hardpoint::Solution;
use hardpoint::model::{BodyId, Model};
use hardpoint::motion::BodyState;
use hardpoint::space::Vec3;

use super::plane::Complex;
use super::result::Answer;

/// Largest differences between the motion of a model and the poses of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngineDeviation {
    /// Distance of the guided point, m.
    pub distance: f64,
    /// Angle of the coupler, rad.
    pub angle: f64,
}

/// Compares the motion of a model with an answer: `body` is the name of its coupler, `steps` are the output times at
/// which the poses are passed. `None` if the motion ended before, or there is no such body.
pub fn deviation_of_engine(
    model: &Model,
    solution: &Solution,
    answer: &Answer,
    body: &str,
    steps: &[usize],
) -> Option<EngineDeviation> {
    let body = BodyId(model.bodies.iter().position(|b| b.name == body)?);
    let design = BodyState::at_design(model, body).pose().inverse();
    let at = |step: usize, p: Complex| {
        let moved = (step < solution.motion.len()).then(|| solution.motion.at(step).body(body.0).pose())?;
        Some(moved.compose(design).point(Vec3::new(p.x, p.y, 0.0)))
    };
    let mut found = EngineDeviation { distance: 0.0, angle: 0.0 };
    for (moved, step) in answer.moves.iter().zip(steps) {
        let (p, c) = (answer.linkage.p, answer.linkage.p + Complex::new(1.0, 0.0));
        let [own, ahead] = [at(*step, p)?, at(*step, c)?];
        let (expected, turn) = (moved.of(p), moved.turn);
        found.distance = found.distance.max((own.x - expected.x).hypot(own.y - expected.y));
        let way = Complex::new(ahead.x - own.x, ahead.y - own.y);
        found.angle = found.angle.max(turn.cross(way).atan2(turn.dot(way)).abs());
    }
    Some(found)
}
