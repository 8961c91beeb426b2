//! Cases of a vehicle, which no source defines: heave, roll and steering.

use crate::finish;
use crate::mechanism::{Case, Law, Mechanism};
use crate::report::ImportLog;

/// Travel of the wheels in heave or bump and in roll, and of the rack, mm.
pub const HEAVE: f64 = 60.0;
const ROLL: f64 = 40.0;
const RACK: f64 = 30.0;
/// Fractions of the travel that are tried in order, since a mechanism may lock before.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// Returns an oscillation by a travel in mm.
pub fn oscillation(m: &Mechanism, travel: f64) -> String {
    format!("{}*sin(2*pi*t)", finish::rounded(travel * m.per_mm()))
}

/// Reduces the vertical motion of the wheels if the mechanism locks before its end.
fn shorten_bumps(m: &mut Mechanism, notes: &mut ImportLog, bumps: &[usize]) {
    let shorter = |part: f64| {
        let mut shorter = m.clone();
        let law = oscillation(m, part * HEAVE);
        bumps.iter().for_each(|driver| shorter.drivers[*driver].law = Law::Text(law.clone()));
        (shorter, law)
    };
    let found = PARTS.into_iter().map(|part| (part, shorter(part))).find(|(_, (m, _))| finish::moves(m));
    let Some((_, (shorter, law))) = found.filter(|(part, _)| *part < 1.0) else { return };
    *m = shorter;
    for driver in bumps {
        let why = format!("the mechanism locks within {HEAVE} mm: the law is reduced to `{law}`");
        notes.approximated("motion", &m.drivers[*driver].name, None, why);
    }
}

/// Adds the cases of a vehicle: both wheels in the same direction (heave), in opposite directions (roll), and steering.
/// A single motion needs no case. Travels that the mechanism does not reach are reduced.
pub fn add_vehicle_cases(m: &mut Mechanism, notes: &mut ImportLog) {
    let mut bumps: Vec<usize> = m.wheels.iter().map(|w| w.bump).collect();
    bumps.dedup();
    if bumps.is_empty() {
        return;
    }
    shorten_bumps(m, notes, &bumps);
    let mut wanted: Vec<(&'static str, Vec<(usize, f64)>)> = match bumps[..] {
        [left, right] => {
            vec![("heave", vec![(left, HEAVE), (right, HEAVE)]), ("roll", vec![(left, ROLL), (right, -ROLL)])]
        }
        [bump] => vec![("bump", vec![(bump, HEAVE)])],
        _ => return,
    };
    wanted.extend(m.steering.map(|steering| ("steer", vec![(steering, RACK)])));
    if wanted.len() < 2 {
        return;
    }
    for (name, travels) in wanted {
        let case = |part: f64| {
            let law = |travel: f64| oscillation(m, part * travel);
            Case { name, laws: travels.iter().map(|(driver, travel)| (*driver, law(*travel))).collect() }
        };
        match PARTS.into_iter().map(case).find(|case| moves(m, case)) {
            Some(case) => {
                let laws: Vec<String> =
                    case.laws.iter().map(|(k, law)| format!("`{}` {law}", m.drivers[*k].name)).collect();
                let why = format!("nothing drives it in the source: added with {}", laws.join(", "));
                notes.approximated("case", name, None, why);
                m.cases.push(case);
            }
            None => {
                let why = "the mechanism does not reach the travel: the case is not added";
                notes.approximated("case", name, None, why);
            }
        }
    }
}

/// Returns true if the mechanism moves from end to end in a case.
fn moves(m: &Mechanism, case: &Case) -> bool {
    let mut alone = m.clone();
    alone.cases.clear();
    for driver in &mut alone.drivers {
        match driver.law {
            Law::Text(_) | Law::Table(_) => driver.law = Law::Fixed,
            Law::Fixed | Law::Constant(_) => {}
        }
    }
    for (driver, law) in &case.laws {
        alone.drivers[*driver].law = Law::Text(law.clone());
    }
    finish::moves(&alone)
}
