//! Outcome of driving a linkage through the poses of a task, and linkages that are alike.

use hardpoint_planar::defects::{Defect, Passage, passage};
use hardpoint_planar::linkage::Linkage;
use hardpoint_planar::plane::Displacement;

/// Searches whose joints are nearer than this, in sizes, end at the same linkage.
pub(super) const MERGED: f64 = 0.02;
/// Answers of a family whose joints are nearer than this, in sizes, are alike; only the best of them is kept.
pub(super) const ALIKE: f64 = 0.08;
/// Answers nearer than this, in sizes, are the same.
pub(super) const SAME: f64 = 1e-6;

/// Outcome of driving a linkage at one side or the other.
pub(super) enum Driven {
    /// It passes the poses: its score, the linkage driven at the better side, and the passage.
    Well((f64, Linkage, Passage)),
    /// It passes them only with a crank that does not turn fully, as it must.
    Rocking,
    /// It has a defect, the least of both sides.
    Not(Defect),
}

/// Drives a linkage at each of the given sides.
pub(super) fn driven(
    sides: [Option<Linkage>; 2],
    moves: &[Displacement],
    any_order: bool,
    full_turn: bool,
) -> Driven {
    let (mut best, mut least, mut rocks) = (None::<(f64, Linkage, Passage)>, Defect::Singular, false);
    for linkage in sides.into_iter().flatten() {
        match passage(&linkage, moves, any_order) {
            Ok(passage) if full_turn && !passage.is_full => rocks = true,
            Ok(passage) => {
                let score = score(&linkage, &passage, 1.0);
                if best.as_ref().is_none_or(|b| score > b.0) {
                    best = Some((score, linkage, passage));
                }
            }
            Err(defect) => least = least.min(defect),
        }
    }
    match best {
        Some(best) => Driven::Well(best),
        None if rocks => Driven::Rocking,
        None => Driven::Not(least),
    }
}

/// Score of a linkage: `sin mu / (1 + extent / (4 size))`.
fn score(linkage: &Linkage, passage: &Passage, size: f64) -> f64 {
    passage.transmission.sin() / (1.0 + 0.25 * linkage.extent() / size)
}

/// True if the joints of two linkages are near one another, whichever side drives.
pub(super) fn is_alike(one: &Linkage, other: &Linkage, distance: f64) -> bool {
    let (a, b) = (one.joints(), other.joints());
    let near = |order: &[usize]| order.iter().zip(&b).all(|(k, q)| (a[*k] - *q).norm() < distance);
    a.len() == b.len()
        && if a.len() == 4 { near(&[0, 1, 2, 3]) || near(&[3, 2, 1, 0]) } else { near(&[0, 1, 2]) }
}
