//! Task of a synthesis: an aim, types of linkages, and regions of their joints.

use hardpoint_planar::linkage::{Guide, Linkage};
use hardpoint_planar::plane::{Complex, Pose};

/// A task of synthesis.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Poses or path.
    pub aim: Aim,
    /// True if four-bars are looked for.
    pub four_bars: bool,
    /// True if slider-cranks are looked for.
    pub slider_cranks: bool,
    /// Region of the fixed pivots.
    pub fixed_region: Option<Region>,
    /// Region of the pins on the body, in its first pose.
    pub moving_region: Option<Region>,
    /// Fixed pivots of cranks, if they are given: for three poses.
    pub fixed_pivots: Vec<Complex>,
    /// True if the crank must turn fully.
    pub full_turn: bool,
    /// True if the poses may be passed in any order.
    pub any_order: bool,
    /// Distance up to which a point of a path counts as met, m: linkages that come nearer are not better.
    pub tolerance: f64,
    /// Maximum number of answers.
    pub answers: usize,
}

impl Task {
    /// Task without restrictions.
    pub fn new(aim: Aim) -> Self {
        Self {
            aim,
            four_bars: true,
            slider_cranks: true,
            fixed_region: None,
            moving_region: None,
            fixed_pivots: Vec::new(),
            full_turn: false,
            any_order: false,
            tolerance: 0.0,
            answers: 10,
        }
    }

    /// True if the joints of a linkage are inside the regions.
    pub(super) fn has_inside(&self, linkage: &Linkage) -> bool {
        let fixed = |p: Complex| self.fixed_region.is_none_or(|r| r.has(p));
        let moving = |p: Complex| self.moving_region.is_none_or(|r| r.has(p));
        let other = match linkage.guide {
            Guide::Rocker(d) => fixed(d),
            Guide::Slider(_) => true,
        };
        fixed(linkage.a) && other && moving(linkage.b) && moving(linkage.c)
    }
}

/// Aim of a synthesis.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// Three to five poses of a body.
    Poses(Vec<Pose>),
    /// Points of a path of a point.
    Path {
        /// The points in order, m.
        points: Vec<Complex>,
        /// True if the path returns to its first point.
        is_closed: bool,
        /// Turns of the crank since the first point, rad, if they are prescribed.
        turns: Option<Vec<f64>>,
    },
}

/// A rectangle, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Range of x.
    pub x: [f64; 2],
    /// Range of y.
    pub y: [f64; 2],
}

impl Region {
    pub(super) fn has(&self, p: Complex) -> bool {
        let within = |[low, high]: [f64; 2], x: f64| low <= x && x <= high;
        within(self.x, p.x) && within(self.y, p.y)
    }

    pub(super) fn corners(&self) -> [Complex; 4] {
        let [[left, right], [low, high]] = [self.x, self.y];
        [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Complex::new(x, y))
    }

    pub(super) fn middle(&self) -> Complex {
        let [x, y] = [self.x, self.y].map(|[low, high]| 0.5 * (low + high));
        Complex::new(x, y)
    }
}

/// Reason why a task has no synthesis.
#[derive(Clone, Debug, PartialEq)]
pub enum TaskError {
    /// Fewer than three poses or points, or more than five poses.
    Count(usize),
    /// Two poses or neighbouring points coincide, by their numbers from 0.
    Coincide([usize; 2]),
    /// The orientation is the same in all poses.
    Translation,
    /// All poses turn about this one point.
    OnePole(Complex),
    /// All points of the path lie on a line.
    Line,
    /// A number of prescribed turns other than that of the points.
    Turns(usize),
    /// Prescribed turns do not go on in one direction within a turn, by the number from 0.
    TurnOrder(usize),
    /// Fixed pivots for a number of poses other than three.
    FixedPivots,
    /// Two given fixed pivots coincide, by their numbers from 0.
    SamePivots([usize; 2]),
    /// No type of linkage is selected.
    NoType,
}
