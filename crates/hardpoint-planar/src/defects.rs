//! Passage of a linkage through poses in their order, or the defect that prevents it.

use std::f64::consts::TAU;

use crate::linkage::Linkage;
use crate::plane::{Complex, Displacement};

/// Reason why a linkage that has all poses does not pass them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Defect {
    /// The poses are passed in another order.
    Order,
    /// The crank must pass a dead point between poses: the branch of the linkage changes.
    Branch,
    /// No motion leads from one pose to another: the linkage must be taken apart.
    Circuit,
    /// The transmission angle is below one degree over the passage, or over the whole turn of a crank that can turn
    /// fully; or pins coincide.
    Singular,
}

impl Defect {
    /// All defects.
    pub const ALL: [Self; 4] = [Self::Order, Self::Branch, Self::Circuit, Self::Singular];

    /// Description of linkages with it, after their number.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::Order => "in another order",
            Self::Branch => "with a change of branch",
            Self::Circuit => "on separate circuits",
            Self::Singular => "within 1 deg of a dead point",
        }
    }
}

/// Passage through all poses by a crank that turns in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// Turn of the crank since the first pose at each pose, rad.
    pub turns: Vec<f64>,
    /// True if the crank turns fully.
    pub is_full: bool,
    /// Minimum of the transmission angle over the passage, or over the whole turn of a crank that turns fully, rad.
    pub transmission: f64,
}

impl Passage {
    /// Range of the crank's turn from the first to the last pose that it passes, rad, in the direction of turning.
    pub fn range(&self) -> [f64; 2] {
        let low = self.turns.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.turns.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if self.turns.last() < self.turns.first() { [high, low] } else { [low, high] }
    }
}

/// Sine of the transmission angle below which a linkage is at a dead point: one degree.
const DEAD: f64 = 0.0175;
/// Turn between two poses below which the crank is at rest, rad.
const AT_REST: f64 = 1e-6;
/// Links shorter than this part of the largest have no direction.
const SHORT: f64 = 1e-6;
/// Round-off of an arc's ends, rad.
const SLACK: f64 = 1e-9;

/// Passage of a linkage through displacements of its coupler since its configuration, the first of which is none; in
/// any order on request.
///
/// # Errors
/// The defect that prevents it.
pub fn passage(linkage: &Linkage, moves: &[Displacement], any_order: bool) -> Result<Passage, Defect> {
    let lengths = linkage.lengths();
    let shortest = lengths.rocker.unwrap_or(f64::INFINITY).min(lengths.crank).min(lengths.coupler);
    if !(shortest > SHORT * linkage.extent()) {
        return Err(Defect::Singular);
    }
    let branches: Vec<f64> =
        moves.iter().map(|m| linkage.branch([m.of(linkage.b), m.of(linkage.c)])).collect();
    if branches.iter().any(|s| !(s.abs() > DEAD)) {
        return Err(Defect::Singular);
    }
    let angle = |m: &Displacement| {
        let turned: Complex = (m.of(linkage.b) - linkage.a).over(linkage.b - linkage.a);
        turned.angle()
    };
    let raw: Vec<f64> = moves.iter().map(angle).collect();
    let stays = branches.iter().all(|s| s.signum() == branches[0].signum());
    let arcs = linkage.arcs();
    let turns = match &arcs {
        None if !stays => return Err(Defect::Circuit),
        None => full_turns(&raw, any_order)?,
        Some(arcs) => {
            let holds = |[low, high]: [f64; 2], x: f64| {
                let to = x + ((low - SLACK - x) / TAU).ceil() * TAU;
                (to <= high + SLACK).then_some(to)
            };
            let arc = arcs.iter().find(|arc| holds(**arc, 0.0).is_some()).ok_or(Defect::Singular)?;
            let base = holds(*arc, 0.0).unwrap_or(0.0);
            let inside: Option<Vec<f64>> = raw.iter().map(|x| Some(holds(*arc, *x)? - base)).collect();
            let turns = inside.ok_or(Defect::Circuit)?;
            if !stays {
                return Err(Defect::Branch);
            }
            let [up, down] = [1.0, -1.0].map(|s| turns.windows(2).all(|p| s * (p[1] - p[0]) > AT_REST));
            if !(up || down || any_order) {
                return Err(Defect::Order);
            }
            turns
        }
    };
    let mut passage = Passage { is_full: arcs.is_none(), transmission: 0.0, turns };
    let range = if passage.is_full { [0.0, TAU] } else { passage.range() };
    passage.transmission = linkage.transmission(range);
    if passage.transmission.sin() > DEAD { Ok(passage) } else { Err(Defect::Singular) }
}

/// Turns of a crank that turns fully, in the direction in which it passes the poses in order within one turn. The last
/// may be the first again, a turn later.
fn full_turns(raw: &[f64], any_order: bool) -> Result<Vec<f64>, Defect> {
    let ahead = |direction: f64| {
        let mut total = 0.0;
        let mut turns = vec![0.0];
        for pair in raw.windows(2) {
            let step = (direction * (pair[1] - pair[0])).rem_euclid(TAU);
            // The end of the turn is the first again.
            let step = if step < AT_REST { step + TAU } else { step };
            total += step;
            turns.push(direction * total);
        }
        (total <= TAU + SLACK).then_some(turns)
    };
    let both = [ahead(1.0), ahead(-1.0)];
    let shorter = both.into_iter().flatten().min_by(|a, b| {
        let last = |t: &Vec<f64>| t.last().map_or(0.0, |x| x.abs());
        last(a).total_cmp(&last(b))
    });
    match shorter {
        Some(turns) => Ok(turns),
        None if any_order => Ok(raw.iter().map(|x| x.rem_euclid(TAU)).collect()),
        None => Err(Defect::Order),
    }
}
