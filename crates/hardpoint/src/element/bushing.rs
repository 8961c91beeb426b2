//! Bushing: springs and dampers between two bodies at a place.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, Bushing, Compliance, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Model};
use crate::space::{Mat3, Real, Vec3, Wrench};

impl Bushing {
    /// Wrench on body j.
    fn wrench<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Wrench<T> {
        let (i, j) = (at.body(self.from), at.body(self.to));
        let (p, q, axes) = (at.point(self.from), at.point(self.to), at.turned(i));
        let way = axes.transpose_mul(q - p);
        let [x, y, z] = [self.x, self.y, self.z].map(|n| at.number(n.0));
        // F = -Q K Q^T (P_j - P_i) - c v,  v of P_j as seen from i                                             (44)
        let mut force = -(axes * Vec3::new(x * way.x, y * way.y, z * way.z));
        if let Some(damping) = self.damping {
            let slip = at.bodies[j].velocity(q) - at.bodies[i].velocity(q);
            force -= slip * at.number(damping.0);
        }
        let mut push = Wrench::force(force, q);
        let about = [self.about_x, self.about_y, self.about_z];
        if about.iter().any(|n| n.is_some()) {
            let turned = rotation_vector(axes.transpose() * at.turned(j));
            let [x, y, z] = about.map(|n| at.or_zero(n.map(|n| n.0)));
            push += Wrench::moment(-(axes * Vec3::new(x * turned.x, y * turned.y, z * turned.z)));
        }
        push
    }
}

impl ForceProperties for Bushing {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Points([self.from, self.to]),
            dimension: Dimension::FORCE,
            given: [None; 3],
            table: None,
            law: None,
            // The turn is a series as long as it is small.
            is_arithmetic: [self.about_x, self.about_y, self.about_z].iter().all(|n| n.is_none()),
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
        let (p, q) = (at.point(self.from), at.point(self.to));
        let axes = at.turned(at.body(self.from));
        let way = axes.transpose_mul(q - p);
        let turn = rotation_vector(axes.transpose() * at.turned(at.body(self.to)));
        let slides = [self.x, self.y, self.z].map(|n| at.number(n.0));
        let turns = [self.about_x, self.about_y, self.about_z].map(|n| at.or_zero(n.map(|n| n.0)));
        for k in 0..3 {
            each(way[k], slides[k]);
            each(turn[k], turns[k]);
        }
    }
}

/// Square of the sine below which the series of the angle is accurate to round-off.
const SMALL: f64 = 1e-6;

/// Rotation vector of a rotation by less than half a turn: its axis times its angle, rad.
fn rotation_vector<T: Real>(rot: Mat3<T>) -> Vec3<T> {
    let [x, y, z] = rot.cols;
    let half = T::constant(0.5);
    // sin(theta) n and cos(theta)
    let sine = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) * half;
    let square = sine.dot(sine);
    if square.decisive() < SMALL {
        // theta / sin(theta) = 1 + s^2/6 + 3 s^4/40
        let more = square * T::constant(3.0 / 40.0) + T::constant(1.0 / 6.0);
        sine * (square * more + T::one())
    } else {
        let cosine = (x.x + y.y + z.z - T::one()) * half;
        let size = sine.norm();
        sine * (size.atan2(cosine) / size)
    }
}
