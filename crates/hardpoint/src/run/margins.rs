//! Margins of a motion to singular positions, with their derivatives by the design.

use std::ops::ControlFlow;

use super::request::Scope;
use super::sink::NullSink;
use super::walk::{PerPlan, Plan, SolvedSteps};
use super::{Analysis, Walk};
use crate::model::VariableId;
use crate::motion::margin::Margins;
use crate::motion::state_along::StateAlong;
use crate::motion::{Margin, Stop};
use crate::number::Dual;
use crate::sensitivity::{DirectDifferentiation, PlanVelocity};

/// Margins at the output times of a motion, with derivatives.
#[derive(Clone, Debug, Default)]
pub struct MarginDerivatives {
    /// Per output time: margin.
    pub margins: Vec<Margin>,
    /// Per output time: derivatives by the requested variables, per unit of each; empty where they are not requested.
    pub d: Vec<Vec<f64>>,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

/// Direction along one variable.
struct Direction {
    field: PlanVelocity<f64>,
    /// Workspace of this variable alone: coordinates that it does not reach keep a rate of zero.
    direct: DirectDifferentiation<f64>,
    along: StateAlong,
    margins: Margins<Dual>,
}

impl Analysis<'_> {
    /// Margins at the design with variable k at `design[k]`, with derivatives by these variables where they are below a
    /// value.
    ///
    /// The derivative is that of the block of equations with the minimum margin: one-sided where two margins are equal.
    /// It is 0 for large blocks, whose margin is a ratio of pivots.
    pub fn margin_derivatives(
        &self,
        design: &[f64],
        variables: &[VariableId],
        below: f64,
    ) -> MarginDerivatives {
        let design = self.prepare(design, Scope::of_one(true, false));
        let model = self.model();
        // Sensitivities are solved where derivatives are requested only.
        let (all_fields, mut only_position) = (design.fields.clone(), design);
        if self.openings().is_none() {
            only_position.fields.clear();
        }
        let mut workspaces = PerPlan::new(self, &only_position, |Plan { analysis, design, .. }: Plan<'_>| {
            let (model, topology) = (analysis.solved_model(), analysis.topology());
            let openings = analysis.openings().map_or(&[][..], |(openings, _)| openings);
            let direction = |v: &VariableId| {
                let field = all_fields[v.0].clone().with_openings(openings);
                let mut values: Vec<Dual> = design.values.iter().map(|b| Dual::constant(*b)).collect();
                values[v.0] = Dual::variable(design.values[v.0]);
                let geometry = analysis.design_map().geometry(&values);
                Direction {
                    field: PlanVelocity::new(topology, &field),
                    direct: DirectDifferentiation::new(model, topology),
                    along: StateAlong::new(model, topology, &geometry),
                    margins: Margins::new(model, topology, &geometry),
                }
            };
            let directions: Vec<Direction> = variables.iter().map(direction).collect();
            (directions, Margins::new(model, topology, &design.geometry))
        });
        let mut found = MarginDerivatives::default();
        let mut walk = Walk::new(self, &only_position, vec![false; model.bodies.len()]);
        let times = &self.model().times;
        found.stop = walk.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            let SolvedSteps::One(plan, one, _, equilibrium) = solved else { return };
            let model = plan.analysis.solved_model();
            let (directions, values) = workspaces.on(plan);
            let t = times[found.margins.len()];
            let margin = values.at(&one.mechanism.topology, &one.mechanism.state);
            found.margins.push(margin);
            if !(margin.value < below) {
                found.d.push(Vec::new());
                return;
            }
            let mut rates_of_openings = Vec::new();
            if let Some(equilibrium) = equilibrium {
                equilibrium.differentiate(one, t, |_, rates| rates_of_openings.push(rates.to_vec()));
            }
            let derivative =
                |(v, Direction { field, direct, along, margins }): (&VariableId, &mut Direction)| {
                    let mechanism = &mut one.mechanism;
                    if let Some(rates) = rates_of_openings.get(v.0) {
                        field.set_last_shifts(rates);
                    }
                    field.set_time(|d| mechanism.parts.law_of(d.0), t);
                    direct.solve_position(&mechanism.topology, &mut mechanism.state, field);
                    along.set(model, mechanism, &direct.flow.speeds[0]);
                    margins.derivative(&mechanism.topology, &along.state, margin.block).unwrap_or(0.0)
                };
            found.d.push(variables.iter().zip(directions).map(derivative).collect());
        });
        found
    }
}
