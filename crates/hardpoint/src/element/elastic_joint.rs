//! Joint that gives along its own axes.

use crate::draft::{CheckElement, ElementCheck};
use crate::linalg::semidefinite::is_definite;
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ElasticJoint, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Model, NumberId};
use crate::space::{Real, Wrench};

impl ForceProperties for ElasticJoint {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Joint(self.joint),
            axes: [None; 2],
            dimension: Dimension::FORCE,
            given: [self.preload_x, self.preload_y, self.preload_z].map(|n| n.map(|n| n.0)),
            table: None,
            law: None,
            is_arithmetic: self.law().is_arithmetic(),
            compliance: Compliance::Joint(self),
            friction: None,
        }
    }
}

impl CheckElement for ElasticJoint {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let law = self.law();
        let gives = law.gives();
        let value = |n: NumberId| c.value(n);
        // Curves may have any slope in the design configuration.
        let is_linear = |k: &usize| gives[*k] && law.directions[*k].curve.is_none();
        let linear: Vec<usize> = (0..6).filter(is_linear).collect();
        let stiffness = |r: usize, k: usize| law.stiffnesses(r, k).map(value).sum();
        let row = |r: &usize| linear.iter().map(|k| stiffness(*r, *k)).collect();
        let matrix: Vec<Vec<f64>> = linear.iter().map(row).collect();
        let given = |k: &usize| law.directions[*k].stiffness.is_none_or(|n| value(n) > 0.0);
        if !gives.contains(&true) {
            let message = format!("`{}` is rigid in all directions", c.name);
            c.fault("HP0251", "type", message)
                .help("give it a stiffness along or about one of its axes, or remove it");
        } else if !(0..6).all(|k| given(&k)) {
            let message = format!("a stiffness of `{}` is not positive", c.name);
            c.fault("HP0252", "joint", message)
                .help("give a positive stiffness, or remove the key to make that direction rigid");
        } else if self.matrix.is_some() && !is_definite(&matrix) {
            let message = format!("the stiffness matrix of `{}` is not positive definite", c.name);
            c.fault("HP0252", "matrix", message)
                .note("it counts with the stiffnesses along and about single axes on its diagonal")
                .help("increase the diagonal, or reduce the entries beside it");
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
        at.apply_between(self.joint, at.elastic_wrench(&opening, &self.law()), T::one(), out);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId) -> T {
        at.opening(self.joint).map_or(T::zero(), |opening| at.elastic_wrench(&opening, &self.law()).f.norm())
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
