//! Couplers as written.

use crate::model::Transmission;

/// A coupler.
#[derive(Clone, Debug)]
pub struct CouplerDraft {
    /// Name.
    pub name: String,
    /// Relation of the coupler.
    pub kind: CouplerKindDraft,
    /// Constant value of the sum of the terms; zero for gears, racks and belts.
    pub constant: f64,
}

/// Relation of a coupler. Angles and displacements are those of body j relative to body i, positive along the axes of
/// their joints.
#[derive(Clone, Debug)]
pub enum CouplerKindDraft {
    /// `sum of coefficient x coordinate = constant`.
    Linear(Vec<TermDraft>),
    /// Two joints, each with the coordinate that the transmission couples.
    Pair {
        /// Transmission between the two coordinates.
        by: Transmission,
        /// The joints' names.
        joints: [String; 2],
    },
}

/// Joint coordinate times a coefficient.
#[derive(Clone, Debug)]
pub struct TermDraft {
    /// The joint's name.
    pub joint: String,
    /// Name of the coordinate; optional if the joint has only one.
    pub coordinate: Option<String>,
    /// Coefficient, per m or per rad of the coordinate.
    pub coefficient: f64,
}
