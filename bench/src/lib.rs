//! Models to measure with: those of `models/`, read as a user's file is read, and generated ones of any size.

use hardpoint::Analysis;
use hardpoint::law::Law;
use hardpoint::motion::Execution;
use hardpoint::space::{Mat3, Pose, Vec3};
use hardpoint::{
    draft::{
        BodyDraft, ChangeDraft, Draft, DrivenDraft, DriverDraft, FrameDraft, HardpointDraft, JointDraft,
        Line, Place, PointDraft, VariableDraft,
    },
    model::Model,
};

pub mod designs;
pub mod floor;
pub mod workloads;

/// The model `models/NAME.toml`.
///
/// # Panics
/// If it does not read, which its own tests exclude.
pub fn model(name: &str) -> Model {
    let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    hardpoint_file::read(path.as_ref()).unwrap_or_else(|e| panic!("{e}")).model
}

/// The model `bench/models/NAME.toml`, of the comparison with other systems.
///
/// # Panics
/// If it does not read.
pub fn workload_model(name: &str) -> Model {
    hardpoint_file::parse(&workload_text(name), name).unwrap_or_else(|e| panic!("{e}")).model
}

/// An analysis, its steps solved as `HARDPOINT_PATH` asks for.
///
/// # Panics
/// If the model cannot be driven.
pub fn analysis(model: &Model) -> Analysis<'_> {
    let path = std::env::var("HARDPOINT_PATH").ok();
    let execution = path.and_then(|name| Execution::named(&name)).unwrap_or_default();
    Analysis::new(model).expect("a model that can be driven").executed(execution)
}

/// The text of `bench/models/NAME.toml`.
///
/// # Panics
/// If it cannot be read.
pub fn workload_text(name: &str) -> String {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn body(name: String) -> BodyDraft {
    BodyDraft { name, frame: FrameDraft::Default }
}

fn body_at(name: String, x: f64, y: f64) -> BodyDraft {
    let pose = Pose { r: Vec3::new(x, y, 0.0), rot: Mat3::IDENTITY };
    BodyDraft { name, frame: FrameDraft::Pose(pose) }
}

fn joint(name: String, kind: &str, bodies: [&str; 2], at: &[[f64; 2]], axis: Option<[f64; 3]>) -> JointDraft {
    JointDraft {
        name,
        kind: kind.into(),
        bodies: bodies.map(Into::into),
        at: at.iter().map(|&[x, y]| Place::At(Vec3::new(x, y, 0.0))).collect(),
        axis: axis.map(|a| Line::Along(a.into())),
        ..JointDraft::default()
    }
}

fn driven(name: String, joint: &str, law: &str, steps: usize) -> Draft {
    let law = Law::parse(law).expect("a law");
    let drives = DrivenDraft::Coordinate { joint: joint.into(), coordinate: None };
    let driver = DriverDraft { name: "motor".into(), drives, law };
    let times = (0..=steps).map(|k| k as f64 / 100.0).collect();
    Draft { name, drivers: vec![driver], times, ..Draft::default() }
}

const Z: Option<[f64; 3]> = Some([0.0, 0.0, 1.0]);

/// N parallelograms side by side, each driven by the one before: N loops of two unknowns. Every body has its frame
/// in its middle.
pub fn chain(n: usize, steps: usize) -> Draft {
    let mut draft = driven(format!("chain of {n}"), "pivot0", "0.5*sin(2*pi*t)", steps);
    for k in 0..=n {
        let (x, bar, coupler) = (k as f64, format!("bar{k}"), format!("coupler{k}"));
        draft.bodies.push(body_at(bar.clone(), x, 0.5));
        draft.joints.push(joint(format!("pivot{k}"), "revolute", ["ground", &bar], &[[x, 0.0]], Z));
        if k < n {
            draft.bodies.push(body_at(coupler.clone(), x + 0.5, 1.0));
            let next = format!("bar{}", k + 1);
            draft.joints.push(joint(format!("left{k}"), "revolute", [&bar, &coupler], &[[x, 1.0]], Z));
            draft.joints.push(joint(
                format!("right{k}"),
                "revolute",
                [&coupler, &next],
                &[[x + 1.0, 1.0]],
                Z,
            ));
        }
    }
    draft
}

/// The chain of [`chain`] with so many design variables, at most one per loop and spread evenly: each moves one of the
/// pivots on the ground along x, which all loops from there on follow.
pub fn chain_with_variables(n: usize, variables: usize, steps: usize) -> Draft {
    let mut draft = chain(n, steps);
    for k in (0..variables).map(|v| v * n / variables) {
        let (name, pivot) = (format!("P{k}"), format!("pivot{k}"));
        let joint = draft.joints.iter_mut().find(|j| j.name == pivot).expect("a pivot of the chain");
        joint.at = vec![Place::Hardpoint(name.clone())];
        let velocity = Vec3::new(1.0, 0.0, 0.0);
        draft.hardpoints.push(HardpointDraft { name: name.clone(), position: Vec3::new(k as f64, 0.0, 0.0) });
        let changes = vec![ChangeDraft::Move { hardpoint: name.clone(), velocity }];
        draft.design.push(VariableDraft { name, changes, ..VariableDraft::default() });
    }
    draft
}

/// A generated model as a model file of eleven steps. All of its joints are at coordinates, and nothing in it has a design variable.
pub fn text(draft: &Draft) -> String {
    let mut text = format!(
        "name = '{}'\nunits = {{ length = 'm', angle = 'rad' }}\ntime = {{ end = 0.1, steps = 10 }}\n[drivers]\n",
        draft.name
    );
    for driver in &draft.drivers {
        let DrivenDraft::Coordinate { joint, .. } = &driver.drives else { unreachable!("joints are driven") };
        text += &format!("{} = {{ joint = '{joint}', law = '{}' }}\n", driver.name, driver.law);
    }
    text += "[bodies]\n";
    for body in &draft.bodies {
        text += &format!("{} = {{}}\n", body.name);
    }
    text += "[joints]\n";
    for joint in &draft.joints {
        let place = |place: &Place| {
            let Place::At(at) = place else { unreachable!("joints are at coordinates") };
            format!("{:?}", at.to_array())
        };
        let at = match joint.at.as_slice() {
            [one] => place(one),
            more => format!("[{}]", more.iter().map(place).collect::<Vec<_>>().join(", ")),
        };
        let axis = match &joint.axis {
            Some(Line::Along(u)) => format!(", axis = {:?}", u.to_array()),
            _ => String::new(),
        };
        let (name, kind, [i, j]) = (&joint.name, &joint.kind, &joint.bodies);
        text += &format!("{name} = {{ type = '{kind}', bodies = ['{i}', '{j}'], at = {at}{axis} }}\n");
    }
    text
}

/// A truss of n nodes, each tied by rods to the two before, that turns about its first node while a leg
/// pushes at its last: one block of 2 (n - 1) unknowns, none of which can be found before the others.
pub fn truss(n: usize, steps: usize) -> Draft {
    let mut draft = driven(format!("truss of {n}"), "push", "0.02*sin(2*pi*t)", steps);
    let at = |k: usize| [0.5 * k as f64, 0.8 * (k % 2) as f64];
    let node = |k: usize| if k == 0 { "ground".to_owned() } else { format!("node{k}") };
    for k in 1..n {
        let slider = format!("slider{k}");
        draft.bodies.extend([slider.clone(), node(k)].map(body));
        let along = [Some([1.0, 0.0, 0.0]), Some([0.0, 1.0, 0.0])];
        let this = node(k);
        let (x, y) = (["ground", slider.as_str()], [slider.as_str(), this.as_str()]);
        draft.joints.push(joint(format!("x{k}"), "translational", x, &[at(k)], along[0]));
        draft.joints.push(joint(format!("y{k}"), "translational", y, &[at(k)], along[1]));
        for other in k.saturating_sub(2)..k {
            let ends = [node(other), node(k)];
            let ends = [ends[0].as_str(), ends[1].as_str()];
            draft.joints.push(joint(format!("rod{other}_{k}"), "distance", ends, &[at(other), at(k)], None));
        }
    }
    let tip = at(n - 1);
    let last = node(n - 1);
    draft.joints.push(joint(
        "push".into(),
        "leg",
        ["ground", &last],
        &[[tip[0] + 0.3, tip[1] - 1.0], tip],
        None,
    ));
    draft
}

/// The truss of [`truss`] with two design variables for each of its nodes but the first, along x and y, and its tip as a point.
pub fn truss_with_variables(n: usize, steps: usize) -> Draft {
    let mut draft = truss(n, steps);
    let at = |k: usize| Vec3::new(0.5 * k as f64, 0.8 * (k % 2) as f64, 0.0);
    for k in 1..n {
        let name = format!("P{k}");
        for place in draft.joints.iter_mut().flat_map(|j| &mut j.at) {
            if *place == Place::At(at(k)) {
                *place = Place::Hardpoint(name.clone());
            }
        }
        for axis in 0..2 {
            let changes = vec![ChangeDraft::Move { hardpoint: name.clone(), velocity: Vec3::AXES[axis] }];
            draft.design.push(VariableDraft {
                name: format!("{name}.{axis}"),
                changes,
                ..VariableDraft::default()
            });
        }
        draft.hardpoints.push(HardpointDraft { name, position: at(k) });
    }
    let tip = Place::Hardpoint(format!("P{}", n - 1));
    draft.points.push(PointDraft { name: "tip".into(), body: format!("node{}", n - 1), at: tip });
    draft
}

/// n x m scissors, pinned to each other at their corners, that open and close together; the first one stands on the ground, and
/// the crossing of scissor `at` is driven.
pub fn scissors(n: usize, m: usize, at: [usize; 2], steps: usize) -> Draft {
    let (name, crossing) = (format!("{n} x {m} scissors"), format!("cross{}_{}", at[0], at[1]));
    let mut draft = driven(name, &crossing, "0.3*sin(2*pi*t)", steps);
    // Bars rise or fall from left to right; those that end at a corner are pinned to the first of them there.
    let mut at_corner: std::collections::BTreeMap<(usize, usize), Vec<String>> = Default::default();
    for i in 0..n {
        for j in 0..m {
            let (up, down) = (format!("up{i}_{j}"), format!("down{i}_{j}"));
            for (corner, bar) in
                [((i, j), &up), ((i + 1, j + 1), &up), ((i, j + 1), &down), ((i + 1, j), &down)]
            {
                at_corner.entry(corner).or_default().push(bar.clone());
            }
            let centre = [i as f64 + 0.5, j as f64 + 0.5];
            draft.joints.push(joint(format!("cross{i}_{j}"), "revolute", [&up, &down], &[centre], Z));
            draft.bodies.extend([up, down].map(body));
        }
    }
    draft.joints.push(joint("base".into(), "fixed", ["ground", "up0_0"], &[[0.0, 0.0]], None));
    for ((i, j), bars) in at_corner {
        for (k, bar) in bars.iter().enumerate().skip(1) {
            let name = format!("pin{i}_{j}_{k}");
            draft.joints.push(joint(name, "revolute", [&bars[0], bar], &[[i as f64, j as f64]], Z));
        }
    }
    draft
}
