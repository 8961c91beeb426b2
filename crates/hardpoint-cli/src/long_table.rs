//! Long tables, written as they come: as CSV, or as Parquet.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

use hardpoint_report::GENERATOR;
use hardpoint_report::cells::Cells;

/// A row group of Parquet has at least so many rows, so that the table need not fit into memory.
const GROUP_ROWS: usize = 1 << 16;

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Text, one row a line.
    Csv,
    /// Apache Parquet, not compressed: numbers hardly give way.
    Parquet,
}

impl TableFormat {
    /// How the names of its files end.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }
}

/// A table under way. What is written depends on the rows alone, and not on how many came at once.
pub struct TableWriter<W: Write + Send> {
    sink: Sink<W>,
}

enum Sink<W: Write + Send> {
    Csv(Box<csv::Writer<W>>),
    Parquet(Box<SerializedFileWriter<W>>, Vec<Cells>),
}

impl<W: Write + Send> TableWriter<W> {
    /// Begins a table with these columns; the cells only say of which kind they are.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn new(out: W, format: TableFormat, columns: Vec<(String, Cells)>) -> io::Result<Self> {
        let sink = match format {
            TableFormat::Csv => {
                let mut csv = csv::Writer::from_writer(out);
                csv.write_record(columns.iter().map(|(name, _)| name))?;
                Sink::Csv(Box::new(csv))
            }
            TableFormat::Parquet => {
                let properties = WriterProperties::builder()
                    .set_created_by(GENERATOR.into())
                    .set_compression(Compression::UNCOMPRESSED)
                    .set_dictionary_enabled(false);
                let schema = schema(&columns).map_err(io::Error::other)?;
                let writer = SerializedFileWriter::new(out, schema, Arc::new(properties.build()));
                let cells = columns.into_iter().map(|(_, cells)| cells).collect();
                Sink::Parquet(Box::new(writer.map_err(io::Error::other)?), cells)
            }
        };
        Ok(Self { sink })
    }

    /// Adds rows: of every column as many cells.
    ///
    /// # Errors
    /// Where they cannot be written.
    pub fn add(&mut self, rows: Vec<Cells>) -> io::Result<()> {
        match &mut self.sink {
            Sink::Csv(csv) => {
                for row in 0..rows.first().map_or(0, Cells::len) {
                    csv.write_record(rows.iter().map(|cells| cells.text(row)))?;
                }
                Ok(())
            }
            Sink::Parquet(writer, pending) => {
                // Groups end where they are full, wherever the rows came from.
                let mut rest = rows;
                loop {
                    let room = GROUP_ROWS - pending.first().map_or(0, Cells::len);
                    let later: Vec<Cells> = rest.iter_mut().map(|cells| cells.split_off(room)).collect();
                    pending.iter_mut().zip(rest).for_each(|(cells, more)| cells.append(more));
                    if pending.first().map_or(0, Cells::len) < GROUP_ROWS {
                        return Ok(());
                    }
                    write_group(writer, pending)?;
                    rest = later;
                }
            }
        }
    }

    /// Ends the table.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn end(self) -> io::Result<()> {
        match self.sink {
            Sink::Csv(mut csv) => csv.flush(),
            Sink::Parquet(mut writer, mut pending) => {
                if pending.first().is_some_and(|cells| !cells.is_empty()) {
                    write_group(&mut writer, &mut pending)?;
                }
                writer.close().map(drop).map_err(io::Error::other)
            }
        }
    }
}

fn schema(columns: &[(String, Cells)]) -> parquet::errors::Result<TypePtr> {
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

/// Writes what is pending as a row group; nothing is pending then.
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
    use parquet::file::reader::{FileReader, SerializedFileReader};

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
            TableWriter::new(&mut out, format, names.into_iter().zip(rows(0..0)).collect()).unwrap();
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
    fn a_reader_of_parquet_finds_what_was_written() {
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
}
