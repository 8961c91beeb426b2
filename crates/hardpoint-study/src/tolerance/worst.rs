//! Worst case: every deviation anywhere within its reach, regardless of its probability.

use super::deviations::{Block, Deviations};
use hardpoint_search::dot;

/// Maximum number of ascent rounds over all tolerances; most ascents end after two or three.
const ROUNDS: usize = 50;
/// Number of direction updates of a sphere in each round.
const TURNS: usize = 10;
/// Relative gain below which the difference is round-off.
const NO_MORE: f64 = 1e-12;

/// Minimum or maximum within the tolerances, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// First-order value: `nominal +- sum over tolerances of reach * |gradient|`.
    pub first: f64,
    /// Second-order value, if second derivatives are known: extreme of the quadratic, found by ascent from the
    /// first-order extreme and its neighbours.
    pub second: Option<f64>,
    /// Deviations at the worst case, per toleranced variable: those of the exact metric if it is known, otherwise to
    /// second or to first order.
    pub deviations: Vec<f64>,
    /// Exact metric of the design at the worst case.
    pub exact: Option<f64>,
    /// Reason why the exact metric is missing, if the design does not reach the end.
    pub why: Option<String>,
}

/// Extreme of a function with a gradient and optional second derivatives: the maximum for `sign` 1, the minimum for -1.
pub(super) fn extreme(of: &Deviations, value: f64, g: &[f64], h: Option<&[Vec<f64>]>, sign: f64) -> Extreme {
    let g: Vec<f64> = g.iter().map(|g| sign * g).collect();
    let corner = corner(of, &g, sign);
    let first = value + sign * dot(&g, &corner);
    let Some(h) = h else {
        return Extreme { first, second: None, deviations: corner, exact: None, why: None };
    };
    let h: Vec<Vec<f64>> = h.iter().map(|row| row.iter().map(|x| sign * x).collect()).collect();
    let quadratic = Quadratic { of, g: &g, h: &h };
    let flipped = |block: &Block| {
        let mut d = corner.clone();
        d[block.range()].iter_mut().for_each(|x| *x = -*x);
        d
    };
    let opposite = corner.iter().map(|x| -x).collect();
    let starts = [corner.clone(), opposite].into_iter().chain(of.blocks.iter().map(flipped));
    // Of equal ones the first, so that a minimum and a maximum without derivatives are at opposite corners.
    let found = starts
        .map(|start| quadratic.ascend(start))
        .reduce(|best, other| if quadratic.at(&other) > quadratic.at(&best) { other } else { best });
    let deviations = found.expect("there is a start");
    Extreme {
        first,
        second: Some(value + sign * quadratic.at(&deviations)),
        deviations,
        exact: None,
        why: None,
    }
}

/// Extreme of a function with a value and a gradient at these deviations, and the second derivatives of the nominal
/// design, as [`extreme`].
pub(super) fn extreme_from(
    of: &Deviations,
    d: &[f64],
    (value, g): (f64, &[f64]),
    h: Option<&[Vec<f64>]>,
    sign: f64,
) -> Extreme {
    // With g = g_0 + H d and f = f_0 + g_0' d + d' H d / 2.
    let bend: Vec<f64> = h.map_or_else(|| vec![0.0; d.len()], |h| h.iter().map(|row| dot(row, d)).collect());
    let at_nominal: Vec<f64> = g.iter().zip(&bend).map(|(g, bend)| g - bend).collect();
    extreme(of, value - dot(&at_nominal, d) - 0.5 * dot(&bend, d), &at_nominal, h, sign)
}

impl Extreme {
    /// Predicted value, to the highest known order.
    pub(super) fn predicted(&self) -> f64 {
        self.second.unwrap_or(self.first)
    }
}

/// Exact minimum and maximum: each design at a predicted worst case, and the nominal one, is within the tolerances, and
/// where the first and second derivatives vanish the prediction says nothing of their order.
pub(super) fn ordered(ends: [Extreme; 2], nominal: f64) -> [Extreme; 2] {
    let [Some(least), Some(greatest)] = ends.each_ref().map(|e| e.exact) else { return ends };
    let none = vec![0.0; ends[0].deviations.len()];
    let designs =
        [(least, ends[0].deviations.clone()), (greatest, ends[1].deviations.clone()), (nominal, none)];
    let mut sign = 1.0;
    ends.map(|mut end| {
        sign = -sign;
        for (value, deviations) in &designs {
            if end.exact.is_some_and(|exact| sign * value > sign * exact) {
                (end.exact, end.deviations) = (Some(*value), deviations.clone());
            }
        }
        end
    })
}

/// Every tolerance at the end of its reach, along the gradient; without a gradient, at the upper end for the maximum
/// (`sign` 1), and at the lower end for the minimum: both are then at opposite corners.
fn corner(of: &Deviations, g: &[f64], sign: f64) -> Vec<f64> {
    let mut d = vec![0.0; g.len()];
    for block in &of.blocks {
        towards(&g[block.range()], block, sign, &mut d[block.range()]);
    }
    d
}

/// Moves the deviations of a tolerance to the end of its reach in a direction; where that is zero, to the end at which
/// all of them are the same number of this sign.
fn towards(direction: &[f64], block: &Block, sign: f64, to: &mut [f64]) {
    let norm = dot(direction, direction).sqrt();
    if norm > 0.0 {
        to.iter_mut().zip(direction).for_each(|(x, g)| *x = block.reach * g / norm);
    } else {
        to.fill(sign * block.reach / (block.len as f64).sqrt());
    }
}

/// `g' d + d' H d / 2`, with each tolerance of d within its reach.
struct Quadratic<'a> {
    of: &'a Deviations,
    g: &'a [f64],
    h: &'a [Vec<f64>],
}

impl Quadratic<'_> {
    fn at(&self, d: &[f64]) -> f64 {
        dot(self.g, d) + 0.5 * self.h.iter().zip(d).map(|(row, d_i)| d_i * dot(row, d)).sum::<f64>()
    }

    fn slope(&self, i: usize, d: &[f64]) -> f64 {
        self.g[i] + dot(&self.h[i], d)
    }

    /// Coordinate ascent, one tolerance after the other.
    fn ascend(&self, mut d: Vec<f64>) -> Vec<f64> {
        for _ in 0..ROUNDS {
            let before = self.at(&d);
            for block in &self.of.blocks {
                if block.len == 1 { self.along(block, &mut d) } else { self.around(block, &mut d) }
            }
            let after = self.at(&d);
            if after - before <= NO_MORE * after.abs() {
                break;
            }
        }
        d
    }

    /// Best value of one variable: an end of its reach, or the vertex of a concave parabola.
    fn along(&self, block: &Block, d: &mut [f64]) {
        let (i, reach) = (block.first, block.reach);
        let (curvature, slope) = (self.h[i][i], self.slope(i, d) - self.h[i][i] * d[i]);
        // The last term makes zeros of both signs equal.
        let height = |x: f64| slope * x + 0.5 * curvature * x * x + 0.0;
        let top = (curvature < 0.0).then(|| (-slope / curvature).clamp(-reach, reach));
        // Of equal ones the last: where nothing is gained, the value stays.
        let ends = [reach, -reach].into_iter().chain(top).chain([d[i]]);
        let best = ends.max_by(|a, b| height(*a).total_cmp(&height(*b)));
        d[i] = best.expect("there is a candidate");
    }

    /// Direction of a sphere's radius. The function plus `mu |d|^2 / 2`, which is constant on the sphere, is convex and
    /// increases with every turn towards its gradient.
    fn around(&self, block: &Block, d: &mut [f64]) {
        let square =
            block.range().flat_map(|i| block.range().map(move |j| (i, j))).map(|(i, j)| self.h[i][j].powi(2));
        let mu = square.sum::<f64>().sqrt();
        for _ in 0..TURNS {
            let before = (self.at(d), d[block.range()].to_vec());
            let slope: Vec<f64> = block.range().map(|i| self.slope(i, d) + mu * d[i]).collect();
            towards(&slope, block, 1.0, &mut d[block.range()]);
            if self.at(d) < before.0 {
                d[block.range()].copy_from_slice(&before.1);
                return;
            }
        }
    }
}
