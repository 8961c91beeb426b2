//! Deviations of the design variables: their distributions and correlations, and the resulting statistics of a function
//! with known derivatives.

use crate::random::{design_stream, draw, moments};
use hardpoint::linalg::semidefinite;
use hardpoint::model::{Model, Scatter, ToleranceSettings, VariableId};

use hardpoint_search::dot;

/// Toleranced variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TolerancedVariable {
    /// The variable.
    pub variable: VariableId,
    /// Index of its tolerance.
    pub tolerance: usize,
    /// Standard deviation of its deviation, m, rad or a plain number.
    pub sigma: f64,
    /// Kurtosis of its deviation: 3 if it is normal.
    pub kurtosis: f64,
}

/// Moments to second order, in SI; 0 if they are round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondOrder {
    /// Mean minus nominal value.
    pub shift: f64,
    /// Standard deviation.
    pub sigma: f64,
    /// Standard deviation of the second-order part alone.
    pub bend: f64,
}

/// Toleranced variables with their distributions.
#[derive(Clone, Debug)]
pub(super) struct Deviations {
    pub variables: Vec<TolerancedVariable>,
    /// Coordinates of each tolerance, stored consecutively, with reach and scatter.
    pub blocks: Vec<Block>,
    /// Square root of the correlation matrix, row by row; `None` if nothing is correlated.
    root: Option<Vec<Vec<f64>>>,
}

/// Coordinates of one tolerance.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Index of the tolerance.
    pub tolerance: usize,
    /// First of its variables, and their number.
    pub first: usize,
    pub len: usize,
    pub reach: f64,
    scatter: Scatter,
    kurtosis: f64,
}

impl Block {
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.len
    }
}

impl Deviations {
    pub fn new(model: &Model, settings: &ToleranceSettings, left_out: &[VariableId]) -> Self {
        assert!(settings.tolerances.iter().flat_map(|t| &t.variables).all(|v| v.0 < model.variables.len()));
        let reaches: Vec<f64> = settings.tolerances.iter().map(|t| t.reach).collect();
        Self::of(settings, &reaches, |v| !left_out.contains(&v))
    }

    /// Deviations with other reaches, one for each tolerance.
    pub fn with_reaches(&self, settings: &ToleranceSettings, reaches: &[f64]) -> Self {
        Self::of(settings, reaches, |v| self.variables.iter().any(|of| of.variable == v))
    }

    fn of(settings: &ToleranceSettings, reaches: &[f64], varies: impl Fn(VariableId) -> bool) -> Self {
        let (mut variables, mut blocks) = (Vec::new(), Vec::new());
        for (tolerance, one) in settings.tolerances.iter().enumerate() {
            let moved: Vec<VariableId> = one.variables.iter().copied().filter(|v| varies(*v)).collect();
            if moved.is_empty() {
                continue;
            }
            // A sphere with one fixed coordinate is a disc.
            let (first, len, reach) = (variables.len(), moved.len(), reaches[tolerance]);
            let of = moments(one.scatter, len, reach);
            blocks.push(Block { tolerance, first, len, reach, scatter: one.scatter, kurtosis: of.kurtosis });
            variables.extend(moved.into_iter().map(|variable| TolerancedVariable {
                variable,
                tolerance,
                sigma: of.sigma,
                kurtosis: of.kurtosis,
            }));
        }
        let place = |v: VariableId| variables.iter().position(|of: &TolerancedVariable| of.variable == v);
        let matrix = || {
            let n = variables.len();
            let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect();
            let mut matrix: Vec<Vec<f64>> = (0..n).map(unit).collect();
            for one in &settings.correlations {
                if let [Some(i), Some(j)] = one.between.map(place) {
                    (matrix[i][j], matrix[j][i]) = (one.coefficient, one.coefficient);
                }
            }
            semidefinite::root(&matrix).expect("the correlations of a model were checked")
        };
        let root = (!settings.correlations.is_empty()).then(matrix);
        Self { variables, blocks, root }
    }

    /// Row i of the square root of the covariance matrix.
    pub fn root_row(&self, i: usize) -> Vec<f64> {
        let sigma = self.variables[i].sigma;
        match &self.root {
            Some(root) => root[i].iter().map(|x| sigma * x).collect(),
            None => {
                let mut row = vec![0.0; self.variables.len()];
                row[i] = sigma;
                row
            }
        }
    }

    /// Vector in coordinates in which deviations are uncorrelated with standard deviation 1: `L' g`.
    pub fn whitened(&self, g: &[f64]) -> Vec<f64> {
        let mut white = vec![0.0; g.len()];
        for (i, g) in g.iter().enumerate() {
            white.iter_mut().zip(self.root_row(i)).for_each(|(w, l)| *w += l * g);
        }
        white
    }

    /// First-order standard deviation: `sqrt(g' S g)`.
    pub fn sigma(&self, g: &[f64]) -> f64 {
        let white = self.whitened(g);
        dot(&white, &white).sqrt()
    }

    /// Contribution of each variable to the first-order variance: `g_i (S g)_i / g' S g`.
    pub fn shares(&self, g: &[f64]) -> Vec<f64> {
        let white = self.whitened(g);
        let variance = dot(&white, &white);
        let share = |i: usize| {
            let part = g[i] * dot(&self.root_row(i), &white);
            if part == 0.0 { 0.0 } else { part / variance }
        };
        (0..g.len()).map(share).collect()
    }

    /// Contribution of each variable to the second-order variance; interactions of two variables are split equally.
    ///
    /// ```text
    /// g_i (S g)_i + (H S H S)_ii / 2 + (k/3 - 1) (sum over the block of G_ij^2 / 2 + tr(G_b) G_ii / 4),  over their sum
    /// ```
    pub fn second_shares(&self, g: &[f64], h: &[Vec<f64>]) -> Vec<f64> {
        let n = g.len();
        let roots: Vec<Vec<f64>> = (0..n).map(|i| self.root_row(i)).collect();
        let covariance = |i: usize, j: usize| dot(&roots[i], &roots[j]);
        let hs = |i: usize, j: usize| (0..n).map(|k| h[i][k] * covariance(k, j)).sum::<f64>();
        let hs: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| hs(i, j)).collect()).collect();
        let scaled = |i: usize, j: usize| h[i][j] * self.variables[i].sigma * self.variables[j].sigma;
        let mut parts: Vec<f64> = (0..n)
            .map(|i| {
                let first = g[i] * (0..n).map(|j| covariance(i, j) * g[j]).sum::<f64>();
                first + 0.5 * (0..n).map(|j| hs[i][j] * hs[j][i]).sum::<f64>()
            })
            .collect();
        for block in &self.blocks {
            let trace: f64 = block.range().map(|i| scaled(i, i)).sum();
            for i in block.range() {
                let square: f64 = block.range().map(|j| scaled(i, j).powi(2)).sum();
                parts[i] += (block.kurtosis / 3.0 - 1.0) * (0.5 * square + 0.25 * trace * scaled(i, i));
            }
        }
        let variance: f64 = parts.iter().sum();
        parts.into_iter().map(|part| if part == 0.0 { 0.0 } else { part / variance }).collect()
    }

    /// Moments to second order.
    ///
    /// ```text
    /// G = L' H L,  shift = tr(G) / 2,  sigma^2 = |L' g|^2 + tr(G G) / 2 + sum over blocks (k/3 - 1) (tr(G_b G_b) / 2 + tr(G_b)^2 / 4)
    /// ```
    pub fn second_order(&self, g: &[f64], h: &[Vec<f64>]) -> SecondOrder {
        let n = g.len();
        // Row i of H L, then L' (H L).
        let half: Vec<Vec<f64>> = h.iter().map(|row| self.whitened(row)).collect();
        let column = |j: usize| -> Vec<f64> { half.iter().map(|row| row[j]).collect() };
        let white: Vec<Vec<f64>> = (0..n).map(|j| self.whitened(&column(j))).collect();
        let trace = |of: std::ops::Range<usize>| of.map(|i| white[i][i]).sum::<f64>();
        let square = |of: std::ops::Range<usize>| {
            of.clone()
                .flat_map(|i| of.clone().map(move |j| (i, j)))
                .map(|(i, j)| white[i][j].powi(2))
                .sum::<f64>()
        };
        let beyond_normal = |b: &Block| {
            (b.kurtosis / 3.0 - 1.0) * (0.5 * square(b.range()) + 0.25 * trace(b.range()).powi(2))
        };
        let bend = 0.5 * square(0..n) + self.blocks.iter().map(beyond_normal).sum::<f64>();
        let (first, bend) = (self.sigma(g), bend.max(0.0).sqrt());
        SecondOrder { shift: 0.5 * trace(0..n), sigma: first.hypot(bend), bend }
    }

    /// Deviations of the sample with a number.
    pub fn sample(&self, seed: u64, number: usize) -> Vec<f64> {
        let mut stream = design_stream(seed, number as u64);
        let mut d = vec![0.0; self.variables.len()];
        for block in &self.blocks {
            draw(block.scatter, block.reach, &mut stream, &mut d[block.range()]);
        }
        if let Some(root) = &self.root {
            let white: Vec<f64> = d.iter().zip(&self.variables).map(|(d, v)| d / v.sigma).collect();
            for (i, of) in self.variables.iter().enumerate() {
                d[i] = of.sigma * dot(&root[i], &white);
            }
        }
        d
    }

    /// Values of all variables of the model with these deviations.
    pub fn design(&self, variables: usize, deviations: &[f64]) -> Vec<f64> {
        let mut design = vec![0.0; variables];
        self.variables.iter().zip(deviations).for_each(|(v, d)| design[v.variable.0] = *d);
        design
    }
}
