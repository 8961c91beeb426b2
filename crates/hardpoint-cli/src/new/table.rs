//! Tables of hardpoints: CSV files and spreadsheets.

use std::path::Path;

use calamine::{Data, Reader};
use hardpoint_table::csv::original;

/// Maximum size of a file.
const LARGEST: u64 = 16 << 20;

/// Contents of a table.
#[derive(Debug, PartialEq)]
pub struct Hardpoints {
    pub rows: Vec<Row>,
    /// Line of the column names, from 1, if it has them.
    pub header: Option<usize>,
    /// Unit of its coordinates, if the column names have one, as in `x [mm]`.
    pub unit: Option<String>,
}

/// A hardpoint of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Line, from 1.
    pub line: usize,
    pub name: String,
    pub place: [f64; 3],
}

/// Reads all rows of a table; the error is a sentence. In a table of points in a plane, z may be absent; it is 0 then.
pub fn read(path: &Path, in_plane: bool) -> Result<Hardpoints, String> {
    let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
    if size > LARGEST {
        return Err(format!("it is larger than {} MiB", LARGEST >> 20));
    }
    let is = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    if ["xlsx", "xlsm", "xls", "ods"].into_iter().any(is) {
        return hardpoints(&sheet(path)?, in_plane);
    }
    let (cells, delimiter) = text(path)?;
    let table = hardpoints(&cells, in_plane)?;
    check_numbers_of_fields(&cells, &table, delimiter)?;
    Ok(table)
}

/// Cells of the first sheet that is not empty.
fn sheet(path: &Path) -> Result<Vec<Vec<String>>, String> {
    let mut book = calamine::open_workbook_auto(path).map_err(|e| e.to_string())?;
    for name in book.sheet_names() {
        let range = book.worksheet_range(&name).map_err(|e| e.to_string())?;
        let cell = |cell: &Data| match cell {
            Data::Empty => String::new(),
            cell => cell.to_string(),
        };
        if !range.is_empty() {
            // Lines are counted from the top of the sheet.
            let above = range.start().map_or(0, |(row, _)| row as usize);
            let rows = range.rows().map(|row| row.iter().map(cell).collect());
            return Ok(std::iter::repeat_n(Vec::new(), above).chain(rows).collect());
        }
    }
    Err("none of its sheets has a cell".into())
}

/// Number of columns of a table without column names.
const UNNAMED: usize = 4;

/// Checks that no row of a text has more fields than the table has columns: a decimal comma, or a separator that is too
/// much, would move the coordinates into other columns. Empty fields at the end do no harm.
fn check_numbers_of_fields(cells: &[Vec<String>], table: &Hardpoints, delimiter: u8) -> Result<(), String> {
    let used = |row: &Vec<String>| row.iter().rposition(|cell| !cell.trim().is_empty()).map_or(0, |k| k + 1);
    let columns = table.header.and_then(|line| cells.get(line - 1)).map_or(UNNAMED, used);
    let fields = |row: &Row| cells.get(row.line - 1).map_or(0, used);
    let Some(row) = table.rows.iter().find(|row| fields(row) > columns) else { return Ok(()) };
    let counted = match table.header {
        Some(line) => format!("line {line} has the names of {columns} columns"),
        None => format!("a table without column names has {columns} columns"),
    };
    let help = match delimiter {
        b',' => "if its numbers have decimal commas, separate the fields with semicolons",
        _ => "remove the others, or name their columns",
    };
    Err(format!("line {} has {} fields, but {counted}; {help}", row.line, fields(row)))
}

/// Cells of a text, separated by semicolons, tabs or commas, and the separator. Unless commas separate them, numbers
/// may have a decimal comma.
fn text(path: &Path) -> Result<(Vec<Vec<String>>, u8), String> {
    let text = std::fs::read_to_string(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::InvalidData => "it is not a text in UTF-8".to_owned(),
        _ => e.to_string(),
    })?;
    let text = text.trim_start_matches('\u{feff}');
    let first = text.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
    let delimiter = *b"\t;".iter().find(|c| first.as_bytes().contains(c)).unwrap_or(&b',');
    let text = &with_header(text, first, delimiter);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .delimiter(delimiter)
        .from_reader(text.as_bytes());
    let mut cells: Vec<Vec<String>> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| e.to_string())?;
        // The position of a record is the start of the empty lines and comments before it.
        let line = record.position().map_or(0, |p| {
            let before = text[p.byte() as usize..].lines().take_while(|l| l.is_empty() || l.starts_with('#'));
            p.line() as usize + before.count()
        });
        cells.resize(line.saturating_sub(1).max(cells.len()), Vec::new());
        cells.push(
            record
                .iter()
                .map(original)
                .map(|cell| if delimiter == b',' { cell.to_owned() } else { pointed(cell) })
                .collect(),
        );
    }
    Ok((cells, delimiter))
}

/// Removes the `#` before the column names: a line above the first row with columns x and y is a header, not a comment.
fn with_header(text: &str, first: &str, delimiter: u8) -> String {
    let mut out = text.to_owned();
    let above = text.lines().take_while(|l| l.trim().is_empty() || l.starts_with('#'));
    let heads = |line: &&str| {
        let titles: Vec<String> = line.split(char::from(delimiter)).map(|cell| title(cell).0).collect();
        ["x", "y"].iter().all(|axis| titles.iter().any(|t| t.trim_start_matches('#').trim() == *axis))
    };
    if let Some(line) = above.filter(|l| l.starts_with('#')).filter(heads).last().filter(|_| !heads(&first)) {
        let at = line.as_ptr() as usize - text.as_ptr() as usize;
        // The replacement has the same length, so that positions stay.
        out.replace_range(at..=at, " ");
    }
    out
}

/// Replaces the decimal comma of a number with a point; other text is unchanged.
fn pointed(cell: &str) -> String {
    let with_point = cell.replacen(',', ".", 1);
    if number(&with_point).is_some() { with_point } else { cell.to_owned() }
}

/// Names and coordinates; the first line that is not empty may be a header.
fn hardpoints(cells: &[Vec<String>], in_plane: bool) -> Result<Hardpoints, String> {
    let filled = |row: &&Vec<String>| row.iter().any(|cell| !cell.trim().is_empty());
    let lines = || (1..).zip(cells).filter(|(_, row)| filled(row));
    let mut columns = [0, 1, 2, 3].map(Some);
    let mut begin = 0;
    let mut header = None;
    let mut unit = None;
    if let Some((line, head)) = lines().next() {
        if in_plane && lines().all(|(_, row)| row.len() <= 3) {
            columns[3] = None;
        }
        if head.iter().all(|cell| number(cell).is_none()) {
            begin = line;
            header = Some(line);
            let titles: Vec<(String, Option<String>)> = head.iter().map(|cell| title(cell)).collect();
            for (k, axis) in (1..).zip(["x", "y", "z"]) {
                columns[k] = titles.iter().position(|(t, _)| t == axis);
                if columns[k].is_none() && !(in_plane && axis == "z") {
                    return Err(format!("line {line} is a header without a column `{axis}`"));
                }
            }
            let called = |t: &str| ["name", "hardpoint", "point"].contains(&t);
            let name = titles.iter().position(|(t, _)| called(t));
            columns[0] =
                name.or_else(|| (0..titles.len().min(4)).find(|k| !columns[1..].contains(&Some(*k))));
            if columns[0].is_none() {
                return Err(format!("line {line} is a header without a column for the names of hardpoints"));
            }
            unit = unit_of(columns[1..].iter().flatten().map(|k| &titles[*k].1), line)?;
            // Units may be on a line of their own.
            if let Some((line, units)) =
                lines().find(|(l, _)| *l > begin).filter(|(_, r)| is_units(r, &columns))
            {
                let symbol =
                    |cell: &String| Some(cell.trim_matches(['[', ']', '(', ')', ' ']).trim().to_lowercase());
                let below: Vec<Option<String>> =
                    columns[1..].iter().flatten().map(|k| units.get(*k).and_then(symbol)).collect();
                let below = unit_of(below.iter(), line)?;
                if unit.is_some() && unit != below {
                    return Err(format!("the units in line {line} contradict those of the column names"));
                }
                (unit, begin) = (below, line);
            }
        }
    }
    let mut rows = Vec::new();
    for (line, row) in lines().filter(|(line, _)| *line > begin) {
        let cell = |k: usize| row.get(k).map_or("", |cell| cell.trim());
        let name = columns[0].map_or("", cell);
        if name.is_empty() {
            return Err(format!("line {line} has no name"));
        }
        let mut place = [0.0; 3];
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let Some(text) = columns[k + 1].map(cell) else { continue };
            place[k] = number(text).ok_or_else(|| match number(name) {
                Some(_) if text.is_empty() => {
                    format!("line {line} has no name: write the name of the hardpoint before x, y and z")
                }
                _ => format!("line {line}: `{text}` is not a number for {axis}"),
            })?;
        }
        rows.push(Row { line, name: name.to_owned(), place });
    }
    if rows.is_empty() { Err("it has no rows".into()) } else { Ok(Hardpoints { rows, header, unit }) }
}

/// Returns whether a line below the names of the columns has a word in place of every coordinate.
fn is_units(row: &[String], columns: &[Option<usize>; 4]) -> bool {
    let mut cells = columns[1..].iter().flatten().map(|k| row.get(*k).map_or("", |cell| cell.trim()));
    cells.all(|cell| {
        let word = cell.trim_matches(['[', ']', '(', ')', ' ']);
        !word.is_empty() && word.chars().all(char::is_alphabetic) && number(word).is_none()
    })
}

fn number(cell: &str) -> Option<f64> {
    cell.trim().parse::<f64>().ok().filter(|x| x.is_finite())
}

/// Splits a column title into name and unit: `X [mm]` is x in mm.
fn title(cell: &str) -> (String, Option<String>) {
    let (name, rest) = cell.split_once(['[', '(']).unwrap_or((cell, ""));
    let unit = rest.trim().trim_end_matches([']', ')']).trim().to_lowercase();
    (name.trim().to_lowercase(), Some(unit).filter(|unit| !unit.is_empty()))
}

/// Common unit of the columns; `None` if they have no unit.
fn unit_of<'t>(
    mut units: impl Iterator<Item = &'t Option<String>>,
    line: usize,
) -> Result<Option<String>, String> {
    let Some(first) = units.next() else { return Ok(None) };
    let said = |unit: &Option<String>| unit.clone().unwrap_or_else(|| "no unit".into());
    match units.find(|unit| *unit != first) {
        Some(other) => Err(format!("line {line} has columns in {} and in {}", said(first), said(other))),
        None => Ok(first.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str, in_plane: bool) -> Result<Hardpoints, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        std::fs::write(&path, text).unwrap();
        read(&path, in_plane)
    }

    #[test]
    fn columns_are_in_order_or_as_they_are_named() {
        let expected = vec![
            Row { line: 2, name: "A".into(), place: [1.0, 2.0, 3.5] },
            Row { line: 4, name: "B".into(), place: [-1.0, 0.0, 1e3] },
        ];
        for (text, unit) in [
            ("name,x,y,z\nA,1,2,3.5\n\nB,-1,0,1e3\n", None),
            ("name,x,y,z\r\nA,1,2,3.5\r\n\r\nB,-1,0,1e3\r\n", None),
            ("# from the drawing\nA; 1; 2; 3.5\n\nB; -1; 0; 1e3\n", None),
            ("name;x;y;z\nA;1,0;2;3,5\n\nB;-1;0,000;1e3\n", None),
            (
                "\u{feff}z [mm]\tPoint\tY (mm)\tX [ MM ]\n3.5\tA\t2\t1\n\n1e3\tB\t0\t-1\n",
                Some("mm".to_owned()),
            ),
        ] {
            let found = of(text, false).map(|table| (table.rows, table.unit));
            assert_eq!(found, Ok((expected.clone(), unit)), "{text}");
        }
    }

    #[test]
    fn a_line_of_units_and_a_header_after_a_hash_are_understood() {
        let expected = |lines: [usize; 2]| {
            let rows = [("A", [1.0, 2.0, 3.5]), ("B", [-1.0, 0.0, 1e3])].into_iter().zip(lines);
            rows.map(|((name, place), line)| Row { line, name: name.into(), place }).collect::<Vec<_>>()
        };
        for (text, unit, lines) in [
            ("name,x,y,z\n-,mm,mm,mm\nA,1,2,3.5\nB,-1,0,1e3\n", Some("mm"), [3, 4]),
            ("name;x;y;z\n;[in];[in];[in]\nA;1;2;3,5\nB;-1;0;1e3\n", Some("in"), [3, 4]),
            ("#name,x,y,z\n-,mm,mm,mm\nA,1,2,3.5\nB,-1,0,1e3\n", Some("mm"), [3, 4]),
            ("name,x [m],y [m],z [m]\nunit,m,m,m\nA,1,2,3.5\nB,-1,0,1e3\n", Some("m"), [3, 4]),
            ("#name,x,y,z\nA,1,2,3.5\nB,-1,0,1e3\n", None, [2, 3]),
            ("# of the car\n# Point, z (mm), y (mm), x (mm)\nA,3.5,2,1\nB,1e3,0,-1\n", Some("mm"), [3, 4]),
            ("#,name,x,y,z\n1,A,1,2,3.5\n2,B,-1,0,1e3\n", None, [2, 3]),
        ] {
            let unit = unit.map(str::to_owned);
            let found = of(text, false).map(|table| (table.rows, table.unit));
            assert_eq!(found, Ok((expected(lines), unit)), "{text}");
        }
    }

    #[test]
    fn points_in_a_plane_need_no_third_coordinate() {
        for text in ["A,1,2\nB,-1,0.5\n", "x,y,name\n1,2,A\n-1,0.5,B\n", "name,x,y,z\nA,1,2,0\nB,-1,0.5,0\n"]
        {
            let found: Vec<_> = of(text, true).unwrap().rows.into_iter().map(|r| (r.name, r.place)).collect();
            assert_eq!(
                found,
                [("A".to_owned(), [1.0, 2.0, 0.0]), ("B".to_owned(), [-1.0, 0.5, 0.0])],
                "{text}"
            );
        }
        assert!(of("A,1,2\nB,1,2\n", false).unwrap_err().contains("not a number for z"));
    }

    /// Named columns besides the coordinates, empty fields at the end of a line, and lines without fields.
    #[test]
    fn further_columns_and_empty_fields_are_ignored() {
        for text in [
            "name,x,y,z,comment,part\nA,1,2,3,outer,7\nB,4,5,6\n",
            "name,x,y,z\nA,1,2,3,,\n,,,\nB,4,5,6,\n",
            "A,1,2,3,,\nB,4,5,6\n",
            "name;x;y;z;\nA;1,0;2,0;3,0;\nB;4;5;6\n",
        ] {
            let found: Vec<_> =
                of(text, false).unwrap().rows.into_iter().map(|r| (r.name, r.place)).collect();
            let expected = [("A".to_owned(), [1.0, 2.0, 3.0]), ("B".to_owned(), [4.0, 5.0, 6.0])];
            assert_eq!(found, expected, "{text}");
        }
    }

    #[test]
    fn an_invalid_table_is_reported_with_its_line() {
        for (text, part) in [
            (
                "name,x,y,z\nA,1,2,3\nB,0,5,0,7,99\n",
                "line 3 has 6 fields, but line 1 has the names of 4 columns; if its numbers have decimal commas, \
                 separate the fields with semicolons",
            ),
            ("name,x,y,z,\nA,0,5,0,7\n", "line 2 has 5 fields"),
            (
                "A,1,2,3\n\nB,0,5,0,7,99\n",
                "line 3 has 6 fields, but a table without column names has 4 columns",
            ),
            ("name;x;y;z\nA;1;2;3;4\n", "remove the others, or name their columns"),
            ("", "no rows"),
            ("name,x,y\nA,1,2\n", "without a column `z`"),
            ("A,1,2,3\nB,1,2\n", "line 2: `` is not a number for z"),
            ("A,1,2,3\nB,1,\"2,5\",3\n", "line 2: `2,5` is not a number for y"),
            ("A;1;2;3\nB;1;2.000,5;3\n", "line 2: `2.000,5` is not a number for y"),
            ("A,1,2,3\n,1,2,3\n", "line 2 has no name"),
            ("A,1,2,inf\n", "line 1: `inf`"),
            ("x,y,z\n1,2,3\n", "without a column for the names"),
            ("1,2,3\n4,5,6\n", "line 1 has no name"),
            ("name,x,y,z\n-,mm,mm,m\nA,1,2,3\n", "line 2 has columns in mm and in m"),
            ("name,x [mm],y [mm],z [mm]\n-,m,m,m\nA,1,2,3\n", "units in line 2 contradict"),
            ("name,x [mm],y [mm],z [m]\nA,1,2,3\n", "line 1 has columns in mm and in m"),
            ("name,x [mm],y,z\nA,1,2,3\n", "line 1 has columns in mm and in no unit"),
        ] {
            let error = of(text, false).unwrap_err();
            assert!(error.contains(part), "{text:?}: {error}");
        }
        assert!(read(Path::new("no such file.csv"), false).is_err());
    }
}
