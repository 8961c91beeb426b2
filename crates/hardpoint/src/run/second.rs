//! Second design derivatives over a motion: Hessians, Hessian-vector products, and the curvature of curves along a
//! change.

use std::collections::BTreeSet;

use super::{Analysis, PreparedDesign, Run, Solution, Walk};
use crate::design::BodyFixed;
use crate::measure::{Instant, Output, bodies_asked_for, outputs};
use crate::model::{BodyId, GROUND, VariableId};
use crate::motion::Stop;
use crate::motion::mechanism::Mechanism;
use crate::number::Dual;
use crate::sensitivity::{BodyCurvature, PairDirection, Seconds};
use crate::space::{Pose, Vec3};

/// Step of the differences, in natural steps of the variables: their error is its square and the round-off over it.
const DIFFERENCE: f64 = 1e-3;

/// Second derivatives of all bodies' positions and of the values of all outputs, for pairs of directions.
#[derive(Clone, Debug, Default)]
pub struct SecondDerivatives {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// Requested pairs of directions.
    pub pairs: Vec<[usize; 2]>,
    /// Columns: measures, then components of points.
    pub outputs: Vec<Output>,
    /// Number of bodies, ground included.
    pub bodies: usize,
    /// `values[(k * pairs + p) * outputs + m]`: second derivatives of the outputs.
    values: Vec<f64>,
    /// First derivatives along the second direction of each pair, in the same layout.
    firsts: Vec<f64>,
    curvatures: Vec<BodyCurvature>,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

impl SecondDerivatives {
    /// Second derivative of the value of output m at time k along the directions of pair p, in the output's unit per
    /// unit of both.
    pub fn value(&self, k: usize, p: usize, m: usize) -> f64 {
        self.values[(k * self.pairs.len() + p) * self.outputs.len() + m]
    }

    /// First derivative of the value of output m at time k along the second direction of pair p.
    pub fn first(&self, k: usize, p: usize, m: usize) -> f64 {
        self.firsts[(k * self.pairs.len() + p) * self.outputs.len() + m]
    }

    /// Second derivative of a body's position at time k along the directions of pair p.
    pub fn body(&self, k: usize, p: usize, body: BodyId) -> &BodyCurvature {
        &self.curvatures[(k * self.pairs.len() + p) * self.bodies + body.0]
    }
}

impl Analysis<'_> {
    /// Second derivatives at the design with variable k at `design[k]`, for pairs of directions, given by their
    /// indices.
    ///
    /// A direction contains the rate of every variable (missing entries are 0). Unit vectors and all their pairs give
    /// the Hessian. One further direction v, paired with every unit vector, gives the Hessian times v. One direction
    /// paired with itself gives the curvature along a change. Each pair costs one solution with the existing factors.
    ///
    /// Results for directions that the mechanism cannot follow are meaningless: check
    /// [`Sensitivities::admissibility`](crate::sensitivity::Sensitivities::admissibility) first.
    ///
    /// Second derivatives of an equilibrium are differences of its exact first derivatives, with six digits or more;
    /// those of bodies are not known.
    ///
    /// # Panics
    /// If a pair contains an index that is out of range.
    pub fn second(&self, design: &[f64], directions: &[Vec<f64>], pairs: &[[usize; 2]]) -> SecondDerivatives {
        let directions: Vec<Vec<f64>> = directions.iter().map(|d| self.model().whole(d)).collect();
        if self.openings().is_some() {
            return self.second_of_equilibrium(design, &directions, pairs);
        }
        let design = self.design(design);
        let model = self.model();
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let mut result = SecondDerivatives {
            pairs: pairs.to_vec(),
            outputs: outputs(model),
            bodies: model.bodies.len(),
            ..SecondDerivatives::default()
        };
        let mut bends = SecondDerivativeSolver::new(self, &design, &directions, pairs);
        let mut times = model.times.iter();
        result.stop = walk.each(|one| {
            if let Some(&t) = times.next() {
                bends.add(&mut one.mechanism, t, &mut result);
            }
        });
        result
    }

    /// Second derivatives of an equilibrium.
    fn second_of_equilibrium(
        &self,
        design: &[f64],
        directions: &[Vec<f64>],
        pairs: &[[usize; 2]],
    ) -> SecondDerivatives {
        let (model, values) = (self.model(), self.model().whole(design));
        let outputs = outputs(model);
        // Per output time and output, the first derivative along a direction in a run.
        let along = |run: &Solution, u: &[f64]| -> Vec<f64> {
            let of = |k: usize, m: usize| {
                let parts = u.iter().enumerate().filter(|(_, rate)| **rate != 0.0);
                parts.map(|(v, rate)| rate * run.measured.derivative(k, VariableId(v), m, 0)).sum()
            };
            (0..run.motion.len())
                .flat_map(|k| (0..outputs.len()).map(move |m| (k, m)))
                .map(|(k, m)| of(k, m))
                .collect()
        };
        let here = self.solve(Run::new().at(&values));
        // Where the nominal design has no equilibrium, others need not have one.
        let mut steps = if here.stop.is_some() { 0 } else { here.motion.len() };
        let mut found: Vec<[Vec<f64>; 2]> = vec![Default::default(); pairs.len()];
        let seconds: BTreeSet<usize> = pairs.iter().map(|[_, w]| *w).filter(|_| steps > 0).collect();
        for w in seconds {
            let natural = |(v, rate): (usize, &f64)| rate.abs() / model.natural_step(VariableId(v));
            let size = directions[w].iter().enumerate().map(natural).fold(0.0, f64::max);
            let step = if size > 0.0 { DIFFERENCE / size } else { 1.0 };
            let ends = [step, -step].map(|h| {
                let along_w = values.iter().zip(&directions[w]);
                let moved: Vec<f64> = along_w.map(|(x, rate)| x + h * rate).collect();
                self.solve(Run::new().at(&moved))
            });
            steps = ends.iter().fold(steps, |steps, run| steps.min(run.motion.len()));
            for (pair, found) in pairs.iter().zip(&mut found).filter(|([_, of], _)| *of == w) {
                let [ahead, behind] = ends.each_ref().map(|run| along(run, &directions[pair[0]]));
                let bend = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
                *found = [bend, along(&here, &directions[w])];
            }
        }
        let nan = Vec3::new(f64::NAN, f64::NAN, f64::NAN);
        let unknown = BodyCurvature { d2r: nan, ddpi: nan };
        let count = outputs.len();
        let numbers = |which: usize| -> Vec<f64> {
            let of = |k: usize| found.iter().flat_map(move |pair| &pair[which][k * count..][..count]);
            (0..steps).flat_map(of).copied().collect()
        };
        SecondDerivatives {
            times: here.motion.times[..steps].to_vec(),
            pairs: pairs.to_vec(),
            values: numbers(0),
            firsts: numbers(1),
            bodies: model.bodies.len(),
            curvatures: vec![unknown; steps * pairs.len() * model.bodies.len()],
            stop: here.stop,
            outputs,
        }
    }
}

/// Workspace of second derivatives, in addition to a mechanism.
struct SecondDerivativeSolver<'a> {
    analysis: &'a Analysis<'a>,
    seconds: Seconds,
    /// Body-fixed data of measures, per pair.
    fixed: Vec<BodyFixed<Dual<Dual>>>,
    asked_for: Vec<usize>,
    poses: Vec<Pose<Dual<Dual>>>,
}

impl<'a> SecondDerivativeSolver<'a> {
    fn new(
        analysis: &'a Analysis<'_>,
        design: &PreparedDesign,
        directions: &[Vec<f64>],
        pairs: &[[usize; 2]],
    ) -> Self {
        let (model, design_map) = (analysis.model(), analysis.design_map());
        let ways: Vec<PairDirection> = directions.iter().map(|d| PairDirection::Design(d.clone())).collect();
        let fixed = |&[u, w]: &[usize; 2]| {
            // b + eps_w w + eps_u u: at eps_w the derivative along w, at eps_u that along u, at both the second one
            let value = |k: usize| Dual {
                v: Dual { v: design.values[k], d: directions[w][k] },
                d: Dual::constant(directions[u][k]),
            };
            let values: Vec<_> = (0..model.variables.len()).map(value).collect();
            design_map.fixed(&values)
        };
        Self {
            analysis,
            seconds: Seconds::new(design_map, analysis.topology(), &design.values, (&ways, &[]), pairs),
            fixed: pairs.iter().map(fixed).collect(),
            asked_for: bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect(),
            poses: vec![Pose::IDENTITY.spread(); model.bodies.len()],
        }
    }

    /// Appends the second derivatives at time t.
    fn add(&mut self, mechanism: &mut Mechanism<'_>, t: f64, result: &mut SecondDerivatives) {
        self.seconds.solve(mechanism, t);
        let (model, state) = (self.analysis.model(), &mechanism.state);
        result.times.push(t);
        for p in 0..self.seconds.len() {
            for &b in &self.asked_for {
                self.poses[b] = self.seconds.pose(state, p, b);
            }
            let instant = Instant::new(model, &self.fixed[p], &self.poses);
            instant.all(|x| {
                result.values.push(x.d.d);
                result.firsts.push(x.v.d);
            });
            let body = |b: usize| self.seconds.curvature(state, p, b);
            result.curvatures.extend((0..result.bodies).map(body));
        }
    }
}
