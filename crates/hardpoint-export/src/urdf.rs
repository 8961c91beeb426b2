//! URDF: the tree, mimic joints, loops as `loop_joint`.

use std::fmt::Write;

use hardpoint_file::ModelFile;

use crate::skeleton::{Skeleton, axis, followers, places};
use crate::{Exported, Format, escaped, numbers};

/// See the module.
pub const FORMAT: Format =
    Format { name: "urdf", about: "URDF robot description", endings: &["urdf"], write };

/// Types of joints, and what URDF calls them.
const TYPES: [(&str, &str); 4] =
    [("revolute", "continuous"), ("translational", "prismatic"), ("fixed", "fixed"), ("planar", "planar")];

fn write(file: &ModelFile, out: &mut Exported) {
    let model = &file.model;
    let tree = Skeleton::new(model, &TYPES.map(|(own, _)| own), out);
    let name = |body: usize| if body == 0 { "world".to_owned() } else { escaped(&model.bodies[body].name) };
    let mut text = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(&model.name));
    for &body in &tree.order {
        let _ = writeln!(text, "  <link name=\"{}\"/>", name(body));
    }
    let (follow, others) = followers(model);
    for &body in &tree.order {
        let Some(k) = tree.carrier[body] else { continue };
        let joint = &model.joints[k];
        let [i, j] = joint.bodies.map(|b| b.0);
        let kind =
            TYPES.iter().find(|(own, _)| *own == joint.kind.name).map_or("fixed", |(_, theirs)| theirs);
        let _ = writeln!(text, "  <joint name=\"{}\" type=\"{kind}\">", escaped(&joint.name));
        let _ = writeln!(text, "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>", name(i), name(j));
        let origin = places(model, joint)[0] - tree.origin(i);
        let _ = writeln!(text, "    <origin xyz=\"{}\"/>", numbers(origin.to_array()));
        if kind != "fixed" {
            let _ = writeln!(text, "    <axis xyz=\"{}\"/>", numbers(axis(joint).to_array()));
        }
        if kind == "prismatic" {
            // Required there; without limits of the model's own it says nothing.
            text += "    <limit lower=\"-1e9\" upper=\"1e9\" effort=\"1e9\" velocity=\"1e9\"/>\n";
        }
        for f in follow.iter().filter(|f| f.own == k) {
            let master = escaped(&model.joints[f.master].name);
            let _ = writeln!(text, "    <mimic joint=\"{master}\" multiplier=\"{}\"/>", f.factor);
        }
        text += "  </joint>\n";
    }
    for &k in &tree.loops {
        let joint = &model.joints[k];
        let kind = match joint.kind.name {
            "spherical" => "ball",
            other => TYPES.iter().find(|(own, _)| *own == other).map_or("", |(_, theirs)| *theirs),
        };
        if kind.is_empty() {
            out.unsaid(
                "joint",
                &joint.name,
                format!("URDF has nothing like a joint of type {}", joint.kind.name),
            );
            continue;
        }
        let _ = writeln!(text, "  <loop_joint name=\"{}\" type=\"{kind}\">", escaped(&joint.name));
        for (e, at) in places(model, joint).into_iter().enumerate() {
            let body = joint.bodies[e].0;
            let place = at - tree.origin(body);
            let _ = writeln!(
                text,
                "    <link{} link=\"{}\" xyz=\"{}\"/>",
                e + 1,
                name(body),
                numbers(place.to_array())
            );
        }
        let _ = writeln!(text, "    <axis xyz=\"{}\"/>\n  </loop_joint>", numbers(axis(joint).to_array()));
        out.unsaid(
            "joint",
            &joint.name,
            "it closes a loop: written as `loop_joint`, which not every program reads",
        );
    }
    let outside = follow.iter().filter(|f| !tree.carrier.contains(&Some(f.own))).map(|f| &f.name);
    for coupler in others.iter().chain(outside) {
        out.unsaid("coupler", coupler, "a mimic joint follows one other joint of the tree");
    }
    out.text = text + "</robot>\n";
    out.without_motions(file, "URDF");
}
