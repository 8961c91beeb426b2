//! Best of several searches, and their distinct optima.

use hardpoint::model::{Model, OptimizationSettings};

use super::assessment::{AS_GOOD, LIMIT_KEPT};
use super::result::{Optimization, SearchResult, Status};

/// An optimum of another assembly or sense must be better than those of the model's own by this fraction.
const NO_WORSE: f64 = 1e-6;
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
            let found = search.found.as_ref().filter(|found| found.violation <= LIMIT_KEPT);
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

/// Index of the best search.
pub(super) fn best(searches: &[SearchResult]) -> Option<usize> {
    let found = |k: &usize| searches[*k].found.as_ref();
    let rank = |k: &usize| {
        let assessment = found(k).expect("only those that found something are ranked");
        let kept = assessment.violation <= LIMIT_KEPT;
        let objective = match searches[*k].status {
            // Objectives without effects differ by round-off.
            Status::NoEffect => 0.0,
            Status::Optimal
            | Status::Stuck
            | Status::LimitsNotKept
            | Status::IterationLimit
            | Status::Interrupted
            | Status::NoStart => assessment.objective,
        };
        (!kept, if kept { objective } else { assessment.violation })
    };
    let order = |a: &usize, b: &usize| {
        let ([a, b], [x, y]) = ([rank(a).0, rank(b).0], [rank(a).1, rank(b).1]);
        a.cmp(&b).then(x.total_cmp(&y))
    };
    let least = (0..searches.len()).filter(|k| found(k).is_some()).min_by(order)?;
    let (exceeds, value) = rank(&least);
    let as_good = |k: &usize| {
        let same = |(e, v): (bool, f64)| e == exceeds && v - value <= AS_GOOD * value.abs();
        found(k).is_some() && same(rank(k))
    };
    let residual = |k: &usize| searches[*k].optimality.residual;
    let best = (0..searches.len()).filter(as_good).min_by(|a, b| residual(a).total_cmp(&residual(b)))?;
    let own = (0..searches.len()).filter(|k| found(k).is_some_and(|f| f.violation <= LIMIT_KEPT));
    let own = own.filter(|k| is_as_good_in_own_assembly(searches, *k, best));
    Some(own.min_by(|a, b| residual(a).total_cmp(&residual(b))).unwrap_or(best))
}

/// True if a search in the model's own assembly and sense ended no worse than one elsewhere: a coupler that is turned
/// over, or a mirror image, often moves like another design of the model, and is then not worth another assembly.
fn is_as_good_in_own_assembly(searches: &[SearchResult], own: usize, other: usize) -> bool {
    let [own, other] = [own, other].map(|k| &searches[k]);
    let objective = |search: &SearchResult| search.found.as_ref().map_or(f64::INFINITY, |f| f.objective);
    let (a, b) = (objective(own), objective(other));
    let is_equal = own.optimality.met && other.optimality.met || a - b <= NO_WORSE * b.abs();
    own.variant == 0 && other.variant != 0 && own.status == other.status && is_equal
}
