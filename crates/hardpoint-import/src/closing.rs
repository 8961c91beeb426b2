//! Loops that a source leaves open: frames on two bodies that coincide, as named by the user or detected as a likely
//! pair.

use std::collections::BTreeSet;
use std::str::FromStr;

use crate::markers::{ElementSource, Marker, join};
use crate::mechanism::{Mechanism, NamedFrame};
use crate::report::ImportLog;
use crate::robot;
use crate::turn::home;

/// Joint types that can close a loop between two frames; all but the first two have an axis.
const TYPES: [&str; 6] = ["spherical", "fixed", "revolute", "cylindrical", "translational", "planar"];
/// Names of the axes of a frame.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Distance below which frames coincide, as a fraction of the mechanism size.
const SAME_PLACE: f64 = 1e-6;
/// Maximum number of reported pairs.
const MOST_NAMED: usize = 8;
/// Maximum number of frames that are searched for pairs.
const MOST_FRAMES: usize = 1000;
/// Words in the names of frames for loops.
const OF_LOOPS: [&str; 6] = ["loop", "clos", "cut", "weld", "constraint", "mate"];
/// Suffixes of the names of a pair.
const ENDS: [(&str, &str); 8] = [
    ("_1", "_2"),
    ("_a", "_b"),
    ("_A", "_B"),
    ("_i", "_j"),
    ("_parent", "_child"),
    ("_predecessor", "_successor"),
    ("1", "2"),
    ("A", "B"),
];

/// Joint that closes a loop between two frames: `A=B`, `A=B:revolute`, `A=B:revolute:x`, `A@0.2,0,0=B`.
#[derive(Clone, Debug, PartialEq)]
pub struct Closing {
    /// Names of the frames.
    pub frames: [String; 2],
    /// Points in these frames, relative to their origins along their axes, in the unit of the source.
    pub places: [[f64; 3]; 2],
    /// Joint type.
    pub kind: &'static str,
    /// Axis of the joint in the first frame: 0, 1, 2 for x, y, z.
    pub axis: usize,
}

impl FromStr for Closing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut rest = text.trim();
        let suffix = |rest: &mut &str, known: &[&'static str]| {
            let (before, last) = last_word(rest)?;
            let found = known.iter().position(|k| *k == last)?;
            *rest = before;
            Some(found)
        };
        let axis = suffix(&mut rest, &AXES);
        let kind = suffix(&mut rest, &TYPES);
        // `A=B:revolute:q`, whose last word is no axis
        let is_type = |word: &str| TYPES.contains(&word);
        let word_before_last = last_word(rest).and_then(|(before, _)| last_word(before));
        let is_understood = match kind {
            Some(_) => true,
            None => axis.is_none() && !word_before_last.is_some_and(|(_, word)| is_type(word)),
        };
        let ends = rest.split_once('=').map(|(a, b)| [a, b].map(end));
        let (Some([Some(a), Some(b)]), true) = (ends, is_understood) else {
            return Err(format!(
                "`{text}` does not name two frames: write `A=B`, `A=B:TYPE` with a type of {}, or `A=B:TYPE:AXIS` with x, y or z of frame A; \
                 a point in a frame follows its name, as in `A@0.2,0,0=B`",
                TYPES.join(", ")
            ));
        };
        let (frames, places) = ([a.0, b.0], [a.1, b.1]);
        Ok(Self { frames, places, kind: TYPES[kind.unwrap_or(0)], axis: axis.unwrap_or(2) })
    }
}

/// Splits a text at its last colon; names of frames in SDFormat may contain `::`.
fn last_word(text: &str) -> Option<(&str, &str)> {
    text.rsplit_once(':').filter(|(before, _)| !before.ends_with(':'))
}

/// Parses a frame and a point in it: `NAME`, or `NAME@x,y,z`.
fn end(text: &str) -> Option<(String, [f64; 3])> {
    let (name, place) = match text.rsplit_once('@') {
        Some((name, place)) => {
            let numbers: Option<Vec<f64>> = place.split(',').map(|x| x.trim().parse().ok()).collect();
            (name, <[f64; 3]>::try_from(numbers?).ok().filter(|p| p.iter().all(|x| x.is_finite()))?)
        }
        None => (text, [0.0; 3]),
    };
    Some((name.trim().to_owned(), place)).filter(|(name, _)| !name.is_empty())
}

/// Closes loops between frames named by the user.
pub fn close(m: &mut Mechanism, notes: &mut ImportLog, closings: &[Closing]) {
    for closing in closings {
        let ends = closing.frames.each_ref().map(|name| {
            let found = m.frames.iter().find(|f| f.name == *name).cloned();
            if found.is_none() {
                let near = hardpoint::draft::did_you_mean(name, m.frames.iter().map(|f| f.name.as_str()));
                let help = near.map_or_else(
                    || {
                        "use links of URDF, links and frames of SDFormat, or bodies and sites of MJCF"
                            .to_owned()
                    },
                    |near| format!("did you mean `{near}`?"),
                );
                notes.problem_with(
                    "HP0803",
                    None,
                    format!("the frame `{name}` for closing a loop does not exist"),
                    &help,
                );
            }
            found
        });
        let [Some(mut a), Some(mut b)] = ends else { continue };
        for (frame, place) in [&mut a, &mut b].into_iter().zip(closing.places) {
            frame.pose.r = frame.pose.point(place.into());
        }
        let name = format!("{}_{}", a.name, b.name);
        connect(m, notes, &name, closing.kind, closing.axis, [&a, &b]);
    }
}

fn connect(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    name: &str,
    kind: &'static str,
    axis: usize,
    ends: [&NamedFrame; 2],
) {
    let source = ElementSource { kind: "loop", name, at: None };
    if kind == "fixed" {
        let ends = ends.map(|f| Marker { body: f.body, pose: f.pose });
        robot::weld(m, notes, source, kind, ends);
        return;
    }
    let markers = ends.map(|f| match kind {
        "spherical" => {
            Some(Marker { body: f.body, pose: hardpoint::space::Pose { rot: home().rot, r: f.pose.r } })
        }
        _ => Marker::along(f.body, f.pose.r, f.pose.rot.cols[axis]),
    });
    if let [Some(i), Some(j)] = markers {
        join(m, notes, source, kind, [i, j]);
    }
}

/// Closes the loops cut by onshape-to-robot, which leaves two frames `closing_NAME_1` and `closing_NAME_2`.
pub fn close_cut_by_exporters(m: &mut Mechanism, notes: &mut ImportLog) {
    let cut = |f: &NamedFrame| {
        Some(f.name.rsplit("::").next()?.strip_prefix("closing_")?.strip_suffix("_1")?.to_owned())
    };
    let first: Vec<(NamedFrame, String)> =
        m.frames.iter().filter_map(|f| Some((f.clone(), cut(f)?))).collect();
    for (i, name) in first {
        let other = format!("{}_2", i.name.trim_end_matches("_1"));
        let Some(j) = m.frames.iter().find(|f| f.name == other).cloned() else { continue };
        let group = groups(m);
        if group[i.body] == group[j.body] || is_joined(m, [&i, &j], &group) {
            continue;
        }
        let name = format!("closing_{name}");
        let why = "loop cut by onshape-to-robot: its two frames are connected by a ball joint";
        notes.approximated("loop", &name, None, why);
        connect(m, notes, &name, "spherical", 2, [&i, &j]);
    }
}

/// Reports pairs of frames that are likely to be the two ends of a cut loop.
pub fn report_likely_pairs(m: &Mechanism, notes: &mut ImportLog) {
    let bare: Vec<&NamedFrame> = m.frames.iter().filter(|f| f.bare).take(MOST_FRAMES).collect();
    let group = groups(m);
    let near = SAME_PLACE * m.size();
    let mut named = BTreeSet::new();
    for (k, a) in bare.iter().enumerate() {
        for b in &bare[k + 1..] {
            let alike = are_a_pair(&a.name, &b.name);
            let coincide = (a.pose.r - b.pose.r).norm() <= near;
            if !(alike || coincide) || group[a.body] == group[b.body] || is_joined(m, [a, b], &group) {
                continue;
            }
            let bodies = [group[a.body].min(group[b.body]), group[a.body].max(group[b.body])];
            if !named.insert(bodies) {
                continue;
            }
            if named.len() > MOST_NAMED {
                return;
            }
            let why = if coincide { "coincide on two bodies" } else { "have matching names" };
            notes.remark(format!(
                "the frames `{0}` and `{1}` {why}: if a loop is cut here, `--close {0}={1}` closes it with a ball joint, \
                 `--close {0}={1}:revolute` with a hinge about z of `{0}`",
                a.name, b.name
            ));
        }
    }
}

/// Returns for each body the lowest index of the bodies fixed to it.
fn groups(m: &Mechanism) -> Vec<usize> {
    let mut group: Vec<usize> = (0..m.bodies.len()).collect();
    let find = |group: &[usize], mut b: usize| {
        while group[b] != b {
            b = group[b];
        }
        b
    };
    for joint in m.joints.iter().filter(|j| j.kind == "fixed") {
        let [a, b] = joint.bodies.map(|b| find(&group, b));
        group[a.max(b)] = a.min(b);
    }
    (0..group.len()).map(|b| find(&group, b)).collect()
}

/// Returns true if a joint connects the bodies of two frames at the origin of one of them.
fn is_joined(m: &Mechanism, [a, b]: [&NamedFrame; 2], group: &[usize]) -> bool {
    let near = SAME_PLACE * m.size();
    let pair = [group[a.body], group[b.body]];
    m.joints.iter().any(|j| {
        let [i, k] = j.bodies.map(|b| group[b]);
        let same = pair == [i, k] || pair == [k, i];
        same && j.at.iter().any(|at| [a, b].iter().any(|f| (*at - f.pose.r).norm() <= near))
    })
}

fn are_a_pair(a: &str, b: &str) -> bool {
    let lower = a.to_ascii_lowercase();
    OF_LOOPS.iter().any(|word| lower.contains(word))
        && ENDS.iter().any(|(x, y)| {
            let stems = |a: &str, b: &str| match (a.strip_suffix(x), b.strip_suffix(y)) {
                (Some(a), Some(b)) => a == b,
                _ => false,
            };
            stems(a, b) || stems(b, a)
        })
}
