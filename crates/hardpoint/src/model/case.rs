//! Cases: several motions of one mechanism.

use crate::law::Law;

use super::{CaseId, Change, DriverId, Formula, Model, Target};

/// A motion of the mechanism under laws and at times of its own: a car in bump with the rack held, or steered at one ride height.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// Per driver, the law that it follows in this case; where there is none, that of the driver itself.
    pub laws: Vec<Option<Law>>,
    /// What of these laws follows the design variables.
    pub formulas: Vec<Formula>,
    /// Output times, s, increasing.
    pub times: Vec<f64>,
}

/// A case of two drivers, each of which stands wherever the other does: toe over wheel travel and steer. All other drivers are held as
/// drawn.
///
/// It is no motion but positions, and none of the [motions](Model::motions) of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Its name.
    pub name: String,
    /// The two drivers.
    pub drivers: [DriverId; 2],
    /// Where each of them stands, counted from the drawing, m or rad, increasing.
    pub values: [Vec<f64>; 2],
}

impl Model {
    /// The case of that name.
    pub fn case(&self, name: &str) -> Option<CaseId> {
        self.cases.iter().position(|c| c.name == name).map(CaseId)
    }

    /// The mechanism in one of its cases: a model with that motion and no other, and with the metrics that are taken of it.
    ///
    /// All but [`metrics`](Self::metrics) and what follows the laws keep their places. A design variable that changes the law that a
    /// driver has of its own changes nothing in a case that gives it another.
    ///
    /// # Panics
    /// If there is no such case.
    pub fn in_case(&self, case: CaseId) -> Self {
        let Case { name, laws, formulas, times } = &self.cases[case.0];
        let mut model = Self { times: times.clone(), cases: Vec::new(), optimization: None, ..self.clone() };
        model.name = format!("{}, {name}", self.name);
        for (driver, law) in model.drivers.iter_mut().zip(laws) {
            if let Some(law) = law {
                driver.law = law.clone();
            }
        }
        model.formulas.retain(|f| !matches!(f.of, Target::Law(d, _) if laws[d.0].is_some()));
        model.formulas.extend_from_slice(formulas);
        let is_replaced =
            |change: &Change| matches!(change, Change::Law(law) if laws[law.driver.0].is_some());
        model.variables.iter_mut().for_each(|v| v.changes.retain(|change| !is_replaced(change)));
        model.metrics.retain(|m| m.case.is_none_or(|of| of == case));
        model.metrics.iter_mut().for_each(|m| m.case = None);
        model
    }

    /// The motions of the mechanism: one model for each case, or this one alone where there is none.
    pub fn motions(&self) -> Vec<Self> {
        match self.cases.len() {
            0 => vec![self.clone()],
            n => (0..n).map(|k| self.in_case(CaseId(k))).collect(),
        }
    }
}
