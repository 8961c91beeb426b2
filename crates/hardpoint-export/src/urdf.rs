//! URDF: tree joints, couplers as mimic joints, loops as `loop_joint`.

use std::fmt::Write;

use hardpoint::joint::{Freedom, JointType};
use hardpoint::model::{Joint, Model};
use hardpoint_file::ModelFile;

use crate::contents::Target;
use crate::masses::{WrittenMass, entries, possible_masses};
use crate::skeleton::{Carrier, Follower, Skeleton, axis, bounded, ends, followers, joint_points, range_of};
use crate::{ExportedModel, Format, Writer, escaped, number, numbers};

/// URDF format.
pub const FORMAT: Format = Format {
    name: "urdf",
    about: "URDF robot description",
    endings: &["urdf"],
    write: Writer::Described(Target::Urdf, write),
};

/// Joint type of URDF with the same freedoms; a `ball` can close a loop only.
fn urdf_type(kind: &JointType) -> Option<&'static str> {
    match kind.freedoms.filter(|_| kind.tree_rows.is_empty())? {
        [Freedom::Turn(2)] => Some("continuous"),
        [Freedom::Slide(2)] => Some("prismatic"),
        [Freedom::Slide(0), Freedom::Slide(1), Freedom::Turn(2)] => Some("planar"),
        [Freedom::Ball] => Some(BALL),
        [] => Some("fixed"),
        _ => None,
    }
}

const BALL: &str = "ball";

fn write(file: &ModelFile, out: &mut ExportedModel) {
    let model = &file.model;
    let tree = Skeleton::new(
        model,
        |kind| urdf_type(kind).is_some_and(|name| name != BALL),
        |kind| urdf_type(kind).is_some(),
        out,
    );
    let mut text = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(&model.name));
    write_links(&mut text, &tree, out);
    let (follow, mut others) = followers(&tree);
    for &body in &tree.order {
        match tree.carrier[body] {
            Some(Carrier::Joint(k, backward)) => {
                let mut mimics = follow.iter().filter(|f| f.own == k);
                write_joint(&mut text, &tree, body, (k, backward), mimics.next());
                others.extend(mimics.map(|f| f.name.clone()));
            }
            Some(Carrier::Loops) => {
                let origin = numbers(tree.origin(body).to_array());
                let _ = writeln!(
                    text,
                    "  <joint name=\"{0}_floating\" type=\"floating\">\n    <parent link=\"world\"/>\n    <child link=\"{0}\"/>\n    \
                     <origin xyz=\"{origin}\"/>\n  </joint>",
                    link_name(model, body)
                );
            }
            None => {}
        }
    }
    for &k in &tree.loops {
        write_loop_joint(&mut text, &tree, &model.joints[k], out);
    }
    for limit in &model.joint_limits {
        let is_written =
            tree.is_carrier(limit.joint.0) && range_of(model, limit.joint.0, 0) == Some(ends(limit));
        if !is_written {
            out.report_unsupported("limit", &limit.name, "URDF limits the only coordinate of a tree joint");
        }
    }
    for coupler in &others {
        out.report_unsupported("coupler", coupler, "a mimic joint depends on one other tree joint");
    }
    out.text = text + "</robot>\n";
}

fn link_name(model: &Model, body: usize) -> String {
    if body == 0 { "world".to_owned() } else { escaped(&model.bodies[body].name) }
}

/// Writes the bodies with their masses.
fn write_links(text: &mut String, tree: &Skeleton<'_>, out: &mut ExportedModel) {
    let model = tree.model;
    let masses = possible_masses(model);
    for &body in &tree.order {
        let name = link_name(model, body);
        let Some(WrittenMass { mass, change }) = masses[body] else {
            let _ = writeln!(text, "  <link name=\"{name}\"/>");
            continue;
        };
        if let Some(why) = change {
            out.report_unsupported("mass", &model.bodies[body].name, why);
        }
        let centre = numbers((mass.centre - tree.origin(body)).to_array());
        let [xx, yy, zz, xy, xz, yz] = entries(&mass.inertia).map(number);
        let _ = writeln!(
            text,
            "  <link name=\"{name}\">\n    <inertial>\n      <origin xyz=\"{centre}\"/>\n      \
             <mass value=\"{}\"/>\n      \
             <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/>\n    \
             </inertial>\n  </link>",
            number(mass.mass)
        );
    }
}

/// Writes the tree joint that carries a body, with its limit and the joint whose coordinate it follows.
fn write_joint(
    text: &mut String,
    tree: &Skeleton<'_>,
    body: usize,
    (k, backward): (usize, bool),
    mimic: Option<&Follower>,
) {
    let model = tree.model;
    let joint = &model.joints[k];
    let outer = tree.outer(body);
    let kind = urdf_type(joint.kind).unwrap_or("fixed");
    let range = range_of(model, k, 0).filter(|_| ["continuous", "prismatic"].contains(&kind));
    let kind = if range.is_some() && kind == "continuous" { "revolute" } else { kind };
    let _ = writeln!(text, "  <joint name=\"{}\" type=\"{kind}\">", escaped(&joint.name));
    let _ = writeln!(
        text,
        "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>",
        link_name(model, outer),
        link_name(model, body)
    );
    let origin = tree.origin(body) - tree.origin(outer);
    let _ = writeln!(text, "    <origin xyz=\"{}\"/>", numbers(origin.to_array()));
    if kind != "fixed" {
        let axis = if backward { -axis(joint) } else { axis(joint) };
        let _ = writeln!(text, "    <axis xyz=\"{}\"/>", numbers(axis.to_array()));
    }
    if ["prismatic", "revolute"].contains(&kind) {
        // URDF requires a limit; where the model has none, it is not effective.
        let [lower, upper] = range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]).map(bounded);
        let _ = writeln!(
            text,
            "    <limit lower=\"{lower}\" upper=\"{upper}\" effort=\"1e9\" velocity=\"1e9\"/>"
        );
    }
    if let Some(f) = mimic {
        let master = escaped(&model.joints[f.master].name);
        let offset = if f.constant == 0.0 { String::new() } else { format!(" offset=\"{}\"", f.constant) };
        let _ = writeln!(text, "    <mimic joint=\"{master}\" multiplier=\"{}\"{offset}/>", f.factor);
    }
    *text += "  </joint>\n";
}

/// Writes a joint that closes a loop.
fn write_loop_joint(text: &mut String, tree: &Skeleton<'_>, joint: &Joint, out: &mut ExportedModel) {
    let Some(kind) = urdf_type(joint.kind) else {
        out.report_unsupported(
            "joint",
            &joint.name,
            format!("URDF has no equivalent of a joint of type {}", joint.kind.name),
        );
        return;
    };
    let _ = writeln!(text, "  <loop_joint name=\"{}\" type=\"{kind}\">", escaped(&joint.name));
    for (e, at) in joint_points(tree.model, joint).into_iter().enumerate() {
        let body = joint.bodies[e].0;
        let place = at - tree.origin(body);
        let _ = writeln!(
            text,
            "    <link{} link=\"{}\" xyz=\"{}\"/>",
            e + 1,
            link_name(tree.model, body),
            numbers(place.to_array())
        );
    }
    let _ = writeln!(text, "    <axis xyz=\"{}\"/>\n  </loop_joint>", numbers(axis(joint).to_array()));
    out.report_unsupported(
        "joint",
        &joint.name,
        "it closes a loop: written as `loop_joint`, which some programs do not read",
    );
}

#[cfg(test)]
mod tests {
    use hardpoint::joint::ALL;

    use super::*;

    #[test]
    fn joint_types_with_equivalents() {
        let found: Vec<_> = ALL.iter().filter_map(|t| Some((t.name, urdf_type(t)?))).collect();
        let expected = [
            ("fixed", "fixed"),
            ("revolute", "continuous"),
            ("translational", "prismatic"),
            ("spherical", BALL),
            ("planar", "planar"),
        ];
        assert_eq!(found, expected);
    }
}
