//! Tables of hardpoints: CSV files and spreadsheets.

use std::path::Path;

use calamine::{Data, Reader};

/// A larger file is no table of hardpoints.
const LARGEST: u64 = 16 << 20;

/// A hardpoint of a table.
#[derive(Debug, PartialEq)]
pub struct Row {
    /// Its line, from 1.
    pub line: usize,
    pub name: String,
    pub place: [f64; 3],
}

/// All rows of a table; what is wrong with it in words.
pub fn read(path: &Path) -> Result<Vec<Row>, String> {
    let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
    if size > LARGEST {
        return Err(format!("it is larger than {} MiB", LARGEST >> 20));
    }
    let is = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    let cells = match ["xlsx", "xlsm", "xls", "ods"].into_iter().any(is) {
        true => sheet(path)?,
        false => text(path)?,
    };
    rows(&cells)
}

/// The cells of the first sheet that has any.
fn sheet(path: &Path) -> Result<Vec<Vec<String>>, String> {
    let mut book = calamine::open_workbook_auto(path).map_err(|e| e.to_string())?;
    for name in book.sheet_names() {
        let range = book.worksheet_range(&name).map_err(|e| e.to_string())?;
        let cell = |cell: &Data| match cell {
            Data::Empty => String::new(),
            cell => cell.to_string(),
        };
        if !range.is_empty() {
            // Lines count from the top of the sheet.
            let above = range.start().map_or(0, |(row, _)| row as usize);
            let rows = range.rows().map(|row| row.iter().map(cell).collect());
            return Ok(std::iter::repeat_n(Vec::new(), above).chain(rows).collect());
        }
    }
    Err("none of its sheets has a cell".into())
}

/// The cells of a text, which semicolons, tabs or commas keep apart.
fn text(path: &Path) -> Result<Vec<Vec<String>>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::InvalidData => "it is not a text in UTF-8".to_owned(),
        _ => e.to_string(),
    })?;
    let text = text.trim_start_matches('\u{feff}');
    let first = text.lines().find(|l| !l.trim().is_empty() && !l.starts_with('#')).unwrap_or_default();
    let delimiter = *b"\t;".iter().find(|c| first.as_bytes().contains(c)).unwrap_or(&b',');
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
        // A record's position is that of the empty lines and remarks before it.
        let line = record.position().map_or(0, |p| {
            let before = text[p.byte() as usize..].lines().take_while(|l| l.is_empty() || l.starts_with('#'));
            p.line() as usize + before.count()
        });
        cells.resize(line.saturating_sub(1).max(cells.len()), Vec::new());
        cells.push(record.iter().map(str::to_owned).collect());
    }
    Ok(cells)
}

/// Names and places; the first line that is not empty may name the columns.
fn rows(cells: &[Vec<String>]) -> Result<Vec<Row>, String> {
    let filled = |row: &&Vec<String>| row.iter().any(|cell| !cell.trim().is_empty());
    let lines = || (1..).zip(cells).filter(|(_, row)| filled(row));
    let mut columns = [0, 1, 2, 3];
    let mut begin = 0;
    if let Some((line, head)) = lines().next() {
        let number = |k: usize| head.get(k).and_then(|cell| cell.trim().parse::<f64>().ok());
        if (0..head.len()).all(|k| number(k).is_none()) {
            begin = line;
            // `X [mm]` is x.
            let title =
                |cell: &String| cell.split(['[', '(']).next().unwrap_or_default().trim().to_lowercase();
            let titles: Vec<String> = head.iter().map(title).collect();
            for (column, title) in columns.iter_mut().skip(1).zip(["x", "y", "z"]) {
                let found = titles.iter().position(|t| t == title);
                *column = found
                    .ok_or_else(|| format!("line {line} names its columns, and none of them `{title}`"))?;
            }
            let name = titles.iter().position(|t| ["name", "hardpoint", "point"].contains(&t.as_str()));
            columns[0] = name.unwrap_or_else(|| (0..4).find(|k| !columns[1..].contains(k)).unwrap_or(0));
        }
    }
    let mut all = Vec::new();
    for (line, row) in lines().filter(|(line, _)| *line > begin) {
        let cell = |k: usize| row.get(columns[k]).map_or("", |cell| cell.trim());
        if cell(0).is_empty() {
            return Err(format!("line {line} has no name"));
        }
        let mut place = [0.0; 3];
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let found = cell(k + 1).parse::<f64>().ok().filter(|x| x.is_finite());
            place[k] =
                found.ok_or_else(|| format!("line {line}: `{}` is no number for {axis}", cell(k + 1)))?;
        }
        all.push(Row { line, name: cell(0).to_owned(), place });
    }
    if all.is_empty() { Err("it has no rows".into()) } else { Ok(all) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<Row>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        std::fs::write(&path, text).unwrap();
        read(&path)
    }

    #[test]
    fn columns_are_in_order_or_as_they_are_named() {
        let expected = vec![
            Row { line: 2, name: "A".into(), place: [1.0, 2.0, 3.5] },
            Row { line: 4, name: "B".into(), place: [-1.0, 0.0, 1e3] },
        ];
        for text in [
            "name,x,y,z\nA,1,2,3.5\n\nB,-1,0,1e3\n",
            "name,x,y,z\r\nA,1,2,3.5\r\n\r\nB,-1,0,1e3\r\n",
            "# from the drawing\nA; 1; 2; 3.5\n\nB; -1; 0; 1e3\n",
            "\u{feff}z [mm]\tPoint\tY (mm)\tX\n3.5\tA\t2\t1\n\n1e3\tB\t0\t-1\n",
        ] {
            assert_eq!(of(text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_table_is_told_with_its_line() {
        for (text, part) in [
            ("", "no rows"),
            ("name,x,y\nA,1,2\n", "none of them `z`"),
            ("A,1,2,3\nB,1,2\n", "line 2: `` is no number for z"),
            ("A,1,2,3\nB,1,\"2,5\",3\n", "line 2: `2,5` is no number for y"),
            ("A,1,2,3\n,1,2,3\n", "line 2 has no name"),
            ("A,1,2,inf\n", "line 1: `inf`"),
        ] {
            let error = of(text).unwrap_err();
            assert!(error.contains(part), "{text:?}: {error}");
        }
        assert!(read(Path::new("no such file.csv")).is_err());
    }
}
