//! Joint that gives along its own axes.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ElasticJoint, Elasticity, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Model, NumberId};
use crate::space::{Real, Wrench};

impl ElasticJoint {
    /// Stiffnesses along and about the joint's axes.
    fn stiffnesses(&self) -> [[Option<NumberId>; 3]; 2] {
        let [x, y, z, a, b, c] = self.elasticities().map(|of| of.stiffness);
        [[x, y, z], [a, b, c]]
    }
}

impl ForceProperties for ElasticJoint {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Joint(self.joint),
            dimension: Dimension::FORCE,
            given: [self.preload_x, self.preload_y, self.preload_z].map(|n| n.map(|n| n.0)),
            table: None,
            law: None,
            is_arithmetic: self.elasticities().iter().all(|of| of.curve.is_none()),
            compliance: Compliance::Joint {
                joint: self.joint,
                stiffnesses: self.stiffnesses(),
                gives: self.elasticities().map(|of| of.gives()),
            },
            friction: None,
        }
    }
}

impl CheckElement for ElasticJoint {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let given: Vec<NumberId> = self.stiffnesses().into_iter().flatten().flatten().collect();
        if !self.elasticities().iter().any(Elasticity::gives) {
            let message = format!("`{}` is rigid in all directions", c.name);
            c.fault("HP0251", "type", message)
                .help("give it a stiffness along or about one of its axes, or remove it");
        } else if given.iter().any(|n| !(c.value(*n) > 0.0)) {
            let message = format!("a stiffness of `{}` is not positive", c.name);
            c.fault("HP0252", "joint", message)
                .help("give a positive stiffness, or remove the key to make that direction rigid");
        }
        let joint = &c.model().joints[self.joint.0];
        if joint.kind.places == 0 {
            let message = format!("joint `{}` has no location at which it could deflect", joint.name);
            c.fault("HP0251", "joint", message).help("name a joint with a location");
        }
    }
}

impl ForceFormula for ElasticJoint {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId, out: &mut [Wrench<T>]) {
        let Some(opening) = at.opening(self.joint) else { return };
        at.apply_between(self.joint, at.elastic_wrench(&opening, &self.elasticities()), T::one(), out);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId) -> T {
        at.opening(self.joint)
            .map_or(T::zero(), |opening| at.elastic_wrench(&opening, &self.elasticities()).f.norm())
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
