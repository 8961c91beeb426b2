//! Types of joints that give along and about some of their axes.
//!
//! The chain of such a joint is `S(x, y, z) Rx(alpha) Ry(beta) Rz(gamma)` from marker i to marker j, or of a cross
//! `S(x, y, z) Rz(gamma) Ry(beta) Rx(alpha)`, with the directions that give and those that are free; a rigid direction
//! has no freedom. Its force is a load on the same coordinates (`element/elastic_joint.rs`, `load/opening.rs`).

use std::sync::{Mutex, PoisonError};

use crate::constraint::Row;
use crate::order::sort_by_index;

use super::{CoordinateType, Freedom, JointType, Quantity};

/// A direction of a joint: along x, y, z, then about x, y, z of its marker i.
pub(crate) const DIRECTIONS: usize = 6;

/// Names of the directions of elastic joints and bushings in model files.
pub const DIRECTION_NAMES: [&str; DIRECTIONS] = ["x", "y", "z", "about_x", "about_y", "about_z"];

/// A joint type with elastic directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElasticType {
    /// The type; its coordinates are those of the rigid type, then one per elastic direction.
    pub kind: &'static JointType,
    /// True if its rows are those of its rigid directions, so that it may be cut. The rows of types such as universal
    /// joints do not belong to single directions.
    pub can_be_cut: bool,
}

/// Directions in which the bodies of a joint move freely.
pub(crate) fn free_directions(kind: &JointType) -> [bool; DIRECTIONS] {
    let mut free = [false; DIRECTIONS];
    for freedom in kind.freedoms.into_iter().flatten() {
        match freedom {
            Freedom::Slide(k) => free[*k] = true,
            Freedom::Turn(k) => free[3 + k] = true,
            Freedom::Ball => free[3..].fill(true),
        }
    }
    free
}

/// Free directions in which the joint moves only together with others: along and about the axis of a screw, about that
/// of a constant-velocity joint. A stiffness there is one of the lead, or of the shaft, not against the joint's motion.
pub(crate) fn tied_directions(kind: &JointType) -> [bool; DIRECTIONS] {
    let mut tied = [false; DIRECTIONS];
    tied[2] = kind.has_lead();
    tied[5] = kind.has_lead() || kind.tree_rows.contains(&Row::ConstantVelocity);
    tied
}

/// Directions in which the joint moves by itself, so that a stiffness there is a spring against its motion.
pub(crate) fn sprung_directions(kind: &JointType) -> [bool; DIRECTIONS] {
    let (free, tied) = (free_directions(kind), tied_directions(kind));
    std::array::from_fn(|k| free[k] && !tied[k])
}

/// Returns a joint type that gives in these directions, which are not free; `None` for a type without freedoms of its
/// own, such as a rod.
pub(crate) fn elastic(rigid: &'static JointType, directions: [bool; DIRECTIONS]) -> Option<ElasticType> {
    // Types are compared by their place, so each is made once; there are at most 64 per rigid type.
    static MADE: Mutex<Vec<(&'static str, [bool; DIRECTIONS], ElasticType)>> = Mutex::new(Vec::new());
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let known = made.iter().find(|(name, of, _)| *name == rigid.name && *of == directions);
    if let Some((.., known)) = known {
        return Some(*known);
    }
    let new = make(rigid, directions)?;
    made.push((rigid.name, directions, new));
    Some(new)
}

fn make(rigid: &'static JointType, directions: [bool; DIRECTIONS]) -> Option<ElasticType> {
    let own = rigid.freedoms?;
    let opened = (0..DIRECTIONS).filter(|d| directions[*d]).map(freedom_of);
    // With simple freedoms all slides come first, then all turns, so that they are the coordinates of the force.
    let is_simple = own.iter().all(|f| matches!(f, Freedom::Slide(_) | Freedom::Turn(2) | Freedom::Ball));
    let mut freedoms: Vec<Freedom> = opened.chain(own.iter().copied()).collect();
    // The third turn of a cross is between its pins, whose angles keep their meaning.
    if let [.., third, z @ Freedom::Turn(2), Freedom::Turn(0)] = &mut freedoms[..]
        && *third == Freedom::Turn(1)
    {
        std::mem::swap(third, z);
    }
    if is_simple {
        sort_by_index(&mut freedoms, |f| match f {
            Freedom::Slide(k) => *k,
            Freedom::Turn(k) => 3 + k,
            Freedom::Ball => DIRECTIONS,
        });
    }
    let place = |freedom: Freedom| freedoms.iter().rposition(|f| *f == freedom);
    // Where axes tilt, angles are those of the chain, with rows that hold for axes of any direction: after the tilts of
    // simple types, before that of a cross.
    let tilts = directions[3] || directions[4];
    let tilting = |row: Row| match row {
        Row::Angle if is_simple => Row::CardanAngle,
        Row::Angle => Row::Heading,
        Row::AngleOnJ => Row::HeadingOnJ,
        Row::Point(_)
        | Row::PointOnBase(_)
        | Row::Dot1(..)
        | Row::Dot2(_)
        | Row::Distance
        | Row::HeadingOnJ
        | Row::CardanAngle
        | Row::Heading
        | Row::Course
        | Row::Cosine
        | Row::Offset
        | Row::Contact
        | Row::ConstantVelocity
        | Row::LowestPoint(_) => row,
    };
    let coordinates = rigid.coordinates.iter().map(|c| CoordinateType {
        name: c.name,
        quantity: c.quantity,
        freedom: c.freedom.and_then(|k| place(own[k])),
        row: if tilts { tilting(c.row) } else { c.row },
    });
    let openings = (0..DIRECTIONS).filter(|d| directions[*d]).map(|d| CoordinateType {
        name: DIRECTION_NAMES[d],
        quantity: if d < 3 { Quantity::Length } else { Quantity::Angle },
        freedom: freedoms.iter().position(|f| *f == freedom_of(d)),
        // Only tree joints are driven in these directions.
        row: if d < 3 { Row::Dot2(d) } else { Row::CardanAngle },
    });
    let coordinates = coordinates.chain(openings).collect::<Vec<_>>().leak();
    let free = free_directions(rigid);
    let mut rows =
        (0..DIRECTIONS).filter(|d| !directions[*d] && !free[*d]).map(rigid_row).collect::<Vec<_>>();
    let can_be_cut = rows.is_empty() || is_simple;
    // Constraints between free directions, such as that of a constant-velocity joint.
    rows.extend(rigid.tree_rows);
    let kind = JointType {
        coordinates,
        freedoms: Some(freedoms.leak()),
        rows: if can_be_cut { rows.leak() } else { rigid.rows },
        relaxations: &[],
        ..*rigid
    };
    Some(ElasticType { kind: Box::leak(Box::new(kind)), can_be_cut })
}

/// Returns the type with three turns in the place of the rotation of a ball, about x, y and z of its marker i, each a
/// coordinate of its own after those of the type; the type itself if it has no ball.
pub(crate) fn with_turns(kind: &'static JointType) -> &'static JointType {
    static MADE: Mutex<Vec<(&'static JointType, &'static JointType)>> = Mutex::new(Vec::new());
    let own = kind.freedoms.unwrap_or_default();
    let Some(ball) = own.iter().position(|f| *f == Freedom::Ball) else { return kind };
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, known)) = made.iter().find(|(of, _)| std::ptr::eq(*of, kind)) {
        return known;
    }
    let turns = [3, 4, 5].map(freedom_of);
    let freedoms = [&own[..ball], &turns, &own[ball + 1..]].concat().leak();
    let moved = |k: usize| if k > ball { k + 2 } else { k };
    let coordinates =
        kind.coordinates.iter().map(|c| CoordinateType { freedom: c.freedom.map(moved), ..*c }).chain(
            (0..3).map(|k| CoordinateType {
                name: DIRECTION_NAMES[3 + k],
                quantity: Quantity::Angle,
                freedom: Some(ball + k),
                // Only tree joints are driven in these directions.
                row: Row::Angle,
            }),
        );
    let new: &JointType = Box::leak(Box::new(JointType {
        coordinates: coordinates.collect::<Vec<_>>().leak(),
        freedoms: Some(freedoms),
        ..*kind
    }));
    made.push((kind, new));
    new
}

/// Freedom of a direction.
const fn freedom_of(direction: usize) -> Freedom {
    if direction < 3 { Freedom::Slide(direction) } else { Freedom::Turn(direction - 3) }
}

/// Constraint of a rigid direction: its coordinate is zero whatever the others are.
const fn rigid_row(direction: usize) -> Row {
    match direction {
        // alpha = atan2(-y_i . z_j, z_i . z_j), beta = asin(x_i . z_j), gamma = atan2(-x_i . y_j, x_i . x_j)
        3 => Row::Dot1(1, 2),
        4 => Row::Dot1(0, 2),
        5 => Row::Dot1(0, 1),
        along => Row::Dot2(along),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ALL, CYLINDRICAL, DISTANCE, FIXED, REVOLUTE, SPHERICAL, TRANSLATIONAL};
    use super::*;

    #[test]
    fn freedoms_and_rows_of_elastic_types_add_up_to_six() {
        for rigid in ALL {
            let free = free_directions(rigid);
            for mask in 0..1 << DIRECTIONS {
                let directions: [bool; DIRECTIONS] = std::array::from_fn(|d| mask >> d & 1 == 1 && !free[d]);
                let Some(ElasticType { kind, can_be_cut }) = elastic(rigid, directions) else {
                    assert!(rigid.freedoms.is_none(), "{}", rigid.name);
                    continue;
                };
                let freedoms = kind.freedom_count().unwrap();
                let opened = directions.iter().filter(|d| **d).count();
                assert_eq!(freedoms, rigid.freedom_count().unwrap() + opened, "{}", rigid.name);
                if can_be_cut {
                    let rows = kind.rows.len() - rigid.tree_rows.len();
                    assert_eq!(freedoms + rows, 6, "{} {directions:?}", rigid.name);
                }
                for c in kind.coordinates {
                    assert!(c.freedom.is_none_or(|f| f < freedoms), "{}", rigid.name);
                }
            }
        }
    }

    #[test]
    fn a_ball_with_turns_has_the_same_freedoms() {
        for kind in ALL {
            let turning = with_turns(kind);
            let has_ball = kind.freedoms.is_some_and(|f| f.contains(&Freedom::Ball));
            assert_eq!(std::ptr::eq(turning, *kind), !has_ball, "{}", kind.name);
            assert_eq!(turning.freedom_count(), kind.freedom_count());
            assert!(std::ptr::eq(turning, with_turns(kind)));
            if has_ball {
                let driven = turning.coordinates.iter().filter_map(|c| c.freedom).count();
                assert_eq!(driven, kind.coordinates.iter().filter_map(|c| c.freedom).count() + 3);
            }
        }
    }

    #[test]
    fn a_type_is_made_once() {
        for rigid in [&REVOLUTE, &FIXED, &SPHERICAL, &TRANSLATIONAL, &CYLINDRICAL] {
            let free = free_directions(rigid);
            let all = free.map(|free| !free);
            let [a, b] = [(); 2].map(|()| elastic(rigid, all).unwrap().kind);
            assert!(std::ptr::eq(a, b) && a.rows.is_empty());
        }
        assert!(elastic(&DISTANCE, [true; DIRECTIONS]).is_none());
    }
}
