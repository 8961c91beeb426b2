//! Given moment on a body.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, BodyMoment, Compliance, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, GROUND, Model};
use crate::space::{Real, Wrench};

impl ForceProperties for BodyMoment {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Body(self.body),
            axes: [None; 2],
            dimension: Dimension::MOMENT,
            given: [Some(self.moment.0), None, None],
            table: None,
            law: self.law.as_ref(),
            is_arithmetic: true,
            compliance: Compliance::None,
            friction: None,
        }
    }
}

impl CheckElement for BodyMoment {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        if self.body == GROUND {
            let message = format!("`{}` acts on ground, which does not move", c.name);
            c.fault("HP0251", "body", message).help("apply it to another body");
        }
    }
}

impl ForceFormula for BodyMoment {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let turn = at.along(self.about, self.axes, self.body.0) * self.size(at, e);
        out[self.body.0] -= Wrench::moment(turn);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        at.number(self.moment.0) * at.laws[e.0]
    }

    fn deflections<T: Real>(&self, _: &AppliedLoads<'_, T>, _: ElementId, _: impl FnMut(T, T)) {}
}
