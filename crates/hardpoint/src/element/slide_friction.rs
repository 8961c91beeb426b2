//! Coulomb friction in a slide, and viscous friction besides.

use crate::draft::{CheckElement, ElementCheck};
use crate::joint::{Quantity, Slide};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, JointFriction, Properties, SlideFriction};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Real, Wrench};

/// Default transition velocity, m/s.
const TRANSITION_VELOCITY: f64 = 0.001;

/// Minimum sine of the angle between two directions that count as not parallel.
const ACROSS: f64 = 1e-3;

impl ForceProperties for SlideFriction {
    #[inline]
    fn properties(&self, model: &Model) -> Properties<'_> {
        let joint = &model.joints[self.joint.0];
        let coordinate = joint.kind.coordinates.iter().position(|c| c.quantity == Quantity::Length);
        Properties {
            acts_on: coordinate.map_or(ActsOn::Joint(self.joint), |c| ActsOn::Coordinate(self.joint, c)),
            dimension: Dimension::FORCE,
            given: [None; 3],
            table: None,
            law: None,
            is_arithmetic: true,
            compliance: Compliance::None,
            friction: Some(JointFriction {
                joint: self.joint,
                coordinate,
                coefficient: self.coefficient.0,
                radius: None,
                length: self.length.map(|n| n.0),
                ignored_direction: self.ignored_direction,
                viscous: self.viscous.map(|n| n.0),
                transition_velocity: self.transition_velocity.map(|n| n.0),
                default_transition_velocity: TRANSITION_VELOCITY,
            }),
        }
    }
}

impl CheckElement for SlideFriction {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let joint = &c.model().joints[self.joint.0];
        if joint.kind.slide != Slide::Block {
            let help = if joint.kind.is_hinge || joint.kind.is_ball() {
                "write `type = \"friction\"` for a hinge or ball joint"
            } else {
                "name a translational or cylindrical joint; for viscous friction of others use the `damping` of a `joint_spring`"
            };
            c.report_friction_joint(self.joint, "slide", help);
        } else if self.ignored_direction.is_some_and(|n| n.cross(joint.frames[0].cols[2]).norm() < ACROSS) {
            let message = format!("`ignored_direction` of `{}` is parallel to its sliding axis", c.name);
            c.fault("HP0251", "ignored_direction", message)
                .help("give a direction across the sliding axis, or remove `ignored_direction`");
        }
    }
}

impl ForceFormula for SlideFriction {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        at.apply_friction(e, out);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        at.friction_size(e)
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
