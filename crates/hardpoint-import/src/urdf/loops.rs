//! What URDF has no element of its own for: joints that follow others, loops, floating links.

use hardpoint::space::{Pose, Vec3};
use roxmltree::Node;

use super::{Mimic, Reader, WITHOUT_AXIS, Written, pose};
use crate::markers::Called;
use crate::turn::{Z, home, roll_pitch_yaw};
use crate::xml;
use crate::xml::{attribute, attribute_at, child, children, named};

impl<'a, 'i> Reader<'a, 'i, '_> {
    /// What plugins of Gazebo say of joints that follow others: in `mimicJoint` the one that follows.
    pub(super) fn followers(&mut self, robot: Node<'a, 'i>, joints: &mut [Written<'a, 'i>]) {
        for node in named(robot, "gazebo").flat_map(|g| named(g, "plugin")) {
            let text = |key| Some(child(node, key)?.text()?.trim().to_owned());
            let Some(follows) = text("mimicJoint") else { continue };
            let master = text("joint").or_else(|| text("jointName")).unwrap_or_default();
            let at = xml::at(0, node);
            let [mut factor, mut offset] = [1.0, 0.0];
            for (key, to) in [("multiplier", &mut factor), ("offset", &mut offset)] {
                let Some(element) = child(node, key) else { continue };
                let what = format!("`{key}`");
                let words = element.text().unwrap_or_default();
                if let Some([x]) = xml::exactly::<1>(words, &what, xml::at(0, element), self.notes) {
                    *to = x;
                }
            }
            let is_there = joints.iter().any(|j| j.name == master);
            match joints.iter_mut().find(|j| j.name == follows) {
                Some(j) if is_there => {
                    // Most robots say it twice, for those that draw them and for those that simulate them.
                    j.mimic.get_or_insert(Mimic { node, joint: master, factor, offset });
                }
                _ => {
                    let why = format!(
                        "there are no joints `{follows}` and `{master}`, of which one follows the other"
                    );
                    self.notes.refused("plugin", node.attribute("name").unwrap_or_default(), at, why);
                }
            }
        }
    }

    pub(super) fn mimics(&mut self, joints: &[Written<'a, 'i>]) {
        for j in joints {
            let Some(mimic) = &j.mimic else { continue };
            let at = attribute_at(0, mimic.node, "joint").or_else(|| xml::at(0, mimic.node));
            match (self.joints.get(&j.name).copied(), self.joints.get(&mimic.joint).copied()) {
                (Some(own), Some(master)) if own != master => {
                    let note = Called { kind: "mimic of", name: &mimic.joint, at }.note(self.notes);
                    let terms = vec![(own, 1.0), (master, -mimic.factor)];
                    self.m.coupler(&format!("{}_mimic", j.name), note, terms);
                    self.notes.taken("mimic", &j.name, at);
                }
                _ if j.name != mimic.joint && self.names.contains(&mimic.joint) => {
                    let why = format!(
                        "`{}` or `{}`, which it follows, has no single coordinate",
                        j.name, mimic.joint
                    );
                    self.notes.refused("mimic", &j.name, at, why);
                }
                _ => {
                    let near =
                        hardpoint::draft::did_you_mean(&mimic.joint, self.names.iter().map(String::as_str));
                    let help = near
                        .map_or("name another joint of the robot".into(), |n| format!("did you mean `{n}`?"));
                    let message =
                        format!("`{}` follows the joint `{}`, which is not there", j.name, mimic.joint);
                    self.notes.problem_with("HP0803", at, message, &help);
                }
            }
        }
    }

    /// Joints that close loops: `loop_joint`, with the places on both links as in Drake and Isaac Sim, or like a joint; ball constraints
    /// of Drake; joints of SDF in a `gazebo` element; and frames that onshape-to-robot leaves where it cuts a loop.
    pub(super) fn loops(&mut self, robot: Node<'a, 'i>) {
        for node in named(robot, "loop_joint") {
            let Some(name) = self.name(node) else { continue };
            let kind = node.attribute("type").unwrap_or("continuous").trim().to_ascii_lowercase();
            let axis = self.axis(node, &kind);
            // Isaac Sim's documentation calls both of them `link1`.
            let links: Vec<_> =
                children(node).filter(|n| ["link1", "link2"].contains(&n.tag_name().name())).collect();
            let ends = match links[..] {
                [a, b] => [a, b].map(|end| {
                    let (body, outer) = self.standing(end, "link")?;
                    Some((body, outer.compose(pose(end, self.notes))))
                }),
                _ => self.ends(node),
            };
            if let [Some(i), Some(j)] = ends {
                // Directions are those of the first link.
                let j = (j.0, Pose { rot: i.1.rot, r: j.1.r });
                self.connect(node, &name, &kind, [i, j], axis);
            }
        }
        for (k, node) in named(robot, "ball_constraint").enumerate() {
            let ends = [
                ("ball_constraint_body_A", "ball_constraint_p_AP"),
                ("ball_constraint_body_B", "ball_constraint_p_BQ"),
            ];
            let ends = ends.map(|(body, place)| {
                let Some(named) = child(node, body) else {
                    let message = format!("the ball constraint has no `{body}`");
                    self.notes.problem_with("HP0803", xml::at(0, node), message, "name a link in it");
                    return None;
                };
                let (body, outer) = self.standing(named, "name")?;
                let place = child(node, place).and_then(|p| attribute::<3>(0, p, "value", self.notes));
                Some((body, Pose { rot: home().rot, r: outer.point(place.unwrap_or_default().into()) }))
            });
            if let [Some(i), Some(j)] = ends {
                self.connect(node, &format!("ball_constraint_{}", k + 1), "ball", [i, j], Z.into());
            }
        }
        for node in named(robot, "gazebo").flat_map(|g| named(g, "joint")) {
            let Some(name) = self.name(node) else { continue };
            let kind = node.attribute("type").unwrap_or_default().to_ascii_lowercase();
            let [Some(i), Some(j)] = self.ends(node) else { continue };
            let axis = child(node, "axis").and_then(|a| child(a, "xyz"));
            let at = axis.and_then(|a| xml::at(0, a));
            let given =
                axis.and_then(|a| xml::exactly::<3>(a.text().unwrap_or_default(), "`xyz`", at, self.notes));
            let axis = Vec3::from(given.unwrap_or(Z));
            if axis.unit().is_none() && !WITHOUT_AXIS.contains(&kind.as_str()) {
                let help = "give a vector other than zero";
                self.notes.problem_with("HP0804", at, "the axis has no direction", help);
                continue;
            }
            self.connect(node, &name, &kind, [(i.0, j.1), j], axis);
        }
        let cut: Vec<String> = self
            .links
            .keys()
            .filter(|n| n.starts_with("closing_"))
            .filter_map(|n| Some(n.strip_suffix("_1")?.to_owned()))
            .collect();
        for name in cut {
            let ends = ["1", "2"].map(|k| format!("{name}_{k}"));
            let found = ends.each_ref().map(|end| self.poses.get(end).copied());
            let ([Some(i), Some(j)], Some(&node)) = (found, self.links.get(&ends[0])) else { continue };
            let why =
                "a loop that onshape-to-robot has cut: its two frames are taken to meet in a ball joint";
            self.notes.approximated("loop", &name, xml::at(0, node), why);
            self.connect(node, &name, "ball", [i, j], Z.into());
        }
    }

    /// Floating links: those that loops hold are left to them, the others stand where they are drawn.
    pub(super) fn floating(&mut self) {
        for (name, node, bodies, place) in std::mem::take(&mut self.floating) {
            let at = xml::at(0, node);
            if self.m.are_connected(bodies) {
                let why = "no joint: the loops of the link hold it, and drivers what these leave free";
                self.notes.approximated("joint", &name, at, why);
                continue;
            }
            let why = "nothing holds its six freedoms in the source: it is fixed as drawn";
            self.notes.approximated("joint", &name, at, why);
            let note = Called { kind: "joint", name: &name, at }.note(self.notes);
            self.m.joint(crate::mechanism::Joint::new(&name, note, "fixed", bodies, place));
        }
    }

    /// The link that an attribute names, where it stands.
    fn standing(&mut self, node: Node<'a, 'i>, key: &str) -> Option<(usize, Pose)> {
        let link = node.attribute(key).unwrap_or_default().trim();
        let found = self.poses.get(link).copied();
        if found.is_none() {
            let at = attribute_at(0, node, key).or_else(|| xml::at(0, node));
            let message = format!("there is no link `{link}`");
            self.notes.problem_with("HP0803", at, message, "name a link of the robot");
        }
        found
    }

    /// The two ends of a joint that is written like others: on the child, or on the parent where `origin` is given.
    fn ends(&mut self, node: Node<'a, 'i>) -> [Option<(usize, Pose)>; 2] {
        let [parent, body] = ["parent", "child"]
            .map(|end| self.linked(node, end).and_then(|link| self.poses.get(&link).copied()));
        let (Some((i, outer)), Some((j, inner))) = (parent, body) else { return [None, None] };
        let on =
            |reader: &mut Self, key, outer: Pose| Some(outer.compose(pose(child(node, key)?, reader.notes)));
        if let (Some(a), Some(b)) = (on(self, "parent_origin", outer), on(self, "child_origin", inner)) {
            return [Some((i, a)), Some((j, b))];
        }
        let frame = match (child(node, "origin"), child(node, "pose")) {
            (Some(_), _) => outer.compose(self.origin(node)),
            (None, Some(p)) => {
                let text = p.text().unwrap_or_default();
                let n = xml::exactly::<6>(text, "`pose`", xml::at(0, p), self.notes).unwrap_or_default();
                inner.compose(Pose { rot: roll_pitch_yaw([n[3], n[4], n[5]]), r: [n[0], n[1], n[2]].into() })
            }
            _ => inner,
        };
        [Some((i, frame)), Some((j, frame))]
    }
}
