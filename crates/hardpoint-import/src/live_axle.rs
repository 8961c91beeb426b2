//! Live axles by the names of their hardpoints: rods between the body of the vehicle and one rigid axle, a Panhard rod
//! or a Watt linkage across, springs and dampers.

use std::collections::BTreeMap;

use hardpoint::space::Vec3;

use crate::axle;
use crate::corner::{Corner, Role, bump};
use crate::mechanism::{GROUND, Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::SIDES;
use crate::turn::X;

/// Words of members that are rods.
const RODS: [&str; 9] = ["link", "arm", "rod", "bar", "panhard", "track", "trackbar", "strut", "watts"];
/// Words of members that only a live axle has.
const OWN: [&str; 6] = ["panhard", "track_bar", "trackbar", "watts", "watt", "axle_tube"];
/// Words of the ends of rods: on the vehicle, on the axle or its lever.
const ENDS: [&[&str]; 2] = [
    &["frame", "chassis", "body", "inner", "inboard"],
    &["axle", "outer", "outboard", "lever", "crank", "bellcrank"],
];
/// Words of ends of which the one nearer to the wheel is on the axle.
const LENGTHWISE: [&str; 2] = ["front", "rear"];
/// Words of the pivot of a Watt linkage's lever.
const PIVOT: [&str; 3] = ["pivot", "centre", "center"];

/// The hardpoints of one side, or those without one.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// By their names in small letters.
    pub named: Vec<(String, Vec3)>,
}

/// A rod as its ends come.
#[derive(Clone, Copy, Debug, Default)]
struct Rod {
    /// On the vehicle and on the axle.
    ends: [Option<Vec3>; 2],
    /// In front and in the rear.
    lengthwise: [Option<Vec3>; 2],
}

impl Rod {
    /// Returns its ends, on the vehicle first; `centre` is that of the wheel, or of the axle.
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

/// Splits a name into a member and the word of its end.
fn member(name: &str) -> Option<(&str, &str)> {
    let (member, end) = name.rsplit_once('_')?;
    let member = member.strip_suffix("_to").unwrap_or(member);
    member.split('_').any(|word| RODS.contains(&word) || word == "watt").then_some((member, end))
}

/// Returns whether these names are those of a live axle.
pub fn names_one(places: &[Places; 3]) -> bool {
    let names = places.iter().flat_map(|p| &p.named);
    names.into_iter().any(|(name, _)| OWN.iter().any(|word| name.contains(word)))
}

/// Returns whether a leaf spring guides the axle.
pub fn has_leaf_springs(places: &[Places; 3]) -> bool {
    let names = places.iter().flat_map(|p| &p.named);
    names
        .into_iter()
        .any(|(name, _)| ["leaf", "shackle", "spring_eye"].iter().any(|word| name.contains(word)))
}

/// The rods of all sides by side and member, and the pivot of a Watt linkage.
fn rods(places: &[Places; 3]) -> (BTreeMap<(usize, &str), Rod>, Option<Vec3>) {
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

/// Builds the axle of the places of the left and right side and of those in between; `corners` are the known hardpoints
/// of both sides. Returns whether its rods leave it one or two freedoms.
pub fn build(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    places: &[Places; 3],
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
    // Both rods of a Watt linkage and its lever hold one freedom.
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
    // Five rods leave one freedom: both wheels go up and down together.
    let shared = (held == 5).then(|| {
        let why = "its five rods leave it one freedom: it goes up and down, and rolls in its bushings alone, which are not in the file";
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

/// Names that tell of no member: neither a place of a suspension that is known, nor one of two ends of a rod.
pub fn unplaced(places: &[Places; 3], is_known: impl Fn(&str) -> bool) -> Vec<String> {
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
