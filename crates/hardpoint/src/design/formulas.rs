//! Dependencies of formulas on variables and on each other.

use crate::model::{Change, Model, Source, Target, VariableId};

/// Dependencies of formulas on variables and on each other.
#[derive(Clone, Debug)]
pub(super) struct Formulas {
    /// Per parameter: variables that change it, and its rate by each.
    ///
    /// `p = p_o + sum_k rate_k b_k`.
    pub rates: Vec<Vec<(usize, f64)>>,
    /// Index of the formula that defines each parameter, each coordinate of a hardpoint, and each length of a joint.
    pub of_parameter: Vec<Option<usize>>,
    pub of_hardpoint: Vec<[Option<usize>; 3]>,
    pub of_length: Vec<Option<usize>>,
    /// Index of the formula that defines each number of masses and forces.
    pub of_number: Vec<Option<usize>>,
    /// Formulas that use each parameter, and each hardpoint.
    using_parameter: Vec<Vec<usize>>,
    using_hardpoint: Vec<Vec<usize>>,
    /// Formulas that use the constants of each joint; they are also in [`Self::using_hardpoint`] of its hardpoints.
    using_joint: Vec<Vec<usize>>,
    /// Per variable: true if a formula depends on it.
    pub is_used: Vec<bool>,
}

impl Formulas {
    pub fn of(model: &Model) -> Option<Self> {
        if model.formulas.is_empty() {
            return None;
        }
        let (parameters, hardpoints) = (model.parameters.len(), model.hardpoints.len());
        let mut f = Self {
            rates: vec![Vec::new(); parameters],
            of_parameter: vec![None; parameters],
            of_hardpoint: vec![[None; 3]; hardpoints],
            of_length: vec![None; model.joints.len()],
            of_number: vec![None; model.numbers.len()],
            using_parameter: vec![Vec::new(); parameters],
            using_hardpoint: vec![Vec::new(); hardpoints],
            using_joint: vec![Vec::new(); model.joints.len()],
            is_used: Vec::new(),
        };
        // Both directions of the graph: the formula that defines a number, and the formulas that use it. The formulas
        // of a model are ordered so that each comes after those that it uses.
        for (k, formula) in model.formulas.iter().enumerate() {
            match formula.of {
                Target::Parameter(p) => f.of_parameter[p.0] = Some(k),
                Target::Coordinate(h, axis) => f.of_hardpoint[h.0][axis] = Some(k),
                Target::Length(j) => f.of_length[j.0] = Some(k),
                Target::Number(n) => f.of_number[n.0] = Some(k),
                Target::Law(..) => {}
            }
            for source in formula.sources() {
                match source {
                    Source::Parameter(p) => f.using_parameter[p.0].push(k),
                    Source::Coordinate(h, _) => f.using_hardpoint[h.0].push(k),
                    Source::Kept(j, _) => {
                        f.using_joint[j.0].push(k);
                        model.joints[j.0].hardpoints().for_each(|h| f.using_hardpoint[h.0].push(k));
                    }
                }
            }
        }
        for (k, variable) in model.variables.iter().enumerate() {
            for change in &variable.changes {
                if let Some((parameter, rate)) = change.parameter() {
                    f.rates[parameter.0].push((k, rate));
                }
            }
            // If no formula depends on the variable, all results remain nominal and are not evaluated.
            let is_used = variable.changes.iter().any(|change| f.using(change).next().is_some());
            f.is_used.push(is_used);
        }
        Some(f)
    }

    /// Returns the formulas that use the quantities of a change.
    fn using(&self, change: &Change) -> impl Iterator<Item = usize> {
        let parameter = change.parameter().map(|(p, _)| &self.using_parameter[p.0]);
        let hardpoint = change.hardpoint().map(|(h, _)| &self.using_hardpoint[h.0]);
        let joint = change.joint().map(|j| &self.using_joint[j.0]);
        parameter.into_iter().chain(hardpoint).chain(joint).flatten().copied()
    }

    /// Returns the formulas that depend on a variable, directly or through others, in order.
    pub fn following(&self, model: &Model, variable: VariableId) -> Vec<usize> {
        let mut seen = vec![false; model.formulas.len()];
        let changes = &model.variables[variable.0].changes;
        let mut waiting: Vec<usize> = changes.iter().flat_map(|c| self.using(c)).collect();
        // Everything reachable along "is used by" from the parameters and coordinates that the variable itself changes.
        while let Some(k) = waiting.pop() {
            if !std::mem::replace(&mut seen[k], true) {
                match model.formulas[k].of {
                    Target::Parameter(p) => waiting.extend(&self.using_parameter[p.0]),
                    Target::Coordinate(h, _) => waiting.extend(&self.using_hardpoint[h.0]),
                    Target::Length(j) => waiting.extend(&self.using_joint[j.0]),
                    Target::Law(..) | Target::Number(_) => {}
                }
            }
        }
        (0..seen.len()).filter(|k| seen[*k]).collect()
    }
}
