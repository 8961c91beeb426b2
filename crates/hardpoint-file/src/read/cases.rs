//! Cases: several motions of one mechanism.

use std::collections::{HashMap, HashSet};

use hardpoint::draft::{CaseDraft, Draft, FormulaDraft, FormulaOf, GridDraft, OtherDrivers, Section};
use hardpoint::joint::Quantity;
use hardpoint::law::Law;

use crate::values::{
    EntryPlace, Field, Fields, Kinds, NUMBER, Reader, Shape, Subject, Table, Value, all_read, shown, table,
};

use super::elements::{LOAD_MODES, LOADS};
use super::raw::Raw;
use super::times::{MOST_TIMES, TIME};
use super::{law, times};

/// Maximum number of cases.
const MOST_CASES: usize = 1000;
pub(crate) const CASE: Table = table! {
    /// A motion of the mechanism, with laws and output times of its own.
    "Case":
    /// Laws of drivers and forces in this case, by name; all other forces keep their laws.
    or("{}") "laws": Shape::Entries("a driver", &law::LAW), "{ bump = \"40*sin(2*pi*t)\" }";
    /// Motion of all other drivers.
    or("\"fixed\"") "other_drivers": REST, "\"as_in_model\"";
    /// Loads with or without inertia, as `loads` of the file. Default: that of the file.
    may "loads": LOADS, "\"static\"";
    /// Output times, like `[time]`. Default: those of `[time]`.
    may "time": Shape::Kinds(&TIME), "{ end = 1.0, steps = 100 }";
    /// Instead of these keys: a map over all combinations of the positions of two drivers. All other drivers are fixed
    /// in the design configuration.
    may "grid": Shape::Entries("a driver", &Shape::Kinds(&SWEEP)), "{ bump = { from = -80, to = 80, steps = 8 }, steering = { from = -15, to = 15, steps = 6 } }";
};
pub(crate) const SWEEP: Kinds = Kinds {
    name: "Sweep",
    doc: "Positions of a driver in a grid, in its unit, counted from the design configuration.",
    typed: false,
    tables: || vec![&RANGE, &PLACES],
};
const RANGE: Table = table! {
    /// Evenly spaced.
    "Range":
    /// The lowest position.
    must "from": NUMBER, "-80";
    /// The highest position.
    must "to": NUMBER, "80";
    /// Number of intervals: there is one position more.
    must "steps": Shape::Count(MOST_POSITIONS), "8";
};
const PLACES: Table = table! {
    /// One by one.
    "Positions":
    /// The positions, increasing.
    must "at": Shape::some(&NUMBER), "[-80, 0, 80]";
};
/// Maximum number of positions of one driver.
const MOST_POSITIONS: u32 = 10_000;
const REST: Shape = Shape::Words(&[
    ("fixed", "They are fixed in the design configuration: their law is 0."),
    ("as_in_model", "They follow the laws that they have in `[drivers]`."),
]);
const RESTS: [OtherDrivers; 2] = [OtherDrivers::Held, OtherDrivers::AsAbove];

pub(super) fn cases(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let entries = r.entries(model, "cases", "case");
    if let (Some(f), true) = (model.get("cases"), entries.len() > MOST_CASES) {
        let message = format!("there are {} cases", entries.len());
        r.senseless(f.value.span(), message).help = Some(format!("give at most {MOST_CASES}"));
        raw.draft.unread.note(Section::Model, 0, "cases");
        return;
    }
    let driven = raw.draft.drivers.iter().zip(&raw.driven).map(|(d, q)| (d.name.clone(), *q));
    let driven: HashMap<String, Quantity> = driven.collect();
    let mut outputs = 0;
    for entry in entries {
        let fields = r.entry("case", &entry, CASE.keys());
        let mut place = EntryPlace::of(&fields);
        if fields.get("grid").is_some() {
            for key in ["laws", "other_drivers", "loads", "time"] {
                let why = "a `grid` defines positions of two drivers; all others are fixed in the design configuration, and it has no time";
                r.out_of_place(&fields, key, why);
            }
            let sweeps = r.given(&fields, "grid", |r, f| sweeps(r, &fields, f, &mut place, &driven));
            raw.push(r, Section::Grids, place);
            raw.draft.grids.push(GridDraft { name: entry.0, sweeps: sweeps.unwrap_or_default() });
            continue;
        }
        let draft = &mut raw.draft;
        let laws =
            r.given(&fields, "laws", |r, f| case_laws(r, &entry.0, &fields, f, &mut place, &driven, draft));
        let rest = r.word_of(&fields, "other_drivers").map(|k| RESTS[k]);
        let mut times = r.given(&fields, "time", |r, f| {
            times::times(r, &format!("`time` of {}", fields.what), &fields.subject("time"), f)
        });
        outputs += times.as_ref().unwrap_or(&raw.draft.times).len();
        if outputs > MOST_TIMES as usize {
            let message = format!("the cases have more than {MOST_TIMES} output times together");
            r.senseless(entry.1.clone(), message).help = Some("ask for fewer `steps`".into());
            r.unread.push("time");
            times = Some(Vec::new());
        }
        let load_mode = r.word_of(&fields, "loads").map(|k| LOAD_MODES[k]);
        let laws = laws.unwrap_or_default();
        if rest == Some(OtherDrivers::AsAbove) && !r.unread.contains(&"laws") {
            laws_of_their_own(r, &fields, &laws, raw);
        }
        raw.push(r, Section::Cases, place);
        let rest = rest.unwrap_or_default();
        raw.draft.cases.push(CaseDraft { name: entry.0, laws, rest, times, load_mode });
    }
    only_grids(r, raw);
}

/// HP0104: drivers without a law in any case.
fn only_grids(r: &mut Reader<'_>, raw: &Raw) {
    if !raw.draft.cases.is_empty() || raw.draft.grids.is_empty() {
        return;
    }
    for k in &raw.without_law {
        let name = shown(&raw.draft.drivers[*k].name);
        let at = raw.places.list(Section::Drivers)[*k].find("name", None);
        let message = format!("driver `{name}` has no `law`, and no case gives it one");
        let d = r.report("HP0104", at, message);
        d.notes.push("cases with a `grid` define positions of drivers, not laws".into());
        d.help = Some("add it, for example `law = \"10*t\"`".into());
    }
}

/// Two drivers and their positions, in SI.
fn sweeps(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    place: &mut EntryPlace,
    driven: &HashMap<String, Quantity>,
) -> Option<Vec<(String, Vec<f64>)>> {
    let subject = fields.subject("grid");
    let table = r.table_of_names(f.value, &subject, "a table of two drivers' names and positions")?;
    let mut entries: Vec<_> = table.iter().collect();
    // In the order of the text: the first one varies along the rows.
    entries.sort_by_key(|(name, _)| name.span().start);
    let (mut sweeps, mut items, mut complete) = (Vec::new(), Vec::new(), true);
    for (name, value) in entries {
        let Some(driver) = r.short(name.get_ref(), name.span(), "the name of a driver") else {
            complete = false;
            continue;
        };
        let what = format!("driver `{}` in the grid of {}", shown(&driver), fields.what);
        let subject = Subject {
            name: format!("the range of {what}"),
            example: "for example `{ from = -80, to = 80, steps = 8 }`".into(),
        };
        let unit = r.units.to_si(driven.get(&driver).copied().unwrap_or(Quantity::Number), 1.0);
        match positions(r, &what, &subject, value) {
            Some(values) => {
                items.push(name.span());
                sweeps.push((driver, values.into_iter().map(|v| v * unit).collect()));
            }
            None => complete = false,
        }
    }
    place.items("grid", items);
    complete.then_some(sweeps)
}

/// Positions of a driver, in its unit.
fn positions(r: &mut Reader<'_>, what: &str, subject: &Subject, value: &Value<'_>) -> Option<Vec<f64>> {
    let table = r.table(value, subject, "a table with `from`, `to` and `steps`")?;
    let fields = r.fields(what, value.span(), table, SWEEP.keys());
    if let Some(f) = fields.get("at") {
        for key in ["from", "to", "steps"] {
            r.out_of_place(&fields, key, "the positions are listed in `at` already");
        }
        let subject = fields.subject("at");
        let Some(list) = f.value.get_ref().as_array().filter(|list| list.len() > 1) else {
            r.wrong(f.value, &subject, "a list of at least two positions");
            return None;
        };
        if list.len() > MOST_POSITIONS as usize {
            r.too_many(f.value.span(), &subject.name, list.len());
            return None;
        }
        let places = all_read(list.iter().map(|v| r.number(v, &subject)))?;
        if let Some(k) = (1..places.len()).find(|&k| places[k] <= places[k - 1]) {
            let message = format!("the position {} of {what} comes after {}", places[k], places[k - 1]);
            r.senseless(list[k].span(), message).help = Some("list the positions in increasing order".into());
            return None;
        }
        return Some(places);
    }
    let ends = ["from", "to", "steps"].map(|key| r.need(&fields, key));
    let [from, to, steps] = ["from", "to", "steps"].map(|key| {
        let subject = fields.subject(key);
        fields.get(key).and_then(|f| r.number(f.value, &subject))
    });
    let (Some(from), Some(to), Some(steps), [_, Some(end), Some(count)]) = (from, to, steps, ends) else {
        return None;
    };
    if !(steps >= 1.0 && steps < f64::from(MOST_POSITIONS) && steps.fract() == 0.0) {
        let message = format!("`steps` of {what} cannot be {steps}");
        r.senseless(count.value.span(), message).help =
            Some(format!("give the number of intervals, a whole number from 1 to {}", MOST_POSITIONS - 1));
        return None;
    }
    if to <= from {
        let message = format!("the range of {what} goes from {from} to {to}");
        r.senseless(end.value.span(), message).help = Some("give a `to` above `from`".into());
        return None;
    }
    // Each position interpolates both ends, so that symmetric ranges include zero exactly, and whole numbers stay
    // whole.
    Some((0..=steps as usize).map(|k| (from * (steps - k as f64) + to * k as f64) / steps).collect())
}

/// HP0104: drivers without a law in this case.
fn laws_of_their_own(r: &mut Reader<'_>, fields: &Fields<'_>, laws: &[(String, Law)], raw: &Raw) {
    let named: HashSet<&str> = laws.iter().map(|law| law.0.as_str()).collect();
    let without = raw.without_law.iter().map(|k| &raw.draft.drivers[*k].name);
    let without: Vec<&String> = without.filter(|name| !named.contains(name.as_str())).collect();
    let Some(first) = without.first() else { return };
    let names: Vec<String> = without.iter().map(|name| format!("`{}`", shown(name))).collect();
    let names = hardpoint::draft::some_of(&names, ", ", 12);
    let what = if without.len() == 1 { "driver" } else { "drivers" };
    let at = fields.get("other_drivers").map_or(fields.at.clone(), |f| f.value.span());
    let message = format!("{} leaves {what} {names} without a `law`", fields.what);
    r.report("HP0104", at, message).help = Some(format!(
        "give one in the case, like `laws = {{ {first} = \"10*t\" }}`, or in `[drivers.{first}]`, or fix it with `other_drivers = \"fixed\"`"
    ));
}

/// Laws of a case, in SI.
fn case_laws(
    r: &mut Reader<'_>,
    case: &str,
    fields: &Fields<'_>,
    f: Field<'_>,
    place: &mut EntryPlace,
    driven: &HashMap<String, Quantity>,
    draft: &mut Draft,
) -> Option<Vec<(String, Law)>> {
    let subject = fields.subject("laws");
    let table = r.table_of_names(f.value, &subject, "a table of drivers' names and laws")?;
    let (mut laws, mut names, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut complete = true;
    for (name, value) in table {
        let Some(driver) = r.short(name.get_ref(), name.span(), "the name of a driver") else {
            complete = false;
            continue;
        };
        let is_force = !driven.contains_key(&driver) && draft.forces.iter().any(|f| f.name == driver);
        let of = if is_force { "force" } else { "driver" };
        let of = format!("{of} `{}` in {}", shown(&driver), fields.what);
        let subject =
            Subject { name: format!("the law of {of}"), example: "for example `\"30*sin(2*pi*t)\"`".into() };
        let mut law = law::law_in(r, &of, &subject, value);
        if is_force {
            law = law::of_force(r, &subject, value).and(law);
        }
        let quantity = driven.get(&driver).copied();
        law::check_units(r, quantity);
        let quantity = quantity.unwrap_or(Quantity::Number);
        for (parameter, expression) in r.law_formulas.drain(..) {
            let of = FormulaOf::CaseLaw(case.to_owned(), driver.clone(), parameter);
            draft.formulas.push(FormulaDraft { of, expression });
        }
        complete &= law.is_some();
        if let Some(law) = law {
            names.push(name.span());
            values.push(value.span());
            laws.push((driver, law.scaled(r.units.to_si(quantity, 1.0))));
        }
    }
    place.items("laws", names);
    place.items("law", values);
    if !complete {
        r.unread.push("laws");
        r.unread.push("law");
    }
    Some(laws)
}
