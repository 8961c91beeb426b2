//! Given force on a point.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, PointForce, Properties};
use crate::model::{Dimension, ElementId, GROUND, Model};
use crate::space::{Real, Wrench};

impl ForceProperties for PointForce {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Point(self.at),
            axes: [None; 2],
            dimension: Dimension::FORCE,
            given: [Some(self.force.0), None, None],
            table: None,
            law: self.law.as_ref(),
            is_arithmetic: true,
            compliance: Compliance::None,
            friction: None,
        }
    }
}

impl CheckElement for PointForce {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        if c.body_of(self.at) == GROUND {
            let message = format!("`{}` acts on ground, which does not move", c.name);
            c.fault("HP0251", "at", message).help("apply it to a point of another body");
        }
    }
}

impl ForceFormula for PointForce {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let body = at.body(self.at);
        let push = at.along(self.along, self.axes, body) * self.size(at, e);
        out[body] -= Wrench::force(push, at.point(self.at));
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        at.number(self.force.0) * at.laws[e.0]
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
