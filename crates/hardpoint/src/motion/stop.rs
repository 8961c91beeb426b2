//! Reason why a motion ended before its last output time.

use crate::draft::with_digits;
use crate::joint::Quantity;
use crate::model::{BodyId, DriverId, ElementId, HardpointId, JointId, LimitEnd, Model};
use crate::space::Vec3;
use crate::topology::BlockId;

use super::gap::{Gap, SINGULAR_DRAWING};

/// Significant digits of times and of parts of loads in messages.
const TIME_DIGITS: usize = 7;

/// End of a run before its last output time. The results up to there are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Event that ended the run.
    pub kind: StopKind,
    /// The last time that was solved, s; `None` if not even the start was reached.
    pub last_time: Option<f64>,
    /// The earliest time known to fail, s.
    pub failed_time: f64,
    /// Values of all drivers at the last solved position, relative to the design configuration, m or rad.
    pub drivers: Vec<f64>,
    /// The block of the plan that holds that loop.
    pub block: Option<BlockId>,
    /// Smallest over largest pivot of the loop in question there: near 0 at a limit position.
    pub pivot_ratio: f64,
    /// The joints of that loop.
    pub joints: Vec<JointId>,
    /// Smallest remaining gaps, largest first, if the mechanism does not assemble.
    pub remains: Vec<Gap>,
    /// Fraction of the gaps that could be closed together during the assembly, 0 to 1.
    pub closed: Option<f64>,
    /// True if the tangent stiffness of an equilibrium becomes singular there: beyond it the mechanism snaps through.
    pub snaps_through: bool,
}

/// Event that ended a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopKind {
    /// The drivers prescribe a position that the mechanism cannot reach (HP0401).
    Limit,
    /// The point of a joint reaches the end of the curve that it follows (HP0401).
    CurveEnd {
        /// The joint.
        joint: JointId,
    },
    /// A dead point or change point: beyond it the mechanism may take another branch (HP0402).
    BranchChange,
    /// The mechanism is open in the design configuration and cannot be closed (HP0406).
    DoesNotAssemble,
    /// Redundant constraints contradict each other there: the mechanism locks (HP0403).
    Locked {
        /// The joint whose constraint fails.
        joint: JointId,
        /// By how much, m or as a cosine.
        residual: f64,
        /// Quantity of the value.
        quantity: Quantity,
    },
    /// A driver's law has no finite value (HP0404).
    LawNotFinite {
        /// The driver.
        driver: DriverId,
    },
    /// The law of a load has no finite value (HP0404).
    LoadNotFinite {
        /// The force.
        force: ElementId,
    },
    /// A formula of the design has no finite value (HP0412).
    FormulaNotFinite {
        /// Index in [`Model::formulas`].
        formula: usize,
    },
    /// A driver moves farther between two output times than the solver follows (HP0408).
    TooFar {
        /// The driver.
        driver: DriverId,
    },
    /// A joint reaches its limit, which ends the motion (HP0268); or it is beyond the limit at the first output time
    /// (HP0267).
    JointLimit {
        /// Index in [`Model::joint_limits`].
        limit: usize,
        /// The end that is reached.
        end: LimitEnd,
        /// True if the motion begins beyond the limit.
        begins_beyond: bool,
    },
    /// The caller asked to stop (HP0405).
    Interrupted,
    /// No force resists a direction that gives (HP0421).
    NothingHolds {
        /// The direction.
        direction: GivingDirection,
    },
    /// Beyond a part of the loads at the first output time there is no equilibrium near by (HP0422).
    LimitLoad {
        /// The part, 0 to 1.
        part: f64,
    },
    /// Along the motion there is no further equilibrium near by (HP0423).
    NoEquilibrium,
    /// The equilibrium becomes unstable (HP0424).
    Unstable {
        /// The direction in which the mechanism moves away.
        direction: GivingDirection,
    },
    /// A direction is so stiff that round-off of the positions hides the other stiffnesses (HP0425).
    TooStiff {
        /// The direction.
        direction: GivingDirection,
    },
}

/// Direction in which a mechanism gives under load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GivingDirection {
    /// A coordinate of a joint, by its name.
    Joint(JointId, &'static str),
    /// A motion of the second body of a joint relative to the first, in several coordinates of the joint.
    JointMotion(JointId, AxisMotion),
    /// A motion, relative to ground, of a body that springs alone hold.
    Body(BodyId, AxisMotion),
    /// A released driver.
    Driver(DriverId),
}

/// A small motion about or along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMotion {
    /// Direction of the axis in ground, a unit vector of either sense.
    pub axis: Vec3,
    /// True if it is a rotation about the axis.
    pub rotates: bool,
    /// True if it is a translation along the axis.
    pub slides: bool,
    /// A named hardpoint on the axis of a rotation.
    pub through: Option<HardpointId>,
}

/// Components of a direction beside an axis that are not written: it is named by the axis.
const ALONG_AXIS: f64 = 5e-4;

impl AxisMotion {
    /// In words; `of` says whose axes x, y and z are.
    fn words(self, model: &Model, of: &str) -> String {
        let [x, y, z] = self.axis.to_array();
        let beside = [f64::hypot(y, z), f64::hypot(x, z), f64::hypot(x, y)];
        let axis = match beside.iter().position(|beside| *beside <= ALONG_AXIS) {
            Some(k) => format!("{of}{}", ["x", "y", "z"][k]),
            None => {
                // Of the two senses that with a positive largest component.
                let largest =
                    [x, y, z].into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
                // No zero is written as -0.
                let digits = |c: f64| (1e3 * c * largest.signum()).round() / 1e3 + 0.0;
                let [x, y, z] = [x, y, z].map(digits);
                format!("{of}direction [{x}, {y}, {z}]")
            }
        };
        let how = match (self.rotates, self.slides) {
            (true, true) => "about and along",
            (true, false) => "about",
            (false, _) => "along",
        };
        let through = self.through.map(|h| format!(" through `{}`", model.hardpoints[h.0].name));
        format!("{how} {axis}{}", through.unwrap_or_default())
    }
}

impl GivingDirection {
    /// In words, with the user's names.
    fn words(self, model: &Model) -> String {
        let along = |axis: &str| match axis.strip_prefix("about_") {
            Some(axis) => format!("about {axis}"),
            None => format!("along {axis}"),
        };
        match self {
            Self::Joint(joint, axis @ ("x" | "y" | "z" | "about_x" | "about_y" | "about_z")) => {
                format!("joint `{}` {}", model.joints[joint.0].name, along(axis))
            }
            Self::Joint(joint, coordinate) => {
                format!("the {coordinate} of joint `{}`", model.joints[joint.0].name)
            }
            Self::JointMotion(joint, motion) => {
                format!("joint `{}` {}", model.joints[joint.0].name, motion.words(model, "global "))
            }
            Self::Body(body, motion) => {
                format!("body `{}` {}", model.bodies[body.0].name, motion.words(model, ""))
            }
            Self::Driver(driver) => format!("driver `{}`", model.drivers[driver.0].name),
        }
    }
}

impl Stop {
    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self.kind {
            StopKind::Limit | StopKind::CurveEnd { .. } => "HP0401",
            StopKind::BranchChange => "HP0402",
            StopKind::Locked { .. } => "HP0403",
            StopKind::LawNotFinite { .. } | StopKind::LoadNotFinite { .. } => "HP0404",
            StopKind::FormulaNotFinite { .. } => "HP0412",
            StopKind::JointLimit { begins_beyond: true, .. } => "HP0267",
            StopKind::JointLimit { begins_beyond: false, .. } => "HP0268",
            StopKind::Interrupted => "HP0405",
            StopKind::DoesNotAssemble => "HP0406",
            StopKind::TooFar { .. } => "HP0408",
            StopKind::NothingHolds { .. } => "HP0421",
            StopKind::LimitLoad { .. } => "HP0422",
            StopKind::NoEquilibrium => "HP0423",
            StopKind::Unstable { .. } => "HP0424",
            StopKind::TooStiff { .. } => "HP0425",
        }
    }

    /// The headline.
    pub fn headline(&self, model: &Model) -> String {
        let t = with_digits(self.failed_time, TIME_DIGITS);
        if self.last_time.is_none() && matches!(self.kind, StopKind::Limit | StopKind::BranchChange) {
            return format!("the mechanism does not reach its start position at t = {t} s");
        }
        match self.kind {
            StopKind::Limit => format!("the mechanism cannot move beyond t = {t} s"),
            StopKind::CurveEnd { .. } => format!("{} at t = {t} s", self.happened(model)),
            StopKind::BranchChange => format!("the mechanism passes a dead point at t = {t} s"),
            StopKind::DoesNotAssemble => match self.remains.first() {
                Some(gap) => format!("the mechanism does not assemble: {} stays open", gap.of.name(model)),
                None => "the mechanism does not assemble".into(),
            },
            StopKind::Locked { joint, .. } if self.closed.is_some() => {
                format!(
                    "the mechanism does not assemble: joint `{}` cannot be closed with the others",
                    model.joints[joint.0].name
                )
            }
            StopKind::Locked { joint, .. } => {
                format!(
                    "the mechanism locks at t = {t} s: joint `{}` cannot stay closed",
                    model.joints[joint.0].name
                )
            }
            StopKind::LawNotFinite { driver } => {
                format!(
                    "the law of driver `{}` has no finite value at t = {t} s",
                    model.drivers[driver.0].name
                )
            }
            StopKind::LoadNotFinite { force } => {
                format!(
                    "the law of force `{}` has no finite value at t = {t} s",
                    model.elements[force.0].name
                )
            }
            StopKind::FormulaNotFinite { formula } => {
                format!(
                    "the expression for {} has no finite value in this design",
                    model.target_name(model.formulas[formula].of)
                )
            }
            StopKind::TooFar { driver } => {
                format!(
                    "driver `{}` moves too far between two output times to be followed, from t = {t} s on",
                    model.drivers[driver.0].name
                )
            }
            StopKind::JointLimit { .. } => {
                let at = if self.begins_beyond_limit() { "" } else { ", which ends the motion" };
                format!("{} at t = {t} s{at}", self.happened(model))
            }
            StopKind::Interrupted => format!("interrupted at t = {t} s"),
            StopKind::NothingHolds { direction } => format!("nothing holds {}", direction.words(model)),
            StopKind::LimitLoad { part } => {
                let part = with_digits(part, TIME_DIGITS);
                let snaps = self.in_words_if_it_snaps();
                format!("beyond {part} of the loads at t = {t} s there is no equilibrium near by{snaps}")
            }
            StopKind::NoEquilibrium => {
                let snaps = self.in_words_if_it_snaps();
                format!("beyond t = {t} s there is no equilibrium near by{snaps}")
            }
            StopKind::Unstable { direction } => {
                format!("the equilibrium becomes unstable at t = {t} s along {}", direction.words(model))
            }
            StopKind::TooStiff { direction } => format!(
                "the equilibrium cannot be solved: the stiffness of {} is too large beside the others",
                direction.words(model)
            ),
        }
    }

    /// End of a sentence about an equilibrium that ends.
    fn in_words_if_it_snaps(&self) -> &'static str {
        if self.snaps_through { ": the mechanism snaps through" } else { "" }
    }

    /// Description without the time, for events that are not at a time.
    pub fn happened(&self, model: &Model) -> String {
        match self.kind {
            StopKind::Limit => "the mechanism reaches a limit position".into(),
            StopKind::CurveEnd { joint } => {
                format!("the point of `{}` reaches the end of its curve", model.joints[joint.0].name)
            }
            StopKind::BranchChange => "the mechanism passes a dead point".into(),
            StopKind::Locked { joint, .. } if self.closed.is_none() => {
                format!("the mechanism locks: joint `{}` cannot stay closed", model.joints[joint.0].name)
            }
            StopKind::LawNotFinite { driver } => {
                format!("driver `{}` has no finite value", model.drivers[driver.0].name)
            }
            StopKind::LoadNotFinite { force } => {
                format!("the law of force `{}` has no finite value", model.elements[force.0].name)
            }
            StopKind::TooFar { driver } => {
                format!("driver `{}` moves too far to be followed", model.drivers[driver.0].name)
            }
            StopKind::JointLimit { limit, end, begins_beyond } => {
                let does = if begins_beyond { "is beyond" } else { "reaches" };
                format!("`{}` {does} its {}", model.joint_limits[limit].name, end.noun())
            }
            StopKind::Interrupted => "interrupted".into(),
            StopKind::NoEquilibrium => "there is no further equilibrium near by".into(),
            StopKind::Unstable { direction } => {
                format!("the equilibrium becomes unstable along {}", direction.words(model))
            }
            StopKind::NothingHolds { .. }
            | StopKind::LimitLoad { .. }
            | StopKind::TooStiff { .. }
            | StopKind::FormulaNotFinite { .. }
            | StopKind::DoesNotAssemble
            | StopKind::Locked { .. } => self.headline(model),
        }
    }

    /// True if the motion begins beyond the limit of a joint that ends it.
    fn begins_beyond_limit(&self) -> bool {
        matches!(self.kind, StopKind::JointLimit { begins_beyond: true, .. })
    }

    /// Returns true if the mechanism does not assemble because its design configuration is in or near a singular
    /// position, and no assembly was found around it.
    pub fn is_singular_drawing(&self) -> bool {
        self.closed.is_some_and(|part| part <= SINGULAR_DRAWING)
    }

    /// Suggested fix, if there is one.
    pub fn help(&self) -> Option<&'static str> {
        Some(match self.kind {
            StopKind::Limit => {
                "a limit position: shorten the sweep of the drivers, or move the hardpoints of these joints so that \
                 the loop reaches further"
            }
            StopKind::CurveEnd { .. } => {
                "extend the curve as far as the point moves, or shorten the sweep of the drivers"
            }
            StopKind::BranchChange => {
                "at a dead point the loop may continue on either of two branches and its velocities are not defined; \
                 write `at_change_points = \"continue\"` at the top of the model file if the motion continues smoothly, as in \
                 a parallelogram; or shorten the sweep, or drive another joint of the loop"
            }
            StopKind::Locked { .. } => {
                "the loop has redundant constraints that agree at the design configuration only; check that its axes \
                 are exactly parallel (or meet in one point), or give a joint more freedom"
            }
            StopKind::DoesNotAssemble if self.remains.is_empty() => {
                "its joints can be closed only where the loop is stretched or folded, and no motion is defined there: change \
                 a length or place a little, or draw the loop nearer to the assembly that you mean"
            }
            StopKind::DoesNotAssemble => {
                "change the lengths or places of these joints by at least what stays open, or give one of them more \
                 freedom"
            }
            StopKind::LawNotFinite { .. } | StopKind::LoadNotFinite { .. } => {
                "change the law, or end the run before that time"
            }
            StopKind::FormulaNotFinite { .. } => {
                "change the design less, or narrow the bounds of its variables: the expression divides by zero or takes a \
                 root of a negative number there"
            }
            StopKind::TooFar { .. } => {
                "the limit between two output times is 100,000 rad (about 16,000 turns), or 100,000 sizes of the mechanism: \
                 request more output times, or make the law slower"
            }
            StopKind::JointLimit { begins_beyond: true, .. } => {
                "begin the motion within the limit, or correct its `min` or `max`: coordinates count from the design \
                 configuration, but the length of a rod or leg is the whole length, and the articulation of a joint \
                 between two shafts the angle between them"
            }
            StopKind::JointLimit { begins_beyond: false, .. } => {
                "shorten the sweep of the drivers, or remove `stop = true` to follow the motion beyond the limit"
            }
            StopKind::Interrupted => return None,
            StopKind::NothingHolds { .. } => {
                "give the direction a stiffness, hold it with a driver that is not released, or make it rigid"
            }
            StopKind::LimitLoad { .. } | StopKind::NoEquilibrium => {
                "reduce the loads or shorten the sweep of the drivers, make the springs and elastic joints stiffer, or \
                 begin with the loads at zero and increase them over time to see how it gets there"
            }
            StopKind::Unstable { .. } => {
                "the forces push the mechanism away from its position: reduce them, or stiffen that direction"
            }
            StopKind::TooStiff { .. } => {
                "round-off of the positions times this stiffness is a force that hides those of the others: reduce it to a \
                 million times theirs at most, or make the direction rigid"
            }
        })
    }
}
