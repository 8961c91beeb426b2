//! Measures during the motion of one driver alone: motion ratios, bump steer, instant centres, roll centres.
//!
//! A driver that moves by itself is a direction like a change of the design (`docs/theory.md`, section 7); how the
//! outcome changes with the design is the second derivative along both.

use std::cell::OnceCell;

use hardpoint_tape::{Number, record};

use crate::design::{BodyFixed, DesignMap};
use crate::model::{
    AxleMeasure, AxleMotion, DriverId, GROUND, MeasureKind, Model, OutputSource, WheelId, loads, of_bodies,
};
use crate::motion::kinematics::State;
use crate::motion::mechanism::Mechanism;
use crate::motion::step_program::RecordedStep;
use crate::number::{Dual, Real, record as recording};
use crate::sensitivity::{PairDirection, Seconds, pair_with_variables, values_along_variable};
use crate::space::{Mat3, Pose, Vec3};
use crate::topology::Topology;

use super::dexterity::dexterity;
use super::step_values::{RecordedValue, RecordedValues};
use super::wheel::{TravellingWheel, amounts, axle_roll_centre, if_moving};
use super::{Instant, StepValues, bodies_asked_for};

/// Maximum number of combinations of a driver, a body and a variable for which slopes are recorded: each takes some
/// hundred operations.
const MOST_PAIRS: usize = 10_000;

/// Poses of all bodies while a driver moves alone at an equilibrium.
pub(crate) struct DriverPoses {
    pub driver: DriverId,
    /// Per variable: with the derivatives along the driver (outer) and by the variable (inner).
    pub by_variable: Vec<Vec<Pose<Dual<Dual>>>>,
}

/// Evaluates the measures that depend on a driver, where a stepper is; or records them with a step.
pub(crate) struct Slopes<'a, T = f64> {
    model: &'a Model,
    drivers: Vec<DriverId>,
    variables: usize,
    /// True if an equilibrium solves the derivatives by the variables.
    at_equilibrium: bool,
    seconds: Seconds<T>,
    /// Per variable, what measures depend on; the last is that of no change.
    fixed: Vec<BodyFixed<Dual<Dual<T>>>>,
    asked_for: Vec<usize>,
    /// The measures, ascending.
    measures: Vec<usize>,
    /// Per driver.
    poses: Vec<Vec<Pose<Dual<Dual<T>>>>>,
}

/// Drivers that move alone and variables: directions of [`Seconds`], first the drivers, then unit vectors of the
/// variables; pairs are every driver u with every variable w (15).
struct Ways {
    measures: Vec<usize>,
    drivers: Vec<DriverId>,
    variables: usize,
    directions: Vec<PairDirection>,
    pairs: Vec<[usize; 2]>,
}

impl Ways {
    /// Directions of these measures of a model, with derivatives by the variables if requested; `None` if none depends
    /// on a driver.
    fn of(model: &Model, asked: impl IntoIterator<Item = usize>, sensitivities: bool) -> Option<Self> {
        let measures: Vec<usize> = asked.into_iter().filter(|m| model.depends_on_driver(*m)).collect();
        let drivers = drivers_of(model, &measures);
        if drivers.is_empty() {
            return None;
        }
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let mut directions = drivers.iter().map(|d| PairDirection::Driver(*d)).collect();
        let pairs = pair_with_variables(model, &mut directions, variables);
        Some(Self { measures, drivers, variables, directions, pairs })
    }
}

impl<'a> Slopes<'a> {
    /// Slopes of the design with these values, of these measures, with derivatives by the variables if requested;
    /// `None` if none of them depends on a driver. These openings follow the drivers, if there are any.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        (values, asked): (&[f64], impl IntoIterator<Item = usize>),
        sensitivities: bool,
        openings: &[DriverId],
    ) -> Option<Self> {
        let mut ways = Ways::of(design_map.model(), asked, sensitivities)?;
        if !openings.is_empty() {
            // The openings follow both directions of a pair, which the equilibrium solves.
            ways.pairs.clear();
        }
        let seconds = Seconds::new(design_map, topology, values, (&ways.directions, openings), &ways.pairs);
        let slopes = Self::along(design_map, values, ways, seconds);
        Some(Self { at_equilibrium: !openings.is_empty(), ..slopes })
    }

    /// The drivers that move alone.
    pub fn drivers(&self) -> &[DriverId] {
        &self.drivers
    }

    /// Sets the rates of this number of openings while each of these drivers moves alone; all others are released, and
    /// nothing is known along them.
    pub fn set_openings(&mut self, openings: usize, rates: &[(DriverId, Vec<f64>)]) {
        let unknown = vec![f64::NAN; openings];
        for (k, driver) in self.drivers.iter().enumerate() {
            let found = rates.iter().find(|(d, _)| d == driver);
            self.seconds.set_openings(k, found.map_or(&unknown, |(_, rates)| rates));
        }
    }

    /// Writes the results at time t, the one that was begun last. At an equilibrium `curved` are the poses along the
    /// drivers.
    pub fn add(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        t: f64,
        curved: &[DriverPoses],
        out: &mut StepValues,
    ) {
        self.seconds.solve(mechanism, t);
        let (variables, at_equilibrium) = (self.variables, self.at_equilibrium);
        let enter = |k, by, x: Dual| if by < variables { out.set_d(by, k, x.d) } else { out.set(k, x.v) };
        let drivers = self.drivers.clone();
        let unknown = Vec3::ZERO.map(|_: f64| Dual::constant(Dual::constant(f64::NAN)));
        let unknown = Pose { rot: Mat3 { cols: [unknown; 3] }, r: unknown };
        let set = |by: usize, poses: &mut [Vec<Pose<Dual<Dual>>>]| {
            for (driver, poses) in drivers.iter().zip(poses) {
                let found = curved.iter().find(|along| along.driver == *driver);
                match found.and_then(|along| along.by_variable.get(by)) {
                    Some(of_variable) => poses.clone_from(of_variable),
                    // Of a driver that was left out the value alone is known.
                    None if at_equilibrium && by < variables => poses.fill(unknown),
                    None => {}
                }
            }
        };
        let first = if at_equilibrium && curved.is_empty() { variables } else { 0 };
        self.measure(&mechanism.state, first, set, enter);
    }
}

impl<'a> Slopes<'a, Number> {
    /// Records these measures with a step, with derivatives by the variables if requested; `None` if they are not
    /// arithmetic. If any of the limits is positive, the results are invalid.
    pub fn record(
        design_map: &'a DesignMap<'a>,
        step: &mut RecordedStep<'_>,
        sensitivities: bool,
    ) -> Option<(RecordedValues, Vec<Number>)> {
        let RecordedStep { topology, state, values, .. } = step;
        let model = design_map.model();
        let ways = Ways::of(model, 0..model.measures.len(), sensitivities)?;
        let seconds = Seconds::recorded(design_map, topology, values, &ways.directions, &ways.pairs)?;
        let mut slopes = recording::strictly(|| Self::along(design_map, values, ways, seconds));
        slopes.seconds.solve_at(topology, state);
        let (variables, mut limits) = (slopes.variables, recording::limits());
        let zero = Number::constant(0.0);
        let mut found: Vec<RecordedValue> = Vec::new();
        slopes.measure(
            state,
            0,
            |_, _| (),
            |measure, by, x| {
                let holds = recording::limits();
                let place = match found.iter().position(|f| f.measure == measure) {
                    Some(place) => place,
                    None => {
                        found.push(RecordedValue {
                            measure,
                            excess: zero,
                            numbers: vec![zero; 1 + variables],
                        });
                        found.len() - 1
                    }
                };
                let RecordedValue { excess, numbers, .. } = &mut found[place];
                if let Formula::Slope(..) = formula(&model.measures[measure].kind) {
                    // A formula has another number beyond its limits; ...
                    limits.extend(holds);
                } else {
                    // ... an instant centre has none at infinity.
                    *excess = holds.into_iter().fold(*excess, Number::larger);
                }
                if by < variables {
                    numbers[1 + by] = x.d;
                } else {
                    numbers[0] = x.v;
                    // NaN is left to the kernel: a recording has no sign of zero.
                    limits.extend(x.v.known().is_none().then(|| x.v.abs() + -f64::MAX));
                }
            },
        );
        Some((RecordedValues(found), limits))
    }
}

impl<'a, T: Real> Slopes<'a, T> {
    fn along(design_map: &'a DesignMap<'a>, values: &[T], ways: Ways, seconds: Seconds<T>) -> Self {
        let Ways { measures, drivers, variables, .. } = ways;
        let model = design_map.model();
        // Body-fixed data do not depend on a driver: the outer derivative is zero.
        let fixed = |by: usize| design_map.fixed(&values_along_variable(values, by));
        Self {
            model,
            seconds,
            fixed: (0..variables).chain([usize::MAX]).map(fixed).collect(),
            asked_for: bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect(),
            measures,
            poses: vec![vec![Pose::IDENTITY.spread(); model.bodies.len()]; drivers.len()],
            variables,
            at_equilibrium: false,
            drivers,
        }
    }

    /// Evaluates all of them at a state that was solved: `found` gets each measure with a variable, from the `first`
    /// on, and the derivative by that, and after the last variable with their number and the value. `set` may replace
    /// the poses, per driver, for a variable.
    fn measure(
        &mut self,
        state: &State<T>,
        first: usize,
        mut set: impl FnMut(usize, &mut [Vec<Pose<Dual<Dual<T>>>>]),
        mut found: impl FnMut(usize, usize, Dual<T>),
    ) {
        for by in first..=self.variables {
            self.seconds.set_poses(state, by, &self.asked_for, &mut self.poses);
            set(by, &mut self.poses);
            let instants = self
                .poses
                .iter()
                .map(|poses| (Instant::new(self.model, &self.fixed[by], poses), OnceCell::new()));
            let alone = DriverAlone { drivers: &self.drivers, instants: instants.collect() };
            for &k in &self.measures {
                found(k, by, alone.measure(self.model, k));
            }
        }
    }
}

/// Drivers that measures depend on.
fn drivers_of(model: &Model, measures: &[usize]) -> Vec<DriverId> {
    let mut drivers: Vec<DriverId> = measures.iter().flat_map(|k| model.drivers_alone(*k)).collect();
    drivers.sort_unstable();
    drivers.dedup();
    drivers
}

/// Formula of a measure along a driver.
enum Formula {
    /// The slope of one output over another.
    Slope(OutputSource, OutputSource),
    SingularValue,
    Other,
}

fn formula(kind: &MeasureKind) -> Formula {
    match kind {
        MeasureKind::Slope { of, over, .. } => Formula::Slope(*of, *over),
        MeasureKind::Dexterity { .. } => Formula::SingularValue,
        of_bodies!()
        | loads!()
        | MeasureKind::Compliance { .. }
        | MeasureKind::Wheel { .. }
        | MeasureKind::Axle { .. } => Formula::Other,
    }
}

/// Reason why the measures of a model that depend on a driver are not recorded, if they are not.
pub(crate) fn hindrance(design_map: &DesignMap<'_>) -> Option<&'static str> {
    let model = design_map.model();
    let all: Vec<usize> = (0..model.measures.len()).collect();
    let pairs = drivers_of(model, &all).len() * (1 + model.variables.len()) * model.bodies.len();
    if pairs > MOST_PAIRS {
        return Some("the program for the motion of single drivers would be too long");
    }
    let mut outputs = Vec::new();
    for measure in &model.measures {
        match formula(&measure.kind) {
            Formula::Slope(of, over) => outputs.extend([of, over]),
            Formula::SingularValue => return Some("singular values are found by iterations"),
            Formula::Other => {}
        }
    }
    if outputs.is_empty() {
        return None;
    }
    let mut fits = true;
    recording::begin();
    record(|| {
        let number =
            |x: f64| Dual { v: Dual::constant(Number::input(x)), d: Dual::constant(Number::input(0.0)) };
        let vector = |v: Vec3| v.map(number);
        let poses: Vec<_> = model
            .bodies
            .iter()
            .map(|b| Pose { rot: Mat3 { cols: b.frame.rot.cols.map(vector) }, r: vector(b.frame.r) })
            .collect();
        let fixed =
            design_map.fixed(&model.whole(&[])).map(|x| Dual::constant(Dual::constant(Number::constant(x))));
        outputs.iter().for_each(|output| _ = Instant::new(model, &fixed, &poses).output(*output));
        fits = recording::is_arithmetic();
        []
    });
    (!fits).then_some("a slope is that of a formula that decides by values")
}

/// Sum of `w^2 + (v / L_0)^2` of the bodies along a driver, with the size `L_0` of the mechanism.
fn motion_of<T: Real>(instant: &Instant<'_, Dual<T>>) -> T {
    let per_size = T::constant(1.0 / instant.fixed.size);
    instant.poses.iter().fold(T::zero(), |sum, pose| {
        let (w, v) = (pose.split().1.w, pose.r.map(|x| x.d) * per_size);
        sum + w.dot(w) + v.dot(v)
    })
}

/// The same position as often as there are drivers, each time with what happens while that driver alone moves.
struct DriverAlone<'m, T> {
    drivers: &'m [DriverId],
    /// Per driver, with the motion of all bodies, which is computed for the first slope.
    instants: Vec<(Instant<'m, Dual<T>>, OnceCell<T>)>,
}

impl<T: Real> DriverAlone<'_, T> {
    fn place(&self, driver: DriverId) -> usize {
        self.drivers.binary_search(&driver).expect("the drivers of all measures are here")
    }

    fn instant(&self, driver: DriverId) -> &Instant<'_, Dual<T>> {
        &self.instants[self.place(driver)].0
    }

    fn motion(&self, driver: DriverId) -> T {
        let (instant, motion) = &self.instants[self.place(driver)];
        *motion.get_or_init(|| motion_of(instant))
    }

    /// The value of a measure that depends on a driver; NaN of all others.
    fn measure(&self, model: &Model, k: usize) -> T {
        let unknown = T::constant(f64::NAN);
        let mut alone = model.drivers_alone(k).map(|d| self.instant(d));
        let Some(first) = alone.next() else { return unknown };
        let second = alone.next();
        let wheel = |instant: &Instant<'_, Dual<T>>, d: usize, wheel: WheelId| TravellingWheel {
            wheel: instant.wheel(k, d, wheel),
            // The twist w, v per unit of q, from a pose with its derivative `d` along q
            carrier: instant.poses[model.wheels[wheel.0].body.0].split().1,
            drive: model.wheels[wheel.0].drive,
            brakes: model.wheels[wheel.0].brakes,
        };
        match &model.measures[k].kind {
            // (d of/dq) / (d over/dq), each with its derivative by the variable; the quotient rule is the dual's.
            // Several drivers move by dq or -dq in terms of their laws: d/dq = sum +-d/dq_k
            MeasureKind::Slope { of, over, driver, together, opposed } => {
                let along = |output: OutputSource| {
                    let mut sum = first.output(output).d;
                    let with = together.iter().flatten().map(|d| (d, false));
                    for (d, is_opposed) in with.chain(opposed.iter().flatten().map(|d| (d, true))) {
                        let rate = self.instant(*d).output(output).d;
                        let is_reversed = |d: &DriverId| model.drivers[d.0].is_reversed;
                        let turned = is_reversed(d) != is_reversed(driver);
                        sum = if turned == is_opposed { sum + rate } else { sum - rate };
                    }
                    sum
                };
                let (of, rate) = (along(*of), along(*over));
                let others = [together, opposed].into_iter().flatten().flatten();
                let motion = others.fold(self.motion(*driver), |sum, d| sum + self.motion(*d));
                // (L_0^n (w, v / L_0))^2 of a measure in m^n, with the size L_0 of the mechanism
                let size = T::constant(first.fixed.size.powi(model.dimension(*over).length.into()));
                of / if_moving(rate, motion * (size * size))
            }
            MeasureKind::Dexterity { points, drivers, value } => {
                let jacobian = |d: usize, p: usize| {
                    let instant = self.instant(drivers[d]);
                    instant.point(points[p]).map(|x| x.d)
                };
                dexterity(jacobian, [drivers.len(), points.len()], *value)
            }
            MeasureKind::Wheel { wheel: w, what } => {
                let own = wheel(first, 0, *w);
                let travelling = match second.zip(model.moved_with(*w, *what)) {
                    Some((second, other)) => {
                        let own = [own, wheel(second, 0, *w)];
                        let other = [wheel(first, 1, other), wheel(second, 1, other)];
                        let by = amounts(&own, &other, what.motion());
                        let [one, two] = own;
                        one.along(two, by)
                    }
                    None => own,
                };
                travelling.measure(*what, &model.vehicle)
            }
            MeasureKind::Axle { axle, what } => {
                let [left, right] = model.axles[axle.0].wheels;
                let Some(second) = second else { return unknown };
                let by_one = model.wheels[left.0].bump == model.wheels[right.0].bump;
                let wheels = if by_one {
                    [wheel(first, 0, left), wheel(second, 1, right)]
                } else {
                    let along = |d: usize, id: WheelId| [wheel(first, d, id), wheel(second, d, id)];
                    let (left, right) = (along(0, left), along(1, right));
                    let by = amounts(&left, &right, AxleMotion::Roll);
                    [left, right].map(|[one, two]| one.along(two, by))
                };
                let (y, height) = axle_roll_centre(wheels);
                if *what == AxleMeasure::RollCentreY { y } else { height }
            }
            of_bodies!() | loads!() | MeasureKind::Compliance { .. } => unknown,
        }
    }
}
