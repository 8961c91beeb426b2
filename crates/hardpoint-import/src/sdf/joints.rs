//! Joints of SDFormat: their axes, their relations, and Drake's extensions.

use std::collections::BTreeMap;

use hardpoint::space::{Pose, Vec3};
use roxmltree::Node;

use super::{Frame, Model, Reader, version};
use crate::markers::{
    ElementSource, Marker, MarkerJoint, carrying_joint, coordinate_sign, has_perpendicular_axes, join,
    join_by_hinges,
};
use crate::mechanism::{Coordinate, Mechanism};
use crate::turn::home;
use crate::xml::{Vocabulary, child, children, exactly, local, named};
use crate::{robot, xml};

/// Known content of a joint.
const JOINT: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    read: &[
        "parent",
        "child",
        "pose",
        "axis",
        "axis2",
        "thread_pitch",
        "screw_thread_pitch",
        "gearbox_ratio",
        "gearbox_reference_body",
    ],
    irrelevant: &["physics", "sensor"],
};
/// Known content of an axis.
const AXIS: Vocabulary = Vocabulary {
    attributes: &[],
    read: &[
        "xyz",
        "use_parent_model_frame",
        "limit",
        "dynamics",
        "mimic",
        "thread_pitch",
        "screw_thread_pitch",
    ],
    irrelevant: &[],
};
/// Known content of the elements of an axis.
const OF_AXES: [(&str, Vocabulary); 4] = [
    ("xyz", Vocabulary { attributes: &["expressed_in"], read: &[], irrelevant: &[] }),
    (
        "limit",
        Vocabulary {
            attributes: &[],
            read: &["lower", "upper"],
            irrelevant: &["effort", "velocity", "stiffness", "dissipation", "acceleration"],
        },
    ),
    (
        "dynamics",
        Vocabulary {
            attributes: &[],
            read: &["damping", "friction", "spring_reference", "spring_stiffness"],
            irrelevant: &[],
        },
    ),
    (
        "mimic",
        Vocabulary {
            attributes: &["joint", "axis", "multiplier", "offset", "reference"],
            read: &["multiplier", "offset", "reference"],
            irrelevant: &[],
        },
    ),
];

impl<'d> Reader<'d, '_> {
    fn end(&mut self, joint: Node<'d, 'd>, model: &Model<'d>, end: &'static str) -> Option<Frame> {
        let text = model.text;
        let element = child(joint, end);
        let name = element.and_then(|e| e.text()).unwrap_or_default().trim();
        let frame = self.frame(model, name);
        if frame.is_none() {
            let at = element.map_or_else(|| xml::at(text, joint), |e| xml::at(text, e));
            let message = match name {
                "" => format!("the joint has no `{end}`"),
                name => format!("the link or frame `{name}` does not exist"),
            };
            self.notes.problem_with("HP0803", at, message, "use a link, a frame, or `world`");
        }
        frame
    }

    /// Returns the axis of a joint, global.
    fn axis(&mut self, joint: Node<'d, 'd>, model: &Model<'d>, frame: Pose, key: &'static str) -> Vec3 {
        let text = model.text;
        let axis = child(joint, key);
        let xyz = axis.and_then(|a| child(a, "xyz"));
        let given = xyz
            .and_then(|x| exactly::<3>(x.text().unwrap_or_default(), "`xyz`", xml::at(text, x), self.notes));
        let v = Vec3::from(given.unwrap_or([0.0, 0.0, 1.0]));
        let of_model = axis.and_then(|a| child(a, "use_parent_model_frame")).and_then(|n| n.text());
        // Up to version 1.4, axes are in the model frame.
        let older = version(joint.document().root_element()).is_some_and(|v| v < (1, 5));
        let of_model = of_model.map_or(older, |t| ["1", "true"].contains(&t.trim()));
        let expressed = xyz.and_then(|x| x.attribute("expressed_in")).filter(|e| !e.is_empty());
        let rot = match expressed {
            Some(name) => match self.frame(model, name) {
                Some(frame) => frame.pose.rot,
                None => {
                    let at = xyz.and_then(|x| xml::at(text, x));
                    self.notes.problem_with(
                        "HP0803",
                        at,
                        format!("the frame `{name}` does not exist"),
                        "use a link, joint, frame or model of the file",
                    );
                    frame.rot
                }
            },
            None if of_model => model.place.rot,
            None => frame.rot,
        };
        if v.unit().is_none() {
            let at = xyz.and_then(|x| xml::at(text, x));
            self.notes.problem_with("HP0804", at, "the axis has no direction", "give a non-zero vector");
            return [0.0, 0.0, 1.0].into();
        }
        rot * v
    }

    pub(super) fn joint(&mut self, joint: Node<'d, 'd>, model: &Model<'d>) {
        let (text, scope) = (model.text, &model.scope);
        let name = self.name_of(text, joint);
        let at = xml::at(text, joint);
        let full = format!("{scope}{name}");
        if !self.names.insert(full.clone()) {
            let message = format!("the joint `{name}` is defined twice");
            self.notes.problem_with("HP0803", at, message, "rename one of them");
        }
        self.unknown_words(text, joint, &name);
        let ends = ["parent", "child"].map(|end| self.end(joint, model, end));
        let [Some(i), Some(j)] = ends else { return };
        let Some(frame) = self.frames.get(&format!("{scope}joint {name}")).map(|f| f.pose) else { return };
        let shown = self.shown(&full).to_owned();
        let source = ElementSource { kind: "joint", name: &shown, at };
        let kind = joint.attribute("type").unwrap_or_default().trim();
        let Some(type_name) = self.type_of(kind, &name, joint, text) else { return };
        let axis = if ["spherical", "fixed"].contains(&type_name) {
            frame.rot.cols[2]
        } else {
            self.axis(joint, model, frame, "axis")
        };
        let axis2 = if type_name == "universal" { self.axis(joint, model, frame, "axis2") } else { axis };
        let ends = [(i.body, axis), (j.body, axis2)].map(|(body, axis)| Marker::along(body, frame.r, axis));
        let [Some(i), Some(j)] = ends else { return };
        // The two hinges of `revolute2` may have any axes.
        let is_series = kind == "revolute2" && !has_perpendicular_axes([i, j]);
        let numbers = if is_series {
            join_by_hinges(&mut self.m, self.notes, source, [i, j])
        } else {
            join(&mut self.m, self.notes, source, type_name, [i, j]).map(|number| [number; 2])
        };
        let Some([number, last]) = numbers else { return };
        let second = if is_series { "angle" } else { "angle2" };
        let of_axes = match type_name {
            "revolute" | "screw" => vec![("axis", Coordinate { joint: number, name: "angle" })],
            "translational" => vec![("axis", Coordinate { joint: number, name: "displacement" })],
            "universal" => vec![
                ("axis", Coordinate { joint: number, name: "angle" }),
                ("axis2", Coordinate { joint: last, name: second }),
            ],
            _ => Vec::new(),
        };
        for &(key, of) in of_axes.iter().filter(|_| kind != "continuous") {
            if let Some(limit) = child(joint, key).and_then(|a| child(a, "limit")) {
                self.limit(limit, text, &shown, of);
            }
        }
        if type_name == "screw" {
            self.screw(joint, text, &name, number);
        }
        for key in ["axis", "axis2"] {
            let of_axis = of_axes.iter().find(|(of, _)| *of == key).map(|(_, coordinate)| *coordinate);
            let is_single = type_name != "universal" || is_series;
            self.dynamics(joint, key, text, &shown, of_axis.filter(|_| is_single));
        }
        if !is_series {
            self.joints.insert(full, MarkerJoint { number, kind: type_name, markers: [i, j] });
        }
    }

    /// Reports unknown content of a joint, its poses and its axes.
    fn unknown_words(&mut self, text: usize, joint: Node<'d, 'd>, name: &str) {
        xml::unknown(text, joint, name, JOINT, self.notes);
        self.poses_of(text, joint, name);
        for axis in children(joint).filter(|c| ["axis", "axis2"].contains(&local(*c))) {
            xml::unknown(text, axis, name, AXIS, self.notes);
            for (part, words) in OF_AXES {
                named(axis, part).for_each(|part| xml::unknown(text, part, name, words, self.notes));
            }
        }
    }

    /// Returns the joint type of the model for a type of SDFormat. HP0805: an unknown type. A gearbox is no joint.
    fn type_of(&mut self, kind: &str, name: &str, joint: Node<'d, 'd>, text: usize) -> Option<&'static str> {
        Some(match kind {
            "revolute" | "continuous" => "revolute",
            "prismatic" => "translational",
            "ball" => "spherical",
            "fixed" => "fixed",
            "screw" => "screw",
            "universal" | "revolute2" => "universal",
            // Drake's extension.
            "planar" => "planar",
            "gearbox" => return None,
            _ => {
                let at = xml::attribute_at(text, joint, "type").or(xml::at(text, joint));
                let help = "use revolute, continuous, prismatic, ball, universal, revolute2, screw, gearbox or fixed";
                self.notes.problem_with(
                    "HP0805",
                    at,
                    format!("`{name}` is of the unknown type `{kind}`"),
                    help,
                );
                return None;
            }
        })
    }

    /// Reads the limits of a coordinate.
    fn limit(&mut self, limit: Node<'d, 'd>, text: usize, shown: &str, of: Coordinate) {
        let open = [("lower", f64::NEG_INFINITY), ("upper", f64::INFINITY)];
        let [low, high] = open.map(|(key, open)| {
            let Some(n) = child(limit, key) else { return Some(open) };
            xml::bound(n.text().unwrap_or_default(), &format!("`{key}`"), xml::at(text, n), self.notes)
        });
        if let Some(range) = low.zip(high).and_then(|(low, high)| xml::range(low, high))
            && let Err(why) = self.m.joints[of.joint].limit(of.name, range)
        {
            self.notes.refused("limit", shown, xml::at(text, limit), why);
        }
    }

    /// Reads the lead of a screw, which SDFormat calls pitch.
    fn screw(&mut self, joint: Node<'d, 'd>, text: usize, name: &str, number: usize) {
        let at = xml::at(text, joint);
        let number_of = |reader: &mut Self, key: &'static str| {
            let n = pitch_of(joint, key)?;
            exactly::<1>(n.text().unwrap_or_default(), key, xml::at(text, n), reader.notes).map(|[x]| x)
        };
        let own = number_of(self, "screw_thread_pitch");
        // The older key is in rad per length, with the opposite sign.
        let older = number_of(self, "thread_pitch").filter(|p| *p != 0.0).map(|p| -std::f64::consts::TAU / p);
        let is_given =
            ["screw_thread_pitch", "thread_pitch"].into_iter().any(|key| pitch_of(joint, key).is_some());
        match own.or(older).filter(|p| *p != 0.0) {
            Some(lead) => self.m.joints[number].lead = Some(lead),
            None if !is_given => {
                let why = "it has no pitch: the default of SDFormat, 1 m per turn, is used";
                self.notes.approximated("screw_thread_pitch", name, at, why);
                self.m.joints[number].lead = Some(1.0);
            }
            None => self.notes.problem_with(
                "HP0804",
                at,
                format!("the pitch of the screw `{name}` is zero"),
                "give it a non-zero `screw_thread_pitch`",
            ),
        }
    }

    /// Adds the spring and damper of an axis of a joint.
    fn dynamics(
        &mut self,
        joint: Node<'d, 'd>,
        axis: &'static str,
        text: usize,
        name: &str,
        coordinate: Option<Coordinate>,
    ) {
        if let Some(dynamics) = child(joint, axis).and_then(|axis| child(axis, "dynamics")) {
            let at = xml::at(text, dynamics);
            let [stiffness, damping, free, friction] =
                ["spring_stiffness", "damping", "spring_reference", "friction"].map(|key| {
                    let Some(n) = child(dynamics, key) else { return 0.0 };
                    let words = n.text().unwrap_or_default();
                    let found = exactly::<1>(words, &format!("`{key}`"), xml::at(text, n), self.notes);
                    let [x] = found.unwrap_or_default();
                    x
                });
            let source = ElementSource { kind: "spring", name, at };
            robot::joint_spring(&mut self.m, self.notes, source, coordinate, [stiffness, damping, free]);
            robot::friction(self.notes, name, at, friction);
        }
    }

    /// Reads the relations of a joint to others: `mimic` and gearboxes.
    pub(super) fn relation(&mut self, joint: Node<'d, 'd>, model: &Model<'d>) {
        let (text, scope) = (model.text, &model.scope);
        let name = joint.attribute("name").unwrap_or_default().trim();
        let full = format!("{scope}{name}");
        let shown = self.shown(&full).to_owned();
        let number = |reader: &mut Self, node: Node<'d, 'd>, key: &'static str| {
            if node.has_attribute(key) {
                // Drake's notation.
                return xml::attribute::<1>(text, node, key, reader.notes).map(|[x]| x);
            }
            let n = child(node, key)?;
            exactly::<1>(n.text().unwrap_or_default(), key, xml::at(text, n), reader.notes).map(|[x]| x)
        };
        let axes = ["axis", "axis2"].into_iter().filter_map(|key| child(joint, key));
        for mimic in axes.filter_map(|axis| child(axis, "mimic")) {
            let other = mimic.attribute("joint").unwrap_or_default();
            let factor = number(self, mimic, "multiplier").unwrap_or(1.0);
            let constant = number(self, mimic, "offset").unwrap_or(0.0)
                - factor * number(self, mimic, "reference").unwrap_or(0.0);
            let ends = [full.clone(), format!("{scope}{other}")]
                .map(|n| self.joints.get(&n).and_then(only_coordinate));
            let at = xml::at(text, mimic);
            if name == other {
                let message = format!("`{name}` follows itself");
                self.notes.problem_with("HP0803", at, message, "use another joint of the model");
                continue;
            }
            let [Some(own), Some(master)] = ends else {
                if self.names.contains(&format!("{scope}{other}")) {
                    let why = format!("`{name}` or `{other}`, which it follows, has no single coordinate");
                    self.notes.refused("mimic", name, at, why);
                    continue;
                }
                let message = format!(
                    "`{name}` follows the joint `{other}`, which does not exist or has no single coordinate"
                );
                self.notes.problem_with("HP0803", at, message, "use a revolute or prismatic joint");
                continue;
            };
            robot::follow(&mut self.m, self.notes, [name, other], at, [own, master], [factor, constant]);
        }
        if joint.attribute("type").map(str::trim) != Some("gearbox") {
            return;
        }
        let at = xml::at(text, joint);
        let ratio = number(self, joint, "gearbox_ratio").unwrap_or(1.0);
        let reference = child(joint, "gearbox_reference_body")
            .and_then(|n| n.text())
            .unwrap_or_default()
            .trim()
            .to_owned();
        let [parent, driven] = ["parent", "child"].map(|end| self.end(joint, model, end));
        let (Some(parent), Some(driven), Some(carrier)) = (parent, driven, self.frame(model, &reference))
        else {
            self.notes.refused("joint", &shown, at, "the reference body of the gearbox does not exist");
            return;
        };
        let Some(frame) = self.frames.get(&format!("{scope}joint {name}")).map(|f| f.pose) else { return };
        let axes = ["axis", "axis2"].map(|key| self.axis(joint, model, frame, key));
        let hinge = |body: usize, axis: Vec3| {
            let on_carrier =
                self.joints.values().filter(|k| k.markers.iter().any(|m| m.body == carrier.body));
            let axis = axis.unit().unwrap_or(axis);
            let k = carrying_joint(on_carrier, body, &["revolute"], axis)?;
            Some((k.number, coordinate_sign(k, body, axis)))
        };
        match (hinge(parent.body, axes[0]), hinge(driven.body, axes[1])) {
            (Some((a, u)), Some((b, v))) => {
                let terms = vec![
                    (Coordinate { joint: b, name: "angle" }, v),
                    (Coordinate { joint: a, name: "angle" }, ratio * u),
                ];
                let note = ElementSource { kind: "joint", name, at }.note(self.notes);
                self.m.coupler(name, note, terms);
                self.notes.taken("gearbox", &shown, at);
            }
            _ => self.notes.refused(
                "joint",
                &shown,
                at,
                "a gearbox requires hinges of both bodies on the reference body, along its axes",
            ),
        }
    }

    /// Reads extensions by other programs: mimic plugins, equalities of MuJoCo, loop joints.
    pub(super) fn extensions(&mut self, model: &Model<'d>) {
        let (text, scope) = (model.text, &model.scope);
        for node in named(model.node, "plugin") {
            let Some(f) = robot::mimic_plugin(text, node, self.notes) else { continue };
            let at = xml::at(text, node);
            let ends = [&f.own, &f.master]
                .map(|n| self.joints.get(&format!("{scope}{n}")).and_then(only_coordinate));
            match ends {
                [Some(own), Some(master)] if own != master => {
                    // Most models define it twice, for visualisation and for simulation.
                    let coupled = |c: &crate::mechanism::Coupler| {
                        c.terms.len() == 2 && [own, master].iter().all(|x| c.terms.iter().any(|t| t.0 == *x))
                    };
                    if !self.m.couplers.iter().any(coupled) {
                        let constants = [f.factor, f.offset];
                        robot::follow(
                            &mut self.m,
                            self.notes,
                            [&f.own, &f.master],
                            at,
                            [own, master],
                            constants,
                        );
                    }
                }
                _ => {
                    let why = format!(
                        "it couples the joints `{}` and `{}`, which do not both exist",
                        f.own, f.master
                    );
                    self.notes.refused("plugin", node.attribute("name").unwrap_or_default(), at, why);
                }
            }
        }
        for node in named(model.node, "loop_joint") {
            let why = "`loop_joint` is an extension of URDF: use a `joint` of this model instead, which may close a loop";
            self.notes.refused(
                "loop_joint",
                node.attribute("name").unwrap_or_default(),
                xml::at(text, node),
                why,
            );
        }
        let blocks: Vec<Node<'d, 'd>> = named(model.node, "mujoco").collect();
        if blocks.is_empty() {
            return;
        }
        let within = |name: &str| name.strip_prefix(scope.as_str()).map(str::to_owned);
        let mut bodies = BTreeMap::new();
        for (name, body) in &self.bodies {
            let pose = self.m.bodies[*body].pose;
            bodies.extend(within(name).zip(pose).map(|(name, pose)| (name, (*body, pose))));
        }
        let joints =
            self.joints.iter().filter_map(|(name, j)| Some((within(name)?, only_coordinate(j)?))).collect();
        let m = std::mem::replace(&mut self.m, Mechanism::new("", "m", "rad"));
        self.m = crate::mjcf::extension(m, self.notes, &blocks, text, &bodies, &joints);
    }

    /// Reads Drake's constraints.
    pub(super) fn constraints(&mut self, model: &Model<'d>) {
        for (k, node) in named(model.node, "ball_constraint").enumerate() {
            let at = xml::at(model.text, node);
            xml::unknown(model.text, node, "", robot::BALL_CONSTRAINT, self.notes);
            let ends = robot::BALL_ENDS.map(|(body, place)| {
                let frame = self.end(node, model, body)?;
                let place = child(node, place).and_then(|p| {
                    exactly::<3>(
                        p.text().unwrap_or_default(),
                        "the point",
                        xml::at(model.text, p),
                        self.notes,
                    )
                });
                let r = frame.pose.point(place.unwrap_or_default().into());
                Some(Marker { body: frame.body, pose: Pose { rot: home().rot, r } })
            });
            let [Some(i), Some(j)] = ends else { continue };
            let name = format!("{}ball_constraint_{}", model.scope, k + 1);
            let source = ElementSource { kind: "ball_constraint", name: self.shown(&name), at };
            join(&mut self.m, self.notes, source, "spherical", [i, j]);
        }
        for node in named(model.node, "linear_bushing_rpy") {
            let why = "bushings are forces: if it closes a loop, use a joint instead";
            self.notes.refused("linear_bushing_rpy", "", xml::at(model.text, node), why);
        }
    }
}

/// Returns the pitch of a screw under one of its keys, which may be in its axis.
fn pitch_of<'a, 'i>(joint: Node<'a, 'i>, key: &'static str) -> Option<Node<'a, 'i>> {
    child(joint, key).or_else(|| child(joint, "axis").and_then(|axis| child(axis, key)))
}

fn only_coordinate(joint: &MarkerJoint) -> Option<Coordinate> {
    let name = match joint.kind {
        "revolute" | "screw" => "angle",
        "translational" => "displacement",
        _ => return None,
    };
    Some(Coordinate { joint: joint.number, name })
}
