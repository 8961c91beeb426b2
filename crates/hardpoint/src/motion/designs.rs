//! Up to eight designs side by side, from one output time to the next, by a straight-line program.
//!
//! They start from where the nominal design does, and every check of a single design's step is made in every lane. Where one
//! fails, nobody knows which design goes another way: each is then solved alone.

use std::sync::Arc;

use hardpoint_tape::{LANES, Lanes};

use crate::model::{BodyId, VariableId};
use crate::space::Real;

use super::Effort;
use super::forecast::{NODES, ORDERS, Weights};
use super::stepper::{Ahead, MILD, MILD_CHANGE, Stepper, TRUST_FLOOR, smooth};
use super::tape::{StepProgram, Tape};
use super::walk::Path;

/// Designs on their way through time.
pub(crate) struct SideBySide<'m> {
    /// Of the nominal design, at the first output time; on the way it knows the laws, and nothing of positions.
    nominal: Stepper<'m, f64>,
    /// With one correction, which serves where the forecast is good, and with two.
    tapes: [Tape; 2],
    /// Which of them has solved the last step.
    by: usize,
    weights: Weights,
    /// Per channel: what is known of it.
    known: Vec<[Lanes; NODES * ORDERS]>,
    /// Times of these positions, the newest first, and how many there are.
    times: [f64; NODES],
    count: usize,
    /// Per unknown coordinate: speed and acceleration at the last step.
    rates: Vec<[Lanes; 2]>,
    /// Per block: the last determinant, and by what part it changed.
    determinants: Vec<Lanes>,
    changes: Vec<Lanes>,
    ratios: Vec<f64>,
}

impl<'m> SideBySide<'m> {
    /// By these programs, with one correction and with two. None where the nominal design is not as drawn at its first output time,
    /// where `nominal` stands: designs could have gone other ways till there.
    pub fn new(nominal: Stepper<'m, f64>, programs: [Arc<StepProgram>; 2]) -> Option<Self> {
        if nominal.saved.drivers.iter().any(|f| f[0] != 0.0) {
            return None;
        }
        let blocks = nominal.topology.blocks.len();
        let tapes = programs.map(Tape::new);
        let (channels, unknowns) = (tapes[0].channels().len(), tapes[0].unknowns().count());
        Some(Self {
            nominal,
            by: 1,
            weights: Weights::default(),
            known: vec![[[0.0; LANES]; NODES * ORDERS]; channels],
            times: [0.0; NODES],
            count: 0,
            rates: vec![[[0.0; LANES]; 2]; unknowns],
            determinants: vec![[0.0; LANES]; blocks],
            changes: vec![[0.0; LANES]; blocks],
            ratios: vec![0.0; blocks],
            tapes,
        })
    }

    /// Which variable moves which body, in the order of the derivatives.
    pub fn moved(&self) -> Vec<(VariableId, BodyId)> {
        self.tapes[0].moved().to_vec()
    }

    /// These designs at all output times, one per lane; `each(k, ...)` sees the results of output time k. None where a step does not go
    /// as expected in some lane.
    pub fn run(&mut self, designs: &[Vec<f64>], each: impl FnMut(usize, &Tape)) -> Option<Effort> {
        let Stepper { time, ahead, fastest_driver, .. } = self.nominal;
        let (drivers, moves) = (self.nominal.saved.drivers.clone(), self.nominal.moves.clone());
        let effort = self.go(designs, each);
        let nominal = &mut self.nominal;
        (nominal.time, nominal.ahead, nominal.fastest_driver) = (time, ahead, fastest_driver);
        (nominal.saved.drivers, nominal.moves) = (drivers, moves);
        effort
    }

    fn go(&mut self, designs: &[Vec<f64>], mut each: impl FnMut(usize, &Tape)) -> Option<Effort> {
        let model = self.nominal.model;
        for tape in &mut self.tapes {
            tape.set_designs(designs);
        }
        let mut effort = Effort { least_pivot_ratio: f64::INFINITY, ..Effort::default() };
        for (k, &t) in model.times.iter().enumerate() {
            if k == 0 {
                self.start(t, &mut effort)?
            } else {
                self.step(t, &mut effort)?
            }
            each(k, &self.tapes[self.by]);
            effort.steps += 1;
            effort.by_program += 1;
            effort.iterations += self.tapes[self.by].passes();
            for &ratio in &self.ratios {
                if ratio < effort.least_pivot_ratio {
                    (effort.least_pivot_ratio, effort.least_pivot_time) = (ratio, t);
                }
            }
        }
        Some(effort)
    }

    /// All designs at the first output time, from where the nominal one is.
    fn start(&mut self, t: f64, effort: &mut Effort) -> Option<()> {
        let saved = &self.nominal.saved;
        let tape = &self.tapes[0];
        for (known, channel) in self.known.iter_mut().zip(tape.channels()) {
            *known = [[0.0; LANES]; NODES * ORDERS];
            known[0] = [channel.saved(&saved.q, &saved.balls); LANES];
        }
        (self.times, self.count) = ([t; NODES], 1);
        let before = saved.determinants.clone();
        self.nominal.drive(Path::Laws, t).ok()?;
        self.solve(1, &[0.0; LANES], effort)?;
        for (b, before) in before.into_iter().enumerate() {
            let now = self.tapes[self.by].determinant(b);
            if !now.iter().all(|x| (MILD[0]..=MILD[1]).contains(&(x / before))) {
                return None;
            }
            self.determinants[b] = now;
        }
        self.count = 0;
        self.save(t);
        Some(())
    }

    /// All designs at the next output time.
    fn step(&mut self, t: f64, effort: &mut Effort) -> Option<()> {
        let h = t - self.nominal.time;
        let nominal = &mut self.nominal;
        nominal.drive(Path::Laws, t).ok()?;
        if !nominal.is_clear(t, h) {
            return None;
        }
        nominal.fastest_driver = nominal.driver_speed();
        let ahead = [h; LANES];
        if self.count < NODES || self.solve(0, &ahead, effort).is_none() {
            self.solve(1, &ahead, effort)?;
        }
        if !self.speeds_are_smooth(h) || !self.determinants_are_even(h) {
            return None;
        }
        for d in 0..self.nominal.drivers.len() {
            let moved = self.nominal.drivers[d][0] - self.nominal.saved.drivers[d][0];
            self.nominal.moves[d] = moved.abs() / self.nominal.driver_units[d];
        }
        self.nominal.ahead = Ahead::Even;
        self.save(t);
        Some(())
    }

    /// Tries one of the tapes, so long beyond the newest position, with the drivers where the nominal stepper has put them.
    fn solve(&mut self, by: usize, ahead: &Lanes, effort: &mut Effort) -> Option<()> {
        self.by = by;
        self.weights.set((self.times.map(|t| t - self.times[0]), self.count), ahead);
        let (tape, nominal) = (&mut self.tapes[by], &self.nominal);
        tape.weights_mut().copy_from_slice(&self.weights.of);
        for (channel, known) in self.known.iter().enumerate() {
            tape.known_mut(channel).copy_from_slice(known);
        }
        for (to, x) in tape.drivers_mut().iter_mut().zip(nominal.drivers.as_flattened()) {
            *to = [*x; LANES];
        }
        let judged = (&nominal.branch[..], &nominal.try_others[..]);
        let residuals = tape.solve(judged, TRUST_FLOOR, &mut self.ratios).ok()?;
        effort.worst_residual = effort.worst_residual.max(residuals.largest);
        Some(())
    }

    /// Whether the speeds are those of the same branch as a step h before.
    fn speeds_are_smooth(&self, h: f64) -> bool {
        let (mut fastest, mut difference) = (0.0, 0.0);
        for ((c, [speeds, _]), [before, acceleration]) in self.tapes[self.by].unknowns().zip(&self.rates) {
            let per_unit = self.nominal.topology.coordinates[c].per_unit;
            for lane in 0..LANES {
                let speed = f64::max(speeds[lane].abs(), before[lane].abs());
                let apart = (speeds[lane] - (before[lane] + acceleration[lane] * h)).abs();
                fastest = Real::larger(fastest, speed * per_unit);
                difference = Real::larger(difference, apart * per_unit);
            }
        }
        smooth(difference, fastest, self.nominal.fastest_driver)
    }

    /// Whether every determinant has changed by little over a step h, and about as much as over the step before.
    fn determinants_are_even(&mut self, h: f64) -> bool {
        let beside = h / self.nominal.change_step;
        let mut even = true;
        for b in 0..self.determinants.len() {
            let now = self.tapes[self.by].determinant(b);
            for lane in 0..LANES {
                let ratio = now[lane] / self.determinants[b][lane];
                let change = ratio - 1.0;
                // Written so that NaN is not even.
                even &= (MILD[0]..=MILD[1]).contains(&ratio);
                if self.nominal.ahead == Ahead::Even {
                    even &= (change - self.changes[b][lane] * beside).abs() <= MILD_CHANGE;
                }
                (self.changes[b][lane], self.determinants[b][lane]) = (change, now[lane]);
            }
        }
        self.nominal.change_step = h;
        even
    }

    /// Goes on from where the designs are at time t.
    fn save(&mut self, t: f64) {
        let tape = &self.tapes[self.by];
        for (channel, known) in self.known.iter_mut().enumerate() {
            known.copy_within(..(NODES - 1) * ORDERS, ORDERS);
            for (order, to) in known[..ORDERS].iter_mut().enumerate() {
                *to = *tape.channel_lanes(channel, order);
            }
        }
        for (to, (_, [speed, acceleration])) in self.rates.iter_mut().zip(tape.unknowns()) {
            *to = [*speed, *acceleration];
        }
        self.times.rotate_right(1);
        self.times[0] = t;
        self.count = usize::min(self.count + 1, NODES);
        self.nominal.saved.drivers.copy_from_slice(&self.nominal.drivers);
        self.nominal.time = t;
    }
}
