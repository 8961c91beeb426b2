//! The worst that tolerances allow: every deviation anywhere within its reach, whatever its likelihood.

use super::deviations::{Block, Deviations};
use super::dot;

/// An ascent ends after that many rounds over all tolerances; it gains in each of them, and ends mostly after two or
/// three.
const ROUNDS: usize = 50;
/// Within a sphere the direction is improved that many times in each round.
const TURNS: usize = 10;
/// Relative gain below which the difference is round-off.
const NO_MORE: f64 = 1e-12;

/// The least or the greatest value that tolerances allow. All in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// To first order: `value +- sum over tolerances of reach * |gradient|`.
    pub first: f64,
    /// To second order, where that is known: an extreme of the quadratic found by ascent from the first order's and its
    /// neighbours.
    pub second: Option<f64>,
    /// Deviations at the worst case, per toleranced variable: to second order if known, otherwise to first order.
    pub deviations: Vec<f64>,
    /// The metric of the design there, solved exactly.
    pub exact: Option<f64>,
    /// Reason why there is none, if that design does not move to the end.
    pub why: Option<String>,
}

/// The extreme of a function with a gradient and, perhaps, second derivatives: the greatest for `sign` 1, the least for
/// -1.
pub(super) fn extreme(of: &Deviations, value: f64, g: &[f64], h: Option<&[Vec<f64>]>, sign: f64) -> Extreme {
    let g: Vec<f64> = g.iter().map(|g| sign * g).collect();
    let corner = corner(of, &g);
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
    let found = starts
        .map(|start| quadratic.ascend(start))
        .max_by(|a, b| quadratic.at(a).total_cmp(&quadratic.at(b)));
    let deviations = found.expect("there is a start");
    Extreme {
        first,
        second: Some(value + sign * quadratic.at(&deviations)),
        deviations,
        exact: None,
        why: None,
    }
}

/// Every tolerance at its end, the way the gradient points; what has no gradient goes up.
fn corner(of: &Deviations, g: &[f64]) -> Vec<f64> {
    let mut d = vec![0.0; g.len()];
    for block in &of.blocks {
        towards(&g[block.range()], block.reach, &mut d[block.range()]);
    }
    d
}

/// The end of a reach in a direction.
fn towards(direction: &[f64], reach: f64, to: &mut [f64]) {
    let norm = dot(direction, direction).sqrt();
    if norm > 0.0 {
        to.iter_mut().zip(direction).for_each(|(x, g)| *x = reach * g / norm);
    } else {
        to.fill(reach / (to.len() as f64).sqrt());
    }
}

/// `g' d + d' H d / 2`, each tolerance of d within its reach.
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

    /// Goes up, one tolerance after the other.
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

    /// The best value of one variable: at an end of its reach or, of a hill, at its top.
    fn along(&self, block: &Block, d: &mut [f64]) {
        let (i, reach) = (block.first, block.reach);
        let (curvature, slope) = (self.h[i][i], self.slope(i, d) - self.h[i][i] * d[i]);
        let height = |x: f64| slope * x + 0.5 * curvature * x * x;
        let top = (curvature < 0.0).then(|| (-slope / curvature).clamp(-reach, reach));
        let best =
            [d[i], reach, -reach].into_iter().chain(top).max_by(|a, b| height(*a).total_cmp(&height(*b)));
        d[i] = best.expect("there is a candidate");
    }

    /// The direction of a sphere's radius: the function with `mu |d|^2 / 2` added, which changes nothing on the sphere,
    /// is convex, and goes up with every turn towards its gradient.
    fn around(&self, block: &Block, d: &mut [f64]) {
        let square =
            block.range().flat_map(|i| block.range().map(move |j| (i, j))).map(|(i, j)| self.h[i][j].powi(2));
        let mu = square.sum::<f64>().sqrt();
        for _ in 0..TURNS {
            let before = (self.at(d), d[block.range()].to_vec());
            let slope: Vec<f64> = block.range().map(|i| self.slope(i, d) + mu * d[i]).collect();
            towards(&slope, block.reach, &mut d[block.range()]);
            if self.at(d) < before.0 {
                d[block.range()].copy_from_slice(&before.1);
                return;
            }
        }
    }
}
