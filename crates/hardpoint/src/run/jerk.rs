//! Jerk over a motion.

use super::{Analysis, PreparedDesign, Walk};
use crate::motion::{BodyJerk, Stop};

/// Third time derivatives of all bodies over a motion.
#[derive(Clone, Debug, Default)]
pub struct Jerks {
    /// Output times that were solved, s.
    pub times: Vec<f64>,
    /// `states[k * bodies + b]`: body b at time k; body 0 is ground.
    pub states: Vec<BodyJerk>,
    /// Number of bodies, ground included.
    pub bodies: usize,
    /// Reason why the run ended before the last output time, if it did.
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
    /// At a jump of the third derivative of a driver's law, the one-sided value of the law itself is used. An
    /// equilibrium is at rest at each time: its jerks are zero, as are its velocities.
    pub fn jerks(&self, design: &[f64]) -> Jerks {
        let design = self.design(design);
        self.jerks_in(&design, usize::MAX, &mut |_| ())
    }

    /// Computes [`Analysis::jerks`] of the nominal design in windows of `rows` output times and calls `each` with one
    /// window after the other.
    pub fn jerks_in_windows(&self, rows: usize, mut each: impl FnMut(&Jerks)) {
        let design = self.design(&[]);
        let last = self.jerks_in(&design, rows, &mut each);
        each(&last);
    }

    fn jerks_in(&self, design: &PreparedDesign, rows: usize, each: &mut dyn FnMut(&Jerks)) -> Jerks {
        let model = self.model();
        let mut walk = Walk::new(self, design, vec![false; model.bodies.len()]);
        let mut result = Jerks { bodies: model.bodies.len(), ..Jerks::default() };
        let mut times = model.times.iter();
        result.stop = walk.each(|one| {
            if result.times.len() >= rows {
                each(&result);
                result.times.clear();
                result.states.clear();
            }
            let Some(&t) = times.next() else { return };
            result.times.push(t);
            if model.equilibrium.is_some() {
                let bodies = result.states.len() + model.bodies.len();
                result.states.resize(bodies, BodyJerk::default());
            } else {
                result.states.extend(BodyJerk::all(&mut one.mechanism, t));
            }
        });
        result
    }
}
