//! Results in brief: an agent reads ranges and rankings, not curves.

use serde_json::{Map, Value, json};

/// Significant digits of numbers.
const DIGITS: usize = 6;
/// Lists of numbers longer than this are replaced by their range.
const LONGEST_LIST: usize = 24;
/// Other lists are cut after this number of entries.
const LONGEST_TABLE: usize = 60;
/// Keys that say nothing to an agent.
const LEFT_OUT: [&str; 6] = ["generator", "timings", "seconds", "files", "effort", "interpolation_error"];

/// A result with ranges in place of curves, numbers of six significant digits, and without empty values.
pub fn brief(value: &Value) -> Value {
    match value {
        Value::Number(number) => {
            number.as_f64().filter(|_| number.is_f64()).map_or_else(|| value.clone(), rounded)
        }
        Value::Array(list)
            if list.len() > LONGEST_LIST && list.iter().all(|x| x.is_number() || x.is_null()) =>
        {
            range(list)
        }
        Value::Array(list) => list.iter().take(LONGEST_TABLE).map(brief).collect(),
        Value::Object(map) => {
            let mut short = Map::new();
            for (key, value) in map {
                if value.is_null() || LEFT_OUT.contains(&key.as_str()) {
                    continue;
                }
                short.insert(key.clone(), brief(value));
                if let Value::Array(list) = value
                    && list.len() > LONGEST_TABLE
                    && !short[key].is_object()
                {
                    short.insert(format!("{key}_left_out"), (list.len() - LONGEST_TABLE).into());
                }
            }
            short.into()
        }
        Value::Null | Value::Bool(_) | Value::String(_) => value.clone(),
    }
}

fn rounded(x: f64) -> Value {
    format!("{x:.*e}", DIGITS - 1).parse::<f64>().map_or(Value::Null, |x| json!(x))
}

/// Range of a curve.
fn range(list: &[Value]) -> Value {
    let known: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
    let (Some(first), Some(last)) = (known.first(), known.last()) else {
        return json!({ "count": list.len() });
    };
    let [least, most] =
        [f64::min as fn(f64, f64) -> f64, f64::max].map(|f| known.iter().copied().fold(*first, f));
    json!({
        "count": list.len(), "first": rounded(*first), "last": rounded(*last),
        "min": rounded(least), "max": rounded(most),
    })
}

/// Only these keys of an object.
pub fn only(document: &Value, keys: &[&str]) -> Map<String, Value> {
    let pairs = keys.iter().filter_map(|key| Some(((*key).to_owned(), document.get(*key)?.clone())));
    pairs.collect()
}

/// The largest entries of a ranking for each unit of the variables, by the magnitude under a key.
pub fn largest(list: &Value, by: &str, most: usize) -> Value {
    let mut entries: Vec<&Value> = list.as_array().into_iter().flatten().collect();
    let size = |e: &Value| e.get(by).and_then(Value::as_f64).map_or(0.0, f64::abs);
    entries.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let mut counts: Vec<(String, usize)> = Vec::new();
    entries.retain(|entry| {
        let group = format!("{:?} {:?}", entry.get("measure"), entry.get("per"));
        match counts.iter_mut().find(|c| c.0 == group) {
            Some((_, count)) => {
                *count += 1;
                *count <= most
            }
            None => {
                counts.push((group, 1));
                most > 0
            }
        }
    });
    entries.into_iter().cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_become_ranges_and_numbers_are_rounded() {
        let curve: Vec<f64> = (0..101).map(|k| (f64::from(k) / 10.0).sin()).collect();
        let short = brief(
            &json!({ "toe": curve, "value": 1.234_567_89e-7, "steps": 12, "stop": null, "seconds": 1.0 }),
        );
        assert_eq!(
            short,
            json!({
                "toe": { "count": 101, "first": 0.0, "last": -0.544_021, "min": -0.999_923, "max": 0.999_574 },
                "value": 1.234_57e-7, "steps": 12,
            })
        );
    }

    #[test]
    fn long_tables_say_how_many_entries_are_left_out() {
        let rows: Vec<Value> = (0..70).map(|k| json!({ "k": k })).collect();
        let short = brief(&json!({ "rows": rows }));
        assert_eq!(short["rows"].as_array().unwrap().len(), LONGEST_TABLE);
        assert_eq!(short["rows_left_out"], json!(10));
    }

    #[test]
    fn the_largest_of_each_measure_and_unit_are_kept() {
        let of = |measure: &str, per: &str, x: f64| json!({ "measure": measure, "per": per, "largest": x });
        let list = json!([of("a", "mm", 1.0), of("a", "mm", -3.0), of("a", "deg", 0.1), of("b", "mm", 2.0)]);
        assert_eq!(
            largest(&list, "largest", 1),
            json!([of("a", "mm", -3.0), of("b", "mm", 2.0), of("a", "deg", 0.1)])
        );
    }
}
