//! Linkages whose coupler point follows a path: starts from the atlas, then exact least squares.
//!
//! The unknowns are the joints in the configuration of the first point, the guided point, and the crank's turn at each
//! further point, unless turns are prescribed. The residuals are the distances from the points, so that free turns make
//! them distances from the curve. Steps are those of Levenberg and Marquardt with exact derivatives, from dual numbers
//! through the closed form; each turn is eliminated by itself.

use hardpoint::linalg::{least_squares, semidefinite};
use hardpoint::number::{Dual, Real};

use super::linkage::{Guide, Linkage};
use super::plane::Complex;

/// Distance that counts as none, in sizes of the path.
const ROUND_OFF: f64 = 1e-13;
/// Relative decrease of the squares per step below which a search rests, and steps that it may rest.
const RESTS: f64 = 1e-5;
const RESTING: usize = 10;
/// First damping, its least value, and that at which a search ends.
const DAMPING: f64 = 1e-2;
const LEAST_DAMPING: f64 = 1e-16;
const MOST_DAMPING: f64 = 1e10;
/// Part of the largest column that is added to the damping of each, so that none is free.
const FLOOR: f64 = 1e-6;
/// Paths of at most this many points are fitted by orthogonal decomposition in the end, which keeps all digits.
const ORTHOGONAL: usize = 12;
/// Points that a linkage can meet exactly.
const MEETS: usize = 9;
/// Distance from which points are approached along straight lines, in sizes of the path.
const APPROACHED: f64 = 0.02;
/// Steps of that approach, its least step, and Newton's steps and misfit at each.
const APPROACH: usize = 400;
const LEAST_STEP: f64 = 1e-5;
const CORRECTIONS: usize = 5;
const CORRECTED: f64 = 1e-8;

/// Unknowns of a linkage as numbers: A, B, C, the guide, P.
fn parameters(of: &Linkage) -> Vec<f64> {
    let mut all = vec![of.a.x, of.a.y, of.b.x, of.b.y, of.c.x, of.c.y, of.p.x, of.p.y];
    match of.guide {
        Guide::Rocker(d) => all.extend([d.x, d.y]),
        Guide::Slider(along) => all.push(along.angle()),
    }
    all
}

/// Linkage of the unknowns.
fn linkage<T: Real>(x: &[T]) -> Linkage<T> {
    let at = |k: usize| Complex::new(x[k], x[k + 1]);
    let guide = match x.len() {
        10 => Guide::Rocker(at(8)),
        _ => Guide::Slider(Complex::unit(x[8])),
    };
    Linkage { a: at(0), b: at(2), c: at(4), guide, p: at(6) }
}

fn squares(x: &[f64], turns: &[f64], points: &[Complex]) -> f64 {
    let of = linkage(x);
    turns.iter().zip(points).map(|(t, p)| (of.point(*t) - *p).square()).sum()
}

/// Derivatives of a point of the curve by the unknowns and the turn, and its distance to the point of the path.
fn linearized(x: &[f64], turn: f64, target: Complex) -> (Vec<Complex>, Complex) {
    let n = x.len();
    let slope = |seed: usize| {
        let dual = |k: usize, v: f64| if k == seed { Dual::variable(v) } else { Dual::constant(v) };
        let x: Vec<Dual> = x.iter().enumerate().map(|(k, v)| dual(k, *v)).collect();
        linkage(&x).point(dual(n, turn))
    };
    let all: Vec<Complex<Dual>> = (0..=n).map(slope).collect();
    let misfit = target - Complex::new(all[n].x.v, all[n].y.v);
    (all.iter().map(|s| Complex::new(s.x.d, s.y.d)).collect(), misfit)
}

/// Damped step of the unknowns and of the turns by orthogonal decomposition of the equations themselves.
fn orthogonal_step(
    x: &[f64],
    turns: &[f64],
    points: &[Complex],
    is_timed: bool,
    damping: f64,
) -> (Vec<f64>, Vec<f64>) {
    let (n, m) = (x.len(), points.len());
    let free = if is_timed { 0 } else { m - 1 };
    let rows: Vec<(Vec<Complex>, Complex)> =
        turns.iter().zip(points).map(|(t, p)| linearized(x, *t, *p)).collect();
    let part = |v: Complex, r: usize| if r.is_multiple_of(2) { v.x } else { v.y };
    // The first turn is zero by definition; turn k is column n + k - 1.
    let square = |c: usize| match c.checked_sub(n) {
        None => rows.iter().map(|r| r.0[c].square()).sum::<f64>(),
        Some(k) => rows[k + 1].0[n].square(),
    };
    let squares: Vec<f64> = (0..n + free).map(square).collect();
    let floor = FLOOR * squares.iter().copied().fold(0.0, f64::max);
    let entry = |r: usize, c: usize| match (r.checked_sub(2 * m), c.checked_sub(n)) {
        (Some(k), _) if k == c => (damping * (squares[c] + floor)).sqrt(),
        (Some(_), _) => 0.0,
        (None, None) => part(rows[r / 2].0[c], r),
        (None, Some(k)) if k + 1 == r / 2 => part(rows[r / 2].0[n], r),
        (None, Some(_)) => 0.0,
    };
    let damped = 2 * m + if damping > 0.0 { n + free } else { 0 };
    let right = (0..damped).map(|r| if r < 2 * m { part(rows[r / 2].1, r) } else { 0.0 }).collect();
    let step = least_squares([damped, n + free], entry, &[right]).swap_remove(0);
    let mut turned = vec![0.0; m];
    turned[1..=free].copy_from_slice(&step[n..]);
    (step[..n].to_vec(), turned)
}

/// Normal equations at a point, with the turns eliminated.
struct Normal {
    /// Of the unknowns of the linkage.
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
    /// Of each turn: its own square, its right-hand side, and its products with the unknowns.
    turns: Vec<(f64, f64, Vec<f64>)>,
}

impl Normal {
    fn of(x: &[f64], turns: &[f64], points: &[Complex]) -> Self {
        let n = x.len();
        let mut matrix = vec![vec![0.0; n]; n];
        let mut right = vec![0.0; n];
        let mut each = Vec::new();
        for (t, p) in turns.iter().zip(points) {
            let (columns, misfit) = linearized(x, *t, *p);
            for i in 0..n {
                right[i] += columns[i].dot(misfit);
                for j in 0..n {
                    matrix[i][j] += columns[i].dot(columns[j]);
                }
            }
            let along = columns[n];
            each.push((
                along.square(),
                along.dot(misfit),
                columns[..n].iter().map(|c| c.dot(along)).collect(),
            ));
        }
        Self { matrix, right, turns: each }
    }

    /// Damped step of the unknowns and of the turns; those of `fixed` turns are zero.
    fn step(&self, damping: f64, is_timed: bool) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = self.right.len();
        let (mut matrix, mut right) = (self.matrix.clone(), self.right.clone());
        let largest = (0..n).map(|k| matrix[k][k]).fold(0.0, f64::max);
        for k in 0..n {
            matrix[k][k] += damping * (matrix[k][k] + FLOOR * largest);
        }
        // The first turn is zero by definition.
        let free = |k: usize| k > 0 && !is_timed;
        for (_, (square, own, products)) in self.turns.iter().enumerate().filter(|(k, _)| free(*k)) {
            let per = 1.0 / (square * (1.0 + damping) + f64::MIN_POSITIVE);
            for i in 0..n {
                right[i] -= products[i] * own * per;
                for j in 0..n {
                    matrix[i][j] -= products[i] * products[j] * per;
                }
            }
        }
        // Scaled to ones on the diagonal
        let unit: Vec<f64> = (0..n).map(|k| matrix[k][k].max(f64::MIN_POSITIVE).sqrt()).collect();
        for i in 0..n {
            right[i] /= unit[i];
            (0..n).for_each(|j| matrix[i][j] /= unit[i] * unit[j]);
        }
        let root = semidefinite::root(&matrix)?;
        semidefinite::solve(&root, &mut right);
        right.iter_mut().zip(&unit).for_each(|(x, unit)| *x /= unit);
        let turn = |(k, (square, own, products)): (usize, &(f64, f64, Vec<f64>))| {
            if !free(k) {
                return 0.0;
            }
            let known: f64 = products.iter().zip(&right).map(|(p, x)| p * x).sum();
            (own - known) / (square * (1.0 + damping) + f64::MIN_POSITIVE)
        };
        let turns = self.turns.iter().enumerate().map(turn).collect();
        Some((right, turns))
    }
}

/// Linkage and turns that meet points exactly, by Newton's method; `None` if it does not converge.
fn corrected(x: &[f64], turns: &[f64], points: &[Complex]) -> Option<(Vec<f64>, Vec<f64>)> {
    let (mut x, mut turns) = (x.to_vec(), turns.to_vec());
    let mut before = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let (by, turned) = orthogonal_step(&x, &turns, points, false, 0.0);
        x.iter_mut().zip(by).for_each(|(x, by)| *x += by);
        turns.iter_mut().zip(turned).for_each(|(t, by)| *t += by);
        let misfit = squares(&x, &turns, points).sqrt();
        if !(misfit < before) {
            break;
        }
        before = misfit;
        if misfit < ROUND_OFF {
            break;
        }
    }
    (before < CORRECTED).then_some((x, turns))
}

/// A search from a start, for a path of size 1.
#[derive(Clone, Debug)]
pub struct Search {
    x: Vec<f64>,
    turns: Vec<f64>,
    squares: f64,
    is_timed: bool,
    damping: f64,
    resting: usize,
}

impl Search {
    /// Search from a linkage; `is_timed` fixes the turns of the crank. `None` if the linkage does not have the turns.
    pub fn new(start: &Linkage, turns: &[f64], points: &[Complex], is_timed: bool) -> Option<Self> {
        let x = parameters(start);
        let squares = squares(&x, turns, points);
        let turns = turns.to_vec();
        squares.is_finite().then_some(Self { x, turns, squares, is_timed, damping: DAMPING, resting: 0 })
    }

    /// Root mean square of the distances from the points.
    pub fn rms(&self) -> f64 {
        (self.squares / self.turns.len() as f64).sqrt()
    }

    /// Linkage in the configuration of the first point.
    pub fn linkage(&self) -> Linkage {
        linkage(&self.x)
    }

    /// Turns of the crank at the points, rad.
    pub fn turns(&self) -> &[f64] {
        &self.turns
    }

    /// Performs steps until the search rests, at most this many. The last are `exact`.
    pub fn advance(&mut self, points: &[Complex], steps: usize, exact: bool) {
        let exact = exact && points.len() <= ORTHOGONAL;
        for _ in 0..steps {
            if self.rms() <= ROUND_OFF || self.resting >= RESTING || !self.step(points, exact) {
                return;
            }
        }
    }

    /// Meets points exactly where there are at most nine: the points move from those that the linkage has to those of
    /// the path, and the linkage follows by Newton's method. Nothing changes if it cannot.
    pub fn approach(&mut self, points: &[Complex]) {
        if points.len() > MEETS || self.is_timed || !(self.rms() < APPROACHED) {
            return;
        }
        let own = self.linkage();
        let from: Vec<Complex> = self.turns.iter().map(|t| own.point(*t)).collect();
        let (mut x, mut turns, mut part, mut step) = (self.x.clone(), self.turns.clone(), 0.0, 0.25);
        for _ in 0..APPROACH {
            if part >= 1.0 || step < LEAST_STEP {
                break;
            }
            let next = f64::min(part + step, 1.0);
            let aims: Vec<Complex> =
                from.iter().zip(points).map(|(a, b)| *a + (*b - *a).times(next)).collect();
            match corrected(&x, &turns, &aims) {
                Some(found) => {
                    (x, turns) = found;
                    part = next;
                    step *= 2.0;
                }
                None => step *= 0.4,
            }
        }
        let found = squares(&x, &turns, points);
        if part >= 1.0 && found < self.squares {
            (self.x, self.turns, self.squares) = (x, turns, found);
        }
    }

    /// Performs one step; false if none is better.
    fn step(&mut self, points: &[Complex], exact: bool) -> bool {
        let normal = (!exact).then(|| Normal::of(&self.x, &self.turns, points));
        while self.damping <= MOST_DAMPING {
            let step = match &normal {
                Some(normal) => normal.step(self.damping, self.is_timed),
                None => Some(orthogonal_step(&self.x, &self.turns, points, self.is_timed, self.damping)),
            };
            if let Some((by, turned)) = step {
                let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<f64>>();
                let (x, turns) = (sum(&self.x, &by), sum(&self.turns, &turned));
                let found = squares(&x, &turns, points);
                if found < self.squares {
                    let rests = found > (1.0 - RESTS) * self.squares;
                    self.resting = if rests { self.resting + 1 } else { 0 };
                    (self.x, self.turns, self.squares) = (x, turns, found);
                    self.damping = (self.damping * 0.2).max(LEAST_DAMPING);
                    return true;
                }
            }
            self.damping *= 6.0;
        }
        false
    }
}
