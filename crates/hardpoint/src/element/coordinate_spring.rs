//! Springs and dampers on a joint's coordinate: along a sliding one, and about an axis.

use crate::draft::{CheckElement, ElementCheck};
use crate::joint::Quantity;
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{
    ActsOn, Compliance, Elasticity, ForceProperties, JointSpring, Properties, TorsionSpring,
};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Real, Wrench};

/// Implements a spring on coordinates of a quantity; `$other` is the type for the other quantity.
macro_rules! coordinate_spring {
    ($type:ident, $dimension:expr, $quantity:expr, $other:literal) => {
        impl $type {
            /// Elastic law over the way from `equilibrium`.
            fn law(&self) -> Elasticity<'_> {
                Elasticity {
                    stiffness: Some(self.stiffness.0),
                    curve: self.curve.as_ref().map(AsRef::as_ref),
                    scale: self.scale.map(|n| n.0),
                    ..Elasticity::default()
                }
            }
        }

        impl ForceProperties for $type {
            #[inline]
            fn properties(&self, _: &Model) -> Properties<'_> {
                Properties {
                    acts_on: ActsOn::Coordinate(self.joint, self.coordinate),
                    axes: [None; 2],
                    dimension: $dimension,
                    given: [None; 3],
                    table: self.law().curve.map(|curve| ("curve", curve)),
                    law: None,
                    is_arithmetic: self.curve.is_none(),
                    compliance: Compliance::Element,
                    friction: None,
                }
            }
        }

        impl CheckElement for $type {
            fn check(&self, c: &mut ElementCheck<'_, '_>) {
                c.check_coordinate((self.joint, self.coordinate), $quantity, $other);
                c.check_scale(self.scale, "scale", &self.law(), "curve");
            }
        }

        impl ForceFormula for $type {
            fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
                // tau works on the coordinate
                at.apply_between(self.joint, at.unit((self.joint, self.coordinate)), self.size(at, e), out);
            }

            fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
                let now = at.coordinate(e, (self.joint, self.coordinate));
                let [equilibrium, damping] = [self.equilibrium.map(|n| n.0), self.damping.map(|n| n.0)];
                at.on_coordinate(now, &self.law(), equilibrium, damping)
            }

            fn deflections<T: Real>(
                &self,
                at: &AppliedLoads<'_, T>,
                e: ElementId,
                mut each: impl FnMut(T, T),
            ) {
                let [value, _] = at.coordinate(e, (self.joint, self.coordinate));
                let way = value - at.or_zero(self.equilibrium.map(|n| n.0));
                each(value, at.elastic_resistance(way, &self.law())[1]);
            }

            fn table_deflection<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> Option<T> {
                let [value, _] = at.coordinate(e, (self.joint, self.coordinate));
                Some(value - at.or_zero(self.equilibrium.map(|n| n.0)))
            }
        }
    };
}

coordinate_spring!(JointSpring, Dimension::FORCE, Quantity::Length, "torsion_spring");
coordinate_spring!(TorsionSpring, Dimension::MOMENT, Quantity::Angle, "joint_spring");
