//! Spring and damper between two points.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Compliance, ForceProperties, Properties, Spring};
use crate::model::{Dimension, ElementId, Model, SpringTable};
use crate::space::{Real, Wrench};

impl Spring {
    /// Table, if the spring has one: tension over deflection.
    fn table(&self) -> Option<&SpringTable> {
        self.named_table().map(|(_, table)| table)
    }

    /// The table after its key in model files.
    fn named_table(&self) -> Option<(&'static str, &SpringTable)> {
        let compression = || Some(("compression", self.compression.as_ref()?));
        self.extension.as_ref().map(|table| ("extension", table)).or_else(compression)
    }

    /// Length in the design configuration, which depends on the design.
    fn design_length<T: Real>(&self, at: &AppliedLoads<'_, T>) -> T {
        (at.design_position(self.to) - at.design_position(self.from)).norm()
    }

    /// Deflection of the spring at a length.
    fn deflection<T: Real>(&self, at: &AppliedLoads<'_, T>, length: T) -> T {
        length - self.free_length.map_or_else(|| self.design_length(at), |free| at.number(free.0))
    }

    /// Tension from the deflection, and its derivative by the length.
    fn pull<T: Real>(&self, at: &AppliedLoads<'_, T>, length: T) -> [T; 2] {
        let way = self.deflection(at, length);
        let stiffness = at.or_zero(self.stiffness.map(|n| n.0));
        let (mut pull, mut slope) = (stiffness * way, stiffness);
        if let Some(cubic) = self.cubic {
            let cubic = at.number(cubic.0) * way * way;
            // ds/dL = k + 3 k_3 (L - L_o)^2 + f T'(L - L_o)
            (pull, slope) = (pull + cubic * way, slope + cubic * T::constant(3.0));
        }
        if let Some(table) = self.table() {
            let [force, by_way] = at.scaled(table, self.scale.map(|n| n.0), way);
            (pull, slope) = (pull + force, slope + by_way);
        }
        [pull, slope]
    }
}

impl ForceProperties for Spring {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Line([self.from, self.to]),
            axes: [None; 2],
            dimension: Dimension::FORCE,
            given: [self.preload.map(|n| n.0), None, None],
            table: self.named_table(),
            law: None,
            is_arithmetic: self.table().is_none(),
            compliance: Compliance::Element,
            friction: None,
        }
    }
}

impl CheckElement for Spring {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        let Self { from, to, stiffness, compression, extension, scale, free_length, preload, .. } = self;
        if c.body_of(*from) == c.body_of(*to) {
            let message = format!("both ends of `{}` are on the same body, where it has no effect", c.name);
            c.fault("HP0251", "to", message)
                .help("put its ends on two different bodies; `ground` is also a body");
        } else if c.coincide(*from, *to) {
            let message = format!("the ends of `{}` coincide", c.name);
            c.fault("HP0251", "to", message)
                .note("a spring of zero length has no direction")
                .help("move its ends apart, or use a `bushing`");
        }
        if compression.is_some() && extension.is_some() {
            let message = format!("`{}` has both `compression` and `extension`", c.name);
            c.fault("HP0251", "extension", message)
                .note("compression is negative extension, and a compressive force is a negative tension")
                .help("combine the two tables in one");
        }
        let has_table = self.table().is_some();
        if scale.is_some() && !has_table {
            let message = format!("`{}` has a `scale`, but no table", c.name);
            c.fault("HP0251", "scale", message).help("remove `scale`, or change its `stiffness`");
        }
        if stiffness.is_none() && !has_table {
            let message = format!("`{}` has neither a stiffness nor a table", c.name);
            c.fault("HP0251", "type", message).help(
                "give its `stiffness`, or its force over its deflection as `compression` or `extension`",
            );
        } else if preload.is_some() && has_table {
            let message = format!("`{}` has both a table and a `preload`", c.name);
            c.fault("HP0251", "preload", message)
                .note("without a `free_length` the deflection counts from the design configuration, and the table's force at 0 acts there")
                .help("remove `preload` and shift the table by it, or give the `free_length`");
        } else if free_length.is_some() && preload.is_some() {
            let message = format!("`{}` has both a `free_length` and a `preload`", c.name);
            c.fault("HP0251", "preload", message)
                .help("remove one of the two: each follows from the other and the stiffness");
        }
    }
}

impl ForceFormula for Spring {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let [from, to] = [self.from, self.to];
        let (p, q) = (at.point(from), at.point(to));
        let d = q - p;
        // s pulls both ends along the line between them                                                         (44)
        let pull = d * (self.size(at, e) / at.apart(d));
        out[at.body(to)] += Wrench::force(pull, q);
        out[at.body(from)] -= Wrench::force(pull, q);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId) -> T {
        let [from, to] = [self.from, self.to];
        let (p, q) = (at.point(from), at.point(to));
        let d = q - p;
        // s = p + k (L - L_o) + k_3 (L - L_o)^3 + f T(L - L_o) + c L.
        let pull = at.grown(self.pull(at, d.norm())[0], || self.pull(at, self.design_length(at))[0]);
        let mut tension = pull + at.preload(self.preload.map(|n| n.0));
        if let Some(damping) = self.damping {
            let velocity = at.bodies[at.body(to)].velocity(q) - at.bodies[at.body(from)].velocity(p);
            tension += at.number(damping.0) * (d.dot(velocity) / at.apart(d));
        }
        tension
    }

    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId, mut each: impl FnMut(T, T)) {
        let length = at.apart(at.point(self.to) - at.point(self.from));
        each(length, self.pull(at, length)[1]);
    }

    fn table_deflection<T: Real>(&self, at: &AppliedLoads<'_, T>, _: ElementId) -> Option<T> {
        let length = (at.point(self.to) - at.point(self.from)).norm();
        Some(self.deflection(at, length))
    }
}
