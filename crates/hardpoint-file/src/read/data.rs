//! Files next to the model file, and two columns of a CSV file: times and values, or another abscissa and values.

use std::path::{Component, Path};

use crate::diagnostic::{closest, shown};
use crate::tree::{Folder, Reader};
use crate::{LARGEST_FILE, neighbours};

/// Maximum number of rows.
const MOST_ROWS: usize = 1_000_000;
/// Maximum number of columns that a message lists.
const LISTED_COLUMNS: usize = 24;

/// A column of a file.
pub(super) enum Column {
    /// Name in the first line of the file.
    Named(String),
    /// Index, from 1.
    Number(usize),
}

/// Default columns.
pub(super) const FIRST_TWO: [Column; 2] = [Column::Number(1), Column::Number(2)];

/// Error in a data file.
pub(crate) struct DataError {
    pub code: &'static str,
    pub message: String,
    pub notes: Vec<String>,
    pub help: Option<String>,
    /// True if the selection of columns is invalid.
    pub of_columns: bool,
}

impl DataError {
    /// HP0111: the file cannot be read.
    pub(super) fn unreadable(message: impl Into<String>, help: &str) -> Self {
        Self {
            code: "HP0111",
            message: message.into(),
            notes: Vec::new(),
            help: Some(help.into()),
            of_columns: false,
        }
    }

    /// HP0112: the file has no curve.
    pub(super) fn content(message: impl Into<String>, help: &str) -> Self {
        Self {
            code: "HP0112",
            message: message.into(),
            notes: Vec::new(),
            help: Some(help.into()),
            of_columns: false,
        }
    }

    fn of_columns(self) -> Self {
        Self { of_columns: true, ..self }
    }

    pub(super) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

impl Reader<'_> {
    /// Points of a file in the model's folder or below it.
    pub(super) fn points_of_text(
        &mut self,
        name: &str,
        columns: &[Column; 2],
        of: &Curve,
    ) -> Result<Vec<[f64; 2]>, DataError> {
        let text = self.text_of_file(name, &of.wanted)?;
        parse(text.strip_prefix('\u{feff}').unwrap_or(text), &shown(name), columns, of)
    }

    /// Text of a file in the model's folder or below it; it is stored with the model.
    pub(super) fn text_of_file(&mut self, name: &str, wanted: &Wanted<'_>) -> Result<&str, DataError> {
        let text = text_from(bytes_of(self.folder, name, wanted)?, name)?;
        Ok(self.texts.entry(name.to_owned()).insert_entry(text).into_mut())
    }
}

/// Descriptions of a requested file, for messages.
pub(super) struct Wanted<'a> {
    /// Purpose of the file.
    pub purpose: &'a str,
    /// Kind of file, with its article.
    pub kind: &'a str,
    /// Ending of its name, to suggest other files in the folder.
    pub ending: &'a str,
    /// Example of a name.
    pub example: &'a str,
    /// Instruction if the model has no folder.
    pub without_folder: &'a str,
    /// Instruction if the file is too large.
    pub too_large: &'a str,
}

/// Descriptions of a curve in a file, for messages.
pub(super) struct Curve {
    wanted: Wanted<'static>,
    /// Abscissa of the curve, and its plural.
    pub abscissa: &'static str,
    abscissas: &'static str,
    /// Unit of the abscissa, after a number.
    unit: &'static str,
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
    write: "write a deflection in the model's length unit and a force in N on each line, like `12.5, 340`",
};

/// Text of a file.
pub(super) fn text_from(bytes: Vec<u8>, name: &str) -> Result<String, DataError> {
    String::from_utf8(bytes).map_err(|_| {
        let message = format!("the file `{}` is not a text in UTF-8", shown(name));
        DataError::unreadable(message, "save it as UTF-8 text")
    })
}

/// Bytes of a file in the model's folder or below it.
pub(super) fn bytes_of(folder: Folder<'_>, name: &str, wanted: &Wanted<'_>) -> Result<Vec<u8>, DataError> {
    let path = inside(name, wanted)?;
    let known = name;
    let name = shown(name);
    let folder = match folder {
        Folder::On(folder) => folder,
        Folder::Given(texts) => match texts.get(known) {
            Some(text) => return Ok(text.clone().into_bytes()),
            None => {
                let message = format!("the file `{name}` is not part of this model");
                return Err(DataError::unreadable(message, wanted.without_folder));
            }
        },
        Folder::None => {
            let message = format!("the file `{name}` cannot be read: this model is a text without a folder");
            return Err(DataError::unreadable(message, wanted.without_folder));
        }
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let failed = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => {
            let message = format!("there is no file `{name}` next to the model file");
            let mut error =
                DataError::unreadable(message, "the path counts from the folder of the model file");
            let (note, close) = neighbours(&folder.join(path), wanted.ending);
            error.notes.extend(note);
            // The name in the model does not contain the reader's folder.
            let prefix = folder.join("").display().to_string();
            error.help = close.map(|c| c.replacen(&prefix, "", 1)).or(error.help);
            error
        }
        _ => DataError::unreadable(format!("the file `{name}` cannot be read"), "check its permissions")
            .note(e.to_string()),
    };
    let full = folder.join(path).canonicalize().map_err(failed)?;
    if !full.starts_with(folder.canonicalize().map_err(failed)?) {
        return Err(leaves(&name, wanted).note("it is a link to a place outside"));
    }
    let meta = std::fs::metadata(&full).map_err(failed)?;
    if !meta.is_file() {
        let message = format!("`{name}` is not a file");
        return Err(DataError::unreadable(message, &format!("name {} in the model's folder", wanted.kind)));
    }
    if meta.len() > LARGEST_FILE {
        let message = format!("the file `{name}` is too large for a {}", wanted.purpose);
        return Err(DataError::unreadable(message, wanted.too_large)
            .note(format!("at most {} MiB are read", LARGEST_FILE >> 20)));
    }
    std::fs::read(&full).map_err(failed)
}

/// Path of a file in the model's folder, valid on all systems; `None` for other paths.
fn inside<'n>(name: &'n str, wanted: &Wanted<'_>) -> Result<&'n Path, DataError> {
    let path = Path::new(name);
    if name.trim().is_empty() {
        let message = format!("the name of the {}'s file is empty", wanted.purpose);
        return Err(DataError::unreadable(message, &format!("name {}", wanted.kind)));
    }
    let is_absolute = path.has_root() || name.starts_with('\\') || name.as_bytes().get(1) == Some(&b':');
    if is_absolute || path.components().any(|c| c == Component::ParentDir) || name.contains("..\\") {
        return Err(leaves(&shown(name), wanted));
    }
    if name.contains('\\') {
        let message = format!("the path `{}` has a `\\`", shown(name));
        return Err(DataError::unreadable(message, "separate folders with `/`; that works on every system"));
    }
    Ok(path)
}

fn leaves(name: &str, wanted: &Wanted<'_>) -> DataError {
    let help = "put it into the folder of the model file, or a folder in it, and name it from there, like";
    DataError::unreadable(
        format!("the file `{name}` is not in the model's folder"),
        &format!("{help} `{}`", wanted.example),
    )
}

fn parse(text: &str, name: &str, columns: &[Column; 2], of: &Curve) -> Result<Vec<[f64; 2]>, DataError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .delimiter(delimiter(text))
        .from_reader(text.as_bytes());
    let mut record = csv::StringRecord::new();
    let mut header: Option<Vec<String>> = None;
    let mut taken = None;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let unit = of.unit;
    loop {
        match reader.read_record(&mut record) {
            Ok(true) => {}
            Ok(false) => break,
            Err(e) => {
                let message = format!("`{name}` is not a CSV file");
                return Err(DataError::content(message, "check its quotes").note(e.to_string()));
            }
        }
        let line = record.position().map_or(0, csv::Position::line);
        let is_first = header.is_none() && taken.is_none();
        if is_first && !record.iter().any(|field| unquoted(field).parse::<f64>().is_ok()) {
            header = Some(record.iter().map(|name| unquoted(name).to_owned()).collect());
            continue;
        }
        let places = match taken {
            Some(places) => places,
            None => *taken.insert(
                found(columns, header.as_deref(), record.len(), name, of).map_err(DataError::of_columns)?,
            ),
        };
        let mut point = [0.0; 2];
        for (k, place) in places.into_iter().enumerate() {
            let title = header.as_ref().and_then(|h| h.get(place)).map(|h| format!(" (`{}`)", shown(h)));
            let here = format!("`{name}`, line {line}, column {}{}", place + 1, title.unwrap_or_default());
            point[k] = number(record.get(place).map(unquoted), &here, "every row needs both columns")?;
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
    Ok(points)
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
            (Column::Named(wanted), Some(header)) if header.iter().filter(|h| *h == wanted).count() > 1 => {
                let at: Vec<String> =
                    (1..).zip(header).filter(|(_, h)| *h == wanted).map(|(n, _)| n.to_string()).collect();
                let message = format!("`{name}` has several columns `{}`", shown(wanted));
                let help = "rename them in the file, or choose columns by number, like `columns = [1, 2]`";
                return Err(DataError::content(message, help).note(format!("columns {}", at.join(", "))));
            }
            (Column::Named(wanted), Some(header)) => match header.iter().position(|h| h == wanted) {
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
