//! Output times.

use hardpoint::draft::Section;

use crate::values::{
    EntryPlace, Field, Fields, Kinds, NUMBER, Reader, Shape, Subject, Table, all_read, table,
};

use super::raw::Raw;

/// Maximum number of output times.
pub(super) const MOST_TIMES: u32 = 1_000_000;
pub(super) const TIME: Kinds = Kinds {
    name: "Time",
    doc: "The output times, in seconds.",
    typed: false,
    tables: || vec![&STEPS, &TIMES],
};
const STEPS: Table = table! {
    /// Evenly spaced.
    "Steps":
    /// The first output time.
    or("0.0") "start": NUMBER, "0";
    /// The last output time.
    must "end": NUMBER, "1.0";
    /// Number of intervals: there is one output time more.
    must "steps": Shape::Count(MOST_TIMES), "100";
};
const TIMES: Table = table! {
    /// One by one.
    "Times":
    /// The output times, increasing.
    must "at": Shape::some(&NUMBER), "[0, 0.5, 1]";
};

pub(super) fn time(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(f) = model.get("time") else { return };
    r.unread.clear();
    let place = EntryPlace::at(f.value.span());
    let times = times(r, "`time`", &model.subject("time"), f);
    if times.is_none() {
        r.unread.push("");
    }
    raw.draft.times = times.unwrap_or_default();
    raw.push(r, Section::Time, place);
}

/// Reads output times; `what` names their owner.
pub(super) fn times(r: &mut Reader<'_>, what: &str, subject: &Subject, f: Field<'_>) -> Option<Vec<f64>> {
    let table = r.table(f.value, subject, "a table with `end` and `steps`")?;
    let fields = r.fields(what, f.value.span(), table, TIME.keys());
    if let Some(f) = fields.get("at") {
        for key in ["start", "end", "steps"] {
            r.out_of_place(&fields, key, "the output times are listed in `at` already");
        }
        let subject = fields.subject("at");
        let Some(list) = f.value.get_ref().as_array().filter(|list| !list.is_empty()) else {
            r.wrong(f.value, &subject, "a list of times in s");
            return None;
        };
        if list.len() > MOST_TIMES as usize {
            r.senseless(f.value.span(), format!("there are more than {MOST_TIMES} output times"));
            return None;
        }
        let times = all_read(list.iter().map(|v| r.number(v, &subject)))?;
        if let Some(k) = (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
            let message = format!("the output time {} s comes after {} s", times[k], times[k - 1]);
            r.senseless(list[k].span(), message).help = Some("list the times in increasing order".into());
            return None;
        }
        return Some(times);
    }
    let start = r.number_of(&fields, "start");
    let end = r.number_of(&fields, "end");
    let steps = r.given(&fields, "steps", |r, f| {
        let steps = r.number(f.value, &fields.subject("steps"))?;
        if !(steps >= 1.0 && steps <= f64::from(MOST_TIMES) && steps.fract() == 0.0) {
            let message = format!("`steps` of {what} cannot be {steps}");
            r.senseless(f.value.span(), message).help =
                Some(format!("give the number of intervals, a whole number from 1 to {MOST_TIMES}"));
            return None;
        }
        Some(steps as usize)
    });
    let (start, end, steps) = (start?, end?, steps?);
    if end <= start {
        let at = fields.get("end").map_or(fields.at.clone(), |f| f.value.span());
        let (message, help) = if end == start {
            let help = format!("give an `end` after `start`, or one output time: `at = [{start}]`");
            (format!("the motion ends at {end} s, at which it starts"), help)
        } else {
            let help = "give an `end` after `start` (which is 0 if it is left out)".to_owned();
            (format!("the motion ends at {end} s, before it starts at {start} s"), help)
        };
        r.senseless(at, message).help = Some(help);
        return None;
    }
    Some((0..=steps).map(|k| start + (end - start) * k as f64 / steps as f64).collect())
}
