//! Clearances over a grid of two drivers: sentences and a table.

use hardpoint::model::{Clearance, Dimension, DriverId, Grid, Model, ShapePair};
use hardpoint_file::Units;
use hardpoint_study::grid::{GridClearances, GridMinimum, GridPair, GridPlace};

use super::{ClearanceSensitivity, DIGITS, KEPT, remedy, sensitivities, strongest};
use crate::figures::{rounded, unit, with_unit};
use crate::page::Table;
use crate::record::{Column, record};

record! {
    /// A least distance of a pair of shapes over a grid.
    GridMinimumFact::of(model: &Model, units: Units, grid: &Grid, found: &GridMinimum) {
        let length = |x: f64| units.from_si(Dimension::LENGTH, x);
    }
    /// Positions of the two drivers, in the coordinates of their laws.
    drivers: [f64; 2] = [0, 1].map(|k| driver_value(model, units, grid.drivers[k], found.drivers[k]).0);
    /// The same in words.
    position: String = position(model, units, grid, found.drivers);
    /// Distance; negative where the shapes overlap.
    distance: f64 = length(found.at.distance[0]);
    /// Place in the grid: `inside`, `edge` or `corner`.
    place: &'static str = match found.place {
        GridPlace::Inside => "inside",
        GridPlace::Edge => "edge",
        GridPlace::Corner => "corner",
    };
    /// False if it is only the lowest of the positions that were tried.
    located: bool = found.is_located;
    /// Nearest points of the shapes' cores, global.
    points: [[f64; 3]; 2] = found.at.points.map(|p| p.map(length).to_array());
    /// True if more than one pair of points is nearest, since lines or faces are parallel.
    parallel: bool = found.at.is_parallel;
    /// True if the cores meet: the distance does not say how deep the shapes are in each other, and has no derivative.
    cores_meet: bool = found.at.cores_meet;
    /// Derivatives of the distance by the design variables with both drivers fixed, the strongest first.
    sensitivities: Vec<ClearanceSensitivity> = sensitivities(model, units, Dimension::LENGTH, &found.d);
}

record! {
    /// Distance of a pair of shapes over a grid.
    GridPairFact::of(
        model: &Model, units: Units, grid: &Grid, clearance: &Clearance, pair: &ShapePair, found: &GridPair,
    ) {
        let [a, b] = model.pair_names(pair);
        let length = |x: f64| units.from_si(Dimension::LENGTH, x);
        let least = found.minima.first().map(|m| m.at);
        // Where the cores meet, the shapes are at least as deep in each other as their distance.
        let below = |min: f64| least.is_some_and(|at| at.cores_meet || !(at.distance[0] >= min - KEPT * model.size()));
    }
    /// Name of the clearance.
    clearance: String = clearance.name.clone();
    /// Names of the shapes.
    shapes: [String; 2] = [a.to_owned(), b.to_owned()];
    /// Unit of all distances.
    unit: String = unit(units, Dimension::LENGTH);
    /// Least distance; `null` if no position was reached.
    least: Option<f64> = least.map(|at| length(at.distance[0]));
    /// Distance that is required.
    min: Option<f64> = pair.min.map(length);
    /// False if the least distance is below the required one, or not known.
    kept: bool = !pair.min.is_some_and(below);
    /// True if the distance is the same at all positions.
    constant: bool = found.is_constant;
    /// Number of the grid's positions at which the shapes overlap.
    touching: usize = found.touching;
    /// All local minima, the least first.
    minima: Vec<GridMinimumFact> =
        found.minima.iter().map(|m| GridMinimumFact::of(model, units, grid, m)).collect();
}

record! {
    /// Clearances over a grid of two drivers.
    pub GridClearanceFact::of(model: &Model, units: Units, found: &GridClearances) {
        let pair_of = |clearance: &Clearance, pair: &ShapePair| {
            let found_pair = found.pairs.iter().find(|p| p.shapes == pair.shapes)?;
            Some(GridPairFact::of(model, units, &found.grid, clearance, pair, found_pair))
        };
        let mut pairs = Vec::new();
        for clearance in &model.clearances {
            pairs.extend(clearance.pairs.iter().filter_map(|pair| pair_of(clearance, pair)));
        }
    }
    /// Name of the grid.
    name: String = found.grid.name.clone();
    /// Names of the two drivers.
    drivers: [String; 2] = found.grid.drivers.map(|d| model.drivers[d.0].name.clone());
    /// Number of positions reached.
    solved: usize = found.solved;
    /// Number of positions requested.
    asked: usize = found.grid.values.iter().map(Vec::len).product();
    /// True if the user ended the search early.
    interrupted: bool = found.interrupted;
    /// All pairs of all clearances.
    pairs: Vec<GridPairFact> = pairs;
}

/// Position of a driver with its unit.
fn driver_value(model: &Model, units: Units, driver: DriverId, value: f64) -> (f64, String) {
    let dimension = Dimension::from(model.driven(&model.drivers[driver.0]).quantity);
    (units.from_si(dimension, value), unit(units, dimension))
}

/// Positions of both drivers in words.
fn position(model: &Model, units: Units, grid: &Grid, values: [f64; 2]) -> String {
    let shown = [0, 1].map(|k| {
        let (value, unit) = driver_value(model, units, grid.drivers[k], values[k]);
        format!("{} {}", model.drivers[grid.drivers[k].0].name, with_unit(value, &unit))
    });
    shown.join(", ")
}

impl GridClearanceFact {
    /// True if no pair is nearer than required.
    pub fn kept(&self) -> bool {
        self.pairs.iter().all(|pair| pair.kept)
    }

    /// The result in sentences: of each clearance its nearest pair, and all pairs that touch or are nearer than
    /// required.
    pub fn sentences(&self) -> Vec<String> {
        let least = |pair: &GridPairFact| pair.least.unwrap_or(f64::INFINITY);
        let mut lines = Vec::new();
        for of in self.pairs.chunk_by(|a, b| a.clearance == b.clearance) {
            let nearest = of.iter().min_by(|a, b| least(a).total_cmp(&least(b)));
            for pair in of {
                let is_nearest = nearest.is_some_and(|n| std::ptr::eq(n, pair));
                if is_nearest || pair.touching > 0 || !pair.kept || least(pair) < 0.0 {
                    lines.extend(pair.lines(self.asked));
                }
            }
        }
        lines
    }

    /// Table of all pairs, the nearest first within each clearance.
    pub fn table(&self) -> Option<Table> {
        let least = |pair: &GridPairFact| pair.least.unwrap_or(f64::INFINITY);
        let mut rows: Vec<&GridPairFact> = self.pairs.iter().collect();
        rows.sort_by(|a, b| a.clearance.cmp(&b.clearance).then(least(a).total_cmp(&least(b))));
        let shown = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let columns: [Column<'_, &GridPairFact>; 6] = [
            ("clearance", &|f| f.clearance.clone()),
            ("shapes", &|f| format!("{} - {}", f.shapes[0], f.shapes[1])),
            ("least", &|f| shown(f.least, &f.unit)),
            ("at", &|f| match f.minima.first() {
                Some(_) if f.constant => "everywhere".into(),
                Some(m) => m.position.clone(),
                None => "-".into(),
            }),
            ("required", &|f| shown(f.min, &f.unit)),
            ("kept", &|f| {
                if f.min.is_none() { "-".into() } else { (if f.kept { "yes" } else { "NO" }).into() }
            }),
        ];
        let [first, second] = &self.drivers;
        let title = format!("Clearances of map `{}` over {first} and {second}", self.name);
        let ended = if self.interrupted { ", interrupted" } else { "" };
        let note = format!(
            "{} of {} positions reached{ended}. Least distances located between the positions; not proved.",
            self.solved, self.asked
        );
        Table::of(title, note, &columns, rows).if_any()
    }
}

impl GridPairFact {
    fn lines(&self, asked: usize) -> Vec<String> {
        let Self { clearance, shapes: [a, b], unit, .. } = self;
        let Some(lowest) = self.minima.first() else {
            return vec![format!("{clearance}: no position was reached")];
        };
        let at = if self.constant { "everywhere".into() } else { format!("at {}", lowest.position) };
        if lowest.distance.is_nan() {
            return vec![format!("{clearance}: the distance of {a} and {b} is not known {at}")];
        }
        let mut lines = Vec::new();
        if lowest.distance < 0.0 {
            let depth = if lowest.cores_meet {
                "their cores meet".into()
            } else {
                format!("{} {unit} deep", rounded(-lowest.distance, DIGITS))
            };
            let count = self.touching;
            lines.push(format!("{clearance}: {a} touches {b} at {count} of {asked} positions; {depth} {at}"));
        } else {
            let distance = rounded(lowest.distance, DIGITS);
            lines.push(format!("{clearance}: {distance} {unit} at least, {a} against {b}, {at}"));
        }
        if !lowest.located {
            lines.push("  the lowest position that was tried; the least value was not located".into());
        }
        let by = strongest(&lowest.sensitivities);
        if !by.is_empty() && !lowest.cores_meet {
            lines.push(format!("  the distance changes by {by}"));
        }
        if let Some(min) = self.min.filter(|_| !self.kept) {
            lines.push(remedy(min, lowest.distance, &lowest.sensitivities, lowest.cores_meet, unit));
        }
        lines
    }
}
