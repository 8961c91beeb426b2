//! Comparison of exact sensitivities with differences of re-solved designs, quantity by quantity.

use hardpoint::measure::clearances_of;
use hardpoint::model::{BodyId, Dimension, Model, OutputSource, VariableId};
use hardpoint::run::{Solution, jumping_clearances, tied_clearances};
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;

use crate::difference::Difference;
use crate::magnitude::Magnitude;

/// A sensitivity that changes a quantity by less than this fraction per natural step counts as zero.
const NEGLIGIBLE: f64 = 1e-3;

/// Deviation of the analytic derivative from the finite difference of one quantity at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// Step, m, rad, or units of tau.
    pub step: f64,
    /// Largest deviation over all times of the difference, relative as described in [`Comparison::of`]; infinite if
    /// there is no sensitivity.
    pub error: f64,
    /// Name of the quantity: `knuckle acceleration`, `toe rate`, ...
    pub quantity: String,
    /// Time of the largest deviation, s.
    pub time: f64,
}

/// Largest relative deviation of every quantity at its step: six kinds of motion for each body except ground, and all
/// orders of each output.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// The six [`KINDS`], each for all bodies except ground; then value, rate and acceleration of every output.
    errors: Vec<StepError>,
    /// Number of bodies without ground.
    bodies: usize,
    /// Number of orders of each output.
    orders: Vec<usize>,
}

/// Kind of motion of a body.
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

/// Kinds of motion, order by order, translation of the origin first, like [`BodySensitivity`].
const KINDS: [Kind; 6] = [
    kind("position", |s| s.dr, 0, Dimension::LENGTH),
    kind("orientation", |s| s.dpi, 0, Dimension::ANGLE),
    kind("velocity", |s| s.dv, 1, Dimension::LENGTH),
    kind("angular velocity", |s| s.domega, 1, Dimension::ANGLE),
    kind("acceleration", |s| s.da, 2, Dimension::LENGTH),
    kind("angular acceleration", |s| s.dalpha, 2, Dimension::ANGLE),
];

impl Comparison {
    /// Compares the sensitivities of a complete solution with a difference over the same output times; empty if nothing
    /// was solved.
    ///
    /// A deviation is relative to the largest sensitivity of its kind over all bodies and times. If the design has
    /// hardly any effect, it is relative to the sensitivity that would change the motion by one part in a thousand per
    /// natural step.
    pub fn of(model: &Model, solution: &Solution, d: &Difference) -> Self {
        Self::with_clearances(model, solution, &NonsmoothClearances::of(model, solution), d)
    }

    /// The same for one of several variables; the clearances are those of the solution.
    pub fn with_clearances(
        model: &Model,
        solution: &Solution,
        nonsmooth: &NonsmoothClearances,
        d: &Difference,
    ) -> Self {
        let undecided = UndecidedOutputs::undefined(model, solution, nonsmooth, d.variable);
        Self::where_decided(model, solution, d, &undecided)
    }

    /// Compares as [`Comparison::of`], but skips outputs at times at which the differences are undecided.
    pub fn where_decided(
        model: &Model,
        solution: &Solution,
        d: &Difference,
        undecided: &UndecidedOutputs,
    ) -> Self {
        let mut builder = ComparisonBuilder::new(model, solution, d);
        if !solution.motion.is_empty() {
            builder.bodies();
            builder.outputs(undecided);
        }
        let orders = solution.measured.outputs.iter().map(|o| o.known.orders).collect();
        Self { errors: builder.errors, bodies: model.bodies.len() - 1, orders }
    }

    /// Errors of all quantities.
    pub fn errors(&self) -> &[StepError] {
        &self.errors
    }

    /// Quantity with the largest error.
    pub fn worst(&self) -> Option<&StepError> {
        self.errors.iter().max_by(|a, b| a.error.total_cmp(&b.error))
    }

    /// Errors of the position, velocity and acceleration of a body's origin; ground has none.
    pub fn of_origin(&self, body: BodyId) -> [f64; 3] {
        [0, 2, 4].map(|kind| self.errors[kind * self.bodies + body.0 - 1].error)
    }

    /// Errors of value, rate and acceleration of output m, a column of
    /// [`MeasureResults`](hardpoint::measure::MeasureResults); 0 for missing orders.
    pub fn of_output(&self, m: usize) -> [f64; 3] {
        let first = KINDS.len() * self.bodies + self.orders[..m].iter().sum::<usize>();
        [0, 1, 2].map(|order| if order < self.orders[m] { self.errors[first + order].error } else { 0.0 })
    }

    /// Reduces the error of outputs that agree at no step by the spread of the differences themselves, time by time.
    ///
    /// The smallest spread s of three consecutive steps bounds truncation and round-off at that time: truncation falls
    /// by a factor of 10 (one-sided: 3) from step to step. Only the part of a deviation that exceeds s remains as an
    /// error.
    pub fn allow_for_spread(
        &mut self,
        model: &Model,
        solution: &Solution,
        differences: &[Difference],
        undecided: &UndecidedOutputs,
        tolerance: f64,
    ) {
        let Some(finest) = differences.last() else { return };
        let builder = ComparisonBuilder::new(model, solution, finest);
        let (measured, steps) = (&solution.measured, solution.motion.len());
        let columns = measured.outputs.len();
        let mut place = KINDS.len() * self.bodies;
        for (m, output) in measured.outputs.iter().enumerate() {
            for order in 0..output.known.orders {
                let (index, variable) = (place, finest.variable);
                place += 1;
                if self.errors.get(index).is_none_or(|e| e.error <= tolerance) {
                    continue;
                }
                let scale = builder.scale_of(m, order);
                let (mut worst, mut time) = (0.0, 0.0);
                for k in (0..steps).filter(|k| builder.is_defined(*k, m) && !undecided.at(*k, m, order)) {
                    let exact = measured.derivative(k, variable, m, order);
                    let of = |d: &Difference| d.outputs[k * columns + m][order];
                    let rest = |w: &[Difference]| {
                        let [a, b, c] = [of(&w[0]), of(&w[1]), of(&w[2])];
                        let spread = (a - b).abs().max((b - c).abs());
                        let apart = (exact - a).abs().min((exact - b).abs()).min((exact - c).abs());
                        (spread, apart)
                    };
                    let known =
                        differences.windows(3).map(rest).filter(|(s, a)| s.is_finite() && a.is_finite());
                    let least = known.min_by(|a, b| a.0.total_cmp(&b.0));
                    // A derivative that is not a number is an error, and so is one without any difference to compare
                    // with.
                    let error =
                        least.map_or(f64::INFINITY, |(spread, apart)| (apart - spread).max(0.0) / scale);
                    if error > worst {
                        (worst, time) = (error, solution.motion.times[k]);
                    }
                }
                if worst < self.errors[index].error {
                    let (quantity, step) = (self.errors[index].quantity.clone(), finest.step);
                    self.errors[index] = StepError { step, error: worst, quantity, time };
                }
            }
        }
    }

    /// Keeps the better of two steps for every quantity.
    pub fn keep_better(&mut self, other: Self) {
        if self.errors.is_empty() {
            *self = other;
            return;
        }
        let better = self.errors.iter_mut().zip(other.errors).filter(|(best, e)| e.error < best.error);
        better.for_each(|(best, e)| *best = e);
    }
}

/// Outputs and times at which there is no derivative, or finite differences cannot decide whether it is right.
#[derive(Clone, Debug, Default)]
pub struct UndecidedOutputs {
    /// `[k * columns + m]`; empty if all are decided.
    places: Vec<bool>,
    /// The same, of rates and accelerations alone: where the shapes of a clearance are parallel for a moment, its rate
    /// jumps, and that of other designs at this time is on either side of the jump.
    jumps: Vec<bool>,
    columns: usize,
}

/// If the second difference exceeds this fraction of the magnitude itself, the zero of its vector is about one step
/// away.
const KINK: f64 = 1e-4;

/// Clearances of a motion that differences do not follow, by output time and clearance.
#[derive(Clone, Debug, Default)]
pub struct NonsmoothClearances {
    /// At an equilibrium, features that are equally deep in each other.
    tied: Vec<bool>,
    /// Along a motion, rates that jump.
    jumping: Vec<bool>,
}

impl NonsmoothClearances {
    /// Those of a solution of the nominal design.
    pub fn of(model: &Model, solution: &Solution) -> Self {
        let motion = &solution.motion;
        if model.clearances.is_empty() {
            Self::default()
        } else if model.equilibrium.is_some() {
            Self { tied: tied_clearances(model, motion), jumping: Vec::new() }
        } else {
            Self { tied: Vec::new(), jumping: jumping_clearances(model, motion) }
        }
    }
}

impl UndecidedOutputs {
    /// Outputs that have a value and no derivative by a variable: where features of shapes are equally deep in each
    /// other at an equilibrium. Along a motion such outputs have no rates either, which shows it, and rates may jump.
    pub fn undefined(
        model: &Model,
        solution: &Solution,
        NonsmoothClearances { tied, jumping }: &NonsmoothClearances,
        variable: VariableId,
    ) -> Self {
        let (measured, clearances) = (&solution.measured, model.clearances.len());
        let columns = measured.outputs.len();
        let of: Vec<_> = measured.outputs.iter().map(|output| clearances_of(model, output.source)).collect();
        let all = |found: &[bool], is: &dyn Fn(usize, usize) -> bool| -> Vec<bool> {
            let any = |k: usize, m: usize| of[m].iter().any(|c| found[k * clearances + c.0]);
            let steps = if found.is_empty() { 0..0 } else { 0..solution.motion.len() };
            let places = steps.flat_map(|k| (0..columns).map(move |m| (k, m)));
            places.map(|(k, m)| any(k, m) && is(k, m)).collect()
        };
        let places = all(tied, &|k, m| measured.derivative(k, variable, m, 0).is_nan());
        Self { places, jumps: all(jumping, &|_, _| true), columns }
    }

    /// Decides from the difference with the finest step. Undecided are magnitudes that reach zero within the step,
    /// where `abs(v)` has a kink and no derivative at v = 0, outputs without a value in a moved design, and those that
    /// are [undefined](Self::undefined). All are decided if there is no difference.
    pub fn by(
        model: &Model,
        solution: &Solution,
        nonsmooth: &NonsmoothClearances,
        finest: Option<&Difference>,
    ) -> Self {
        let Some(d) = finest else { return Self::default() };
        let measured = &solution.measured;
        let columns = measured.outputs.len();
        let kinked = |k: usize, m: usize| {
            let y = measured.value(k, m)[0];
            let Some(far) = model.measures[m].kind.distance_from_kink(y) else { return false };
            let (bend, change) = (d.bends[k * columns + m], d.outputs[k * columns + m][0] * d.step);
            // One-sided differences provide only the change over the step.
            let near = if bend.is_nan() { change } else { bend };
            near.abs() > KINK * far || far == 0.0
        };
        let sources: Vec<Vec<usize>> =
            (0..columns).map(|m| measures_of(model, measured.outputs[m].source)).collect();
        let undefined = Self::undefined(model, solution, nonsmooth, d.variable);
        let undecided = |place: usize| {
            let (k, m) = (place / columns, place % columns);
            d.outputs[place][0].is_nan() || undefined.at(k, m, 0) || sources[m].iter().any(|m| kinked(k, *m))
        };
        let places = (0..columns * solution.motion.len()).map(undecided).collect();
        Self { places, jumps: undefined.jumps, columns }
    }

    fn at(&self, k: usize, m: usize, order: usize) -> bool {
        let is = |places: &[bool]| places.get(k * self.columns + m).copied().unwrap_or(false);
        is(&self.places) || order > 0 && is(&self.jumps)
    }
}

/// Indices of the measures that an output is computed from, its own included.
fn measures_of(model: &Model, output: OutputSource) -> Vec<usize> {
    let OutputSource::Measure(m) = output else { return Vec::new() };
    let sources = model.measures[m].kind.sources().into_iter();
    std::iter::once(m).chain(sources.flat_map(|source| measures_of(model, source))).collect()
}

struct ComparisonBuilder<'a> {
    model: &'a Model,
    solution: &'a Solution,
    d: &'a Difference,
    magnitude: Magnitude,
    natural: f64,
    errors: Vec<StepError>,
}

impl<'a> ComparisonBuilder<'a> {
    fn new(model: &'a Model, solution: &'a Solution, d: &'a Difference) -> Self {
        let magnitude = Magnitude::of_settled_motion(model, &solution.motion);
        Self { model, solution, d, magnitude, natural: model.natural_step(d.variable), errors: Vec::new() }
    }

    /// Indices of the output times of the difference.
    fn times(&self) -> impl ExactSizeIterator<Item = usize> + use<> {
        (0..self.solution.motion.len()).step_by(self.d.stride)
    }

    fn bodies(&mut self) {
        let (solution, d) = (self.solution, self.d);
        let n = solution.motion.bodies;
        // Row by row and body by body, like the difference; empty if the mechanism cannot follow the variable.
        let exact = self.times().filter_map(|k| solution.sensitivities.at(k, d.variable.0));
        let exact: Vec<BodySensitivity> = exact.flat_map(|bodies| bodies.iter()).collect();
        let largest = solution.sensitivities.largest(solution.motion.len(), d.variable.0);
        for (kind, largest) in KINDS.into_iter().zip(largest) {
            let of = kind.of;
            let analytic = |row: usize, i: usize| exact.get(row * n + i).map(of);
            let scale = largest.max(self.negligible(kind.dimension, kind.order));
            for i in 1..n {
                let name = format!("{} {}", self.model.bodies[i].name, kind.name);
                let deviation = |row: usize| {
                    analytic(row, i).map_or(f64::NAN, |a| (a - of(&d.bodies[row * n + i])).norm())
                };
                self.push(name, scale, (0..self.times().len()).map(deviation));
            }
        }
    }

    fn outputs(&mut self, undecided: &UndecidedOutputs) {
        let (measured, d) = (&self.solution.measured, self.d);
        let columns = measured.outputs.len();
        for (m, output) in measured.outputs.iter().enumerate() {
            for order in 0..output.known.orders {
                let is_compared = |k: usize| self.is_defined(k, m) && !undecided.at(k, m, order);
                let compared: Vec<bool> = self.times().map(is_compared).collect();
                let scale = self.scale_of(m, order);
                let deviation = |row: usize| {
                    let analytic = measured.derivative(row * d.stride, d.variable, m, order);
                    (analytic - d.outputs[row * columns + m][order]).abs()
                };
                let name = output.order_name(order);
                let name = if order == 0 { format!("{name} value") } else { name };
                let rows = compared.iter().enumerate();
                let deviations: Vec<f64> =
                    rows.map(|(row, compared)| if *compared { deviation(row) } else { 0.0 }).collect();
                self.push(name, scale, deviations.into_iter());
            }
        }
    }

    /// Scale of deviations of the given time derivative of output m.
    fn scale_of(&self, m: usize, order: usize) -> f64 {
        let measured = &self.solution.measured;
        let largest = measured.largest_derivative(self.d.variable, m, order);
        largest.max(self.negligible(measured.outputs[m].dimension, order))
    }

    /// True if output m has all its orders at time k. The neighbours of a time without values are unreliable.
    fn is_defined(&self, k: usize, m: usize) -> bool {
        let measured = &self.solution.measured;
        let orders = measured.outputs[m].known.orders;
        measured.value(k, m)[..orders].iter().all(|x| x.is_finite())
    }

    /// Sensitivity below which a quantity counts as independent of the variable.
    fn negligible(&self, of: Dimension, order: usize) -> f64 {
        NEGLIGIBLE * self.magnitude.of(of, order) / self.natural
    }

    fn push(&mut self, quantity: String, scale: f64, deviations: impl Iterator<Item = f64>) {
        let (row, most) = deviations.enumerate().fold((0, 0.0_f64), |best, (row, x)| {
            // A NaN deviation must be selected, and stay.
            if best.1.is_nan() || x <= best.1 { best } else { (row, x) }
        });
        let error = if most == 0.0 { 0.0 } else { most / scale };
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let time = self.solution.motion.times[row * self.d.stride];
        self.errors.push(StepError { step: self.d.step, error, quantity, time });
    }
}
