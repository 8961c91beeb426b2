//! Bushing: springs and dampers between two bodies at a place.

use crate::draft::{CheckElement, ElementCheck, StiffnessRule};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Bushing, Compliance, ForceProperties, Properties, StiffnessEntry};
use crate::model::{Dimension, ElementId, Model};
use crate::number;
use crate::space::{Real, Wrench};

impl Bushing {
    /// Wrench on body j.                                                                                      (44)
    fn wrench<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> Wrench<T> {
        let push = at.elastic_wrench(&at.opening_between(e, [self.from, self.to]), &self.law());
        let Some(damping) = self.damping else { return push };
        // -c v,  v of P_j as seen from i
        let (i, j, q) = (at.body(self.from), at.body(self.to), at.point(self.to));
        let slip = at.bodies[j].velocity(q) - at.bodies[i].velocity(q);
        push - Wrench::force(slip * at.number(damping.0), q)
    }
}

impl Bushing {
    /// HP0251: x and y axes that are not given, but differ.
    fn check_across(&self, c: &mut ElementCheck<'_, '_>) {
        let Some(axis) = self.axis.filter(|_| self.axis2.is_none()) else { return };
        if !c.is_even_across(&self.law()) {
            let message =
                format!("the x and y axes of `{}` differ, and their directions are not given", c.name);
            let help = format!("add the direction of its x axis, like {}", c.example_of_axis2(axis));
            c.fault("HP0251", "axis", message).help(help);
        }
    }
}

impl ForceProperties for Bushing {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Points([self.from, self.to]),
            axes: [self.axis, self.axis2],
            dimension: Dimension::FORCE,
            given: number::each(&[self.preload_x, self.preload_y, self.preload_z], |n| n.map(|n| n.0)),
            table: None,
            law: None,
            is_arithmetic: self.law().is_arithmetic(),
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
        c.check_axes([self.axis, self.axis2]);
        self.check_across(c);
        c.check_stiffness(&self.law(), StiffnessRule::NotNegative);
        c.check_curves(&self.law());
    }
}

impl ForceFormula for Bushing {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let push = self.wrench(at, e);
        out[at.body(self.to)] -= push;
        out[at.body(self.from)] += push;
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        self.wrench(at, e).f.norm()
    }

    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, mut each: impl FnMut(T, T)) {
        let opening = at.opening_between(e, [self.from, self.to]);
        let law = self.law();
        for (k, of) in law.directions.iter().enumerate() {
            let [_, stiffness] = at.elastic_resistance(opening.coordinates[k], of);
            each(opening.coordinates[k], stiffness);
        }
        for StiffnessEntry { row, column, value } in law.coupled.iter().flat_map(|matrix| &matrix.entries) {
            let ([a, b], k) = (number::both([*row, *column], |k| opening.coordinates[k]), at.number(*value));
            if row == column {
                each(a, k);
            } else {
                // 2 k a b = k (a + b)^2 - k a^2 - k b^2
                each(a + b, k);
                each(a, -k);
                each(b, -k);
            }
        }
    }
}
