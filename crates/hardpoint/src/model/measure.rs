//! Measures: numbers that follow from the motion.

use super::*;
use crate::law::Expression;
use crate::space::Real;

/// A number that follows from the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Its name.
    pub name: String,
    /// What is measured.
    pub kind: MeasureKind,
}

/// Where an output comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputSource {
    /// A measure of the model.
    Measure(usize),
    /// Component 0, 1 or 2 of a point of the model.
    Point(PointId, usize),
}

/// What a measure measures. Formulas and signs are in `docs/measures.md`.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasureKind {
    /// A joint's coordinate: angle (unwrapped), displacement, or length (the whole of it).
    Coordinate {
        /// Which joint.
        joint: JointId,
        /// Which of its type's coordinates.
        coordinate: usize,
    },
    /// Distance between two body points.
    Distance {
        /// From this point.
        from: PointId,
        /// To this one.
        to: PointId,
    },
    /// Global position of a point along a direction.
    Coordinates {
        /// Which point.
        point: PointId,
        /// Unit direction, global.
        along: Vec3,
    },
    /// Angle between two directions.
    Angle {
        /// From the first to the second.
        between: [Ray; 2],
        /// Which angle.
        kind: AngleKind,
    },
    /// Velocity or acceleration of a point.
    Velocity {
        /// Which point.
        point: PointId,
        /// Unit direction, global, of the component; the magnitude where there is none.
        along: Option<Vec3>,
        /// 1 for the velocity, 2 for the acceleration.
        order: usize,
    },
    /// Curvature of a point's path.
    Curvature {
        /// Which point.
        point: PointId,
        /// Unit direction, global, seen along which a turn to the left is positive; without it, all of it is.
        about: Option<Vec3>,
    },
    /// Time derivative of another output.
    Rate {
        /// Of which.
        of: OutputSource,
    },
    /// How much one output changes per change of another while one driver alone moves.
    Slope {
        /// Of this one ...
        of: OutputSource,
        /// ... over this one.
        over: OutputSource,
        /// The driver that moves.
        driver: DriverId,
    },
    /// A formula over other outputs.
    Combination(Combination),
    /// Toe of a left wheel: `atan2(e_x, e_y)` of the spin axis e.
    Toe {
        /// The body that the wheel turns on.
        body: BodyId,
        /// Spin axis in the design configuration, pointing outboard.
        spin_axis: Direction,
    },
    /// Camber of a left wheel: `-asin(e_z)` of the spin axis e.
    Camber {
        /// The body that the wheel turns on.
        body: BodyId,
        /// Spin axis in the design configuration, pointing outboard.
        spin_axis: Direction,
    },
    /// Something about a wheel.
    Wheel {
        /// Which wheel.
        wheel: WheelId,
        /// What about it.
        what: WheelMeasure,
    },
    /// Something about both wheels of an axle.
    Axle {
        /// Which axle.
        axle: AxleId,
        /// What about it.
        what: AxleMeasure,
    },
}

/// A direction that an angle is measured from or to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ray {
    /// From one point to another.
    Between([PointId; 2]),
    /// Fixed in a body, as it points in the design configuration.
    Fixed {
        /// The body; ground for a global direction.
        body: BodyId,
        /// Where it points.
        axis: Direction,
    },
}

/// Which angle two directions make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AngleKind {
    /// Between them, 0 to 180 deg.
    Between,
    /// Between the lines along them, 0 to 90 deg: the transmission angle.
    Lines,
    /// From the first to the second as seen along this unit direction (global, pointing at the viewer), counter-clockwise
    /// positive.
    About(Vec3),
}

/// A formula over other outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    pub(super) expression: Expression,
    /// What its names mean, and how many of the text's units make one SI unit of each.
    pub(super) inputs: Vec<(OutputSource, f64)>,
    /// How many of the text's units make one SI unit of the result.
    pub(super) per_unit: f64,
    pub(super) dimension: Dimension,
}

impl Combination {
    /// What it was written as.
    pub fn text(&self) -> &str {
        self.expression.text()
    }

    /// The outputs that it uses.
    pub fn sources(&self) -> impl Iterator<Item = OutputSource> {
        self.inputs.iter().map(|i| i.0)
    }

    /// Its value in SI for these outputs in SI.
    pub(crate) fn at<T: Real>(&self, output: impl Fn(OutputSource) -> T) -> T {
        let number = |k: usize| {
            let (from, per_unit) = self.inputs[k];
            output(from) * T::constant(per_unit)
        };
        self.expression.over(number) / T::constant(self.per_unit)
    }
}

/// What a number measures, as powers of length, angle and time; the user's units follow from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    /// Power of length.
    pub length: i8,
    /// Power of angle.
    pub angle: i8,
    /// Power of time.
    pub time: i8,
}

impl Dimension {
    /// A plain number.
    pub const NUMBER: Self = Self { length: 0, angle: 0, time: 0 };
    /// A length.
    pub const LENGTH: Self = Self { length: 1, ..Self::NUMBER };
    /// An angle.
    pub const ANGLE: Self = Self { angle: 1, ..Self::NUMBER };

    /// That of the time derivative of this order; of -1 that of an integral over time.
    #[must_use]
    pub const fn rate(self, order: i8) -> Self {
        Self { time: self.time - order, ..self }
    }

    /// That of a quotient.
    #[must_use]
    pub const fn over(self, o: Self) -> Self {
        Self { length: self.length - o.length, angle: self.angle - o.angle, time: self.time - o.time }
    }
}

impl From<Quantity> for Dimension {
    fn from(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Length => Self::LENGTH,
            Quantity::Angle => Self::ANGLE,
            Quantity::Number => Self::NUMBER,
        }
    }
}

/// How much can be known of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// How many of value, rate and acceleration.
    pub orders: usize,
    /// Whether it follows from positions alone: then it has second design derivatives, and slopes.
    pub by_position: bool,
}

impl Model {
    /// `toe` for a measure, `wheel_centre.z` for a point's component.
    pub fn output_name(&self, output: OutputSource) -> String {
        match output {
            OutputSource::Measure(k) => self.measures[k].name.clone(),
            OutputSource::Point(p, axis) => format!("{}.{}", self.points[p.0].name, ["x", "y", "z"][axis]),
        }
    }

    /// How much can be known of an output: the motion ends at accelerations.
    pub fn known(&self, output: OutputSource) -> Known {
        let moving = |orders: usize| Known { orders, by_position: false };
        let positions = Known { orders: 3, by_position: true };
        let OutputSource::Measure(k) = output else { return positions };
        match &self.measures[k].kind {
            MeasureKind::Velocity { order, .. } => moving(3 - order),
            MeasureKind::Curvature { .. } => moving(1),
            MeasureKind::Rate { of } => moving(self.known(*of).orders.saturating_sub(1)),
            MeasureKind::Combination(c) => c.sources().map(|s| self.known(s)).fold(positions, |all, one| {
                Known { orders: all.orders.min(one.orders), by_position: all.by_position && one.by_position }
            }),
            _ if self.goes_by_driver(k) => moving(1),
            _ => positions,
        }
    }

    /// Whether a measure says what happens while one driver alone moves, rather than in the course of time.
    pub(crate) fn goes_by_driver(&self, measure: usize) -> bool {
        match self.measures[measure].kind {
            MeasureKind::Slope { .. } => true,
            MeasureKind::Wheel { what, .. } => what.needs().goes_by_driver(),
            MeasureKind::Axle { what, .. } => what.goes_by_driver(),
            _ => false,
        }
    }

    /// What an output's value is.
    pub fn dimension(&self, output: OutputSource) -> Dimension {
        let OutputSource::Measure(k) = output else { return Dimension::LENGTH };
        match &self.measures[k].kind {
            MeasureKind::Coordinate { joint, coordinate } => {
                self.joints[joint.0].kind.coordinates[*coordinate].quantity.into()
            }
            MeasureKind::Distance { .. } | MeasureKind::Coordinates { .. } => Dimension::LENGTH,
            MeasureKind::Toe { .. } | MeasureKind::Camber { .. } | MeasureKind::Angle { .. } => {
                Dimension::ANGLE
            }
            MeasureKind::Velocity { order, .. } => Dimension::LENGTH.rate(*order as i8),
            MeasureKind::Curvature { .. } => Dimension::NUMBER.over(Dimension::LENGTH),
            MeasureKind::Rate { of } => self.dimension(*of).rate(1),
            MeasureKind::Slope { of, over, .. } => self.dimension(*of).over(self.dimension(*over)),
            MeasureKind::Combination(c) => c.dimension,
            MeasureKind::Wheel { what, .. } => what.dimension(),
            MeasureKind::Axle { what, .. } => what.dimension(),
        }
    }

    /// The directions fixed in bodies that a measure goes by.
    pub(crate) fn directions(&self, measure: &Measure) -> [Option<(BodyId, Direction)>; 2] {
        let of_wheel = |wheel: WheelId| {
            let wheel = &self.wheels[wheel.0];
            Some((wheel.body, wheel.spin_axis))
        };
        match measure.kind {
            MeasureKind::Toe { body, spin_axis } | MeasureKind::Camber { body, spin_axis } => {
                [Some((body, spin_axis)), None]
            }
            MeasureKind::Wheel { wheel, .. } => [of_wheel(wheel), None],
            MeasureKind::Axle { axle, .. } => self.axles[axle.0].wheels.map(of_wheel),
            MeasureKind::Angle { between, .. } => between.map(|ray| match ray {
                Ray::Fixed { body, axis } => Some((body, axis)),
                Ray::Between(_) => None,
            }),
            _ => [None; 2],
        }
    }
}
