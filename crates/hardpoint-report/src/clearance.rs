//! Clearances over a motion: sentences, tables, and the rows of `clearances.csv`.

mod grid;

use std::io::Write;

use hardpoint::model::{Clearance, Dimension, DriverId, Model, ShapePair};
use hardpoint::motion::TubeFailure;
use hardpoint::run::{
    ClearanceMinimum, ClearanceProof, ClearanceProver, Clearances, Contact, MinimumPlace, PairClearance,
    ProofFailure, ShapeDistance,
};
use hardpoint_file::Units;

pub use grid::{GridClearanceFact, GridMinimumFact, GridPairFact};

use crate::figures::{number, per, rounded, unit, variable_unit, with_unit};
use crate::page::Table;
use crate::record::{Column, record, write_rows};

/// Digits of distances and times in sentences.
const DIGITS: usize = 7;
/// Number of the strongest variables in a sentence.
const NAMED: usize = 5;
/// A distance below the required one by less than this fraction of the mechanism's size is kept: an optimum lies on its
/// limit, and positions are solved to 1e-12 of the size.
const KEPT: f64 = 1e-9;
/// Derivatives below this fraction of the largest are zero but for round-off.
const NEGLIGIBLE: f64 = 1e-9;

record! {
    /// Derivative by a design variable.
    ClearanceSensitivity::of(model: &Model, units: Units, of: Dimension, v: usize, d: f64) {
        let variable = &model.variables[v];
        let by = variable_unit(model, units, variable);
    }
    /// Name of the variable.
    variable: String = variable.name.clone();
    /// Derivative.
    value: f64 = units.derivative_from_si(of, variable.quantity, d);
    /// Unit of the derivative.
    unit: String = per(&unit(units, of), &by);
}

/// Derivatives by all variables that the mechanism follows, the strongest first.
pub(crate) fn sensitivities(
    model: &Model,
    units: Units,
    of: Dimension,
    d: &[f64],
) -> Vec<ClearanceSensitivity> {
    let mut all: Vec<_> = (0..d.len())
        .filter(|v| d[*v].is_finite())
        .map(|v| ClearanceSensitivity::of(model, units, of, v, d[v]))
        .collect();
    all.sort_by(|a, b| b.value.abs().total_cmp(&a.value.abs()));
    all
}

record! {
    /// A least distance of a pair of shapes.
    MinimumFact::of(model: &Model, units: Units, found: &ClearanceMinimum) {
        let length = |x: f64| units.from_si(Dimension::LENGTH, x);
    }
    /// Time, s.
    time: f64 = found.at.time;
    /// Values of the drivers there, in words.
    drivers: String = drivers(model, units, found.at.time);
    /// Distance; negative where the shapes overlap.
    distance: f64 = length(found.at.distance[0]);
    /// Second derivative of the distance by time; `null` at an equilibrium.
    second_rate: Option<f64> = Some(length(found.at.distance[2])).filter(|x| x.is_finite());
    /// Place in the motion: `start`, `inside` or `end`.
    place: &'static str = match found.place {
        MinimumPlace::Start => "start",
        MinimumPlace::Inside => "inside",
        MinimumPlace::End => "end",
    };
    /// True if the rate jumps from negative to positive there.
    kink: bool = found.is_kink;
    /// Nearest points of the shapes' cores, global.
    points: [[f64; 3]; 2] = found.at.points.map(|p| p.map(length).to_array());
    /// True if more than one pair of points is nearest, since lines or faces are parallel.
    parallel: bool = found.at.is_parallel;
    /// True if the cores meet: the distance does not say how deep the shapes are in each other, and has no derivative.
    cores_meet: bool = found.at.cores_meet;
    /// Derivatives of the distance by the design variables, the strongest first; empty where the motion ends early at a
    /// time without known derivatives.
    sensitivities: Vec<ClearanceSensitivity> = sensitivities(model, units, Dimension::LENGTH, &found.d);
}

record! {
    /// A time at which two shapes touch or part.
    ContactFact::of(model: &Model, units: Units, found: &Contact) {}
    /// Time, s.
    time: f64 = found.at.time;
    /// Values of the drivers there, in words.
    drivers: String = drivers(model, units, found.at.time);
    /// True if they touch there, false if they part.
    begins: bool = found.begins;
    /// Derivatives of the time by the design variables, the strongest first; empty at a grazing contact.
    sensitivities: Vec<ClearanceSensitivity> =
        sensitivities(model, units, Dimension::NUMBER.rate(-1), &found.d);
}

/// The strongest variables of a derivative in words.
fn strongest(all: &[ClearanceSensitivity]) -> String {
    let largest = all.first().map_or(0.0, |s| s.value.abs());
    let named = all.iter().filter(|s| s.value.abs() > NEGLIGIBLE * largest).take(NAMED);
    named.map(|s| format!("{} {} {}", s.variable, number(s.value), s.unit)).collect::<Vec<_>>().join(", ")
}

/// A distance below the required one, with the change of the strongest variable that would keep it.
fn remedy(min: f64, least: f64, by: &[ClearanceSensitivity], cores_meet: bool, unit: &str) -> String {
    let change = by.first().filter(|s| s.value != 0.0 && !cores_meet).map(|s| {
        let by = (min - least) / s.value;
        let sign = if by < 0.0 { "" } else { "+" };
        format!("; {} {sign}{} would keep it, to first order", s.variable, number(by))
    });
    format!("  NEARER than the required {}{}", with_unit(min, unit), change.unwrap_or_default())
}

/// Allowance of a proof below the least distance, as a fraction of the mechanism's size: round-off of solved positions.
const ROUND_OFF: f64 = 1e-12;
/// The same for a distance that does not change, or is the least over a part of the motion: no interval is so short
/// that a bound of it has no slack.
const OF_CONSTANT: f64 = 1e-5;

record! {
    /// Proof that two shapes are never nearer than a claim, between output times too.
    ProofFact::of(model: &Model, units: Units, claim: f64, found: ClearanceProof) {
        let (slabs, failure) = match found {
            ClearanceProof::Proved { slabs, .. } => (Some(slabs), None),
            ClearanceProof::NotProved { from, to, reason, .. } => (None, Some((from, to, reason))),
        };
    }
    /// A time at which the shapes are nearer than claimed, s, and their distance there, m.
    #[serde(skip)]
    nearer: Option<[f64; 2]> = nearer(found);
    /// Distance that is claimed.
    claim: f64 = units.from_si(Dimension::LENGTH, claim);
    /// True if it is proved.
    proved: bool = slabs.is_some();
    /// Parts of the motion of the proof.
    slabs: Option<usize> = slabs;
    /// Part of the motion over which nothing is proved, s.
    unproved: Option<[f64; 2]> = failure.map(|(from, to, _)| [from, to]);
    /// Reason why nothing is proved there.
    reason: Option<String> = failure.map(|(_, _, reason)| reason_in_words(model, reason));
}

/// The time and distance that refute a claim.
fn nearer(found: ClearanceProof) -> Option<[f64; 2]> {
    match found {
        ClearanceProof::NotProved { reason: ProofFailure::Nearer { time, distance }, .. } => {
            Some([time, distance])
        }
        ClearanceProof::NotProved { .. } | ClearanceProof::Proved { .. } => None,
    }
}

fn reason_in_words(model: &Model, reason: ProofFailure) -> String {
    match reason {
        ProofFailure::Nearer { time, .. } => {
            format!("the shapes are nearer at t = {} s", rounded(time, DIGITS))
        }
        ProofFailure::Unresolved => "no bound reaches the claim".into(),
        ProofFailure::CoresMeet => {
            "the cores of the shapes meet there, and nothing is proved of how deep they are".into()
        }
        ProofFailure::WithinRing => "rings around other shapes than rods and balls have no bounds".into(),
        ProofFailure::Meshes => "both shapes are meshes, for which no bounds are computed".into(),
        ProofFailure::Interrupted => "the proof was interrupted".into(),
        ProofFailure::Motion(failure) => {
            format!("the motion has no bounds there: {}", motion_in_words(model, failure))
        }
    }
}

fn motion_in_words(model: &Model, failure: TubeFailure) -> String {
    match failure {
        TubeFailure::FollowsCurve { joint } => {
            format!("joint `{}` follows a curve", model.joints.get(joint.0).map_or("", |j| j.name.as_str()))
        }
        TubeFailure::TooLarge { .. } => "a loop has too many unknowns".into(),
        TubeFailure::Law { driver } => {
            format!(
                "the law of driver `{}` is undefined",
                model.drivers.get(driver.0).map_or("", |d| d.name.as_str())
            )
        }
        TubeFailure::NoContraction { .. } => "a singular position is near".into(),
        TubeFailure::NotSolved { time } => {
            format!("no position was found at t = {} s", rounded(time, DIGITS))
        }
        TubeFailure::OtherBranch { time } => {
            format!("another position of the mechanism is near at t = {} s", rounded(time, DIGITS))
        }
    }
}

/// Proves the least distance of a pair, or states where that fails.
pub fn proof(
    model: &Model,
    units: Units,
    prover: &mut ClearanceProver<'_>,
    found: &PairClearance,
) -> Option<ProofFact> {
    let least = found.least()?.at.distance[0];
    if found.unknown_at().is_some() {
        return None;
    }
    let mut prove = |allowance: f64| {
        let claim = least - allowance * model.size();
        let proof = prover.prove(found.shapes, claim);
        let is_unresolved =
            matches!(proof, ClearanceProof::NotProved { reason: ProofFailure::Unresolved, .. });
        (ProofFact::of(model, units, claim, proof), is_unresolved)
    };
    let (exact, is_unresolved) = prove(if found.is_constant { OF_CONSTANT } else { ROUND_OFF });
    if exact.nearer.is_some() {
        // Is it nearer than required, too?
        let pairs = model.clearances.iter().flat_map(|clearance| &clearance.pairs);
        let required = pairs.filter(|pair| pair.shapes == found.shapes).filter_map(|pair| pair.min);
        let mut claims: Vec<f64> = required.map(|min| min - KEPT * model.size()).collect();
        claims.retain(|claim| *claim < least);
        claims.sort_by(f64::total_cmp);
        let refuted = claims.into_iter().find_map(|claim| {
            let proof = ProofFact::of(model, units, claim, prover.prove(found.shapes, claim));
            proof.nearer.is_some().then_some(proof)
        });
        return Some(refuted.unwrap_or(exact));
    }
    // The least distance may be that over a part of the motion, as between points that move as one.
    let lower =
        (is_unresolved && !found.is_constant).then(|| prove(OF_CONSTANT).0).filter(|lower| lower.proved);
    Some(lower.unwrap_or(exact))
}

record! {
    /// Distance of a pair of shapes over a motion.
    ClearanceFact::of(
        model: &Model, units: Units, clearance: &Clearance, pair: &ShapePair, found: &PairClearance,
        proof: Option<ProofFact>,
    ) {
        let [a, b] = model.pair_names(pair);
        let length = |x: f64| units.from_si(Dimension::LENGTH, x);
        let lowest = found.least();
        let least = lowest.map(|m| m.at);
        // Where the cores meet, the shapes are at least as deep in each other as their distance.
        let below = |min: f64| least.is_some_and(|at| at.cores_meet || at.distance[0] < min - KEPT * model.size());
        let unknown_at = found.unknown_at();
        let nearer = proof.as_ref().and_then(|proof| proof.nearer);
        let violated_at = nearer.filter(|[_, at]| pair.min.is_some_and(|min| *at < min - KEPT * model.size()));
    }
    /// Name of the clearance.
    clearance: String = clearance.name.clone();
    /// Names of the shapes.
    shapes: [String; 2] = [a.to_owned(), b.to_owned()];
    /// Unit of all distances.
    unit: String = unit(units, Dimension::LENGTH);
    /// Least distance; `null` if no output time was solved, or it is not known.
    least: Option<f64> = least.map(|at| length(at.distance[0]));
    /// Distance that is required.
    min: Option<f64> = pair.min.map(length);
    /// False if the least distance is below the required one, or not known, or if the proof found a time at which the
    /// distance is below the required one.
    kept: bool =
        least.is_some() && unknown_at.is_none() && violated_at.is_none() && !pair.min.is_some_and(below);
    /// A time of the proof at which the distance is below the required one, s, and the distance there.
    #[serde(skip)]
    violated_at: Option<[f64; 2]> = violated_at.map(|[time, distance]| [time, length(distance)]);
    /// First time at which the distance is not known, s.
    #[serde(skip)]
    unknown_at: Option<f64> = unknown_at;
    /// True if the distance is the same at all times.
    constant: bool = found.is_constant;
    /// Index of the least of the minima.
    #[serde(skip)]
    least_minimum: Option<usize> = lowest.and_then(|least| found.minima.iter().position(|m| std::ptr::eq(m, least)));
    /// All local minima, in order of time.
    minima: Vec<MinimumFact> = found.minima.iter().map(|m| MinimumFact::of(model, units, m)).collect();
    /// Intervals in which the shapes touch, s.
    touching: Vec<[f64; 2]> = found.intervals();
    /// Times at which they touch or part.
    contacts: Vec<ContactFact> = found.contacts.iter().map(|c| ContactFact::of(model, units, c)).collect();
    /// Proof that the distance is never less; `null` where none was tried.
    proof: Option<ProofFact> = proof;
    /// True if the pair is always farther apart than the clearance lists.
    beyond: bool = clearance.beyond.is_some_and(|beyond| least.is_some_and(|at| at.distance[0] > beyond));
}

/// Values of the drivers that move by their laws, in words; those of released drivers depend on the loads instead.
pub(crate) fn drivers(model: &Model, units: Units, time: f64) -> String {
    let moves = |law: &hardpoint::law::Law| {
        let ends = [model.times.first(), model.times.last()].map(|t| t.copied().unwrap_or_default());
        law.over(ends[0], ends[1]).value.reach_from(law.at(ends[0]).value()) > 0.0
    };
    let released = |d: usize| model.equilibrium.as_ref().is_some_and(|e| e.released.contains(&DriverId(d)));
    let moving = model.drivers.iter().enumerate().filter(|(d, driver)| !released(*d) && moves(&driver.law));
    let shown = moving.map(|(_, driver)| {
        let dimension = Dimension::from(model.driven(driver).quantity);
        let value = units.from_si(dimension, driver.law.at(time).value());
        format!("{} {}", driver.name, with_unit(value, &unit(units, dimension)))
    });
    shown.collect::<Vec<_>>().join(", ")
}

impl ClearanceFact {
    /// All pairs of all clearances, without proofs.
    pub fn all(model: &Model, units: Units, found: &Clearances) -> Vec<Self> {
        Self::proved(model, units, found, &mut |_| None)
    }

    /// All pairs of all clearances, each with its proof. A pair that several clearances have is proved once.
    pub fn proved(
        model: &Model,
        units: Units,
        found: &Clearances,
        prove: &mut dyn FnMut(&PairClearance) -> Option<ProofFact>,
    ) -> Vec<Self> {
        let proofs: Vec<Option<ProofFact>> = found.pairs.iter().map(prove).collect();
        let mut facts = Vec::new();
        for clearance in &model.clearances {
            for (pair, of) in found.of(clearance) {
                let proof = found.pairs.iter().zip(&proofs).find(|(p, _)| p.shapes == pair.shapes);
                facts.push(Self::of(
                    model,
                    units,
                    clearance,
                    pair,
                    of,
                    proof.and_then(|(_, proof)| proof.clone()),
                ));
            }
        }
        facts
    }

    /// The lowest of its minima.
    fn lowest(&self) -> Option<&MinimumFact> {
        self.minima.get(self.least_minimum?)
    }

    /// The result in sentences: of each clearance its nearest pair, and all pairs that touch or are nearer than asked
    /// for.
    pub fn sentences(facts: &[Self]) -> Vec<String> {
        let mut lines = Vec::new();
        for of in facts.chunk_by(|a, b| a.clearance == b.clearance) {
            let least = |fact: &Self| fact.least.unwrap_or(f64::INFINITY);
            let nearest = of.iter().min_by(|a, b| least(a).total_cmp(&least(b)));
            for fact in of
                .iter()
                .filter(|fact| nearest.is_some_and(|n| std::ptr::eq(n, *fact)) || fact.is_remarkable())
            {
                lines.extend(fact.lines());
            }
        }
        lines
    }

    fn is_remarkable(&self) -> bool {
        !self.touching.is_empty() || !self.kept
    }

    fn lines(&self) -> Vec<String> {
        let Self { clearance, shapes: [a, b], unit, .. } = self;
        let unknown = self.unknown_at.map(|time| {
            format!(
                "{clearance}: the distance of {a} and {b} is not known at t = {} s",
                rounded(time, DIGITS)
            )
        });
        let Some(lowest) = self.lowest() else {
            let unsolved = || format!("{clearance}: no distance of {a} and {b} was solved");
            return vec![unknown.unwrap_or_else(unsolved)];
        };
        let at = |time: f64, drivers: &str| {
            let drivers = if drivers.is_empty() { String::new() } else { format!(" ({drivers})") };
            format!("t = {} s{drivers}", rounded(time, DIGITS))
        };
        let distance = format!("{} {unit}", rounded(lowest.distance, DIGITS));
        let mut lines = Vec::new();
        if self.touching.is_empty() {
            let when = if self.constant {
                "at all times".into()
            } else {
                format!("at {}", at(lowest.time, &lowest.drivers))
            };
            let proof =
                self.proof.as_ref().map_or_else(String::new, |proof| match (proof.slabs, proof.unproved) {
                    (Some(slabs), _) if rounded(proof.claim, DIGITS) != rounded(lowest.distance, DIGITS) => {
                        format!(
                            "; never less than {} {unit} (proved, {slabs} slabs)",
                            rounded(proof.claim, DIGITS)
                        )
                    }
                    (Some(slabs), _) => format!("; never less (proved, {slabs} slabs)"),
                    (None, Some([from, to])) => {
                        let reason = proof.reason.as_deref().unwrap_or_default();
                        format!("; not proved between {} and {} s: {reason}", number(from), number(to))
                    }
                    (None, None) => String::new(),
                });
            lines.push(format!("{clearance}: {distance} at least, {a} against {b}, {when}{proof}"));
        } else {
            let spans: Vec<String> = (self.touching.iter())
                .map(|[from, to]| format!("from {} to {} s", rounded(*from, DIGITS), rounded(*to, DIGITS)))
                .collect();
            let depth = if lowest.cores_meet {
                format!("their cores meet at {}", at(lowest.time, &lowest.drivers))
            } else {
                let deep = rounded(-lowest.distance, DIGITS);
                format!("{deep} {unit} deep at {}", at(lowest.time, &lowest.drivers))
            };
            lines.push(format!("{clearance}: {a} touches {b} {}; {depth}", spans.join(", ")));
        }
        let by = strongest(&lowest.sensitivities);
        if !by.is_empty() && !lowest.cores_meet {
            lines.push(format!("  the distance changes by {by}"));
        }
        for contact in &self.contacts {
            let by = strongest(&contact.sensitivities);
            if !by.is_empty() {
                let what = if contact.begins { "beginning" } else { "end" };
                lines.push(format!("  its {what} at {} s changes by {by}", rounded(contact.time, DIGITS)));
            }
        }
        if let Some(unknown) = unknown {
            lines.push(unknown);
        } else if let Some((min, [time, distance])) = self.min.zip(self.violated_at) {
            lines.push(format!(
                "  NEARER than the required {}: {} at t = {} s",
                with_unit(min, unit),
                with_unit(distance, unit),
                rounded(time, DIGITS)
            ));
        } else if let Some(min) = self.min.filter(|_| !self.kept) {
            lines.push(remedy(min, lowest.distance, &lowest.sensitivities, lowest.cores_meet, unit));
        }
        let others = self.minima.iter().filter(|m| !std::ptr::eq(*m, lowest)).count();
        if others > 0 && !self.constant {
            lines.push(format!("  other minima: {others}, listed with --json"));
        }
        lines
    }

    /// Table of all pairs, the nearest first within each clearance.
    pub fn table(facts: &[Self]) -> Option<Table> {
        let mut rows: Vec<&Self> = facts.iter().filter(|f| !f.beyond).collect();
        let least = |fact: &Self| fact.least.unwrap_or(f64::INFINITY);
        rows.sort_by(|a, b| a.clearance.cmp(&b.clearance).then(least(a).total_cmp(&least(b))));
        let shown = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let proofs = rows.iter().any(|f| f.proof.is_some());
        let proved = |f: &&&Self| match &f.proof {
            Some(proof) if proof.proved => "yes".into(),
            Some(_) => "no".into(),
            None => "-".into(),
        };
        let proved: Column<'_, &&Self> = ("proved", &proved);
        let columns: [Column<'_, &&Self>; 7] = [
            ("clearance", &|f| f.clearance.clone()),
            ("shapes", &|f| format!("{} - {}", f.shapes[0], f.shapes[1])),
            ("least", &|f| {
                let or_deeper = if f.lowest().is_some_and(|m| m.cores_meet) { " or deeper" } else { "" };
                shown(f.least, &f.unit) + or_deeper
            }),
            ("at t", &|f| match f.lowest() {
                Some(_) if f.constant => "always".into(),
                Some(m) => format!("{} s", number(m.time)),
                None => "-".into(),
            }),
            ("required", &|f| shown(f.min, &f.unit)),
            ("kept", &|f| {
                let in_words = |kept: bool| if kept { "yes" } else { "NO" };
                let kept = if f.unknown_at.is_some() { "not known" } else { in_words(f.kept) };
                f.min.map_or("-", |_| kept).into()
            }),
            ("touching", &|f| {
                let spans =
                    f.touching.iter().map(|[from, to]| format!("{} to {} s", number(*from), number(*to)));
                let spans: Vec<String> = spans.collect();
                if spans.is_empty() { "-".into() } else { spans.join(", ") }
            }),
        ];
        let note = "Least distances of shapes over the motion, located exactly; negative where they overlap.";
        let columns: Vec<_> = columns.into_iter().chain(proofs.then_some(proved)).collect();
        Table::of("Clearances", note, &columns, &rows).if_any()
    }
}

/// A row of `clearances.csv`.
struct Row<'a> {
    clearance: &'a str,
    shapes: [&'a str; 2],
    event: &'static str,
    at: &'a ShapeDistance,
}

/// Writes `clearances.csv`: the distance of every pair at all output times, and at its minima and contacts.
///
/// # Errors
/// If `out` cannot be written.
pub fn write(model: &Model, units: Units, found: &Clearances, out: impl Write) -> csv::Result<()> {
    let mut rows = Vec::new();
    for clearance in &model.clearances {
        for (pair, of) in found.of(clearance) {
            if clearance.beyond.is_some_and(|beyond| of.least().is_some_and(|m| m.at.distance[0] > beyond)) {
                continue;
            }
            let row =
                |event, at| Row { clearance: &clearance.name, shapes: model.pair_names(pair), event, at };
            let mut own: Vec<Row<'_>> = of.curve.iter().map(|at| row("", at)).collect();
            own.extend(of.minima.iter().map(|m| row("minimum", &m.at)));
            own.extend(of.contacts.iter().map(|c| row(if c.begins { "touches" } else { "parts" }, &c.at)));
            own.sort_by(|a, b| a.at.time.total_cmp(&b.at.time));
            rows.extend(own);
        }
    }
    let length = |x: f64| units.from_si(Dimension::LENGTH, x);
    let shown = |x: f64| if x.is_finite() { x.to_string() } else { String::new() };
    let symbol = units.length.symbol();
    let headings: Vec<String> = ["distance", "rate", "acceleration"]
        .iter()
        .zip(["", "/s", "/s^2"])
        .map(|(what, per)| format!("{what} [{symbol}{per}]"))
        .chain(
            ["first", "second"]
                .iter()
                .flat_map(|which| ["x", "y", "z"].map(|axis| format!("{which} {axis} [{symbol}]"))),
        )
        .collect();
    let cell = |k: usize| {
        move |row: &Row<'_>| match k {
            0..=2 => shown(length(row.at.distance[k])),
            _ => shown(length(row.at.points[(k - 3) / 3][(k - 3) % 3])),
        }
    };
    let cells: Vec<_> = (0..headings.len()).map(cell).collect();
    let mut columns: Vec<Column<'_, Row<'_>>> = vec![
        ("t [s]", &|row| row.at.time.to_string()),
        ("clearance", &|row| row.clearance.to_owned()),
        ("first", &|row| row.shapes[0].to_owned()),
        ("second", &|row| row.shapes[1].to_owned()),
        ("event", &|row| row.event.to_owned()),
    ];
    columns.extend(
        headings.iter().zip(&cells).map(|(heading, cell)| -> Column<'_, Row<'_>> { (heading, cell) }),
    );
    write_rows(out, &columns, rows)
}
