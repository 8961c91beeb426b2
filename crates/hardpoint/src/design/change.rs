//! Effects of the kinds of changes on a design, over any number type.

use crate::model::Model;
use crate::model::change::{self, Change, changes};
use crate::number::{self, Real};
use crate::space::{Pose, Vec3, rotation_from_euler_313};

/// Effect of a kind of change on the design, for a value b of its variable. The default methods have no effect.
pub(crate) trait Effect {
    /// Returns the rate of the rotation vector of marker e of the joint, global, rad per unit; zero if it does not
    /// turn. Those of all changes of a marker add up.
    fn rotation(&self, _e: usize) -> Vec3 {
        Vec3::ZERO
    }

    /// Returns marker e of that joint in the design configuration, global; `marker` is its pose without this change,
    /// but turned by its rotation.
    #[inline(always)]
    fn marker<T: Real>(&self, _model: &Model, marker: Pose<T>, _e: usize, _b: T) -> Pose<T> {
        marker
    }

    /// Returns the given length of that joint, m; `length` is its value without this change.
    #[inline(always)]
    fn length<T: Real>(&self, length: T, _b: T) -> T {
        length
    }
}

impl Effect for change::Move {}

impl Effect for change::Marker {
    fn rotation(&self, e: usize) -> Vec3 {
        if self.end.covers(e) { self.rotation } else { Vec3::ZERO }
    }

    #[inline(always)]
    fn marker<T: Real>(&self, _: &Model, Pose { rot, r }: Pose<T>, e: usize, b: T) -> Pose<T> {
        // P = P_o + b V                                                                                     (paper 3.1)
        let r = if self.end.covers(e) { self.position.spread().times_plus(b, r) } else { r };
        Pose { rot, r }
    }
}

impl Effect for change::Length {
    #[inline(always)]
    fn length<T: Real>(&self, length: T, b: T) -> T {
        b.times_plus(T::constant(self.rate), length)
    }
}

impl Effect for change::Parameter {}

impl Effect for change::Law {}

impl Effect for change::Field {
    #[inline(always)]
    fn marker<T: Real>(&self, model: &Model, marker: Pose<T>, e: usize, b: T) -> Pose<T> {
        let joint = &model.joints[self.joint.0];
        if joint.bodies[e] != self.body {
            return marker;
        }
        // (paper 3.1, 2.2): P = P_o + A (b V); the axes turn by R = C(theta_o + b U) C(theta_o)^-1 in the body's frame,
        // A R A^T in global axes
        let body = model.bodies[self.body.0].frame.rot.spread();
        let (theta, c) = model.euler_of(joint, e);
        let turned =
            number::each(&[0, 1, 2], |n| T::constant(self.u[n]).times_plus(b, T::constant(theta[n])));
        let turned = rotation_from_euler_313(turned) * c.transpose().spread();
        Pose { rot: body * turned * body.transpose() * marker.rot, r: marker.r + body * self.v.spread() * b }
    }
}

/// Delegates to the kind of the change.
macro_rules! in_designs {
    ($(
        $(#[doc = $doc:literal])* $kind:ident { $($fields:tt)* }
        |$known:pat_param| $quantity:expr, $target:expr, |$words:pat_param| $says:expr;
    )*) => {
        impl Effect for Change {
            fn rotation(&self, e: usize) -> Vec3 {
                match self { $(Self::$kind(change) => change.rotation(e)),* }
            }

            #[inline(always)]
            fn marker<T: Real>(&self, model: &Model, marker: Pose<T>, e: usize, b: T) -> Pose<T> {
                match self { $(Self::$kind(change) => change.marker(model, marker, e, b)),* }
            }

            #[inline(always)]
            fn length<T: Real>(&self, length: T, b: T) -> T {
                match self { $(Self::$kind(change) => change.length(length, b)),* }
            }
        }
    };
}

changes!(in_designs);
