//! Convex quadratic programs and non-negative least squares, for a few tens of unknowns.
//!
//! ```text
//! min  1/2 p^T H p + g^T p    so that    A p <= b                 H = L L^T, positive definite
//! ```
//!
//! With `z = L^T p + L^-1 g` this is the least distance problem `min |z|, G z >= h`, whose dual is a problem of
//! non-negative least squares (Lawson and Hanson, *Solving Least Squares Problems*, chapter 23).

use hardpoint::linalg::{least_squares, semidefinite};

use crate::vector::{dot, norm};

/// A column enters if it reduces the residual by more than this, relative to its length and that of the right-hand
/// side.
const ENTERS: f64 = 1e-14;
/// A dual residual below this means that the constraints contradict each other.
const CONTRADICTION: f64 = 1e-13;
/// Iterations of the active-set method per column, to break cycles.
const ROUNDS: usize = 4;

/// A linear constraint `a p <= b`.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Coefficients.
    pub a: Vec<f64>,
    /// Right-hand side.
    pub b: f64,
}

/// Solution of a quadratic program.
#[derive(Clone, Debug)]
pub struct Minimum {
    /// Unknowns.
    pub p: Vec<f64>,
    /// Multiplier of each constraint, at least 0: `H p + g + A^T m = 0`.
    pub multipliers: Vec<f64>,
}

/// Solves the program; `None` if H is not positive definite, or no `p` satisfies all constraints.
pub fn minimize(h: &[Vec<f64>], g: &[f64], constraints: &[Linear]) -> Option<Minimum> {
    let n = g.len();
    let root = semidefinite::root(h).filter(|l| (0..n).all(|k| l[k][k] > 0.0))?;
    // L^-1 v
    let forward = |v: &[f64]| {
        let mut x = v.to_vec();
        for k in 0..n {
            x[k] = (x[k] - (0..k).map(|j| root[k][j] * x[j]).sum::<f64>()) / root[k][k];
        }
        x
    };
    let shift = forward(g);
    // Columns (-L^-1 a, -(b + a H^-1 g)) of the dual, scaled to unit length.
    let column = |c: &Linear| {
        let mut column: Vec<f64> = forward(&c.a).iter().map(|x| -x).collect();
        let along: f64 = column.iter().zip(&shift).map(|(a, s)| -a * s).sum();
        column.push(-(c.b + along));
        let length = norm(&column);
        let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
        column.iter_mut().for_each(|x| *x *= scale);
        (column, scale)
    };
    let (columns, scales): (Vec<_>, Vec<_>) = constraints.iter().map(column).unzip();
    let mut right = vec![0.0; n + 1];
    right[n] = 1.0;
    let u = non_negative(&columns, &right);
    let last = columns.iter().zip(&u).map(|(c, u)| c[n] * u).sum::<f64>() - right[n];
    if !(last < -CONTRADICTION) {
        return None;
    }
    // The dual is accurate enough to tell which constraints are active; with them,  min |z|, G z = h,  G^T m = z.
    let active: Vec<usize> = (0..columns.len()).filter(|k| u[*k] > 0.0).collect();
    let heights = active.iter().map(|k| columns[*k][n]).collect();
    let z = least_squares([active.len(), n], |r, c| columns[active[r]][c], &[heights]).swap_remove(0);
    let forces = least_squares([n, active.len()], |r, c| columns[active[c]][r], std::slice::from_ref(&z));
    let mut multipliers = vec![0.0; columns.len()];
    for (k, m) in active.iter().zip(&forces[0]) {
        multipliers[*k] = scales[*k] * m.max(0.0);
    }
    // p = L^-T (z - L^-1 g)
    let mut p: Vec<f64> = z.iter().zip(&shift).map(|(z, s)| z - s).collect();
    for k in (0..n).rev() {
        p[k] = (p[k] - (k + 1..n).map(|j| root[j][k] * p[j]).sum::<f64>()) / root[k][k];
    }
    Some(Minimum { p, multipliers })
}

/// The `u >= 0` that minimises `|E u - f|`, for the columns of E.
pub fn non_negative(columns: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let m = columns.len();
    let mut u = vec![0.0; m];
    let mut passive: Vec<usize> = Vec::new();
    let tolerance = ENTERS * norm(right);
    let left = |u: &[f64], passive: &[usize]| {
        let mut left = right.to_vec();
        for k in passive {
            left.iter_mut().zip(&columns[*k]).for_each(|(l, c)| *l -= c * u[*k]);
        }
        left
    };
    // Columns that would leave at once, because they depend on those that are passive.
    let mut barred = vec![false; m];
    for _ in 0..ROUNDS * m {
        let rest = left(&u, &passive);
        let slope = |k: usize| dot(&columns[k], &rest);
        let enters = (0..m)
            .filter(|k| !barred[*k] && !passive.contains(k))
            .map(|k| (k, slope(k)))
            .filter(|(k, slope)| *slope > tolerance * norm(&columns[*k]))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((enters, _)) = enters else { break };
        passive.push(enters);
        let before = u.clone();
        loop {
            let entry = |r: usize, c: usize| columns[passive[c]][r];
            let solved = least_squares([right.len(), passive.len()], entry, &[right.to_vec()]).swap_remove(0);
            if solved.iter().all(|x| *x > 0.0) {
                passive.iter().zip(solved).for_each(|(k, x)| u[*k] = x);
                break;
            }
            // Towards the solution until the first number vanishes.
            let falls = passive.iter().zip(&solved).filter(|(_, x)| !(**x > 0.0));
            let part = falls.map(|(k, x)| u[*k] / (u[*k] - x)).fold(1.0, |a, b| if b < a { b } else { a });
            for (k, x) in passive.iter().zip(&solved) {
                u[*k] += part * (x - u[*k]);
            }
            let first = passive.iter().zip(&solved).filter(|(_, x)| !(**x > 0.0));
            let first = first.min_by(|a, b| u[*a.0].total_cmp(&u[*b.0])).map(|(k, _)| *k);
            passive.retain(|k| u[*k] > 0.0 && Some(*k) != first);
            (0..m).filter(|k| !passive.contains(k)).for_each(|k| u[k] = 0.0);
            if passive.is_empty() {
                break;
            }
        }
        if u == before || !passive.contains(&enters) {
            barred[enters] = true;
        } else {
            barred.fill(false);
        }
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Round-off of the dual.
    const ROUND_OFF: f64 = 1e-12;

    #[test]
    fn a_point_outside_a_corner_is_projected_on_it() {
        // min (x - 3)^2 + (y - 2)^2 so that x <= 1, y <= 1, x + y <= 1.5: x = 1, y = 1/2.
        let h = [[2.0, 0.0], [0.0, 2.0]].map(Vec::from);
        let rows = [([1.0, 0.0], 1.0), ([0.0, 1.0], 1.0), ([1.0, 1.0], 1.5)];
        let rows: Vec<Linear> = rows.map(|(a, b)| Linear { a: a.into(), b }).into();
        let found = minimize(&h, &[-6.0, -4.0], &rows).unwrap();
        let off = (found.p[0] - 1.0).abs() + (found.p[1] - 0.5).abs();
        assert!(off < ROUND_OFF, "{:?}", found.p);
        // 2 (x - 3) + m0 + m2 = 0 and 2 (y - 2) + m2 = 0
        let expected = [1.0, 0.0, 3.0];
        assert!(found.multipliers.iter().zip(expected).all(|(a, b)| (a - b).abs() < ROUND_OFF));
    }

    #[test]
    fn contradictions_and_indefinite_matrices_have_no_minimum() {
        let rows = [Linear { a: vec![1.0], b: -1.0 }, Linear { a: vec![-1.0], b: -1.0 }];
        assert!(minimize(&[vec![1.0]], &[0.0], &rows).is_none());
        assert!(minimize(&[vec![-1.0]], &[0.0], &[]).is_none());
    }

    #[test]
    fn conditions_of_a_minimum_hold_for_random_programs() {
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut active = 0;
        for _ in 0..200 {
            let n = 6;
            let a: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| random()).collect()).collect();
            let entry = |i: usize, j: usize| dot(&a[i], &a[j]) + if i == j { 0.1 } else { 0.0 };
            let h: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
            let g: Vec<f64> = (0..n).map(|_| random()).collect();
            let row = |_: usize| Linear { a: (0..n).map(|_| random()).collect(), b: 0.3 };
            let rows: Vec<Linear> = (0..15).map(row).collect();
            let Minimum { p, multipliers } = minimize(&h, &g, &rows).unwrap();
            for i in 0..n {
                let forces: f64 = rows.iter().zip(&multipliers).map(|(r, m)| r.a[i] * m).sum();
                assert!((dot(&h[i], &p) + g[i] + forces).abs() < 1e-9);
            }
            for (row, m) in rows.iter().zip(&multipliers) {
                let slack = row.b - dot(&row.a, &p);
                assert!(slack > -1e-9 && *m >= 0.0 && (slack * m).abs() < 1e-8);
                active += usize::from(*m > 0.0);
            }
        }
        assert!(active > 200, "{active} active constraints");
    }
}
