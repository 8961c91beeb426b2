//! Numbers and units as text, for tables and messages. Result files have full precision instead.

use hardpoint::joint::Quantity;
use hardpoint::law::ParameterKind;
use hardpoint::model::{DesignVariable, Dimension, Model};

use crate::Units;

/// Number with at most five significant digits, without trailing zeros.
///
/// ```
/// use hardpoint_table::figures::number;
/// assert_eq!(number(0.123456789), "0.12346");
/// assert_eq!(number(1250.0), "1250");
/// assert_eq!(number(-3.2e-9), "-3.2e-9");
/// ```
pub fn number(value: f64) -> String {
    rounded(value, 5)
}

/// Number with at most `digits` significant digits, without trailing zeros; a dash for a missing number.
pub fn rounded(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    // Round first: 9.999999 has a different power of ten when rounded to five digits.
    let text = format!("{value:.*e}", digits - 1);
    let (_, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    if (-4..6).contains(&power) {
        let decimals = (digits as i32 - 1 - power).max(0) as usize;
        let plain = format!("{value:.decimals$}");
        if plain.contains('.') { plain.trim_end_matches('0').trim_end_matches('.').into() } else { plain }
    } else {
        let (lead, power) = text.split_once('e').unwrap_or((&text, "0"));
        let lead = if lead.contains('.') { lead.trim_end_matches('0').trim_end_matches('.') } else { lead };
        format!("{lead}e{power}")
    }
}

/// Relative error with two digits; a dash for a missing number.
pub fn error(value: f64) -> String {
    match value {
        v if !v.is_finite() => "–".into(),
        0.0 => "0".into(),
        v => format!("{v:.1e}"),
    }
}

/// Duration in a suitable unit.
pub fn seconds(value: f64) -> String {
    match value {
        v if v < 1e-3 => format!("{} µs", rounded(v * 1e6, 3)),
        v if v < 1.0 => format!("{} ms", rounded(v * 1e3, 3)),
        v => format!("{} s", rounded(v, 3)),
    }
}

/// File size: `3.2 MB`.
///
/// ```
/// use hardpoint_table::figures::bytes;
/// assert_eq!([0, 999, 1_500, 3_200_000, 5_800_000_000].map(bytes), ["0 B", "999 B", "1.5 kB", "3.2 MB", "5.8 GB"]);
/// ```
pub fn bytes(size: u64) -> String {
    let (mut size, mut unit) = (size as f64, "B");
    for larger in ["kB", "MB", "GB", "TB"] {
        if size >= 999.5 {
            (size, unit) = (size / 1000.0, larger);
        }
    }
    format!("{} {unit}", rounded(size, if size < 10.0 { 2 } else { 3 }))
}

/// Number with its unit; plain numbers have none.
pub fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { number(value) } else { format!("{} {unit}", number(value)) }
}

/// Symbol of a quantity's unit; `1` for a plain number.
pub fn symbol(units: Units, quantity: Quantity) -> &'static str {
    match units.of(quantity).0 {
        "" => "1",
        symbol => symbol,
    }
}

/// Symbol of a unit: `mm`, `deg/mm`, `1/(mm*s)`; `1` for a plain number.
///
/// ```
/// use hardpoint::model::Dimension;
/// use hardpoint_table::Units;
/// use hardpoint_table::figures::unit;
/// let metres = Units::default();
/// assert_eq!(unit(metres, Dimension::LENGTH.rate(2)), "m/s^2");
/// assert_eq!(unit(metres, Dimension::ANGLE.over(Dimension::LENGTH).rate(1)), "rad/(m*s)");
/// assert_eq!(unit(metres, Dimension::NUMBER.over(Dimension::LENGTH)), "1/m");
/// // Moments are in N m for any unit of length.
/// let millimetres = Units { length: hardpoint_table::LengthUnit::Millimetre, ..metres };
/// assert_eq!(unit(millimetres, Dimension::ANGLE.over(Dimension::MOMENT)), "rad/(N*m)");
/// assert_eq!(millimetres.per_si(Dimension::ANGLE.over(Dimension::MOMENT)), 1.0);
/// ```
pub fn unit(units: Units, of: impl Into<Dimension>) -> String {
    let of = of.into();
    let Dimension { length, angle, time, force } = of;
    // Moments and energies are in N m and powers in W, whatever the length unit.
    if of == Dimension::MOMENT.rate(1) {
        return "W".into();
    }
    let metres = if of.length_in_units() == length { units.length.symbol() } else { "m" };
    let powers = [(units.angle.symbol(), angle), ("N", force), (metres, length), ("s", time)];
    let product = |sign: i8| {
        let factors =
            powers.iter().map(|(symbol, power)| (*symbol, power * sign)).filter(|(_, power)| *power > 0);
        let text = |(symbol, power): (&str, i8)| {
            if power == 1 { symbol.to_string() } else { format!("{symbol}^{power}") }
        };
        factors.map(text).collect::<Vec<_>>()
    };
    let (above, below) = (product(1), product(-1));
    let above = if above.is_empty() { "1".into() } else { above.join("*") };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join("*")),
    }
}

/// Unit of the time derivative of order 0, 1 or 2: `mm`, `mm/s`, `mm/s^2`.
pub fn order_unit(units: Units, of: impl Into<Dimension>, order: usize) -> String {
    unit(units, of.into().rate(order as i8))
}

/// Unit of a design variable; `1` for a plain number.
///
/// To the core, a parameter of a law that is neither a length nor an angle is a plain number. The rate of change of the
/// parameter per unit of the variable then decides whether the variable is in the user's unit or in SI.
pub fn variable_unit(model: &Model, units: Units, variable: &DesignVariable) -> String {
    if variable.quantity != Quantity::Number {
        return symbol(units, variable.quantity).into();
    }
    let mut found = variable.changes.iter().map(|change| {
        let (driver, parameter, rate) = change.law()?;
        let driver = &model.drivers[driver.0];
        let quantity = model.driven(driver).quantity;
        let kind = driver.law.parameters()[parameter].kind;
        parameter_unit(units, quantity, kind, rate.abs())
    });
    let first = found.next().flatten();
    match first {
        Some(unit) if found.all(|other| other.as_ref() == Some(&unit)) => unit,
        _ => "1".into(),
    }
}

/// Unit in which a parameter changes by one, if it changes by `rate` internally.
fn parameter_unit(units: Units, driven: Quantity, kind: ParameterKind, rate: f64) -> Option<String> {
    let is = |size: f64| (rate - size).abs() <= 1e-12 * size;
    match kind {
        ParameterKind::Time if is(1.0) => Some("s".into()),
        ParameterKind::Frequency if is(1.0) => Some("Hz".into()),
        ParameterKind::ValueRate(power) => {
            let per = match power {
                1 | 2 => return in_either(units, driven, is, |u| order_unit(u, driven, power as usize)),
                n => format!("/s^{n}"),
            };
            in_either(units, driven, is, |u| format!("{}{per}", symbol(u, driven)))
        }
        ParameterKind::Value
        | ParameterKind::Number
        | ParameterKind::Time
        | ParameterKind::Frequency
        | ParameterKind::Angle => None,
    }
}

/// Text for the user's units if the rate corresponds to them, otherwise for SI units.
fn in_either(
    units: Units,
    driven: Quantity,
    is: impl Fn(f64) -> bool,
    text: impl Fn(Units) -> String,
) -> Option<String> {
    let meant = [units, Units::default()].into_iter().find(|u| is(u.to_si(driven, 1.0)));
    meant.map(text)
}

/// Unit of a derivative: `deg/mm`, `mm/s per mm` as `mm/(s*mm)`.
///
/// ```
/// use hardpoint_table::figures::per;
/// assert_eq!(per("deg", "mm"), "deg/mm");
/// assert_eq!(per("deg/s", "mm"), "deg/(s*mm)");
/// assert_eq!(per("deg/mm", "mm"), "deg/mm^2");
/// assert_eq!(per("mm/deg^2", "deg"), "mm/deg^3");
/// assert_eq!(per("deg/(s*mm)", "mm"), "deg/(s*mm^2)");
/// assert_eq!(per("deg", "1"), "deg");
/// assert_eq!(per("deg", "mm/s"), "deg/(mm/s)");
/// assert_eq!(per("deg", "N*m"), "deg/(N*m)");
/// ```
pub fn per(of: &str, by: &str) -> String {
    match (of.split_once('/'), by.contains('/')) {
        _ if by == "1" => of.into(),
        (Some((top, below)), of_quotient) => {
            let below = below.strip_prefix('(').and_then(|b| b.strip_suffix(')')).unwrap_or(below);
            let mut factors: Vec<String> = below.split('*').map(Into::into).collect();
            let power = |factor: &str| match factor.strip_prefix(by)?.strip_prefix('^') {
                Some(power) => power.parse::<u8>().ok(),
                None => (factor == by).then_some(1),
            };
            match factors.iter_mut().find_map(|factor| power(factor).map(|n| (factor, n))) {
                Some((factor, n)) => *factor = format!("{by}^{}", n + 1),
                None if of_quotient => factors.push(format!("({by})")),
                None => factors.push(by.into()),
            }
            match &factors[..] {
                [factor] => format!("{top}/{factor}"),
                factors => format!("{top}/({})", factors.join("*")),
            }
        }
        (None, false) if !by.contains('*') => format!("{of}/{by}"),
        (None, _) => format!("{of}/({by})"),
    }
}

/// Names in backticks with separators: `` `a`, `b` and `c` ``.
pub fn names<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|n| format!("`{n}`")).collect();
    in_words(&quoted)
}

/// Items with separators: `a, b and c`.
fn in_words(items: &[String]) -> String {
    match items.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// Items with separators; of a long list the first few and the number of the others.
pub fn some_in_words(items: &[String]) -> String {
    if items.len() > SHOWN { some_of(items, ", ") } else { in_words(items) }
}

/// Quoted names with their kind: ``coupler `a` ``, ``coupler `b` ``.
pub fn quoted<'a>(what: &'a str, names: &'a [String]) -> impl Iterator<Item = String> + 'a {
    names.iter().map(move |n| format!("{what} `{n}`"))
}

/// True if a character must not be displayed unchanged: control characters, and invisible ones that change the writing
/// direction or separate lines.
pub fn is_odd(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// Number with a noun: `1 step`, `2 steps`.
pub fn count(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") }
}

/// Maximum number of items shown of a long list.
const SHOWN: usize = 8;

/// Items with a separator; of a long list the first few and the number of the others.
pub fn some_of(items: &[impl AsRef<str>], separator: &str) -> String {
    hardpoint::draft::some_of(items, separator, SHOWN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_the_digits_asked_for_and_no_more() {
        let cases: [(f64, &str); 9] = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (99999.96, "100000"),
            (1234567.0, "1.2346e6"),
            (0.00012345678, "0.00012346"),
            (0.00001, "1e-5"),
            (-345.44, "-345.44"),
            (1e-300, "1e-300"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(rounded(9.99, 2), "10");
        assert_eq!(seconds(0.01234), "12.3 ms");
    }

    #[test]
    fn lists_read_as_a_sentence() {
        assert_eq!(names(["a"]), "`a`");
        assert_eq!(names(["a", "b", "c"]), "`a`, `b` and `c`");
    }

    #[test]
    fn a_long_list_is_cut_short_and_counted() {
        let names: Vec<String> = (0..200).map(|k| format!("R{k}")).collect();
        assert_eq!(some_of(&names[..3], ", "), "R0, R1, R2");
        assert_eq!(some_of(&names, ", "), "R0, R1, R2, R3, R4, R5, R6, R7 and 192 more");
    }
}
