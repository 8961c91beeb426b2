//! Linear least squares within bounds by an active set.

use crate::vector::dot;

/// A release or a new active bound takes one pass; this number of passes per parameter is enough for any problem that
/// does not cycle.
const MOST_PASSES: usize = 10;
/// A multiplier below this fraction of the gradient's size is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Directions over free parameters, with the sizes of their columns: `v` and `|J v|`.
pub type FreeDirections<'a> = &'a dyn Fn(&[usize]) -> Vec<(Vec<f64>, f64)>;

/// Minimises `|J (x - start) + r|^2` within bounds. `directions` lists the determined directions over free parameters,
/// which make the columns of J perpendicular. A parameter at a bound has exactly its value.
pub fn bounded_least_squares(
    start: &[f64],
    rows: &[Vec<f64>],
    right: &[f64],
    bounds: &[[f64; 2]],
    directions: FreeDirections<'_>,
) -> Vec<f64> {
    let n = start.len();
    let mut x = start.to_vec();
    let residuals = |x: &[f64]| -> Vec<f64> {
        let by: Vec<f64> = x.iter().zip(start).map(|(x, s)| x - s).collect();
        rows.iter().zip(right).map(|(row, r)| dot(row, &by) + r).collect()
    };
    let gradient = |x: &[f64]| -> Vec<f64> {
        let r = residuals(x);
        (0..n).map(|k| rows.iter().zip(&r).map(|(row, r)| row[k] * r).sum()).collect()
    };
    // A parameter at a bound is free if the objective falls towards the inside.
    let is_held = |x: &[f64], g: &[f64], k: usize| {
        (x[k] <= bounds[k][0] && g[k] > 0.0) || (x[k] >= bounds[k][1] && g[k] < 0.0)
    };
    let g = gradient(&x);
    let mut free: Vec<usize> = (0..n).filter(|k| !is_held(&x, &g, *k)).collect();
    for _ in 0..MOST_PASSES * n {
        let g = gradient(&x);
        let mut step = vec![0.0; n];
        for (v, size) in directions(&free) {
            let by = -dot(&v, &g) / (size * size);
            step.iter_mut().zip(&v).for_each(|(s, v)| *s += by * v);
        }
        // Fraction of the step up to the first bound
        let room = |k: usize| match step[k] {
            s if s > 0.0 => (bounds[k][1] - x[k]) / s,
            s if s < 0.0 => (bounds[k][0] - x[k]) / s,
            _ => f64::INFINITY,
        };
        let first = free.iter().map(|k| (room(*k).max(0.0), *k)).min_by(|a, b| a.0.total_cmp(&b.0));
        match first.filter(|(fraction, _)| *fraction < 1.0) {
            Some((fraction, k)) => {
                x.iter_mut().zip(&step).for_each(|(x, s)| *x += fraction * s);
                x[k] = bounds[k][usize::from(step[k] > 0.0)];
                free.retain(|f| *f != k);
            }
            None => {
                x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
                let g = gradient(&x);
                let size = ROUND_OFF * dot(&g, &g).sqrt();
                let pull = |k: usize| if x[k] <= bounds[k][0] { -g[k] } else { g[k] };
                let held = (0..n).filter(|k| !free.contains(k));
                let released = held.map(|k| (pull(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
                match released.filter(|(pull, _)| *pull > size) {
                    Some((_, k)) => free.push(k),
                    None => break,
                }
                free.sort_unstable();
            }
        }
    }
    x.iter().zip(bounds).map(|(x, [low, high])| x.clamp(*low, *high)).collect()
}
