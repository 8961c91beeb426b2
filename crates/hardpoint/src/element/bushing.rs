//! Bushing: springs and dampers between two bodies at a place.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Bushing, Compliance, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Real, Wrench};

impl Bushing {
    /// Wrench on body j.                                                                                      (44)
    fn wrench<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Wrench<T> {
        let push = at.elastic_wrench(&at.opening_between([self.from, self.to]), &self.elasticities());
        let Some(damping) = self.damping else { return push };
        // -c v,  v of P_j as seen from i
        let (i, j, q) = (at.body(self.from), at.body(self.to), at.point(self.to));
        let slip = at.bodies[j].velocity(q) - at.bodies[i].velocity(q);
        push - Wrench::force(slip * at.number(damping.0), q)
    }
}

impl ForceProperties for Bushing {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Points([self.from, self.to]),
            dimension: Dimension::FORCE,
            given: [self.preload_x, self.preload_y, self.preload_z].map(|n| n.map(|n| n.0)),
            table: None,
            law: None,
            is_arithmetic: self.elasticities().iter().all(|of| of.curve.is_none()),
            compliance: Compliance::Element,
            friction: None,
        }
    }
}

impl CheckElement for Bushing {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        if c.body_of(self.from) == c.body_of(self.to) {
            let message = format!("both sides of `{}` are on the same body", c.name);
            c.fault("HP0251", "to", message)
                .help("put them on two different bodies; `ground` is also a body");
        }
    }
}

impl ForceFormula for Bushing {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId, out: &mut [Wrench<T>]) {
        let push = self.wrench(at);
        out[at.body(self.to)] -= push;
        out[at.body(self.from)] += push;
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId) -> T {
        self.wrench(at).f.norm()
    }

    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId, mut each: impl FnMut(T, T)) {
        let opening = at.opening_between([self.from, self.to]);
        for (k, of) in self.elasticities().iter().enumerate() {
            let [_, stiffness] = at.elastic_force(opening.coordinates[k], of);
            each(opening.coordinates[k], stiffness);
        }
    }
}
