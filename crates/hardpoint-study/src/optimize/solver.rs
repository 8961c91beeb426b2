//! Solvers applied to optimisation problems: bounded least squares, and sequential programming with limits.
//!
//! Both use the design as fractions of its bounds, so that every variable ranges from 0 to 1.

use std::cell::RefCell;

use crate::evaluation::StudyCost;
use crate::recent::Recent;
use hardpoint::linalg::folded_rows;
use hardpoint_search::{LeastSquares, Program, Sequential, independent};

use super::problem::{LimitRow, Point, Problem, Refusal, Rows};

/// Minimum curvature assumed in any direction, as a fraction of the largest.
pub(super) const FLAT: f64 = 1e-4;
/// Length of a first step without known curvature, as a fraction of the bounds.
const FIRST_STEP: f64 = 0.1;

/// Result at a design.
type Found = Result<Point, Refusal>;

/// Designs evaluated by a search: the most recent ones with their values, and all that failed.
pub(crate) struct Memory<'p> {
    pub problem: &'p Problem<'p>,
    more: &'p (dyn Fn() -> bool + Sync),
    recent: Recent<Found>,
    pub refused: RefCell<Vec<(Vec<f64>, Refusal)>>,
    pub cost: RefCell<StudyCost>,
}

impl<'p> Memory<'p> {
    pub fn new(problem: &'p Problem<'p>, more: &'p (dyn Fn() -> bool + Sync)) -> Self {
        Self {
            problem,
            more,
            recent: Recent::default(),
            refused: RefCell::default(),
            cost: RefCell::default(),
        }
    }

    /// Result at a design, given as fractions of the bounds.
    pub fn at<X>(&self, parts: &[f64], of: impl FnOnce(&Found) -> X) -> X {
        let find = || {
            let design = self.problem.design(parts);
            let found = self.problem.at(design.clone(), &mut self.cost.borrow_mut(), self.more);
            if let Err(refusal) = &found
                && !refusal.interrupted
            {
                self.refused.borrow_mut().push((design, refusal.clone()));
            }
            found
        };
        self.recent.at(parts, find, of)
    }

    pub fn interrupted(&self) -> bool {
        !(self.more)()
    }
}

/// Solver between iterations.
pub(super) trait Solver {
    /// Performs one iteration and returns the new point, as fractions of the bounds; `None` at the end.
    fn step(&mut self) -> Option<Vec<f64>>;

    /// True if the steps so far do not suit the problem: another solver begins where this one did.
    fn is_unfit(&self) -> bool;
}

/// Solver for squared goals without limits other than bounds.
pub(super) fn least_squares<'p>(memory: &'p Memory<'p>, start: &[f64], point: &Point) -> LeastSquares<'p> {
    let spans = memory.problem.spans();
    let size = point.misfits.values.iter().map(|r| r * r).sum::<f64>().sqrt();
    let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
    let same = spans.clone();
    let residuals = move |x: &[f64]| {
        let rows = folded_misfits(memory, &spans, scale, x);
        rows.iter().map(|row| row[x.len()]).collect()
    };
    let derivatives = move |x: &[f64]| {
        let rows = folded_misfits(memory, &same, scale, x);
        rows.into_iter()
            .map(|mut row| {
                row.truncate(x.len());
                row
            })
            .collect()
    };
    LeastSquares::new(start, [0.0, 1.0], Box::new(residuals), Box::new(derivatives))
}

/// Misfits of a design with their derivatives, `[J r]`, reduced to one row for every variable plus one with the same
/// squares and products, since the number of misfits depends on the times at which a design was solved.
fn folded_misfits(memory: &Memory<'_>, spans: &[f64], scale: f64, x: &[f64]) -> Vec<Vec<f64>> {
    memory.at(x, |found| {
        let Ok(point) = found else { return vec![vec![f64::NAN; x.len() + 1]; x.len() + 1] };
        let Rows { values, d } = &point.misfits;
        let by = |v: usize| d.iter().map(|d| scale * spans[v] * d[v]).collect();
        let mut columns: Vec<Vec<f64>> = (0..x.len()).map(by).collect();
        columns.push(values.iter().map(|r| scale * r).collect());
        folded_rows(columns)
    })
}

impl Solver for LeastSquares<'_> {
    fn step(&mut self) -> Option<Vec<f64>> {
        self.step()
    }

    fn is_unfit(&self) -> bool {
        false
    }
}

/// Problem with any goals and limits, in coordinates in which the squared goals have about the same curvature in every
/// direction.
///
/// ```text
/// x = x0 + T z,   T = (2 J^T J + mu I)^-1/2        J: the misfits by x at the start
///
/// min  squares(x) + plain(x) + sum of t or t^2    so that    peak_k(x) <= t,  limits(x) <= 0,  0 <= x <= 1,
///                                                            high_k(x) <= u,  -low_k(x) <= v,  u + v <= most
/// ```
///
/// The squares are those of extrema at a target. The last line is a limit on the range of a curve.
pub(super) struct Programming<'p> {
    memory: &'p Memory<'p>,
    spans: Vec<f64>,
    x0: Vec<f64>,
    /// Columns of T.
    t: Vec<Vec<f64>>,
    /// Factors of the objective and of every limit.
    scale: f64,
    limit_scales: Vec<f64>,
    /// Number of groups of peaks, the last of them squared, and of limited ranges, and number of inequalities; equal
    /// for all designs.
    peaks: usize,
    squared: usize,
    spreads: usize,
    inequal: usize,
    /// Per equality: true if its derivatives are independent of those before it. The solver cannot take others; most of
    /// them repeat what those before them require. Where one does not, the next run from there takes it.
    independent: Vec<bool>,
}

impl Programming<'_> {
    fn searched(&self) -> usize {
        self.x0.len()
    }

    fn x(&self, y: &[f64]) -> Vec<f64> {
        let n = self.searched();
        let along = |i: usize| (0..n).map(|j| self.t[j][i] * y[j]).sum::<f64>();
        (0..n).map(|i| (self.x0[i] + along(i)).clamp(0.0, 1.0)).collect()
    }

    /// Gradient by fractions of the bounds, from a gradient by the variables.
    fn by_parts(&self, d: &[f64]) -> Vec<f64> {
        d.iter().zip(&self.spans).map(|(d, span)| d * span).collect()
    }

    /// Gradient by z, with zeros for the peaks.
    fn by_z(&self, by_parts: &[f64]) -> Vec<f64> {
        let column = |t: &Vec<f64>| t.iter().zip(by_parts).map(|(t, g)| t * g).sum::<f64>();
        self.t.iter().map(column).chain(self.none()).collect()
    }

    /// Groups of candidates with the scale of each: a maximum has the scale of the objective, and one whose square
    /// counts has its root.
    fn groups<'a>(&'a self, point: &'a Point) -> impl Iterator<Item = (f64, &'a Rows)> {
        groups(self.scale, point)
    }

    /// Index of the first t whose square counts; those before count themselves.
    fn first_squared(&self) -> usize {
        self.searched() + self.peaks - self.squared
    }

    /// Zeros for t, u and v.
    fn none(&self) -> impl Iterator<Item = f64> {
        std::iter::repeat_n(0.0, self.peaks + 2 * self.spreads)
    }

    /// Index of u of a limited range; v is the next.
    fn ends(&self, spread: usize) -> usize {
        self.searched() + self.peaks + 2 * spread
    }

    /// Equalities that are independent of those before them.
    fn equal_rows<'a>(&'a self, point: &'a Point) -> impl Iterator<Item = &'a LimitRow> {
        let rows = point.limits.iter().filter(|row| row.equal).zip(&self.independent);
        rows.filter(|(_, independent)| **independent).map(|(row, _)| row)
    }

    /// The inequalities `c <= 0`, in order: lower bounds, upper bounds, limits, peaks, limited ranges.
    fn inequalities_at(&self, y: &[f64], point: &Point) -> Vec<f64> {
        let n = self.searched();
        let along = |i: usize| self.x0[i] + (0..n).map(|j| self.t[j][i] * y[j]).sum::<f64>();
        let mut c: Vec<f64> = (0..n).map(|i| -along(i)).chain((0..n).map(|i| along(i) - 1.0)).collect();
        for row in point.limits.iter().filter(|row| !row.equal && !row.spread) {
            c.push(self.limit_scales[row.of] * row.exceeds);
        }
        for (group, (scale, rows)) in self.groups(point).enumerate() {
            c.extend(rows.values.iter().map(|v| scale * v - y[n + group]));
        }
        for (k, spread) in point.spreads.iter().enumerate() {
            let (scale, ends) = (self.limit_scales[spread.of], self.ends(k));
            for (end, rows) in spread.ends.iter().enumerate() {
                c.extend(rows.values.iter().map(|v| scale * v - y[ends + end]));
            }
            c.push(y[ends] + y[ends + 1] - scale * spread.most);
        }
        c
    }
}

impl Program for Programming<'_> {
    fn equal(&self) -> usize {
        self.independent.iter().filter(|is| **is).count()
    }

    fn inequal(&self) -> usize {
        self.inequal
    }

    fn objective(&self, y: &[f64]) -> f64 {
        let n = self.searched();
        self.memory.at(&self.x(y), |found| match found {
            Ok(point) => {
                let squares: f64 = point.smooth_misfits().values.iter().map(|r| r * r).sum();
                let plain: f64 = point.plain.values.iter().sum();
                let (linear, squared) = y[n..n + self.peaks].split_at(self.peaks - self.squared);
                let peaks = linear.iter().sum::<f64>() + squared.iter().map(|t| t * t).sum::<f64>();
                self.scale * (squares + plain) + peaks
            }
            Err(_) => f64::INFINITY,
        })
    }

    fn gradient(&self, y: &[f64]) -> Vec<f64> {
        let n = self.searched();
        self.memory.at(&self.x(y), |found| match found {
            Ok(point) => {
                let mut g = self.by_z(&self.by_parts(&point.smooth().gradient(n)));
                g.iter_mut().for_each(|g| *g *= self.scale);
                let squared = self.first_squared();
                g[n..squared].fill(1.0);
                (squared..n + self.peaks).for_each(|k| g[k] = 2.0 * y[k]);
                g
            }
            Err(_) => vec![f64::NAN; y.len()],
        })
    }

    fn equalities(&self, y: &[f64]) -> Vec<f64> {
        self.memory.at(&self.x(y), |found| match found {
            Ok(point) => {
                let rows = self.equal_rows(point);
                rows.map(|row| self.limit_scales[row.of] * row.exceeds).collect()
            }
            Err(_) => vec![f64::NAN; self.equal()],
        })
    }

    fn inequalities(&self, y: &[f64]) -> Vec<f64> {
        self.memory.at(&self.x(y), |found| match found {
            Ok(point) => self.inequalities_at(y, point),
            Err(_) => vec![f64::NAN; self.inequal],
        })
    }

    fn jacobian(&self, y: &[f64]) -> Vec<Vec<f64>> {
        let n = self.searched();
        self.memory.at(&self.x(y), |found| {
            let Ok(point) = found else {
                return vec![vec![f64::NAN; y.len()]; self.equal() + self.inequal];
            };
            let limit = |row: &LimitRow| {
                let scale = self.limit_scales[row.of];
                let d: Vec<f64> = self.by_parts(&row.d).iter().map(|d| scale * d).collect();
                self.by_z(&d)
            };
            let mut rows: Vec<Vec<f64>> = self.equal_rows(point).map(limit).collect();
            for sign in [-1.0, 1.0] {
                for i in 0..n {
                    let by_z = (0..n).map(|j| sign * self.t[j][i]);
                    rows.push(by_z.chain(self.none()).collect());
                }
            }
            rows.extend(point.limits.iter().filter(|r| !r.equal && !r.spread).map(limit));
            let below = |scale: f64, all: &Rows, end: usize| -> Vec<Vec<f64>> {
                let row = |d: &Vec<f64>| {
                    let d: Vec<f64> = self.by_parts(d).iter().map(|d| scale * d).collect();
                    let mut row = self.by_z(&d);
                    row[end] = -1.0;
                    row
                };
                all.d.iter().map(row).collect()
            };
            for (k, (scale, peaks)) in self.groups(point).enumerate() {
                rows.extend(below(scale, peaks, n + k));
            }
            for (k, spread) in point.spreads.iter().enumerate() {
                let (scale, ends) = (self.limit_scales[spread.of], self.ends(k));
                for (end, all) in spread.ends.iter().enumerate() {
                    rows.extend(below(scale, all, ends + end));
                }
                let mut row = vec![0.0; y.len()];
                row[ends..ends + 2].fill(1.0);
                rows.push(row);
            }
            rows
        })
    }
}

/// Sequential programming in these coordinates.
pub(super) struct ScaledSequential<'p> {
    solver: Sequential<'p>,
    /// Map from z to x, copied from the problem because the solver owns it.
    x0: Vec<f64>,
    t: Vec<Vec<f64>>,
}

impl<'p> ScaledSequential<'p> {
    pub fn new(memory: &'p Memory<'p>, start: &[f64], point: &Point, limit_scales: &[f64]) -> Option<Self> {
        let (n, spans) = (start.len(), memory.problem.spans());
        let by_parts = |d: &[f64]| d.iter().zip(&spans).map(|(d, span)| d * span).collect::<Vec<f64>>();
        let gradient = by_parts(&point.gradient(n));
        let steepest = gradient.iter().fold(0.0, |most: f64, g| most.max(g.abs()));
        let rows: Vec<Vec<f64>> = point.smooth_misfits().d.iter().map(|d| by_parts(d)).collect();
        // 2 J^T J
        let curved = |i: usize, j: usize| 2.0 * rows.iter().map(|d| d[i] * d[j]).sum::<f64>();
        let most = (0..n).map(|i| curved(i, i)).fold(0.0, f64::max);
        let scale = match (most > 0.0, steepest > 0.0) {
            (true, _) => 1.0 / most,
            (false, true) => FIRST_STEP / steepest,
            _ => 1.0,
        };
        let t = match most > 0.0 {
            true => inverse_root(n, |i, j| scale * curved(i, j) + if i == j { FLAT } else { 0.0 }),
            false => (0..n).map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect()).collect(),
        };
        let limit_scales: Vec<f64> = limit_scales.iter().map(|s| 1.0 / s).collect();
        let mut y = vec![0.0; n];
        y.extend(groups(scale, point).map(|(scale, rows)| scale * rows.greatest()));
        for spread in &point.spreads {
            y.extend(spread.ends.iter().map(|rows| limit_scales[spread.of] * rows.greatest()));
        }
        let equal = point.limits.iter().filter(|row| row.equal);
        let equal: Vec<Vec<f64>> = equal.map(|row| by_parts(&row.d)).collect();
        let (x0, t_too) = (start.to_vec(), t.clone());
        let (squared, spreads) = (point.extrema.len(), point.spreads.len());
        let peaks = point.peaks.len() + squared;
        let mut problem = Programming {
            memory,
            spans: spans.clone(),
            x0,
            t,
            scale,
            limit_scales,
            peaks,
            squared,
            spreads,
            inequal: 0,
            independent: independent(equal),
        };
        problem.inequal = problem.inequalities_at(&y, point).len();
        let solver = Sequential::new(Box::new(problem), y)?;
        Some(Self { solver, x0: start.to_vec(), t: t_too })
    }
}

impl Solver for ScaledSequential<'_> {
    fn step(&mut self) -> Option<Vec<f64>> {
        let y = self.solver.step()?;
        let n = self.x0.len();
        let along = |i: usize| (0..n).map(|j| self.t[j][i] * y[j]).sum::<f64>();
        Some((0..n).map(|i| (self.x0[i] + along(i)).clamp(0.0, 1.0)).collect())
    }

    fn is_unfit(&self) -> bool {
        false
    }
}

/// Groups of candidates with their scales, for a scale of the objective.
fn groups(scale: f64, point: &Point) -> impl Iterator<Item = (f64, &Rows)> {
    let linear = point.peaks.iter().map(move |rows| (scale, rows));
    linear.chain(point.extrema.iter().map(move |extremum| (scale.sqrt(), &extremum.rows)))
}

/// The columns of `L^-T` for a positive definite matrix `L L^T`.
fn inverse_root(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let rest = entry(i, j) - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if i == j { rest.max(FLAT * FLAT).sqrt() } else { rest / l[j][j] };
        }
    }
    // L^T t_j = e_j
    let column = |j: usize| {
        let mut t = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| l[k][i] * t[k]).sum();
            t[i] = (f64::from(u8::from(i == j)) - known) / l[i][i];
        }
        t
    };
    (0..n).map(column).collect()
}
