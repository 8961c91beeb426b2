//! Linkages whose coupler point follows a path: starts from the atlas, then exact least squares.
//!
//! The unknowns are the joints in the configuration of the first point, the guided point, and the crank's turn at each
//! further point, unless turns are prescribed. The residuals are the distances from the points, so that free turns make
//! them distances from the curve. Steps are those of Levenberg and Marquardt with exact derivatives, from dual numbers
//! through the closed form; each turn is eliminated by itself.

use hardpoint::linalg::{least_squares, semidefinite};
use hardpoint::number::{Dual, Real};

use hardpoint_search::singular;

use crate::linkage::{Guide, Linkage};
use crate::plane::{Complex, Displacement};

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
/// Distance from which points are approached along straight lines, in sizes of the path.
const APPROACHED: f64 = 0.02;
/// Steps of that approach, its least step, and Newton's steps and misfit at each.
const APPROACH: usize = 400;
const LEAST_STEP: f64 = 1e-5;
const CORRECTIONS: usize = 6;
/// Steps along the curve of linkages, its first and largest step, and the misfit at each.
const CURVE_STEPS: usize = 300;
const FIRST_ARC: f64 = 0.01;
const LARGEST_ARC: f64 = 0.25;
const LEAST_ARC: f64 = 1e-7;
const ON_CURVE: f64 = 1e-13;
/// Extent of a linkage, in sizes of the path, that no step may exceed.
pub const LARGEST: f64 = 8.0;

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
    /// Products of the unknowns of the linkage.
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
    /// Each turn: its square, its right-hand side, and its products with the unknowns.
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

/// Linkages whose guided point is at places on lines, the same way along each. Unknowns are A, B, C, the guide, and the
/// angles of the coupler at the points but the first: each dyad keeps its length, so that no branch is taken, and the
/// curve of linkages goes on where a point passes a dead point. The last number is the way along the lines.
struct Lines {
    from: Vec<Complex>,
    /// Directions of the lines, together of length 1.
    lines: Vec<Complex>,
    /// The way to the points of the path.
    length: f64,
    /// Numbers of the joints.
    unknowns: usize,
}

impl Lines {
    /// Derivatives of the constraints of both dyads at all points, and their misfits.
    fn linearized(&self, at: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let (n, way) = (self.unknowns, at[at.len() - 1]);
        let aim = |k: usize| self.from[k] + self.lines[k].times(way);
        let pin = |k: usize| Complex::new(at[k], at[k + 1]);
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for k in 1..self.from.len() {
            let turn = Complex::<f64>::unit(at[n + k - 1]);
            let [here, start] = [self.lines[k], self.lines[0]];
            let mut put = |entries: &[(usize, Complex)], by_angle: f64, by_way: f64, misfit: f64| {
                let mut row = vec![0.0; at.len()];
                for (column, value) in entries {
                    row[*column] += value.x;
                    row[*column + 1] += value.y;
                }
                row[n + k - 1] = by_angle;
                row[at.len() - 1] = by_way;
                rows.push(row);
                right.push(-misfit);
            };
            // |W - G|^2 = |Z - G|^2 with W = aim + turn (Z - first aim)
            let mut crank = |pivot: usize, at_pin: usize| {
                let (g, z) = (pin(pivot), pin(at_pin));
                let arm = turn * (z - aim(0));
                let reach = aim(k) + arm - g;
                let own = z - g;
                let back = turn.conjugate() * reach;
                put(
                    &[(pivot, own - reach), (at_pin, back - own)],
                    arm.left().dot(reach),
                    here.dot(reach) - start.dot(back),
                    0.5 * (reach.square() - own.square()),
                );
            };
            crank(0, 2);
            if n == 8 {
                crank(6, 4);
                continue;
            }
            // along x (W - Z) = 0
            let (z, along) = (pin(4), Complex::<f64>::unit(at[6]));
            let arm = turn * (z - aim(0));
            let shift = aim(k) + arm - z;
            let q = along.conjugate() * (turn - Complex::new(1.0, 0.0));
            let mut row = vec![0.0; at.len()];
            (row[4], row[5], row[6]) = (q.y, q.x, along.left().cross(shift));
            row[n + k - 1] = along.cross(arm.left());
            row[at.len() - 1] = along.cross(here - turn * start);
            rows.push(row);
            right.push(-along.cross(shift));
        }
        (rows, right)
    }

    /// Newton's method from here, with the way fixed or free, and the number of steps; `None` if it does not converge.
    fn corrected(&self, mut at: Vec<f64>, is_fixed: bool) -> Option<(Vec<f64>, usize)> {
        for step in 0..=CORRECTIONS {
            let (rows, right) = self.linearized(&at);
            let misfit = right.iter().map(|x| x * x).sum::<f64>().sqrt();
            if misfit < ON_CURVE {
                return Some((at, step));
            }
            if step == CORRECTIONS || !(misfit < 1.0) {
                return None;
            }
            let width = at.len() - usize::from(is_fixed);
            let by = &least_squares([rows.len(), width], |r, c| rows[r][c], &[right])[0];
            at.iter_mut().zip(by).for_each(|(x, by)| *x += by);
        }
        None
    }

    /// The linkage that meets the points, by steps along the lines.
    fn approached(&self, mut at: Vec<f64>) -> Option<Vec<f64>> {
        let last = at.len() - 1;
        let (mut part, mut step) = (0.0, 0.25);
        for _ in 0..APPROACH {
            if part >= 1.0 {
                return Some(at);
            }
            if step < LEAST_STEP {
                return None;
            }
            let next = f64::min(part + step, 1.0);
            let mut ahead = at.clone();
            ahead[last] = next * self.length;
            match self.corrected(ahead, true) {
                Some((found, _)) => {
                    (at, part) = (found, next);
                    step *= 2.0;
                }
                None => step *= 0.4,
            }
        }
        None
    }

    /// The linkage that meets the points, along the curve of all.
    fn followed(&self, mut at: Vec<f64>, more: &(dyn Fn() -> bool + Sync)) -> Option<Vec<f64>> {
        let last = at.len() - 1;
        let mut before = vec![0.0; at.len()];
        before[last] = 1.0;
        let mut arc = FIRST_ARC;
        for _ in 0..CURVE_STEPS {
            if arc < LEAST_ARC || !more() || at.iter().any(|x| x.abs() > LARGEST) {
                return None;
            }
            let tangent = self.tangent(&at, &before);
            let ahead = at.iter().zip(&tangent).map(|(a, t)| a + arc * t).collect();
            let Some((next, steps)) = self.corrected(ahead, false) else {
                arc *= 0.4;
                continue;
            };
            if (at[last] < self.length) != (next[last] < self.length) {
                // Linear between both, then exactly
                let part = (self.length - at[last]) / (next[last] - at[last]);
                let mut between: Vec<f64> = at.iter().zip(&next).map(|(a, b)| a + part * (b - a)).collect();
                between[last] = self.length;
                if let Some((found, _)) = self.corrected(between, true) {
                    return Some(found);
                }
                arc *= 0.4;
                continue;
            }
            (at, before) = (next, tangent);
            arc = if steps <= 3 { (arc * 1.6).min(LARGEST_ARC) } else { arc };
        }
        None
    }

    /// Unit tangent of the curve in the direction of the one before.
    fn tangent(&self, at: &[f64], before: &[f64]) -> Vec<f64> {
        let (rows, _) = self.linearized(at);
        let tangent = singular(&rows, at.len()).directions.pop().unwrap_or_default();
        let along: f64 = tangent.iter().zip(before).map(|(a, b)| a * b).sum();
        if along < 0.0 { tangent.iter().map(|x| -x).collect() } else { tangent }
    }

    /// Linkage at the points of the path, and the displacements of its coupler.
    fn met(&self, at: &[f64]) -> (Linkage, Vec<Displacement>) {
        let aim = |k: usize| self.from[k] + self.lines[k].times(self.length);
        let mut x = at[..6].to_vec();
        x.extend([aim(0).x, aim(0).y]);
        x.extend(&at[6..self.unknowns]);
        let displacement = |k: usize| {
            let turn = Complex::unit(if k == 0 { 0.0 } else { at[self.unknowns + k - 1] });
            Displacement { turn, shift: aim(k) - turn * aim(0) }
        };
        (linkage(&x), (0..self.from.len()).map(displacement).collect())
    }
}

/// Linkage in the configuration of the first point, displacements of its coupler since then, and the root mean square
/// of the distances.
pub type FittedLinkage = (Linkage, Vec<Displacement>, f64);

/// A search from a start, for a path of size 1.
#[derive(Clone, Debug)]
pub struct Search {
    x: Vec<f64>,
    turns: Vec<f64>,
    squares: f64,
    is_timed: bool,
    damping: f64,
    resting: usize,
    /// Linkage that meets the points exactly, and the displacements of its coupler, once it is found.
    exact: Option<(Linkage, Vec<Displacement>)>,
}

impl Search {
    /// Search from a linkage; `is_timed` fixes the turns of the crank. `None` if the linkage does not have the turns.
    pub fn new(start: &Linkage, turns: &[f64], points: &[Complex], is_timed: bool) -> Option<Self> {
        let x = parameters(start);
        let squares = squares(&x, turns, points);
        let turns = turns.to_vec();
        squares.is_finite().then_some(Self {
            x,
            turns,
            squares,
            is_timed,
            damping: DAMPING,
            resting: 0,
            exact: None,
        })
    }

    /// Root mean square of the distances from the points, without those that are met exactly.
    pub fn rms(&self) -> f64 {
        (self.squares / self.turns.len() as f64).sqrt()
    }

    /// True if the points are met exactly.
    pub fn is_exact(&self) -> bool {
        self.exact.is_some()
    }

    /// Linkage that meets the points exactly, if it was found.
    pub fn exact(&self) -> Option<FittedLinkage> {
        self.exact.as_ref().map(|(linkage, moves)| (*linkage, moves.clone(), 0.0))
    }

    /// The nearest linkage that was found by steps.
    pub fn nearest(&self) -> FittedLinkage {
        let own = self.linkage();
        (own, self.turns.iter().map(|t| own.displacement(*t)).collect(), self.rms())
    }

    /// The nearest linkage.
    pub fn linkage(&self) -> Linkage {
        linkage(&self.x)
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

    /// Meets points exactly where there are few enough: the points move on straight lines from those that the linkage
    /// has to those of the path, and the linkage follows. Nothing changes if it cannot.
    pub fn approach(&mut self, points: &[Complex]) {
        if let Some(lines) = self.lines(points) {
            self.exact = lines.approached(self.state()).map(|at| lines.met(&at));
        }
    }

    /// Meets the largest number of points that a linkage can meet, along the whole curve of linkages that meet points
    /// on those lines and beyond: where the points turn back, the curve goes on. It leads out of the narrow valleys of
    /// the squares. Nothing changes if the points of the path are not on it.
    pub fn follow(&mut self, points: &[Complex], more: &(dyn Fn() -> bool + Sync)) {
        if let Some(lines) = self.lines(points)
            && points.len() == lines.unknowns + 1
        {
            self.exact = lines.followed(self.state(), more).map(|at| lines.met(&at));
        }
    }

    /// The lines to points that can be met, from those that the linkage has.
    fn lines(&self, points: &[Complex]) -> Option<Lines> {
        let own = linkage(&self.x);
        let unknowns = self.x.len() - 2;
        let is_near = self.rms() < APPROACHED && self.rms() > ROUND_OFF;
        (points.len() <= unknowns + 1 && !self.is_timed && is_near).then(|| {
            let from: Vec<Complex> = self.turns.iter().map(|t| own.point(*t)).collect();
            let lines: Vec<Complex> = points.iter().zip(&from).map(|(p, f)| *p - *f).collect();
            let length = lines.iter().map(|l| l.square()).sum::<f64>().sqrt();
            Lines { from, lines: lines.iter().map(|l| l.times(1.0 / length)).collect(), length, unknowns }
        })
    }

    /// Joints, angles of the coupler at the further points, and the place on the lines.
    fn state(&self) -> Vec<f64> {
        let own = linkage(&self.x);
        let angles = self.turns[1..].iter().map(|t| own.displacement(*t).turn.angle());
        self.x[..6].iter().chain(&self.x[8..]).copied().chain(angles).chain([0.0]).collect()
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
                if found < self.squares && linkage(&x).extent() < LARGEST {
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
