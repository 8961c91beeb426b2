//! Two columns of a CSV file: times and values, or another abscissa and values. Titles of columns, with their units.

use std::path::Path;

use hardpoint::model::Dimension;
use toml::de::DeValue;

use crate::values::{
    DataError, Field, Fields, Reader, Shape, Subject, Table, Value, Wanted, closest, shown, text_from,
};
use hardpoint_table::csv::original;
use hardpoint_table::figures::unit as symbol_of;
use hardpoint_table::{AngleUnit, LengthUnit, Unit, Units};

/// Maximum number of rows.
const MOST_ROWS: usize = 1_000_000;
/// Maximum number of columns that a message lists.
const LISTED_COLUMNS: usize = 24;
pub(super) const COLUMN: Shape = Shape::Any(
    "Column",
    "A column's name, or its number from 1.",
    &[Shape::Name("a column"), Shape::Count(u32::MAX)],
);

/// A column of a file.
enum Column {
    /// Name in the first line of the file.
    Named(String),
    /// Index, from 1.
    Number(usize),
}

/// Default columns.
const FIRST_TWO: [Column; 2] = [Column::Number(1), Column::Number(2)];

/// Descriptions of a curve in a file, for messages.
pub(super) struct Curve {
    wanted: Wanted<'static>,
    /// Abscissa of the curve, and its plural.
    abscissa: &'static str,
    abscissas: &'static str,
    /// Unit of the abscissa, after a number.
    unit: &'static str,
    /// Dimensions that abscissa and value may have; empty where the model decides.
    dimensions: [&'static [Dimension]; 2],
    /// Instruction if the file is empty.
    write: &'static str,
}

/// Table of a law.
pub(super) const TABLE: Curve = Curve {
    wanted: Wanted {
        purpose: "table",
        kind: "a CSV file",
        ending: "csv",
        example: "data/travel.csv",
        without_folder: "write the table as `points = [[0, 0], [1, 5]]`, or read the model from a file",
        too_large: "keep fewer rows, such as every tenth one",
    },
    abscissa: "time",
    abscissas: "times",
    unit: " s",
    // What a law prescribes, or the factor of a force.
    dimensions: [&[], &[Dimension::LENGTH, Dimension::ANGLE, Dimension::NUMBER]],
    write: "write a time in s and a value on each line, like `0.5, 12.5`",
};
/// Target of a metric.
pub(super) const TARGET: Curve = Curve {
    wanted: Wanted {
        purpose: "target",
        example: "data/target.csv",
        without_folder: "write the target as `target = [[-50, 0.1], [50, -0.1]]`, or read the model from a file",
        ..TABLE.wanted
    },
    abscissa: "abscissa",
    abscissas: "abscissas",
    unit: "",
    dimensions: [&[]; 2],
    write: "write an abscissa and a value on each line, in the units of the model file, like `-20, 0.15`",
};
/// Force of a spring.
pub(super) const FORCE: Curve = Curve {
    wanted: Wanted {
        purpose: "table",
        example: "data/bump_stop.csv",
        without_folder: "write the table as `[[0, 0], [20, 400]]`, or read the model from a file",
        ..TABLE.wanted
    },
    abscissa: "way",
    abscissas: "ways",
    unit: "",
    dimensions: [&[Dimension::LENGTH], &[Dimension::FORCE]],
    write: "write a deflection in the model's length unit and a force in N on each line, like `12.5, 340`",
};

/// Moment of a spring.
pub(super) const MOMENT: Curve = Curve {
    abscissa: "angle",
    abscissas: "angles",
    dimensions: [&[Dimension::ANGLE], &[Dimension::MOMENT]],
    write: "write an angle in the model's angle unit and a moment in N m on each line, like `5, 34`",
    ..FORCE
};

/// Points of a file, in the units of the model file, and the titles of their columns.
pub(super) struct FilePoints {
    pub points: Vec<[f64; 2]>,
    pub titles: Titles,
}

/// Titles of the columns of abscissa and value, where a file has them.
pub(super) type Titles = [Option<Title>; 2];

/// Points, which `pair` reads one by one, the name of a file that holds them, or a table with it; with the titles of
/// the file's columns.
pub(super) fn points_given<P: From<[f64; 2]>>(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    (table_of_file, of): (&'static Table, &Curve),
    pair: impl Fn(&mut Reader<'_>, &Value<'_>, &Subject, &str) -> Option<P>,
) -> Option<(Vec<P>, Titles)> {
    let in_file = |found: FilePoints| (found.points.into_iter().map(P::from).collect(), found.titles);
    let subject = fields.subject(f.key);
    match f.value.get_ref() {
        DeValue::Table(table) => {
            let fields = r.fields(subject.name, f.value.span(), table, table_of_file.keys());
            let file = r.need(&fields, "file")?;
            points_in_file(r, &fields, file, of).map(in_file)
        }
        DeValue::String(name) => match points_of_text(r, name, &FIRST_TWO, of) {
            Ok(points) => Some(in_file(points)),
            Err(e) => {
                r.data_error(f.value.span(), e);
                None
            }
        },
        _ => {
            let expected = format!("points `[{}, value]`, or the name of a CSV file", of.abscissa);
            let list = r.list(f.value, &subject, &expected)?;
            let points: Option<Vec<P>> =
                list.iter().map(|value| pair(r, value, &subject, &expected)).collect();
            Some((points?, [None, None]))
        }
    }
}

/// The points of a file, whose name a field gives and whose columns another.
pub(super) fn points_in_file(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    of: &Curve,
) -> Option<FilePoints> {
    let columns = columns(r, fields, of);
    let name = r.text(fields, f)?;
    let columns = columns?;
    match points_of_text(r, &name, &columns, of) {
        Ok(points) => Some(points),
        Err(e) => {
            let at = fields.get("columns").filter(|_| e.of_columns).unwrap_or(f);
            r.data_error(at.value.span(), e);
            None
        }
    }
}

/// The two columns of a file, by name or number; the first two where none are named.
fn columns(r: &mut Reader<'_>, fields: &Fields<'_>, of: &Curve) -> Option<[Column; 2]> {
    let Some(f) = fields.get("columns") else { return Some(FIRST_TWO) };
    let subject = fields.subject("columns");
    let expected =
        format!("two columns, of the {} and of the value, each a name or a number from 1", of.abscissa);
    let list = match f.value.get_ref().as_array() {
        Some(list) if list.len() == 2 => list,
        _ => {
            r.wrong(f.value, &subject, &expected);
            return None;
        }
    };
    let [time, value] = [0, 1].map(|k| match list[k].get_ref() {
        DeValue::String(_) => r.name(&list[k], &subject, &expected).map(Column::Named),
        _ => {
            let number = r.number(&list[k], &subject)?;
            if !((1.0..=1e6).contains(&number) && number.fract() == 0.0) {
                r.senseless(list[k].span(), format!("{} cannot be {number}", subject.name)).help =
                    Some("columns are counted from 1".into());
                return None;
            }
            Some(Column::Number(number as usize))
        }
    });
    Some([time?, value?])
}

/// Points of a file in the model's folder or below it.
fn points_of_text(
    r: &mut Reader<'_>,
    name: &str,
    columns: &[Column; 2],
    of: &Curve,
) -> Result<FilePoints, DataError> {
    let units = r.units;
    let text = r.text_of_file(name, &of.wanted)?;
    parse(text.strip_prefix('\u{feff}').unwrap_or(text), &shown(name), columns, of, units)
}

/// Points of a CSV text, in these units: those of titles with other units of length or angle are converted.
fn parse(
    text: &str,
    name: &str,
    columns: &[Column; 2],
    of: &Curve,
    units: Units,
) -> Result<FilePoints, DataError> {
    let mut reader = records_of(text);
    let mut record = csv::StringRecord::new();
    let mut header: Option<Vec<String>> = None;
    let mut taken: Option<([usize; 2], [f64; 2])> = None;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let unit = of.unit;
    while reader.read_record(&mut record).map_err(|e| no_csv(name, &e))? {
        let line = record.position().map_or(0, csv::Position::line);
        let is_first = header.is_none() && taken.is_none();
        if is_first && !record.iter().any(|field| unquoted(field).parse::<f64>().is_ok()) {
            header = Some(record.iter().map(|name| unquoted(name).to_owned()).collect());
            continue;
        }
        let (places, scales) = match taken {
            Some(taken) => taken,
            None => {
                let places = found(columns, header.as_deref(), record.len(), name, of)
                    .map_err(DataError::of_columns)?;
                *taken.insert((places, scales(places, header.as_deref(), name, of, units)?))
            }
        };
        let mut point = [0.0; 2];
        for (k, (place, scale)) in places.into_iter().zip(scales).enumerate() {
            let title = header.as_ref().and_then(|h| h.get(place)).map(|h| format!(" (`{}`)", shown(h)));
            let here = format!("`{name}`, line {line}, column {}{}", place + 1, title.unwrap_or_default());
            point[k] =
                scale * number(record.get(place).map(unquoted), &here, "every row needs both columns")?;
        }
        if let Some(before) = points.last().filter(|before| point[0] <= before[0]) {
            let message = format!(
                "`{name}`, line {line}: the {} of a {} must increase, but {}{unit} follows {}{unit}",
                of.abscissas, of.wanted.purpose, point[0], before[0]
            );
            let help = format!("sort the rows by {x}, and keep one for each {x}", x = of.abscissa);
            return Err(DataError::content(message, &help));
        }
        points.push(point);
        if points.len() > MOST_ROWS {
            let message = format!("`{name}` has more than {MOST_ROWS} rows");
            return Err(DataError::content(message, "keep fewer rows"));
        }
    }
    if points.is_empty() {
        if let Some(header) = &header {
            found(columns, Some(header), header.len(), name, of).map_err(DataError::of_columns)?;
        }
        let message = format!("`{name}` has no rows of numbers");
        return Err(DataError::content(message, of.write));
    }
    let title = |place: usize| Some(Title::of(header.as_ref()?.get(place)?));
    let titles = taken.map_or([None, None], |(places, _)| places.map(title));
    Ok(FilePoints { points, titles })
}

/// Name, in quotes for messages, and text of a CSV file in any folder, whose first line `names` something.
pub(super) fn text_at(path: &Path, names: &str) -> Result<(String, String), DataError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| {
        let message = format!("the file `{}` cannot be read", shown(&name));
        DataError::unreadable(message, &format!("name a CSV file whose first line names {names}"))
            .note(e.to_string())
    })?;
    let text = text_from(bytes, &name)?;
    Ok((name, text))
}

/// Reader of the records of a CSV text.
pub(super) fn records_of(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .delimiter(delimiter(text))
        .from_reader(text.as_bytes())
}

/// HP0112: a text without records.
pub(super) fn no_csv(name: &str, e: &csv::Error) -> DataError {
    DataError::content(format!("`{name}` is not a CSV file"), "check its quotes").note(e.to_string())
}

/// Delimiter of the columns: a tab or a semicolon, if the first line has one, or a comma.
pub(super) fn delimiter(text: &str) -> u8 {
    let mut lines = text.lines().filter(|l| !l.trim().is_empty() && !l.starts_with('#'));
    let first = lines.next().unwrap_or_default();
    *b"\t;".iter().find(|c| first.as_bytes().contains(c)).unwrap_or(&b',')
}

/// Indices of the columns, from 0.
fn found(
    columns: &[Column; 2],
    header: Option<&[String]>,
    width: usize,
    name: &str,
    of: &Curve,
) -> Result<[usize; 2], DataError> {
    // With its unit or without.
    let is = |title: &str, wanted: &str| title == wanted || Title::of(title).name == wanted;
    let mut places = [0; 2];
    for (place, column) in places.iter_mut().zip(columns) {
        *place = match (column, header) {
            (Column::Number(n), _) if *n <= width => n - 1,
            (Column::Number(n), _) => {
                let columns = if width == 1 { "1 column".into() } else { format!("{width} columns") };
                let message = format!("`{name}` has no column {n}");
                let help = "separate columns with commas, semicolons or tabs, and choose two with `columns = [1, 2]`";
                return Err(DataError::content(message, help).note(format!("its first line has {columns}")));
            }
            (Column::Named(wanted), Some(header)) if header.iter().filter(|h| is(h, wanted)).count() > 1 => {
                let at: Vec<String> =
                    (1..).zip(header).filter(|(_, h)| is(h, wanted)).map(|(n, _)| n.to_string()).collect();
                let message = format!("`{name}` has several columns `{}`", shown(wanted));
                let help = "rename them in the file, or choose columns by number, like `columns = [1, 2]`";
                return Err(DataError::content(message, help).note(format!("columns {}", at.join(", "))));
            }
            (Column::Named(wanted), Some(header)) => match header.iter().position(|h| is(h, wanted)) {
                Some(k) => k,
                None => {
                    let message = format!("`{name}` has no column `{}`", shown(wanted));
                    let names = header.iter().take(LISTED_COLUMNS);
                    let list: Vec<_> = names.map(|h| format!("`{}`", shown(h))).collect();
                    let close = closest(wanted, header.iter().map(String::as_str));
                    let mut e =
                        DataError::content(message, "").note(format!("its columns: {}", list.join(", ")));
                    let close = close.map(|c| format!("did you mean `{c}`?"));
                    e.help = Some(
                        close.unwrap_or_else(|| "name one of these columns, or choose by number".into()),
                    );
                    return Err(e);
                }
            },
            (Column::Named(wanted), None) => {
                let message = format!("`{name}` has no column `{}`", shown(wanted));
                return Err(DataError::content(message, "choose columns by number, like `columns = [1, 2]`")
                    .note("its first line holds numbers, not the names of columns"));
            }
        };
    }
    if places[0] == places[1] {
        let x = of.abscissa;
        let message =
            format!("`columns` takes column {} of `{name}` for both the {x} and the value", places[0] + 1);
        return Err(DataError::content(message, &format!("name two columns, the {x} first")));
    }
    Ok(places)
}

/// Factors from the units in the titles of two columns to those of the model file; 1 without a unit.
fn scales(
    places: [usize; 2],
    header: Option<&[String]>,
    name: &str,
    of: &Curve,
    units: Units,
) -> Result<[f64; 2], DataError> {
    let mut scales = [1.0; 2];
    for (k, place) in places.into_iter().enumerate() {
        let Some(title) = header.and_then(|titles| titles.get(place)).map(|title| Title::of(title)) else {
            continue;
        };
        let Some(written) = title.unit.as_deref() else { continue };
        if k == 0 && of.abscissa == "time" {
            if written != "s" {
                let message = format!("the times of `{name}` are in `{}`", shown(written));
                return Err(DataError::content(message, "give times in s"));
            }
            continue;
        }
        let of_column = format!("`{}` of `{name}` is in `{}`", shown(&title.name), shown(written));
        let Some(unit) = Unit::of_symbol(written) else {
            let message = format!("{of_column}, which is not a known unit");
            let help = "give its values in the unit of the model file, or remove the unit of the column";
            return Err(DataError::content(message, help));
        };
        let known = of.dimensions[k];
        if !known.is_empty() && !known.contains(&unit.dimension) {
            let own = known.iter().map(|own| symbol_of(units, *own)).collect::<Vec<_>>().join(", ");
            return Err(DataError::content(
                format!("{of_column}, and the model file has {own}"),
                &format!("give the values in {own}, or choose other `columns`"),
            ));
        }
        // Numbers in the model's own unit stay as they are, without round-off.
        if written != symbol_of(units, unit.dimension) {
            scales[k] = unit.size * units.per_si(unit.dimension);
        }
    }
    Ok(scales)
}

/// Title of a column.
#[derive(Clone, Debug)]
pub(crate) struct Title {
    /// Name, without the unit.
    pub name: String,
    /// Unit in brackets behind the name.
    pub unit: Option<String>,
}

impl Title {
    /// Splits the title in a cell into name and unit: `toe [deg]`.
    pub fn of(cell: &str) -> Self {
        let title = original(unquoted(cell));
        let split = title.split_once(" [").and_then(|(name, unit)| Some((name, unit.strip_suffix(']')?)));
        match split {
            Some((name, unit)) => Self { name: name.to_owned(), unit: unit_in(unit) },
            None => Self { name: title.to_owned(), unit: None },
        }
    }

    /// Units in which the numbers below are read: those of the model file, or the unit of the title in place of its own
    /// if both are lengths or both are angles. `own` is the unit of the model file, `1` of a plain number.
    ///
    /// # Errors
    /// An error with this code if the unit is another one.
    pub fn units(
        &self,
        units: Units,
        of: Dimension,
        own: &str,
        code: &'static str,
    ) -> Result<Units, DataError> {
        let Some(written) = self.unit.as_deref() else { return Ok(units) };
        let (length, angle) = (LengthUnit::of_symbol(written), AngleUnit::of_symbol(written));
        let (name, written) = (shown(&self.name), shown(written));
        let symbols = |of: &[&str]| format!("give its values in one of {}", of.join(", "));
        let (message, help) = match (of, length, angle) {
            (Dimension::LENGTH, Some(length), _) => return Ok(Units { length, ..units }),
            (Dimension::ANGLE, _, Some(angle)) => return Ok(Units { angle, ..units }),
            _ if written == own => return Ok(units),
            (Dimension::LENGTH, ..) => (
                format!("`{name}` is in `{written}`, and it is a length"),
                symbols(&LengthUnit::ALL.map(LengthUnit::symbol)),
            ),
            (Dimension::ANGLE, ..) => (
                format!("`{name}` is in `{written}`, and it is an angle"),
                symbols(&AngleUnit::ALL.map(AngleUnit::symbol)),
            ),
            _ if own == "1" => (
                format!("`{name}` is in `{written}`, and it is a plain number"),
                "remove the unit of the column".to_owned(),
            ),
            _ => (
                format!("`{name}` is in `{written}`, and the model file has {own}"),
                format!("give the values in {own}"),
            ),
        };
        Err(DataError::new(code, message, help))
    }

    /// Units in which the numbers below are read, as [`units`](Self::units), and the factor from the unit of the title
    /// to theirs: any unit of this dimension is converted.
    ///
    /// # Errors
    /// An error with this code if the unit measures something else.
    pub fn conversion(
        &self,
        units: Units,
        of: Dimension,
        code: &'static str,
    ) -> Result<(Units, f64), DataError> {
        let written = self.unit.as_deref().and_then(Unit::of_symbol);
        match (self.units(units, of, &symbol_of(units, of), code), written) {
            (Ok(units), _) => Ok((units, 1.0)),
            (Err(_), Some(unit)) if unit.dimension == of => Ok((units, unit.size * units.per_si(of))),
            (Err(error), _) => Err(error),
        }
    }
}

/// HP0112: the error of a column in `data` whose unit is not one of the quantity `of`, once its dimension is known.
pub(super) fn other_unit(
    [name, written]: [&str; 2],
    data: &str,
    units: Units,
    (of, dimension): (&str, Dimension),
) -> Option<DataError> {
    if Unit::of_symbol(written).is_some_and(|unit| unit.dimension == dimension) {
        return None;
    }
    let column = format!("`{}` of {data} is in `{}`", shown(name), shown(written));
    Some(match symbol_of(units, dimension).as_str() {
        "1" => DataError::content(
            format!("{column}, and {of} is a plain number"),
            "remove the unit of the column, or choose other `columns`",
        ),
        own => DataError::content(
            format!("{column}, and {of} is in {own}"),
            &format!("give the values in {own}, or choose other `columns`"),
        ),
    })
}

/// Unit in a cell or in the brackets of a title; plain numbers have none.
pub(super) fn unit_in(text: &str) -> Option<String> {
    Some(text.trim()).filter(|unit| !matches!(*unit, "" | "-")).map(str::to_owned)
}

/// Removes the quotes of a field that begins with a blank.
pub(super) fn unquoted(field: &str) -> &str {
    field.strip_prefix('"').and_then(|f| f.strip_suffix('"')).map_or(field, str::trim)
}

pub(super) fn number(field: Option<&str>, here: &str, needs: &str) -> Result<f64, DataError> {
    let help = "write numbers with a decimal point and without units";
    match field {
        None => Err(DataError::content(format!("{here} is missing"), needs)),
        Some("") => Err(DataError::content(format!("{here} is empty"), needs)),
        Some(field) => match field.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(_) => Err(DataError::content(format!("{here}: `{field}` is not a finite number"), help)),
            Err(_) => Err(DataError::content(format!("{here}: `{}` is not a number", shown(field)), help)),
        },
    }
}
