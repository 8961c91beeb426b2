//! MJCF: bodies in bodies, loops and couplers as equalities.

use std::fmt::Write;

use hardpoint_file::ModelFile;

use crate::skeleton::{Skeleton, axis, followers, places};
use crate::{Exported, Format, escaped, numbers};

/// See the module.
pub const FORMAT: Format = Format { name: "mjcf", about: "MuJoCo model", endings: &["xml", "mjcf"], write };

/// Types of joints, and what MJCF calls them; of one without a name its body has no joint.
const TYPES: [(&str, &str); 4] =
    [("revolute", "hinge"), ("translational", "slide"), ("spherical", "ball"), ("fixed", "")];

fn write(file: &ModelFile, out: &mut Exported) {
    let model = &file.model;
    let tree = Skeleton::new(model, &TYPES.map(|(own, _)| own), out);
    out.text = format!(
        "<mujoco model=\"{}\">\n  <compiler angle=\"radian\"/>\n  <worldbody>\n",
        escaped(&model.name)
    );
    inside(&tree, 0, 2, out);
    out.text += "  </worldbody>\n";
    let mut equalities = String::new();
    let body = |b: usize| if b == 0 { "world".to_owned() } else { escaped(&model.bodies[b].name) };
    for &k in &tree.loops {
        let joint = &model.joints[k];
        let [i, j] = joint.bodies.map(|b| b.0);
        let (element, place, why) = match joint.kind.name {
            "spherical" => ("connect", places(model, joint)[0] - tree.origin(i), None),
            "revolute" => {
                let why = "written as `connect`, which holds its place and not its axis: enough where the loop is plane";
                ("connect", places(model, joint)[0] - tree.origin(i), Some(why))
            }
            "fixed" => ("weld", places(model, joint)[1] - tree.origin(j), None),
            other => {
                out.unsaid(
                    "joint",
                    &joint.name,
                    format!("MJCF has nothing like a joint of type {other} that closes a loop"),
                );
                continue;
            }
        };
        if let Some(why) = why {
            out.unsaid("joint", &joint.name, why);
        }
        let _ = writeln!(
            equalities,
            "    <{element} name=\"{}\" body1=\"{}\" body2=\"{}\" anchor=\"{}\"/>",
            escaped(&joint.name),
            body(i),
            body(j),
            numbers(place.to_array())
        );
    }
    let (follow, others) = followers(model);
    for f in follow {
        let [own, master] = [f.own, f.master].map(|k| escaped(&model.joints[k].name));
        let _ = writeln!(
            equalities,
            "    <joint name=\"{}\" joint1=\"{own}\" joint2=\"{master}\" polycoef=\"0 {} 0 0 0\"/>",
            escaped(&f.name),
            f.factor
        );
    }
    for name in others {
        out.unsaid("coupler", &name, "an equality of MJCF is between two joints with one coordinate each");
    }
    if !equalities.is_empty() {
        let _ = write!(out.text, "  <equality>\n{equalities}  </equality>\n");
    }
    out.text += "</mujoco>\n";
    out.without_motions(file, "MJCF");
}

/// The bodies that a body carries.
fn inside(tree: &Skeleton<'_>, outer: usize, depth: usize, out: &mut Exported) {
    let indent = "  ".repeat(depth);
    for &body in &tree.order {
        let Some(k) = tree.carrier[body] else { continue };
        let joint = &tree.model.joints[k];
        if joint.bodies[0].0 != outer {
            continue;
        }
        let place = tree.origin(body) - tree.origin(outer);
        let name = escaped(&tree.model.bodies[body].name);
        let _ = writeln!(out.text, "{indent}<body name=\"{name}\" pos=\"{}\">", numbers(place.to_array()));
        let kind = TYPES.iter().find(|(own, _)| *own == joint.kind.name).map_or("", |(_, theirs)| theirs);
        let name = escaped(&joint.name);
        match kind {
            "" => {}
            "ball" => {
                let _ = writeln!(out.text, "{indent}  <joint name=\"{name}\" type=\"ball\"/>");
            }
            _ => {
                let axis = numbers(axis(joint).to_array());
                let _ =
                    writeln!(out.text, "{indent}  <joint name=\"{name}\" type=\"{kind}\" axis=\"{axis}\"/>");
            }
        }
        // A moving body has to have a mass.
        let _ = writeln!(out.text, "{indent}  <inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>");
        inside(tree, body, depth + 1, out);
        let _ = writeln!(out.text, "{indent}</body>");
    }
}
