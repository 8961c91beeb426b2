//! Finite differences by re-solving moved designs: slow and approximate, used to check the exact derivatives.

use hardpoint::model::{Dimension, VariableId};
use hardpoint::motion::{BodyState, Stop};
use hardpoint::run::{Analysis, Run, Solution};
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;

/// Tolerance of central differences, relative to the largest sensitivity of the same kind: a quantity passes if it
/// agrees to this at some step. In a well-conditioned mechanism central differences reach about (machine epsilon)^(2/3)
/// = 4e-11 at best; accelerations near a limit position lose four digits. Where the differences themselves scatter by
/// more than this, because of truncation or round-off, their spread is allowed in addition.
const PASS: f64 = 1e-6;

/// Tolerance of one-sided differences. Truncation grows with the step itself, so that they reach (machine
/// epsilon)^(1/2) = 1.5e-8 at best: 400 times more than central differences. The tolerance is larger by the same
/// factor.
const PASS_ONE_SIDED: f64 = 4e-4;

/// Pair of designs of a difference quotient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DifferenceScheme {
    /// Designs at +h and -h: the error falls with the square of h.
    #[default]
    Central,
    /// Designs at +h and 0: the error falls with h. For a variable that cannot be moved to the other side.
    Forward,
    /// Designs at 0 and -h: the error falls with h. For a variable that cannot be moved to the other side.
    Backward,
}

impl DifferenceScheme {
    /// Tolerance of the differences, relative to the largest sensitivity of the same kind.
    pub fn tolerance(self) -> f64 {
        if self == Self::Central { PASS } else { PASS_ONE_SIDED }
    }

    /// Designs to solve, in steps from the nominal one.
    fn moves(self) -> &'static [f64] {
        match self {
            Self::Central => &[1.0, -1.0],
            Self::Forward => &[1.0],
            Self::Backward => &[-1.0],
        }
    }
}

/// Difference quotients over a whole motion by one design variable.
#[derive(Clone, Debug)]
pub struct Difference {
    /// The variable.
    pub variable: VariableId,
    /// Step from the nominal design to a moved one, m, rad, or units of tau.
    pub step: f64,
    /// Stride of its output times: row k is output time `k * stride`.
    pub stride: usize,
    /// `bodies[k * n + i]`: quotient of body i in row k.
    pub bodies: Vec<BodySensitivity>,
    /// `outputs[k * m + j]`: quotients of value, rate and acceleration of output j in row k.
    pub outputs: Vec<[f64; 3]>,
    /// `bends[k * m + j]`: second difference `y(b + h) - 2 y(b) + y(b - h)` of the value of output j in row k. It is
    /// far above h^2 if the output has a kink between the moved designs; NaN for one-sided differences.
    pub bends: Vec<f64>,
}

/// Solves the designs of a scheme for each variable and step, eight at a time, and returns the quotients. `nominal` is
/// the complete solution of the nominal design.
///
/// # Errors
/// Per entry, the [`Stop`] of a moved design that did not reach the end.
pub fn finite_differences(
    analysis: &Analysis<'_>,
    nominal: &Solution,
    scheme: DifferenceScheme,
    steps: &[(VariableId, f64)],
) -> Vec<Result<Difference, Stop>> {
    finite_differences_each(analysis, nominal, scheme, steps, 1)
}

/// Returns the quotients of [`finite_differences`] at every `stride`-th output time, from the first on.
///
/// # Errors
/// See [`finite_differences`].
pub fn finite_differences_each(
    analysis: &Analysis<'_>,
    nominal: &Solution,
    scheme: DifferenceScheme,
    steps: &[(VariableId, f64)],
    stride: usize,
) -> Vec<Result<Difference, Stop>> {
    let moves = scheme.moves();
    let analysis =
        &analysis.without_metrics(analysis.model().times.iter().step_by(stride).copied().collect());
    let mut out = Vec::with_capacity(steps.len());
    // Small groups, since a solution stores its whole motion.
    for group in steps.chunks(8 / moves.len()) {
        let designs: Vec<Vec<f64>> = group
            .iter()
            .flat_map(|&(v, h)| moves.iter().map(move |m| analysis.model().alone(v, m * h)))
            .collect();
        let mut solutions = vec![Solution::default(); designs.len()];
        let run = Run::new().without_sensitivities();
        analysis.solve_designs(run, &designs, |k, solution| solutions[k] = std::mem::take(solution));
        for (&(variable, step), moved) in group.iter().zip(solutions.chunks(moves.len())) {
            let stop = moved.iter().find_map(|s| s.stop.clone());
            let (nominal, plus) =
                (Rows { solution: nominal, stride }, Rows { solution: &moved[0], stride: 1 });
            let [plus, minus] = match scheme {
                DifferenceScheme::Central => [plus, Rows { solution: &moved[1], stride: 1 }],
                DifferenceScheme::Forward => [plus, nominal],
                DifferenceScheme::Backward => [nominal, plus],
            };
            out.push(match stop {
                Some(stop) => Err(stop),
                None => {
                    let mut d = quotient((variable, step, stride), plus, minus, moves.len() as f64 * step);
                    if let DifferenceScheme::Central = scheme {
                        bend(&mut d.bends, [plus, nominal, minus]);
                    }
                    Ok(d)
                }
            });
        }
    }
    out
}

/// Every `stride`-th output time of a solution.
#[derive(Clone, Copy)]
struct Rows<'s> {
    solution: &'s Solution,
    stride: usize,
}

impl Rows<'_> {
    fn count(self) -> usize {
        self.solution.motion.len().div_ceil(self.stride)
    }

    fn states(self, row: usize) -> impl Iterator<Item = BodyState> {
        self.solution.motion.at(row * self.stride).iter()
    }

    /// Value, rate and acceleration of output m in a row.
    fn output(self, row: usize, m: usize) -> [f64; 3] {
        self.solution.measured.value(row * self.stride, m)
    }
}

/// Difference quotient of a body; `apart` is the difference of the variable between the two designs.
fn quotient(
    (variable, step, stride): (VariableId, f64, usize),
    plus: Rows<'_>,
    minus: Rows<'_>,
    apart: f64,
) -> Difference {
    // (y(b + h) - y(b - h)) / 2h = y_b + O(h^2);  (y(b + h) - y(b)) / h = y_b + O(h)
    let k = 1.0 / apart;
    let rows = plus.count();
    let bodies = (0..rows)
        .flat_map(|row| plus.states(row).zip(minus.states(row)))
        .map(|(p, m)| body_quotient(&p, &m, k))
        .collect();
    let kinds = &plus.solution.measured.outputs;
    let outputs: Vec<[f64; 3]> = (0..rows)
        .flat_map(|row| (0..kinds.len()).map(move |m| (row, m)))
        .map(|(row, m)| {
            let (p, q) = (plus.output(row, m), minus.output(row, m));
            let mut d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            if kinds[m].dimension == Dimension::ANGLE {
                // The designs may count an angle through different turns.
                let turn = 2.0 * std::f64::consts::PI;
                d[0] -= turn * (d[0] / turn).round();
            }
            d.map(|x| k * x)
        })
        .collect();
    let bends = vec![f64::NAN; outputs.len()];
    Difference { variable, step, stride, bodies, outputs, bends }
}

/// Second differences of the values of all outputs.
fn bend(bends: &mut [f64], [plus, nominal, minus]: [Rows<'_>; 3]) {
    let columns = nominal.solution.measured.outputs.len();
    for (place, bend) in bends.iter_mut().enumerate() {
        let (row, m) = (place / columns, place % columns);
        let [p, y, q] = [plus, nominal, minus].map(|s| s.output(row, m)[0]);
        *bend = p - 2.0 * y + q;
    }
}

fn body_quotient(p: &BodyState, m: &BodyState, k: f64) -> BodySensitivity {
    // dA/db A^T is skew; its vector is half the sum of the columns' cross products. e x e' summed over the three axes
    // is 2 pi', with e the mean of both designs' and e' the quotient of their difference
    let columns = |c: usize| (p.rotation.cols[c] + m.rotation.cols[c]) * 0.5;
    let turned = |c: usize| columns(c).cross(p.rotation.cols[c] - m.rotation.cols[c]);
    let dpi: Vec3 = (turned(0) + turned(1) + turned(2)) * (0.5 * k);
    BodySensitivity {
        dr: (p.r - m.r) * k,
        dpi,
        dv: (p.v - m.v) * k,
        domega: (p.omega - m.omega) * k,
        da: (p.a - m.a) * k,
        dalpha: (p.alpha - m.alpha) * k,
    }
}
