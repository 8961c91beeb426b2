//! Points and directions fixed in a body, as jets.

use crate::motion::BodyState;
use crate::sensitivity::BodySensitivity;
use crate::space::{Jet, Vec3};

/// A body's state and its derivatives by one design variable.
#[derive(Clone, Copy, Debug)]
pub struct BodyJet<'a> {
    /// How it stands and moves.
    pub state: &'a BodyState,
    /// How that changes with the design.
    pub d: &'a BodySensitivity,
}

impl BodyJet<'_> {
    /// The direction `e` of the body's frame, in global components; the design turns it in the body at
    /// rate `de`.
    #[inline]
    pub fn direction(&self, e: Vec3, de: Vec3) -> Vec3<Jet> {
        let (s, d) = (self.state, self.d);
        let e0 = s.rotation * e;
        let e1 = s.omega.cross(e0);
        let e2 = s.alpha.cross(e0) + s.omega.cross(e1);
        let b0 = d.dpi.cross(e0) + s.rotation * de;
        let b1 = d.domega.cross(e0) + s.omega.cross(b0);
        let b2 = d.dalpha.cross(e0) + s.alpha.cross(b0) + d.domega.cross(e1) + s.omega.cross(b1);
        Vec3::from_derivatives([[e0, e1, e2], [b0, b1, b2]])
    }

    /// The point `s` of the body's frame, in global components; the design moves it in the body at
    /// velocity `ds`.
    #[inline]
    pub fn point(&self, s: Vec3, ds: Vec3) -> Vec3<Jet> {
        let (state, d) = (self.state, self.d);
        let origin = Vec3::from_derivatives([[state.r, state.v, state.a], [d.dr, d.dv, d.da]]);
        origin + self.direction(s, ds)
    }
}
