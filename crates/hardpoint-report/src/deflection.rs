//! Deflections of elastic joints and bushings: the largest of each direction in `deflections.csv` and on the page; and
//! curves of forces that a motion leaves.

use std::io::Write;

use hardpoint::Analysis;
use hardpoint::draft::Section;
use hardpoint::load::{CurveRange, Loads};
use hardpoint::model::{Dimension, ElementId, Model};
use hardpoint_file::{Diagnostic, ModelFile, Severity, Units};
use hardpoint_table::csv::CsvWriter;

use crate::figures::{number, rounded, symbol, unit, with_unit};
use crate::metric::{MetricSensitivity, derivative_cells, derivative_headings};
use crate::page::Table;
use crate::record::{Column, record};

/// Names of the six directions.
const DIRECTIONS: [&str; 6] = ["along x", "along y", "along z", "about x", "about y", "about z"];

record! {
    /// Largest deflection of an element in one direction over the motion.
    DeflectionFact::of(model: &Model, units: Units, loads: &Loads, i: usize, at: (ElementId, usize)) {
        let (element, direction) = at;
        let [dimension, force_dimension] = dimensions(direction);
        let largest = loads.largest_deflections.get(i).and_then(Option::as_ref);
        let derivatives = largest.into_iter().flat_map(|largest| model.variables.iter().zip(&largest.d));
        let derivatives = derivatives.filter(|(_, d)| d.is_finite());
    }
    /// Name of the elastic joint or bushing.
    element: String = model.elements[element.0].name.clone();
    /// Direction: along or about an axis of the joint, or of the bushing.
    direction: &'static str = DIRECTIONS[direction];
    /// Largest deflection with its sign: of the second body relative to the first.
    deflection: Option<f64> = largest.map(|largest| units.from_si(dimension, largest.deflection.displacement));
    /// Unit of the deflection.
    unit: String = unit(units, dimension);
    /// Elastic force or moment on the second body at that time.
    force: Option<f64> = largest.map(|largest| units.from_si(force_dimension, largest.deflection.force));
    /// Unit of the force.
    force_unit: String = unit(units, force_dimension);
    /// Time of the largest deflection, s.
    time: Option<f64> = largest.map(|largest| loads.times[largest.step]);
    /// Sensitivities of the deflection at that time to every design variable that the mechanism can follow, if they
    /// were solved.
    sensitivities: Vec<MetricSensitivity> =
        derivatives.map(|(by, d)| MetricSensitivity::of(model, units, dimension, by, *d)).collect();
}

/// Dimensions of the deflection in a direction, and of the force against it.
fn dimensions(direction: usize) -> [Dimension; 2] {
    if direction < 3 { [Dimension::LENGTH, Dimension::FORCE] } else { [Dimension::ANGLE, Dimension::MOMENT] }
}

/// Name of a deflection as a curve, such as `lca_rear along z`, and its dimension.
pub(crate) fn curve_name(model: &Model, (element, direction): (ElementId, usize)) -> (String, Dimension) {
    let [dimension, _] = dimensions(direction);
    (format!("{} {}", model.elements[element.0].name, DIRECTIONS[direction]), dimension)
}

/// Digits of the time at which a deflection is largest.
const DIGITS: usize = 7;

/// HP0414: warnings about curves that end before the largest deflection of the motion. Those that end with two points
/// of the same force continue as they are meant.
pub(crate) fn ends_of_curves(file: &ModelFile) -> Vec<Diagnostic> {
    let (model, units) = (&file.model, file.units);
    let curves = model.force_curves();
    if curves.is_empty() {
        return Vec::new();
    }
    let Ok(analysis) = Analysis::new(model) else { return Vec::new() };
    let masses = model.elements.iter().filter(|e| e.kind.has_mass()).count();
    let mut list = Vec::new();
    for (curve, range) in curves.iter().zip(analysis.curve_ranges()) {
        let Some(CurveRange { deflections, steps }) = range else { continue };
        let quantity = curve.quantity(model);
        let shown = |deflection: f64| {
            with_unit(units.from_si(quantity, curve.as_written(deflection)), symbol(units, quantity))
        };
        for k in [0, 1] {
            let (end, is_constant) = curve.table.end(k == 1);
            let is_beyond = if k == 1 { deflections[k] > end } else { deflections[k] < end };
            if !is_beyond || is_constant {
                continue;
            }
            let (name, end) = (&model.elements[curve.element.0].name, shown(end));
            let (largest, time) = (shown(deflections[k]), rounded(model.times[steps[k]], DIGITS));
            let message = format!(
                "`{}` of `{name}` ends at {end}, and its deflection is {largest} at t = {time} s",
                curve.key
            );
            let place = Some((Section::Forces, curve.element.0 - masses));
            list.push(
                file.diagnostic(Severity::Warning, "HP0414", message, place)
                    .note("beyond its end a curve continues as a straight line with its slope there")
                    .help("extend the curve as far as the motion goes, or reduce the load or the travel"),
            );
        }
    }
    list
}

impl DeflectionFact {
    /// Largest deflections of a motion: of each element the directions in which it deflects.
    pub fn all(model: &Model, units: Units, loads: &Loads) -> Vec<Self> {
        let directions = model.elastic_directions();
        let of = |(i, at)| Self::of(model, units, loads, i, at);
        directions.into_iter().enumerate().map(of).collect()
    }

    /// Table of the deflections.
    pub fn table(facts: &[Self]) -> Option<Table> {
        let shown = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let columns: [Column<'_, &Self>; 5] = [
            ("element", &|d| d.element.clone()),
            ("direction", &|d| d.direction.to_owned()),
            ("largest deflection", &|d| shown(d.deflection, &d.unit)),
            ("force or moment there", &|d| shown(d.force, &d.force_unit)),
            ("at t", &|d| d.time.map_or("-".into(), |t| format!("{} s", number(t)))),
        ];
        let note =
            "Of the second body relative to the first, along and about the axes of the joint or bushing.";
        Table::of("Deflections", note, &columns, facts).if_any()
    }

    /// Writes `deflections.csv`: a row for each element and direction, with the derivative by every variable per unit
    /// of it.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write(facts: &[Self], model: &Model, units: Units, out: impl Write) -> csv::Result<()> {
        let mut csv = CsvWriter::new(out);
        let names = ["element", "direction", "deflection", "deflection unit", "force", "force unit", "t [s]"];
        csv.row(names.map(String::from).into_iter().chain(derivative_headings(model, units)))?;
        let shown = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        for d in facts {
            let (deflection, force, time) = (shown(d.deflection), shown(d.force), shown(d.time));
            let facts = [d.element.as_str(), d.direction, &deflection, &d.unit, &force, &d.force_unit, &time];
            csv.row(facts.map(String::from).into_iter().chain(derivative_cells(model, &d.sensitivities)))?;
        }
        csv.end()?;
        Ok(())
    }
}
