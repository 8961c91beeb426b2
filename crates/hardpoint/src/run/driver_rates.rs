//! Rates of all outputs by each driver alone, while the others are at rest.

use std::ops::ControlFlow;

use super::sink::NullSink;
use super::walk::{PerPlan, Plan, SolvedSteps};
use super::{Analysis, Walk};
use crate::measure::{Instant, Output, bodies_asked_for, outputs};
use crate::model::{DriverId, GROUND};
use crate::motion::Stop;
use crate::number::Dual;
use crate::sensitivity::{PairDirection, Seconds};
use crate::space::Pose;

/// Derivatives of all output values with respect to the coordinate that each driver prescribes, the other drivers
/// fixed.
#[derive(Clone, Debug, Default)]
pub struct DriverRates {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// Requested drivers.
    pub drivers: Vec<DriverId>,
    /// Columns: measures, then components of points.
    pub outputs: Vec<Output>,
    /// `values[(k * drivers + d) * outputs + m]`.
    values: Vec<f64>,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

impl DriverRates {
    /// Rate of output m at time k with respect to requested driver d, in the output's unit per m or rad; `None` for
    /// outputs that do not depend on positions alone.
    pub fn value(&self, k: usize, d: usize, m: usize) -> Option<f64> {
        let value = self.values[(k * self.drivers.len() + d) * self.outputs.len() + m];
        Some(value).filter(|_| self.outputs[m].known.by_position)
    }
}

impl Analysis<'_> {
    /// Derivatives with respect to single drivers along the motion of the nominal design (`docs/theory.md`, section 7).
    pub fn driver_rates(&self, drivers: &[DriverId]) -> DriverRates {
        let model = self.model();
        let design = self.design(&[]);
        let ways: Vec<PairDirection> = drivers.iter().map(|d| PairDirection::Driver(*d)).collect();
        let mut workspaces = PerPlan::new(self, &design, |Plan { analysis, design, .. }: Plan<'_>| {
            let openings = analysis.openings().map_or(&[][..], |(openings, _)| openings);
            let (map, topology) = (analysis.design_map(), analysis.topology());
            Seconds::new(map, topology, &design.values, (&ways, openings), &[])
        });
        let values: Vec<_> = design.values.iter().map(|v| Dual::constant(Dual::constant(*v))).collect();
        let fixed = self.design_map().fixed(&values);
        let bodies: Vec<usize> = bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect();
        let mut poses = vec![Pose::IDENTITY.spread(); model.bodies.len()];
        let mut found =
            DriverRates { drivers: drivers.to_vec(), outputs: outputs(model), ..DriverRates::default() };
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let mut times = model.times.iter();
        let go_on = &mut |_| ControlFlow::Continue(());
        found.stop = walk.all(&mut NullSink, go_on, |_, solved, _, _| {
            let (Some(&t), SolvedSteps::One(plan, one, _, equilibrium)) = (times.next(), solved) else {
                return;
            };
            let seconds = workspaces.on(plan);
            if let Some(equilibrium) = equilibrium {
                for (driver, rates) in equilibrium.driver_rates(one, t) {
                    if let Some(k) = drivers.iter().position(|d| *d == driver) {
                        seconds.set_openings(k, &rates);
                    }
                }
            }
            seconds.solve(&mut one.mechanism, t);
            found.times.push(t);
            for d in 0..drivers.len() {
                for &b in &bodies {
                    poses[b] = seconds.pose_along(&one.mechanism.state, d, b);
                }
                Instant::new(model, &fixed, &poses).all(|x| found.values.push(x.d.v));
            }
        });
        found
    }
}
