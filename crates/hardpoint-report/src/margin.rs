//! Margin of a motion to singular positions, in words.

use hardpoint::model::{Driver, JointId, Model};
use hardpoint::motion::{Motion, SingularityKind};
use hardpoint::topology::Topology;
use hardpoint_file::Units;
use serde::{Serialize, Serializer};

use crate::course::MarginCourse;
use crate::figures::{number, rounded, some_in_words, some_of, symbol};

/// Margin above which at most three digits of the velocities are lost, which needs no comment.
const COMFORTABLE: f64 = 1e-3;
/// Margin below which the user is warned.
const THIN: f64 = 1e-6;
/// Time to a singular position beyond the end, as a fraction of the run, below which it is reported.
const SOON: f64 = 0.1;

/// Margins over the output times: 1 is best, 0 is a singular position.
#[derive(Clone, Debug, Serialize)]
pub struct MarginFact {
    /// Minimum margin.
    pub least: f64,
    /// Time of the minimum margin, s.
    pub time: f64,
    /// Joints of the loop with the minimum margin.
    pub joints: Vec<String>,
    /// Number of digits of the velocities, of about 16, that are lost there.
    pub digits_lost: f64,
    /// Margin at the start of the motion.
    pub start: f64,
    /// Time after the last output time at which the motion would reach a singular position if it continued, s, if one
    /// is near.
    pub singular_after: Option<f64>,
    /// Travel of the drivers until then.
    pub drivers_until: Vec<DriverTravel>,
    /// Kind of the singular position: `limit`, where the loop cannot be closed any further, or `two_motions`, where two
    /// motions meet.
    #[serde(serialize_with = "kind")]
    pub singular_kind: Option<SingularityKind>,
    /// Margin at every output time, or at the stored ones of a long run (`steps.kept_every` of the summary).
    pub series: Vec<f64>,
    /// Duration from the first to the last output time, s.
    #[serde(skip)]
    span: f64,
}

/// Travel of a driver.
#[derive(Clone, Debug, Serialize)]
pub struct DriverTravel {
    /// The driver.
    pub driver: String,
    /// Travel, in `unit`.
    pub travel: f64,
    /// Unit of the travel.
    pub unit: String,
}

impl MarginFact {
    /// Margins of a motion; `None` if nothing was solved, or only single unknowns one after the other: the condition
    /// number of a single equation is always 1.
    pub fn new(
        model: &Model,
        units: Units,
        topology: &Topology,
        course: &MarginCourse,
        kept: &Motion,
    ) -> Option<Self> {
        if topology.blocks.iter().all(|b| b.unknowns.len() <= 1) {
            return None;
        }
        let (least, time) = course.least?;
        Some(Self {
            least: least.value,
            time,
            joints: named(model, &topology.joints_of_block(least.block)),
            digits_lost: -least.value.log10(),
            start: course.start?.value,
            singular_after: kept.beyond.as_ref().map(|b| b.after),
            drivers_until: kept.beyond.as_ref().map_or_else(Vec::new, |b| {
                let moving = model.drivers.iter().zip(&b.travel).filter(|(_, travel)| **travel != 0.0);
                let fact = |(driver, travel): (&Driver, &f64)| {
                    let quantity = model.driven(driver).quantity;
                    DriverTravel {
                        driver: driver.name.clone(),
                        travel: units.from_si(quantity, *travel),
                        unit: symbol(units, quantity).to_owned(),
                    }
                };
                moving.map(fact).collect()
            }),
            singular_kind: kept.beyond.as_ref().map(|b| b.kind),
            series: kept.margins.iter().map(|m| m.value).collect(),
            span: course.span[1] - course.span[0],
        })
    }

    /// True if velocities near the minimum margin are unreliable.
    pub fn is_thin(&self) -> bool {
        !(self.least >= THIN)
    }

    /// Minimum margin in words: `0.12 at least, at t = 0.35 s (pin, guide)`.
    pub fn line(&self) -> String {
        let joints = few(&self.joints);
        format!("{} at least, at t = {} s ({joints})", rounded(self.least, 2), number(self.time))
    }

    /// Margins at the start and at the minimum: `0.12 at the start, 0.05 at least, at ...`.
    pub fn line_from_start(&self) -> String {
        format!("{} at the start, {}", rounded(self.start, 2), self.line())
    }

    /// Sentence about the minimum margin.
    pub fn sentence(&self) -> String {
        let least = format!(
            "The minimum margin is {} at t = {} s, in the loop of {}",
            rounded(self.least, 2),
            number(self.time),
            some_in_words(&self.joints.iter().map(|j| format!("`{j}`")).collect::<Vec<_>>()),
        );
        let lost = match self.digits_lost.round() {
            _ if self.least <= 0.0 => "velocities are meaningless there".into(),
            n if n < 1.0 => "hardly a digit of the velocities is lost there".into(),
            n if n < 2.0 => "about one of 16 digits of the velocities is lost there".into(),
            n => format!("about {n} of 16 digits of the velocities are lost there"),
        };
        let how = match self.least {
            m if m >= COMFORTABLE => ", which is comfortable",
            m if m >= THIN => ", close to a singular position",
            _ => ", too close to a singular position to rely on them",
        };
        format!("{least}: {lost}{how}.{}", self.ahead().map_or(String::new(), |s| format!(" {s}.")))
    }

    /// Sentence about a singular position just beyond the end.
    pub fn ahead(&self) -> Option<String> {
        let after = self.singular_after.filter(|after| *after <= SOON * self.span)?;
        let drivers = self.drivers_until.iter();
        // This extrapolation from the end of the motion is accurate to about two digits.
        let travel = |d: &DriverTravel| format!("{} {}", rounded(d.travel, 2), d.unit).trim_end().to_owned();
        let drivers: Vec<String> = drivers.map(|d| format!("{} of `{}`", travel(d), d.driver)).collect();
        let what = match self.singular_kind? {
            SingularityKind::Limit => "its loop cannot be closed any further",
            SingularityKind::TwoMotions => "two motions meet there",
        };
        let until =
            if drivers.is_empty() { String::new() } else { format!(" ({})", some_of(&drivers, ", ")) };
        let after = rounded(after, 2);
        Some(format!("A singular position is estimated to lie about {after} s{until} beyond the end; {what}"))
    }
}

/// Name of a kind in the results.
fn kind<S: Serializer>(kind: &Option<SingularityKind>, to: S) -> Result<S::Ok, S::Error> {
    let name = kind.map(|kind| match kind {
        SingularityKind::Limit => "limit",
        SingularityKind::TwoMotions => "two_motions",
    });
    name.serialize(to)
}

/// Names on one line; of a long list the first few and the number of the others.
fn few(joints: &[String]) -> String {
    hardpoint::draft::some_of(joints, ", ", 4)
}

/// Names of joints that are written in the model file.
pub(crate) fn named(model: &Model, joints: &[JointId]) -> Vec<String> {
    // Joints that place bodies of an elastic mechanism are not in its model.
    let joints = joints.iter().filter_map(|j| model.joints.get(j.0));
    joints.filter(|j| !j.unnamed).map(|j| j.name.clone()).collect()
}
