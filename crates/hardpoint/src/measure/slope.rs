//! Measures during the motion of one driver alone: motion ratios, bump steer, instant centres, roll centres.
//!
//! A driver that moves by itself is a direction like a change of the design (`docs/theory.md`, section 7); how the
//! outcome changes with the design is the second derivative along both.

use crate::design::{BodyFixed, DesignMap};
use crate::model::{
    AxleMeasure, DriverId, GROUND, MeasureKind, Model, VariableId, WheelId, WheelRequirement,
};
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::sensitivity::{PairDirection, Seconds};
use crate::space::Pose;
use crate::topology::Topology;

use super::wheel::{TravellingWheel, axle_roll_centre};
use super::{Instant, StepValues, bodies_asked_for};

/// Evaluates the measures that depend on a driver, where a stepper is.
pub(crate) struct Slopes<'a> {
    model: &'a Model,
    drivers: Vec<DriverId>,
    variables: usize,
    seconds: Seconds,
    /// Per variable, what measures depend on; the last is that of no change.
    fixed: Vec<BodyFixed<Dual<Dual>>>,
    asked_for: Vec<usize>,
    /// Per driver.
    poses: Vec<Vec<Pose<Dual<Dual>>>>,
}

impl<'a> Slopes<'a> {
    /// For the design with these values, with derivatives by the variables if they are wanted; `None` for a model
    /// without such measures.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        sensitivities: bool,
    ) -> Option<Self> {
        let model = design_map.model();
        let mut drivers: Vec<DriverId> =
            (0..model.measures.len()).flat_map(|k| driver_of(model, k)).flatten().collect();
        drivers.sort_unstable();
        drivers.dedup();
        if drivers.is_empty() {
            return None;
        }
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let unit = |v: usize| model.alone(VariableId(v), 1.0);
        let ways = drivers
            .iter()
            .map(|d| PairDirection::Driver(*d))
            .chain((0..variables).map(|v| PairDirection::Design(unit(v))));
        // Directions: first the drivers, then unit vectors of the variables; pairs: every driver u with every variable
        // w (15).
        let ways: Vec<PairDirection> = ways.collect();
        let pairs: Vec<[usize; 2]> = (0..variables)
            .flat_map(|v| (0..drivers.len()).map(move |d| (d, v)))
            .map(|(d, v)| [d, drivers.len() + v])
            .collect();
        let fixed = |by: usize| {
            // With the driver none of it goes (the outer `d` is 0); along the variable what that moves in its body (the
            // inner `d`).
            let value = |k: usize| Dual::constant(Dual { v: values[k], d: f64::from(u8::from(k == by)) });
            let values: Vec<_> = (0..values.len()).map(value).collect();
            design_map.fixed(&values)
        };
        Some(Self {
            model,
            seconds: Seconds::new(design_map, topology, values, &ways, &pairs),
            fixed: (0..variables).chain([usize::MAX]).map(fixed).collect(),
            asked_for: bodies_asked_for(model).into_iter().filter(|b| *b != GROUND.0).collect(),
            poses: vec![vec![Pose::IDENTITY.spread(); model.bodies.len()]; drivers.len()],
            variables,
            drivers,
        })
    }

    /// Enters what is found at time t, the one that was begun last.
    pub fn add(&mut self, stepper: &mut Stepper<'_>, t: f64, out: &mut StepValues) {
        self.seconds.solve(stepper, t);
        let state = &stepper.state;
        for by in 0..=self.variables {
            for (d, poses) in self.poses.iter_mut().enumerate() {
                for &body in &self.asked_for {
                    // X + eps_q X_q + eps_b X_b + eps_q eps_b X_qb, without b for the values themselves
                    poses[body] = if by < self.variables {
                        self.seconds.pose(state, by * self.drivers.len() + d, body)
                    } else {
                        self.seconds.pose_along(state, d, body)
                    };
                }
            }
            let alone = DriverAlone {
                drivers: &self.drivers,
                instants: self.poses.iter().map(|p| Instant::new(self.model, &self.fixed[by], p)).collect(),
            };
            for k in (0..self.model.measures.len()).filter(|k| self.model.depends_on_driver(*k)) {
                let x = alone.measure(self.model, k);
                if by < self.variables { out.set_d(by, k, x.d) } else { out.set(k, x.v) }
            }
        }
    }
}

/// The drivers that a measure depends on, if it does: those of both wheels of an axle may differ.
fn driver_of(model: &Model, k: usize) -> Option<[DriverId; 2]> {
    let of_wheel = |wheel: WheelId, need: WheelRequirement| model.wheels[wheel.0].driver(need);
    if !model.depends_on_driver(k) {
        return None;
    }
    match model.measures[k].kind {
        MeasureKind::Slope { driver, .. } => Some([driver; 2]),
        MeasureKind::Wheel { wheel, what } => of_wheel(wheel, what.needs()).map(|d| [d; 2]),
        MeasureKind::Axle { axle, .. } => {
            let [left, right] =
                model.axles[axle.0].wheels.map(|wheel| of_wheel(wheel, WheelRequirement::Bump));
            left.zip(right).map(|(l, r)| [l, r])
        }
        _ => None,
    }
}

/// The same position as often as there are drivers, each time with what happens while that driver alone moves.
struct DriverAlone<'m, T> {
    drivers: &'m [DriverId],
    instants: Vec<Instant<'m, Dual<T>>>,
}

impl<T: Real> DriverAlone<'_, T> {
    /// The value of a measure that depends on a driver; NaN of all others.
    fn measure(&self, model: &Model, k: usize) -> T {
        let unknown = T::constant(f64::NAN);
        let Some(drivers) = driver_of(model, k) else { return unknown };
        let [first, second] = drivers.map(|d| {
            &self.instants[self.drivers.binary_search(&d).expect("the drivers of all measures are here")]
        });
        let wheel = |instant: &Instant<'_, Dual<T>>, d: usize, wheel: WheelId| TravellingWheel {
            wheel: instant.wheel(k, d, wheel),
            // The twist w, v per unit of q, which is what a pose with `d` along q splits into
            carrier: instant.poses[model.wheels[wheel.0].body.0].split().1,
            drive: model.wheels[wheel.0].drive,
            brakes: model.wheels[wheel.0].brakes,
        };
        match model.measures[k].kind {
            // (d of/dq) / (d over/dq), each with its derivative by the variable; the quotient rule is the dual's
            MeasureKind::Slope { of, over, .. } => first.output(of).d / first.output(over).d,
            MeasureKind::Wheel { wheel: w, what } => wheel(first, 0, w).measure(what, &model.vehicle),
            MeasureKind::Axle { axle, what } => {
                // Each wheel goes up and down by its own driver; they may be one.
                let [left, right] = model.axles[axle.0].wheels;
                let (y, height) = axle_roll_centre([wheel(first, 0, left), wheel(second, 1, right)]);
                if what == AxleMeasure::RollCentreY { y } else { height }
            }
            _ => unknown,
        }
    }
}
