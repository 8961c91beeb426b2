//! Given force of the road on a wheel.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, Properties, WheelForce};
use crate::model::{Dimension, ElementId, GROUND, Model};
use crate::space::{Real, Vec3, Wrench};

impl WheelForce {
    /// Point at which the road acts on the wheel, and the force.
    fn road<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> (Vec3<T>, Vec3<T>) {
        let now = at.wheel(self.wheel);
        let [o, f, z] = [self.outboard, self.forward, self.up].map(|n| at.or_zero(n.map(|n| n.0)));
        let push = now.outboard() * o + now.forward() * f + Vec3::AXES[2].spread() * z;
        (now.contact(), push * at.laws[e.0])
    }
}

impl ForceProperties for WheelForce {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Wheel(self.wheel),
            dimension: Dimension::FORCE,
            given: [self.outboard, self.forward, self.up].map(|n| n.map(|n| n.0)),
            table: None,
            law: self.law.as_ref(),
            is_arithmetic: true,
            compliance: Compliance::None,
            friction: None,
        }
    }
}

impl CheckElement for WheelForce {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        if [self.outboard, self.forward, self.up].iter().all(|n| n.is_none()) {
            let message = format!("`{}` has no force", c.name);
            c.fault("HP0251", "type", message)
                .help("give its force `up`, `outboard` or `forward`, or remove it");
        }
        if c.model().wheels[self.wheel.0].body == GROUND {
            let message = format!("`{}` acts on a wheel of ground, which does not move", c.name);
            c.fault("HP0251", "wheel", message).help("name a wheel of another body");
        }
    }
}

impl ForceFormula for WheelForce {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let (contact, push) = self.road(at, e);
        out[at.model.wheels[self.wheel.0].body.0] -= Wrench::force(push, contact);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        // A zero force has no derivative.
        self.road(at, e).1.norm()
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
