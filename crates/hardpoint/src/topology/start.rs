//! Coordinates of the tree at which the assembly starts, if that is not the design configuration.

use crate::space::Quat;

/// Coordinates at which the assembly of every design starts, of another assembly of the nominal design.
#[derive(Clone, Debug, PartialEq)]
pub struct StartCoordinates {
    /// Per coordinate: value, rad or m; 0 for balls and for coordinates that a driver prescribes.
    pub(crate) q: Vec<f64>,
    /// Per coordinate that begins a ball: its rotation.
    pub(crate) balls: Vec<Quat<f64>>,
    /// Per curve: parameter of the contact, m.
    pub(crate) contacts: Vec<f64>,
    /// Per block: sign of the determinant there, of the nominal design; a changed design must have the same. Empty if
    /// the position is singular.
    pub(crate) signs: Vec<bool>,
}
