//! Completion of an imported mechanism: bodies without a connection to ground, and undriven motions.

use std::collections::HashSet;

use hardpoint::joint::JointType;
use hardpoint::model::JointId;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::Vec3;
use hardpoint::topology::TopologyError;
use hardpoint::{Analysis, Run};

use crate::mechanism::{Coordinate, Driver, Drives, ForceOn, GROUND, Joint, Law, Mechanism};
use hardpoint_file::Diagnostic;

use crate::report::ImportLog;
use crate::straighten::straighten;
use crate::turn::{X, Y, Z};
use crate::write;

/// Amplitude of the input of a mechanism with one degree of freedom: of an angle, rad.
const SWING: f64 = 0.2;
/// Amplitude of a displacement, as a fraction of the mechanism size.
const STROKE: f64 = 0.05;
/// Distance from an axis, as a fraction of the mechanism's size, below which a point does not move when the axis turns.
const OFF: f64 = 1e-6;
/// Number of intervals with which an input law is tried.
const TRIED: usize = 20;
/// Maximum number of output times at which the design variables are tested.
const MOST_TIMES: usize = 200;
/// Maximum number of undriven motions that are fixed; more are an error.
const MOST_HELD: usize = 400;

/// Connects loose bodies to ground, and fixes or drives undriven motions. Returns the remaining error, if any: the
/// model is written all the same, for the user to correct.
///
/// Open joints whose gaps are below `closed` times the mechanism size are closed in the design configuration if they
/// cannot be assembled.
pub fn finish(m: &mut Mechanism, notes: &mut ImportLog, closed: f64) -> Option<Diagnostic> {
    ground(m, notes);
    straighten_if_helpful(m, notes);
    let moves = m.drivers.iter().any(|d| !matches!(d.law, Law::Fixed | Law::Constant(_)));
    let mut left = match freedom(m, notes) {
        Ok(left) => left,
        Err(fault) => return Some(fault.diagnostic),
    };
    let only_one = left.count == 1 && !moves;
    if left.count > MOST_HELD {
        let message = format!("{} motions are undriven; at most {MOST_HELD} are fixed", left.count);
        let help = "remove parts that need not move from the source, or add drivers to the model";
        return Some(notes.diagnostic("HP0808", None, message).help(help));
    }
    let mut tried = HashSet::new();
    // Contradiction of other drivers that appeared once these motions were fixed.
    let mut conflict: Option<(Vec<Driver>, Diagnostic)> = None;
    while left.count > 0 {
        let Some(held) = candidates(m, &left).find(|held| !tried.contains(held)) else {
            if let Some((drivers, fault)) = conflict {
                report_fixed(m, notes, &drivers);
                m.drivers.extend(drivers);
                return Some(fault);
            }
            if let Some(fault) = left.singular {
                return Some(*fault);
            }
            let names: Vec<String> = left.joints.iter().map(|j| format!("`{}`", m.joints[*j].name)).collect();
            let message = format!("{} motions remain undriven: no driver was found for them", left.count);
            return Some(
                notes
                    .diagnostic("HP0808", None, message)
                    .note(format!("undriven joints: {}", names.join(", ")))
                    .help("add drivers for these joints to the model, or joints that constrain them"),
            );
        };
        tried.insert(held.clone());
        let before = m.drivers.len();
        for (name, drives) in held.drivers(m) {
            let why = format!("{}: fixed in the design configuration", undriven(m));
            m.driver(&format!("{name}_held"), why, drives, Law::Fixed);
        }
        match freedom(m, notes) {
            // The idle spin of a body is not counted as a degree of freedom until it is fixed.
            Ok(now)
                if now.count < left.count
                    || (now.count == left.count && now.joints.len() < left.joints.len()) =>
            {
                left = now;
                conflict = None;
                if !only_one {
                    report_fixed(m, notes, &m.drivers[before..]);
                }
            }
            found => {
                let fixed = m.drivers.split_off(before);
                let is_own = |name: &String| fixed.iter().any(|driver| driver.name == *name);
                if let Err(fault) = found
                    && conflict.is_none()
                    && !fault.drivers.is_empty()
                    && !fault.drivers.iter().any(is_own)
                {
                    conflict = Some((fixed, fault.diagnostic));
                }
            }
        }
    }
    close_as_nominal(m, notes, closed);
    if only_one {
        swing(m, notes);
    }
    remove_inadmissible(m, notes);
    None
}

/// Reports motions that drivers fix.
fn report_fixed(m: &Mechanism, notes: &mut ImportLog, drivers: &[Driver]) {
    for driver in drivers {
        let why = format!("{}: a driver fixes it in the design configuration", undriven(m));
        notes.approximated("motion", driver.name.trim_end_matches("_held"), None, why);
    }
}

/// Adds a remark if nothing moves: in a mechanism with all motions fixed, something is usually missing.
pub fn remark_undriven(m: &Mechanism, notes: &mut ImportLog, closes: bool) {
    let held = m.drivers.iter().filter(|d| d.law == Law::Fixed).count();
    let moves = m.drivers.iter().any(|d| !matches!(d.law, Law::Fixed | Law::Constant(_)));
    if moves || held == 0 {
        return;
    }
    let is_tree = m.joints.len() < m.bodies.len();
    let how = if closes { ": if it has loops, close them with `--close A=B`" } else { "" };
    let loops = if is_tree {
        format!("; the mechanism is a tree, without a closed loop{how}")
    } else {
        String::new()
    };
    let motions =
        if held == 1 { "its one motion is".to_owned() } else { format!("all of its {held} motions are") };
    let cause = match m.lost_motions {
        0 => "nothing in the source drives it",
        _ => "no imported motion drives it",
    };
    notes.remark(format!("{cause}: {motions} fixed in the design configuration{loops}"));
}

/// Returns the reason why a motion is undriven.
fn undriven(m: &Mechanism) -> &'static str {
    match m.lost_motions {
        0 => "nothing drives it in the source",
        _ => "no imported motion drives it",
    }
}

/// Closes open joints in the design configuration if the mechanism does not assemble, since undriven motions are fixed
/// there.
fn close_as_nominal(m: &mut Mechanism, notes: &mut ImportLog, closed: f64) {
    let is_open = |j: &Joint| j.length.is_some() || (j.at.len() > 1 && !j.is(JointType::is_rod));
    let gap = |j: &Joint| match j.at[..] {
        [a, b] if j.length.is_none() => (a - b).norm(),
        [a, b] => j.length.map_or(0.0, |l| (l - (a - b).norm()).abs()),
        _ => 0.0,
    };
    let largest = m.joints.iter().filter(|j| is_open(j)).map(gap).fold(0.0, f64::max);
    let turned = m.turned.iter().map(|frame| frame.angle).fold(0.0, f64::max);
    let few = largest <= closed * m.size() && turned <= closed;
    if (m.turned.is_empty() && !m.joints.iter().any(is_open)) || !few || assembles(m) {
        return;
    }
    let mut closed = m.clone();
    let mut names = Vec::new();
    for joint in closed.joints.iter_mut().filter(|j| is_open(j)) {
        names.push(format!("`{}`", joint.name));
        joint.length = None;
        if !joint.is(JointType::is_rod) {
            joint.at.drain(..1);
        }
    }
    for frame in &m.turned {
        names.push(format!("`{}`", m.joints[frame.joint].name));
        closed.drivers[frame.driver].law = Law::Fixed;
    }
    if assembles(&closed) {
        *m = closed;
        let why = format!(
            "they cannot be closed with the other motions fixed: their frames remain in the design configuration: {}",
            names.join(", ")
        );
        notes.approximated("joints", "", None, why);
    }
}

/// Returns true if the mechanism assembles at its first output time.
fn assembles(m: &Mechanism) -> bool {
    parsed(m).is_ok_and(|mut file| {
        file.model.times.truncate(1);
        Analysis::new(&file.model).is_ok_and(|a| a.solve(Run::new().without_sensitivities()).stop.is_none())
    })
}

/// Adds a point to observe if the source names none: on the last body of the longest chain of moving joints, at the
/// location farthest from the joint that carries it.
pub fn end_point(m: &mut Mechanism, notes: &mut ImportLog) {
    if !m.points.is_empty() || !m.wheels.is_empty() {
        return;
    }
    // For each body, the minimum number of moving joints between it and ground, and the joint that leads to it.
    let mut chains: Vec<Option<(usize, usize)>> = vec![None; m.bodies.len()];
    chains[GROUND] = Some((0, usize::MAX));
    let mut settled = false;
    while !settled {
        settled = true;
        for (k, joint) in m.joints.iter().enumerate() {
            let [i, j] = joint.bodies;
            for (from, to) in [(i, j), (j, i)] {
                let Some((length, _)) = chains[from] else { continue };
                let length = length + usize::from(!joint.is(|t| t.freedoms == Some(&[])));
                if chains[to].is_none_or(|(known, _)| length < known) {
                    chains[to] = Some((length, k));
                    settled = false;
                }
            }
        }
    }
    let ends =
        chains.iter().enumerate().filter_map(|(b, chain)| chain.map(|(length, joint)| (length, b, joint)));
    let longest =
        ends.filter(|(length, ..)| *length > 0).reduce(|best, end| if end.0 > best.0 { end } else { best });
    let Some((length, end, carrier)) = longest else { return };
    let place = |joint: &Joint| {
        let side = joint.bodies.iter().position(|b| *b == end)?;
        joint.at.get(side).or(joint.at.last()).copied()
    };
    let carried_by = &m.joints[carrier];
    let Some(carried) = place(carried_by) else { return };
    let others = m.joints.iter().filter_map(place).chain(m.bodies[end].pose.map(|p| p.r));
    let at = others
        .fold(carried, |best, at| if (at - carried).norm() > (best - carried).norm() { at } else { best });
    // A point on a body that rotates about ground has to be off the axis.
    let arm = carried_by.axis.map_or(at - carried, |axis| (at - carried).cross(axis));
    let slides = carried_by.is(JointType::slides);
    if length == 1 && !slides && arm.norm() <= OFF * m.size() {
        return;
    }
    m.point(&format!("{}_end", m.bodies[end].name), end, at);
    let why = "added: a point on the last body of the longest chain, to observe the motion";
    let name = m.points.last().map_or(String::new(), |p| p.name.clone());
    notes.approximated("point", &name, None, why);
}

/// Removes inadmissible design variables, such as a displacement of a hinge out of the plane of a planar loop.
fn remove_inadmissible(m: &mut Mechanism, notes: &mut ImportLog) {
    let Ok(mut file) = parsed(m) else { return };
    let times = &mut file.model.times;
    if times.len() > MOST_TIMES {
        let every = times.len().div_ceil(MOST_TIMES);
        *times = times.iter().copied().step_by(every).collect();
    }
    let Ok(analysis) = Analysis::new(&file.model) else { return };
    let found = analysis.solve(Run::new()).sensitivities.admissibility;
    let resists = |a: &Admissibility| matches!(a, Admissibility::CannotFollow { .. });
    let names =
        file.model.variables.iter().zip(&found).filter(|(_, a)| resists(a)).map(|(v, _)| v.name.clone());
    m.inadmissible = names.collect();
    if !m.inadmissible.is_empty() {
        let names: Vec<String> = m.inadmissible.iter().map(|n| format!("`{n}`")).collect();
        let why = format!("the mechanism cannot follow them, and they are not added: {}", names.join(", "));
        notes.approximated("design variables", "", None, why);
    }
}

/// Fixes to ground the bodies that no joint connects with it.
fn ground(m: &mut Mechanism, notes: &mut ImportLog) {
    // `root[b]`: the lowest index of the bodies that joints connect with `b`.
    let mut root: Vec<usize> = (0..m.bodies.len()).collect();
    fn find(root: &mut [usize], mut b: usize) -> usize {
        while root[b] != b {
            root[b] = root[root[b]];
            b = root[b];
        }
        b
    }
    for joint in &m.joints {
        let [a, b] = joint.bodies.map(|b| find(&mut root, b));
        root[a.max(b)] = a.min(b);
    }
    for b in 1..m.bodies.len() {
        if find(&mut root, b) != b {
            continue;
        }
        let body = &m.bodies[b];
        let first = m.joints.iter().find(|j| j.bodies.contains(&b)).and_then(|j| j.at.first().copied());
        let at = body.pose.map(|p| p.r).or(first).unwrap_or_else(|| Vec3::from([0.0; 3]));
        let name = body.name.clone();
        let mut held = |(body, _): &(usize, Vec3)| find(&mut root, *body) == b;
        let mut by_forces = m.forces.iter().filter_map(|force| match &force.on {
            ForceOn::Points(ends) | ForceOn::Bushing(ends, _) => Some(ends),
            ForceOn::Coordinate(_) | ForceOn::Joint(..) | ForceOn::Constant(..) => None,
        });
        let why = if by_forces.any(|ends| ends.iter().any(&mut held)) {
            "only forces hold it in the source: it is fixed to ground; without this joint, and with `[equilibrium]`, they \
             place it"
        } else {
            "nothing connects it to ground in the source: it is fixed to ground"
        };
        m.joint(Joint::new(&format!("{name}_fixed"), why.into(), "fixed", [GROUND, b], at));
        notes.approximated("body", &name, None, why);
    }
}

/// Makes nearly parallel axes in loops parallel if this lets the loops move.
fn straighten_if_helpful(m: &mut Mechanism, notes: &mut ImportLog) {
    let mut straight = m.clone();
    let Some(done) = straighten(&mut straight) else { return };
    let score = |m: &Mechanism| freedom(m, notes).ok().filter(|l| l.singular.is_none()).map(|l| l.count);
    if score(&straight) <= score(m) {
        return;
    }
    *m = straight;
    let names: Vec<String> = done.joints.iter().map(|n| format!("`{n}`")).collect();
    let why = format!(
        "rotated by up to {:.1e} rad to be parallel to other axes, since their loops could not move as written: {}",
        done.by,
        names.join(", ")
    );
    notes.approximated("axes", "", None, why);
}

/// Undriven motions.
#[derive(Default)]
struct FreeMotions {
    /// Number of undriven motions.
    count: usize,
    /// Joints that move.
    joints: Vec<usize>,
    /// Bodies that move.
    bodies: Vec<usize>,
    /// Diagnostic if the motions may exist in the design configuration only. Adding a driver shows whether they do,
    /// since special proportions look the same.
    singular: Option<Box<Diagnostic>>,
}

/// Reason why a mechanism cannot be driven, other than undriven motions.
struct FreedomError {
    diagnostic: Diagnostic,
    /// Names of the drivers that contradict each other, if that is the reason.
    drivers: Vec<String>,
}

/// Returns the undriven motions of a mechanism.
fn freedom(m: &Mechanism, notes: &ImportLog) -> Result<FreeMotions, Box<FreedomError>> {
    let refused = |message: String| {
        notes.diagnostic("HP0808", None, format!("the imported mechanism does not work: {message}"))
    };
    let failed = |message| Box::new(FreedomError { diagnostic: refused(message), drivers: Vec::new() });
    if m.bodies.len() == 1 {
        return Err(failed("it has no bodies".into()));
    }
    let file = parsed(m).map_err(failed)?;
    match Analysis::new(&file.model) {
        Ok(_) => Ok(FreeMotions::default()),
        Err(fault) => {
            let message = refused(format!("{fault}"));
            let message = fault.notes().into_iter().fold(message, |m, n| m.note(n));
            let diagnostic = Diagnostic { code: fault.code(), ..message }.help(fault.help());
            // Drivers of other quantities than joint coordinates are unnamed joints, after the named ones.
            let own =
                |joints: &[JointId]| joints.iter().map(|j| j.0).filter(|j| *j < m.joints.len()).collect();
            // The error quotes the names.
            let named = |names: &[String]| {
                let is = |b: &usize| names.iter().any(|n| n.trim_matches('`') == m.bodies[*b].name);
                (1..m.bodies.len()).filter(is).collect()
            };
            match &fault {
                TopologyError::UnderDriven { freedom, joints, bodies, .. } => Ok(FreeMotions {
                    count: *freedom,
                    joints: own(joints),
                    bodies: named(bodies),
                    singular: None,
                }),
                TopologyError::Singular { freedom, joints, bodies, .. } => Ok(FreeMotions {
                    count: *freedom,
                    joints: own(joints),
                    bodies: named(bodies),
                    singular: Some(Box::new(diagnostic)),
                }),
                TopologyError::OverDriven { drivers, .. } => {
                    let drivers = drivers.iter().map(|d| file.model.drivers[d.0].name.clone()).collect();
                    Err(Box::new(FreedomError { diagnostic, drivers }))
                }
                TopologyError::Immovable { .. } | TopologyError::ElasticLoop { .. } => {
                    Err(Box::new(FreedomError { diagnostic, drivers: Vec::new() }))
                }
            }
        }
    }
}

/// Parses the model without its meshes, which are separate files, and without limits of joints, which do not change
/// the motion.
fn parsed(m: &Mechanism) -> Result<hardpoint_file::ModelFile, String> {
    let mut bare = m.clone();
    bare.bodies.iter_mut().for_each(|b| b.mesh = None);
    bare.joints.iter_mut().for_each(|j| j.limits.clear());
    hardpoint_file::parse(&write::explicit(&bare, ""), "import").map_err(|d| {
        d.list()
            .first()
            .map_or(String::new(), |d| [std::slice::from_ref(&d.message), &d.notes[..]].concat().join("; "))
    })
}

/// Motion that drivers can fix; the first number is the index of the joint unless stated.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum FixableMotion {
    /// A joint coordinate.
    Coordinate(usize, &'static str),
    /// Several angles between the bodies of a joint, by their axes, fixed together: fixing one rotation of an idle body
    /// would leave the same number of degrees of freedom.
    Rotations(usize, &'static [usize]),
    /// One angle between the bodies of a joint, by its axis.
    Rotation(usize, usize),
    /// Displacement of the joint location on body j along an axis.
    Translation(usize, usize),
    /// Displacement of a body frame along an axis, by the index of the body, for bodies on rods only.
    BodyTranslation(usize, usize),
    /// Rotation of a body about an axis, by the index of the body.
    BodyRotation(usize, usize),
}

/// Names and directions of the global axes.
const AXES: [(&str, [f64; 3]); 3] = [("x", X), ("y", Y), ("z", Z)];

impl FixableMotion {
    /// Returns the names and quantities of the drivers that fix the motion.
    fn drivers(&self, m: &Mechanism) -> Vec<(String, Drives)> {
        let turn = |joint: usize, (letter, axis): (&str, [f64; 3])| {
            let j = &m.joints[joint];
            let drives = Drives::Rotation { body: j.bodies[1], about: axis.into(), relative_to: j.bodies[0] };
            (format!("{}_about_{letter}", j.name), drives)
        };
        match *self {
            Self::Coordinate(joint, name) => {
                let j = &m.joints[joint];
                let own =
                    if coordinates(j).len() == 1 { j.name.clone() } else { format!("{}_{name}", j.name) };
                vec![(own, Drives::Coordinate(Coordinate { joint, name }))]
            }
            Self::Rotations(joint, axes) => axes.iter().map(|k| turn(joint, AXES[*k])).collect(),
            Self::Rotation(joint, axis) => vec![turn(joint, AXES[axis])],
            Self::Translation(joint, axis) => {
                let j = &m.joints[joint];
                let at = j.at.last().copied().unwrap_or_else(|| Vec3::from([0.0; 3]));
                let drives = Drives::Translation { body: j.bodies[1], at, along: AXES[axis].1.into() };
                vec![(format!("{}_along_{}", m.bodies[j.bodies[1]].name, AXES[axis].0), drives)]
            }
            Self::BodyTranslation(body, axis) => {
                let at = m.bodies[body].pose.map_or_else(Vec3::zero, |p| p.r);
                let drives = Drives::Translation { body, at, along: AXES[axis].1.into() };
                vec![(format!("{}_along_{}", m.bodies[body].name, AXES[axis].0), drives)]
            }
            Self::BodyRotation(body, axis) => {
                let drives = Drives::Rotation { body, about: AXES[axis].1.into(), relative_to: GROUND };
                vec![(format!("{}_about_{}", m.bodies[body].name, AXES[axis].0), drives)]
            }
        }
    }
}

/// Returns the coordinates of a joint type.
fn coordinates(joint: &Joint) -> &'static [hardpoint::joint::CoordinateType] {
    joint.joint_type().map_or(&[], |t| t.coordinates)
}

/// All three axes, and the combinations that are fixed together.
const ALL_AXES: &[usize] = &[0, 1, 2];
const TOGETHER: [&[usize]; 4] = [ALL_AXES, &[0, 1], &[0, 2], &[1, 2]];

/// Motions that can be fixed, in order of preference: coordinates of the moving joints, then rotations and translations
/// of their bodies, then those of any body. A ball joint is fixed as a whole if possible, since the spin of a body
/// between two ball joints is not counted as a degree of freedom.
fn candidates<'m>(m: &'m Mechanism, left: &'m FreeMotions) -> impl Iterator<Item = FixableMotion> + 'm {
    let joints = &left.joints;
    let free = joints.iter().flat_map(move |&joint| {
        let constant = m.joints[joint].is(|t| t.is_rod() && !t.rows.is_empty());
        let all = coordinates(&m.joints[joint]).iter().filter(move |_| !constant);
        let open = all.filter(move |c| !m.is_driven(Coordinate { joint, name: c.name }));
        open.map(move |c| FixableMotion::Coordinate(joint, c.name))
    });
    let balls = joints.iter().filter(|j| left.count > 1 && m.joints[**j].is(JointType::is_ball));
    fn each(list: &[usize], held: fn(usize, usize) -> FixableMotion) -> impl Iterator<Item = FixableMotion> {
        list.iter().flat_map(move |&k| (0..AXES.len()).map(move |axis| held(k, axis)))
    }
    let together = joints.iter().flat_map(|&j| TOGETHER.map(|axes| FixableMotion::Rotations(j, axes)));
    let of_joints =
        each(joints, FixableMotion::Rotation).chain(together).chain(each(joints, FixableMotion::Translation));
    let of = |list: &[usize]| {
        each(list, FixableMotion::BodyTranslation)
            .chain(each(list, FixableMotion::BodyRotation))
            .collect::<Vec<_>>()
    };
    let others: Vec<usize> = (1..m.bodies.len()).filter(|b| !left.bodies.contains(b)).collect();
    let of_bodies = of(&left.bodies).into_iter().chain(of(&others));
    free.chain(balls.map(|j| FixableMotion::Rotations(*j, ALL_AXES))).chain(of_joints).chain(of_bodies)
}

/// Returns true if the mechanism moves from end to end in the first second.
pub fn moves(m: &Mechanism) -> bool {
    parsed(m).is_ok_and(|mut file| {
        file.model.times = (0..=TRIED).map(|k| k as f64 / TRIED as f64).collect();
        Analysis::new(&file.model).is_ok_and(|a| a.solve(Run::new().without_sensitivities()).stop.is_none())
    })
}

/// Makes the only degree of freedom the input: it oscillates as far as possible.
fn swing(m: &mut Mechanism, notes: &mut ImportLog) {
    let Some(driver) = m.drivers.len().checked_sub(1) else { return };
    let (name, cause) = (m.drivers[driver].name.clone(), undriven(m));
    let (is_angle, limits) = match m.drivers[driver].drives {
        Drives::Coordinate(c) => (c.name.starts_with("angle"), m.joints[c.joint].range_of(c.name)),
        Drives::Translation { .. } => (false, None),
        Drives::Rotation { .. } => (true, None),
    };
    let per_rad = if m.angle == "deg" { 180.0 / std::f64::consts::PI } else { 1.0 };
    let usual = if is_angle { SWING * per_rad } else { STROKE * m.size() };
    let wanted = match limits.map(|[low, high]| (-low, high)) {
        // In both directions, or in the only possible one.
        Some((down, up)) if down > 0.0 && up > 0.0 => vec![(usual.min(down).min(up), false)],
        Some((down, up)) if up > 0.0 && down <= 0.0 => vec![(usual.min(up), true)],
        Some((down, _)) if down > 0.0 => vec![(-usual.min(down), true)],
        _ => vec![(usual, false), (usual / 4.0, false), (usual / 4.0, true), (-usual / 4.0, true)],
    };
    for (amplitude, one_way) in wanted {
        let a = rounded(amplitude);
        let text = if one_way { format!("{a}*(1 - cos(2*pi*t))/2") } else { format!("{a}*sin(2*pi*t)") };
        let d = &mut m.drivers[driver];
        d.law = Law::Text(text.clone());
        d.note = format!("{cause}: as the only degree of freedom it is the input");
        if moves(m) {
            let why = format!("{cause}: as the only degree of freedom it is the input, law `{text}`");
            notes.approximated("motion", &name, None, why);
            let short = name.strip_suffix("_held").unwrap_or(&name).to_owned();
            m.drivers[driver].name = format!("{short}_input");
            return;
        }
    }
    let d = &mut m.drivers[driver];
    (d.law, d.note) = (Law::Fixed, format!("{cause}: fixed in the design configuration"));
    let why = format!("{cause}, and it cannot oscillate: a driver fixes it in the design configuration");
    notes.approximated("motion", &name, None, why);
}

/// Rounds to two digits, for readability.
pub fn rounded(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    format!("{x:.1e}").parse().unwrap_or(x)
}
