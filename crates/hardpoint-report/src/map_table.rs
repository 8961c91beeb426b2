//! Tables over drivers with a proved error: sentences, and the files of `hardpoint map`.

use std::collections::HashSet;
use std::io::{self, Write};

use hardpoint::model::{Dimension, Model};
use hardpoint::motion::BoxFailure;
use hardpoint::number::Exponents;
use hardpoint_file::Units;
use hardpoint_study::map::{MapError, MapTable, ProofError, Request};
use hardpoint_table::csv::CsvWriter;
use serde::Serialize;

use crate::figures::{count, per, rounded, unit};
use crate::record::record;

/// Digits of errors in sentences.
const DIGITS: usize = 3;
/// Digits of drivers' values in sentences.
const PLACE_DIGITS: usize = 6;

/// Driver of a table.
#[derive(Clone, Debug, Serialize)]
pub struct MapAxisFact {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Knots, ascending, in the coordinate of its laws.
    pub knots: Vec<f64>,
}

/// Numbers of one derivative at all positions.
#[derive(Clone, Debug, Serialize)]
pub struct MapNumbers {
    /// Names of the drivers by which it is derived; none for the value.
    pub by: Vec<String>,
    /// Unit.
    pub unit: String,
    /// Numbers, position by position; the last driver varies fastest.
    pub values: Vec<f64>,
}

/// Output of a table.
#[derive(Clone, Debug, Serialize)]
pub struct MapColumnFact {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Permitted error of the interpolation.
    pub permitted_error: f64,
    /// Proved bound of the error of the interpolation, everywhere in the ranges.
    pub proved_error: f64,
    /// The value, and for cubic Hermite interpolation the mixed first derivatives.
    pub numbers: Vec<MapNumbers>,
}

record! {
    /// A table over drivers, in the units of a model file or in SI.
    pub MapTableFact::of(model: &Model, units: Units, request: &Request, table: &MapTable) {
        let quantity = |n: usize| model.driven(&model.drivers[table.drivers[n].0]).quantity;
        let by = |order: &Exponents| (0..table.drivers.len()).filter(|n| order[*n] == 1).collect::<Vec<usize>>();
        let driver_name = |n: usize| model.drivers[table.drivers[n].0].name.clone();
        let numbers = |column: usize, o: usize, order: &Exponents, dimension: Dimension| {
            let count = table.orders().len();
            let by = by(order);
            // d^2 f / dx dy in units of f per unit of x per unit of y
            let factor = by.iter().fold(units.per_si(dimension), |factor, n| factor / units.per_si(quantity(*n)));
            MapNumbers {
                by: by.iter().map(|n| driver_name(*n)).collect(),
                unit: by.iter().fold(unit(units, dimension), |of, n| per(&of, &unit(units, quantity(*n)))),
                values: table.columns[column].numbers.iter().skip(o).step_by(count).map(|x| x * factor).collect(),
            }
        };
    }
    /// Name of the model.
    model: String = model.name.clone();
    /// Interpolation for which the error is proved: `hermite` or `linear`.
    interpolation: &'static str = table.interpolation.name();
    /// True: the errors are proved in interval arithmetic, not sampled.
    proved: bool = true;
    /// Number of positions.
    positions: usize = table.positions();
    /// Number of cells between the positions.
    cells: usize = table.cells();
    /// Number of boxes of the drivers' ranges of which bounds were computed.
    boxes: usize = table.boxes;
    /// Drivers.
    drivers: Vec<MapAxisFact> = table.knots.iter().enumerate().map(|(n, knots)| MapAxisFact {
        name: driver_name(n),
        unit: unit(units, quantity(n)),
        // The ends are the numbers of the request: a table must have values there.
        knots: knots.iter().map(|x| units.shortest_from_si(quantity(n), *x)).collect(),
    }).collect();
    /// Outputs.
    outputs: Vec<MapColumnFact> = request.outputs.iter().zip(&table.columns).enumerate().map(|(c, (asked, column))| {
        let dimension = asked.dimension;
        let orders = table.orders();
        MapColumnFact {
            name: asked.name.clone(),
            unit: unit(units, dimension),
            permitted_error: units.from_si(dimension, asked.error),
            // A bound is rounded upwards.
            proved_error: units.from_si(dimension, column.proved).next_up(),
            numbers: orders.iter().enumerate().map(|(o, order)| numbers(c, o, order, dimension)).collect(),
        }
    }).collect();
}

impl MapTableFact {
    /// The result in sentences.
    pub fn sentences(&self) -> Vec<String> {
        let axis = |axis: &MapAxisFact| {
            let MapAxisFact { name, unit, knots } = axis;
            let [from, to] =
                [knots.first(), knots.last()].map(|x| rounded(x.copied().unwrap_or(f64::NAN), PLACE_DIGITS));
            format!("  {name} from {from} to {to} {unit}: {}", count(knots.len(), "knot"))
        };
        let mut lines = vec![format!(
            "{} in {}, {} interpolation",
            count(self.positions, "position"),
            count(self.cells, "cell"),
            self.interpolation
        )];
        lines.extend(self.drivers.iter().map(axis));
        lines.extend(self.outputs.iter().map(|output| {
            let error = |x: f64| rounded(x, DIGITS);
            let unit = if output.unit == "1" { String::new() } else { format!(" {}", output.unit) };
            format!(
                "  {}: error at most {}{unit} everywhere, proved ({} permitted)",
                output.name,
                error(output.proved_error),
                error(output.permitted_error)
            )
        }));
        lines
    }

    /// Knots of position k.
    fn place(&self, position: usize) -> Vec<f64> {
        let mut rest = position;
        let mut place: Vec<f64> = self
            .drivers
            .iter()
            .rev()
            .map(|axis| {
                let x = axis.knots[rest % axis.knots.len()];
                rest /= axis.knots.len();
                x
            })
            .collect();
        place.reverse();
        place
    }

    /// Writes a row for each position: the drivers, then each output with its derivatives.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let mut csv = CsvWriter::new(out);
        let drivers = self.drivers.iter().map(|axis| format!("{} [{}]", axis.name, axis.unit));
        let name = |output: &MapColumnFact, numbers: &MapNumbers| {
            let by: String = numbers.by.iter().map(|by| format!(" by {by}")).collect();
            format!("{}{by} [{}]", output.name, numbers.unit)
        };
        let outputs = self.outputs.iter().flat_map(|o| o.numbers.iter().map(move |n| name(o, n)));
        csv.row(drivers.chain(outputs))?;
        for position in 0..self.positions {
            let of = self.outputs.iter().flat_map(|o| o.numbers.iter().map(|n| n.values[position]));
            csv.numbers(self.place(position).into_iter().chain(of))?;
            csv.end_row()?;
        }
        csv.end().map(|_| ())
    }

    /// Writes tables for `CombiTable1Ds` or `CombiTable2Ds` of the Modelica Standard Library, in these units: one table
    /// `map` with a column for each output over one driver, or a table for each output over two. The name of a table is
    /// that of its output with `_` for characters other than ASCII letters and digits; `_2`, `_3` and so on follow
    /// names that would be equal.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn write_modelica(&self, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "#1")?;
        writeln!(out, "# {}", self.title())?;
        writeln!(out, "# smoothness = LinearSegments; extrapolation = NoExtrapolation")?;
        for axis in &self.drivers {
            writeln!(out, "# {} in {}", comment(&axis.name), axis.unit)?;
        }
        let names = self.table_names();
        for (output, table) in self.outputs.iter().zip(&names) {
            let renamed = match self.drivers.len() > 1 && *table != output.name {
                true => format!(", table {table}"),
                false => String::new(),
            };
            writeln!(
                out,
                "# {} in {}, error at most {:e} (proved){renamed}",
                comment(&output.name),
                output.unit,
                output.proved_error
            )?;
        }
        let row = |out: &mut dyn Write, numbers: &mut dyn Iterator<Item = f64>| {
            let texts: Vec<String> = numbers.map(|x| format!("{x:?}")).collect();
            writeln!(out, "{}", texts.join(" "))
        };
        match &self.drivers[..] {
            [u] => {
                writeln!(out, "double map({},{})", u.knots.len(), 1 + self.outputs.len())?;
                for (k, u) in u.knots.iter().enumerate() {
                    row(
                        &mut out,
                        &mut [*u].into_iter().chain(self.outputs.iter().map(|o| o.numbers[0].values[k])),
                    )?;
                }
            }
            [u, v, ..] => {
                for (output, name) in self.outputs.iter().zip(&names) {
                    writeln!(out, "double {name}({},{})", 1 + u.knots.len(), 1 + v.knots.len())?;
                    row(&mut out, &mut [0.0].into_iter().chain(v.knots.iter().copied()))?;
                    for (i, u) in u.knots.iter().enumerate() {
                        let values = &output.numbers[0].values[i * v.knots.len()..(i + 1) * v.knots.len()];
                        row(&mut out, &mut [*u].into_iter().chain(values.iter().copied()))?;
                    }
                }
            }
            [] => {}
        }
        Ok(())
    }

    /// Writes a `SPLINE` statement of Adams Solver for each output, in these units: a curve over one driver, x, or a
    /// family of curves over two, x and z. The identifiers are 1, 2 and so on, in the order of the outputs.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn write_adams(&self, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "! {}", self.title())?;
        for (axis, name) in self.drivers.iter().zip(["x", "z"]) {
            writeln!(out, "! {name}: {} in {}", comment(&axis.name), axis.unit)?;
        }
        writeln!(out, "! errors are proved for linear interpolation")?;
        for (k, output) in self.outputs.iter().enumerate() {
            let (id, values) = (k + 1, &output.numbers[0].values);
            let (name, unit, error) = (comment(&output.name), &output.unit, output.proved_error);
            writeln!(out, "! {id}: {name} in {unit}, error at most {error:e}\nSPLINE/{id}")?;
            match &self.drivers[..] {
                [x] => {
                    write_list(&mut out, "X", x.knots.iter().copied())?;
                    write_list(&mut out, "Y", values.iter().copied())?;
                }
                [x, z, ..] => {
                    write_list(&mut out, "X", x.knots.iter().copied())?;
                    for (j, z_j) in z.knots.iter().enumerate() {
                        let curve = values.iter().skip(j).step_by(z.knots.len()).copied();
                        write_list(&mut out, "Y", [*z_j].into_iter().chain(curve))?;
                    }
                }
                [] => {}
            }
        }
        Ok(())
    }

    /// Name of the model, with those of the drivers.
    fn title(&self) -> String {
        let drivers: Vec<&str> = self.drivers.iter().map(|axis| axis.name.as_str()).collect();
        comment(&format!("{} over {}", self.model, drivers.join(", ")))
    }

    /// Names of the outputs' tables for Modelica, in which names have no dots; no two are the same.
    fn table_names(&self) -> Vec<String> {
        let plain = |name: &str| name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        // Outputs with such a name have it unchanged.
        let names = self.outputs.iter().map(|output| &output.name);
        let mut taken: HashSet<String> = names.filter(|name| plain(name) == **name).cloned().collect();
        let one = |output: &MapColumnFact| {
            let plain = plain(&output.name);
            let mut table = plain.clone();
            let mut count = 1;
            while plain != output.name && !taken.insert(table.clone()) {
                count += 1;
                table = format!("{plain}_{count}");
            }
            table
        };
        self.outputs.iter().map(one).collect()
    }
}

/// Text in one line.
fn comment(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// Writes an argument of an Adams statement, with continuation lines of at most 80 columns, which begin with commas.
fn write_list(out: &mut impl Write, name: &str, numbers: impl Iterator<Item = f64>) -> io::Result<()> {
    const COLUMNS: usize = 80;
    let mut line = format!(", {name}=");
    for (k, x) in numbers.enumerate() {
        // A number has a decimal point, also before its exponent.
        let text = format!("{x:?}");
        let text = if text.contains('.') { text } else { text.replace('e', ".0e") };
        let separator = if k == 0 { "" } else { ", " };
        if line.len() + separator.len() + text.len() > COLUMNS {
            writeln!(out, "{line}")?;
            line = format!(", {text}");
        } else {
            line += &format!("{separator}{text}");
        }
    }
    writeln!(out, "{line}")
}

/// Description of the reason why there is no table, and an instruction; `None` if the mechanism cannot be driven, or
/// the caller ended the study.
pub fn reason(model: &Model, units: Units, request: &Request, error: &MapError) -> Option<(String, String)> {
    let quantity = |n: usize| model.driven(&model.drivers[request.axes[n].driver.0]).quantity;
    let name = |n: usize| &model.drivers[request.axes[n].driver.0].name;
    let value = |n: usize, x: f64| {
        format!("{} {}", rounded(units.from_si(quantity(n), x), PLACE_DIGITS), unit(units, quantity(n)))
    };
    let place = |x: &[f64]| {
        let all: Vec<String> =
            x.iter().enumerate().map(|(n, x)| format!("{} = {}", name(n), value(n, *x))).collect();
        all.join(", ")
    };
    let smaller = "give smaller ranges with `--over`";
    Some(match error {
        MapError::Topology(_) | MapError::Interrupted => return None,
        MapError::Equilibrium => (
            "elastic joints open as the forces require, not by the drivers alone".to_owned(),
            "remove `[equilibrium]` for a map of the rigid mechanism".to_owned(),
        ),
        MapError::Start(stop) => (
            format!("the design configuration is not solved: {}", stop.happened(model)),
            "`hardpoint check` shows the reason".to_owned(),
        ),
        MapError::NotReached { drivers, last, stop } => (
            format!("{} is not reached: {} at {}", place(drivers), stop.happened(model), place(last)),
            format!("{smaller} that end before"),
        ),
        MapError::NotProved { part, reason } => {
            let ends = |(n, [from, to]): (usize, &[f64; 2])| {
                format!("{} from {} to {}", name(n), value(n, *from), value(n, *to))
            };
            let part: Vec<String> = part.iter().enumerate().map(ends).collect();
            let why = match reason {
                ProofError::Output(k) => {
                    format!(
                        "`{}` is undefined, jumps by a turn or has a kink there",
                        request.outputs[*k].name
                    )
                }
                ProofError::Motion(failure) => motion(model, failure),
            };
            (format!("no error is proved for {}: {why}", part.join(", ")), smaller.to_owned())
        }
        MapError::TooLarge { positions, proved } => {
            let errors: Vec<String> = request
                .outputs
                .iter()
                .zip(proved)
                .map(|(output, proved)| {
                    let in_units = rounded(units.from_si(output.dimension, *proved), DIGITS);
                    format!("{} {in_units} {}", output.name, unit(units, output.dimension))
                })
                .collect();
            (
                format!(
                    "the table would have more than {positions} positions, where the errors are {}",
                    errors.join(", ")
                ),
                "permit greater errors, give smaller ranges, or interpolate with `--interpolation hermite`"
                    .to_owned(),
            )
        }
    })
}

fn motion(model: &Model, failure: &BoxFailure) -> String {
    match failure {
        BoxFailure::FollowsCurve { joint } => {
            let name = model.joints.get(joint.0).map_or("", |j| j.name.as_str());
            format!("joint `{name}` follows a curve, of which there are no bounds")
        }
        BoxFailure::TooLarge { .. } => "a loop has too many unknowns".into(),
        BoxFailure::NoContraction { .. } => "a singular position is near".into(),
        BoxFailure::NotReached(stop) => stop.happened(model),
        BoxFailure::OtherBranch => "another position of the mechanism is near".into(),
    }
}
