//! Joint that gives along its own axes.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ElasticJoint, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Model, NumberId};
use crate::space::{Real, Wrench};

impl ElasticJoint {
    /// Stiffnesses along and about the joint's axes.
    fn stiffnesses(&self) -> [[Option<NumberId>; 3]; 2] {
        let Self { joint: _, x, y, z, about_x, about_y, about_z } = self;
        [[x, y, z].map(|n| n.map(|n| n.0)), [about_x, about_y, about_z].map(|n| n.map(|n| n.0))]
    }
}

impl ForceProperties for ElasticJoint {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Joint(self.joint),
            dimension: Dimension::FORCE,
            given: [None; 3],
            table: None,
            law: None,
            is_arithmetic: true,
            compliance: Compliance::Joint(self.joint, self.stiffnesses()),
            friction: None,
        }
    }
}

impl CheckElement for ElasticJoint {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let given: Vec<NumberId> = self.stiffnesses().into_iter().flatten().flatten().collect();
        if given.is_empty() {
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
    fn apply<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: &mut [Wrench<T>]) {}

    fn size<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId) -> T {
        T::zero()
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
