//! Angles that elements act on, counted through whole turns.

use crate::model::{ElementId, Model};
use crate::topology::{CoordinateId, Topology};

/// What counts the turns of the coordinate that an element acts on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turns {
    /// It acts on none.
    None,
    /// The coordinate of the tree, which is the angle itself.
    Coordinate(CoordinateId),
    /// The path: when it was seen last, and its rate then.
    Path(Option<[f64; 2]>),
}

impl Turns {
    pub fn of(model: &Model, topology: &Topology, e: ElementId) -> Self {
        let Some((joint, coordinate)) = model.elements[e.0].kind.coordinate(model) else { return Self::None };
        let link = topology.links.iter().find(|link| link.joint == Some(joint));
        match link.zip(model.joints[joint.0].kind.coordinates[coordinate].freedom) {
            Some((link, freedom)) => {
                let step = if link.parent_end == 0 { freedom } else { link.steps.len() - 1 - freedom };
                Self::Coordinate(link.steps[step].first)
            }
            None => Self::Path(None),
        }
    }
}
