//! Refinement of a table until the error of every cell is proved.
//!
//! The derivatives that bound the error of a cell are bounded over boxes that tile it, or tile a larger box around it.
//! The boxes are halved if the bounds are much larger than the derivatives at some points, the cell if the derivatives
//! themselves are too large.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use hardpoint::model::{DriverId, Model};
use hardpoint::motion::BoxFailure;
use hardpoint::number::{Exponents, Interval, Real, Taylor};
use hardpoint::run::{Analysis, BoundsOfOutputs, DriverMap};
use hardpoint::topology::Formulation;

use super::{MOST_VALUES, MapColumn, MapError, MapTable, ProofError, Request};

/// Bounds within this factor of the derivatives at points are not improved by smaller boxes.
const SHARP: f64 = 1.5;
/// Number of times that the boxes of a cell are halved to sharpen bounds, by the number of drivers: a box of three
/// drivers has the cost of some hundred boxes of one.
const MOST_HALVINGS: [usize; 3] = [3, 4, 2];
/// Number of entries for all numbers of halvings.
const MOST_LEVELS: usize = 5;
/// Number of times that a range is halved before nothing is proved in a part of it.
const MOST_PARTS: i32 = 14;
/// Error of a conversion of units and of the drivers' values, in units of the value.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Part of the drivers' ranges, relative to the design configuration.
type Part = Vec<[f64; 2]>;
/// Values of drivers, bit by bit.
type Key = Vec<u64>;
/// Magnitudes of derivatives over a box, per output and order, or the reason why there are none.
type BoxResult = Result<Rc<Vec<Vec<f64>>>, ProofError>;

/// Largest magnitudes of derivatives over a part of the ranges.
struct Magnitudes {
    /// Per output and order of [`Search::asked`].
    of: Vec<Vec<f64>>,
    /// Boxes over which they are proved; they tile the part.
    boxes: Vec<Part>,
}

/// Numbers of the table at a knot.
struct Node {
    /// Per output and order of the table: value and largest error.
    numbers: Vec<Vec<[f64; 2]>>,
}

/// Cell of the table.
#[derive(Clone, Default)]
struct Cell {
    /// Bounds over the cell, or around it.
    known: Option<Rc<Magnitudes>>,
    /// True if they are near to the derivatives.
    is_sharp: bool,
    /// Proved bound per output, once it is permitted.
    proved: Option<Rc<Vec<f64>>>,
}

/// Bound of the error of a cell.
struct CellError {
    /// Per output, in SI.
    of: Vec<f64>,
    /// Largest error in units of the permitted one.
    ratio: f64,
    /// Driver that contributes most to it.
    along: usize,
}

/// Builds a table. `more` is called regularly, with the number of proved cells and that of all cells of the present
/// grid; if it returns false, the study ends.
///
/// # Errors
/// A [`MapError`].
pub fn solve(
    model: &Model,
    formulation: Formulation,
    request: &Request,
    more: &mut dyn FnMut(usize, usize) -> bool,
) -> Result<MapTable, MapError> {
    let analysis = Analysis::with(model, formulation).map_err(MapError::Topology)?;
    let drivers: Vec<DriverId> = request.axes.iter().map(|axis| axis.driver).collect();
    let outputs = request.outputs.iter().map(|o| o.output).collect();
    let map = analysis.driver_map(&[], &drivers, outputs).ok_or(MapError::Equilibrium)?;
    let design: Vec<f64> = drivers.iter().map(|d| model.as_drawn(*d)).collect();
    let ranges: Part =
        request.axes.iter().zip(&design).map(|(a, design)| a.range.map(|x| x - design)).collect();
    let remainders = request.interpolation.remainders(drivers.len());
    let slopes = (0..drivers.len()).map(|n| [0, 1, 2].map(|k| u8::from(k == n)));
    let asked = remainders.iter().map(|(_, order)| *order).chain(slopes).chain([[0; 3]]).collect();
    let mut search = Search {
        map: map.map_err(MapError::Start)?,
        request,
        orders: request.interpolation.orders(drivers.len()),
        remainders,
        asked,
        design,
        ranges,
        boxes: HashMap::new(),
        nodes: HashMap::new(),
        excess: [0.0; MOST_LEVELS],
        proved: [0, 1],
        more,
    };
    search.reach_corners()?;
    let (knots, cells) = search.refine()?;
    search.connect(&knots, &cells)?;
    search.table(drivers, knots, &cells)
}

struct Search<'a> {
    map: DriverMap<'a>,
    request: &'a Request,
    /// Orders of the numbers at a knot.
    orders: Vec<Exponents>,
    /// Orders of the remainders, with their drivers.
    remainders: Vec<(usize, Exponents)>,
    /// Orders of the derivatives that are bounded: the remainders, the first derivative by each driver, and the value,
    /// which jumps where an angle is a half turn although its derivatives do not.
    asked: Vec<Exponents>,
    /// Drivers' values in the design configuration.
    design: Vec<f64>,
    /// Ranges relative to it.
    ranges: Part,
    boxes: HashMap<Key, BoxResult>,
    nodes: HashMap<Key, Rc<Node>>,
    /// Per number of halvings of a cell: the last error of a cell of this grid in units of that from the derivatives at
    /// its points, to begin with the boxes that will do; 0 if it is not known.
    excess: [f64; MOST_LEVELS],
    /// Number of proved cells, and of all.
    proved: [usize; 2],
    more: &'a mut dyn FnMut(usize, usize) -> bool,
}

impl Search<'_> {
    /// Checks that all corners of the ranges are reached, for a precise message.
    fn reach_corners(&mut self) -> Result<(), MapError> {
        for corner in corners(&self.ranges) {
            self.node(&corner)?;
        }
        Ok(())
    }

    /// Halves intervals until the error of every cell is permitted.
    fn refine(&mut self) -> Result<(Vec<Vec<f64>>, Vec<Cell>), MapError> {
        let count = self.request.intervals;
        let even = |[from, to]: &[f64; 2]| {
            let inside = (1..count).map(|k| from + (to - from) * (k as f64 / count as f64));
            [*from].into_iter().chain(inside).chain([*to]).collect()
        };
        let mut knots: Vec<Vec<f64>> = self.ranges.iter().map(even).collect();
        let mut cells = vec![Cell::default(); knots.iter().map(|knots| knots.len() - 1).product()];
        loop {
            let mut halved: HashSet<(usize, usize)> = HashSet::new();
            self.excess = [0.0; MOST_LEVELS];
            self.proved = [cells.iter().filter(|cell| cell.proved.is_some()).count(), cells.len()];
            for (c, cell) in cells.iter_mut().enumerate().filter(|(_, cell)| cell.proved.is_none()) {
                let places = places(&knots, c);
                // Halved already on account of another cell: the halves may do.
                if places.iter().enumerate().any(|(n, k)| halved.contains(&(n, *k))) {
                    continue;
                }
                let part: Part = places.iter().zip(&knots).map(|(k, x)| [x[*k], x[*k + 1]]).collect();
                if let Some(along) = self.judge(cell, &part)? {
                    halved.insert((along, places[along]));
                }
            }
            if halved.is_empty() {
                return Ok((knots, cells));
            }
            (knots, cells) = halve(&knots, &cells, &halved);
            let positions: usize = knots.iter().map(Vec::len).product();
            if positions * self.orders.len() * self.request.outputs.len() > MOST_VALUES {
                let mut proved = vec![0.0_f64; self.request.outputs.len()];
                for (c, cell) in cells.iter().enumerate() {
                    let widths: Vec<f64> =
                        places(&knots, c).iter().zip(&knots).map(|(k, x)| x[*k + 1] - x[*k]).collect();
                    let found = match (&cell.proved, &cell.known) {
                        (Some(proved), _) => proved.to_vec(),
                        (None, Some(known)) => self.error(&known.of, &widths).of,
                        (None, None) => vec![f64::INFINITY; proved.len()],
                    };
                    proved.iter_mut().zip(found).for_each(|(most, x)| *most = most.max(x));
                }
                return Err(MapError::TooLarge { positions, proved });
            }
        }
    }

    /// Proves the error of a cell, or returns the driver along which it is to be halved.
    fn judge(&mut self, cell: &mut Cell, part: &Part) -> Result<Option<usize>, MapError> {
        let widths: Vec<f64> = part.iter().map(|[from, to]| to - from).collect();
        if let Some(known) = cell.known.clone() {
            let error = self.error(&known.of, &widths);
            if self.accept(cell, &known, &error, part, &widths)? {
                return Ok(None);
            }
            if cell.is_sharp {
                return Ok(Some(error.along));
            }
        }
        let (at_points, along) = {
            let mut most = vec![vec![0.0_f64; self.asked.len()]; self.request.outputs.len()];
            let middle = part.iter().map(|[from, to]| 0.5 * (from + to)).collect();
            for point in corners(part).chain([middle]) {
                let found =
                    self.map.at(&point).map_err(|failure| self.failed(part, ProofError::Motion(failure)))?;
                let found = self.magnitudes_of(&found);
                join(&mut most, &found);
            }
            let error = self.error(&most, &widths);
            (error.ratio, error.along)
        };
        let most = MOST_HALVINGS[part.len() - 1];
        // No boxes would do, as in other cells of this grid.
        if at_points <= 1.0 && at_points * self.excess[most] > SHARP {
            return Ok(Some(along));
        }
        // Larger boxes have failed in cells like this one.
        let mut halvings = match at_points <= 1.0 {
            true => (0..most).find(|h| !(at_points * self.excess[*h] > 1.0)).unwrap_or(most),
            false => 0,
        };
        loop {
            let mut boxes = Vec::new();
            let of = self.over(part, halvings, &mut boxes)?;
            let known = Rc::new(Magnitudes { of, boxes });
            let error = self.error(&known.of, &widths);
            cell.known = Some(known.clone());
            cell.is_sharp = error.ratio <= SHARP * at_points;
            if at_points > 0.0 {
                self.excess[halvings] = error.ratio / at_points;
            }
            if self.accept(cell, &known, &error, part, &widths)? {
                return Ok(None);
            }
            if at_points > 1.0 || cell.is_sharp && error.ratio > SHARP || halvings == most {
                return Ok(Some(error.along));
            }
            halvings += 1;
        }
    }

    /// Accepts a cell if its error, with that of the numbers at its corners, is permitted.
    fn accept(
        &mut self,
        cell: &mut Cell,
        known: &Magnitudes,
        error: &CellError,
        part: &Part,
        widths: &[f64],
    ) -> Result<bool, MapError> {
        if !(error.ratio <= 1.0) {
            return Ok(false);
        }
        let mut all: Vec<Interval> = error.of.iter().map(|x| Interval::constant(*x)).collect();
        let mut of_data = vec![vec![0.0_f64; self.orders.len()]; all.len()];
        for corner in corners(part) {
            let node = self.node(&corner)?;
            for (most, numbers) in of_data.iter_mut().zip(&node.numbers) {
                most.iter_mut().zip(numbers).for_each(|(most, [_, error])| *most = most.max(*error));
            }
        }
        // The drivers' values are rounded, too.
        let displaced: Vec<f64> = part
            .iter()
            .zip(&self.design)
            .map(|([a, b], d)| ROUNDING * (a.abs().max(b.abs()) + d.abs()))
            .collect();
        let interpolation = self.request.interpolation;
        for ((all, data), known) in all.iter_mut().zip(&of_data).zip(&known.of) {
            for (order, data) in self.orders.iter().zip(data) {
                *all += interpolation.data_factor(*order, widths) * Interval::constant(*data);
            }
            for (slope, displaced) in known[self.remainders.len()..].iter().zip(&displaced) {
                *all += Interval::constant(*slope) * Interval::constant(*displaced);
            }
        }
        let all: Vec<f64> = all.iter().map(|x| x.high).collect();
        let is_permitted = all.iter().zip(&self.request.outputs).all(|(x, output)| *x <= output.error);
        if is_permitted {
            self.proved[0] += 1;
            cell.proved = Some(Rc::new(all));
        }
        Ok(is_permitted)
    }

    /// Bound of the error of a cell of these widths, from magnitudes of derivatives.
    fn error(&self, magnitudes: &[Vec<f64>], widths: &[f64]) -> CellError {
        let mut found = CellError { of: Vec::new(), ratio: 0.0, along: 0 };
        for (magnitudes, output) in magnitudes.iter().zip(&self.request.outputs) {
            let mut along = vec![Interval::zero(); widths.len()];
            for (remainder, magnitude) in self.remainders.iter().zip(magnitudes) {
                let factor = self.request.interpolation.factor(*remainder, widths);
                along[remainder.0] += factor * Interval::constant(*magnitude);
            }
            let sum = along.iter().fold(Interval::zero(), |sum, x| sum + *x).high;
            if sum / output.error > found.ratio {
                found.ratio = sum / output.error;
                let most = (0..widths.len()).max_by(|a, b| along[*a].high.total_cmp(&along[*b].high));
                found.along = most.unwrap_or(0);
            }
            found.of.push(sum);
        }
        found
    }

    fn magnitudes_of(&self, bounds: &BoundsOfOutputs) -> Vec<Vec<f64>> {
        let of = |output: &Taylor<Interval>| {
            self.asked.iter().map(|order| output.derivative(*order).magnitude()).collect()
        };
        bounds.iter().map(of).collect()
    }

    /// Magnitudes over a part that is halved this often, and where there are no bounds over a box.
    fn over(
        &mut self,
        part: &Part,
        halvings: usize,
        boxes: &mut Vec<Part>,
    ) -> Result<Vec<Vec<f64>>, MapError> {
        self.go_on()?;
        let widths: Vec<f64> = self.ranges.iter().map(|[from, to]| to - from).collect();
        let size = |n: usize| (part[n][1] - part[n][0]) / widths[n];
        if halvings == 0 {
            match self.over_box(part) {
                Ok(of) => {
                    boxes.push(part.clone());
                    return Ok(of.to_vec());
                }
                Err(reason) => {
                    let may_be_halved = match &reason {
                        ProofError::Motion(failure) => failure.may_be_halved(),
                        ProofError::Output(_) => true,
                    };
                    let is_least = (0..part.len()).all(|n| size(n) <= 0.5_f64.powi(MOST_PARTS));
                    if !may_be_halved || is_least {
                        return Err(self.failed(part, reason));
                    }
                }
            }
        }
        let widest = (0..part.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0);
        let [from, to] = part[widest];
        let middle = 0.5 * (from + to);
        let mut all: Option<Vec<Vec<f64>>> = None;
        // First the half that is nearer to the design configuration, where positions are reached.
        let mut halves = [[from, middle], [middle, to]];
        if middle < 0.0 {
            halves.reverse();
        }
        for half in halves {
            let mut part = part.clone();
            part[widest] = half;
            let found = self.over(&part, halvings.saturating_sub(1), boxes)?;
            match &mut all {
                Some(all) => join(all, &found),
                None => all = Some(found),
            }
        }
        Ok(all.unwrap_or_default())
    }

    /// Reports the progress; fails if the caller ends the study.
    fn go_on(&mut self) -> Result<(), MapError> {
        let [proved, cells] = self.proved;
        if (self.more)(proved, cells) { Ok(()) } else { Err(MapError::Interrupted) }
    }

    /// Magnitudes over one box.
    fn over_box(&mut self, part: &Part) -> BoxResult {
        let key = key(part.iter().flatten());
        if let Some(known) = self.boxes.get(&key) {
            return known.clone();
        }
        let found = self.map.over(&intervals(part)).map_err(ProofError::Motion).and_then(|bounds| {
            let of = self.magnitudes_of(&bounds);
            match of.iter().position(|of| !of.iter().all(|x| x.is_finite())) {
                Some(output) => Err(ProofError::Output(output)),
                None => Ok(Rc::new(of)),
            }
        });
        self.boxes.insert(key, found.clone());
        found
    }

    /// Numbers of the table at a point.
    fn node(&mut self, at: &[f64]) -> Result<Rc<Node>, MapError> {
        let key = key(at);
        if let Some(known) = self.nodes.get(&key) {
            return Ok(known.clone());
        }
        let point: Part = at.iter().map(|x| [*x; 2]).collect();
        let bounds = self.map.at(at).map_err(|failure| self.failed(&point, ProofError::Motion(failure)))?;
        let mut numbers = Vec::new();
        for (k, output) in bounds.iter().enumerate() {
            let of = |order: &Exponents| {
                let bounds = output.derivative(*order);
                let value = bounds.middle();
                // Rounded once more in the conversion to the user's units.
                [value, 0.5 * bounds.width() * (1.0 + ROUNDING) + ROUNDING * value.abs()]
            };
            let of: Vec<[f64; 2]> = self.orders.iter().map(of).collect();
            if of.iter().flatten().any(|x| !x.is_finite()) {
                return Err(self.failed(&point, ProofError::Output(k)));
            }
            numbers.push(of);
        }
        let node = Rc::new(Node { numbers });
        self.nodes.insert(key, node.clone());
        Ok(node)
    }

    /// Proves that the numbers at all knots belong to the branch of the boxes around them, and this to the branch of
    /// the design configuration.
    fn connect(&mut self, knots: &[Vec<f64>], cells: &[Cell]) -> Result<(), MapError> {
        let begins: Vec<f64> = self.ranges.iter().map(|[from, to]| 0.0_f64.clamp(*from, *to)).collect();
        for (c, cell) in cells.iter().enumerate() {
            self.go_on()?;
            let Some(known) = &cell.known else { continue };
            let part: Part = places(knots, c).iter().zip(knots).map(|(k, x)| [x[*k], x[*k + 1]]).collect();
            let inside = contains(&part, &begins).then(|| begins.clone());
            for point in corners(&part).chain(inside) {
                let around = known.boxes.iter().find(|b| contains(b, &point));
                let around = around.expect("boxes tile a part that contains the cell").clone();
                let same = self.map.connect(&intervals(&around), &point);
                same.map_err(|failure| self.failed(&around, ProofError::Motion(failure)))?;
            }
        }
        let design = vec![0.0; begins.len()];
        if begins != design { self.connect_points(&design, &begins, MOST_PARTS) } else { Ok(()) }
    }

    /// Proves that two points belong to one branch.
    fn connect_points(&mut self, from: &[f64], to: &[f64], halvings: i32) -> Result<(), MapError> {
        let part: Part = from.iter().zip(to).map(|(a, b)| [a.min(*b), a.max(*b)]).collect();
        match self.over_box(&part) {
            Ok(_) | Err(ProofError::Output(_)) => Ok(()),
            Err(ProofError::Motion(failure)) if failure.may_be_halved() && halvings > 0 => {
                let middle: Vec<f64> = part.iter().map(|[from, to]| 0.5 * (from + to)).collect();
                self.connect_points(from, &middle, halvings - 1)?;
                self.connect_points(&middle, to, halvings - 1)
            }
            Err(reason) => Err(self.failed(&part, reason)),
        }
    }

    fn table(
        &mut self,
        drivers: Vec<DriverId>,
        knots: Vec<Vec<f64>>,
        cells: &[Cell],
    ) -> Result<MapTable, MapError> {
        let mut columns: Vec<MapColumn> = self
            .request
            .outputs
            .iter()
            .map(|o| MapColumn { output: o.output, proved: 0.0, numbers: Vec::new() })
            .collect();
        for proved in cells.iter().filter_map(|cell| cell.proved.as_ref()) {
            columns
                .iter_mut()
                .zip(proved.iter())
                .for_each(|(column, x)| column.proved = column.proved.max(*x));
        }
        let positions: usize = knots.iter().map(Vec::len).product();
        for position in 0..positions {
            let node = self.node(&point(&knots, position))?;
            for (column, numbers) in columns.iter_mut().zip(&node.numbers) {
                column.numbers.extend(numbers.iter().map(|[value, _]| value));
            }
        }
        let of_laws = |(n, knots): (usize, Vec<f64>)| {
            let last = knots.len() - 1;
            // The ends are those of the request, to the last bit.
            let place = |(k, x): (usize, f64)| match k {
                0 => self.request.axes[n].range[0],
                k if k == last => self.request.axes[n].range[1],
                _ => x + self.design[n],
            };
            knots.into_iter().enumerate().map(place).collect()
        };
        let knots = knots.into_iter().enumerate().map(of_laws).collect();
        let interpolation = self.request.interpolation;
        Ok(MapTable { drivers, knots, interpolation, columns, boxes: self.map.computed() })
    }

    fn failed(&self, part: &Part, reason: ProofError) -> MapError {
        let values = |relative: &[f64]| relative.iter().zip(&self.design).map(|(x, d)| x + d).collect();
        match reason {
            ProofError::Motion(BoxFailure::NotReached(stop)) => {
                let middle: Vec<f64> = part.iter().map(|[from, to]| 0.5 * (from + to)).collect();
                let last: Vec<f64> = self
                    .request
                    .axes
                    .iter()
                    .map(|axis| stop.drivers.get(axis.driver.0).copied().unwrap_or(0.0))
                    .collect();
                MapError::NotReached { drivers: values(&middle), last: values(&last), stop }
            }
            reason => {
                let part = part.iter().zip(&self.design).map(|(ends, d)| ends.map(|x| x + d)).collect();
                MapError::NotProved { part, reason }
            }
        }
    }
}

/// Elementwise maximum.
fn join(most: &mut [Vec<f64>], others: &[Vec<f64>]) {
    for (most, others) in most.iter_mut().zip(others) {
        most.iter_mut().zip(others).for_each(|(most, other)| {
            // NaN and infinity remain.
            if !(*other <= *most || most.is_nan()) {
                *most = *other;
            }
        });
    }
}

fn intervals(part: &Part) -> Vec<Interval> {
    part.iter().map(|[from, to]| Interval::between(*from, *to)).collect()
}

fn contains(part: &Part, point: &[f64]) -> bool {
    part.iter().zip(point).all(|([from, to], x)| from <= x && x <= to)
}

fn key<'x>(numbers: impl IntoIterator<Item = &'x f64>) -> Key {
    // Zero has one sign.
    numbers.into_iter().map(|x| (x + 0.0).to_bits()).collect()
}

fn corners(part: &Part) -> impl Iterator<Item = Vec<f64>> + use<> {
    let part = part.clone();
    (0..1_usize << part.len())
        .map(move |corner| part.iter().enumerate().map(|(n, ends)| ends[corner >> n & 1]).collect())
}

/// Interval of each driver of cell c; the last driver varies fastest.
fn places(knots: &[Vec<f64>], c: usize) -> Vec<usize> {
    let mut rest = c;
    let mut places: Vec<usize> = knots
        .iter()
        .rev()
        .map(|knots| {
            let n = knots.len() - 1;
            let place = rest % n;
            rest /= n;
            place
        })
        .collect();
    places.reverse();
    places
}

/// Position by its number; the last driver varies fastest.
fn point(knots: &[Vec<f64>], position: usize) -> Vec<f64> {
    let mut rest = position;
    let mut point: Vec<f64> = knots
        .iter()
        .rev()
        .map(|knots| {
            let x = knots[rest % knots.len()];
            rest /= knots.len();
            x
        })
        .collect();
    point.reverse();
    point
}

/// Halves intervals; the cells of both halves begin with what is known of the whole.
fn halve(knots: &[Vec<f64>], cells: &[Cell], halved: &HashSet<(usize, usize)>) -> (Vec<Vec<f64>>, Vec<Cell>) {
    // Per driver: the knots, and the old interval of each new one.
    let (mut finer, mut from) = (Vec::new(), Vec::new());
    for (n, knots) in knots.iter().enumerate() {
        let (mut new, mut old) = (vec![knots[0]], Vec::new());
        for (k, ends) in knots.windows(2).enumerate() {
            if halved.contains(&(n, k)) {
                new.push(0.5 * (ends[0] + ends[1]));
                old.push(k);
            }
            new.push(ends[1]);
            old.push(k);
        }
        finer.push(new);
        from.push(old);
    }
    let count: usize = from.iter().map(Vec::len).product();
    let cell = |c: usize| {
        let places = places(&finer, c);
        let old = places.iter().enumerate().fold(0, |old, (n, k)| old * (knots[n].len() - 1) + from[n][*k]);
        cells[old].clone()
    };
    let cells = (0..count).map(cell).collect();
    (finer, cells)
}
