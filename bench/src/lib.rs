//! Models to measure with: those of `models/`, read as a user's file is read, and generated ones of any size.

use hardpoint::Analysis;
use hardpoint::law::Law;
use hardpoint::motion::Execution;
use hardpoint::space::{Mat3, Pose, Vec3};
use hardpoint::{
    draft::{BodyDraft, DirectionDraft, Draft, DrivenDraft, FrameDraft, JointDraft, LocationDraft},
    model::Model,
};

pub mod designs;
pub mod floor;
pub mod workloads;

/// The model `models/NAME.toml`, or `bench/models/NAME.toml` where the gallery has none of that name.
///
/// # Panics
/// If it does not read, which its own tests exclude.
pub fn model(name: &str) -> Model {
    let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    if !std::fs::exists(&path).is_ok_and(|is_there| is_there) {
        return workload_model(name);
    }
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

fn body_at(name: String, x: f64, y: f64) -> BodyDraft {
    let pose = Pose { r: Vec3::new(x, y, 0.0), rot: Mat3::IDENTITY };
    BodyDraft { name, frame: FrameDraft::Pose(pose) }
}

fn flat([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

fn driven(name: String, joint: &str, law: &str, steps: usize) -> Draft {
    let law = Law::parse(law).expect("a law");
    Draft::new(name).driver("motor", joint, law).times((0..=steps).map(|k| k as f64 / 100.0))
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// N parallelograms side by side, each driven by the one before: N loops of two unknowns. Every body has its frame
/// in its middle.
pub fn chain(n: usize, steps: usize) -> Draft {
    let mut draft = driven(format!("chain of {n}"), "pivot0", "0.5*sin(2*pi*t)", steps);
    for k in 0..=n {
        let (x, bar, coupler) = (k as f64, format!("bar{k}"), format!("coupler{k}"));
        draft = draft.body(body_at(bar.clone(), x, 0.5)).revolute(
            format!("pivot{k}"),
            ["ground", &bar],
            flat([x, 0.0]),
            Z,
        );
        if k < n {
            let next = format!("bar{}", k + 1);
            draft = draft
                .body(body_at(coupler.clone(), x + 0.5, 1.0))
                .revolute(format!("left{k}"), [&bar, &coupler], flat([x, 1.0]), Z)
                .revolute(format!("right{k}"), [&coupler, &next], flat([x + 1.0, 1.0]), Z);
        }
    }
    draft
}

/// The chain of [`chain`] with that many design variables, at most one per loop and spread evenly: each moves one of
/// the pivots on the ground along x, which all loops from there on follow.
pub fn chain_with_variables(n: usize, variables: usize, steps: usize) -> Draft {
    let mut draft = chain(n, steps);
    for k in (0..variables).map(|v| v * n / variables) {
        let (name, pivot) = (format!("P{k}"), format!("pivot{k}"));
        let joint = draft.joints.iter_mut().find(|j| j.name == pivot).expect("a pivot of the chain");
        joint.at = vec![LocationDraft::Hardpoint(name.clone())];
        draft = draft.hardpoint(&name, [k as f64, 0.0, 0.0]).variable_moving(&name, &name, X);
    }
    draft
}

/// A generated model as a model file of eleven steps. All of its joints are at coordinates, and nothing in it has a
/// design variable.
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
        let place = |place: &LocationDraft| {
            let LocationDraft::At(at) = place else { unreachable!("joints are at coordinates") };
            format!("{:?}", at.to_array())
        };
        let at = match joint.at.as_slice() {
            [one] => place(one),
            more => format!("[{}]", more.iter().map(place).collect::<Vec<_>>().join(", ")),
        };
        let axis = match &joint.axis {
            Some(DirectionDraft::Along(u)) => format!(", axis = {:?}", u.to_array()),
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
        draft = draft
            .bodies([slider.as_str(), &node(k)])
            .translational(format!("x{k}"), ["ground", &slider], flat(at(k)), X)
            .translational(format!("y{k}"), [&slider, &node(k)], flat(at(k)), Y);
        for other in k.saturating_sub(2)..k {
            let name = format!("rod{other}_{k}");
            draft = draft.distance(name, [node(other), node(k)], [at(other), at(k)].map(flat));
        }
    }
    let tip = at(n - 1);
    let leg = JointDraft::new("push", "leg", ["ground", &node(n - 1)]);
    draft.joint(leg.at(flat([tip[0] + 0.3, tip[1] - 1.0])).at(flat(tip)))
}

/// The truss of [`truss`] with two design variables for each of its nodes but the first, along x and y, and its tip as
/// a point.
pub fn truss_with_variables(n: usize, steps: usize) -> Draft {
    let mut draft = truss(n, steps);
    let at = |k: usize| Vec3::new(0.5 * k as f64, 0.8 * (k % 2) as f64, 0.0);
    for k in 1..n {
        let name = format!("P{k}");
        for place in draft.joints.iter_mut().flat_map(|j| &mut j.at) {
            if *place == LocationDraft::At(at(k)) {
                *place = LocationDraft::Hardpoint(name.clone());
            }
        }
        draft = draft
            .variable_moving(format!("{name}.0"), &name, X)
            .variable_moving(format!("{name}.1"), &name, Y)
            .hardpoint(name, at(k));
    }
    draft.point("tip", format!("node{}", n - 1), format!("P{}", n - 1).as_str())
}

/// n x m scissors, pinned to each other at their corners, that open and close together; the first one is on the ground,
/// and the crossing of scissor `at` is driven.
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
            draft = draft
                .revolute(format!("cross{i}_{j}"), [&up, &down], flat(centre), Z)
                .bodies([up.as_str(), &down]);
        }
    }
    draft = draft.joint(JointDraft::new("base", "fixed", ["ground", "up0_0"]).at([0.0; 3]));
    for ((i, j), bars) in at_corner {
        for (k, bar) in bars.iter().enumerate().skip(1) {
            let name = format!("pin{i}_{j}_{k}");
            draft = draft.revolute(name, [&bars[0], bar], flat([i as f64, j as f64]), Z);
        }
    }
    draft
}
