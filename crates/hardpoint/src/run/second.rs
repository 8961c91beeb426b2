//! Second design derivatives over a motion: Hessians, Hessian-vector products, and the curvature of curves along a
//! change.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use super::request::Scope;
use super::sink::NullSink;
use super::walk::{PerPlan, Plan, SolvedSteps};
use super::{Analysis, PreparedDesign, Walk};
use crate::design::BodyFixed;
use crate::equilibrium::{Along, Curvatures};
use crate::measure::{Instant, Output, bodies_asked_for, outputs};
use crate::model::{BodyId, GROUND};
use crate::motion::Stop;
use crate::motion::mechanism::Mechanism;
use crate::number::Dual;
use crate::sensitivity::{BodyCurvature, PairDirection, Seconds};
use crate::space::Pose;

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
    /// unit of both; NaN for loads and for measures of single drivers and forces, whose second derivatives are not
    /// computed.
    pub fn value(&self, k: usize, p: usize, m: usize) -> f64 {
        self.values[(k * self.pairs.len() + p) * self.outputs.len() + m]
    }

    /// First derivative of the value of output m at time k along the second direction of pair p; NaN for the same
    /// outputs.
    pub fn first(&self, k: usize, p: usize, m: usize) -> f64 {
        self.firsts[(k * self.pairs.len() + p) * self.outputs.len() + m]
    }

    /// Second derivative of a body's position at time k along the directions of pair p.
    pub fn body(&self, k: usize, p: usize, body: BodyId) -> &BodyCurvature {
        &self.curvatures[(k * self.pairs.len() + p) * self.bodies + body.0]
    }
}

impl SecondDerivatives {
    /// Appends the derivatives of output m.
    fn push(&mut self, m: usize, second: f64, first: f64) {
        let is_known = self.outputs[m].known.by_position;
        self.values.push(if is_known { second } else { f64::NAN });
        self.firsts.push(if is_known { first } else { f64::NAN });
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
    /// # Panics
    /// If a pair contains an index that is out of range.
    pub fn second(&self, design: &[f64], directions: &[Vec<f64>], pairs: &[[usize; 2]]) -> SecondDerivatives {
        let directions: Vec<Vec<f64>> = directions.iter().map(|d| self.model().whole(d)).collect();
        let model = self.model();
        let mut result = SecondDerivatives {
            pairs: pairs.to_vec(),
            outputs: outputs(model),
            bodies: model.bodies.len(),
            ..SecondDerivatives::default()
        };
        if self.openings().is_some() {
            return self.second_at_equilibrium(design, &directions, result);
        }
        let design = self.design(design);
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let mut bends = SecondDerivativeSolver::new(self, &design, &directions, pairs);
        let mut times = model.times.iter();
        result.stop = walk.each(|one| {
            if let Some(&t) = times.next() {
                bends.add(&mut one.mechanism, t, &mut result);
            }
        });
        result
    }

    /// Second derivatives at equilibria: by every variable and along the second direction of each pair.
    fn second_at_equilibrium(
        &self,
        design: &[f64],
        directions: &[Vec<f64>],
        mut result: SecondDerivatives,
    ) -> SecondDerivatives {
        let design = self.prepare(design, Scope::of_one(true, false));
        let model = self.model();
        let pairs = result.pairs.clone();
        let seconds: BTreeSet<usize> = pairs.iter().map(|[_, w]| *w).collect();
        let mut workspaces = PerPlan::new(self, &design, |Plan { analysis, design, .. }: Plan<'_>| {
            let Some(openings) = analysis.openings() else { return Vec::new() };
            let of = |w: usize| {
                let along = (&design.values[..], &directions[w][..]);
                let direction = vec![Along::Design(directions[w].clone())];
                (w, Curvatures::new(analysis.design_map(), analysis.topology(), along, openings, direction))
            };
            seconds.iter().map(|w| of(*w)).collect()
        });
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let count = result.outputs.len();
        result.stop = walk.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            let SolvedSteps::One(plan, one, _, Some(equilibrium)) = solved else { return };
            let curvatures: &mut Vec<(usize, Curvatures<'_>)> = workspaces.on(plan);
            let t = model.times[result.times.len()];
            // Per second direction: first derivatives of all outputs along it, and per variable the second ones.
            let mut found = Vec::new();
            for (w, curvatures) in curvatures.iter_mut() {
                equilibrium.curve(one, t, curvatures, 0);
                let (mut first, mut by_variable) = (vec![0.0; count], Vec::new());
                for v in 0..model.variables.len() {
                    let poses = curvatures.poses(v);
                    let instant = Instant::new(model, &curvatures.fixed[v], &poses);
                    first.clear();
                    let mut second = Vec::with_capacity(count);
                    instant.all(|x| {
                        first.push(x.v.d);
                        second.push(x.d.d);
                    });
                    by_variable.push(second);
                }
                found.push((*w, first, by_variable));
            }
            result.times.push(t);
            let state = &one.mechanism.state;
            for [u, w] in &pairs {
                let at = found.iter().position(|(of, ..)| of == w).expect("every second direction is solved");
                let ((_, first, by_variable), (_, curvatures)) = (&found[at], &curvatures[at]);
                let parts = || directions[*u].iter().enumerate().filter(|(_, rate)| **rate != 0.0);
                for m in 0..count {
                    let second = parts().map(|(v, rate)| rate * by_variable[v][m]).sum();
                    result.push(m, second, first[m]);
                }
                for body in 0..result.bodies {
                    let [along_u, curvature] = curvatures.twist_along(&directions[*u], body);
                    let [along_w, _] = curvatures.twist_along(&directions[*w], body);
                    let r = state.pose[body].r;
                    result.curvatures.push(BodyCurvature::of(r, [along_u, along_w], curvature));
                }
            }
        });
        result
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
            let mut m = 0;
            instant.all(|x| {
                result.push(m, x.d.d, x.v.d);
                m += 1;
            });
            let body = |b: usize| self.seconds.curvature(state, p, b);
            result.curvatures.extend((0..result.bodies).map(body));
        }
    }
}
