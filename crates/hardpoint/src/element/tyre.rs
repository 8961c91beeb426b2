//! Tyre: a vertical spring between the road and the contact point of a wheel.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, Properties, Tyre};
use crate::model::{Dimension, ElementId, GROUND, Model};
use crate::space::{Real, Vec3, Wrench};

impl Tyre {
    /// Contact point, and the force of the road along z: `F_0 + k (h law - (C_z - C_z0))`, with C_z0 the height of the
    /// contact point in the design configuration.
    fn road<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> (Vec3<T>, T) {
        let contact = at.wheel(self.wheel).contact();
        let drawn = at.design_wheel(self.wheel).contact();
        let road = at.or_zero(self.height.map(|n| n.0)) * at.laws[e.0];
        let deflection = road - (contact.z - drawn.z);
        (contact, at.number(self.stiffness.0).times_plus(deflection, at.preload(self.preload.map(|n| n.0))))
    }
}

impl ForceProperties for Tyre {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Wheel(self.wheel),
            axes: [None; 2],
            dimension: Dimension::FORCE,
            given: [self.preload.map(|n| n.0), None, None],
            table: None,
            law: self.law.as_ref(),
            is_arithmetic: true,
            compliance: Compliance::Element,
            friction: None,
        }
    }
}

impl CheckElement for Tyre {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        c.check_positive("tyre", [(self.stiffness.0, "stiffness")]);
        if c.model().wheels[self.wheel.0].body == GROUND {
            let message = format!("`{}` acts on a wheel of ground, which does not move", c.name);
            c.fault("HP0251", "wheel", message).help("name a wheel of another body");
        }
    }
}

impl ForceFormula for Tyre {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let (contact, force) = self.road(at, e);
        let up: Vec3<T> = Vec3::AXES[2].spread();
        out[at.model.wheels[self.wheel.0].body.0] -= Wrench::force(up * force, contact);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        self.road(at, e).1
    }

    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId, mut each: impl FnMut(T, T)) {
        each(at.wheel(self.wheel).contact().z, at.number(self.stiffness.0));
    }
}
