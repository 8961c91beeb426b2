//! Storage of measures and point components over a motion, with their sensitivities.

use hardpoint_tape::{LANES, Lanes};

use crate::blocks::{Blocks, MergedRow, added_rows};
use crate::model::{Dimension, KnownOrders, Model, OutputSource, PointId, VariableId};
use crate::number::array;

use super::StepValues;

/// A column of [`MeasureResults`].
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// `toe` for a measure, `wheel_centre.z` for a point's component.
    pub name: String,
    /// Dimension of the value.
    pub dimension: Dimension,
    /// Known time derivatives.
    pub known: KnownOrders,
    /// Source of the output.
    pub source: OutputSource,
    /// Values at which it has kinks ([`MeasureKind::kinks`](crate::model::MeasureKind::kinks)).
    pub kinks: &'static [f64],
}

impl Output {
    /// Name of the time derivative of order 0, 1 or 2: `toe`, `toe rate`, `toe acceleration`; for a point's component
    /// `tip.x`, `tip.vx`, `tip.ax`.
    pub fn order_name(&self, order: usize) -> String {
        match (self.source, self.name.rsplit_once('.')) {
            (_, _) if order == 0 => self.name.clone(),
            (OutputSource::Point(..), Some((point, axis))) => {
                format!("{point}.{}{axis}", ["", "v", "a"][order])
            }
            (OutputSource::Measure(_), _) | (OutputSource::Point(..), None) => {
                format!("{} {}", self.name, ["", "rate", "acceleration"][order])
            }
        }
    }
}

/// Measures and point components over a motion, with their sensitivities.
#[derive(Clone, Debug, Default)]
pub struct MeasureResults {
    /// The columns: all measures, then x, y, z of all named points.
    pub outputs: Vec<Output>,
    /// Number of design variables.
    pub variables: usize,
    /// Output times.
    steps: usize,
    /// Per output, value, rate and acceleration; m or rad, per s, per s^2.
    pub(super) values: Blocks,
    /// Derivatives of those by the variables at fixed t.
    pub(super) d: Blocks,
    /// `places[b * outputs + m]`: index of the first derivative of output m by variable b; `None` if they are all zero.
    places: Vec<Option<usize>>,
    /// Variables that there are no derivatives by.
    unknown: Vec<bool>,
    pub(super) by_formula: usize,
}

impl MeasureResults {
    /// The column of that name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|o| o.name == name)
    }

    /// Value, rate and acceleration of output m at time k.
    ///
    /// Those beyond [`KnownOrders::orders`] are NaN, and so is what has no number at that time: the curvature of a path
    /// where its point rests, the instant centre of a body that does not turn.
    #[inline]
    pub fn value(&self, k: usize, m: usize) -> [f64; 3] {
        let row = self.values.row(k);
        array(|order| finite(row.get(3 * m + order)))
    }

    /// Derivatives by variable b; NaN if there is no value, or if the variable is not admissible, see
    /// [`Sensitivities::admissibility`](crate::sensitivity::Sensitivities::admissibility).
    pub fn d(&self, k: usize, b: VariableId, m: usize) -> [f64; 3] {
        let (values, d, place) = (self.values.row(k), self.d.row(k), self.place(b, m));
        array(|order| self.known(b, values.get(3 * m + order), place.map(|place| d.get(place + order))))
    }

    /// One of them: of the value (`order` 0), the rate (1) or the acceleration (2).
    #[inline]
    pub fn derivative(&self, k: usize, b: VariableId, m: usize, order: usize) -> f64 {
        let d = self.place(b, m).map(|place| self.d.row(k).get(place + order));
        self.known(b, self.values.row(k).get(3 * m + order), d)
    }

    /// Position of the derivatives of output m by variable b; `None` if they are zero.
    #[inline(always)]
    fn place(&self, b: VariableId, m: usize) -> Option<usize> {
        self.places[b.0 * self.outputs.len() + m]
    }

    /// Derivative of a value by variable b.
    #[inline(always)]
    fn known(&self, b: VariableId, value: f64, d: Option<f64>) -> f64 {
        if self.unknown[b.0] || !value.is_finite() { f64::NAN } else { d.map_or(0.0, finite) }
    }

    /// Largest magnitude over all output times of a [`derivative`](Self::derivative), of those that are known.
    pub fn largest_derivative(&self, b: VariableId, m: usize, order: usize) -> f64 {
        (0..self.len()).map(|k| self.derivative(k, b, m, order).abs()).fold(0.0, f64::max)
    }

    /// Number of output times.
    pub fn len(&self) -> usize {
        if self.outputs.is_empty() { 0 } else { self.steps }
    }

    /// True if there is nothing.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of values, over all outputs and output times, that formulas evaluated one by one and not a program:
    /// round-off apart, the numbers are the same.
    pub fn by_formula(&self) -> usize {
        self.by_formula
    }

    /// Resizes for these outputs at this number of times, within the memory at hand; `layout` gives the positions and
    /// the number of the derivatives.
    pub(super) fn shape(
        &mut self,
        outputs: Vec<Output>,
        variables: usize,
        layout: (Vec<Option<usize>>, usize),
        steps: usize,
    ) {
        self.values.shape(3 * outputs.len(), steps);
        self.d.shape(layout.1, steps);
        (self.outputs, self.variables, self.places, self.steps) = (outputs, variables, layout.0, steps);
        self.by_formula = 0;
        self.unknown.clear();
        self.unknown.resize(variables, false);
    }

    pub(super) fn set(&mut self, k: usize, m: usize, numbers: [f64; 3]) {
        self.values.set(k, 3 * m, numbers);
    }

    /// Stores derivatives, if they have a position.
    pub fn set_d(&mut self, k: usize, b: VariableId, m: usize, numbers: [f64; 3]) {
        if let Some(place) = self.place(b, m) {
            self.d.set(k, place, numbers);
        }
    }

    /// Copies measures that need more of a step than the motion of its bodies, at the eight output times from k on.
    /// Their rates are unknown; a program has stored them as such.
    pub(super) fn take_given(&mut self, k: usize, given: &StepValues, by_program: bool) {
        let Some(block) = given.block(k) else { return };
        let outputs = self.outputs.len();
        let (values, derivatives) = (self.values.block_mut(k), self.d.block_mut(k));
        let enter = |to: &mut [Lanes], x: &Lanes| {
            to[0] = *x;
            if !by_program {
                (to[1], to[2]) = ([f64::NAN; LANES], [f64::NAN; LANES]);
            }
        };
        let (now, changes) = block.split_at(given.measures().len());
        for (n, &m) in given.measures().iter().enumerate() {
            enter(&mut values[3 * m..], &now[n]);
        }
        let count = given.measures().len();
        for (b, places) in self.places.chunks_exact(outputs).enumerate() {
            for (n, &m) in given.measures().iter().enumerate() {
                if let Some(place) = places[m] {
                    enter(&mut derivatives[place..], &changes[b * count + n]);
                }
            }
        }
    }

    /// Appends output time k of another one, all outputs or those named.
    pub(crate) fn take_over(&mut self, from: &Self, k: usize, outputs: Option<&[OutputSource]>) {
        let wanted = |m: &usize| outputs.is_none_or(|list| list.contains(&from.outputs[*m].source));
        let columns: Vec<usize> = (0..from.outputs.len()).filter(wanted).collect();
        if self.outputs.is_empty() {
            let mut width = 0;
            let pairs =
                (0..from.variables).flat_map(|b| columns.iter().map(move |m| b * from.outputs.len() + m));
            let place = |pair: usize| {
                from.places[pair].map(|_| {
                    width += 3;
                    width - 3
                })
            };
            let places = pairs.map(place).collect();
            let outputs = columns.iter().map(|m| from.outputs[*m].clone()).collect();
            self.shape(outputs, from.variables, (places, width), 0);
        }
        let row = self.steps;
        self.steps += 1;
        for (m, &column) in columns.iter().enumerate() {
            self.set(row, m, from.value(k, column));
            for b in (0..from.variables).map(VariableId) {
                self.set_d(row, b, m, from.d(k, b, column));
            }
        }
    }

    /// Inserts output times of other results of the same outputs and variables, in this order of rows.
    pub(crate) fn insert(&mut self, added: &Self, rows: &[MergedRow]) {
        self.values.merge(&added.values, rows);
        // Derivatives may have other positions there.
        self.d.spread(rows);
        for (k, from) in added_rows(rows) {
            for m in 0..self.outputs.len() {
                for b in (0..self.variables).map(VariableId) {
                    self.set_d(k, b, m, added.d(from, b, m));
                }
            }
        }
        self.steps = rows.len();
        self.by_formula += added.by_formula;
    }

    /// Drops every second output time.
    pub(crate) fn thin(&mut self) {
        self.values.thin(self.steps);
        self.d.thin(self.steps);
        self.steps = self.steps.div_ceil(2);
    }

    /// There are no derivatives by these variables.
    pub(crate) fn forget(&mut self, variables: impl IntoIterator<Item = usize>) {
        self.unknown.resize(self.variables, false);
        variables.into_iter().for_each(|v| self.unknown[v] = true);
    }
}

/// Derivatives of that many outputs by that many variables, all of them.
pub(super) fn dense(outputs: usize, variables: usize) -> (Vec<Option<usize>>, usize) {
    let all = outputs * variables;
    ((0..all).map(|n| Some(3 * n)).collect(), 3 * all)
}

/// The columns that a model's measures and points give.
pub fn outputs(model: &Model) -> Vec<Output> {
    let output = |source| Output {
        name: model.output_name(source),
        dimension: model.dimension(source),
        known: model.known(source),
        source,
        kinks: match source {
            OutputSource::Measure(m) => model.measures[m].kind.kinks(),
            OutputSource::Point(..) => &[],
        },
    };
    let measures = (0..model.measures.len()).map(OutputSource::Measure);
    let points = (0..model.points.len()).filter(|k| !model.points[*k].unnamed);
    let components = points.flat_map(|k| (0..3).map(move |axis| OutputSource::Point(PointId(k), axis)));
    measures.chain(components).map(output).collect()
}

/// NaN at the pole of a formula; otherwise the number.
pub(crate) fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { f64::NAN }
}
