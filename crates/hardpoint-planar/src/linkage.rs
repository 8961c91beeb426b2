//! Four-bars and slider-cranks: positions in closed form, ranges, transmission angle and type.
//!
//! The crank turns about A and carries the pin B; the coupler joins B to C, which a rocker about D or a slider guides.
//! With a the crank's length, b the coupler's, c the rocker's, g the ground's, psi the crank's angle and mu the angle
//! at C between coupler and rocker (of a slider: between coupler and the normal of its line), theory (69):
//!
//! ```text
//! cos mu  =  p + q cos(psi - gamma)      rocker: p = (b^2 + c^2 - a^2 - g^2) / (2 b c),  q = a g / (b c)
//!                                        slider: p = e / b,  q = a / b,  e: height of A above the line
//! ```
//!
//! The linkage assembles where |cos mu| <= 1, its branch is the sign of sin mu, and its dead points are at sin mu = 0.

use std::f64::consts::{PI, TAU};

use hardpoint::number::Real;

use crate::dyads::Dyad;
use crate::plane::{Complex, Displacement};

/// The second dyad of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guide<T = f64> {
    /// A rocker about this pivot, m.
    Rocker(Complex<T>),
    /// A slider along a line through C with this unit direction.
    Slider(Complex<T>),
}

/// A four-bar or slider-crank, driven at A, in the configuration of the first pose or point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linkage<T = f64> {
    /// Fixed pivot of the crank, m.
    pub a: Complex<T>,
    /// Pin of crank and coupler, m.
    pub b: Complex<T>,
    /// Pin of coupler and rocker or slider, m.
    pub c: Complex<T>,
    /// The rocker or slider.
    pub guide: Guide<T>,
    /// Point of the coupler that is guided, m.
    pub p: Complex<T>,
}

/// Type of a linkage by the links that turn fully.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LinkageType {
    /// The crank turns fully, the rocker does not.
    CrankRocker,
    /// Crank and rocker both turn fully.
    DoubleCrank,
    /// The other side turns fully: the driven link rocks.
    RockerCrank,
    /// Both rock, and the coupler turns fully.
    GrashofDoubleRocker,
    /// No link turns fully against another.
    TripleRocker,
    /// A slider-crank whose crank turns fully.
    SliderCrank,
    /// A slider-crank whose crank rocks.
    SliderRocker,
}

impl LinkageType {
    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::CrankRocker => "crank-rocker",
            Self::DoubleCrank => "double-crank",
            Self::RockerCrank => "rocker-crank",
            Self::GrashofDoubleRocker => "double-rocker (Grashof)",
            Self::TripleRocker => "double-rocker",
            Self::SliderCrank => "slider-crank",
            Self::SliderRocker => "slider-crank with a rocking crank",
        }
    }
}

/// Lengths of the links, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// Distance of the fixed pivots; of a slider-crank the distance of A from the slider's line.
    pub ground: f64,
    /// Crank.
    pub crank: f64,
    /// Coupler from B to C.
    pub coupler: f64,
    /// Rocker, if there is one.
    pub rocker: Option<f64>,
}

impl<T: Real> Linkage<T> {
    /// Coupler displaced since the first configuration: `place` gives the displaced B and C for a crank's turn, rad.
    /// `NaN` where the linkage does not assemble.
    fn pins(&self, turn: T) -> [Complex<T>; 2] {
        let b = self.a + Complex::unit(turn) * (self.b - self.a);
        let coupler = (self.c - self.b).square();
        let c = match self.guide {
            Guide::Rocker(d) => {
                // C = B + f (u + i v),  u = (b^2 + f^2 - c^2) / (2 f^2),  v = +-sqrt(b^2 / f^2 - u^2)
                let f = d - b;
                let square = f.square();
                let u = (coupler + square - (self.c - d).square()) / (square + square);
                let v = (coupler / square - u * u).sqrt();
                let side = (d - self.b).cross(self.c - self.b).value().signum();
                b + f * Complex::new(u, v * side)
            }
            Guide::Slider(along) => {
                let height = along.cross(b - self.c);
                let side = along.dot(self.c - self.b).value().signum();
                let root = (coupler - height * height).sqrt() * side;
                b + along.times(root) - along.left().times(height)
            }
        };
        [b, c]
    }

    /// Place of the guided point for a turn of the crank, rad; `NaN` where the linkage does not assemble.
    pub fn point(&self, turn: T) -> Complex<T> {
        let [b, c] = self.pins(turn);
        b + (c - b) * (self.p - self.b).over(self.c - self.b)
    }
}

/// The crank's angles at which a linkage assembles, as cosines of its angle from gamma.
#[derive(Clone, Copy, Debug)]
struct Drive {
    /// Direction in which cos mu is largest, rad.
    gamma: f64,
    p: f64,
    q: f64,
}

impl Linkage {
    /// Linkage of two dyads, of which the first is a crank that drives; `p` is the guided point.
    pub fn of(crank: &Dyad, other: &Dyad, p: Complex) -> Option<Self> {
        let Dyad::Crank { pivot, pin } = *crank else { return None };
        let guide = match *other {
            Dyad::Crank { pivot, .. } => Guide::Rocker(pivot),
            Dyad::Slider { along, .. } => Guide::Slider(along),
        };
        Some(Self { a: pivot, b: pin, c: other.pin(), guide, p })
    }

    /// Displacement of the coupler since the first configuration for a turn of the crank, rad.
    pub fn displacement(&self, turn: f64) -> Displacement {
        let [b, c] = self.pins(turn);
        let by = (c - b).over(self.c - self.b);
        let turn = by.times(1.0 / by.norm());
        Displacement { turn, shift: b - turn * self.b }
    }

    /// The linkage after a similarity.
    pub fn moved(&self, by: impl Fn(Complex) -> Complex, turned: impl Fn(Complex) -> Complex) -> Self {
        let guide = match self.guide {
            Guide::Rocker(d) => Guide::Rocker(by(d)),
            Guide::Slider(along) => Guide::Slider(turned(along)),
        };
        Self { a: by(self.a), b: by(self.b), c: by(self.c), guide, p: by(self.p) }
    }

    /// Lengths of the links.
    pub fn lengths(&self) -> Lengths {
        let [ground, rocker] = match self.guide {
            Guide::Rocker(d) => [(d - self.a).norm(), (self.c - d).norm()],
            Guide::Slider(along) => [along.cross(self.a - self.c).abs(), f64::NAN],
        };
        Lengths {
            ground,
            crank: (self.b - self.a).norm(),
            coupler: (self.c - self.b).norm(),
            rocker: Some(rocker).filter(|r| !r.is_nan()),
        }
    }

    /// Points whose places define the linkage: A, B, C, and D if there is one.
    pub fn joints(&self) -> Vec<Complex> {
        let d = match self.guide {
            Guide::Rocker(d) => Some(d),
            Guide::Slider(_) => None,
        };
        [self.a, self.b, self.c].into_iter().chain(d).collect()
    }

    /// Largest distance between two of its joints and the guided point, m.
    pub fn extent(&self) -> f64 {
        let all: Vec<Complex> = self.joints().into_iter().chain([self.p]).collect();
        let from = |p: &Complex| all.iter().map(|q| (*p - *q).norm()).fold(0.0, f64::max);
        all.iter().map(from).fold(0.0, f64::max)
    }

    /// The same four-bar driven at its other side; `None` for a slider-crank.
    pub fn swapped(&self) -> Option<Self> {
        match self.guide {
            Guide::Rocker(d) => {
                Some(Self { a: d, b: self.c, c: self.b, guide: Guide::Rocker(self.a), p: self.p })
            }
            Guide::Slider(_) => None,
        }
    }

    /// The two other four-bars whose guided points have the same path (Roberts, Chebyshev), in the same configuration,
    /// with the displacements of their couplers; none for a slider-crank.
    ///
    /// With `k = (P - B) / (C - B)` the three fixed pivots A, D and `F = A + k (D - A)` form a triangle that is similar
    /// to the coupler. Over A the crank is `P - B`, the coupler turns as the crank did, and over D alike.
    pub fn cognates(&self, moves: &[Displacement]) -> Vec<(Self, Vec<Displacement>)> {
        let Some(swapped) = self.swapped() else { return Vec::new() };
        let over = |of: &Self| {
            let Guide::Rocker(d) = of.guide else { return None };
            let k = (of.p - of.b).over(of.c - of.b);
            let b = of.a + of.p - of.b;
            let c = b + k * (of.b - of.a);
            let cognate = Self { a: of.a, b, c, guide: Guide::Rocker(of.a + k * (d - of.a)), p: of.p };
            let moved = |m: &Displacement| {
                let turn = (m.of(of.b) - of.a).over(of.b - of.a);
                let turn = turn.times(1.0 / turn.norm());
                Displacement { turn, shift: m.of(of.p) - turn * of.p }
            };
            Some((cognate, moves.iter().map(moved).collect()))
        };
        [self, &swapped].into_iter().filter_map(over).collect()
    }

    fn drive(&self) -> Drive {
        let Lengths { crank: a, coupler: b, .. } = self.lengths();
        match self.guide {
            Guide::Rocker(d) => {
                let (g, c) = ((d - self.a).norm(), (self.c - d).norm());
                Drive {
                    gamma: (d - self.a).angle(),
                    p: (b * b + c * c - a * a - g * g) / (2.0 * b * c),
                    q: a * g / (b * c),
                }
            }
            Guide::Slider(along) => {
                Drive { gamma: along.left().angle(), p: along.cross(self.a - self.c) / b, q: a / b }
            }
        }
    }

    /// Sine of the angle at C, with the sign of the branch.
    pub fn branch(&self, [b, c]: [Complex; 2]) -> f64 {
        let coupler = c - b;
        let sine = match self.guide {
            Guide::Rocker(d) => coupler.cross(d - c) / (d - c).norm(),
            Guide::Slider(along) => coupler.dot(along),
        };
        sine / coupler.norm()
    }

    /// Type of the linkage.
    pub fn kind(&self) -> LinkageType {
        let of = self.lengths();
        let turns = matches!(self.drive().arcs()[..], [Arc::Full]);
        let Some(swapped) = self.swapped() else {
            return if turns { LinkageType::SliderCrank } else { LinkageType::SliderRocker };
        };
        let links = [of.ground, of.crank, of.coupler, of.rocker.unwrap_or(0.0)];
        let [least, most] =
            [links.iter().copied().fold(f64::INFINITY, f64::min), links.iter().copied().fold(0.0, f64::max)];
        let is_grashof = 2.0 * (least + most) < links.iter().sum();
        match (turns, matches!(swapped.drive().arcs()[..], [Arc::Full])) {
            (true, true) => LinkageType::DoubleCrank,
            (true, false) => LinkageType::CrankRocker,
            (false, true) => LinkageType::RockerCrank,
            (false, false) if is_grashof => LinkageType::GrashofDoubleRocker,
            (false, false) => LinkageType::TripleRocker,
        }
    }

    /// Arcs of the crank's turn since the first configuration over which the linkage assembles, rad; `None` if the
    /// crank turns fully.
    pub fn arcs(&self) -> Option<Vec<[f64; 2]>> {
        let drive = self.drive();
        let start = (self.b - self.a).angle() - drive.gamma;
        let from = |[low, high]: [f64; 2]| {
            // The arc around the start, or after it
            let middle = 0.5 * (low + high);
            let turns = ((start - middle) / TAU).round() * TAU;
            [low + turns - start, high + turns - start]
        };
        match &drive.arcs()[..] {
            [Arc::Full] => None,
            arcs => Some(
                arcs.iter()
                    .filter_map(|arc| if let Arc::Between(ends) = arc { Some(from(*ends)) } else { None })
                    .collect(),
            ),
        }
    }

    /// Minimum of the transmission angle over the crank's turns in a range, rad, from 0 to a quarter turn.
    pub fn transmission(&self, [from, to]: [f64; 2]) -> f64 {
        let drive = self.drive();
        let start = (self.b - self.a).angle() - drive.gamma;
        let [low, high] = [from.min(to) + start, from.max(to) + start];
        let first = (low / PI).ceil() as i64;
        let last = (high / PI).floor() as i64;
        let stationary = (first..=last).take(3).map(|k| k as f64 * PI);
        let cosine = |angle: f64| (drive.p + drive.q * angle.cos()).abs().min(1.0);
        let largest = [low, high].into_iter().chain(stationary).map(cosine).fold(0.0, f64::max);
        largest.acos()
    }
}

/// Angles from gamma at which a linkage assembles.
enum Arc {
    Full,
    Between([f64; 2]),
}

impl Drive {
    /// The arcs at which |p + q cos x| <= 1.
    fn arcs(&self) -> Vec<Arc> {
        let [low, high] = [(-1.0 - self.p) / self.q, (1.0 - self.p) / self.q];
        match (low <= -1.0, high >= 1.0) {
            _ if !(low <= 1.0 && high >= -1.0) => Vec::new(),
            (true, true) => vec![Arc::Full],
            (false, true) => vec![Arc::Between([-low.acos(), low.acos()])],
            (true, false) => vec![Arc::Between([high.acos(), TAU - high.acos()])],
            (false, false) => {
                vec![Arc::Between([high.acos(), low.acos()]), Arc::Between([-low.acos(), -high.acos()])]
            }
        }
    }
}
