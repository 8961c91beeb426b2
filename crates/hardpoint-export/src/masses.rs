//! Mass properties of bodies that other programs accept.

use hardpoint::load::{BodyMass, body_masses};
use hardpoint::model::Model;
use hardpoint::space::{Mat3, Vec3};

/// Relative tolerance of moments of inertia from typed digits: that of the check of a model.
const FLAT: f64 = 1e-3;

/// Round-off of the axes of a body in an entry of an inertia matrix, relative to the largest entry.
const ROUND_OFF: f64 = 1e-14;

/// Mass properties of a body as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenMass {
    pub mass: BodyMass,
    /// Change that the format requires, if there is one.
    pub change: Option<&'static str>,
}

/// Mass properties of all bodies, with moments of inertia that a rigid body can have: those that the model leaves out
/// are the minimum.
pub fn possible_masses(model: &Model) -> Vec<Option<WrittenMass>> {
    let of = |mass: BodyMass| {
        let slack = FLAT * mass.inertia.cols.iter().map(|c| c.norm()).fold(0.0, f64::max);
        let written = with_second_moments(mass, [-slack, 0.0]);
        let change = (written != mass).then_some(
            "moments of inertia that the model leaves out are written as the least that the others permit",
        );
        WrittenMass { mass: written, change }
    };
    body_masses(model).into_iter().map(|mass| mass.map(of)).collect()
}

/// Mass properties of all bodies, each with a mass and with moments of inertia, for programs that require both. A point
/// has the moments of a ball with the radius of gyration `radius`; a body without mass is such a point with a small
/// part of the lightest mass.
pub fn positive_masses(model: &Model, radius: f64) -> Vec<WrittenMass> {
    let found = possible_masses(model);
    let lightest = found.iter().flatten().map(|m| m.mass.mass).reduce(f64::min);
    let written = |(body, found): (usize, &Option<WrittenMass>)| {
        let none = || {
            let centre = model.bodies[body].frame.r;
            let Some(lightest) = lightest else {
                // Unit inertia to be replaced. That no body has a mass is a single report.
                let inertia = diagonal([1.0; 3]);
                return WrittenMass { mass: BodyMass { mass: 1.0, centre, inertia }, change: None };
            };
            let mass = BodyMass { mass: NEGLIGIBLE * lightest, centre, inertia: diagonal([0.0; 3]) };
            let why = "it has no mass: a point with a thousandth of the lightest body's mass is written";
            WrittenMass { mass, change: Some(why) }
        };
        let WrittenMass { mass, change } = found.unwrap_or_else(none);
        // Of a ball, each second moment is half of a moment of inertia.
        let ball = 0.5 * mass.mass * radius.powi(2);
        let raised = with_second_moments(mass, [0.5 * ball, ball]);
        let point = "moments of inertia that are zero are written as small positive ones";
        WrittenMass { mass: raised, change: change.or((raised != mass).then_some(point)) }
    };
    found.iter().enumerate().map(written).collect()
}

/// Part of the lightest body's mass that bodies without mass have where a mass is required.
const NEGLIGIBLE: f64 = 1e-3;

/// Raises the second moments of a mass, `S = tr I / 2 1 - I` with `I = tr S 1 - S`, by a minimum if one of them is
/// below a limit. A raise along one direction leaves the moment of inertia about that direction as it is.
fn with_second_moments(mass: BodyMass, [limit, least]: [f64; 2]) -> BodyMass {
    let entry = |m: &Mat3, r: usize, c: usize| m.cols[c][r];
    let of_trace = |m: &Mat3, part: f64| {
        let trace: f64 = (0..3).map(|k| entry(m, k, k)).sum();
        let cols = [0, 1, 2].map(|c| Vec3::AXES[c] * (part * trace) - m.cols[c]);
        Mat3 { cols }
    };
    let raised_by =
        |m: &Mat3, by: [f64; 3]| Mat3 { cols: [0, 1, 2].map(|c| m.cols[c] + Vec3::AXES[c] * by[c]) };
    let second = of_trace(&mass.inertia, 0.5);
    let is_above = |m: &Mat3| is_positive(raised_by(m, [-limit; 3]));
    if is_above(&second) {
        return mass;
    }
    // Round-off of a body without extent along one direction.
    let little = raised_by(&second, [least; 3]);
    let raised = if least > 0.0 && is_above(&little) {
        little
    } else {
        // A matrix whose diagonal dominates.
        let others =
            |k: usize| [(k + 1) % 3, (k + 2) % 3].map(|j| entry(&second, j, k).abs()).iter().sum::<f64>();
        let missing = [0, 1, 2].map(|k| (others(k) + least - entry(&second, k, k)).max(0.0));
        raised_by(&second, missing)
    };
    BodyMass { inertia: of_trace(&raised, 1.0), ..mass }
}

/// Returns true if a symmetric matrix has no negative pivot.
fn is_positive(m: Mat3) -> bool {
    let [[a, d, f], [_, b, e], [.., c]] = m.cols.map(|col| col.to_array());
    // Pivots of the elimination, each times those before it.
    let second = a * b - d * d;
    let third = c * second - a * e * e - b * f * f + 2.0 * d * e * f;
    a >= 0.0 && b >= 0.0 && c >= 0.0 && second >= 0.0 && a * c >= f * f && b * c >= e * e && third >= 0.0
}

fn diagonal(entries: [f64; 3]) -> Mat3 {
    Mat3 { cols: [0, 1, 2].map(|k| Vec3::AXES[k] * entries[k]) }
}

/// Entries xx, yy, zz, xy, xz and yz of an inertia matrix; zero if they are round-off.
pub fn entries(inertia: &Mat3) -> [f64; 6] {
    let [[xx, xy, xz], [_, yy, yz], [.., zz]] = inertia.cols.map(|col| col.to_array());
    let entries = [xx, yy, zz, xy, xz, yz];
    let largest = entries.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    entries.map(|x| if x.abs() > ROUND_OFF * largest { x } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(inertia: Mat3) -> BodyMass {
        BodyMass { mass: 2.0, centre: Vec3::ZERO, inertia }
    }

    #[test]
    fn a_body_without_mass_is_a_small_part_of_the_lightest_one_in_mass_and_inertia() {
        let text = "name = \"m\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1, steps = 2 }\n\
                    [hardpoints]\nA = [0, 0, 0]\nB = [900, 0, 0]\n[bodies]\narm = {}\nlink = {}\n\
                    [joints]\na = { type = \"revolute\", bodies = [\"ground\", \"arm\"], at = \"A\", axis = \"z\" }\n\
                    b = { type = \"revolute\", bodies = [\"arm\", \"link\"], at = \"B\", axis = \"z\" }\n\
                    [drivers]\na = { joint = \"a\", law = \"t\" }\nb = { joint = \"b\", law = 0 }\n\
                    [masses]\nm = { type = \"rigid\", centre = { body = \"arm\", at = [9, 0, 0] }, mass = 2, \
                    ixx = 0.002, iyy = 0.003, izz = 0.004 }\n";
        let file = hardpoint_file::parse(text, "m.toml").unwrap();
        let [_, arm, link] = positive_masses(&file.model, 1e-3 * file.model.size())[..] else { panic!() };
        assert_eq!((arm.mass.mass, arm.change), (2.0, None));
        assert_eq!(link.mass.mass, 0.002);
        assert!(link.change.is_some_and(|why| why.contains("thousandth")));
        for column in link.mass.inertia.cols {
            let moment = column.norm();
            assert!(moment > 0.0 && moment < 1e-3 * 0.002, "{moment}");
        }
    }

    #[test]
    fn moments_that_a_body_can_have_stay_and_others_are_raised_least() {
        // A cube, a flat plate, a point.
        for possible in [[1.0, 1.0, 1.0], [1.0, 2.0, 3.0], [0.0; 3]] {
            let mass = body(diagonal(possible));
            assert_eq!(with_second_moments(mass, [0.0, 0.0]), mass, "{possible:?}");
        }
        // In a plane only the moment about its normal is known; it stays.
        let found = with_second_moments(body(diagonal([0.0, 0.0, 4.0])), [0.0, 0.0]).inertia;
        assert_eq!(found, diagonal([2.0, 2.0, 4.0]));
        // A point becomes a ball.
        let found = with_second_moments(body(diagonal([0.0; 3])), [0.25, 0.5]).inertia;
        assert_eq!(found, diagonal([1.0; 3]));
        // A thin rod along (1, 2, 2) / 3 with I = m l^2 / 12 (1 - u u^T) keeps its moments but for the minimum.
        let u = Vec3::new(1.0, 2.0, 2.0) * (1.0 / 3.0);
        let cols = [0, 1, 2].map(|k| Vec3::AXES[k] - u * u[k]);
        let found = with_second_moments(body(Mat3 { cols }), [0.5e-6, 1e-6]).inertia;
        for (a, b) in entries(&found).iter().zip(entries(&Mat3 { cols })) {
            assert!((a - b).abs() < 5e-6, "{found:?}");
        }
    }
}
