//! Angles that elements act on, counted through whole turns.

use crate::measure::is_counted_of_element;
use crate::model::{ElementId, Model};
use crate::topology::{CoordinateId, Topology};

/// Source of the number of turns of an element's coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turns {
    /// It acts on none.
    None,
    /// A length of a joint that the tree does not carry, which has no turns.
    Length,
    /// The coordinate of the tree, which is the angle itself.
    Coordinate(CoordinateId),
    /// The path, where the angle is counted in this place.
    Path(usize),
}

impl Turns {
    /// Returns those of all elements.
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

    /// Returns those of one element; the place of an angle on the path is not known.
    pub fn of(model: &Model, topology: &Topology, e: ElementId) -> Self {
        let Some((joint, coordinate)) = model.elements[e.0].kind.coordinate(model) else { return Self::None };
        let link = topology.links.iter().find(|link| link.joint == Some(joint));
        match link.zip(model.joints[joint.0].kind.coordinates[coordinate].freedom) {
            Some((link, freedom)) => Self::Coordinate(link.coordinate_of(freedom)),
            None if is_counted_of_element(model, topology, e) => Self::Path(0),
            None => Self::Length,
        }
    }
}
