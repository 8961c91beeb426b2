//! Given force of the road on a wheel.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, Force, ForceProperties, Properties, WheelForce};
use crate::model::{Dimension, ElementId, GROUND, Model, WheelPoint};
use crate::number;
use crate::space::{Real, Vec3, Wrench};

impl WheelForce {
    /// True if it is a moment alone.
    fn is_moment(&self) -> bool {
        [self.outboard, self.forward, self.up].iter().all(|n| n.is_none())
    }

    /// Point of the wheel at which it acts, the force, and the moment about z.
    fn road<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> (Vec3<T>, Vec3<T>, Vec3<T>) {
        let now = at.wheel(self.wheel);
        let [o, f, z] = number::each(&[self.outboard, self.forward, self.up], |n| at.or_zero(n.map(|n| n.0)));
        let up: Vec3<T> = Vec3::AXES[2].spread();
        let push = now.outboard() * o + now.forward() * f + up * z;
        let turn = up * (now.side * at.or_zero(self.about_up.map(|n| n.0)));
        let point = match self.at.unwrap_or_default() {
            WheelPoint::Contact => now.contact(),
            WheelPoint::Centre => now.centre,
        };
        (point, push * at.laws[e.0], turn * at.laws[e.0])
    }
}

impl ForceProperties for WheelForce {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Wheel(self.wheel),
            axes: [None; 2],
            dimension: if self.is_moment() { Dimension::MOMENT } else { Dimension::FORCE },
            given: match self.about_up {
                Some(moment) if self.is_moment() => [Some(moment.0), None, None],
                Some(_) | None => number::each(&[self.outboard, self.forward, self.up], |n| n.map(|n| n.0)),
            },
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
        if self.is_moment() && self.about_up.is_none() {
            let message = format!("`{}` has no force", c.name);
            c.fault("HP0251", "type", message)
                .help("give its force `up`, `outboard` or `forward`, or its moment `about_up`, or remove it");
        }
        if c.model().wheels[self.wheel.0].body == GROUND {
            let message = format!("`{}` acts on a wheel of ground, which does not move", c.name);
            c.fault("HP0251", "wheel", message).help("name a wheel of another body");
        }
    }
}

impl ForceFormula for WheelForce {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let (point, push, turn) = self.road(at, e);
        let on_wheel = &mut out[at.model.wheels[self.wheel.0].body.0];
        *on_wheel -= Wrench::force(push, point);
        *on_wheel -= Wrench::moment(turn);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        // Positive in the direction at a law of 1. Without components it has no derivative.
        let of = |n: Option<Force>| at.or_zero(n.map(|n| n.0));
        let full = match self.is_moment() {
            true => at.or_zero(self.about_up.map(|n| n.0)).abs(),
            false => Vec3::new(of(self.outboard), of(self.forward), of(self.up)).norm(),
        };
        full * at.laws[e.0]
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
