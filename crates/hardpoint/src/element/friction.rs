//! Coulomb friction in a joint, and viscous friction besides: in a hinge or ball joint, and in a slide.

use crate::draft::{CheckElement, ElementCheck};
use crate::joint::{Freedom, Quantity, Slide};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{
    ActsOn, Compliance, ForceProperties, Friction, JointFriction, Properties, SlideFriction,
};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Real, Wrench};

/// Implements friction on coordinates of a quantity; `$radius` and `$ignored` return what one of the types alone has.
macro_rules! joint_friction {
    ($type:ident, $dimension:expr, $quantity:expr, $transition_velocity:expr, $radius:expr, $ignored:expr) => {
        impl ForceProperties for $type {
            #[inline]
            fn properties(&self, model: &Model) -> Properties<'_> {
                // A ball turns by no coordinate.
                let joint = &model.joints[self.joint.0];
                let coordinate = joint.kind.coordinates.iter().position(|c| c.quantity == $quantity);
                Properties {
                    acts_on: coordinate
                        .map_or(ActsOn::Joint(self.joint), |c| ActsOn::Coordinate(self.joint, c)),
                    axes: [None; 2],
                    dimension: $dimension,
                    given: [None; 3],
                    table: None,
                    law: None,
                    is_arithmetic: true,
                    compliance: Compliance::None,
                    friction: Some(JointFriction {
                        joint: self.joint,
                        coordinate,
                        coefficient: self.coefficient.0,
                        radius: $radius(self),
                        length: self.length.map(|n| n.0),
                        ignored_direction: $ignored(self),
                        viscous: self.viscous.map(|n| n.0),
                        transition_velocity: self.transition_velocity.map(|n| n.0),
                        default_transition_velocity: $transition_velocity,
                    }),
                }
            }
        }

        impl ForceFormula for $type {
            fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
                at.apply_friction(e, out);
            }

            fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
                at.friction_size(e)
            }

            fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
        }
    };
}

/// Default transition velocities, rad/s and m/s.
const TRANSITION_VELOCITIES: [f64; 2] = [0.01, 0.001];
/// Minimum sine of the angle between two directions that count as not parallel.
const ACROSS: f64 = 1e-3;

joint_friction!(
    Friction,
    Dimension::MOMENT,
    Quantity::Angle,
    TRANSITION_VELOCITIES[0],
    |f: &Self| Some(f.radius.0),
    |_| None
);
joint_friction!(
    SlideFriction,
    Dimension::FORCE,
    Quantity::Length,
    TRANSITION_VELOCITIES[1],
    |_| None,
    |f: &Self| f.ignored_direction
);

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

impl CheckElement for SlideFriction {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let joint = &c.model().joints[self.joint.0];
        let kind = joint.kind;
        if kind.slide != Slide::Block {
            let help = if kind.is_hinge || kind.is_ball() {
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
