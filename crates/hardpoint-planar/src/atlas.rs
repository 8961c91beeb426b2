//! Atlas of coupler curves, and the retrieval of those that resemble a path.
//!
//! The linkages are low-discrepancy samples of their ratios; each curve is evaluated in closed form. A piece of a curve
//! and a path are compared by their shape descriptors: 16 points w_j at equal arc lengths with mean 0 and norm 1. The
//! similarity `|sum conj(t_j) w_j|` does not depend on position, rotation and size, and is 1 for equal shapes; for all
//! Fourier descriptors of both it is the same number (Parseval).

use std::f64::consts::TAU;

use sobol_burley::sample;

use crate::linkage::{Guide, Linkage};
use crate::plane::Complex;

/// Number of linkages of each type that are sampled; about two thirds assemble.
const SAMPLED: u32 = 3000;
/// Crank positions of a curve over its range.
const STEPS: usize = 72;
/// Points of a descriptor.
pub const POINTS: usize = 16;
/// Part of an arc's half that is left out at its ends, which are dead points.
const MARGIN: f64 = 0.01;
/// Pieces of a curve begin at every sixth crank position and have these numbers of steps.
const EVERY: usize = 6;
const PIECES: [usize; 8] = [9, 18, 27, 36, 45, 54, 63, 72];

/// A shape: points at equal arc lengths, with mean 0 and norm 1.
pub type Shape = [Complex; POINTS];

/// A path with its arc lengths.
#[derive(Clone, Debug)]
pub struct Trace {
    points: Vec<Complex>,
    lengths: Vec<f64>,
}

impl Trace {
    /// Trace of a sequence of points.
    pub fn of(points: Vec<Complex>) -> Self {
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
        }
        Self { points, lengths }
    }

    /// Index of a place as a fractional number, between `first` and `last`, by its part of the arc length there.
    pub fn place(&self, [first, last]: [usize; 2], part: f64) -> f64 {
        let length = self.lengths[first] + part * (self.lengths[last] - self.lengths[first]);
        let k = first + self.lengths[first..=last].partition_point(|l| *l <= length).clamp(1, last - first);
        let step = self.lengths[k] - self.lengths[k - 1];
        let within = if step > 0.0 { (length - self.lengths[k - 1]) / step } else { 0.0 };
        (k - 1) as f64 + within.clamp(0.0, 1.0)
    }

    /// Part of the whole arc length at a point.
    pub fn part(&self, k: usize) -> f64 {
        self.lengths[k] / self.lengths[self.lengths.len() - 1]
    }

    /// Shape of a piece; `None` if it has no length.
    pub fn shape(&self, piece: [usize; 2], is_closed: bool) -> Option<Shape> {
        let intervals = if is_closed { POINTS } else { POINTS - 1 };
        let mut all = [Complex::ZERO; POINTS];
        for (j, at) in all.iter_mut().enumerate() {
            let place = self.place(piece, j as f64 / intervals as f64);
            let k = (place as usize).min(self.points.len() - 2);
            let [a, b] = [self.points[k], self.points[k + 1]];
            *at = a + (b - a).times(place - k as f64);
        }
        normalized(all)
    }
}

/// Points with mean 0 and norm 1; `None` if they coincide.
fn normalized<const N: usize>(all: [Complex; N]) -> Option<[Complex; N]> {
    let mean = all.iter().fold(Complex::ZERO, |sum, p| sum + *p).times(1.0 / N as f64);
    let all = all.map(|p| p - mean);
    let norm = all.iter().map(|p| p.square()).sum::<f64>().sqrt();
    (norm > f64::MIN_POSITIVE).then(|| all.map(|p| p.times(1.0 / norm)))
}

/// A linkage that resembles the path.
#[derive(Clone, Debug)]
pub struct Resemblance {
    /// 1 for equal shapes.
    pub similarity: f64,
    /// The linkage in the task, in the configuration of the first point.
    pub linkage: Linkage,
    /// Turns of the crank at the points, rad.
    pub turns: Vec<f64>,
}

/// The path to be matched.
pub struct Target<'a> {
    /// Points of the path.
    pub points: &'a [Complex],
    /// A smooth curve through the points.
    pub trace: Trace,
    /// Part of its length at each point.
    pub parts: Vec<f64>,
    /// True if it returns to its first point.
    pub is_closed: bool,
    /// Turns of the crank since the first point, if they are prescribed, rad.
    pub turns: Option<&'a [f64]>,
}

/// Types of linkages in the atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtlasType {
    /// Four-bars.
    FourBar,
    /// Slider-cranks.
    SliderCrank,
}

/// Linkage of the atlas with a number; `None` if no linkage has these ratios.
fn linkage(of: AtlasType, number: u32) -> Option<(Linkage, [f64; 2])> {
    let at = |d: u32, low: f64, high: f64| low + (high - low) * f64::from(sample(number, d, 7));
    let ratio = |d: u32, low: f64, high: f64| 10_f64.powf(at(d, low, high));
    let crank = ratio(0, -1.0, 0.3);
    let (coupler, middle) = match of {
        AtlasType::FourBar => {
            let [coupler, rocker] = [ratio(1, -0.6, 0.6), ratio(2, -0.6, 0.6)];
            // A configuration from the range of f = |BD| that the crank reaches and the other two links close
            let low = (1.0 - crank).abs().max((coupler - rocker).abs());
            let high = (1.0 + crank).min(coupler + rocker);
            if !(low < high) {
                return None;
            }
            let f = 0.5 * (low + high);
            let psi = ((1.0 + crank * crank - f * f) / (2.0 * crank)).clamp(-1.0, 1.0).acos();
            let b = Complex::<f64>::unit(psi).times(crank);
            let d = Complex::new(1.0, 0.0);
            let u = (coupler * coupler + f * f - rocker * rocker) / (2.0 * f * f);
            let v = (coupler * coupler / (f * f) - u * u).max(0.0).sqrt();
            let c = b + (d - b) * Complex::new(u, v);
            (coupler, Linkage { a: Complex::ZERO, b, c, guide: Guide::Rocker(d), p: b })
        }
        AtlasType::SliderCrank => {
            let height = at(1, -1.0, 1.0);
            let b_height = height.clamp(-0.9 * crank, 0.9 * crank);
            let b = Complex::new((crank * crank - b_height * b_height).sqrt(), b_height);
            let rise = height - b_height;
            if !(rise.abs() < 1.0) {
                return None;
            }
            let c = b + Complex::new((1.0 - rise * rise).sqrt(), rise);
            (1.0, Linkage { a: Complex::ZERO, b, c, guide: Guide::Slider(Complex::new(1.0, 0.0)), p: b })
        }
    };
    debug_assert!(((middle.c - middle.b).norm() - coupler).abs() < 1e-9 * coupler);
    let q = Complex::new(at(3, -1.0, 2.0), at(4, -1.5, 1.5));
    let whole = Linkage { p: middle.b + (middle.c - middle.b) * q, ..middle };
    match whole.arcs() {
        None => Some((whole, [0.0, TAU])),
        Some(arcs) => {
            let [low, high] = arcs.into_iter().find(|[low, high]| *low < 0.0 && 0.0 < *high)?;
            let cut = MARGIN * (high - low);
            Some((whole, [low + cut, high - cut]))
        }
    }
}

/// The linkages of the atlas that resemble a path most, best first, one piece of each curve.
pub fn resembling(
    target: &Target<'_>,
    of: AtlasType,
    most: usize,
    more: &(dyn Fn() -> bool + Sync),
) -> Vec<Resemblance> {
    let whole = [0, target.trace.points.len() - 1];
    let Some(shape) = target.trace.shape(whole, target.is_closed) else { return Vec::new() };
    let mut found: Vec<Resemblance> = Vec::new();
    for number in 0..SAMPLED {
        if number % 64 == 0 && !more() {
            return found;
        }
        let Some((linkage, range)) = linkage(of, number) else { continue };
        let best = match target.turns {
            Some(turns) => best_timed(target.points, turns, &linkage, range),
            None => best_piece(target, &shape, &linkage, range),
        };
        found.extend(best);
    }
    found.sort_by(|a, b| b.similarity.total_cmp(&a.similarity));
    found.truncate(most);
    found
}

/// A match of two sequences of points: the second becomes the first, turned and scaled, and mirrored before.
#[derive(Clone, Copy)]
struct Alignment {
    similarity: f64,
    is_mirrored: bool,
    is_reversed: bool,
}

/// The piece of a curve that resembles the shape most.
fn best_piece(
    target: &Target<'_>,
    shape: &Shape,
    linkage: &Linkage,
    [from, to]: [f64; 2],
) -> Option<Resemblance> {
    let is_full = linkage.arcs().is_none();
    let turn = |k: f64| from + (to - from) * k / STEPS as f64;
    // Twice around, so that pieces of a full turn may begin anywhere.
    let count = if is_full { 2 * STEPS } else { STEPS };
    let once: Vec<Complex> = (0..=STEPS).map(|k| linkage.point(turn(k as f64))).collect();
    if !once.iter().all(|p| p.is_finite()) {
        return None;
    }
    let curve = Trace::of((0..=count).map(|k| once[if k > STEPS { k - STEPS } else { k }]).collect());
    let pieces: &[usize] = match (target.is_closed, is_full) {
        (true, true) => &[STEPS],
        (true, false) => &[],
        (false, _) => &PIECES,
    };
    let mut best: Option<(Alignment, [usize; 2])> = None;
    for length in pieces {
        let last = if is_full { STEPS - 1 } else { STEPS - length };
        for start in (0..=last).step_by(if target.is_closed { EVERY / 2 } else { EVERY }) {
            let piece = [start, start + length];
            let Some(own) = curve.shape(piece, target.is_closed) else { continue };
            let alignment = aligned(shape, &own, target.is_closed);
            if best.as_ref().is_none_or(|(b, _)| alignment.similarity > b.similarity) {
                best = Some((alignment, piece));
            }
        }
    }
    let (alignment, piece) = best?;
    let parts = target.parts.iter().map(|part| if alignment.is_reversed { 1.0 - part } else { *part });
    let turns: Vec<f64> = parts.map(|part| turn(curve.place(piece, part))).collect();
    placed(target.points, linkage, &turns, alignment.is_mirrored, alignment.similarity)
}

/// The start of prescribed turns at which the points of a curve resemble the path most.
fn best_timed(
    points: &[Complex],
    given: &[f64],
    linkage: &Linkage,
    [from, to]: [f64; 2],
) -> Option<Resemblance> {
    let is_full = linkage.arcs().is_none();
    let mean = |all: &[Complex]| all.iter().fold(Complex::ZERO, |s, p| s + *p).times(1.0 / all.len() as f64);
    let similarity = |own: &[Complex], is_mirrored: bool| {
        let (m, n) = (mean(points), mean(own));
        let mut sum = [Complex::ZERO, Complex::ZERO];
        let mut squares = [0.0, 0.0];
        for (t, w) in points.iter().zip(own) {
            let (t, w) = (*t - m, *w - n);
            let w = if is_mirrored { w.conjugate() } else { w };
            sum[0] = sum[0] + t.conjugate() * w;
            squares[0] += t.square();
            squares[1] += w.square();
        }
        sum[0].norm() / (squares[0] * squares[1]).sqrt()
    };
    let mut best: Option<(f64, bool, Vec<f64>)> = None;
    for k in 0..STEPS {
        let start = from + (to - from) * k as f64 / STEPS as f64;
        // A mirrored linkage turns the other way.
        for is_mirrored in [false, true] {
            let direction = if is_mirrored { -1.0 } else { 1.0 };
            let turns: Vec<f64> = given.iter().map(|t| start + direction * t).collect();
            if !is_full && !turns.iter().all(|t| from <= *t && *t <= to) {
                continue;
            }
            let own: Vec<Complex> = turns.iter().map(|t| linkage.point(*t)).collect();
            let similar = similarity(&own, is_mirrored);
            if similar.is_finite() && best.as_ref().is_none_or(|b| similar > b.0) {
                best = Some((similar, is_mirrored, turns));
            }
        }
    }
    let (similar, is_mirrored, turns) = best?;
    placed(points, linkage, &turns, is_mirrored, similar)
}

/// Best alignment of two shapes: as they are, mirrored, and with the path in the other direction.
fn aligned(target: &Shape, own: &Shape, is_closed: bool) -> Alignment {
    let mut best = Alignment { similarity: -1.0, is_mirrored: false, is_reversed: false };
    for is_reversed in [false, true] {
        let mut sums = [Complex::ZERO; 2];
        for (j, w) in own.iter().enumerate() {
            let from_start = if is_closed { (POINTS - j) % POINTS } else { POINTS - 1 - j };
            let t = target[if is_reversed { from_start } else { j }];
            sums[0] = sums[0] + t.conjugate() * *w;
            sums[1] = sums[1] + t * *w;
        }
        for (is_mirrored, sum) in [(false, sums[0]), (true, sums[1])] {
            let similarity = sum.norm();
            if similarity > best.similarity {
                best = Alignment { similarity, is_mirrored, is_reversed };
            }
        }
    }
    best
}

/// The linkage moved so that its points at the turns are near those of the path, in the configuration of the first.
fn placed(
    points: &[Complex],
    linkage: &Linkage,
    turns: &[f64],
    is_mirrored: bool,
    similarity: f64,
) -> Option<Resemblance> {
    let mirror = |z: Complex| if is_mirrored { z.conjugate() } else { z };
    let at = linkage.displacement(turns[0]);
    let moved = Linkage {
        a: mirror(linkage.a),
        b: mirror(at.of(linkage.b)),
        c: mirror(at.of(linkage.c)),
        guide: match linkage.guide {
            Guide::Rocker(d) => Guide::Rocker(mirror(d)),
            Guide::Slider(along) => Guide::Slider(mirror(along)),
        },
        p: mirror(at.of(linkage.p)),
    };
    let turns: Vec<f64> =
        turns.iter().map(|t| (t - turns[0]) * if is_mirrored { -1.0 } else { 1.0 }).collect();
    let own: Vec<Complex> = turns.iter().map(|t| moved.point(*t)).collect();
    // points ~ factor own + shift by least squares
    let mean = |all: &[Complex]| all.iter().fold(Complex::ZERO, |s, p| s + *p).times(1.0 / all.len() as f64);
    let (m, n) = (mean(points), mean(&own));
    let (mut sum, mut square) = (Complex::ZERO, 0.0);
    for (t, w) in points.iter().zip(&own) {
        sum = sum + (*w - n).conjugate() * (*t - m);
        square += (*w - n).square();
    }
    let factor = sum.times(1.0 / square);
    let length = factor.norm();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let unit = factor.times(1.0 / length);
    let linkage = moved.moved(|z| factor * (z - n) + m, |n| unit * n);
    Some(Resemblance { similarity, linkage, turns })
}

/// A smooth curve through points: centripetal Catmull-Rom pieces of `DENSE` steps. Returns it with the index of each
/// point.
pub fn smooth(points: &[Complex], is_closed: bool) -> (Vec<Complex>, Vec<usize>) {
    const DENSE: usize = 8;
    let n = points.len() as isize;
    let at = |k: isize| {
        if is_closed {
            return points[k.rem_euclid(n) as usize];
        }
        match k {
            // Beyond the ends the path goes on as it came.
            -1 => points[0].times(2.0) - points[1],
            k if k == n => points[n as usize - 1].times(2.0) - points[n as usize - 2],
            k => points[k as usize],
        }
    };
    let mut curve = Vec::new();
    let mut places = Vec::new();
    let pieces = if is_closed { n } else { n - 1 };
    for k in 0..pieces {
        places.push(curve.len());
        let p = [k - 1, k, k + 1, k + 2].map(at);
        let knot = |a: Complex, b: Complex| (b - a).norm().sqrt().max(1e-12);
        let t1 = knot(p[0], p[1]);
        let t2 = t1 + knot(p[1], p[2]);
        let t3 = t2 + knot(p[2], p[3]);
        for j in 0..DENSE {
            let t = t1 + (t2 - t1) * j as f64 / DENSE as f64;
            let mix = |a: Complex, b: Complex, s: f64, e: f64| {
                a.times((e - t) / (e - s)) + b.times((t - s) / (e - s))
            };
            let a = [mix(p[0], p[1], 0.0, t1), mix(p[1], p[2], t1, t2), mix(p[2], p[3], t2, t3)];
            let b = [mix(a[0], a[1], 0.0, t2), mix(a[1], a[2], t1, t3)];
            curve.push(mix(b[0], b[1], t1, t2));
        }
    }
    if is_closed {
        curve.push(points[0]);
    } else {
        places.push(curve.len());
        curve.push(points[n as usize - 1]);
    }
    (curve, places)
}
