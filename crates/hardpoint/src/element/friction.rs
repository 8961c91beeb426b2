//! Coulomb friction in a hinge or ball joint, and viscous friction besides.

use crate::draft::{CheckElement, ElementCheck};
use crate::joint::{Freedom, Quantity, Slide};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, Friction, JointFriction, Properties};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Real, Wrench};

/// Default transition velocity, rad/s.
const TRANSITION_VELOCITY: f64 = 0.01;

impl ForceProperties for Friction {
    #[inline]
    fn properties(&self, model: &Model) -> Properties<'_> {
        // A ball turns by no coordinate.
        let joint = &model.joints[self.joint.0];
        let coordinate = joint.kind.coordinates.iter().position(|c| c.quantity == Quantity::Angle);
        Properties {
            acts_on: coordinate.map_or(ActsOn::Joint(self.joint), |c| ActsOn::Coordinate(self.joint, c)),
            dimension: Dimension::MOMENT,
            given: [None; 3],
            table: None,
            law: None,
            is_arithmetic: true,
            compliance: Compliance::None,
            friction: Some(JointFriction {
                joint: self.joint,
                coordinate,
                coefficient: self.coefficient.0,
                radius: Some(self.radius.0),
                length: self.length.map(|n| n.0),
                ignored_direction: None,
                viscous: self.viscous.map(|n| n.0),
                transition_velocity: self.transition_velocity.map(|n| n.0),
                default_transition_velocity: TRANSITION_VELOCITY,
            }),
        }
    }
}

impl CheckElement for Friction {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let kind = c.model().joints[self.joint.0].kind;
        if !kind.is_hinge && !kind.is_ball() {
            let help = match (kind.slide, kind.freedoms) {
                (Slide::Block, _) => "write `type = \"slide_friction\"` for a slide",
                (_, Some([Freedom::Turn(_), Freedom::Turn(_)])) => {
                    "replace the universal joint by two revolute joints with a body between them; for viscous friction alone use the `damping` of a `torsion_spring`"
                }
                _ => {
                    "name a revolute, cylindrical or spherical joint; for viscous friction of others use the `damping` of a `torsion_spring`"
                }
            };
            c.report_friction_joint(self.joint, "hinge or ball joint", help);
        } else if self.length.is_some() && kind.is_ball() {
            let message = format!("`{}` has a `length`, which does not apply to a spherical joint", c.name);
            c.fault("HP0251", "length", message).help("remove `length`");
        }
    }
}

impl ForceFormula for Friction {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        at.apply_friction(e, out);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        at.friction_size(e)
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
