//! Solution of many numbered designs in all motions, shared by Monte Carlo studies and sweeps.
//!
//! Designs are solved in blocks of fixed size, eight of a block batched. The content of a block depends neither on the
//! thread nor on the number of requested designs. Results are therefore independent of threads, and the first designs
//! of a long run equal those of a short run to the last bit.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use hardpoint_tape::LANES;

use hardpoint::model::Model;
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Run, Solution};

use super::evaluation::Motions;

/// Number of designs in a block: large enough to make the cost of starting a block negligible, small enough to respond
/// to an interruption quickly.
pub const BLOCK: usize = 512;

/// Designs to solve, and options.
pub struct SampleRun<'w> {
    /// Numbers of the designs. Start at a multiple of 512: otherwise the first designs are batched with other
    /// neighbours than in a longer run.
    pub numbers: Range<usize>,
    /// Returns the values of all variables of the design with a given number.
    pub design: &'w (dyn Fn(usize) -> Vec<f64> + Sync),
    /// Number of threads.
    pub threads: NonZero<usize>,
    /// Called before every block; returns false to end the run.
    pub more: &'w (dyn Fn() -> bool + Sync),
}

/// Results gathered over a block.
#[derive(Clone, Debug)]
pub struct SampleBlock<A> {
    /// Numbers of the designs.
    pub numbers: Range<usize>,
    /// Gathered results.
    pub found: A,
}

impl Motions<'_> {
    /// Solves many designs in all motions, without sensitivities. `see` gathers the results of a block. It is called
    /// with each design of the block, by number and motion, motion by motion and in ascending order of numbers. `done`
    /// receives the blocks in order and may end the run; it has then received all designs up to some number.
    ///
    /// # Panics
    /// If `see` or `done` panics.
    pub(crate) fn sample<A: Default + Send>(
        &self,
        run: &SampleRun<'_>,
        see: &(dyn Fn(&mut A, usize, usize, &Solution) + Sync),
        done: &mut (dyn FnMut(SampleBlock<A>) -> ControlFlow<()> + Send),
    ) {
        let SampleRun { numbers, design, threads, more } = run;
        let (next, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
        let blocks = numbers.len().div_ceil(BLOCK);
        // Results of blocks that wait for an earlier block, and the number of the next block to report.
        let waiting = Mutex::new((BTreeMap::new(), 0_usize, done));
        let work = || {
            while let Some(block) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|b| *b < blocks) {
                if ended.load(Ordering::Relaxed) || !more() {
                    ended.store(true, Ordering::Relaxed);
                    return;
                }
                let first = numbers.start + block * BLOCK;
                let numbers = first..usize::min(first + BLOCK, numbers.end);
                let found = self.block(numbers.clone(), *design, see);
                let mut turn = waiting.lock().expect("no turn before has panicked");
                let (waiting, now, done) = &mut *turn;
                waiting.insert(block, SampleBlock { numbers, found });
                while let Some(gathered) = waiting.remove(now) {
                    *now += 1;
                    if !ended.load(Ordering::Relaxed) && done(gathered).is_break() {
                        ended.store(true, Ordering::Relaxed);
                    }
                }
            }
        };
        match threads.get().min(blocks) {
            0 | 1 => work(),
            n => std::thread::scope(|scope| (0..n).for_each(|_| drop(scope.spawn(work)))),
        }
    }

    fn block<A: Default + Send>(
        &self,
        numbers: Range<usize>,
        design: &(dyn Fn(usize) -> Vec<f64> + Sync),
        see: &(dyn Fn(&mut A, usize, usize, &Solution) + Sync),
    ) -> A {
        let mut designs: Vec<Vec<f64>> = numbers.clone().map(design).collect();
        // An incomplete last batch is filled up with the designs that would come next. Their results are ignored.
        let full = designs.len().next_multiple_of(LANES);
        designs.extend((numbers.end..).take(full - designs.len()).map(design));
        let mut found = A::default();
        for (motion, analysis) in self.analyses().iter().enumerate() {
            analysis.solve_designs(Run::new().without_sensitivities(), &designs, |k, solution| {
                if k < numbers.len() {
                    see(&mut found, numbers.start + k, motion, solution);
                }
            });
        }
        found
    }
}

/// Reason of a failure: its description without the numbers that depend on the design. Designs that fail for one reason
/// are counted together.
pub(crate) fn failure_reason(stop: &Stop, model: &Model) -> String {
    let kind = match stop.kind {
        StopKind::LimitLoad { .. } => StopKind::LimitLoad { part: 0.0 },
        kind @ (StopKind::Limit
        | StopKind::CurveEnd { .. }
        | StopKind::BranchChange
        | StopKind::DoesNotAssemble
        | StopKind::Locked { .. }
        | StopKind::LawNotFinite { .. }
        | StopKind::LoadNotFinite { .. }
        | StopKind::FormulaNotFinite { .. }
        | StopKind::TooFar { .. }
        | StopKind::JointLimit { .. }
        | StopKind::Interrupted
        | StopKind::NothingHolds { .. }
        | StopKind::NoEquilibrium
        | StopKind::Unstable { .. }
        | StopKind::TooStiff { .. }) => kind,
    };
    Stop { kind, failed_time: 0.0, ..stop.clone() }.headline(model)
}
