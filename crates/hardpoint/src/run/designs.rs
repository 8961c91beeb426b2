//! Many designs of one mechanism: in batches of eight, on the requested number of threads.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use hardpoint_tape::LANES;

use crate::measure::{MeasureResults, PathAngles, StepValues};
use crate::motion::SolverStatistics;
use crate::motion::design_batch::DesignBatch;
use crate::motion::step_program::Purpose;
use crate::sensitivity::{Resistance, Sensitivities, admissibility, note_defects};

use super::analysis::Analysis;
use super::request::{Run, Scope};
use super::sink::{Sink, hand_over};
use super::solution::{Solution, StreamSummary};

impl Analysis<'_> {
    /// Solves many designs, each with variable k at its entry k (m, rad or a plain number; missing entries are 0).
    /// Calls `visit` with the number of every design and its solution, one at a time. Each thread has memory for eight
    /// solutions: later designs overwrite a solution that `visit` does not take (`std::mem::take`).
    ///
    /// A single thread solves the designs in the given order; with several ([`Run::threads`]) the order is undefined.
    ///
    /// Without sensitivities, designs are solved in batches. If one design of a batch stops, each of them is solved
    /// again on its own, so that every design has its own outcome. Lanes and single runs agree to round-off
    /// (`docs/performance.md`).
    ///
    /// # Panics
    /// Panics if `visit` panics.
    pub fn solve_designs(
        &self,
        run: Run<'_>,
        designs: &[Vec<f64>],
        visit: impl FnMut(usize, &mut Solution) + Send,
    ) {
        let scope = Scope { of_many: designs.len(), ..run.scope };
        let alone =
            scope.sensitivities || scope.measures && (self.depends_on_step() || self.has_times_between());
        let (next, visit) = (AtomicUsize::new(0), Mutex::new(visit));
        let work = || {
            let mut solutions: [Solution; LANES] = std::array::from_fn(|_| Solution::default());
            let mut batch = if alone { None } else { self.design_batch(designs.len(), false, true) };
            let firsts = || Some(LANES * next.fetch_add(1, Ordering::Relaxed));
            for first in std::iter::from_fn(firsts).take_while(|first| *first < designs.len()) {
                let group = &designs[first..usize::min(first + LANES, designs.len())];
                let solutions = &mut solutions[..group.len()];
                self.solve_group(&mut batch, group, scope, solutions);
                let mut visit = visit.lock().expect("a visit before has panicked");
                (first..).zip(solutions).for_each(|(k, solution)| visit(k, solution));
            }
        };
        match run.threads.get() {
            1 => work(),
            n => std::thread::scope(|scope| (0..n).for_each(|_| drop(scope.spawn(work)))),
        }
    }

    /// Solves at most one design per lane: in a batch, or each on its own.
    fn solve_group(
        &self,
        batch: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        scope: Scope,
        solutions: &mut [Solution],
    ) {
        let Some(effort) = self.solve_batch(batch, designs, solutions) else {
            for (design, solution) in designs.iter().zip(solutions) {
                self.solve_prepared(&self.prepare(design, scope), solution);
            }
            return;
        };
        for (design, solution) in designs.iter().zip(solutions) {
            solution.motion.times.extend_from_slice(&self.model().times);
            solution.motion.effort = effort;
            solution.sensitivities = Sensitivities::default();
            (solution.stop, solution.between) = (None, None);
            if scope.measures {
                let design = self.prepare(design, scope);
                self.measure(&design, &StepValues::default(), solution);
                self.solve_between(&design, &mut |_| ControlFlow::Continue(()), solution);
            } else {
                solution.measured = MeasureResults::default();
            }
        }
    }

    /// Solves the motions of all these designs in a batch; returns `None` if one of them fails.
    fn solve_batch(
        &self,
        batch: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        solutions: &mut [Solution],
    ) -> Option<SolverStatistics> {
        let batch = batch.as_mut().filter(|_| self.are_defined(designs))?;
        solutions.iter_mut().for_each(|s| self.make_room(&mut s.motion, 0));
        let effort = batch.run(&self.whole(designs), |_, _| self.flow())?;
        solutions.iter_mut().enumerate().for_each(|(lane, s)| batch.hand_over(lane, &mut s.motion));
        Some(effort)
    }

    /// True if these are several designs, all of whose formulas have values.
    fn are_defined(&self, designs: &[Vec<f64>]) -> bool {
        let is_defined =
            |design: &Vec<f64>| self.design_map().undefined_formula(&self.model().whole(design)).is_none();
        designs.len() > 1 && designs.iter().all(is_defined)
    }

    /// Breaks once the analysis is interrupted: each design is then solved on its own, and stops as interrupted.
    fn flow(&self) -> ControlFlow<()> {
        if self.is_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Completes the designs to one value per variable.
    fn whole(&self, designs: &[Vec<f64>]) -> Vec<Vec<f64>> {
        designs.iter().map(|d| self.model().whole(d)).collect()
    }

    /// Streams like [`Analysis::stream`], for many designs in the given order, eight at a time. The results of every
    /// design, with its sensitivities, go to a sink of its own, which `sink` creates and `end` receives.
    ///
    /// Results of up to eight designs are interleaved. If one design of a batch stops, each of them starts again with a
    /// new sink, so that every design has its own outcome.
    pub fn stream_designs<S: Sink>(
        &self,
        run: Run<'_>,
        designs: &[Vec<f64>],
        mut sink: impl FnMut(usize) -> S,
        mut end: impl FnMut(usize, S, StreamSummary),
    ) {
        let mut batch = self.design_batch(designs.len(), run.scope.sensitivities, false);
        let opens = if run.scope.sensitivities { self.opens() } else { &[] };
        for (group, designs) in designs.chunks(LANES).enumerate() {
            let number = |k: usize| group * LANES + k;
            let mut sinks: Vec<S> = (0..designs.len()).map(|k| sink(number(k))).collect();
            if let Some((effort, mut resisting)) = self.stream_batch(&mut batch, designs, &mut sinks) {
                let steps = self.model().times.len();
                for (k, sink) in sinks.into_iter().enumerate() {
                    let resisting = resisting.drain(..opens.len()).collect();
                    let admissibility = admissibility(opens, resisting, steps);
                    end(number(k), sink, StreamSummary { steps, admissibility, effort, stop: None });
                }
                continue;
            }
            for (k, design) in designs.iter().enumerate() {
                let mut sink = sink(number(k));
                let streamed = self.stream(Run { scope: run.scope, ..Run::new().at(design) }, &mut sink);
                end(number(k), sink, streamed);
            }
        }
    }

    /// Streams all designs in a batch; returns `None` if one of them fails.
    fn stream_batch<S: Sink>(
        &self,
        batch: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        sinks: &mut [S],
    ) -> Option<(SolverStatistics, Vec<Resistance>)> {
        let batch = batch.as_mut().filter(|_| self.are_defined(designs))?;
        let (wanted, moved) = (self.wanted(sinks), batch.moved());
        let variables = self.model().variables.len();
        let mut resisting = vec![(Vec::new(), 0.0); LANES * variables];
        let effort = batch.run(&self.whole(designs), |k, found| {
            let times = [self.model().times[k]; LANES];
            note_defects(
                found.tape,
                self.topology(),
                (&times[..designs.len()], 0),
                (&mut resisting, variables),
            );
            hand_over(&found.block, &wanted, moved.iter().copied(), sinks, 0..designs.len(), |lane| {
                (lane, k)
            });
            self.flow()
        })?;
        Some((effort, resisting))
    }

    /// Batch solver for this number of designs, if that is possible and saves time; stores results if requested.
    fn design_batch(&self, designs: usize, sensitivities: bool, keeps: bool) -> Option<DesignBatch<'_>> {
        let pays = designs > 1 && self.programs_pay(designs);
        // All designs must have the same laws, and the same output times.
        if !pays || self.design_map().laws_change() || self.model().stops_at_limits() {
            return None;
        }
        let program = move |corrections| {
            let purpose = Purpose {
                times: false,
                any_design: true,
                corrections,
                sensitivities,
                margins: false,
                slopes: false,
                loads: false,
            };
            self.program(purpose)
        };
        let batch = DesignBatch::new(self.nominal(), Box::new(program), keeps)?;
        // Turns of angles are counted over the output times of a batch, and not on the way to the first of them.
        let counts =
            || PathAngles::of(self.design_map(), self.topology(), &self.model().whole(&[]), true).is_some();
        (!batch.begins_elsewhere() || !counts()).then_some(batch)
    }
}
