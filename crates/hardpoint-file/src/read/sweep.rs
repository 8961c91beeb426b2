//! Settings of a sweep.

use std::path::Path;

use hardpoint::draft::{
    DesignListDraft, DraftError, DraftLocation, Section, SweepRangeDraft, SweepSettingsDraft,
};
use hardpoint::joint::Quantity;
use hardpoint::model::{Model, SweepMethod, SweepRange, SweepSettings, VariableId};
use toml::de::DeValue;

use crate::values::{
    DataError, EntryPlace, Fields, METRIC, NUMBER, OUTPUT, Reader, Shape, Subject, TWO_NUMBERS, Table,
    Wanted, shown, table,
};
use hardpoint_table::Units;
use hardpoint_table::figures::variable_unit;

use super::data::{Title, no_csv, number, records_of, text_at, unquoted};
use super::raw::Raw;

/// Maximum number of designs that are read.
const MOST_SAMPLES: u32 = SweepSettings::MOST as u32;
/// Maximum number of values of a variable that are read.
const MOST_LEVELS: u32 = 1_000_000;
pub(crate) const SWEEP: Table = table! {
    /// Designs of a sweep, and the results that are stored.
    "SweepStudy":
    /// Ranges of design variables by name, in their units, like `bounds`; other variables are constant. Default: all
    /// variables with `bounds`, within these.
    may "variables": Shape::Entries("a design variable", &ENTRY), "{ lca_front_z = [-5, 5], radius = { from = 90, to = 110, levels = 5 } }";
    /// Method that chooses the designs.
    or("\"sobol\"") "method": METHOD, "\"factorial\"";
    /// Number of designs; with `method = "sobol_indices"` the number of pairs of designs.
    or("1000") "samples": Shape::Count(MOST_SAMPLES), "100000";
    /// Seed of the random numbers: the same seed gives the same designs.
    or("1") "seed": Shape::Count(u32::MAX), "7";
    /// With `method = "factorial"`: default number of values of a variable, two or more.
    or("3") "levels": Shape::Count(MOST_LEVELS), "5";
    /// Instead of these keys: a CSV file in the model's folder with the designs, whose first line names design
    /// variables, with or without units.
    may "designs": Shape::Text, "\"designs.csv\"";
    /// Names of the stored metrics. Default: all.
    may "metrics": Shape::list(&METRIC), "[\"toe_range\"]";
    /// Names of the measures whose curves are stored. Default: none.
    may "curves": Shape::list(&OUTPUT), "[\"toe\"]";
};
const METHOD: Shape = Shape::Words(&[
    ("factorial", "Every combination of `levels` values of each variable."),
    ("latin_hypercube", "At random, with one design in each of `samples` slices of every range."),
    ("sobol", "Points that fill the ranges evenly, however many there are."),
    (
        "sobol_indices",
        "What Sobol's indices of sensitivity take: for v variables, (v + 2) times `samples` designs.",
    ),
]);
const ENTRY: Shape = Shape::Any(
    "SweepVariable",
    "The range, or a table with the range and more.",
    &[TWO_NUMBERS, Shape::Table(&RANGE)],
);
pub(super) const RANGE: Table = table! {
    /// Range of a design variable.
    "SweepRange":
    /// Lower end, in its unit. Default: its lower bound.
    may "from": NUMBER, "-5";
    /// Upper end. Default: its upper bound.
    may "to": NUMBER, "5";
    /// With `method = "factorial"`: number of values, two or more, including both ends. Default: that of `[sweep]`.
    may "levels": Shape::Count(MOST_LEVELS), "5";
};
/// Code of a column of a list that is no value of a design variable.
pub(super) const LIST_CODE: &str = "HP0247";
/// Lists of designs.
const LIST: Wanted<'static> = Wanted {
    purpose: "list of designs",
    kind: "a CSV file",
    ending: "csv",
    example: "data/designs.csv",
    without_folder: "read the model from a file, or use `--designs`",
    too_large: "split it, and sweep over its parts one after the other",
};

pub(super) fn sweep(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(fields) = r.study(model, "sweep", "variables", &SWEEP) else { return };
    let place = EntryPlace::of(&fields);
    let method = fields.get("method").and_then(|_| r.word_of(&fields, "method"));
    let samples = r.count_of(&fields, "samples", MOST_SAMPLES);
    let seed = r.count_of(&fields, "seed", u32::MAX);
    let levels = r.count_of(&fields, "levels", MOST_LEVELS);
    let [metrics, curves] = ["metrics", "curves"].map(|key| r.list_of_names(&fields, key, "all"));
    let designs = r.given(&fields, "designs", |r, f| {
        let name = r.name(f.value, &fields.subject(f.key), "the name of a CSV file")?;
        let found = r.text_of_file(&name, &LIST).and_then(|text| list_in(text, &name));
        found.map_err(|e| r.data_error(f.value.span(), e)).ok()
    });
    if fields.get("designs").is_some() {
        for key in ["variables", "method", "samples", "seed", "levels"] {
            r.out_of_place(&fields, key, "the designs are those of the file that `designs` names");
        }
    }
    r.lost_tables(&fields);
    raw.push(r, Section::Sweep, place);
    let ranges = sweep_ranges(r, &fields, raw);
    let units = [r.units.length.per_metre(), r.units.angle.per_radian()];
    let list = |DesignList { titles, rows }: DesignList| DesignListDraft {
        file: fields.get("designs").and_then(|f| f.value.get_ref().as_str()).unwrap_or_default().into(),
        names: titles.into_iter().map(|title| title.name).collect(),
        rows,
        per_metre: units[0],
        per_radian: units[1],
    };
    let designs = designs.map(|mut list| {
        list.convert(r.units);
        raw.listed.clone_from(&list.titles);
        list
    });
    raw.draft.sweeping = Some(SweepSettingsDraft {
        method: method.map(|k| SweepMethod::NAMED[k]),
        ranges: fields.get("variables").map(|_| ranges),
        designs: designs.map(list),
        levels: levels.unwrap_or(SweepSettings::LEVELS),
        samples: samples.unwrap_or(SweepSettings::SAMPLES),
        seed: seed.map_or(SweepSettings::SEED, |seed| seed as u64),
        metrics,
        curves: curves.unwrap_or_default(),
    });
}

fn sweep_ranges(r: &mut Reader<'_>, sweep: &Fields<'_>, raw: &mut Raw) -> Vec<SweepRangeDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut found = Vec::new();
    for entry in r.entries_below(sweep, "sweep.", "variables", "design variable") {
        let (name, at, value) = &entry;
        let (place, ends, levels) = match value.get_ref() {
            DeValue::Table(_) => {
                let fields = r.entry("the range of", &entry, RANGE.keys());
                let place = EntryPlace::of(&fields);
                let ends = ["from", "to"].map(|key| r.number_of(&fields, key));
                (place, ends, r.count_of(&fields, "levels", MOST_LEVELS))
            }
            _ => {
                r.unread.clear();
                let subject = Subject {
                    name: format!("the range of `{}`", shown(name)),
                    example: format!(
                        "for example `{name} = [-5, 5]`, or `{name} = {{ from = -5, to = 5, levels = 5 }}`"
                    ),
                };
                let mut place = EntryPlace::at(at.clone());
                place.key("from", value);
                let ends = r.numbers::<2>(value, &subject, "the lower and the upper end");
                if ends.is_none() {
                    r.unread.push("from");
                }
                (place, [0, 1].map(|k| ends.map(|e| e[k])), None)
            }
        };
        if !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::SweepRanges, place);
        let [low, high] = ends;
        found.push(SweepRangeDraft { name: entry.0, low, high, levels, per_metre, per_radian });
    }
    found
}

/// Designs listed in a file.
#[derive(Debug)]
pub(crate) struct DesignList {
    /// Title of each column: a design variable, and the unit of its values.
    pub titles: Vec<Title>,
    /// Values of each design.
    pub rows: Vec<Vec<f64>>,
}

impl DesignList {
    /// Converts the lengths and angles whose columns have a unit to those of the model file.
    fn convert(&mut self, units: Units) {
        for (k, title) in self.titles.iter().enumerate() {
            for of in [Quantity::Length, Quantity::Angle] {
                // A unit of another kind is an error once the variable is known.
                if let Ok(own) = title.units(units, of.into(), "", LIST_CODE)
                    && own != units
                {
                    self.rows.iter_mut().for_each(|row| row[k] = units.from_si(of, own.to_si(of, row[k])));
                }
            }
        }
    }
}

/// HP0247: a column of the model's list of designs whose unit is not one of its variable.
pub(super) fn wrong_unit(
    model: &Model,
    units: Units,
    list: &DesignListDraft,
    titles: &[Title],
) -> Option<DraftError> {
    let ranges = &model.sweeping.as_ref()?.ranges;
    let one = |(column, (title, range)): (usize, (&Title, &SweepRange))| {
        let error = units_of_column(model, units, title, range.variable).err()?;
        let note = format!("it is the title of column {} of `{}`", column + 1, list.file);
        let at = DraftLocation { section: Section::Sweep, index: 0, key: "designs", item: None };
        let DataError { code, message, help, .. } = error;
        Some(DraftError { code, at, message, notes: vec![note], help })
    };
    titles.iter().zip(ranges).enumerate().find_map(one)
}

/// Units of the values of a variable below a title.
pub(super) fn units_of_column(
    model: &Model,
    units: Units,
    title: &Title,
    variable: VariableId,
) -> Result<Units, DataError> {
    let variable = &model.variables[variable.0];
    title.units(units, variable.quantity.into(), &variable_unit(model, units, variable), LIST_CODE)
}

/// List of designs in a file in any folder.
pub(crate) fn list_at(path: &Path) -> Result<DesignList, DataError> {
    let (name, text) = text_at(path, "design variables")?;
    list_in(&text, &name)
}

/// Reads a list of designs: names of variables, then their values, row by row.
fn list_in(text: &str, name: &str) -> Result<DesignList, DataError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let name = shown(name);
    let mut reader = records_of(text);
    let no_csv = |e: csv::Error| no_csv(&name, &e);
    let mut record = csv::StringRecord::new();
    let write = "write the names of design variables on the first line, like `B_x, B_z`, and their values on each line below";
    if !reader.read_record(&mut record).map_err(no_csv)? {
        return Err(DataError::content(format!("`{name}` is empty"), write));
    }
    let titles: Vec<Title> = record.iter().map(Title::of).collect();
    if titles.iter().all(|title| title.name.parse::<f64>().is_ok()) {
        let message =
            format!("`{name}`, line 1: there are numbers in place of the names of design variables");
        return Err(DataError::content(message, write));
    }
    let mut rows: Vec<Vec<f64>> = Vec::new();
    while reader.read_record(&mut record).map_err(no_csv)? {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() > titles.len() {
            let message =
                format!("`{name}`, line {line} has {} values for {} variables", record.len(), titles.len());
            return Err(DataError::content(message, "give one value for each name of the first line"));
        }
        let value = |(k, title): (usize, &Title)| {
            let here = format!("`{name}`, line {line}, column {} (`{}`)", k + 1, shown(&title.name));
            let help = "every design needs a value of every variable; write 0 for no change";
            number(record.get(k).map(unquoted), &here, help)
        };
        rows.push(titles.iter().enumerate().map(value).collect::<Result<_, _>>()?);
    }
    if rows.is_empty() {
        return Err(DataError::content(format!("`{name}` has no designs"), write));
    }
    Ok(DesignList { titles, rows })
}
