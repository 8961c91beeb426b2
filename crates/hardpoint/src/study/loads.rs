//! Loads of joints and drivers over a motion.

use crate::load::LoadSolver;
use crate::model::{Axes, ElementId, JointId};
use crate::motion::Stop;
use crate::run::{Analysis, Walk};
use crate::space::Vec3;

/// Reaction of a joint on its second body, global.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLoad {
    /// Location of the joint on that body, m.
    pub place: Vec3,
    /// The force, N, with that of drivers on the joint's coordinates.
    pub force: Vec3,
    /// The moment about that place, N m.
    pub moment: Vec3,
    /// Determined components of force and moment: with redundant constraints some of them depend on stiffness, and the
    /// values here are one of many solutions.
    pub known: [[bool; 3]; 2],
    /// The same force and moment along the global axes in the design configuration, which have turned with the body.
    pub in_body: [Vec3; 2],
    /// Determined components of these.
    pub known_in_body: [[bool; 3]; 2],
    /// Determined part of the force, global: the force without its components along undetermined directions.
    pub known_force: Vec3,
    /// Along how many directions the force is known; 3: it is known.
    pub known_directions: usize,
}

/// Load of a driver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriverLoad {
    /// Force, N, or moment, N m; positive where it works while what it drives grows.
    pub force: f64,
    /// The speed that it prescribes, m/s or rad/s: times the force it is the power, W.
    pub speed: f64,
}

/// Loads of all joints and drivers over a motion.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// `joints[k * n + j]` at time k of joint j, of n.
    pub joints: Vec<JointLoad>,
    /// `drivers[k * n + d]` at time k of driver d, of n.
    pub drivers: Vec<DriverLoad>,
    /// `pushes[k * n + i]` at time k of [`Model::pushed`](crate::model::Model::pushed)'s place i, of n: the force on
    /// its body there, global, N.
    pub pushes: Vec<Vec3>,
    /// Friction elements that are not determined at some time, because redundant constraints share their normal force:
    /// then no load is determined.
    pub shared_friction: Vec<ElementId>,
    /// Friction that has more than one solution at some time: then no load is known either.
    pub ambiguous_friction: Vec<ElementId>,
    /// Reason why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

impl Loads {
    /// Loads of all joints at output time k.
    pub fn joints_at(&self, k: usize) -> &[JointLoad] {
        let n = self.joints.len() / self.times.len().max(1);
        &self.joints[k * n..(k + 1) * n]
    }

    /// Loads of all drivers at output time k.
    pub fn drivers_at(&self, k: usize) -> &[DriverLoad] {
        let n = self.drivers.len() / self.times.len().max(1);
        &self.drivers[k * n..(k + 1) * n]
    }

    /// Forces at all of [`Model::pushed`](crate::model::Model::pushed)'s places at output time k.
    pub fn pushes_at(&self, k: usize) -> &[Vec3] {
        let n = self.pushes.len() / self.times.len().max(1);
        &self.pushes[k * n..(k + 1) * n]
    }
}

impl Analysis<'_> {
    /// Loads of all joints and drivers over the motion of the design with variable k at `design[k]`; of a model in
    /// which nothing has mass and nothing pushes they are all zero.
    pub fn loads(&self, design: &[f64]) -> Loads {
        let (model, design) = (self.model(), self.design(design));
        let mut solver = LoadSolver::new(self.design_map(), self.topology(), &design.values, false).judging();
        let mut walk = Walk::new(self, &design, vec![false; model.bodies.len()]);
        let (mut result, mut times) = (Loads::default(), model.times.iter());
        let pushed = model.pushed();
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
            result.pushes.extend(pushed.iter().map(|&(element, at)| solver.push(element, at)));
            let found = solver.found();
            let drivers = found.drivers.iter().zip(&found.speeds);
            result.drivers.extend(drivers.map(|(&force, &speed)| DriverLoad { force, speed }));
        });
        result
    }
}

/// Enters elements that are not there yet.
fn note(list: &mut Vec<ElementId>, elements: impl Iterator<Item = ElementId>) {
    for element in elements {
        if !list.contains(&element) {
            list.push(element);
        }
    }
}
