//! Many designs in all motions, each by its number: what Monte Carlo, sweeps and their like have in common.
//!
//! Designs go in blocks of fixed size, and eight of a block side by side. A block is the same whoever solves it and
//! however many are requested, so that no result depends on threads, and the first designs of many are those of few, to
//! the last bit.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use hardpoint_tape::LANES;

use crate::run::{Run, Solution};

use super::evaluation::Motions;

/// Designs of one block: enough that what begins a block counts for nothing beside it, few enough that an interruption
/// is soon heard.
pub const BLOCK: usize = 512;

/// Designs to solve, and options.
pub struct SampleRun<'w> {
    /// The numbers of the designs. They begin with a multiple of 512, or the first designs are not solved beside those
    /// that they would be beside in a longer run.
    pub numbers: Range<usize>,
    /// The values of all variables of the design of a number.
    pub design: &'w (dyn Fn(usize) -> Vec<f64> + Sync),
    /// On that many threads.
    pub threads: NonZero<usize>,
    /// Is asked before every block whether to go on.
    pub more: &'w (dyn Fn() -> bool + Sync),
}

/// Results gathered over a block.
#[derive(Clone, Debug)]
pub struct SampleBlock<A> {
    /// The designs.
    pub numbers: Range<usize>,
    /// Gathered results.
    pub found: A,
}

impl Motions<'_> {
    /// Solves many designs in all motions, without sensitivities. Of every block `see` gathers what is wanted: it is
    /// shown each design of it, by its number and the motion, motion by motion and in the order of their numbers.
    /// `done` is given the blocks in order, and may end the work; what was given to it then are all designs up to some
    /// number.
    ///
    /// # Panics
    /// If `see` or `done` does.
    pub fn sample<A: Default + Send>(
        &self,
        run: &SampleRun<'_>,
        see: &(dyn Fn(&mut A, usize, usize, &Solution) + Sync),
        done: &mut (dyn FnMut(SampleBlock<A>) -> ControlFlow<()> + Send),
    ) {
        let SampleRun { numbers, design, threads, more } = run;
        let (next, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
        let blocks = numbers.len().div_ceil(BLOCK);
        // What was found of blocks whose turn has not come, and whose turn it is.
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
        // A last group that is not full is filled with designs that nobody sees: those that would come next.
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
