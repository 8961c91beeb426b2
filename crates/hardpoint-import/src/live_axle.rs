//! Live axles recognised by the names of their hardpoints: rods between the vehicle body and one rigid axle, a Panhard
//! rod or a Watt linkage, springs and dampers.

use std::collections::BTreeMap;

use hardpoint::space::Vec3;

use crate::axle;
use crate::corner::{Corner, Role, bump};
use crate::mechanism::{GROUND, Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::SIDES;
use crate::turn::X;

/// Words in the names of rods.
const RODS: [&str; 9] = ["link", "arm", "rod", "bar", "panhard", "track", "trackbar", "strut", "watts"];
/// Words in the names of members that only live axles have.
const OWN: [&str; 6] = ["panhard", "track_bar", "trackbar", "watts", "watt", "axle_tube"];
/// Suffixes of the ends of rods: on the vehicle, and on the axle or its lever.
const ENDS: [&[&str]; 2] = [
    &["frame", "chassis", "body", "inner", "inboard"],
    &["axle", "outer", "outboard", "lever", "crank", "bellcrank"],
];
/// Suffixes of ends of which the one nearer to the wheel is on the axle.
const LENGTHWISE: [&str; 2] = ["front", "rear"];
/// Suffixes of the pivot of a Watt linkage's lever.
const PIVOT: [&str; 3] = ["pivot", "centre", "center"];

/// Hardpoints of one side, or those without a side.
#[derive(Clone, Debug, Default)]
pub struct SideHardpoints {
    /// Hardpoints by their names in lower case.
    pub named: Vec<(String, Vec3)>,
}

/// Ends of a rod that have been read.
#[derive(Clone, Copy, Debug, Default)]
struct Rod {
    /// Ends on the vehicle and on the axle.
    ends: [Option<Vec3>; 2],
    /// Front and rear end.
    lengthwise: [Option<Vec3>; 2],
}

impl Rod {
    /// Returns the ends, that on the vehicle first; `centre` is the centre of the wheel or axle.
    fn places(&self, centre: Vec3) -> Option<[Vec3; 2]> {
        let from = |p: Vec3| (p.x - centre.x).abs();
        let [front, rear] = self.lengthwise;
        match self.ends {
            [Some(chassis), Some(axle)] => Some([chassis, axle]),
            [None, None] => {
                let (front, rear) = (front?, rear?);
                Some(if from(front) > from(rear) { [front, rear] } else { [rear, front] })
            }
            [Some(_), None] | [None, Some(_)] => None,
        }
    }
}

/// Splits a name into a member and the suffix of its end.
fn member(name: &str) -> Option<(&str, &str)> {
    let (member, end) = name.rsplit_once('_')?;
    let member = member.strip_suffix("_to").unwrap_or(member);
    member.split('_').any(|word| RODS.contains(&word) || word == "watt").then_some((member, end))
}

/// Returns true if the names are those of a live axle.
pub fn names_one(places: &[SideHardpoints; 3]) -> bool {
    let names = places.iter().flat_map(|p| &p.named);
    names.into_iter().any(|(name, _)| OWN.iter().any(|word| name.contains(word)))
}

/// Returns true if a leaf spring guides the axle.
pub fn has_leaf_springs(places: &[SideHardpoints; 3]) -> bool {
    let names = places.iter().flat_map(|p| &p.named);
    names
        .into_iter()
        .any(|(name, _)| ["leaf", "shackle", "spring_eye"].iter().any(|word| name.contains(word)))
}

/// Returns the rods of all sides by side and member, and the pivot of a Watt linkage.
fn rods(places: &[SideHardpoints; 3]) -> (BTreeMap<(usize, &str), Rod>, Option<Vec3>) {
    let mut rods: BTreeMap<(usize, &str), Rod> = BTreeMap::new();
    let mut pivot = None;
    for (k, side) in places.iter().enumerate() {
        for (name, place) in &side.named {
            let Some((member, end)) = member(name) else { continue };
            let slot = ENDS.iter().position(|words| words.contains(&end));
            let lengthwise = LENGTHWISE.iter().position(|word| *word == end);
            match (slot, lengthwise) {
                (Some(slot), _) => rods.entry((k, member)).or_default().ends[slot] = Some(*place),
                (None, Some(slot)) => rods.entry((k, member)).or_default().lengthwise[slot] = Some(*place),
                (None, None) if PIVOT.contains(&end) && is_watt(member) => pivot = Some(*place),
                (None, None) => {}
            }
        }
    }
    (rods, pivot)
}

/// Builds the axle from the hardpoints of the left and right side and those in between; `corners` are the known
/// hardpoints of both sides. Returns true if the rods leave the axle one or two degrees of freedom.
pub fn build(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    places: &[SideHardpoints; 3],
    corners: &[Corner; 2],
    at: Option<SourceSpan>,
) -> bool {
    let centre = |k: usize| corners[k].points.get(&Role::WheelCentre).copied();
    let (Some(left), Some(right)) = (centre(0), centre(1)) else { return false };
    let middle = (left + right) * 0.5;
    let (rods, pivot) = rods(places);
    let centres = [left, right, middle];
    let rods: Vec<(usize, &str, [Vec3; 2])> = rods
        .into_iter()
        .filter_map(|((k, member), rod)| Some((k, member, rod.places(centres[k])?)))
        .filter(|(.., [i, j])| i != j)
        .collect();
    let watt = rods.iter().filter(|(_, member, _)| is_watt(member)).count();
    let lever = pivot.filter(|_| watt == 2);
    // Both rods of a Watt linkage and its lever remove one degree of freedom.
    let held = rods.len() - if lever.is_some() { 1 } else { 0 };
    if !(4..=5).contains(&held) || (watt > 0 && lever.is_none()) {
        return false;
    }
    let axle = axle::body(m, "axle", middle);
    notes.taken("body", "axle", at);
    let lever = lever.map(|pivot| {
        let body = axle::body(m, "watt_lever", pivot);
        let of_lever = rods.iter().find(|(_, member, _)| is_watt(member));
        let normal = of_lever.and_then(|(.., [chassis, end])| (*chassis - *end).cross(*end - pivot).unit());
        let hinge = Joint::new("watt_pivot", String::new(), "revolute", [axle, body], pivot);
        m.joint(hinge.along(normal.unwrap_or_else(|| X.into())));
        notes.taken("joint", "watt_pivot", at);
        body
    });
    let suffixes = ["_left", "_right", ""];
    for (k, member, places) in &rods {
        let name = format!("{member}{}", suffixes[*k]);
        let carrier = lever.filter(|_| is_watt(member)).unwrap_or(axle);
        axle::rod(m, notes, &name, [GROUND, carrier], *places, at);
    }
    // Five rods leave one degree of freedom: both wheels move vertically together.
    let shared = (held == 5).then(|| {
        let why = "its five rods leave one degree of freedom: it heaves, but does not roll, since its bushings are not in the file";
        notes.approximated("axle", "axle", at, why);
        bump(m, notes, "", at, axle, middle)
    });
    for ((_, suffix), (corner, centre)) in SIDES.into_iter().zip(corners.iter().zip([left, right])) {
        let corner = Corner { suffix: suffix.into(), rack: false, bump: shared, at, ..corner.clone() };
        let ends = |roles: [Role; 2]| {
            let [top, bottom] = roles.map(|role| corner.points.get(&role).copied());
            top.zip(bottom).filter(|(top, bottom)| top != bottom).map(<[Vec3; 2]>::from)
        };
        let mut spring = None;
        for (draw, roles) in [
            ("damper", [Role::DamperChassis, Role::DamperMoving]),
            ("spring", [Role::SpringChassis, Role::SpringMoving]),
        ] {
            let Some(places) = ends(roles) else { continue };
            axle::leg(m, notes, &format!("{draw}{suffix}"), [GROUND, axle], places, draw, at);
            if draw == "spring" {
                spring = Some([(GROUND, places[0]), (axle, places[1])]);
            }
        }
        corner.wheel(m, notes, axle, centre, spring);
    }
    true
}

fn is_watt(member: &str) -> bool {
    member.split('_').any(|word| ["watt", "watts"].contains(&word))
}

/// Returns the names that are neither a known hardpoint of a suspension nor one of the two ends of a rod.
pub fn unplaced(places: &[SideHardpoints; 3], is_known: impl Fn(&str) -> bool) -> Vec<String> {
    let (rods, _) = rods(places);
    let mut out = Vec::new();
    for (k, side) in places.iter().enumerate() {
        for (name, _) in &side.named {
            let is_whole =
                |member| rods.get(&(k, member)).is_some_and(|rod| rod.places(Vec3::zero()).is_some());
            if !is_known(name) && !member(name).is_some_and(|(m, _)| is_whole(m)) && !out.contains(name) {
                out.push(name.clone());
            }
        }
    }
    out
}
