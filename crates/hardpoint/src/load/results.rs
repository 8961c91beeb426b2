//! Loads of joints and drivers over a motion, as stored.

use crate::model::ElementId;
use crate::motion::Stop;
use crate::space::Vec3;

/// Reaction wrench of a joint on body j, global components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLoad {
    /// Point of application on body j, m.
    pub place: Vec3,
    /// Force, N, including forces of drivers on the joint's coordinates.
    pub force: Vec3,
    /// Moment about that point, N m.
    pub moment: Vec3,
    /// True for determined components of force and moment. With redundant constraints some components depend on
    /// stiffness, and the values here are one of many solutions.
    pub known: [[bool; 3]; 2],
    /// Force, N, and moment, N m, in axes that coincide with the global axes in the design configuration and turn with
    /// body j.
    pub in_body: [Vec3; 2],
    /// True for determined components of `in_body`.
    pub known_in_body: [[bool; 3]; 2],
    /// Determined part of the force, N, global: the force without its components along undetermined directions.
    pub known_force: Vec3,
    /// Number of directions in which the force is determined; 3 if it is fully determined.
    pub known_directions: usize,
}

/// Load of a driver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriverLoad {
    /// Force, N, or moment, N m; positive if it does positive work when the driven coordinate increases.
    pub force: f64,
    /// Prescribed speed, m/s or rad/s. Force times speed is the power, W.
    pub speed: f64,
}

/// Deflection of an elastic joint or a bushing along or about one of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection {
    /// Displacement, m, or angle, rad, of body j relative to body i from the design configuration.
    pub displacement: f64,
    /// Elastic force, N, or moment, N m, on body j in that direction.
    pub force: f64,
}

/// Largest deflection over a motion, of an elastic joint or a bushing along or about one of its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestDeflection {
    /// Number of the output time; the first of equal deflections counts.
    pub step: usize,
    /// Deflection at that time.
    pub deflection: Deflection,
    /// Derivatives of the displacement by every design variable at that time, m or rad per unit of the variable: NaN
    /// for those that the mechanism cannot follow; empty if no sensitivities are requested.
    pub d: Vec<f64>,
}

/// Range of the deflections of a curve over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveRange {
    /// Least and greatest deflection, m or rad.
    pub deflections: [f64; 2],
    /// Numbers of their output times; the first of equal deflections counts.
    pub steps: [usize; 2],
}

impl CurveRange {
    /// Range with a further deflection; NaN leaves it as it is.
    pub(crate) fn with(range: Option<Self>, deflection: f64, step: usize) -> Option<Self> {
        let Some(mut range) = range else {
            return deflection.is_finite().then_some(Self { deflections: [deflection; 2], steps: [step; 2] });
        };
        if deflection < range.deflections[0] {
            (range.deflections[0], range.steps[0]) = (deflection, step);
        }
        if deflection > range.deflections[1] {
            (range.deflections[1], range.steps[1]) = (deflection, step);
        }
        Some(range)
    }
}

/// Loads of all joints and drivers over a motion.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// `joints[k * n + j]`: load of joint j of n at time k.
    pub joints: Vec<JointLoad>,
    /// `drivers[k * n + d]`: load of driver d of n at time k.
    pub drivers: Vec<DriverLoad>,
    /// `pushes[k * n + i]`: applied force at point i of n of [`Model::points_of_application`] on its body at time k,
    /// global, N.
    ///
    /// [`Model::points_of_application`]: crate::model::Model::points_of_application
    pub pushes: Vec<Vec3>,
    /// `deflections[k * n + i]`: deflection in direction i of n of [`Model::elastic_directions`] at time k.
    ///
    /// [`Model::elastic_directions`]: crate::model::Model::elastic_directions
    pub deflections: Vec<Deflection>,
    /// Largest deflection in each direction of [`Model::elastic_directions`]; `None` if none is known.
    ///
    /// [`Model::elastic_directions`]: crate::model::Model::elastic_directions
    pub largest_deflections: Vec<Option<LargestDeflection>>,
    /// `given[k * n + i]`: value of force i of n of [`Model::given_forces`] at time k, N or N m, with the sign of its
    /// law.
    ///
    /// [`Model::given_forces`]: crate::model::Model::given_forces
    pub given: Vec<f64>,
    /// True for each output time at which the friction of all elements is determined. No load is determined at others.
    pub friction_known: Vec<bool>,
    /// Friction elements whose friction is undetermined at some time because redundant constraints share their normal
    /// force. No load is determined then.
    pub shared_friction: Vec<ElementId>,
    /// Friction elements with more than one solution at some time. No load is determined then.
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

    /// Applied forces at all points of [`Model::points_of_application`] at output time k, global, N.
    ///
    /// [`Model::points_of_application`]: crate::model::Model::points_of_application
    pub fn pushes_at(&self, k: usize) -> &[Vec3] {
        let n = self.pushes.len() / self.times.len().max(1);
        &self.pushes[k * n..(k + 1) * n]
    }

    /// Deflections in all directions of [`Model::elastic_directions`] at output time k.
    ///
    /// [`Model::elastic_directions`]: crate::model::Model::elastic_directions
    pub fn deflections_at(&self, k: usize) -> &[Deflection] {
        let n = self.deflections.len() / self.times.len().max(1);
        &self.deflections[k * n..(k + 1) * n]
    }

    /// Values of all forces of [`Model::given_forces`] at output time k.
    ///
    /// [`Model::given_forces`]: crate::model::Model::given_forces
    pub fn given_at(&self, k: usize) -> &[f64] {
        let n = self.given.len() / self.times.len().max(1);
        &self.given[k * n..(k + 1) * n]
    }
}
