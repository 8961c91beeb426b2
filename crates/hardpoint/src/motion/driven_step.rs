//! A step as straight-line programs of its drivers, for generators of source code.
//!
//! The programs are recorded from the kernel, like those that the solver runs itself ([`step_program`]). They differ in
//! their inputs: the coordinates at which the step begins, the drivers' values, rates and accelerations, and, if
//! requested, the design variables. There is no time, no law and no prediction in them, so the caller chooses the path
//! of the drivers.
//!
//! The angles that couplers count through whole turns, and the parameters of the contacts with curves, are unknowns
//! like the coordinates. The turn of an angle is the nearest one to the predicted angle. A parameter is corrected on
//! the piece of its curve on which it is predicted: the numbers of the piece are inputs, too.
//!
//! A distance of a point from its curve that changes with the design is that from the foot of the perpendicular in the
//! design configuration. The parameter of the foot is one more unknown, which moves with the design only.
//!
//! [`step_program`]: super::step_program

use hardpoint_tape::{Number, Options, Program, record};

use crate::design::DesignMap;
use crate::linalg::Factors;
use crate::model::{CURVE_PIECE, Contact, Curve, CurvePiece, Driver, JointId, VariableId};
use crate::number::{self, record as recording};
use crate::space::Vec3;
use crate::topology::{ClosureId, RowId, Topology};

use super::BodyState;
use super::kinematics::State;
use super::mechanism::{Mechanism, driver_units};
use super::parts::PlanGeometry;
use super::predictor::{Channel, ORDERS};
use super::step_program::{OFFSET, RecordedStep, largest_of};

/// Step of a mechanism as straight-line programs of its drivers, and of its design if that was requested.
///
/// All numbers are in SI units. The three programs have the same inputs: the unknown coordinates, the piece of every
/// curve at its contact, then value, rate and acceleration of every driver, then the values of
/// [`design`](Self::design). A step corrects the coordinates by
/// [`correction`](Self::correction) until the size of a correction is at most 1e-8, so that the remaining error is its
/// square, and evaluates [`motion`](Self::motion) there.
#[derive(Clone, Debug)]
pub struct DrivenStep {
    /// Unknown coordinates; those of a ball are the four components of a unit quaternion. Then the angles that couplers
    /// count through whole turns, the parameters of the contacts with curves, and those of the feet in the design
    /// configuration.
    pub coordinates: Vec<DrivenCoordinate>,
    /// Curves that points follow: those of the contacts, then those of the feet.
    pub curves: Vec<DrivenCurve>,
    /// Value of every driver at the start, m or rad.
    pub drivers: Vec<DrivenCoordinate>,
    /// Design variables that are inputs, in the order of the model: all of them, or none if the design is nominal.
    pub design: Vec<DrivenVariable>,
    /// One Newton correction: the corrected coordinates, and its largest component in units of the coordinates.
    pub correction: Program,
    /// First and second derivative of every coordinate.
    pub path: Program,
    /// Results at the solved coordinates, in this order: [`MotionCheck`]s, the determinant of every block, excess and
    /// then value of every measure of [`step_measures`](Self::step_measures), and 24 numbers of every body but ground:
    /// r, the columns of A, v, omega, a, alpha.
    pub motion: Program,
    /// True for each block whose determinant is a logarithm.
    pub logarithmic: Vec<bool>,
    /// Measures of the model that are found with the motion. Their value is undefined if its excess is positive.
    pub step_measures: Vec<usize>,
}

/// Coordinate of a step where its path starts.
#[derive(Clone, Copy, Debug)]
pub struct DrivenCoordinate {
    /// Value, m or rad; a component of a quaternion.
    pub start: f64,
    /// Unit in which moves are compared: 1 rad, the size of the loop, 1/2 for a component of a quaternion, or the
    /// length over which a curve turns by about a radian.
    pub unit: f64,
}

/// Curve of a step, which a point follows.
#[derive(Clone, Debug)]
pub struct DrivenCurve {
    /// Index of its parameter in the coordinates.
    pub coordinate: usize,
    /// The curve.
    pub curve: Curve,
}

/// Design variable of a step, in its unit; the nominal design is at 0.
#[derive(Clone, Copy, Debug)]
pub struct DrivenVariable {
    /// True if the variable also changes the law of a driver, which is not part of the step.
    pub changes_law: bool,
}

/// Numbers by which the motion of a step is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionCheck {
    /// Positive if a decision of the recording does not hold.
    Limit,
    /// Positive if a determinant has another sign: the position is on another branch.
    Branch,
    /// Largest factor of the elimination in the recorded order of the pivots.
    Growth,
    /// Largest pivot over the smallest one, of all blocks.
    Pivots,
    /// Largest residual of a constraint, redundant ones included, rad or sizes of loops.
    Residual,
}

impl MotionCheck {
    /// All checks, in the order of the outputs.
    pub const ALL: [Self; 5] = [Self::Limit, Self::Branch, Self::Growth, Self::Pivots, Self::Residual];
}

/// Unknown of a step.
#[derive(Clone, Copy)]
enum Unknown {
    Channel(Channel),
    /// Angle that a coupler counts through whole turns, by the row of its term.
    Angle(RowId),
    /// Parameter of the contact with a curve.
    Contact(ClosureId, usize),
    /// Parameter of a foot, by its index.
    Foot(usize, Foot),
}

/// Foot of the perpendicular on a curve from its follower in the design configuration, if the design moves it.
#[derive(Clone, Copy)]
struct Foot {
    joint: JointId,
    /// Index of the curve.
    curve: usize,
}

impl Foot {
    /// All of a plan whose design is an input.
    fn all(topology: &Topology, design_map: &DesignMap<'_>) -> Vec<Self> {
        let mut feet = Vec::new();
        record(|| {
            let values: Vec<Number> = design_map.model().whole(&[]).into_iter().map(Number::input).collect();
            let is_moved = |foot: &Self| {
                let follower = design_map.follower(foot.joint, &values);
                follower.is_some_and(|p| [p.x, p.y].iter().any(|x| x.known().is_none()))
            };
            let all = topology.contacts().map(|(c, curve)| Self { joint: topology[c].joint, curve });
            feet = all.filter(is_moved).collect();
            []
        });
        feet
    }
}

impl Unknown {
    /// All of a plan, in the order of the inputs.
    fn all(topology: &Topology, feet: &[Foot]) -> Vec<Self> {
        let channels = Channel::all(topology).into_iter().map(Self::Channel);
        let terms = topology.coupler_terms.iter().filter(|r| !topology.constraint(**r).is_length());
        let contacts = topology.contacts().map(|(c, k)| Self::Contact(c, k));
        let feet = feet.iter().enumerate().map(|(k, foot)| Self::Foot(k, *foot));
        channels.chain(terms.map(|r| Self::Angle(*r))).chain(contacts).chain(feet).collect()
    }

    /// Value, first and second derivative in a solved state, with the parameters of the feet.
    fn of(self, topology: &Topology, state: &State<Number>, feet: &[Number]) -> [Number; ORDERS] {
        match self {
            Self::Channel(channel) => channel.of(state),
            Self::Angle(r) => state.coordinate_of_row(topology, r),
            Self::Contact(c, k) => {
                let [rate, second] = state.sliding(topology, c, k);
                [state.contacts[k].u, rate, second]
            }
            // It rests where the design does.
            Self::Foot(k, _) => [feet[k], Number::constant(0.0), Number::constant(0.0)],
        }
    }

    /// The unknown at the accepted position.
    fn start(self, one: &Mechanism<'_>) -> DrivenCoordinate {
        let saved = &one.saved;
        let (start, unit) = match self {
            Self::Channel(channel) => {
                let unit = match channel {
                    Channel::Coordinate(c) => one.topology[c].unit,
                    Channel::Ball(..) => 0.5,
                };
                (channel.saved(&saved.q, &saved.balls), unit)
            }
            Self::Angle(r) => (saved.coupled[r.0][0], 1.0),
            Self::Contact(_, k) => (saved.contacts[k].u, one.parts.curves[k].turning_length()),
            Self::Foot(_, Foot { curve, .. }) => {
                (one.parts.curves[curve].start(), one.parts.curves[curve].turning_length())
            }
        };
        DrivenCoordinate { start, unit }
    }

    /// Size of a correction from an input, for the unknowns that are not corrected with the coordinates.
    fn corrected(
        self,
        topology: &Topology,
        state: &State<Number>,
        feet: &[Number],
        [from, unit]: [Number; 2],
    ) -> Option<Number> {
        match self {
            Self::Channel(_) => None,
            Self::Angle(_) | Self::Contact(..) | Self::Foot(..) => {
                let [now, ..] = self.of(topology, state, feet);
                Some(((now - from) / unit).abs())
            }
        }
    }
}

impl DrivenStep {
    /// Writes the pieces of the curves at the contacts behind the coordinates, as the programs read them.
    pub fn place_pieces(&self, inputs: &mut [f64]) {
        let first = self.coordinates.len();
        for (k, DrivenCurve { coordinate, curve }) in self.curves.iter().enumerate() {
            let piece = curve.piece(inputs[*coordinate]);
            inputs[first + k * CURVE_PIECE..][..CURVE_PIECE].copy_from_slice(&piece);
        }
    }

    /// Number of inputs before those of the drivers: the coordinates, and the pieces of the curves.
    pub fn position_inputs(&self) -> usize {
        self.coordinates.len() + self.curves.len() * CURVE_PIECE
    }

    /// Records the step at the accepted position, of the nominal design or of any; `besides` records the measures that
    /// need more than the motion, with further limits. `None` if the step is not arithmetic.
    pub(crate) fn record(
        one: &Mechanism<'_>,
        (design_map, any_design): (&DesignMap<'_>, bool),
        step_measures: Vec<usize>,
        besides: impl FnOnce(&mut RecordedStep<'_>) -> Option<(Vec<Number>, Vec<Number>)>,
    ) -> Option<Self> {
        let (model, topology) = (one.model, &one.topology);
        let feet = if any_design { Foot::all(topology, design_map) } else { Vec::new() };
        let unknowns = Unknown::all(topology, &feet);
        let design = (design_map, any_design.then_some(&feet[..]));
        // An offset below 1e-8 is corrected once; without an offset nothing is corrected.
        let correction = recorded(one, design, OFFSET[0], |step, _, (inputs, feet)| {
            let state = &*step.state;
            let mut out: Vec<Number> = unknowns.iter().map(|u| u.of(topology, state, feet)[0]).collect();
            let of_coordinates = state.corrections.iter().map(|(corrections, _)| corrections[0]);
            let others = unknowns.iter().zip(inputs);
            let others = others.filter_map(|(unknown, from)| unknown.corrected(topology, state, feet, *from));
            out.push(largest_of(of_coordinates.chain(others)));
            Some(out)
        })?;
        let path = recorded(one, design, 0.0, |step, _, (_, feet)| {
            let rates = unknowns.iter().flat_map(|u| u.of(topology, step.state, feet).into_iter().skip(1));
            Some(rates.collect())
        })?;
        let motion = recorded(one, design, 0.0, |step, parts, _| {
            let bodies = BodyState::all(step.state);
            let state = &*step.state;
            let watched = || state.watched.iter();
            let sides = state.watched.iter().map(|w| {
                let side = if Number::value(w.product) > 0.0 { -1.0 } else { 1.0 };
                w.product * side
            });
            let [branch, growth] = [largest_of(sides), largest_of(watched().map(|w| w.growth))];
            let pivots = watched().map(|w| w.most * w.least).reduce(Number::larger);
            let pivots = pivots.unwrap_or_else(|| Number::constant(1.0));
            let [_, residual] = state.largest_residuals(topology, parts, step.drivers);
            let determinants = state.determinants.clone();
            let (measures, limits) = besides(step)?;
            let limit = largest_of(limits.into_iter().chain(recording::limits()));
            Some([vec![limit, branch, growth, pivots, residual], determinants, measures, bodies].concat())
        })?;
        let coordinates = unknowns.iter().map(|unknown| unknown.start(one));
        let curves = one.parts.curves.iter().chain(feet.iter().map(|foot| &one.parts.curves[foot.curve]));
        let first_contact = unknowns.len() - one.parts.curves.len() - feet.len();
        // Zero has one sign.
        let values = model.drivers.iter().zip(&one.saved.drivers).map(|(d, f)| d.with_sense(f[0]) + 0.0);
        let drivers = values.zip(driver_units(model, topology));
        let values = if any_design { model.whole(&[]) } else { Vec::new() };
        let variable = |k: usize| DrivenVariable {
            changes_law: !design_map.field(VariableId(k), &values).laws.is_empty(),
        };
        Some(Self {
            design: (0..values.len()).map(variable).collect(),
            coordinates: coordinates.collect(),
            curves: curves
                .enumerate()
                .map(|(k, curve)| DrivenCurve { coordinate: first_contact + k, curve: curve.clone() })
                .collect(),
            drivers: drivers.map(|(start, unit)| DrivenCoordinate { start, unit }).collect(),
            correction,
            path,
            motion,
            logarithmic: one.state.factors.iter().map(|f| matches!(f, Factors::Sparse(_))).collect(),
            step_measures,
        })
    }
}

/// Every unknown where a step begins, with its unit, and the corrected parameter of every foot.
type Begin<'a> = (&'a [[Number; 2]], &'a [Number]);

/// Inputs of a recorded step that say where it begins.
struct Beginning {
    /// Every unknown, with its unit.
    inputs: Vec<[Number; 2]>,
    /// Every foot, with the joint and the piece of the curve.
    feet: Vec<(JointId, CurvePiece<Number>, Contact<Number>)>,
}

/// Puts the position at `offset` from the accepted one into a state, as inputs of a recording.
fn begin(one: &Mechanism<'_>, feet: &[Foot], offset: f64, state: &mut State<Number>) -> Beginning {
    let (mut inputs, mut contacts, mut placed) = (Vec::new(), Vec::new(), Vec::new());
    for unknown in Unknown::all(&one.topology, feet) {
        let DrivenCoordinate { start, unit } = unknown.start(one);
        let beside = match unknown {
            Unknown::Channel(Channel::Ball(c, k)) => {
                one.saved.balls[c.0].nudged(Vec3::new(offset, offset, offset)).component(k)
            }
            Unknown::Channel(Channel::Coordinate(_)) => start + offset * unit,
            Unknown::Angle(_) | Unknown::Contact(..) | Unknown::Foot(..) => start,
        };
        let input = Number::input(beside);
        inputs.push([input, Number::constant(unit)]);
        match unknown {
            Unknown::Channel(channel) => channel.put(input, state),
            Unknown::Angle(r) => state.near[r.0] = input,
            Unknown::Contact(..) => contacts.push((start, input)),
            Unknown::Foot(_, foot) => placed.push((foot, start, input)),
        }
    }
    let pieces = one.parts.curves.iter().zip(&contacts);
    state.pieces = pieces.map(|(curve, (start, _))| curve.piece(*start).map(Number::input)).collect();
    let contacts = state.pieces.iter().zip(&contacts);
    state.contacts = contacts.map(|(piece, (_, u))| Contact::on_piece(piece, *u)).collect();
    let on_curve = |(Foot { joint, curve }, start, u): (Foot, f64, Number)| {
        let piece = one.parts.curves[curve].piece(start).map(Number::input);
        (joint, piece, Contact::on_piece(&piece, u))
    };
    Beginning { inputs, feet: placed.into_iter().map(on_curve).collect() }
}

/// Records a step of the nominal design, or of any with these feet, from a position at `offset` from the accepted one,
/// and returns the program of these outputs.
fn recorded(
    one: &Mechanism<'_>,
    (design_map, any_design): (&DesignMap<'_>, Option<&[Foot]>),
    offset: f64,
    outputs: impl FnOnce(&mut RecordedStep<'_>, &PlanGeometry<Number>, Begin<'_>) -> Option<Vec<Number>>,
) -> Option<Program> {
    let (model, topology) = (one.model, &one.topology);
    let mut fits = false;
    recording::begin();
    let recorded = record(|| {
        let mut state = State::new(model, topology);
        let Beginning { inputs, feet } = begin(one, any_design.unwrap_or_default(), offset, &mut state);
        // Inputs are the drivers' values, the kernel drives coordinates.
        let coordinate = |(driver, saved): (&Driver, &[f64; ORDERS])| {
            number::each(saved, |x| driver.with_sense(Number::input(driver.with_sense(x))))
        };
        let drivers: Vec<[Number; ORDERS]> =
            model.drivers.iter().zip(&one.saved.drivers).map(coordinate).collect();
        let number = if any_design.is_some() { Number::input } else { Number::constant };
        let values: Vec<Number> = model.whole(&[]).into_iter().map(number).collect();
        let known = feet.iter().map(|(joint, _, foot)| (*joint, *foot)).collect();
        let (geometry, followers) = recording::strictly(|| design_map.geometry_on(&values, known));
        let corrected = feet.iter().zip(followers).map(|((_, piece, foot), p)| foot.corrected(piece, p).u);
        let corrected: Vec<Number> = corrected.collect();
        let parts = PlanGeometry::of(model, topology, &geometry);
        if state.solve(topology, &parts, &drivers, f64::INFINITY).is_err() {
            return Vec::new();
        }
        let mut step =
            RecordedStep { topology, state: &mut state, values: &values, drivers: &drivers, laws: &[] };
        let outputs = outputs(&mut step, &parts, (&inputs, &corrected));
        fits = outputs.is_some();
        outputs.unwrap_or_default()
    });
    (fits && recording::is_arithmetic()).then(|| recorded.program(Options::default()).0)
}
