//! How far a motion stays from singular positions, in words.

use hardpoint::model::Model;
use hardpoint::motion::Motion;
use hardpoint::topology::Topology;
use serde::Serialize;

use crate::course::MarginCourse;
use crate::diagnose::named;
use crate::figures::{number, rounded, some_in_words};

/// Above this, no more than three digits of the velocities are lost and there is nothing to say.
const COMFORTABLE: f64 = 1e-3;
/// Below this the user is warned.
const THIN: f64 = 1e-6;
/// A singular position this near to the end, as part of the run, is told.
const SOON: f64 = 0.1;

/// Margins over the output times: 1 is best, 0 is a singular position.
#[derive(Clone, Debug, Serialize)]
pub struct MarginFact {
    /// The least of all.
    pub least: f64,
    /// Its time, s.
    pub time: f64,
    /// The joints of the loop that has it.
    pub joints: Vec<String>,
    /// How many of about 16 digits of the velocities are lost there.
    pub digits_lost: f64,
    /// Where the motion starts.
    pub start: f64,
    /// How long after the last output time the mechanism would be singular if the margin fell on as it does there, s.
    pub singular_after: Option<f64>,
    /// The margin at every output time; of very many, at those that were kept (`steps.kept_every` of the summary).
    pub series: Vec<f64>,
    /// First to last output time, s.
    #[serde(skip)]
    span: f64,
}

impl MarginFact {
    /// The margins of a motion; `None` where nothing was solved, or nothing but single unknowns, one after the other:
    /// a single equation's condition number is 1 however it stands.
    pub fn new(model: &Model, topology: &Topology, course: &MarginCourse, kept: &Motion) -> Option<Self> {
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
            singular_after: course.singular_after(),
            series: kept.margins.iter().map(|m| m.value).collect(),
            span: course.span[1] - course.span[0],
        })
    }

    /// Whether velocities near the least margin are not to be relied on.
    pub fn is_thin(&self) -> bool {
        !(self.least >= THIN)
    }

    /// `0.12 at least, at t = 0.35 s (pin, guide)`.
    pub fn line(&self) -> String {
        let joints = few(&self.joints);
        format!("{} at least, at t = {} s ({joints})", rounded(self.least, 2), number(self.time))
    }

    /// `0.12 at the start, 0.05 at least, at ...`.
    pub fn line_from_start(&self) -> String {
        format!("{} at the start, {}", rounded(self.start, 2), self.line())
    }

    /// What the least margin means.
    pub fn sentence(&self) -> String {
        let least = format!(
            "The least margin is {} at t = {} s, in the loop of {}",
            rounded(self.least, 2),
            number(self.time),
            some_in_words(&self.joints.iter().map(|j| format!("`{j}`")).collect::<Vec<_>>()),
        );
        let lost = match self.digits_lost.round() {
            _ if self.least <= 0.0 => "velocities mean nothing there".into(),
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

    /// Of a singular position just beyond the end.
    pub fn ahead(&self) -> Option<String> {
        let after = self.singular_after.filter(|after| *after <= SOON * self.span)?;
        let after = rounded(after, 2);
        Some(format!("Falling on like this, it would be 0, a singular position, {after} s after the end"))
    }
}

/// The names on one line; of many the first, and how many more there are.
fn few(joints: &[String]) -> String {
    const SHOWN: usize = 4;
    match joints.len().saturating_sub(SHOWN) {
        0 => joints.join(", "),
        more => format!("{} and {more} more", joints[..SHOWN].join(", ")),
    }
}
