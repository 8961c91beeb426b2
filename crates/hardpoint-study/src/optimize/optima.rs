//! Distinct optima of several searches.

use hardpoint::model::{Model, OptimizationSettings};

use super::{KEPT, Optimization, Status, is_as_good_in_own_assembly};

/// Optima in the same assembly and sense are the same if no variable differs by more than this fraction of its bounds:
/// an optimality residual of 1e-6 leaves less than that wherever the curvature of the goals is of order one.
const SAME: f64 = 1e-4;
/// Along a flat valley the ends of searches are further apart: they are the same up to this distance if their
/// objectives are equal up to [`FLAT`].
const VALLEY: f64 = 1e-2;
/// Largest relative difference of objectives along a flat valley.
const FLAT: f64 = 1e-7;

impl Optimization {
    /// Distinct optima, the best first: of each the searches that ended in it, the best first.
    ///
    /// Searches that ended elsewhere are in none of them. Variables without effect in all searches do not count.
    pub fn optima(&self, model: &Model, settings: &OptimizationSettings) -> Vec<Vec<usize>> {
        let found = |k: usize| self.searches[k].found.as_ref().expect("an optimum has a design");
        let has_effect = |v: usize| self.searches.iter().any(|search| !search.idle[v]);
        let relevant: Vec<_> =
            (0..settings.variables.len()).filter(|v| has_effect(*v)).map(|v| settings.variables[v]).collect();
        let is_same = |a: usize, b: usize| {
            let same_variant = self.searches[a].variant == self.searches[b].variant;
            let [a, b] = [found(a), found(b)];
            let is_flat = (a.objective - b.objective).abs() <= FLAT * a.objective.abs();
            let least = if is_flat { VALLEY } else { SAME };
            same_variant
                && relevant.iter().all(|v| {
                    let [low, high] = model.variables[v.0].bounds.unwrap_or_default();
                    (a.design[v.0] - b.design[v.0]).abs() <= least * (high - low)
                })
        };
        let kept = |k: &usize| {
            let search = &self.searches[*k];
            let found = search.found.as_ref().filter(|found| found.violation <= KEPT);
            found.filter(|_| search.status == Status::Optimal)
        };
        let mut ends: Vec<(usize, f64)> =
            (0..self.searches.len()).filter_map(|k| Some((k, kept(&k)?.objective))).collect();
        ends.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut optima: Vec<Vec<usize>> = Vec::new();
        for (k, _) in ends {
            match optima.iter_mut().find(|optimum| is_same(optimum[0], k)) {
                Some(optimum) => optimum.push(k),
                None => optima.push(vec![k]),
            }
        }
        let best = optima.first().map(|optimum| optimum[0]);
        let own = best.and_then(|best| {
            optima.iter().position(|optimum| is_as_good_in_own_assembly(&self.searches, optimum[0], best))
        });
        if let Some(own) = own {
            optima[..=own].rotate_right(1);
        }
        optima
    }
}
