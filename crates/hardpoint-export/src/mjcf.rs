//! MJCF: nested bodies, with loops, rods and couplers as equality constraints.

use std::fmt::Write;

use hardpoint::constraint::Row;
use hardpoint::joint::{Freedom, JointType};
use hardpoint::model::{JointLimit, Model};
use hardpoint::space::Vec3;
use hardpoint_file::ModelFile;

use crate::contents::Target;
use crate::masses::{WrittenMass, entries, positive_masses};
use crate::skeleton::{Carrier, Skeleton, axis, bounded, followers, is_closed, joint_points, range_of};
use crate::{ExportedModel, Format, Writer, escaped, number, numbers};

/// MJCF format.
pub const FORMAT: Format = Format {
    name: "mjcf",
    about: "MuJoCo model",
    endings: &["xml", "mjcf"],
    write: Writer::Described(Target::Mjcf, write),
};

/// Freedoms of a tree joint that a sequence of MJCF joints has as well: turns and slides, or a single ball.
fn freedoms(kind: &JointType) -> Option<&'static [Freedom]> {
    let freedoms =
        kind.freedoms.filter(|_| kind.places == 1 && kind.tree_rows.is_empty() && !kind.has_lead())?;
    (freedoms.len() < 2 || !freedoms.contains(&Freedom::Ball)).then_some(freedoms)
}

/// Constraint of MJCF that closes a loop.
enum Closure {
    Connect,
    Weld,
    /// Two connected points of an axis.
    Hinge,
    /// A tendon of fixed length.
    Rod,
}

impl Closure {
    /// Constraint for a cut joint of this type.
    fn of(kind: &JointType) -> Option<Self> {
        match kind.freedoms {
            Some([]) => Some(Self::Weld),
            Some([Freedom::Turn(2)]) => Some(Self::Hinge),
            Some(_) => kind.is_ball().then_some(Self::Connect),
            None => (kind.rows == [Row::Distance]).then_some(Self::Rod),
        }
    }
}

/// Distance between the two points of its axis at which a cut hinge is connected, as a fraction of the mechanism size.
const APART: f64 = 0.1;

/// Radius of gyration of a point mass, as a fraction of the mechanism size: MuJoCo requires positive moments.
const POINT: f64 = 1e-3;

/// Point of a body that an equality refers to.
struct Site {
    name: String,
    body: usize,
    at: Vec3,
}

fn write(file: &ModelFile, out: &mut ExportedModel) {
    let model = &file.model;
    let tree = Skeleton::new(model, |kind| freedoms(kind).is_some(), |kind| Closure::of(kind).is_some(), out);
    let mut sites = Vec::new();
    let (equalities, tendons) = loops(&tree, &mut sites, out);
    out.text = format!(
        "<mujoco model=\"{}\">\n  <compiler angle=\"radian\"/>\n  <option gravity=\"{}\"/>\n  <worldbody>\n",
        escaped(&model.name),
        // MuJoCo's default is that of the earth.
        numbers(model.gravity.to_array())
    );
    let masses = positive_masses(model, POINT * model.size());
    if !model.elements.iter().any(|e| e.kind.has_mass()) {
        let why = "the model has none: every body has a unit mass and inertia, to be replaced";
        out.report_unsupported("masses", &model.name, why);
    }
    inside(&tree, &sites, &masses, 0, 2, out);
    out.text += "  </worldbody>\n";
    if !tendons.is_empty() {
        let _ = write!(out.text, "  <tendon>\n{tendons}  </tendon>\n");
    }
    if !equalities.is_empty() {
        let _ = write!(out.text, "  <equality>\n{equalities}  </equality>\n");
    }
    out.text += "</mujoco>\n";
    unsupported_limits(&tree, out);
}

/// Writes the constraints that close loops and couple joints, and the tendons of rods.
fn loops(tree: &Skeleton<'_>, sites: &mut Vec<Site>, out: &mut ExportedModel) -> (String, String) {
    let model = tree.model;
    let (mut equalities, mut tendons) = (String::new(), String::new());
    let body = |b: usize| if b == 0 { "world".to_owned() } else { escaped(&model.bodies[b].name) };
    for &k in &tree.loops {
        let joint = &model.joints[k];
        let name = escaped(&joint.name);
        let [i, j] = joint.bodies.map(|b| b.0);
        let mut meet = |element: &str, name: &str, at: [Vec3; 2]| {
            let ends = if is_closed(model, joint) {
                // The anchor of a weld is in the frame of the second body.
                let anchor = if element == "weld" { at[1] - tree.origin(j) } else { at[0] - tree.origin(i) };
                format!(
                    "body1=\"{}\" body2=\"{}\" anchor=\"{}\"",
                    body(i),
                    body(j),
                    numbers(anchor.to_array())
                )
            } else {
                let [a, b] = site_at(sites, name, [i, j], at);
                format!("site1=\"{a}\" site2=\"{b}\"")
            };
            let _ = writeln!(equalities, "    <{element} name=\"{name}\" {ends}/>");
        };
        let at = joint_points(model, joint);
        match Closure::of(joint.kind) {
            Some(Closure::Connect) => meet("connect", &name, at),
            Some(Closure::Weld) => meet("weld", &name, at),
            Some(Closure::Hinge) => {
                let along = axis(joint) * (APART * model.size());
                meet("connect", &name, at);
                meet("connect", &format!("{name}_axis"), at.map(|p| p + along));
            }
            Some(Closure::Rod) => {
                let [a, b] = site_at(sites, &name, [i, j], at);
                let _ = writeln!(
                    tendons,
                    "    <spatial name=\"{name}\"><site site=\"{a}\"/><site site=\"{b}\"/></spatial>"
                );
                // The constant is the difference of the rod length from the distance in the design configuration.
                let nominal = (joint_points(model, joint)[1] - joint_points(model, joint)[0]).norm();
                let constant = joint.length.map_or(0.0, |length| length - nominal);
                let constant = if constant == 0.0 {
                    String::new()
                } else {
                    format!(" polycoef=\"{} 0 0 0 0\"", number(constant))
                };
                let _ = writeln!(equalities, "    <tendon name=\"{name}\" tendon1=\"{name}\"{constant}/>");
            }
            None => {
                let kind = joint.kind.name;
                let why = format!("MJCF has no equivalent of a joint of type {kind} that closes a loop");
                out.report_unsupported("joint", &joint.name, why);
            }
        }
    }
    let (follow, others) = followers(tree);
    for f in follow {
        let [own, master] = [f.own, f.master].map(|k| escaped(&model.joints[k].name));
        let _ = writeln!(
            equalities,
            "    <joint name=\"{}\" joint1=\"{own}\" joint2=\"{master}\" polycoef=\"{} {} 0 0 0\"/>",
            escaped(&f.name),
            f.constant,
            f.factor
        );
    }
    for name in others {
        out.report_unsupported(
            "coupler",
            &name,
            "an equality of MJCF couples two tree joints with a single coordinate each",
        );
    }
    (equalities, tendons)
}

/// Adds sites for the two points of a joint and returns their names.
fn site_at(sites: &mut Vec<Site>, joint: &str, bodies: [usize; 2], at: [Vec3; 2]) -> [String; 2] {
    [0, 1].map(|end| {
        let name = format!("{joint}_{}", ["i", "j"][end]);
        sites.push(Site { name: name.clone(), body: bodies[end], at: at[end] });
        name
    })
}

/// Writes the sites of a body, and the bodies that it carries.
fn inside(
    tree: &Skeleton<'_>,
    sites: &[Site],
    masses: &[WrittenMass],
    outer: usize,
    depth: usize,
    out: &mut ExportedModel,
) {
    let indent = "  ".repeat(depth);
    for site in sites.iter().filter(|s| s.body == outer) {
        let at = numbers((site.at - tree.origin(outer)).to_array());
        let _ = writeln!(out.text, "{indent}<site name=\"{}\" pos=\"{at}\"/>", site.name);
    }
    for &body in tree.order.iter().filter(|b| **b != 0 && tree.outer(**b) == outer) {
        let place = tree.origin(body) - tree.origin(outer);
        let name = escaped(&tree.model.bodies[body].name);
        let _ = writeln!(out.text, "{indent}<body name=\"{name}\" pos=\"{}\">", numbers(place.to_array()));
        match tree.carrier[body] {
            Some(Carrier::Joint(k, backward)) => joints(tree.model, k, backward, &indent, out),
            _ => {
                let _ = writeln!(out.text, "{indent}  <freejoint/>");
            }
        }
        // MuJoCo requires a mass of every moving body.
        let WrittenMass { mass, change } = masses[body];
        if let Some(why) = change {
            out.report_unsupported("mass", &tree.model.bodies[body].name, why);
        }
        let _ = writeln!(
            out.text,
            "{indent}  <inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{}\"/>",
            numbers((mass.centre - tree.origin(body)).to_array()),
            number(mass.mass),
            entries(&mass.inertia).map(number).join(" ")
        );
        inside(tree, sites, masses, body, depth + 1, out);
        let _ = writeln!(out.text, "{indent}</body>");
    }
}

/// Joint of MJCF: its type, axis of the marker, range, and the ending of its name.
type Part = (&'static str, Option<usize>, Option<[f64; 2]>, String);

/// Writes the MJCF joints of a body for its tree joint; `backward` if the body is body i of the joint.
fn joints(model: &Model, number: usize, backward: bool, indent: &str, out: &mut ExportedModel) {
    let joint = &model.joints[number];
    // The whole rotation of a ball, or the coordinate of a freedom.
    let range = |n: usize, freedom: &Freedom| match freedom {
        Freedom::Ball => {
            let mut of_joint = model.joint_limits.iter().filter(|limit| limit.joint.0 == number);
            let most = of_joint.find_map(|limit| limit.max.filter(|_| limits_rotation(model, limit)));
            most.map(|most| [0.0, most])
        }
        Freedom::Turn(_) | Freedom::Slide(_) => {
            let coordinate = joint.kind.coordinates.iter().position(|c| c.freedom == Some(n));
            coordinate.and_then(|c| range_of(model, number, c))
        }
    };
    let parts = freedoms(joint.kind).unwrap_or_default();
    let count = |is: fn(&Freedom) -> bool| parts.iter().filter(|f| is(f)).count();
    let slides = count(|f| matches!(f, Freedom::Slide(_)));
    let hinges = count(|f| matches!(f, Freedom::Turn(_)));
    let parts = parts.iter().enumerate().map(|(n, freedom)| {
        let (kind, along, ending) = match freedom {
            Freedom::Slide(k) if slides > 1 => ("slide", Some(*k), format!("_{}", ["x", "y", "z"][*k])),
            Freedom::Slide(k) => ("slide", Some(*k), "_slide".into()),
            Freedom::Turn(k) if hinges > 1 => ("hinge", Some(*k), format!("_{}", n + 1)),
            Freedom::Turn(k) => ("hinge", Some(*k), "_hinge".into()),
            Freedom::Ball => ("ball", None, String::new()),
        };
        (kind, along, range(n, freedom), ending)
    });
    let mut parts: Vec<Part> = parts.collect();
    if let [(.., ending)] = &mut parts[..] {
        ending.clear();
    }
    if backward {
        // Seen from body j, the order is reversed.
        parts.reverse();
    }
    for (kind, along, range, ending) in &parts {
        let name = escaped(&joint.name);
        let axis = along.map(|k| if k == 2 { axis(joint) } else { joint.frames[1].cols[k] });
        let axis = axis.map(|axis| if backward { -axis } else { axis });
        let axis = axis.map_or_else(String::new, |axis| format!(" axis=\"{}\"", numbers(axis.to_array())));
        let range = range.map_or_else(String::new, |range| {
            let [low, high] = range.map(bounded);
            format!(" limited=\"true\" range=\"{low} {high}\"")
        });
        let _ = writeln!(out.text, "{indent}  <joint name=\"{name}{ending}\" type=\"{kind}\"{axis}{range}/>");
    }
    if parts.len() > 1 {
        let why = format!("written as a chain of {} equivalent joints", parts.len());
        out.report_unsupported("joint", &joint.name, why);
    }
}

/// True if a limit is that of the whole rotation of a ball joint.
fn limits_rotation(model: &Model, limit: &JointLimit) -> bool {
    let own = model.measures[limit.measure].kind.tilting_joint();
    own.is_some_and(|joint| model.joints[joint.0].kind.is_ball())
}

/// Reports the limits of joints that are not written.
fn unsupported_limits(tree: &Skeleton<'_>, out: &mut ExportedModel) {
    let model = tree.model;
    for limit in &model.joint_limits {
        let (joint, kind) = (limit.joint.0, &model.joints[limit.joint.0].kind);
        let has_freedom = |c: usize| kind.coordinates[c].freedom.is_some() && freedoms(kind).is_some();
        let is_written = tree.is_carrier(joint)
            && match limit.coordinate {
                Some(coordinate) => has_freedom(coordinate),
                None => limits_rotation(model, limit) && limit.min.is_none(),
            };
        if !is_written {
            let why = "MJCF limits coordinates of tree joints, and the whole rotation of balls";
            out.report_unsupported("limit", &limit.name, why);
        }
    }
}

#[cfg(test)]
mod tests {
    use hardpoint::joint::ALL;

    use super::*;

    #[test]
    fn joint_types_with_equivalents() {
        let those = |is: &dyn Fn(&JointType) -> bool| -> Vec<&str> {
            ALL.iter().filter(|t| is(t)).map(|t| t.name).collect()
        };
        let carry = [
            "fixed",
            "revolute",
            "translational",
            "cylindrical",
            "spherical",
            "universal",
            "planar",
            "pin_in_slot",
        ];
        assert_eq!(those(&|t| freedoms(t).is_some()), carry);
        assert_eq!(those(&|t| Closure::of(t).is_some()), ["fixed", "revolute", "spherical", "distance"]);
    }
}
