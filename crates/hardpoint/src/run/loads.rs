//! Loads of joints and drivers over the motion of a design.

use super::{Analysis, Walk};
use crate::load::{DriverLoad, JointLoad, LoadSolver, Loads, load_measures};
use crate::model::{Axes, ElementId, JointId};

impl Analysis<'_> {
    /// Loads of all joints and drivers over the motion of the design with variable k at `design[k]`; all zero for a
    /// model without masses and applied forces.
    pub fn loads(&self, design: &[f64]) -> Loads {
        let (model, design) = (self.model(), self.design(design));
        let measures = load_measures(model);
        let solver = LoadSolver::new(self.design_map(), self.topology(), &design.values, measures, false);
        let mut solver = solver.checking_reactions();
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let (mut result, mut times) = (Loads::default(), model.times.iter());
        let (pushed, given) = (model.points_of_application(), model.given_forces());
        let elastic = model.elastic_directions();
        result.stop = walk.each(|one| {
            let Some(&t) = times.next() else { return };
            solver.step(one, t);
            result.times.push(t);
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
            result.deflections.extend(elastic.iter().map(|at| solver.deflection(*at)));
            result.pushes.extend(pushed.iter().map(|&(element, at)| solver.push(element, at)));
            let transmitted = solver.transmitted();
            let drivers = transmitted.drivers.iter().zip(&transmitted.speeds);
            let drivers = drivers.take(model.drivers.len());
            result.drivers.extend(drivers.map(|(&force, &speed)| DriverLoad { force, speed }));
        });
        result
    }
}

/// Adds the elements that are not in the list yet.
fn note(list: &mut Vec<ElementId>, elements: impl Iterator<Item = ElementId>) {
    for element in elements {
        if !list.contains(&element) {
            list.push(element);
        }
    }
}
