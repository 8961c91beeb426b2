//! Mechanisms that nobody thought of: drawn at random, and held to what must be true of every mechanism.
//!
//! A case is a number. `HARDPOINT_CASES=1 HARDPOINT_FIRST=123 cargo test -p hardpoint --test it random -- --ignored`
//! runs case 123 of every family.

mod draw;
mod laws;
mod rank;

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use hardpoint::draft::Draft;
use hardpoint::joint::ALL;

use draw::Rng;
use laws::{Case, Promise, Tally};

/// A kind of random mechanism.
struct Family {
    number: u64,
    name: &'static str,
    draw: fn(&mut Rng) -> Option<Draft>,
    /// None where only survival is requested.
    promise: Option<Promise>,
}

const SPATIAL: Family = Family {
    number: 1,
    name: "spatial",
    draw: draw::spatial,
    promise: Some(Promise { exact: true, closed: true }),
};
const PLANAR: Family = Family {
    number: 2,
    name: "planar",
    draw: draw::planar,
    promise: Some(Promise { exact: false, closed: true }),
};
const TRAIN: Family = Family {
    number: 3,
    name: "train",
    draw: draw::train,
    promise: Some(Promise { exact: true, closed: true }),
};
const OPEN: Family = Family {
    number: 4,
    name: "open",
    draw: draw::open,
    promise: Some(Promise { exact: false, closed: false }),
};

const NONSENSE: Family = Family { number: 5, name: "nonsense", draw: draw::nonsense, promise: None };

/// The first mechanisms of every family that may be solved, as far as their numbers give one.
pub fn drafts(cases: u64) -> impl Iterator<Item = (String, Draft)> {
    [&SPATIAL, &PLANAR, &TRAIN, &OPEN].into_iter().flat_map(move |family| {
        let draw = |seed| {
            Some((format!("{} {seed}", family.name), (family.draw)(&mut Rng::new(family.number, seed))?))
        };
        (0..cases).filter_map(draw)
    })
}

fn run(family: &Family, cases: std::ops::Range<u64>) -> Tally {
    let mut tally = Tally::default();
    for seed in cases {
        let mut rng = Rng::new(family.number, seed);
        let drawn = catch_unwind(AssertUnwindSafe(|| (family.draw)(&mut rng)));
        let draft = match drawn {
            Ok(Some(draft)) => draft,
            Ok(None) => continue,
            Err(_) => {
                tally.failures.push(format!("case {seed}: panic while it is drawn"));
                continue;
            }
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let mut case = Case { seed, draft: &draft, tally: &mut tally };
            match family.promise {
                Some(promise) => case.examine(promise, &mut rng),
                None => case.survive(),
            }
        }));
        if outcome.is_err() {
            tally.failures.push(format!("case {seed}: panic\n{}", laws::describe(&draft)));
        }
    }
    tally
}

fn assert_none(failures: &[String]) {
    let all: Vec<&str> = failures.iter().filter_map(|f| f.lines().next()).collect();
    let shown = failures.iter().take(4).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{} failures:\n{}\n{shown}", failures.len(), all.join("\n"));
}

/// Cases of a family in the ordinary run.
const FEW: u64 = 100;

#[test]
fn exactly_determined_mechanisms_keep_all_laws() {
    let tally = run(&SPATIAL, 0..2 * FEW);
    assert_none(&tally.failures);
    assert!(10 * tally.solved >= 6 * tally.drawn, "{} of {} solved", tally.solved, tally.drawn);
    assert!(tally.admissible >= 100 && tally.reassembled >= 50, "{tally:?}");
}

#[test]
fn overconstrained_planar_linkages_keep_all_laws() {
    let tally = run(&PLANAR, 0..FEW);
    assert_none(&tally.failures);
    assert!(tally.solved >= 40 && tally.cannot_follow >= 20 && tally.admissible >= 20, "{tally:?}");
}

#[test]
fn trains_and_cams_keep_all_laws() {
    let tally = run(&TRAIN, 0..FEW);
    assert_none(&tally.failures);
    assert!(10 * tally.solved >= 9 * tally.drawn, "{} of {} solved", tally.solved, tally.drawn);
}

#[test]
fn open_drawings_are_closed_and_keep_all_laws() {
    let tally = run(&OPEN, 0..FEW);
    assert_none(&tally.failures);
    assert!(2 * tally.solved >= tally.drawn, "{} of {} solved", tally.solved, tally.drawn);
}

#[test]
fn nonsense_ends_in_a_fault_a_stop_or_a_solution() {
    let tally = run(&NONSENSE, 0..2 * FEW);
    assert_none(&tally.failures);
    assert!(tally.faults.len() >= 15 && tally.stops.len() >= 3, "{tally:?}");
}

#[test]
fn the_solved_mechanisms_use_all_that_there_is() {
    let mut wanted: BTreeSet<String> = ["travel", "leg", "heading"].map(|k| format!("driver {k}")).into();
    wanted.extend(["move", "tilt", "marker", "length", "law", "field"].map(String::from));
    for t in ALL {
        wanted.insert(format!("{} cut", t.name));
        if t.freedoms.is_some() {
            wanted.insert(format!("{} tree", t.name));
        }
        for c in t.coordinates {
            wanted.insert(format!("{}.{} measured", t.name, c.name));
            let kept = t.rows.contains(&c.row);
            if c.freedom.is_some() && !kept {
                wanted.insert(format!("{}.{} driven tree", t.name, c.name));
            }
            if !kept {
                wanted.insert(format!("{}.{} driven cut", t.name, c.name));
            }
        }
    }
    let trains = (0..FEW).map(|seed| (&TRAIN, seed));
    for (family, seed) in trains.chain((0..12 * FEW).map(|seed| (&SPATIAL, seed))) {
        if wanted.is_empty() {
            break;
        }
        let mut rng = Rng::new(family.number, seed);
        if let Some(draft) = (family.draw)(&mut rng) {
            for used in laws::used_where_solved(&draft) {
                wanted.remove(&used);
            }
        }
    }
    assert!(wanted.is_empty(), "never in a solved case: {wanted:?}");
}

#[test]
#[ignore = "minutes; HARDPOINT_CASES and HARDPOINT_FIRST say which cases"]
fn thousands_of_mechanisms_keep_all_laws() {
    let number = |name: &str| std::env::var(name).ok().map(|x| x.parse::<u64>().expect("a number"));
    let first = number("HARDPOINT_FIRST").unwrap_or(0);
    let cases = first..first + number("HARDPOINT_CASES").unwrap_or(1000);
    let failures: Vec<String> = [&SPATIAL, &PLANAR, &TRAIN, &OPEN, &NONSENSE]
        .into_iter()
        .flat_map(|family| {
            let tally = run(family, cases.clone());
            eprintln!("{}", tally.summary(family.name));
            tally.failures.into_iter().map(|f| format!("{} {f}", family.name))
        })
        .collect();
    assert_none(&failures);
}
