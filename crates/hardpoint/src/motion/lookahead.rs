//! Lookahead along a path: the longest step that stays clear of singular positions, and the prediction to its end.
//!
//! A step is measured in travel of the drivers, not in time: the range of each law over the step is known
//! ([`crate::law::Law::over`]), so a law that hurries, rests, turns round or pulses between two output times is
//! followed all the same. The position is predicted along the drivers, too, so kinks of laws need no care.

use crate::model::Contact;
use crate::space::Real;

use super::mechanism::Mechanism;
use super::path::Path;
use super::singularity::{SingularityAhead, Surroundings, Workspace};
use super::turns::{FINEST, TURN_TRUST, TurnCounter};

/// Maximum step as a fraction of the estimated distance to the nearest singular position. The estimate is 0.94 to 2.17
/// times the true distance (`docs/theory.md`, section 4), so that no step passes it.
pub(super) const PART_OF_WAY: f64 = 0.4;
/// Maximum step as a fraction of the distance estimated at its far end: the step back would be 0.67 of it, and a near
/// singular position that symmetry hides from one end shows from the other.
const PART_FROM_FAR_END: f64 = 2.5 / (1.0 - PART_OF_WAY) * PART_OF_WAY;
/// Maximum travel of a driver in a step, rad or sizes of its loop: symmetry may hide a singular position entirely, and
/// in uniform rotation there is none.
pub(super) const LONGEST: f64 = 1.0;
/// Maximum change of an unknown coordinate in a step; otherwise the turn of an angle is ambiguous.
const LONGEST_MOVE: f64 = 2.0;

/// Knowledge of the path ahead of the accepted position, with the travel of the step considered.
pub(crate) struct Lookahead {
    /// True if the surroundings of the accepted position are known.
    pub is_known: bool,
    /// Surroundings of the accepted position, and of the far end of a step.
    around: Surroundings,
    beyond: Surroundings,
    /// Made on first use; batches of steps do not need it.
    workspace: Option<Box<Workspace>>,
    /// Per direction: its maximum travel over the step considered.
    /// Du of theory (22): m or rad, and on a path other than the laws' its parameter.
    pub travel: Vec<f64>,
    /// Scratch of predictions: the move of each coordinate.
    moves: Vec<f64>,
    /// Per curve: the predicted parameter, and its distance from the one before.
    pub contacts: Vec<[f64; 2]>,
}

impl Lookahead {
    pub fn new(mechanism: &Mechanism<'_>) -> Self {
        Self {
            is_known: false,
            around: Surroundings::unknown(),
            beyond: Surroundings::unknown(),
            workspace: None,
            travel: vec![0.0; usize::max(mechanism.drivers.len(), 1)],
            moves: vec![0.0; mechanism.topology.coordinates.len()],
            contacts: vec![[0.0; 2]; mechanism.state.contacts.len()],
        }
    }

    /// Surroundings of the accepted position.
    pub fn around(&self) -> &Surroundings {
        &self.around
    }

    /// Examines the surroundings of the state, the far end of a step: along each driver alone, or along the whole path
    /// if all move together.
    pub fn examine(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        path: Path,
        turns: Option<&mut TurnCounter<'_>>,
    ) {
        let turns = turns.filter(|_| path != Path::Assembly);
        let workspace = self.workspace.get_or_insert_with(|| Box::new(Workspace::new(mechanism)));
        workspace.examine(mechanism, path, turns, &mut self.beyond);
    }

    /// Moves on to the far end of the step, the accepted position now.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.around, &mut self.beyond);
        self.is_known = true;
    }

    /// Singular position ahead on the path, seen from the position of the state; `None` if nothing was examined yet.
    /// With a driver it is that ahead of this driver alone, by its travel.
    pub fn singularity(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        path: Path,
        alone: Option<usize>,
    ) -> Option<SingularityAhead> {
        self.workspace.as_mut()?.ahead(mechanism, path, alone)
    }

    /// Measures the maximum travel of each direction over a step h of the path.
    pub fn measure_travel(&mut self, mechanism: &Mechanism<'_>, path: Path, h: f64) {
        let saved = &mechanism.saved;
        match path {
            Path::Assembly | Path::Line { .. } => self.travel[0] = h,
            Path::Laws => {
                for d in 0..mechanism.drivers.len() {
                    // Du_d = max over [t, t + h] of abs(f_d - f_d(t)), from above
                    let stretch = [saved.time, saved.time + h];
                    self.travel[d] = mechanism.parts.travel(d, stretch[0], stretch[1], saved.drivers[d][0]);
                }
            }
        }
    }

    /// Measures the maximum travel of each direction over a stretch of a path, like
    /// [`measure_travel`](Self::measure_travel).
    pub fn measure_stretch(&mut self, mechanism: &Mechanism<'_>, path: Path, from: f64, to: f64) {
        match path {
            Path::Assembly | Path::Line { .. } => self.travel[0] = to - from,
            Path::Laws => {
                for d in 0..mechanism.drivers.len() {
                    let start = mechanism.parts.law(d, from)[0];
                    let travel = mechanism.parts.travel(d, from, to, start);
                    // A NaN travel counts as too far.
                    self.travel[d] = if travel.is_nan() { f64::INFINITY } else { travel };
                }
            }
        }
    }

    /// The largest travel measured last, rad or sizes.
    pub fn travelled(&self, mechanism: &Mechanism<'_>, path: Path) -> f64 {
        match path {
            Path::Assembly | Path::Line { .. } => self.travel[0] * mechanism.unit_of(path),
            Path::Laws => {
                let of_driver = |d: usize| self.travel[d] / mechanism.driver_units[d];
                (0..mechanism.drivers.len()).map(of_driver).fold(0.0, f64::max)
            }
        }
    }

    /// Longest step along a path, at most `rest`, that stays clear of singular positions, with its travel; `shortest`
    /// if there is none.
    pub fn longest_step(&mut self, mechanism: &Mechanism<'_>, path: Path, [shortest, rest]: [f64; 2]) -> f64 {
        let mut h = rest;
        loop {
            self.measure_travel(mechanism, path, h);
            // sum Du_d / rho_d <= 0.4,    max over the unknowns of sum abs(q_d') Du_d <= 2,    Du_d <= 1
            let part = self.part_of_way() / PART_OF_WAY;
            let moved = self.around.move_of_fastest(&self.travel) / LONGEST_MOVE;
            let travelled = self.travelled(mechanism, path);
            // max over the counted angles of sum abs(chi_d') Du_d <= 1
            let turned =
                if travelled > FINEST { self.around.turn_of_fastest(&self.travel) / TURN_TRUST } else { 0.0 };
            let much = part.max(moved).max(travelled / LONGEST).max(turned);
            if much <= 1.0 || h <= shortest {
                return h;
            }
            // If the travel is proportional to h, the first guess is right; ranges of laws over long steps may be
            // wider.
            h = (h * (0.95 / much).clamp(0.02, 0.9)).max(shortest);
        }
    }

    /// Travel measured, as a fraction of the distance to the nearest singular position.
    #[inline(always)]
    pub fn part_of_way(&self) -> f64 {
        self.around.part_of_way(&self.travel)
    }

    /// True if no singular position is known to be near, for the travel measured.
    #[inline(always)]
    pub fn is_clear(&self) -> bool {
        self.part_of_way() <= PART_OF_WAY
    }

    /// True if the far end of the step is clear of singular positions, too.
    pub fn is_clear_beyond(&self) -> bool {
        // sum Du_d / rho_d <= 1.67 with rho_d of the far end
        self.beyond.part_of_way(&self.travel) <= PART_FROM_FAR_END
    }

    /// Predicts the position for the present values of the drivers, `q + sum over the directions of q' du + q'' du^2 /
    /// 2`; returns the largest move, rad or sizes.
    pub fn predict(&mut self, mechanism: &mut Mechanism<'_>, path: Path, h: f64) -> f64 {
        mechanism.restore();
        let Mechanism { topology, parts, state, drivers, saved, .. } = mechanism;
        self.moves.fill(0.0);
        for k in 0..state.contacts.len() {
            self.contacts[k][0] = state.contacts[k].u;
        }
        for k in 0..path.directions(drivers.len()) {
            let du = path.travel_of(k, h, [&saved.drivers, drivers]);
            // q + sum over the drivers of (q_d' Du_d + q_d'' Du_d^2 / 2); mixed second derivatives are left to Newton's
            // method.
            let half = du * du * 0.5;
            let (slopes, bends) = (&self.around.slopes[k], &self.around.bends[k]);
            for (c, moved) in self.moves.iter_mut().enumerate() {
                *moved = bends[c].times_plus(half, slopes[c].times_plus(du, *moved));
            }
            for &r in &topology.coupler_terms {
                let [slope, bend] = self.around.turning[k][r.0];
                state.near[r.0] += slope * du + bend * half;
            }
            // u + u' Du + u'' Du^2 / 2
            for c in 0..self.contacts.len() {
                let [slope, bend] = self.around.sliding[k][c];
                self.contacts[c][0] += slope * du + bend * half;
            }
        }
        for (k, contact) in state.contacts.iter_mut().enumerate() {
            let [u, moved] = &mut self.contacts[k];
            *moved = (*u - contact.u).abs();
            *contact = Contact::at(&parts.curves[k], *u);
        }
        let mut most = 0.0_f64;
        for c in topology.unknown_coordinates() {
            state.q[c.0] += self.moves[c.0];
            most = most.max((self.moves[c.0] * topology[c].per_unit).abs());
        }
        state.turn_balls(topology, topology.link_ids());
        most
    }

    /// Counts angles over a step h to the present state; returns true if each is in the turn that is predicted along
    /// the drivers from both ends, or if the step is too short to ask for more.
    pub fn follow_turns(
        &self,
        mechanism: &Mechanism<'_>,
        (path, h): (Path, f64),
        turns: &mut TurnCounter<'_>,
    ) -> bool {
        let Mechanism { state, drivers, saved, .. } = mechanism;
        let sure = turns.follow(state, |i| {
            let (mut ahead, mut back, mut far) = (0.0, 0.0, 0.0);
            for k in 0..path.directions(drivers.len()) {
                let du = path.travel_of(k, h, [&saved.drivers, drivers]);
                // chi_d' Du_d + chi_d'' Du_d^2 / 2 of this end,  chi_d' Du_d - chi_d'' Du_d^2 / 2 of the far one
                let half = 0.5 * du * du;
                let ([slope, bend], [slope_there, bend_there]) =
                    (self.around.angles[k][i], self.beyond.angles[k][i]);
                ahead += slope * du + bend * half;
                back += slope_there * du - bend_there * half;
                far += (slope_there * self.travel[k]).abs();
            }
            [ahead, back, far]
        });
        let counts = sure || self.travelled(mechanism, path) <= FINEST;
        if counts {
            turns.accept();
        }
        counts
    }
}
