//! Planning of the solution of a model.

use crate::model::Model;

use super::{Formulation, Topology, TopologyError, blocks, mobility, size, tree};

impl Topology {
    /// Plans the solution of a model.
    ///
    /// # Errors
    /// A [`TopologyError`] if motions remain free, if drivers are too many, or if the design configuration is singular.
    pub fn of(model: &Model, formulation: Formulation) -> Result<Self, TopologyError> {
        let mut topology = tree::choose_tree(model, formulation, &[], &[]);
        size::measure(model, &mut topology);
        blocks::split(model, &mut topology)?;
        mobility::examine(model, &mut topology)?;
        Ok(topology)
    }
}
