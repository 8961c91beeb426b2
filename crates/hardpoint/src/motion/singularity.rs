//! Distance to the nearest singular position ahead, independent of the drivers' laws.
//!
//! Near a singular position the response of a loop to a load, `s = J^-1 r` with r a fixed disturbance of its rows,
//! grows like `(u* - u)^-m` along the motion: m = 1/2 at a limit, beyond which the loop cannot be closed, and m = 1
//! where two motions meet. s shows a singular position from a distance, where the motion itself still looks smooth,
//! even if the motion only passes near it. With its series along a direction,
//!
//! ```text
//! c0 = J^-1 r,   c1 = -J^-1 (J' c0),   c2 = -J^-1 (J'' c0 / 2 + J' c1)                     docs/theory.md (22)
//! ```
//!
//! `max(|c1| / |c0|, sqrt(|c2| / |c0|))` is the inverse of the distance to the nearest singular position, within a
//! factor of about two. c0, c1, c2 solve the same equations as a sensitivity by a length in every row; they need only
//! velocity and acceleration of the motion.
//!
//! The directions are the drivers, one by one: the distance does not depend on the speeds of the drivers.

use crate::number;
use crate::space::{Real, Twist, Wrench};
use crate::topology::{BlockId, CoordinateId, Topology};

use super::kinematics::State;
use super::level::Flow;
use super::mechanism::Mechanism;
use super::parts::PlanGeometry;
use super::path::Path;
use super::turns::TurnCounter;

/// Number of loads on the rows. One could miss a singular position; two have not (270 hard cases in the plane and in
/// space).
const LOADS: usize = 2;

/// Neighbourhood of a position: the response of the mechanism to its drivers.
#[derive(Clone, Debug)]
pub(crate) struct Surroundings {
    /// Per direction and block: the inverse distance to the nearest singular position, per unit of the direction.
    /// 1/rho of (22), per rad or m of the driver.
    nearness: Vec<Vec<f64>>,
    /// Per direction: first and second derivatives of the coordinates by it.
    pub slopes: Vec<Vec<f64>>,
    pub bends: Vec<Vec<f64>>,
    /// Per direction and row of a coupler's term: first and second derivatives of its coordinate.
    pub turning: Vec<Vec<[f64; 2]>>,
    /// Per direction and angle that is counted along the path: first and second derivatives of the angle.
    pub angles: Vec<Vec<[f64; 2]>>,
    /// Per direction and curve: first and second derivatives of the contact parameter.
    pub sliding: Vec<Vec<[f64; 2]>>,
    /// Per direction: the fastest unknown coordinate, in its unit; of curves the parameter, in lengths between their
    /// points.
    pub fastest: Vec<f64>,
    /// Number of known directions.
    known: usize,
}

/// A singular position ahead, by the series of one block's response along a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SingularityAhead {
    /// The block that becomes singular.
    pub block: BlockId,
    /// Distance ahead, in units of the direction; negative if the position is behind.
    pub distance: f64,
    /// m of (22) and (23): the response goes like distance^-m, with m about 1/2 at a limit, 1 where two motions meet.
    pub power: f64,
}

/// Working memory.
#[derive(Clone, Debug)]
pub(super) struct Workspace {
    /// The motion along a direction, in place of that along the time, and the rates of all twists and wrenches. `q'`,
    /// `q''` of the coordinates and the twists of the bodies, a prime being d/du along a driver u with all others at
    /// rest.
    motion: Flow<f64>,
    /// x', x''.
    x: [Vec<Twist<f64>>; 2],
    /// l', l''.
    l: [Vec<Wrench<f64>>; 2],
    /// Per load and row: r of (22), +-(0.5 to 1) of the row's unit.
    loads: [Vec<f64>; LOADS],
    /// The series of the response, of one block at a time: c0, c1 and 2 c2 of its coordinates.
    response: Flow<f64>,
    drivers: Vec<[f64; 3]>,
}

impl Surroundings {
    /// Neighbourhood without known directions.
    pub fn unknown() -> Self {
        Self {
            nearness: Vec::new(),
            slopes: Vec::new(),
            bends: Vec::new(),
            turning: Vec::new(),
            angles: Vec::new(),
            sliding: Vec::new(),
            fastest: Vec::new(),
            known: 0,
        }
    }

    /// Reserves memory for this number of directions.
    fn make_room(&mut self, topology: &Topology, directions: usize) {
        self.known = directions;
        if self.fastest.len() >= directions {
            return;
        }
        let zero = 0.0;
        self.nearness.resize(directions, vec![zero; topology.blocks.len()]);
        self.slopes.resize(directions, vec![zero; topology.coordinates.len()]);
        self.bends.resize(directions, vec![zero; topology.coordinates.len()]);
        let rows = if topology.coupled_rows.is_empty() { 0 } else { topology.rows.len() };
        self.turning.resize(directions, vec![[zero; 2]; rows]);
        self.angles.resize(directions, Vec::new());
        let curves = topology.closures.iter().filter(|c| c.contact.is_some()).count();
        self.sliding.resize(directions, vec![[zero; 2]; curves]);
        self.fastest.resize(directions, zero);
    }

    /// Admissible step as a fraction of the distance to the nearest singular position, if each direction moves by at
    /// most `travel`.
    pub fn part_of_way(&self, travel: &[f64]) -> f64 {
        let mut most = 0.0;
        for b in 0..self.nearness.first().map_or(0, Vec::len) {
            let of_block = travel[..self.known].iter().zip(&self.nearness);
            // sum over the drivers of Du_d / rho_d
            let sum: f64 = of_block.map(|(du, nearness)| part(*du, nearness[b])).sum();
            // NaN counts as far too much.
            if !(sum <= most) {
                most = if sum.is_nan() { f64::INFINITY } else { sum };
            }
        }
        most
    }

    /// Displacement of the fastest coordinate, in its unit, if each direction moves by at most `travel`.
    pub fn move_of_fastest(&self, travel: &[f64]) -> f64 {
        travel[..self.known].iter().zip(&self.fastest).map(|(du, speed)| part(*du, *speed)).sum()
    }

    /// Displacement of the fastest counted angle, rad, if each direction moves by at most `travel`.
    pub fn turn_of_fastest(&self, travel: &[f64]) -> f64 {
        let angles = self.angles.first().map_or(0, Vec::len);
        let of_angle = |i: usize| -> f64 {
            travel[..self.known]
                .iter()
                .zip(&self.angles)
                .map(|(du, angles)| part(*du, angles[i][0].abs()))
                .sum()
        };
        // An angle that is NaN or unbounded here is ignored.
        (0..angles).map(of_angle).filter(|turn| turn.is_finite()).fold(0.0, f64::max)
    }
}

/// Product in which zero times NaN or infinity is zero.
fn part(travel: f64, per_unit: f64) -> f64 {
    if travel == 0.0 { 0.0 } else { travel * per_unit }
}

impl Workspace {
    pub fn new(mechanism: &Mechanism<'_>) -> Self {
        let Mechanism { topology, state, drivers, .. } = mechanism;
        let bodies = state.pose.len();
        let (coordinates, rows) = (topology.coordinates.len(), topology.rows.len());
        // Multiples of the golden ratio are uniformly distributed and never repeat: all loads differ, and none is
        // small.
        let mut numbers = (1..).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract());
        let mut load = || -> Vec<f64> {
            let mut next = || numbers.next().expect("there is always another");
            let of_row = |unit: f64| {
                let (size, side) = (0.5 + 0.5 * next(), next());
                unit * if side < 0.5 { -size } else { size }
            };
            topology.rows.iter().map(|place| place.unit).map(of_row).collect()
        };
        Self {
            motion: Flow::new(topology, bodies, true),
            x: std::array::from_fn(|_| vec![Twist::ZERO; coordinates]),
            l: std::array::from_fn(|_| vec![Wrench::zero(); rows]),
            loads: std::array::from_fn(|_| load()),
            response: Flow::new(topology, bodies, false),
            drivers: vec![[0.0; 3]; drivers.len()],
        }
    }

    /// Exchanges the rates along a direction with those along time.
    fn swap(&mut self, state: &mut State<f64>) {
        std::mem::swap(&mut self.motion, &mut state.motion);
        self.x.swap_with_slice(&mut state.x[1..]);
        self.l.swap_with_slice(&mut state.l[1..]);
    }

    /// Examines the position of a mechanism, with its factors, along each direction of a path.
    pub fn examine(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        path: Path,
        mut turns: Option<&mut TurnCounter<'_>>,
        found: &mut Surroundings,
    ) {
        let directions = path.directions(mechanism.drivers.len());
        found.make_room(&mechanism.topology, directions);
        self.swap(&mut mechanism.state);
        let gap = std::mem::replace(&mut mechanism.state.gap_left[1], path.gap_rate());
        for direction in 0..directions {
            for (d, driver) in self.drivers.iter_mut().enumerate() {
                // On the laws' path f' = 1 of one driver, 0 of the others: the distance does not depend on the speed of
                // a driver. f'' = 0
                *driver = [0.0, mechanism.speed_along(path, direction, d), 0.0];
            }
            let Mechanism { topology, parts, state, .. } = &mut *mechanism;
            self.rates(topology, parts, state);
            // q' and q'' by (9) and (10), with f' of this direction in the place of f.
            found.slopes[direction].copy_from_slice(&state.motion.speeds[0]);
            found.bends[direction].copy_from_slice(&state.motion.speeds[1]);
            for &r in &topology.coupler_terms {
                // chi' and chi'' of what a coupler counts
                let [_, speed, rate] = state.coordinate_of_row(topology, r);
                found.turning[direction][r.0] = [speed, rate];
            }
            match &mut turns {
                Some(turns) => turns.slopes(state, &mut found.angles[direction]),
                None => found.angles[direction].clear(),
            }
            let mut fastest = 0.0;
            for c in topology.unknown_coordinates() {
                let speed = state.motion.speeds[0][c.0] * topology[c].per_unit;
                fastest = fastest.larger(speed.abs());
            }
            for (c, k) in topology.contacts() {
                // u' and u'' of where a curve is touched
                let [speed, rate] = state.sliding(topology, c, k);
                found.sliding[direction][k] = [speed, rate];
                fastest = fastest.larger((speed / parts.curves[k].grain()).abs());
            }
            found.fastest[direction] = fastest;
            for b in topology.block_ids() {
                let mut nearness = 0.0;
                for load in 0..LOADS {
                    // 1/rho_b = max over the loads                                                                 (22)
                    nearness = nearness.larger(self.respond(topology, state, b, load));
                }
                found.nearness[direction][b.0] = nearness;
            }
        }
        mechanism.state.gap_left[1] = gap;
        self.swap(&mut mechanism.state);
    }

    /// First singular position that the motion reaches at the present speeds of the drivers, or at unit speed of one
    /// driver `alone`: that of the block with the strongest response.
    pub fn ahead(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        path: Path,
        alone: Option<usize>,
    ) -> Option<SingularityAhead> {
        let Mechanism { topology, parts, state, drivers, .. } = mechanism;
        match alone {
            // Along the motion as it goes: f., f.. of all drivers together, so that the distance is a time.
            None => self.drivers.copy_from_slice(drivers),
            // The distance as a travel of this driver, f' = 1
            Some(driver) => {
                self.drivers.fill([0.0; 3]);
                self.drivers[driver][1] = 1.0;
            }
        }
        self.swap(state);
        let gap = std::mem::replace(&mut state.gap_left[1], path.gap_rate());
        let mut nearest: Option<(f64, SingularityAhead)> = None;
        self.rates(topology, parts, state);
        for b in topology.block_ids() {
            for load in 0..LOADS {
                let nearness = self.respond(topology, state, b, load);
                let Some(ahead) = self.extrapolate(topology, b) else { continue };
                // The block and load with the steepest response determine the nearest position.
                if nearest.is_none_or(|(most, _)| nearness > most) {
                    nearest = Some((nearness, ahead));
                }
            }
        }
        state.gap_left[1] = gap;
        self.swap(state);
        nearest.map(|(_, ahead)| ahead)
    }

    /// Velocity and acceleration along the drivers' speeds, and all rates of twists and wrenches.
    fn rates(&mut self, topology: &Topology, parts: &PlanGeometry<f64>, state: &mut State<f64>) {
        for (c, d) in topology.driven_coordinates() {
            [_, state.motion.speeds[0][c.0], state.motion.speeds[1][c.0]] = self.drivers[d.0];
        }
        state.all_rates(topology, parts, &self.drivers);
    }

    /// Computes the response of a block to a load: c0, c1 and 2 c2 of its unknowns, with all bodies outside of it
    /// fixed. Returns the inverse distance of the nearest singular position.
    #[inline(never)]
    fn respond(&mut self, topology: &Topology, state: &mut State<f64>, b: BlockId, load: usize) -> f64 {
        let (block, response) = (&topology[b], &mut self.response);
        // (24) with z = 0 and f = r, which is at rest.
        for r in block.closures.iter().flat_map(|&c| topology[c].row_ids()) {
            // J c0 = r
            response.demand[r.0] = if topology[r].is_term { 0.0 } else { self.loads[load][r.0] };
        }
        response.solve::<0>(topology, b, state.linear());
        block.closures.iter().for_each(|&c| response.ask(topology, c, 0.0));
        // J c1 = -J' c0: order 1 of (24) with f' = 0
        response.solve::<1>(topology, b, state.linear());
        block.closures.iter().for_each(|&c| response.ask(topology, c, 0.0));
        // J (2 c2) = -2 J' c1 - J'' c0: order 2 of (24), u(2) = s'' = 2 c2
        response.solve::<2>(topology, b, state.linear());
        // The next block is examined by itself.
        for k in block.link_ids() {
            response.twists.iter_mut().for_each(|twists| twists[topology[k].child.0] = Twist::ZERO);
        }
        self.nearness(topology, b)
    }

    /// `max(|c1| / |c0|, sqrt(|c2| / |c0|))` over the block's unknowns, lengths in sizes of their loops.
    fn nearness(&self, topology: &Topology, b: BlockId) -> f64 {
        let norm = |c: &[f64]| {
            let unknowns = topology[b].unknowns.iter();
            unknowns.fold(0.0, |most: f64, &k| most.larger((c[k.0] * topology[k].per_unit).abs()))
        };
        // speeds[2] is 2 c2, hence the half
        let [c0, c1, c2] = number::each(&self.response.speeds.each_ref(), |c| norm(c));
        (c1 / c0).larger((c2 * 0.5 / c0).sqrt())
    }

    /// Extrapolates to the position where the response is infinite. With s ~ (u* - u)^-m, `s'/s = m / (u* - u)` and
    /// `s''/s = m (m + 1) / (u* - u)^2`, taken from the unknown that responds most.
    fn extrapolate(&self, topology: &Topology, b: BlockId) -> Option<SingularityAhead> {
        let size = |k: CoordinateId| (self.response.speeds[0][k.0] * topology[k].per_unit).abs();
        let unknowns = topology[b].unknowns.iter().copied();
        let most = unknowns.max_by(|&j, &k| size(j).total_cmp(&size(k)))?;
        let [c0, c1, c2] = number::each(&self.response.speeds.each_ref(), |c| c[most.0]);
        // a = s'/s = m / D, b = s''/s = m (m + 1) / D^2 (23):  a^2 / (b - a^2) = m,  D = m / a
        let (first, second) = (c1 / c0, c2 / c0);
        let power = first * first / (second - first * first);
        let distance = power / first;
        (power.is_finite() && distance.is_finite()).then_some(SingularityAhead { block: b, distance, power })
    }
}
