//! Guard of the steps from one output time to the next: laws, determinants and speeds that vary little.
//!
//! Close output times are steps themselves, and nothing but their results shows that none of them passes a singular
//! position or a pulse of a law. A step is trusted if
//!
//! - the laws move no driver much farther between two output times than from one to the next;
//! - every determinant changes little, and like in the step before (`docs/theory.md` (28));
//! - the speeds agree with the accelerations of the step before.

use hardpoint_tape::LANES;

use crate::linalg::Factors;
use crate::space::Real;

use super::lookahead::Lookahead;
use super::mechanism::Mechanism;

/// Maximum difference between speeds after a step and their prediction, as a fraction of the fastest coordinate: for a
/// motion that the output times resolve, the difference vanishes with the step.
const SPEED_TRUST: f64 = 0.25;
/// Differences below this fraction of the fastest driver speed are ignored, for a start from rest.
const SPEED_FLOOR: f64 = 1e-3;
/// Allowed ratio of a determinant to that at the output time before. A limit position nearer than 1.5 such steps, or a
/// change point nearer than 3.5, changes it by more (405 motions into such positions, in 20 to 500 output times).
const MILD: [f64; 2] = [0.78, 1.28];
/// Allowed change of this ratio from one such step to the next.
const MILD_CHANGE: f64 = 0.125;
/// Maximum speed of a law between output times, relative to its mean speeds over nearby steps: laws that rest and pulse
/// in between are followed in smaller steps.
const EVEN: f64 = 2.0;
/// A driver that moves by less than this between output times, in rad or sizes, rests.
const RESTS: f64 = 1e-12;
/// Maximum travel of a driver between output times, rad or sizes: whole turns would look like rest.
const LONGEST: f64 = 1.0;
/// Number of output times over which the range of a law is evaluated at once.
const CELL: f64 = 64.0;

/// Guard of the steps of one design, or of one design per lane.
pub(crate) struct StepGuard<const N: usize> {
    blocks: Vec<BlockGuard<N>>,
    drivers: Vec<DriverGuard>,
    /// Length of the last step, and of the last one considered; `None` if no step was trusted from the accepted
    /// position on backwards.
    step: Option<f64>,
    step_ahead: f64,
    /// Speed of the fastest driver so far (rad, or sizes, per s): max abs(f.) / unit.
    pub fastest_driver: f64,
}

/// Determinant of a block at the accepted position, and its relative change over the last step: `r_k - 1` of (28).
#[derive(Clone)]
struct BlockGuard<const N: usize> {
    determinant: [f64; N],
    change: [f64; N],
    /// The same at the end of the steps considered.
    ahead: [[f64; N]; 2],
}

/// Travel of a driver over the last step, `abs(f_k - f_k-1) / unit`, and over the longest of those considered.
#[derive(Clone)]
struct DriverGuard {
    moved: f64,
    ahead: f64,
    /// Maximum speed over an interval of time.
    bound: SpeedBound,
}

/// Maximum speed of a driver over an interval of time.
#[derive(Clone, Copy, Debug)]
struct SpeedBound {
    from: f64,
    to: f64,
    fastest: f64,
}

impl SpeedBound {
    /// Maximum speed of driver d between two times: the bound known for a longer interval, up to `ahead`, if that is
    /// `enough`.
    #[inline(always)]
    fn fastest(&mut self, law: impl Fn(f64, f64) -> f64, [from, to, ahead]: [f64; 3], enough: f64) -> f64 {
        if !(self.from <= from && to <= self.to) {
            *self = Self { from, to: ahead, fastest: law(from, ahead) };
        }
        if self.fastest <= enough { self.fastest } else { law(from, to) }
    }
}

/// Consecutive steps, by the times at which they begin and end.
#[derive(Clone, Copy)]
pub(crate) struct Steps<'t> {
    pub from: f64,
    pub ends: &'t [f64],
}

impl Steps<'_> {
    /// Lengths of the steps.
    #[inline(always)]
    fn lengths(self) -> impl Iterator<Item = f64> {
        let mut before = self.from;
        self.ends.iter().map(move |t| t - std::mem::replace(&mut before, *t))
    }
}

impl<const N: usize> StepGuard<N> {
    /// Guard that knows no step.
    pub fn new(blocks: usize, drivers: usize) -> Self {
        let block = BlockGuard { determinant: [0.0; N], change: [0.0; N], ahead: [[0.0; N]; 2] };
        let bound = SpeedBound { from: 0.0, to: f64::NEG_INFINITY, fastest: 0.0 };
        Self {
            blocks: vec![block; blocks],
            drivers: vec![DriverGuard { moved: 0.0, ahead: 0.0, bound }; drivers],
            step: None,
            step_ahead: 0.0,
            fastest_driver: 0.0,
        }
    }

    /// True if the step to the accepted position was trusted.
    #[inline(always)]
    pub fn knows_a_step(&self) -> bool {
        self.step.is_some()
    }

    /// Starts at a position with these determinants. No step before it is known.
    #[inline(always)]
    pub fn start_at(&mut self, determinants: impl Iterator<Item = f64>) {
        for (b, determinant) in determinants.enumerate() {
            self.blocks[b].determinant = [determinant; N];
        }
        self.step = None;
    }

    /// Determinants of the blocks at the accepted position, in the first lane.
    pub fn determinants(&self) -> impl Iterator<Item = f64> {
        self.blocks.iter().map(|block| block.determinant[0])
    }

    /// Total travel of the drivers over the longest of the steps considered, rad or sizes.
    #[inline(always)]
    pub fn moved(&self) -> f64 {
        self.drivers.iter().map(|driver| driver.ahead).sum()
    }

    /// True if the ends of these steps resolve the laws between them, and no singular position is known to be near.
    /// `values` returns the values of a driver at the ends, and `speed` its largest speed there.
    #[inline(always)]
    pub fn laws_are_resolved<'v>(
        &mut self,
        (mechanism, lookahead): (&Mechanism<'_>, &mut Lookahead),
        steps: Steps<'_>,
        values: impl Fn(usize) -> &'v [f64],
        speed: impl Fn(usize) -> f64,
    ) -> bool {
        let (from, to) = (steps.from, steps.ends[steps.ends.len() - 1]);
        let h = steps.lengths().fold(f64::MIN, f64::max);
        for (d, driver) in self.drivers.iter_mut().enumerate() {
            let (unit, law) = (mechanism.driver_units[d], |from, to| mechanism.parts.fastest(d, from, to));
            let (mut before, mut longest) = (mechanism.saved.drivers[d][0], 0.0_f64);
            for &value in values(d) {
                longest = longest.larger((value - before).abs());
                before = value;
            }
            // max over the steps of abs(f_k - f_k-1) / unit
            driver.ahead = longest / unit;
            // A single step is compared with the step before, too; the first of all cannot be compared.
            let near = match steps.ends.len() {
                1 => self.step.map(|_| f64::max(driver.moved, driver.ahead)),
                _ => Some(driver.ahead),
            };
            // h max abs(f.) <= 2 max abs(f_k - f_k-1): the law is even in between.
            let most = near.map_or(LONGEST, |moved| (EVEN * moved).clamp(RESTS, LONGEST));
            let stretch = [from, to, from + CELL * h];
            let travel = h / unit * driver.bound.fastest(law, stretch, most * unit / h);
            if !(travel <= most) {
                return false;
            }
            lookahead.travel[d] = travel * unit * ((to - from) / h);
        }
        let is_clear = self.step.is_some() || lookahead.is_clear();
        if is_clear {
            self.note_driver_speeds(mechanism, speed);
        }
        is_clear
    }

    /// Records the speeds of the drivers.
    #[inline(always)]
    pub fn note_driver_speeds(&mut self, mechanism: &Mechanism<'_>, speed: impl Fn(usize) -> f64) {
        for (d, unit) in mechanism.driver_units.iter().enumerate() {
            self.fastest_driver = self.fastest_driver.max(speed(d) / unit);
        }
    }

    /// True if every determinant changes little over each of these steps, and like over the step before.
    /// `determinant(b, k)` is that of block b at the end of step k.
    #[inline(always)]
    pub fn determinants_are_even(
        &mut self,
        factors: &[Factors<f64>],
        steps: Steps<'_>,
        determinant: impl Fn(usize, usize) -> [f64; N],
    ) -> bool {
        // h_k / h_k-1; the first step of all has none before it.
        let mut scales = [0.0; LANES];
        let mut before = self.step;
        for (k, h) in steps.lengths().enumerate() {
            (scales[k], before) = (before.map_or(0.0, |before| h / before), Some(h));
            self.step_ahead = h;
        }
        let first_compared = usize::from(self.step.is_none());
        let mut even = true;
        for (b, block) in self.blocks.iter_mut().enumerate() {
            let [mut before, mut change] = [block.determinant, block.change];
            for (k, scale) in scales[..steps.ends.len()].iter().enumerate() {
                let now = determinant(b, k);
                for lane in 0..N {
                    // r_k = det_k / det_k-1 in [0.78, 1.28],                                              (28)
                    // abs((r_k - 1) - (r_k-1 - 1) h_k / h_k-1) <= 0.125
                    let ratio = factors[b].ratio(now[lane], before[lane]);
                    let changed = ratio - 1.0;
                    // NaN is not even.
                    even &= (MILD[0]..=MILD[1]).contains(&ratio);
                    even &= k < first_compared || (changed - change[lane] * scale).abs() <= MILD_CHANGE;
                    change[lane] = changed;
                }
                before = now;
            }
            block.ahead = [before, change];
        }
        even
    }

    /// True if this difference between speeds and their prediction belongs to the same branch, for this maximum speed
    /// of the coordinates.
    #[inline(always)]
    pub fn speeds_are_smooth(&self, difference: f64, fastest: f64) -> bool {
        // NaN is rejected.
        // max abs(q. - predicted) <= max(0.25 max abs(q.), 1e-3 max abs(f.)): speeds on another branch differ by more
        difference <= f64::max(SPEED_TRUST * fastest, SPEED_FLOOR * self.fastest_driver)
    }

    /// Accepts the steps considered.
    #[inline(always)]
    pub fn accept(&mut self) {
        for block in &mut self.blocks {
            [block.determinant, block.change] = block.ahead;
        }
        self.accept_laws(self.step_ahead);
    }

    /// Accepts a step h, as far as laws are concerned.
    #[inline(always)]
    pub fn accept_laws(&mut self, h: f64) {
        for driver in &mut self.drivers {
            driver.moved = driver.ahead;
        }
        self.step = Some(h);
    }

    /// Forgets the last step.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.step = None;
    }
}
