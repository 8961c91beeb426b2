//! Settings of a calibration: fitted variables, prior knowledge, and offsets.

use hardpoint::draft::{CalibrationSettingsDraft, OffsetDraft, PriorDraft, PriorGroupDraft, Section};
use toml::de::DeValue;

use crate::values::{
    EntryPlace, Fields, NUMBER, OUTPUT, Reader, Shape, Subject, Table, VARIABLE, shown, table,
};

use super::raw::Raw;

/// Maximum number of offsets.
const MOST_OFFSETS: usize = 1000;
pub(crate) const CALIBRATE: Table = table! {
    /// Fitted variables of a calibration, and prior knowledge about them. With this table the `bounds` of variables are
    /// kept.
    "Calibrate":
    /// Names of the fitted design variables; all others keep their nominal values. Default: all.
    may "fit": Shape::list(&VARIABLE), "[\"rod_1\", \"rod_2\"]";
    /// Priors by name of the design variable: the standard deviation, in its unit, about the nominal value.
    may "variables": Shape::Entries("a design variable", &ENTRY), "{ rod_1 = 1, rod_2 = { sigma = 1, mean = 217 } }";
    /// Priors of all other variables.
    may "priors": Shape::Words(&[
        ("tolerances", "The `tolerance` of each variable, with the distribution and `sigmas` of `[tolerance]`."),
    ]), "\"tolerances\"";
    /// Groups of variables that deviate nearly alike, such as rods of one batch.
    may "groups": Shape::Entries("a group", &Shape::Table(&GROUP)), "{ rods = { variables = [\"rod_1\", \"rod_2\"], within = 0.05 } }";
    /// Names of drivers, measures and components of points with an unknown constant offset; or tables with a prior.
    may "offsets": Shape::list(&OFFSET_ENTRY), "[\"motor\", { of = \"gauge\", sigma = 0.1 }]";
};
const ENTRY: Shape = Shape::Any(
    "VariablePrior",
    "Standard deviation, or a table with that and the mean.",
    &[NUMBER, Shape::Table(&PRIOR)],
);
pub(super) const PRIOR: Table = table! {
    /// Gaussian prior of a design variable.
    "VariablePriorTable":
    /// Standard deviation, in the variable's unit.
    must "sigma": NUMBER, "1";
    /// Mean of the variable's value: the value of a parameter, the change of all other variables. Default: the nominal
    /// value.
    may "mean": NUMBER, "217";
};
pub(super) const GROUP: Table = table! {
    /// Group of design variables whose deviations from their nominal values are equal but for small differences.
    "PriorGroup":
    /// Names of the members: at least two, of one unit.
    must "variables": Shape::list(&VARIABLE), "[\"rod_1\", \"rod_2\", \"rod_3\"]";
    /// Standard deviation of a member from the common, unknown deviation, in the unit of the members.
    must "within": NUMBER, "0.05";
};
const OFFSET_ENTRY: Shape =
    Shape::Any("Offset", "A name, or a table with a prior.", &[OUTPUT, Shape::Table(&OFFSET)]);
pub(super) const OFFSET: Table = table! {
    /// Offset of a driver or of the readings of a measure, with a prior.
    "OffsetTable":
    /// Name of a driver, a measure, or a component of a point.
    must "of": OUTPUT, "\"gauge\"";
    /// Standard deviation of the offset about 0, in the unit of the driver or measure.
    may "sigma": NUMBER, "0.1";
};

pub(super) fn calibrate(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(fields) = r.study(model, "calibrate", "variables", &CALIBRATE) else { return };
    let place = EntryPlace::of(&fields);
    let fitted = r.list_of_names(&fields, "fit", "all");
    let tolerance_priors = r.word_of(&fields, "priors").is_some();
    r.lost_tables(&fields);
    raw.push(r, Section::Calibrate, place);
    let priors = priors(r, &fields, raw);
    let groups = groups(r, &fields, raw);
    let offsets = offsets(r, &fields, raw);
    raw.draft.calibrating =
        Some(CalibrationSettingsDraft { fitted, priors, tolerance_priors, groups, offsets });
}

fn priors(r: &mut Reader<'_>, calibrate: &Fields<'_>, raw: &mut Raw) -> Vec<PriorDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut found = Vec::new();
    for entry in r.entries_below(calibrate, "calibrate.", "variables", "design variable") {
        let (name, at, value) = &entry;
        let (place, sigma, mean) = match value.get_ref() {
            DeValue::Table(_) => {
                let fields = r.entry("the prior of", &entry, PRIOR.keys());
                let place = EntryPlace::of(&fields);
                (place, r.number_of(&fields, "sigma"), r.number_of(&fields, "mean"))
            }
            _ => {
                r.unread.clear();
                let subject = Subject {
                    name: format!("the prior of `{}`", shown(name)),
                    example: format!("for example `{name} = 1`, or `{name} = {{ sigma = 1, mean = 217 }}`"),
                };
                let mut place = EntryPlace::at(at.clone());
                place.key("sigma", value);
                (place, r.number(value, &subject), None)
            }
        };
        if sigma.is_none() || !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::Priors, place);
        let sigma = sigma.unwrap_or_default();
        found.push(PriorDraft { name: entry.0, sigma, mean, per_metre, per_radian });
    }
    found
}

fn groups(r: &mut Reader<'_>, calibrate: &Fields<'_>, raw: &mut Raw) -> Vec<PriorGroupDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut found = Vec::new();
    for entry in r.entries_below(calibrate, "calibrate.", "groups", "group") {
        let fields = r.entry("group", &entry, GROUP.keys());
        let place = EntryPlace::of(&fields);
        let variables = r.list_of_names(&fields, "variables", "no group");
        let within = r.number_of(&fields, "within");
        if variables.is_none() || within.is_none() {
            r.unread.push("");
        }
        raw.push(r, Section::PriorGroups, place);
        let (variables, within) = (variables.unwrap_or_default(), within.unwrap_or_default());
        found.push(PriorGroupDraft { name: entry.0, variables, within, per_metre, per_radian });
    }
    found
}

fn offsets(r: &mut Reader<'_>, calibrate: &Fields<'_>, raw: &mut Raw) -> Vec<OffsetDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let subject = calibrate.subject("offsets");
    let Some(f) = calibrate.get("offsets") else { return Vec::new() };
    let Some(list) = r.list(f.value, &subject, "a list of names of drivers and measures") else {
        return Vec::new();
    };
    if list.len() > MOST_OFFSETS {
        let message = format!("{} has {} entries", subject.name, list.len());
        r.senseless(f.value.span(), message).help = Some(format!("give at most {MOST_OFFSETS}"));
        return Vec::new();
    }
    let mut found = Vec::new();
    for (k, value) in list.into_iter().enumerate() {
        r.unread.clear();
        let subject = subject.item(k);
        let (place, name, sigma) = match value.get_ref() {
            DeValue::Table(table) => {
                let fields =
                    r.fields(format!("offset {} of `calibrate`", k + 1), value.span(), table, OFFSET.keys());
                (EntryPlace::of(&fields), r.name_of(&fields, "of"), r.number_of(&fields, "sigma"))
            }
            _ => {
                let mut place = EntryPlace::at(value.span());
                place.key("of", value);
                (place, r.name(value, &subject, "the name of a driver or measure"), None)
            }
        };
        if name.is_none() || !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::Offsets, place);
        found.push(OffsetDraft { name: name.unwrap_or_default(), sigma, per_metre, per_radian });
    }
    found
}
