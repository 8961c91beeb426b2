//! Long tables, written row by row as CSV or Parquet.

use std::fs::File;
use std::io::{self, Write};
use std::sync::Arc;

use hardpoint_table::csv::CsvWriter;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

use hardpoint_report::GENERATOR;
use hardpoint_report::cells::Cells;

/// Maximum number of rows and of cells of a Parquet row group, so that the table need not fit into memory.
const GROUP_ROWS: usize = 1 << 16;
const GROUP_CELLS: usize = 1 << 22;
/// Columns of a table by name; the cells give the column type only.
pub type Kinds = Vec<(String, Cells)>;

/// Format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Text, one row per line.
    Csv,
    /// Apache Parquet, not compressed: compression hardly reduces floating-point numbers.
    Parquet,
}

impl TableFormat {
    /// Ending of its file names.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }
}

/// A table that is being written. The file depends on the rows only, not on how they were grouped.
pub struct TableWriter<W: Write + Send> {
    sink: Sink<W>,
}

enum Sink<W: Write + Send> {
    Csv(Box<CsvWriter<W>>),
    Parquet { writer: Box<SerializedFileWriter<W>>, pending: Vec<Cells>, group: usize },
}

impl<W: Write + Send> TableWriter<W> {
    /// Creates a table with these columns. `facts`, by key, are written to the metadata of a Parquet file.
    ///
    /// # Errors
    /// Fails if the table cannot be written.
    pub fn new(out: W, format: TableFormat, columns: Kinds, facts: &[(&str, String)]) -> io::Result<Self> {
        let sink = match format {
            TableFormat::Csv => {
                let mut csv = CsvWriter::new(out);
                csv.row(columns.iter().map(|(name, _)| name))?;
                Sink::Csv(Box::new(csv))
            }
            TableFormat::Parquet => {
                let properties = WriterProperties::builder()
                    .set_created_by(GENERATOR.into())
                    .set_key_value_metadata((!facts.is_empty()).then(|| facts.iter().map(fact).collect()))
                    .set_compression(Compression::UNCOMPRESSED)
                    .set_dictionary_enabled(false);
                let schema = schema(&columns).map_err(io::Error::other)?;
                let writer = SerializedFileWriter::new(out, schema, Arc::new(properties.build()));
                let group = usize::clamp(GROUP_CELLS / columns.len().max(1), 1, GROUP_ROWS);
                let pending = columns.into_iter().map(|(_, cells)| cells).collect();
                Sink::Parquet { writer: Box::new(writer.map_err(io::Error::other)?), pending, group }
            }
        };
        Ok(Self { sink })
    }

    /// Adds rows; all columns have the same number of cells.
    ///
    /// # Errors
    /// Fails if the rows cannot be written.
    pub fn add(&mut self, rows: Vec<Cells>) -> io::Result<()> {
        match &mut self.sink {
            Sink::Csv(csv) => {
                for row in 0..rows.first().map_or(0, Cells::len) {
                    csv.row(rows.iter().map(|cells| cells.text(row)))?;
                }
                Ok(())
            }
            Sink::Parquet { writer, pending, group } => {
                // A group ends when it is full, independent of the calls that added the rows.
                let mut rest = rows;
                loop {
                    let room = *group - pending.first().map_or(0, Cells::len);
                    let later: Vec<Cells> = rest.iter_mut().map(|cells| cells.split_off(room)).collect();
                    pending.iter_mut().zip(rest).for_each(|(cells, more)| cells.append(more));
                    if pending.first().map_or(0, Cells::len) < *group {
                        return Ok(());
                    }
                    write_group(writer, pending)?;
                    rest = later;
                }
            }
        }
    }

    /// Completes the table and returns the writer.
    ///
    /// # Errors
    /// Fails if the table cannot be written.
    pub fn end(self) -> io::Result<W> {
        match self.sink {
            Sink::Csv(csv) => csv.end(),
            Sink::Parquet { mut writer, mut pending, .. } => {
                if pending.first().is_some_and(|cells| !cells.is_empty()) {
                    write_group(&mut writer, &mut pending)?;
                }
                writer.into_inner().map_err(io::Error::other)
            }
        }
    }

    /// Copies rows from a Parquet file with these columns; the text in column `of` selects them. Returns false if it
    /// was cancelled.
    ///
    /// # Errors
    /// Fails if a file cannot be read or written.
    pub fn add_file(
        &mut self,
        file: File,
        of: usize,
        keep: impl Fn(&str) -> bool,
        mut go_on: impl FnMut() -> bool,
    ) -> io::Result<bool> {
        let reader = SerializedFileReader::new(file).map_err(io::Error::other)?;
        for k in 0..reader.num_row_groups() {
            if !go_on() {
                return Ok(false);
            }
            let rows = read_group(&*reader.get_row_group(k).map_err(io::Error::other)?);
            let mut rows = rows.map_err(io::Error::other)?;
            if let Cells::Texts(texts) = &rows[of] {
                let kept: Vec<bool> = texts.iter().map(|text| keep(text)).collect();
                rows.iter_mut().for_each(|cells| cells.retain(&kept));
            }
            self.add(rows)?;
        }
        Ok(true)
    }
}

fn fact((key, value): &(&str, String)) -> KeyValue {
    KeyValue::new((*key).to_owned(), value.clone())
}

/// Cells of a row group by column.
fn read_group(group: &dyn RowGroupReader) -> parquet::errors::Result<Vec<Cells>> {
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let mut columns = Vec::new();
    for k in 0..group.num_columns() {
        let mut known = Vec::new();
        columns.push(match group.get_column_reader(k)? {
            ColumnReader::Int64ColumnReader(mut column) => {
                let mut cells = Vec::new();
                column.read_records(rows, None, None, &mut cells)?;
                Cells::Whole(cells)
            }
            ColumnReader::DoubleColumnReader(mut column) => {
                let mut cells = Vec::new();
                column.read_records(rows, Some(&mut known), None, &mut cells)?;
                Cells::Numbers(spread(&known, cells, f64::NAN))
            }
            ColumnReader::ByteArrayColumnReader(mut column) => {
                let mut cells = Vec::new();
                column.read_records(rows, Some(&mut known), None, &mut cells)?;
                let texts = cells.iter().map(|text| text.as_utf8().map(ToOwned::to_owned));
                Cells::Texts(spread(&known, texts.collect::<Result<_, _>>()?, String::new()))
            }
            _ => return Err(parquet::errors::ParquetError::General("a column of another kind".into())),
        });
    }
    Ok(columns)
}

/// Expands cells to their positions, with `none` elsewhere.
fn spread<T: Clone>(known: &[i16], cells: Vec<T>, none: T) -> Vec<T> {
    let mut cells = cells.into_iter();
    known.iter().map(|k| if *k > 0 { cells.next() } else { None }.unwrap_or_else(|| none.clone())).collect()
}

fn schema(columns: &Kinds) -> parquet::errors::Result<TypePtr> {
    let column = |(name, cells): &(String, Cells)| {
        let (physical, repetition) = match cells {
            Cells::Whole(_) => (Physical::INT64, Repetition::REQUIRED),
            Cells::Numbers(_) => (Physical::DOUBLE, Repetition::OPTIONAL),
            Cells::Texts(_) => (Physical::BYTE_ARRAY, Repetition::OPTIONAL),
        };
        let text = matches!(cells, Cells::Texts(_)).then_some(LogicalType::String);
        let builder = Type::primitive_type_builder(name, physical).with_repetition(repetition);
        builder.with_logical_type(text).build().map(Arc::new)
    };
    let fields = columns.iter().map(column).collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?))
}

/// Writes the pending rows as a row group.
fn write_group<W: Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    pending: &mut [Cells],
) -> io::Result<()> {
    let mut write = || {
        let mut group = writer.next_row_group()?;
        for cells in pending.iter_mut() {
            let mut column = group.next_column()?.expect("the schema has a column for all of them");
            match cells {
                Cells::Whole(cells) => {
                    column.typed::<Int64Type>().write_batch(cells, None, None)?;
                    cells.clear();
                }
                Cells::Numbers(cells) => {
                    let known: Vec<i16> = cells.iter().map(|x| i16::from(x.is_finite())).collect();
                    cells.retain(|x| x.is_finite());
                    column.typed::<DoubleType>().write_batch(cells, Some(&known), None)?;
                    cells.clear();
                }
                Cells::Texts(cells) => {
                    let known: Vec<i16> = cells.iter().map(|x| i16::from(!x.is_empty())).collect();
                    let texts = cells.drain(..).filter(|x| !x.is_empty());
                    let texts: Vec<ByteArray> = texts.map(|x| x.into_bytes().into()).collect();
                    column.typed::<ByteArrayType>().write_batch(&texts, Some(&known), None)?;
                }
            }
            column.close()?;
        }
        group.close().map(drop)
    };
    let written: parquet::errors::Result<()> = write();
    written.map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::record::RowAccessor;

    const ROWS: usize = 3 * GROUP_ROWS / 2;

    fn rows(of: std::ops::Range<usize>) -> Vec<Cells> {
        vec![
            Cells::Whole(of.clone().map(|k| k as i64).collect()),
            Cells::Numbers(of.clone().map(|k| if k % 7 == 0 { f64::NAN } else { 0.5 * k as f64 }).collect()),
            Cells::Texts(of.map(|k| if k % 7 == 0 { format!("row {k}") } else { String::new() }).collect()),
        ]
    }

    fn written(format: TableFormat, at_once: usize) -> Vec<u8> {
        let names = ["design", "toe [deg]", "failed"].map(String::from);
        let mut out = Vec::new();
        let mut table =
            TableWriter::new(&mut out, format, names.into_iter().zip(rows(0..0)).collect(), &[]).unwrap();
        for first in (0..ROWS).step_by(at_once) {
            table.add(rows(first..usize::min(first + at_once, ROWS))).unwrap();
        }
        table.end().unwrap();
        out
    }

    #[test]
    fn a_table_is_the_same_however_its_rows_come() {
        for format in [TableFormat::Csv, TableFormat::Parquet] {
            let whole = written(format, ROWS);
            assert!(written(format, 512) == whole && written(format, 70_001) == whole, "{format:?}");
        }
    }

    #[test]
    fn a_reader_of_parquet_finds_all_rows() {
        let reader =
            SerializedFileReader::new(bytes::Bytes::from(written(TableFormat::Parquet, 512))).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let mut count = 0;
        for (k, row) in reader.get_row_iter(None).unwrap().enumerate() {
            let row: Vec<String> = row.unwrap().get_column_iter().map(|(n, v)| format!("{n}={v}")).collect();
            let [x, why] = if k % 7 == 0 {
                ["null".into(), format!("\"row {k}\"")]
            } else {
                [(0.5 * k as f64).to_string(), "null".into()]
            };
            let x = if x == "null" || x.contains('.') { x } else { format!("{x}.0") };
            assert_eq!(row, [format!("design={k}"), format!("toe [deg]={x}"), format!("failed={why}")]);
            count += 1;
        }
        assert_eq!(count, ROWS);
    }

    #[test]
    fn as_text_unknown_cells_are_empty() {
        let text = String::from_utf8(written(TableFormat::Csv, 9)).unwrap();
        let lines: Vec<&str> = text.lines().take(4).collect();
        assert_eq!(lines, ["design,toe [deg],failed", "0,,row 0", "1,0.5,", "2,1,"]);
    }

    #[test]
    fn rows_are_taken_out_of_a_written_table_and_facts_are_its_metadata() {
        let names = ["design", "toe [deg]", "failed"].map(String::from);
        let kinds = || names.clone().into_iter().zip(rows(0..0)).collect::<Kinds>();
        let facts = [("units", r#"{"toe [deg]":"deg"}"#.to_owned())];
        let begin = |out| TableWriter::new(out, TableFormat::Parquet, kinds(), &facts).unwrap();
        let whole = || {
            let mut table = begin(tempfile::tempfile().unwrap());
            table.add(rows(0..ROWS)).unwrap();
            table.end().unwrap()
        };
        let without = |go_on: &mut dyn FnMut() -> bool| {
            let mut table = begin(tempfile::tempfile().unwrap());
            let all = table.add_file(whole(), 2, |why| !why.starts_with("row 1"), go_on).unwrap();
            (all, SerializedFileReader::new(table.end().unwrap()).unwrap())
        };
        let (all, reader) = without(&mut || true);
        assert!(all);
        let kept = |k: &usize| !k.is_multiple_of(7) || !k.to_string().starts_with('1');
        let expected: Vec<i64> = (0..ROWS).filter(kept).map(|k| k as i64).collect();
        let found: Vec<i64> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().get_long(0).unwrap()).collect();
        assert!(found == expected && found.len() < ROWS);
        let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let metadata: Vec<_> = metadata.iter().map(|f| (f.key.as_str(), f.value.clone())).collect();
        assert_eq!(metadata, [("units", Some(facts[0].1.clone()))]);
        let mut once = true;
        assert!(!without(&mut || std::mem::take(&mut once)).0, "it can be ended between groups");
    }
}
