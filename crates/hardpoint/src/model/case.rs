//! Cases: several motions of one mechanism.

use crate::law::Law;

use super::{CaseId, Change, DriverId, ElementId, Formula, LimitTarget, Model, Target};

/// A motion of the mechanism under laws and at times of its own: a car in bump with the rack held, or steered at one
/// ride height.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name.
    pub name: String,
    /// Per driver, the law that it follows in this case; where there is none, that of the driver itself.
    pub laws: Vec<Option<Law>>,
    /// Laws of forces in this case, in the order of the elements; all others keep their own.
    pub force_laws: Vec<(ElementId, Law)>,
    /// Formulas that express numbers of these laws by the design variables.
    pub formulas: Vec<Formula>,
    /// Output times, s, increasing.
    pub times: Vec<f64>,
    /// Loads with or without inertia; those of the model where there is none.
    pub load_mode: Option<LoadMode>,
}

/// Loads of a motion with or without inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadMode {
    /// Newton and Euler: forces that accelerate the masses along the motion are part of all loads.
    #[default]
    Dynamic,
    /// Quasi-static: at each output time the mechanism is in equilibrium at rest there, under weight, springs and given
    /// forces. Forces by speed, of dampers and friction, are those of the motion.
    Static,
}

/// A case of two drivers over a grid, every position of one with every position of the other: toe over wheel travel and
/// steer. All other drivers are fixed in the design configuration.
///
/// It is no motion but positions, and none of the [motions](Model::motions) of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Name.
    pub name: String,
    /// The two drivers.
    pub drivers: [DriverId; 2],
    /// Positions of each driver, m or rad, increasing; measured like the values of its law.
    pub values: [Vec<f64>; 2],
}

impl Model {
    /// The case of that name.
    pub fn case(&self, name: &str) -> Option<CaseId> {
        self.cases.iter().position(|c| c.name == name).map(CaseId)
    }

    /// The mechanism in one of its cases: a model with that motion and no other, and with the metrics that are taken of
    /// it.
    ///
    /// All but [`metrics`](Self::metrics) and what follows the laws keep their places. A design variable that changes
    /// the law that a driver has of its own changes nothing in a case that gives it another.
    ///
    /// # Panics
    /// If there is no such case.
    pub fn in_case(&self, case: CaseId) -> Self {
        let Case { name, laws, force_laws, formulas, times, load_mode } = &self.cases[case.0];
        let mut model = Self {
            times: times.clone(),
            load_mode: load_mode.unwrap_or(self.load_mode),
            cases: Vec::new(),
            optimization: None,
            tolerancing: None,
            sweeping: None,
            calibrating: None,
            ..self.clone()
        };
        model.name = format!("{}, {name}", self.name);
        for (driver, law) in model.drivers.iter_mut().zip(laws) {
            if let Some(law) = law {
                driver.law = law.clone();
            }
        }
        for (force, law) in force_laws {
            if let Some(of) = model.elements[force.0].kind.law_mut() {
                *of = Some(law.clone());
            }
        }
        model.formulas.retain(|f| !matches!(f.of, Target::Law(d, _) if laws[d.0].is_some()));
        model.formulas.extend_from_slice(formulas);
        let is_replaced = |change: &Change| change.law().is_some_and(|(driver, ..)| laws[driver.0].is_some());
        model.variables.iter_mut().for_each(|v| v.changes.retain(|change| !is_replaced(change)));
        model.metrics.retain(|m| m.case.is_none_or(|of| of == case));
        model.metrics.iter_mut().for_each(|m| m.case = None);
        model
    }

    /// Position of a driver in the design configuration, m or rad: zero, or the whole value of the driven quantity if
    /// the driver's laws count from zero.
    pub fn as_drawn(&self, driver: DriverId) -> f64 {
        self.drivers[driver.0].law.as_drawn().map_or(0.0, |(_, value)| value)
    }

    /// The mechanism with a single case. Of its metrics, goals and limits it has those of this case or of all cases.
    ///
    /// # Panics
    /// Panics if there is no such case.
    #[must_use]
    pub fn with_case_only(&self, case: CaseId) -> Self {
        let cases = vec![self.cases[case.0].clone()];
        let none = Self { tolerancing: None, sweeping: None, calibrating: None, ..self.clone() };
        let mut model = Self { cases, grids: Vec::new(), ..none };
        model.metrics.retain(|m| m.case.is_none_or(|of| of == case));
        model.metrics.iter_mut().for_each(|m| m.case = m.case.map(|_| CaseId(0)));
        let stays = |metric: &usize| self.metrics[*metric].case.is_none_or(|of| of == case);
        let place = |metric: usize| (0..metric).filter(|m| stays(m)).count();
        if let Some(asked) = &mut model.optimization {
            asked.goals.retain(|goal| stays(&goal.metric));
            asked.goals.iter_mut().for_each(|goal| goal.metric = place(goal.metric));
            asked.limits.retain(|limit| !matches!(&limit.of, LimitTarget::Metric(metric) if !stays(metric)));
            for limit in &mut asked.limits {
                if let LimitTarget::Metric(metric) = &mut limit.of {
                    *metric = place(*metric);
                }
            }
        }
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
