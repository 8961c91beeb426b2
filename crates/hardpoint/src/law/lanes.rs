//! Several times side by side, for laws that are evaluated at many.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::jet::TimeJet;
use super::scalar::Arithmetic;
use crate::space::{LANES, Real};

/// Numbers side by side, one for every lane. Their sums, products and roots are those of `f64` to the last bit.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<R>(pub(super) R);

/// Up to this angle, in radians, [`Real::sin_cos`] is good to the last place.
const LARGEST_ANGLE: f64 = 1e5 * std::f64::consts::TAU;

impl<R: Real> Lanes<R> {
    /// The lanes as an array; what there is no lane for is zero.
    #[inline(always)]
    pub(super) fn to_array(self) -> [f64; LANES] {
        let mut lanes = [0.0; LANES];
        self.0.store(&mut lanes);
        lanes
    }

    /// What `f` makes of the index and the number of every lane.
    #[inline(always)]
    pub(super) fn map_lanes(self, mut f: impl FnMut(usize, f64) -> f64) -> Self {
        let lanes = self.to_array();
        Self(self.0.like_lanes(
            #[inline(always)]
            |lane| f(lane, lanes[lane]),
        ))
    }
}

impl<R: Real> Arithmetic for Lanes<R> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self(self.0.like(x))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let angles = self.to_array();
        // Not short-circuit: eight comparisons at once are faster than one after the other.
        if angles.iter().fold(true, |all, angle| all & (angle.abs() <= LARGEST_ANGLE)) {
            let (sin, cos) = self.0.sin_cos();
            return (Self(sin), Self(cos));
        }
        library_sin_cos(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// By repeated squaring, in the order in which `f64::powi` multiplies.
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        let mut power = self.like(1.0);
        let (mut square, mut left) = (self, exponent.unsigned_abs());
        loop {
            if left & 1 == 1 {
                power = power * square;
            }
            left >>= 1;
            if left == 0 {
                break;
            }
            square = square * square;
        }
        if exponent < 0 { self.like(1.0) / power } else { power }
    }
}

impl<R: Real> TimeJet<Lanes<R>> {
    /// The jet of one lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> TimeJet {
        let [f, d, dd, ddd] = self.derivatives();
        TimeJet::from_derivatives([f.0.lane(lane), d.0.lane(lane), dd.0.lane(lane), ddd.0.lane(lane)])
    }

    /// What has no value in any lane; `like` gives the lanes.
    #[inline(always)]
    pub(super) fn undefined_lanes(like: Lanes<R>) -> Self {
        Self::from_derivatives([like.like(f64::NAN); 4])
    }

    /// This jet, but `other` in the lanes that `is_other` says.
    #[inline(always)]
    pub(super) fn or_where(self, is_other: impl Fn(usize) -> bool, other: Self) -> Self {
        let ([f, d, dd, ddd], [g, g_d, g_dd, g_ddd]) = (self.derivatives(), other.derivatives());
        let choose = |f: Lanes<R>, g: Lanes<R>| {
            let g = g.to_array();
            f.map_lanes(|lane, f| if is_other(lane) { g[lane] } else { f })
        };
        Self::from_derivatives([choose(f, g), choose(d, g_d), choose(dd, g_dd), choose(ddd, g_ddd)])
    }
}

/// Sine and cosine by the standard library.
#[cold]
#[inline(never)]
fn library_sin_cos<R: Real>(angles: Lanes<R>) -> (Lanes<R>, Lanes<R>) {
    (angles.map_lanes(|_, angle| angle.sin()), angles.map_lanes(|_, angle| angle.cos()))
}

/// What `f` gives for every lane; `like` gives the lanes. For what is slow in every lane anyway.
pub(super) fn lane_by_lane<R: Real>(
    like: Lanes<R>,
    mut f: impl FnMut(usize) -> TimeJet,
) -> TimeJet<Lanes<R>> {
    let mut lanes = [[0.0; LANES]; 4];
    for lane in 0..R::LANES {
        for (lanes, derivative) in lanes.iter_mut().zip(f(lane).derivatives()) {
            lanes[lane] = derivative;
        }
    }
    like.0.within(
        #[inline(always)]
        || {
            let [f, d, dd, ddd] = lanes;
            let lanes = |from: [f64; LANES]| like.map_lanes(|lane, _| from[lane]);
            TimeJet::from_derivatives([lanes(f), lanes(d), lanes(dd), lanes(ddd)])
        },
    )
}

/// The operators, lane by lane.
macro_rules! lane_operators {
    ($($Operator:ident $operator:ident),*) => {$(
        impl<R: Real> $Operator for Lanes<R> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self($Operator::$operator(self.0, other.0))
            }
        }
    )*};
}

lane_operators!(Add add, Sub sub, Mul mul, Div div);

impl<R: Real> Add<f64> for Lanes<R> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + self.like(other)
    }
}

impl<R: Real> Mul<f64> for Lanes<R> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.like(factor)
    }
}

impl<R: Real> Neg for Lanes<R> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
