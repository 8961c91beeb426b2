//! How far exact sensitivities are from differences of re-solved designs, quantity by quantity.

use crate::model::{BodyId, Dimension, Model};
use crate::run::Solution;
use crate::sensitivity::BodySensitivity;
use crate::space::Vec3;

use super::difference::Difference;
use super::magnitude::Magnitude;

/// A sensitivity that moves a quantity by less than this part of it per natural step counts as zero.
const NEGLIGIBLE: f64 = 1e-3;

/// Analytic against finite difference of one quantity at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// The step, m, rad, or units of tau.
    pub step: f64,
    /// Largest deviation over all times, relative as [`Comparison::of`] says; infinite where there is no sensitivity.
    pub error: f64,
    /// The quantity: `knuckle acceleration`, `toe rate`, ...
    pub quantity: String,
    /// The time where it is, s.
    pub time: f64,
}

/// The largest relative deviation of every quantity at its step: of each body but ground six kinds of motion, of each output its orders.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// The six [`KINDS`], each of all bodies but ground; then value, rate and acceleration of every output.
    errors: Vec<StepError>,
    /// Without ground.
    bodies: usize,
    /// How many orders each output has.
    orders: Vec<usize>,
}

/// A kind of motion of a body.
struct Kind {
    name: &'static str,
    of: fn(&BodySensitivity) -> Vec3,
    order: usize,
    dimension: Dimension,
}

const fn kind(
    name: &'static str,
    of: fn(&BodySensitivity) -> Vec3,
    order: usize,
    dimension: Dimension,
) -> Kind {
    Kind { name, of, order, dimension }
}

/// Order by order, of the origin first.
const KINDS: [Kind; 6] = [
    kind("position", |s| s.dr, 0, Dimension::LENGTH),
    kind("orientation", |s| s.dpi, 0, Dimension::ANGLE),
    kind("velocity", |s| s.dv, 1, Dimension::LENGTH),
    kind("angular velocity", |s| s.domega, 1, Dimension::ANGLE),
    kind("acceleration", |s| s.da, 2, Dimension::LENGTH),
    kind("angular acceleration", |s| s.dalpha, 2, Dimension::ANGLE),
];

impl Comparison {
    /// Compares the sensitivities of a complete solution with a difference over the same output times; empty where nothing was solved.
    ///
    /// A deviation is relative to the largest sensitivity of its kind over all bodies and times, or, where
    /// the design hardly matters, to what one natural step would have to change for one part in a thousand of
    /// the motion itself.
    pub fn of(model: &Model, solution: &Solution, d: &Difference) -> Self {
        let mut comparing = Comparing::new(model, solution, d);
        if !solution.motion.is_empty() {
            comparing.bodies();
            comparing.outputs();
        }
        let orders = solution.measured.outputs.iter().map(|o| o.known.orders).collect();
        Self { errors: comparing.errors, bodies: model.bodies.len() - 1, orders }
    }

    /// That of every quantity.
    pub fn errors(&self) -> &[StepError] {
        &self.errors
    }

    /// The quantity that agrees worst.
    pub fn worst(&self) -> Option<&StepError> {
        self.errors.iter().max_by(|a, b| a.error.total_cmp(&b.error))
    }

    /// Errors of the position, velocity and acceleration of a body's origin; ground has none.
    pub fn of_origin(&self, body: BodyId) -> [f64; 3] {
        [0, 2, 4].map(|kind| self.errors[kind * self.bodies + body.0 - 1].error)
    }

    /// Errors of value, rate and acceleration of output m, a column of [`Measured`](crate::measure::Measured); 0 for orders that it does
    /// not have.
    pub fn of_output(&self, m: usize) -> [f64; 3] {
        let first = KINDS.len() * self.bodies + self.orders[..m].iter().sum::<usize>();
        [0, 1, 2].map(|order| if order < self.orders[m] { self.errors[first + order].error } else { 0.0 })
    }

    /// Keeps of every quantity the better of two steps.
    pub fn keep_better(&mut self, other: Self) {
        if self.errors.is_empty() {
            *self = other;
            return;
        }
        let better = self.errors.iter_mut().zip(other.errors).filter(|(best, e)| e.error < best.error);
        better.for_each(|(best, e)| *best = e);
    }
}

struct Comparing<'a> {
    model: &'a Model,
    solution: &'a Solution,
    d: &'a Difference,
    magnitude: Magnitude,
    natural: f64,
    errors: Vec<StepError>,
}

impl<'a> Comparing<'a> {
    fn new(model: &'a Model, solution: &'a Solution, d: &'a Difference) -> Self {
        let span = match &solution.motion.times[..] {
            [first, .., last] => last - first,
            _ => 1.0,
        };
        let magnitude = Magnitude::of_motion(model, &solution.motion).or_once_in(span);
        Self { model, solution, d, magnitude, natural: model.natural_step(d.variable), errors: Vec::new() }
    }

    fn bodies(&mut self) {
        let (solution, d) = (self.solution, self.d);
        let (n, steps) = (solution.motion.bodies, solution.motion.len());
        // Time by time and body by body, like the difference; nothing where the mechanism cannot follow the variable.
        let exact = (0..steps).filter_map(|k| solution.sensitivities.at(k, d.variable.0));
        let exact: Vec<BodySensitivity> = exact.flat_map(|bodies| bodies.iter()).collect();
        for kind in KINDS {
            let of = kind.of;
            let analytic = |k: usize, i: usize| exact.get(k * n + i).map(of);
            let largest = exact.iter().map(|s| of(s).norm()).fold(0.0, f64::max);
            let scale = largest.max(self.negligible(kind.dimension, kind.order));
            for i in 1..n {
                let name = format!("{} {}", self.model.bodies[i].name, kind.name);
                let deviation =
                    |k: usize| analytic(k, i).map_or(f64::NAN, |a| (a - of(&d.bodies[k * n + i])).norm());
                self.push(name, scale, (0..steps).map(deviation));
            }
        }
    }

    fn outputs(&mut self) {
        let (measured, d, steps) = (&self.solution.measured, self.d, self.solution.motion.len());
        let columns = measured.outputs.len();
        for (m, output) in measured.outputs.iter().enumerate() {
            for order in 0..output.known.orders {
                let analytic = |k: usize| measured.d(k, d.variable, m)[order];
                let largest = (0..steps).map(|k| analytic(k).abs()).fold(0.0, f64::max);
                let scale = largest.max(self.negligible(output.dimension, order));
                // Next to a time without a number the neighbours' may be anything.
                let defined =
                    |k: &usize| measured.value(*k, m)[..output.known.orders].iter().all(|x| x.is_finite());
                let deviation = |k: usize| (analytic(k) - d.outputs[k * columns + m][order]).abs();
                let name = output.order_name(order);
                let name = if order == 0 { format!("{name} value") } else { name };
                self.push(name, scale, (0..steps).map(|k| if defined(&k) { deviation(k) } else { 0.0 }));
            }
        }
    }

    /// A sensitivity below which there is none to speak of.
    fn negligible(&self, of: Dimension, order: usize) -> f64 {
        NEGLIGIBLE * self.magnitude.of(of, order) / self.natural
    }

    fn push(&mut self, quantity: String, scale: f64, deviations: impl Iterator<Item = f64>) {
        let (k, most) = deviations.enumerate().fold((0, 0.0), |best, (k, x)| {
            // A NaN deviation must win.
            if !(x <= best.1) { (k, x) } else { best }
        });
        let error = if most == 0.0 { 0.0 } else { most / scale };
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let time = self.solution.motion.times[k];
        self.errors.push(StepError { step: self.d.step, error, quantity, time });
    }
}
