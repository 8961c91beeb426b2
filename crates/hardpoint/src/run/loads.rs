//! Loads of joints and drivers over the motion of a design.

use std::ops::ControlFlow;

use super::request::Scope;
use super::sink::NullSink;
use super::walk::SolvedSteps;
use super::{Analysis, Walk};
use crate::load::{CurveRange, Deflection, DriverLoad, JointLoad, LargestDeflection, LoadSolver, Loads};
use crate::model::{Axes, ElementId, JointId};
use crate::sensitivity::Admissibility;

impl Analysis<'_> {
    /// Loads of all joints and drivers over the motion of the design with variable k at `design[k]`; all zero for a
    /// model without masses and applied forces.
    pub fn loads(&self, design: &[f64]) -> Loads {
        self.loads_in(design, false)
    }

    /// The same, with the derivatives of the largest deflections by the design variables.
    pub fn loads_with_sensitivities(&self, design: &[f64]) -> Loads {
        self.loads_in(design, true)
    }

    /// Range of the deflections of each curve of [`Model::force_curves`] over the motion of the nominal design;
    /// `None` if no deflection is known.
    ///
    /// [`Model::force_curves`]: crate::model::Model::force_curves
    pub fn curve_ranges(&self) -> Vec<Option<CurveRange>> {
        let model = self.model();
        let curves = model.force_curves();
        let mut ranges = vec![None; curves.len()];
        if curves.is_empty() {
            return ranges;
        }
        let design = self.prepare(&[], Scope::of_one(false, true));
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]).with_loads(|plan| {
            let (map, topology) = (plan.analysis.design_map(), plan.analysis.topology());
            LoadSolver::new(map, topology, &plan.design.values, Vec::new(), false)
        });
        let mut step = 0;
        walk.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            let SolvedSteps::One(_, _, Some(solver), _) = solved else { return };
            for (curve, range) in curves.iter().zip(&mut ranges) {
                *range = CurveRange::with(*range, solver.curve_deflection(curve), step);
            }
            step += 1;
        });
        ranges
    }

    fn loads_in(&self, design: &[f64], sensitivities: bool) -> Loads {
        let model = self.model();
        let elastic = model.elastic_directions();
        let sensitivities = sensitivities && !elastic.is_empty() && !model.variables.is_empty();
        let design = self.prepare(design, Scope::of_one(sensitivities, true));
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]).with_loads(|plan| {
            let (map, topology) = (plan.analysis.design_map(), plan.analysis.topology());
            let solver = LoadSolver::new(map, topology, &plan.design.values, Vec::new(), sensitivities);
            solver.checking_reactions().with_deflections(elastic.clone())
        });
        let mut result = Loads { largest_deflections: vec![None; elastic.len()], ..Loads::default() };
        let (pushed, given) = (model.points_of_application(), model.given_forces());
        result.stop = walk.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            let SolvedSteps::One(_, _, Some(solver), _) = solved else { return };
            let step = result.times.len();
            result.times.push(model.times[step]);
            result.friction_known.push(solver.is_friction_known());
            note(&mut result.shared_friction, solver.shared_friction());
            note(&mut result.ambiguous_friction, solver.ambiguous_friction());
            for joint in (0..model.joints.len()).map(JointId) {
                let [(force, f), (moment, m)] = solver.reaction(joint, Axes::Global);
                let in_body = solver.reaction(joint, Axes::Body);
                let (known_force, known_directions) = solver.known_force(joint);
                result.joints.push(JointLoad {
                    place: solver.place(joint),
                    force,
                    moment,
                    known: [f, m],
                    in_body: in_body.map(|x| x.0),
                    known_in_body: in_body.map(|x| x.1),
                    known_force,
                    known_directions,
                });
            }
            result.given.extend(given.iter().map(|element| solver.given(*element)));
            for (i, (at, largest)) in elastic.iter().zip(&mut result.largest_deflections).enumerate() {
                let deflection = solver.deflection(*at);
                result.deflections.push(deflection);
                if is_larger(deflection, largest.as_ref().map(|largest| largest.deflection)) {
                    let d = solver.deflection_derivatives(i).collect();
                    *largest = Some(LargestDeflection { step, deflection, d });
                }
            }
            result.pushes.extend(pushed.iter().map(|&(element, at)| solver.push(element, at)));
            let transmitted = solver.transmitted();
            let drivers = transmitted.drivers.iter().zip(&transmitted.speeds);
            let drivers = drivers.take(model.drivers.len());
            result.drivers.extend(drivers.map(|(&force, &speed)| DriverLoad { force, speed }));
        });
        for (v, admissibility) in walk.admissibility(&design.opens).iter().enumerate() {
            if matches!(admissibility, Admissibility::CannotFollow { .. }) {
                result.largest_deflections.iter_mut().flatten().for_each(|largest| largest.d[v] = f64::NAN);
            }
        }
        result
    }
}

/// True if a deflection is known, and larger than the largest one before it.
fn is_larger(deflection: Deflection, before: Option<Deflection>) -> bool {
    let size = deflection.displacement.abs();
    before.map_or(size.is_finite(), |before| size > before.displacement.abs())
}

/// Adds the elements that are not in the list yet.
fn note(list: &mut Vec<ElementId>, elements: impl Iterator<Item = ElementId>) {
    for element in elements {
        if !list.contains(&element) {
            list.push(element);
        }
    }
}
