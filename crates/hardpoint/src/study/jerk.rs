//! Jerk over a motion.

use fearless_simd::{Level, dispatch};

use crate::analysis::{Analysis, Design, Solved, Walk};
use crate::motion::jerk::Jerk;
use crate::motion::stepper::Stepper;
use crate::motion::{BodyJerk, Stop};
use crate::space::{Real, lanes, of_lanes};

/// Third time derivatives of all bodies over a motion.
#[derive(Clone, Debug, Default)]
pub struct Jerks {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// `states[k * bodies + b]` at time k of body b; body 0 is ground.
    pub states: Vec<BodyJerk>,
    /// How many bodies there are, ground included.
    pub bodies: usize,
    /// Why the run ended before the last output time, if it did.
    pub stop: Option<Stop>,
}

impl Jerks {
    /// Jerks of all bodies at output time k.
    pub fn at(&self, k: usize) -> &[BodyJerk] {
        &self.states[k * self.bodies..(k + 1) * self.bodies]
    }
}

impl Analysis<'_> {
    /// Jerk of all bodies over the motion of the design with variable k at `design[k]`.
    ///
    /// Where the third derivative of a driver's law jumps, it is that on the side which the law itself gives.
    pub fn jerks(&self, design: &[f64]) -> Jerks {
        let design = self.design(design, false);
        dispatch!(Level::new(), simd => self.jerks_in(&design, usize::MAX, &mut |_| (), lanes(simd)))
    }

    /// As [`Analysis::jerks`] of the nominal design, so many output times at a time: `each` sees them one part after the other.
    pub fn jerks_in_windows(&self, rows: usize, mut each: impl FnMut(&Jerks)) {
        let design = self.design(&[], false);
        let last = dispatch!(Level::new(), simd => self.jerks_in(&design, rows, &mut each, lanes(simd)));
        each(&last);
    }

    fn jerks_in<T: Real>(
        &self,
        design: &Design,
        rows: usize,
        each: &mut dyn FnMut(&Jerks),
        witness: T,
    ) -> Jerks {
        let (model, topology) = (self.model(), self.topology());
        let mut one = Jerk::new(model, topology, 0.0);
        let mut all = Jerk::new(model, topology, witness);
        let mut walk = Walk::new(self, design, vec![false; model.bodies.len()], witness);
        let mut result = Jerks { bodies: model.bodies.len(), ..Jerks::default() };
        let mut done = 0;
        result.stop = walk.each(self, |solved, count| {
            if result.times.len() >= rows {
                each(&result);
                result.times.clear();
                result.states.clear();
            }
            let times = &model.times[done..done + count];
            done += count;
            match solved {
                Solved::One(stepper) => add(&mut one, stepper, times, &mut result),
                Solved::Abreast(stepper) => add(&mut all, stepper, times, &mut result),
            }
        });
        result
    }
}

/// Appends what is found at these times, one per lane.
fn add<T: Real>(jerk: &mut Jerk<T>, stepper: &mut Stepper<'_, T>, times: &[f64], result: &mut Jerks) {
    jerk.solve(stepper, &of_lanes(times));
    for (lane, &t) in times.iter().enumerate() {
        result.times.push(t);
        result.states.extend((0..result.bodies).map(|b| jerk.of_body(stepper, b, lane)));
    }
}
