//! Many designs of one mechanism: eight side by side, on as many threads as are requested.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use hardpoint_tape::LANES;

use crate::measure::{MeasureResults, StepValues};
use crate::motion::SolverStatistics;
use crate::motion::design_batch::DesignBatch;
use crate::motion::step_program::Purpose;
use crate::sensitivity::{Resistance, Sensitivities, admissibility, note_defects};

use super::analysis::Analysis;
use super::request::Run;
use super::sink::{Sink, hand_over};
use super::solution::{Solution, StreamSummary};
use super::walk::Scope;

impl Analysis<'_> {
    /// Solves many designs, each with variable k at its entry k (m, rad or a plain number; missing entries are 0), in
    /// the memory of eight solutions for each thread: `visit` sees every design's number and its solution, one at a
    /// time. What it does not take away (`std::mem::take`) is overwritten by later designs.
    ///
    /// One thread goes through them in the order given, several ([`Run::threads`]) in no certain order.
    ///
    /// Without sensitivities, designs are solved side by side. Where one of those stops, each of them is solved again
    /// on its own, so that every design gets its own outcome. Lanes and single runs agree to round-off
    /// (`docs/performance.md`).
    ///
    /// # Panics
    /// If `visit` does.
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
            let mut abreast = if alone { None } else { self.side_by_side(designs.len(), false, true) };
            let firsts = || Some(LANES * next.fetch_add(1, Ordering::Relaxed));
            for first in std::iter::from_fn(firsts).take_while(|first| *first < designs.len()) {
                let group = &designs[first..usize::min(first + LANES, designs.len())];
                let solutions = &mut solutions[..group.len()];
                self.solve_group(&mut abreast, group, scope, solutions);
                let mut visit = visit.lock().expect("a visit before has panicked");
                (first..).zip(solutions).for_each(|(k, solution)| visit(k, solution));
            }
        };
        match run.threads.get() {
            1 => work(),
            n => std::thread::scope(|scope| (0..n).for_each(|_| drop(scope.spawn(work)))),
        }
    }

    /// Up to as many designs as there are lanes: side by side, or each on its own.
    fn solve_group(
        &self,
        abreast: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        scope: Scope,
        solutions: &mut [Solution],
    ) {
        let Some(effort) = self.solve_side_by_side(abreast, designs, solutions) else {
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

    /// The motions of all these designs, or nothing where one of them does not go as expected.
    fn solve_side_by_side(
        &self,
        abreast: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        solutions: &mut [Solution],
    ) -> Option<SolverStatistics> {
        let abreast = abreast.as_mut().filter(|_| designs.len() > 1)?;
        solutions.iter_mut().for_each(|s| self.make_room(&mut s.motion, 0));
        let effort = abreast.run(&self.whole(designs), |_, _| self.flow())?;
        solutions.iter_mut().enumerate().for_each(|(lane, s)| abreast.hand_over(lane, &mut s.motion));
        Some(effort)
    }

    /// Breaks once the analysis is asked to end: each design is then left to itself, and stops as interrupted.
    fn flow(&self) -> ControlFlow<()> {
        if self.is_ended() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// A value for every variable of every design.
    fn whole(&self, designs: &[Vec<f64>]) -> Vec<Vec<f64>> {
        designs.iter().map(|d| self.model().whole(d)).collect()
    }

    /// As [`Analysis::stream`], for many designs in the order given, eight at a time: every design's results, with its
    /// sensitivities, go to a sink of its own, which `sink` makes and `end` gets back.
    ///
    /// Results of up to eight designs come by turns. Where one of those that are solved side by side stops, each of
    /// them begins anew with a new sink, so that every design gets its own outcome.
    pub fn stream_designs<S: Sink>(
        &self,
        run: Run<'_>,
        designs: &[Vec<f64>],
        mut sink: impl FnMut(usize) -> S,
        mut end: impl FnMut(usize, S, StreamSummary),
    ) {
        let mut abreast = self.side_by_side(designs.len(), run.scope.sensitivities, false);
        let opens = if run.scope.sensitivities { self.opens() } else { &[] };
        for (group, designs) in designs.chunks(LANES).enumerate() {
            let number = |k: usize| group * LANES + k;
            let mut sinks: Vec<S> = (0..designs.len()).map(|k| sink(number(k))).collect();
            if let Some((effort, mut resisting)) = self.stream_side_by_side(&mut abreast, designs, &mut sinks)
            {
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

    /// All designs to the end, or nothing where one of them does not go as expected.
    fn stream_side_by_side<S: Sink>(
        &self,
        abreast: &mut Option<DesignBatch<'_>>,
        designs: &[Vec<f64>],
        sinks: &mut [S],
    ) -> Option<(SolverStatistics, Vec<Resistance>)> {
        let abreast = abreast.as_mut().filter(|_| designs.len() > 1)?;
        let (wanted, moved) = (self.wanted(sinks), abreast.moved());
        let variables = self.model().variables.len();
        let mut resisting = vec![(Vec::new(), 0.0); LANES * variables];
        let effort = abreast.run(&self.whole(designs), |k, found| {
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

    /// Batch solver of this number of designs, if that pays and is possible; stores results if requested.
    fn side_by_side(&self, designs: usize, sensitivities: bool, keeps: bool) -> Option<DesignBatch<'_>> {
        let pays = designs > 1 && self.programs_pay(designs);
        // All designs must have the same laws.
        if !pays || self.design_map().laws_change() {
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
        DesignBatch::new(self.started()?, Box::new(program), keeps)
    }
}
