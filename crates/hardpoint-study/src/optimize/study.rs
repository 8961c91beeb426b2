//! Searches from several starts, on several threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use hardpoint::model::{Model, OptimizationSettings};

use super::assessment::{assess, failed_design, limit_scales};
use super::optima::best;
use super::problem::Problem;
use super::request::Request;
use super::result::{Iteration, Optimization, SearchResult};
use super::search::search;
use super::starts::start;
use super::variants::Variant;
use crate::evaluation::{Motions, StudyCost};
use crate::progress::{Control, Progress, Step};

/// Minimises the goals over the design variables. Reports every iteration and the end of every search; of several
/// searches their ends are counted, of a single one its iterations.
///
/// `motions` are those of the model ([`Model::motions`]), in order.
pub fn optimize(
    model: &Model,
    motions: &Motions<'_>,
    request: &Request,
    control: Control<'_>,
) -> Optimization {
    let Request { settings, first } = request;
    let problem = Problem::new(model, motions, settings);
    let Control { progress, more, threads } = control;
    let mut cost = StudyCost::default();
    let (nominal, nominal_failure) = match problem.at(vec![0.0; model.variables.len()], &mut cost, more) {
        Ok(point) => (Some(assess(&problem, &point, &limit_scales(&problem, &point))), None),
        Err(refusal) => (None, Some(failed_design(vec![0.0; model.variables.len()], refusal))),
    };
    let (variants, others) = driven_variants(model, motions, settings, &|| more());
    let problems: Vec<Problem<'_>> = std::iter::once(motions)
        .chain(&others)
        .map(|motions| Problem::new(model, motions, settings))
        .collect();
    let starts: Vec<(usize, Vec<f64>)> = (0..problems.len())
        .flat_map(|variant| (0..settings.starts).map(move |k| (variant, first + k)))
        .map(|(variant, k)| (variant, start(&problem, k)))
        .collect();
    let (next, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
    // Number of searches that have ended, or of iterations of the only one.
    let progress = Mutex::new((0, progress));
    let is_single = starts.len() == 1;
    let total = if is_single { settings.iterations } else { starts.len() };
    let searches = Mutex::new(starts.iter().map(|_| None).collect::<Vec<Option<SearchResult>>>());
    let more = || !ended.load(Ordering::Relaxed) && more();
    let work = || {
        while let Some(k) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|k| *k < starts.len()) {
            let report = |step: Step<'_>, is_counted: bool, counted: &dyn Fn(usize) -> usize| {
                let (done, progress) = &mut *progress.lock().expect("no report before has panicked");
                *done = if is_counted { counted(*done) } else { *done };
                if progress(Progress { step, done: *done, total, is_counted }).is_break() {
                    ended.store(true, Ordering::Relaxed);
                }
            };
            let mut iterated = |i: &Iteration| report(Step::Iteration(i), is_single, &|_| i.number);
            let (variant, start) = &starts[k];
            let search = search(&problems[*variant], *variant, start, &mut iterated, &more);
            report(Step::Search(k, &search), !is_single, &|done| done + 1);
            searches.lock().expect("no search before has panicked")[k] = Some(search);
        }
    };
    match threads.get().min(starts.len()) {
        1 => work(),
        n => std::thread::scope(|scope| (0..n).for_each(|_| drop(scope.spawn(work)))),
    }
    let searches = searches.into_inner().expect("no search has panicked");
    let searches: Vec<SearchResult> =
        searches.into_iter().map(|s| s.expect("every start was searched from")).collect();
    searches.iter().for_each(|s| cost += s.cost);
    Optimization { nominal, nominal_failure, variants, best: best(&searches), searches, cost }
}

/// Variants that can be driven, and the motions of those other than the model itself.
fn driven_variants(
    model: &Model,
    motions: &Motions<'_>,
    settings: &OptimizationSettings,
    more: &dyn Fn() -> bool,
) -> (Vec<Variant>, Vec<Motions<'static>>) {
    let (mut variants, mut others) = (Vec::new(), Vec::new());
    for variant in Variant::all(model, motions, settings, more) {
        if !variant.is_own() {
            let Some(motions) = variant.motions(model, motions) else { continue };
            others.push(motions);
        }
        variants.push(variant);
    }
    (variants, others)
}
