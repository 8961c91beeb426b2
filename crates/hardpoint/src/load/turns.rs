//! Whole turns of the angles that forces of elements depend on.

use crate::measure::ElementCoordinate;
use crate::model::{ElementId, Model};
use crate::motion::kinematics::State;
use crate::topology::{CoordinateId, Topology};

/// Source of the number of turns of an element's coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turns {
    /// The force does not depend on a coordinate.
    None,
    /// A length of a cut joint, which has no turns.
    Length,
    /// A generalised coordinate, which is the angle itself.
    Coordinate(CoordinateId),
    /// An angle that is counted along the path, at this index.
    Path(usize),
}

impl Turns {
    /// Returns the sources of all elements.
    pub fn of_all(model: &Model, topology: &Topology) -> Vec<Self> {
        let mut turns: Vec<Self> =
            (0..model.elements.len()).map(|e| Self::of(model, topology, ElementId(e))).collect();
        // Angles of elements are counted before all others, one after the other.
        let on_path = turns.iter_mut().filter_map(|turns| match turns {
            Self::Path(place) => Some(place),
            Self::None | Self::Length | Self::Coordinate(_) => None,
        });
        on_path.enumerate().for_each(|(k, place)| *place = k);
        turns
    }

    /// Returns the source of one element; the index of an angle on the path is not set.
    pub fn of(model: &Model, topology: &Topology, e: ElementId) -> Self {
        let Some(coordinate) = ElementCoordinate::of(model, e) else { return Self::None };
        match coordinate.in_tree(topology) {
            Some(c) => Self::Coordinate(c),
            None if coordinate.is_counted(topology) => Self::Path(0),
            None => Self::Length,
        }
    }

    /// Sets the coordinates that elements act on, with whole turns, from a position; `counted` are the angles of its
    /// path.
    pub fn write(all: &[Self], state: &State<f64>, counted: Option<&[f64]>, near: &mut [f64]) {
        for (near, turns) in near.iter_mut().zip(all) {
            match *turns {
                Self::None | Self::Length => {}
                Self::Coordinate(c) => *near = state.q[c.0],
                Self::Path(place) => *near = counted.map_or(f64::NAN, |counted| counted[place]),
            }
        }
    }
}
